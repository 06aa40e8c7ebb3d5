//! How renders of many machines end while something is under way.

use super::accounts::Log;
use super::farm::{Farm, interrupt, leave};
use super::proxy::Proxy;
use super::stories::assert_complete;
use std::net::TcpListener;
use std::time::{Duration, Instant};

/// Bytes per second at which an upload of this test takes half a minute, and what waits before a report some seconds.
const SLOW: u64 = 50_000;

/// A number of samples is reached while a slave sends what it has rendered first, which is far less. The master hears of it
/// all the same, and the slave hears of the end and renders no more, long before its upload is through.
#[test]
fn a_render_ends_while_a_slave_sends() {
    let mut farm = Farm::saving_each(1000.0, "<width>320</width><height>240</height>");
    farm.start_master("m", &["-haltspp", "15"]);
    let proxy = Proxy::to(farm.port);
    let mut slave = farm.slave(1, proxy.port);
    farm.wait("slave1.json", "\"event\":\"rendering\"");
    proxy.slow(Duration::ZERO, SLOW);
    let began = Instant::now();
    farm.wait("master1.stderr", "Waiting for the last of 1 slave");
    let until_end = began.elapsed();
    assert!(!farm.text("slave1.json").contains("\"event\":\"sent\""), "the first upload is under way");
    std::thread::sleep(Duration::from_secs(15));
    proxy.slow(Duration::ZERO, 0);
    assert_eq!(farm.master.as_mut().map(super::workbench::Running::finish), Some(Some(0)));
    let rendered = farm.film().record.expect("ours").elapsed_s;
    // The time of a report and its answer, and not that until the network was mended.
    let limit = until_end.as_secs_f64() + 12.0;
    assert!(rendered < limit, "{rendered} s were rendered, {until_end:?} until the end was told");
    assert!(farm.text("master1.stderr").contains("Halted with the samples per pixel that were asked for"));
    assert_complete(&farm);
    leave(&mut slave);
}

/// A slave is stopped while it tries to reach a master that has died without saving. What it had sent is lost, too, and told of.
#[test]
fn what_a_master_took_with_it_is_told() {
    let mut farm = Farm::saving_each(1000.0, "");
    farm.start_master("m", &[]);
    let mut slave = farm.slave(1, farm.port);
    farm.wait_for_uploads(1, 12);
    farm.kill_master();
    // Somebody is there, and never says a word.
    let silent = TcpListener::bind(("127.0.0.1", farm.port)).expect("the master is gone");
    let _trying = silent.accept().expect("the slave tries again");
    interrupt(&slave);
    assert_eq!(slave.finish(), Some(0));
    let log = farm.text("slave1.json");
    let sent: u64 = Log(log.clone()).uploads().map(|upload| upload.samples).sum();
    let told = log.lines().find(|line| line.contains("\"event\":\"lost_samples\"")).expect("it is told");
    let lost = super::accounts::number(told, "samples");
    assert!(lost >= sent, "{lost} samples are told to be lost, and {sent} were sent: {told}");
}
