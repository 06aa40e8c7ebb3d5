//! A network between a master and its slaves that can be cut, delayed and slowed, through plain sockets.

use std::io::{Read, Write};
use std::net::{Shutdown, TcpListener, TcpStream};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

/// What is wrong with the network.
#[derive(Default)]
struct Faults {
    is_cut: AtomicBool,
    /// Nothing passes, and nothing is lost.
    is_held: AtomicBool,
    /// Milliseconds that everything takes longer.
    delay_ms: AtomicU64,
    /// Bytes per second in each direction; 0: as many as come.
    speed: AtomicU64,
    open: Mutex<Vec<TcpStream>>,
}

/// Passes on what comes to a port of its own.
pub struct Proxy {
    pub port: u16,
    faults: Arc<Faults>,
}

impl Proxy {
    /// To that port.
    pub fn to(port: u16) -> Self {
        let listener = TcpListener::bind(("127.0.0.1", 0)).expect("a free port");
        let own = listener.local_addr().expect("it listens").port();
        let faults: Arc<Faults> = Arc::default();
        let shared = Arc::clone(&faults);
        std::thread::spawn(move || {
            for near in listener.incoming().filter_map(Result::ok) {
                // A cut network answers nobody; to be refused is the quicker way to the same.
                if shared.is_cut.load(Ordering::Relaxed) {
                    continue;
                }
                let Ok(far) = TcpStream::connect(("127.0.0.1", port)) else { continue };
                for (from, to) in [(&near, &far), (&far, &near)] {
                    let (from, to) = (from.try_clone().expect("a handle"), to.try_clone().expect("a handle"));
                    shared.open.lock().expect("the lock").push(from.try_clone().expect("a handle"));
                    let shared = Arc::clone(&shared);
                    std::thread::spawn(move || pass(from, to, &shared));
                }
            }
        });
        Self { port: own, faults }
    }

    /// Cuts all connections, in the midst of whatever they are at; there are no new ones until it is mended.
    pub fn cut(&self) {
        self.faults.is_cut.store(true, Ordering::Relaxed);
        for stream in self.faults.open.lock().expect("the lock").drain(..) {
            drop(stream.shutdown(Shutdown::Both));
        }
    }

    /// Everything passes again.
    pub fn mend(&self) {
        self.faults.is_cut.store(false, Ordering::Relaxed);
    }

    /// Lets nothing pass, as a network that stands still, or goes on.
    pub fn hold(&self, held: bool) {
        self.faults.is_held.store(held, Ordering::Relaxed);
    }

    /// From now on everything is late, and slow.
    pub fn slow(&self, delay: Duration, bytes_per_second: u64) {
        self.faults.delay_ms.store(delay.as_millis() as u64, Ordering::Relaxed);
        self.faults.speed.store(bytes_per_second, Ordering::Relaxed);
    }
}

fn pass(mut from: TcpStream, mut to: TcpStream, faults: &Faults) {
    let mut bytes = [0; 8192];
    while let Ok(n @ 1..) = from.read(&mut bytes) {
        let mut wait = Duration::from_millis(faults.delay_ms.load(Ordering::Relaxed));
        let speed = faults.speed.load(Ordering::Relaxed);
        if speed > 0 {
            wait += Duration::from_secs_f64(n as f64 / speed as f64);
        }
        std::thread::sleep(wait);
        while faults.is_held.load(Ordering::Relaxed) {
            std::thread::sleep(Duration::from_millis(10));
        }
        if to.write_all(&bytes[..n]).is_err() {
            break;
        }
    }
    drop(from.shutdown(Shutdown::Both));
    drop(to.shutdown(Shutdown::Both));
}
