//! How things stand, as JSON and as metrics of Prometheus.

use crate::master::{SlaveStatus, Status};
use indigo_diag::quoted;
use std::fmt::Write as _;
use std::time::Duration;

/// One object of JSON. Times are in seconds.
pub fn json(status: &Status, picture_version: u64) -> String {
    let slaves: Vec<String> = status.slaves.iter().map(slave_json).collect();
    let own = status.own.map_or_else(
        || "null".to_owned(),
        |own| {
            format!(
                "{{\"threads\":{},\"samples_per_second\":{}}}",
                own.threads,
                number(own.samples_per_second)
            )
        },
    );
    format!(
        "{{\"scene\":{},\"width\":{},\"height\":{},\"samples\":{},\"waiting_samples\":{},\"samples_per_pixel\":{},\
         \"samples_per_second\":{},\
         \"elapsed_s\":{},\"rendered_s\":{},\"bytes_received\":{},\"refused\":{},\"present\":{},\"picture\":{},\
         \"own\":{own},\"slaves\":[{}]}}\n",
        quoted(&status.scene),
        status.size[0],
        status.size[1],
        status.samples,
        status.waiting,
        number(status.samples_per_pixel),
        number(status.samples_per_second),
        seconds(status.elapsed),
        number(status.rendered_s),
        status.bytes_received,
        status.refused,
        status.present,
        picture_version,
        slaves.join(",")
    )
}

fn slave_json(slave: &SlaveStatus) -> String {
    let last_upload = slave.last_upload.map_or_else(|| "null".to_owned(), seconds);
    let last_error = slave.last_error.as_deref().map_or_else(|| "null".to_owned(), quoted);
    format!(
        "{{\"name\":{},\"address\":{},\"threads\":{},\"state\":\"{}\",\"since_s\":{},\"samples\":{},\
         \"samples_per_second\":{},\"uploads\":{},\"last_upload_s\":{last_upload},\"errors\":{},\
         \"last_error\":{last_error}}}",
        quoted(&slave.name),
        quoted(&slave.peer.to_string()),
        slave.threads,
        slave.presence.word(),
        seconds(slave.since),
        slave.samples,
        number(slave.samples_per_second),
        slave.uploads,
        slave.errors,
    )
}

/// JSON has no words for what is not finite.
fn number(value: f64) -> String {
    if value.is_finite() { value.to_string() } else { "null".to_owned() }
}

fn seconds(time: Duration) -> String {
    format!("{:.3}", time.as_secs_f64())
}

/// Metrics in the text format of Prometheus, version 0.0.4.
pub fn metrics(status: &Status) -> String {
    let mut text = String::new();
    let mut metric = |name: &str, kind: &str, help: &str, value: f64| {
        // Writing to a string cannot fail.
        let _ =
            write!(text, "# HELP indigo_{name} {help}\n# TYPE indigo_{name} {kind}\nindigo_{name} {value}\n");
    };
    metric("samples_total", "counter", "Samples in the film.", status.samples as f64);
    metric("samples_per_pixel", "gauge", "The same per pixel.", status.samples_per_pixel);
    metric(
        "samples_per_second",
        "gauge",
        "Samples rendered per second, by all machines.",
        status.samples_per_second,
    );
    metric("slaves", "gauge", "Slaves that are there.", status.present as f64);
    metric("received_bytes_total", "counter", "Bytes of uploads.", status.bytes_received as f64);
    metric("refused_total", "counter", "Callers and uploads that were refused.", status.refused as f64);
    metric("elapsed_seconds", "gauge", "Time since the master was started.", status.elapsed.as_secs_f64());
    let mut by_slave = |name: &str, kind: &str, help: &str, value: &dyn Fn(&SlaveStatus) -> f64| {
        let _ = write!(text, "# HELP indigo_slave_{name} {help}\n# TYPE indigo_slave_{name} {kind}\n");
        for slave in status.slaves.iter().filter(|slave| slave.presence.is_there()) {
            let _ = writeln!(
                text,
                "indigo_slave_{name}{{slave={},address={}}} {}",
                label(&slave.name),
                label(&slave.peer.to_string()),
                value(slave)
            );
        }
    };
    by_slave("samples_per_second", "gauge", "Samples rendered per second.", &|s| s.samples_per_second);
    by_slave("samples_total", "counter", "Samples added to the film.", &|s| s.samples as f64);
    by_slave("errors_total", "counter", "Uploads refused or broken off.", &|s| s.errors as f64);
    text
}

/// The value of a label, quoted.
fn label(value: &str) -> String {
    format!("\"{}\"", value.replace('\\', "\\\\").replace('"', "\\\"").replace('\n', "\\n"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::master::Presence;

    fn status() -> Status {
        let slave = |name: &str, presence| SlaveStatus {
            name: name.to_owned(),
            peer: ([10, 0, 0, 1], 4000).into(),
            threads: 8,
            presence,
            since: Duration::from_secs(90),
            samples: 1000,
            samples_per_second: 12.5,
            uploads: 2,
            last_upload: Some(Duration::from_millis(1500)),
            errors: 1,
            last_error: Some("an upload \"broke off\"".to_owned()),
        };
        Status {
            scene: "a \"b\".igs".to_owned(),
            size: [640, 480],
            samples: 5000,
            samples_per_pixel: 0.5,
            samples_per_second: f64::NAN,
            waiting: 70,
            elapsed: Duration::from_secs(100),
            rendered_s: 700.0,
            bytes_received: 12,
            refused: 3,
            present: 1,
            own: None,
            slaves: vec![slave("one", Presence::Rendering), slave("two", Presence::Left)],
        }
    }

    #[test]
    fn json_quotes_and_has_no_words_for_what_is_not_finite() {
        let json = json(&status(), 77);
        for part in [
            r#""scene":"a \"b\".igs""#,
            r#""samples":5000,"waiting_samples":70,"#,
            r#""samples_per_second":null"#,
            r#""picture":77"#,
            r#""state":"left""#,
            r#""last_upload_s":1.500"#,
            r#""last_error":"an upload \"broke off\"""#,
        ] {
            assert!(json.contains(part), "{part}: {json}");
        }
        assert_eq!(json.matches('{').count(), json.matches('}').count());
    }

    #[test]
    fn metrics_are_of_those_that_are_there() {
        let text = metrics(&status());
        assert!(text.contains("\nindigo_samples_total 5000\n"), "{text}");
        assert!(
            text.contains("indigo_slave_samples_per_second{slave=\"one\",address=\"10.0.0.1:4000\"} 12.5\n")
        );
        assert!(!text.contains("\"two\""));
        for line in text.lines().filter(|line| !line.starts_with('#')) {
            assert!(line.rsplit_once(' ').is_some_and(|(_, v)| v.parse::<f64>().is_ok()), "{line}");
        }
    }
}
