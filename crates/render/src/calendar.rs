//! Moments by the calendar, in UTC.

use std::time::{SystemTime, UNIX_EPOCH};

/// A second of the Gregorian calendar.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Moment {
    /// Year, month from 1 and day from 1.
    pub date: [u64; 3],
    /// Hour, minute and second.
    pub time: [u64; 3],
}

impl Moment {
    /// Of a time from 1970 on; that year begins for earlier ones.
    pub fn of(time: SystemTime) -> Self {
        let s = time.duration_since(UNIX_EPOCH).map_or(0, |d| d.as_secs());
        Self { date: date_of(s / 86_400), time: [s / 3600 % 24, s / 60 % 60, s % 60] }
    }
}

/// Date of a day counted from 1970-01-01. Eras of 400 years begin on 1 March of year 0, so that the leap day is the last
/// of its year.
fn date_of(days: u64) -> [u64; 3] {
    let shifted = days + 719_468;
    let (era, day) = (shifted / 146_097, shifted % 146_097);
    let year = (day - day / 1460 + day / 36_524 - day / 146_096) / 365;
    let day_of_year = day - (365 * year + year / 4 - year / 100);
    let month = (5 * day_of_year + 2) / 153;
    let day_of_month = day_of_year - (153 * month + 2) / 5 + 1;
    let month = if month < 10 { month + 3 } else { month - 9 };
    [era * 400 + year + u64::from(month <= 2), month, day_of_month]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn seconds_have_their_place_in_the_calendar() {
        for (seconds, date, time) in [
            (1_206_454_981, [2008, 3, 25], [14, 23, 1]),
            (951_782_400, [2000, 2, 29], [0, 0, 0]),
            (4_107_542_399, [2100, 2, 28], [23, 59, 59]),
            (0, [1970, 1, 1], [0, 0, 0]),
        ] {
            assert_eq!(Moment::of(UNIX_EPOCH + Duration::from_secs(seconds)), Moment { date, time });
        }
    }
}
