//! What happens to renders of many machines.

use super::accounts::samples_up_to;
use super::agreement::assert_agrees;
use super::farm::{Farm, interrupt, kill, leave, signal};
use super::proxy::Proxy;
use std::time::Duration;

/// The film holds each acknowledged sample once, and no other.
pub fn assert_complete(farm: &Farm) {
    assert_sums_up(farm);
    let film = farm.film();
    let counts: f64 = film.film.layers[0].counts.iter().sum();
    assert_eq!(film.record.expect("ours").samples as f64, counts);
}

/// The same by the film's record alone: not all ways of rendering count the samples of pixels.
fn assert_sums_up(farm: &Farm) {
    let (film, logs) = (farm.film(), farm.logs());
    let record = film.record.as_ref().expect("ours");
    let mut sum = 0;
    for run in &record.runs {
        assert_eq!(run.first, 0, "{run:?}: nothing is left out");
        sum += samples_up_to(&logs, run.seed, run.end);
    }
    assert_eq!(record.samples, sum, "the film against the sum of what was acknowledged");
}

/// Slaves that live to the end have everything in the film that they were told is there.
pub fn assert_all_of(farm: &Farm, seeds: &[u64]) {
    let (film, logs) = (farm.film(), farm.logs());
    let record = film.record.as_ref().expect("ours");
    for &seed in seeds {
        let uploads = logs.iter().flat_map(super::accounts::Log::uploads);
        let sent = uploads.filter(|upload| upload.seed == seed).map(|upload| upload.end).max();
        assert_eq!(sent, Some(record.first_fresh_unit(seed)), "of seed {seed}");
    }
}

#[test]
fn a_master_and_four_slaves_through_deaths_and_broken_networks() {
    let mut farm = Farm::new("");
    farm.start_master("m", &[]);
    let proxy = Proxy::to(farm.port);
    let mut slaves: Vec<_> =
        (1..=4).map(|seed| farm.slave(seed, if seed <= 2 { proxy.port } else { farm.port })).collect();
    for seed in 1..=4 {
        farm.wait_for_uploads(seed, 2);
    }
    // A slave dies, and another comes.
    kill(&mut slaves[3]);
    slaves[3] = farm.slave(5, farm.port);
    farm.wait_for_uploads(5, 1);
    // The network is cut in the midst of things, and comes back late and slow: an upload takes a second or so.
    proxy.cut();
    farm.wait_for_times("slave1.json", "\"event\":\"disconnected\"", 1);
    proxy.slow(Duration::from_millis(20), 100_000);
    proxy.mend();
    farm.wait_for_uploads(1, 1);
    farm.wait_for_uploads(2, 1);
    // The master dies twice, and goes on with the slaves that are there.
    for _ in 0..2 {
        farm.kill_master();
        std::thread::sleep(Duration::from_millis(300));
        farm.resume_master("m");
        for seed in [1, 2, 3, 5] {
            farm.wait_for_uploads(seed, 1);
        }
    }
    proxy.slow(Duration::ZERO, 0);
    farm.end_master();
    assert_complete(&farm);
    assert_all_of(&farm, &[1, 2, 3, 5]);
    for slave in &mut slaves {
        leave(slave);
    }
    assert_agrees(&farm.bench, &farm.film());
}

/// What the master renders itself counts, too, and no random numbers are used twice when it goes on.
#[test]
fn a_working_master_dies_and_goes_on() {
    let mut farm = Farm::new("");
    farm.start_master("wm", &[]);
    let mut slave = farm.slave(7, farm.port);
    farm.wait_for_uploads(7, 2);
    farm.kill_master();
    farm.resume_master("wm");
    farm.wait_for_uploads(7, 1);
    farm.end_master();
    let film = farm.film();
    let record = film.record.as_ref().expect("ours");
    let seeds: Vec<u64> = record.runs.iter().map(|run| run.seed).collect();
    assert!(seeds.len() == 2 && seeds.contains(&0) && seeds.contains(&7), "{:?}", record.runs);
    assert!(record.samples > samples_up_to(&farm.logs(), 7, record.first_fresh_unit(7)), "its own count");
    assert_complete(&farm);
    leave(&mut slave);
}

/// A halting condition ends the render, with what slaves had not sent yet.
#[test]
fn a_render_ends_at_its_number_of_samples() {
    // So rarely that none is sent before: what slaves have rendered counts all the same.
    let mut farm = Farm::new("");
    let scene = farm.text("scene.igs").replace("<frame_upload_period>0.4<", "<frame_upload_period>1000<");
    farm.bench.write("scene.igs", &scene);
    farm.start_master("m", &["-haltspp", "200"]);
    let mut slaves = [farm.slave(1, farm.port), farm.slave(2, farm.port)];
    assert_eq!(farm.master.as_mut().map(super::workbench::Running::finish), Some(Some(0)));
    let film = farm.film();
    let spp = film.film.samples_per_pixel();
    assert!(spp >= 200.0);
    farm.wait("master1.stderr", &format!("Halted with the samples per pixel that were asked for: {spp:.2}"));
    assert_complete(&farm);
    assert_all_of(&farm, &[1, 2]);
    // They wait for the next master.
    for (slave, seed) in slaves.iter_mut().zip(1..) {
        farm.wait(&format!("slave{seed}.json"), "\"event\":\"finished\"");
        leave(slave);
    }
}

/// Samples that were counted on, and are gone with their slave, are not passed over in silence, and do not end the render.
#[test]
fn who_dies_at_the_end_is_missed() {
    let mut farm = Farm::new("");
    let scene = farm.text("scene.igs").replace("<frame_upload_period>0.4<", "<frame_upload_period>1000<");
    farm.bench.write("scene.igs", &scene);
    farm.start_master("m", &["-haltspp", "50"]);
    // So slow that the slave is killed in the midst of its upload.
    let proxy = Proxy::to(farm.port);
    proxy.slow(Duration::ZERO, 4_000);
    let mut slave = farm.slave(1, proxy.port);
    farm.wait("master1.stderr", "Waiting for the last of 1 slave");
    kill(&mut slave);
    proxy.cut();
    farm.wait("master1.stderr", "1 slave that is gone had about ");
    farm.wait("master1.stderr", "to send that did not come: rendering goes on");
    // Another renders what was asked for.
    let mut other = farm.slave(2, farm.port);
    assert_eq!(farm.master.as_mut().map(super::workbench::Running::finish), Some(Some(0)));
    let spp = farm.film().film.samples_per_pixel();
    assert!(spp >= 50.0, "{spp}");
    farm.wait("master1.stderr", &format!("Halted with the samples per pixel that were asked for: {spp:.2}"));
    assert_complete(&farm);
    leave(&mut other);
}

/// A slave whose samples come when the render goes on without them renders on with it: one that has not heard of the end, and one
/// that has ended and sends all it has.
#[test]
fn who_comes_after_the_end_was_taken_back_renders_on() {
    for (upload_period, time_to_hear) in [("0.4", 0), ("20", 3)] {
        let mut farm = Farm::new("");
        let scene = farm
            .text("scene.igs")
            .replace("<frame_upload_period>0.4<", &format!("<frame_upload_period>{upload_period}<"));
        farm.bench.write("scene.igs", &scene);
        farm.start_master("m", &["-haltspp", "50"]);
        let proxies = [(); 2].map(|()| Proxy::to(farm.port));
        let mut slaves = [1, 2].map(|seed| {
            let proxy = &proxies[seed as usize - 1];
            proxy.slow(Duration::ZERO, 4_000);
            farm.slave(seed, proxy.port)
        });
        farm.wait("master1.stderr", "Waiting for the last of 2 slaves");
        // What the second had to send is lost, so that the first has to render more than it had told of.
        kill(&mut slaves[1]);
        proxies[1].cut();
        std::thread::sleep(Duration::from_secs(time_to_hear));
        proxies[0].hold(true);
        farm.wait("master1.stderr", "rendering goes on");
        proxies[0].slow(Duration::ZERO, 0);
        proxies[0].hold(false);
        assert_eq!(farm.master.as_mut().map(super::workbench::Running::finish), Some(Some(0)));
        let spp = farm.film().film.samples_per_pixel();
        assert!(spp >= 50.0, "{spp}");
        assert_complete(&farm);
        leave(&mut slaves[0]);
    }
}

/// Who is told to stop while it waits before it looks for the master again looks once more.
#[test]
fn who_stops_between_two_tries_loses_nothing() {
    let mut farm = Farm::new("");
    farm.start_master("m", &[]);
    let mut slave = farm.slave(1, farm.port);
    farm.wait_for_uploads(1, 2);
    farm.kill_master();
    // So many tries in vain that the next is some seconds away.
    farm.wait("slave1.stderr", "trying again in 8 s");
    farm.resume_master("m");
    leave(&mut slave);
    assert!(!farm.text("slave1.stderr").contains("are lost"), "{}", farm.text("slave1.stderr"));
    farm.end_master();
    assert_all_of(&farm, &[1]);
    assert_complete(&farm);
}

/// A master that is started without the film that is there says so before it writes over it.
#[test]
fn a_film_is_not_written_over_without_a_word() {
    let mut farm = Farm::new("");
    farm.start_master("m", &[]);
    let mut slave = farm.slave(1, farm.port);
    farm.wait_for_uploads(1, 2);
    farm.end_master();
    farm.start_master("m", &[]);
    farm.wait("master2.stderr", "the film a.igi will be written over; to go on with it, give -r a.igi, too");
    farm.end_master();
    farm.resume_master("m");
    assert!(!farm.text("master3.stderr").contains("written over"), "it goes on");
    farm.end_master();
    leave(&mut slave);
}

/// Whatever way of rendering: layers of camera and light paths, and chains whose brightness is estimated by all machines
/// together.
#[test]
fn all_ways_of_rendering_agree() {
    for settings in [
        "<bidirectional>true</bidirectional>",
        "<metropolis>true</metropolis>",
        "<bidirectional>true</bidirectional><hybrid>true</hybrid>",
    ] {
        let mut farm = Farm::new(settings);
        farm.start_master("m", &["-haltspp", "400"]);
        let mut slaves = [farm.slave(1, farm.port), farm.slave(2, farm.port)];
        assert_eq!(farm.master.as_mut().map(super::workbench::Running::finish), Some(Some(0)), "{settings}");
        assert_sums_up(&farm);
        assert_all_of(&farm, &[1, 2]);
        for slave in &mut slaves {
            leave(slave);
        }
        assert_agrees(&farm.bench, &farm.film());
    }
}

/// A master that is killed while it ends the render, before it has saved: slaves still have what they sent.
#[test]
fn a_master_may_die_at_the_end() {
    let mut farm = Farm::saving_each(1000.0, "");
    farm.start_master("m", &[]);
    let mut slaves = [farm.slave(1, farm.port), farm.slave(2, farm.port)];
    for seed in [1, 2] {
        farm.wait_for_uploads(seed, 2);
    }
    // The master waits for one that hangs, while the other has sent all that it has.
    signal(&slaves[1], "-STOP");
    interrupt(farm.master.as_ref().expect("there is one"));
    farm.wait("master1.stderr", "Waiting for the last of 2 slaves");
    farm.wait_for_uploads(1, 1);
    farm.kill_master();
    assert!(!farm.bench.path("a.igi").exists(), "nothing was saved");
    signal(&slaves[1], "-CONT");
    farm.start_master("m", &[]);
    for seed in [1, 2] {
        farm.wait_for_uploads(seed, 2);
    }
    farm.end_master();
    assert_complete(&farm);
    assert_all_of(&farm, &[1, 2]);
    for slave in &mut slaves {
        leave(slave);
    }
}

/// A slave needs no file of the scene's, and does not fetch one twice.
#[test]
fn scenes_are_fetched_once() {
    let mut farm = Farm::new("");
    farm.start_master("m", &[]);
    for seed in [1, 2] {
        let mut slave = farm.slave(seed, farm.port);
        farm.wait_for_uploads(seed, 1);
        kill(&mut slave);
    }
    assert_eq!(farm.text("slave1.json").matches("\"event\":\"fetching\"").count(), 1);
    assert_eq!(farm.text("slave2.json").matches("\"event\":\"fetching\"").count(), 0);
}

/// A scene that cannot be kept is rendered all the same.
#[test]
fn a_slave_needs_no_cache() {
    let mut farm = Farm::new("");
    farm.start_master("m", &[]);
    farm.bench.wrapper = ["env", "INDIGO_CACHE=/dev/null"].map(str::to_owned).into();
    let mut slave = farm.slave(1, farm.port);
    farm.wait_for_uploads(1, 1);
    let said = farm.text("slave1.stderr");
    assert!(said.contains("warning: the scene cannot be kept: /dev/null/packs/"), "{said}");
    assert!(said.contains("the variable INDIGO_CACHE may name another folder"), "{said}");
    farm.end_master();
    leave(&mut slave);
}

#[test]
fn without_the_key_there_is_no_joining() {
    let mut farm = Farm::new("");
    farm.start_master("m", &[]);
    let host = format!("127.0.0.1:{}", farm.port);
    let mut stranger = farm.bench.start_as("stranger", &["-n", "s", "-h", &host, "-t", "1"]);
    farm.wait("stranger.stderr", "this slave needs the same one (--key-file FILE)");
    let made = farm.bench.run(&["--make-key", "other"]);
    assert_eq!(made.status, Some(0), "{made:?}");
    let mut other =
        farm.bench.start_as("other_one", &["-n", "s", "-h", &host, "-t", "1", "--key-file", "other"]);
    farm.wait("other_one.stderr", "has not proved that it has the same key");
    farm.wait("master1.json", "\"event\":\"refused\"");
    for process in [&mut stranger, &mut other] {
        interrupt(process);
        assert_eq!(process.finish(), Some(0));
    }
    let refused = farm.text("master1.json");
    assert!(refused.contains("\"peer\":\"127.0.0.1:"), "{refused}");
    // No key, no network.
    let ran = farm.bench.run(&["-n", "s", "-h", "192.0.2.1", "-halt", "1"]);
    assert!(ran.stderr.contains("--make-key FILE"), "{ran:?}");
    if cfg!(unix) {
        let odd = farm.bench.run(&["--make-key", "the $HOME key's"]);
        assert!(odd.stderr.contains("by --key-file 'the $HOME key'\\''s'\n"), "to be copied: {odd:?}");
    }
    // One that cannot be written leaves nothing, and so can be tried again.
    let full = farm.bench.run_limited(0, &["--make-key", "half"]);
    assert!(full.status == Some(1) && !farm.bench.path("half").exists(), "{full:?}");
    // Folders are made, as for all that is written.
    let made = farm.bench.run(&["--make-key", "new/folder/key"]);
    assert!(made.status == Some(0) && farm.bench.path("new/folder/key").exists(), "{made:?}");
    // A key is never written over.
    let again = farm.bench.run(&["--make-key", "key"]);
    assert_eq!(again.status, Some(1), "{again:?}");
}
