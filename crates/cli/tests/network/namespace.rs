//! A network of its own, as the system makes them: cut by the link, and slowed by `tc netem` where the system has that.

use super::farm::{Farm, leave};
use super::stories::{assert_all_of, assert_complete};
use std::io::Write as _;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

/// A namespace, with somebody who holds it.
struct Namespace(Child);

impl Namespace {
    /// `None` where the system gives none.
    fn new() -> Option<Self> {
        let holder =
            Command::new("unshare").args(["-rn", "sleep", "600"]).stderr(Stdio::null()).spawn().ok()?;
        let namespace = Self(holder);
        // The holder may not be there yet, and then the link is that of no namespace but this one.
        (0..100)
            .any(|_| {
                std::thread::sleep(Duration::from_millis(20));
                namespace.is_apart() && namespace.run("ip link set lo up")
            })
            .then_some(namespace)
    }

    /// With a link over which multicast passes, as in an office.
    fn with_lan() -> Option<Self> {
        let has_lan = |namespace: &Self| {
            let mut commands = [
                "ip link add lan type veth peer name other",
                "ip addr add 10.77.0.1/24 dev lan",
                "ip link set lan up",
                "ip link set other up",
            ]
            .into_iter();
            commands.all(|command| namespace.run(command))
        };
        Self::new().filter(has_lan)
    }

    fn is_apart(&self) -> bool {
        let of = |process: &str| std::fs::read_link(format!("/proc/{process}/ns/net")).ok();
        of(&self.0.id().to_string()).is_some_and(|own| Some(own) != of("self"))
    }

    /// What a program is started by to be in it.
    fn wrapper(&self) -> Vec<String> {
        let id = self.0.id().to_string();
        ["nsenter", "-t", &id, "-U", "-n", "--preserve-credentials"].map(str::to_owned).to_vec()
    }

    /// Whether a command there succeeds.
    fn run(&self, command: &str) -> bool {
        let wrapper = self.wrapper();
        let mut enter = Command::new(&wrapper[0]);
        let ran = enter.args(&wrapper[1..]).args(command.split(' ')).stderr(Stdio::null()).status();
        ran.is_ok_and(|status| status.success())
    }
}

impl Drop for Namespace {
    fn drop(&mut self) {
        // It may have ended already.
        drop(self.0.kill());
        drop(self.0.wait());
    }
}

/// Says what is not known, past what catches the output of tests that pass.
fn skip(what: &str) {
    let why = "as this system gives no network namespaces (unshare -rn, ip)";
    drop(writeln!(std::io::stderr(), "SKIPPED: {what}, {why}"));
}

#[test]
fn a_link_that_is_slow_and_fails_costs_no_sample() {
    let Some(network) = Namespace::new() else {
        return skip("whether a slow link that fails costs samples");
    };
    let mut farm = Farm::new("");
    farm.bench.wrapper = network.wrapper();
    farm.start_master("m", &[]);
    let mut slaves = [farm.slave(1, farm.port), farm.slave(2, farm.port)];
    let wait_for_both = |farm: &Farm| [1, 2].map(|seed| farm.wait_for_uploads(seed, 1));
    wait_for_both(&farm);
    if network.run("tc qdisc add dev lo root netem delay 30ms 10ms loss 2% rate 4mbit") {
        wait_for_both(&farm);
    } else {
        println!("without a slow network: this system has no tc netem");
    }
    // Packets are lost for a while; TCP sends them again.
    assert!(network.run("ip link set lo down"));
    std::thread::sleep(Duration::from_secs(2));
    assert!(network.run("ip link set lo up"));
    wait_for_both(&farm);
    farm.end_master();
    assert_complete(&farm);
    assert_all_of(&farm, &[1, 2]);
    for slave in &mut slaves {
        leave(slave);
    }
}

/// A slave that is not told where its master is looks for it in the local network.
#[test]
fn masters_are_found() {
    let Some(network) = Namespace::with_lan() else { return skip("whether slaves find masters") };
    let mut farm = Farm::new("");
    farm.bench.wrapper = network.wrapper();
    farm.start_master("m", &[]);
    let mut slave = farm.searching_slave(3);
    farm.wait_for_uploads(3, 1);
    leave(&mut slave);
    farm.end_master();
    assert_complete(&farm);
}
