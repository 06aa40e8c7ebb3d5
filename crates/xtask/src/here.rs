//! When, where and of what something was measured.

use std::time::SystemTime;

use serde_json::{Value, json};

use crate::process;

/// The machine, its system and its compiler.
pub fn machine() -> Value {
    let cpu = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = cpu
        .lines()
        .find_map(|line| line.strip_prefix("model name")?.split_once(':').map(|(_, name)| name.trim()));
    let memory = std::fs::read_to_string("/proc/meminfo").unwrap_or_default();
    let total = memory.lines().find_map(|line| {
        line.strip_prefix("MemTotal:")?.trim().trim_end_matches("kB").trim().parse::<f64>().ok()
    });
    json!({
        "processor": model.unwrap_or(std::env::consts::ARCH),
        "logical_cores": std::thread::available_parallelism().map_or(1, usize::from),
        "memory_gb": total.map(|kb| (kb / 1024.0 / 1024.0 * 10.0).round() / 10.0),
        "system": std::env::consts::OS,
        "rustc": said("rustc", &["--version"]),
    })
}

/// A machine in words.
pub fn in_words(machine: &Value) -> String {
    let text = |key: &str| machine[key].as_str().unwrap_or("unknown").to_owned();
    let number = |key: &str| machine[key].as_f64().map_or_else(|| "?".to_owned(), |v| v.to_string());
    format!(
        "{}, {} logical cores, {} GB, {}, {}",
        text("processor"),
        number("logical_cores"),
        number("memory_gb"),
        text("system"),
        text("rustc")
    )
}

/// The commit that is checked out, and whether files differ from it.
pub fn commit() -> String {
    said("git", &["describe", "--always", "--dirty"])
}

fn said(program: &str, arguments: &[&str]) -> String {
    process::capture(&mut process::command(program, arguments))
        .map_or_else(|_| "unknown".to_owned(), |said| String::from_utf8_lossy(&said).trim().to_owned())
}

/// Now, by ISO 8601, in universal time.
pub fn date() -> String {
    let since = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH);
    date_of(since.map_or(0, |since| since.as_secs()))
}

fn date_of(seconds: u64) -> String {
    let (days, rest) = (seconds / 86_400, seconds % 86_400);
    let [year, month, day] = civil(days);
    format!("{year:04}-{month:02}-{day:02}T{:02}:{:02}:{:02}Z", rest / 3600, rest / 60 % 60, rest % 60)
}

/// Year, month and day of a number of days since 1970: years that begin in March have their leap day at their end, and 400 of them
/// have 146 097 days.
fn civil(days: u64) -> [u64; 3] {
    let shifted = days + 719_468;
    let (era, day) = (shifted / 146_097, shifted % 146_097);
    let year = (day - day / 1460 + day / 36_524 - day / 146_096) / 365;
    let in_year = day - (365 * year + year / 4 - year / 100);
    let from_march = (5 * in_year + 2) / 153;
    let month = if from_march < 10 { from_march + 3 } else { from_march - 9 };
    [era * 400 + year + u64::from(month < 3), month, in_year - (153 * from_march + 2) / 5 + 1]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_are_dates() {
        assert_eq!(date_of(0), "1970-01-01T00:00:00Z");
        assert_eq!(date_of(951_868_799), "2000-02-29T23:59:59Z");
        assert_eq!(date_of(1_709_251_200), "2024-03-01T00:00:00Z");
        assert_eq!(date_of(1_798_761_599), "2026-12-31T23:59:59Z");
    }
}
