//! A long night in a few minutes: processes die and networks break, again and again, by a script that a seed fixes.

use super::farm::{Farm, kill, leave};
use super::proxy::Proxy;
use super::stories::{assert_all_of, assert_complete};
use super::workbench::Running;
use std::time::Duration;

/// More memory than the first rounds have taken that a process may come to hold, in KiB: caches of allocators, and a film or
/// two of this size. What leaks does so at each upload, of which there are hundreds.
const GROWTH_KIB: u64 = 48 << 10;

/// SplitMix64 (Steele, Lea and Flood 2014).
struct Script(u64);

impl Script {
    fn below(&mut self, n: u64) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        (z ^ (z >> 31)) % n
    }
}

/// Memory of a process in KiB, where the system tells.
fn memory_kib(process: &Running) -> Option<u64> {
    let status = std::fs::read_to_string(format!("/proc/{}/status", process.0.id())).ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    line.trim().strip_suffix("kB")?.trim().parse().ok()
}

fn soak(rounds: u64, seed: u64) {
    let mut farm = Farm::new("");
    farm.start_master("m", &[]);
    let proxy = Proxy::to(farm.port);
    // The first lives to the end; it is behind a network that fails.
    let mut veteran = farm.slave(1, proxy.port);
    let mut others = [farm.slave(2, farm.port), farm.slave(3, proxy.port)];
    let mut next = 4;
    let mut script = Script(seed);
    farm.wait_for_uploads(1, 2);
    let before = memory_kib(&veteran);
    // A master's memory, and how much more it has come to be: for one that lives long enough to be asked twice.
    let mut master = farm.master.as_ref().and_then(memory_kib);
    for round in 0..rounds {
        match script.below(4) {
            0 => {
                let victim = script.below(others.len() as u64) as usize;
                kill(&mut others[victim]);
                // What it had sent is told by then, so that it can be counted.
                std::thread::sleep(Duration::from_millis(500));
                others[victim] = farm.slave(next, if next % 2 == 0 { farm.port } else { proxy.port });
                next += 1;
            }
            1 => {
                farm.kill_master();
                std::thread::sleep(Duration::from_millis(script.below(500)));
                farm.resume_master("m");
                farm.wait_for_uploads(1, 2);
                master = farm.master.as_ref().and_then(memory_kib);
            }
            2 => {
                proxy.cut();
                std::thread::sleep(Duration::from_millis(script.below(1000)));
                proxy.mend();
            }
            _ => {
                proxy.slow(Duration::from_millis(script.below(30)), 50_000 * script.below(8));
                std::thread::sleep(Duration::from_millis(script.below(1000)));
            }
        }
        if round % 4 == 3 {
            // Nothing hangs: whatever has happened, uploads come through.
            farm.wait_for_uploads(1, 1);
        }
        if let (Some(before), Some(after)) = (master, farm.master.as_ref().and_then(memory_kib)) {
            assert!(after < before + GROWTH_KIB, "the master's {before} KiB have become {after}");
        }
    }
    proxy.slow(Duration::ZERO, 0);
    farm.wait_for_uploads(1, 1);
    if let (Some(before), Some(after)) = (before, memory_kib(&veteran)) {
        assert!(after < before + GROWTH_KIB, "{before} KiB have become {after}");
    }
    farm.end_master();
    assert_all_of(&farm, &[1]);
    assert_complete(&farm);
    tell(&farm, rounds);
    for slave in others.iter_mut().chain([&mut veteran]) {
        leave(slave);
    }
}

/// Says what happened, to those who look.
fn tell(farm: &Farm, rounds: u64) {
    let logs = farm.logs();
    let all = |event: &str| {
        let event = format!("\"event\":\"{event}\"");
        logs.iter().map(|log| log.0.matches(&event).count()).sum::<usize>()
    };
    let spp = farm.film().film.samples_per_pixel();
    println!(
        "{rounds} rounds: {} slaves joined {} times, {} uploads were added and {} came again, {} connections were lost; \
         {spp:.1} samples per pixel, all of them told of",
        all("rendering"),
        all("joined"),
        all("added"),
        all("repeated"),
        all("disconnected")
    );
}

#[test]
fn a_short_night() {
    soak(8, 1);
}

/// Some minutes.
#[test]
#[ignore = "cargo xtask soak"]
fn a_long_night() {
    soak(150, 2);
}
