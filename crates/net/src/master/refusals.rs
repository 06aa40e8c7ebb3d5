//! Who was turned away, and how often that is told.

use std::collections::HashMap;
use std::net::IpAddr;
use std::time::{Duration, Instant};

/// Counts refusals by address, so that whoever knocks all day does not fill the log.
#[derive(Debug, Default)]
pub struct Refusals {
    by_address: HashMap<IpAddr, Told>,
    total: u64,
    /// Refusals of all addresses together that were told in the minute that began then.
    minute: Option<(Instant, u32)>,
}

#[derive(Debug)]
struct Told {
    /// Refusals since they were last told of.
    untold: u64,
    /// When the next is told at the earliest.
    next: Instant,
    /// The time between the last two.
    pause: Duration,
}

/// The longest time for which refusals of an address are passed over.
const LONGEST_PAUSE: Duration = Duration::from_mins(10);
/// Refusals of an address are all told as long as they are this far apart.
const SHORTEST_PAUSE: Duration = Duration::from_secs(1);
/// Addresses that are remembered.
const ADDRESSES: usize = 1024;
/// The most refusals that are told in a minute, however many addresses they come from.
const TOLD_A_MINUTE: u32 = 20;

/// What counts as one address: of IPv6 whoever has one has 2^64.
fn household(peer: IpAddr) -> IpAddr {
    match peer.to_canonical() {
        IpAddr::V6(v6) => IpAddr::V6((v6.to_bits() >> 64 << 64).into()),
        v4 @ IpAddr::V4(_) => v4,
    }
}

impl Refusals {
    /// Counts one; if it is to be told, how many were not before it.
    pub fn add(&mut self, peer: IpAddr, now: Instant) -> Option<u64> {
        self.total += 1;
        let peer = household(peer);
        let minute = self.minute.filter(|(since, _)| now < *since + Duration::from_mins(1));
        let (since, in_minute) = minute.unwrap_or((now, 0));
        let is_crowded = in_minute >= TOLD_A_MINUTE;
        if self.by_address.len() >= ADDRESSES && !self.by_address.contains_key(&peer) {
            self.by_address.clear();
        }
        let told =
            self.by_address.entry(peer).or_insert(Told { untold: 0, next: now, pause: SHORTEST_PAUSE });
        if now < told.next || is_crowded {
            told.untold += 1;
            return None;
        }
        self.minute = Some((since, in_minute + 1));
        // Who has been quiet for long starts anew.
        let is_quiet = now.saturating_duration_since(told.next) > told.pause;
        told.pause = if is_quiet { SHORTEST_PAUSE } else { (told.pause * 2).min(LONGEST_PAUSE) };
        told.next = now + told.pause;
        Some(std::mem::take(&mut told.untold))
    }

    /// All of them.
    pub fn total(&self) -> u64 {
        self.total
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn peer(n: u8) -> IpAddr {
        [10, 0, 0, n].into()
    }

    #[test]
    fn who_knocks_all_day_is_told_of_now_and_then() {
        let (mut refusals, start) = (Refusals::default(), Instant::now());
        let told = (0..36_000)
            .filter_map(|n| refusals.add(peer(1), start + Duration::from_millis(100) * n))
            .collect::<Vec<_>>();
        assert!(told.len() < 20, "{}", told.len());
        assert!(told.iter().sum::<u64>() + told.len() as u64 <= 36_000 && refusals.total() == 36_000);
        let later = start + Duration::from_hours(2);
        assert_eq!(refusals.add(peer(2), later), Some(0), "others are told of all the same");
        let strangers = (0..4000u32).filter_map(|n| refusals.add(IpAddr::from(n.to_be_bytes()), later));
        assert!(strangers.count() <= 20, "not all of many addresses");
        let of_v6 = |n: u16| IpAddr::from([0x2001, 0xdb8, 0, 0, 0, 0, 0, n]);
        let much_later = later + Duration::from_hours(1);
        assert_eq!(refusals.add(of_v6(1), much_later), Some(0));
        assert_eq!(refusals.add(of_v6(2), much_later), None, "of the same house");
    }
}
