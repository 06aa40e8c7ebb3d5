//! The report as one page of HTML that needs no other file.

use std::fmt::Write;

use super::check::{Area, Check, Form, Renderer, Target};
use super::images::{DEEPEST, Other, deviations, difference, tone_mapped, white};
use super::judge::Verdict;
use super::report::{Checked, Report, sentence};
use crate::here;

/// Style sheet, light and dark.
const STYLE: &str = include_str!("page.css");
/// Size of the drawing of an interval, in pixels.
const INTERVAL: [f64; 2] = [132.0, 18.0];

/// The whole page.
pub fn page(report: &Report) -> String {
    let mut page = format!(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width\">\
         <meta name=\"color-scheme\" content=\"light dark\"><title>Indigo: validation</title><style>{STYLE}</style></head><body><main>"
    );
    page += &head(report);
    page += &summary(report);
    page += &failed(report);
    for (name, list) in report.groups() {
        let _ = write!(page, "<h2 id=\"{}\">{name}</h2>", anchor(name));
        for checked in list {
            page += &article(checked);
        }
    }
    page + "</main></body></html>\n"
}

fn head(report: &Report) -> String {
    let (count, failed) = (report.verdicts().count(), report.failures().count());
    let said = match (failed, report.broken().count()) {
        (0, 0) => format!("<span class=\"verdict pass\">all {count} comparisons of these checks pass</span>"),
        (_, 0) => format!("<span class=\"verdict fail\">{failed} of {count} comparisons fail</span>"),
        (_, broken) => format!(
            "<span class=\"verdict fail\">{failed} of {count} comparisons fail, {broken} checks were not rendered</span>"
        ),
    };
    let form = match report.form {
        Form::Quick => {
            "This is the quick form, whose demands are looser: half a percent of a region beside another renderer is asked of the full form alone."
        }
        Form::Full => "This is the full form.",
    };
    format!(
        "<h1>Do the pictures come out true?</h1><p class=\"lead\">{} {said}</p>\
         <p>Each picture was rendered {} times with independent random numbers; numbers are means, and intervals hold 95 % of them \
         by Student’s t. A comparison fails when its deviation is so unlikely that a right renderer would fail anywhere in this report \
         with a probability of {} (Šidák), or when noise hides deviations that it must show, beyond what is known of the noise (it is unresolved). The band in each drawing is what \
         a comparison would have noticed in half of all runs, were it the true deviation: nearly always from one and a half times as much on. {form}</p>\
         <p>Beside a picture is its difference from the value it must have, or from the first picture, in standard errors of each pixel, or \
         where it must be uneven in those of each area of which a value is known; of several pictures that are compared with one another the \
         first has none: \
         <span class=\"key\"></span> −{DEEPEST} to +{DEEPEST}; pixels that hold no numbers are magenta.</p>\
         <p class=\"soft\">{}{} · {} · {} · {:.0} s · <code>{}</code></p>",
        escaped(&sentence_case(&report.extent)),
        report.form.seeds(),
        report.family,
        escaped(&report.version),
        report.peer.as_ref().map(|peer| format!(" · beside {}", escaped(peer))).unwrap_or_default(),
        escaped(&report.date),
        escaped(&here::in_words(&report.machine)),
        report.seconds,
        escaped(&report.command)
    )
}

fn summary(report: &Report) -> String {
    let mut table = String::from(
        "<div class=\"scroll\"><table><tr><th>Chapter</th><th class=\"number\">Checks</th><th class=\"number\">Comparisons</th>\
         <th class=\"number\">Least p</th><th class=\"number\">Median of what would be noticed</th><th></th></tr>",
    );
    for (name, list) in report.groups() {
        let verdicts: Vec<&Verdict> = list.iter().flat_map(|c| &c.verdicts).collect();
        let mut resolutions: Vec<f64> = verdicts.iter().map(|v| v.resolution).collect();
        resolutions.sort_by(f64::total_cmp);
        let least = verdicts.iter().map(|v| v.comparison.p).fold(1.0, f64::min);
        let failed = list.iter().map(|checked| checked.failures()).sum();
        let _ = write!(
            table,
            "<tr><td><a href=\"#{}\">{name}</a></td><td class=\"number\">{}</td><td class=\"number\">{}</td>\
             <td class=\"number\">{}</td><td class=\"number\">{} %</td><td>{}</td></tr>",
            anchor(name),
            list.len(),
            verdicts.len(),
            probability(least),
            two_digits(100.0 * resolutions.get(resolutions.len() / 2).copied().unwrap_or(f64::NAN)),
            badge(failed)
        );
    }
    table + "</table></div>"
}

/// What failed, in words, with the way there.
fn failed(report: &Report) -> String {
    let failures = report.failures().map(|(check, verdict)| (check, sentence(check, verdict)));
    let broken =
        report.broken().map(|(check, _)| (check, format!("{}: {}: not rendered", check.group, check.name)));
    let line = |(check, words): (&Check, String)| {
        format!("<li><a href=\"#{}\">{}</a></li>", check.slug(), escaped(&words))
    };
    let list: String = failures.chain(broken).map(line).collect();
    if list.is_empty() { list } else { format!("<h2>What failed</h2><ul>{list}</ul>") }
}

fn badge(failed: usize) -> String {
    match failed {
        0 => "<span class=\"verdict pass\">pass</span>".to_owned(),
        n => format!("<span class=\"verdict fail\">{n} failed</span>"),
    }
}

fn article(checked: &Checked) -> String {
    let check = &checked.check;
    let mut text = format!(
        "<article id=\"{}\"><header><h3>{}</h3>{}</header><p class=\"soft\">{}</p>",
        check.slug(),
        escaped(&check.name),
        badge(checked.failures()),
        escaped(&check.about)
    );
    if let Some(error) = &checked.broken {
        let _ = write!(text, "<pre>{}</pre></article>", escaped(error));
        return text;
    }
    if checked.renders.is_empty() {
        return text + &verdicts(checked);
    }
    let longer = check.longer.iter().map(|(who, times)| format!(", {} {times} times as many", who.name()));
    let longer = longer.collect::<String>();
    let _ = write!(
        text,
        "<p class=\"soft\">{} samples a pixel in each render{longer}; must show {} %, in blocks {} %.</p>",
        checked.demand.samples,
        two_digits(100.0 * checked.demand.resolution),
        two_digits(100.0 * checked.demand.blocks)
    );
    text + &pictures(checked) + &verdicts(checked)
}

/// The table of a check's comparisons.
fn verdicts(checked: &Checked) -> String {
    let mut text = String::from(
        "<div class=\"scroll\"><table><tr><th>Rendered by</th><th></th><th class=\"number\">Must be</th><th class=\"number\">Is</th>\
             <th class=\"number\">Deviation</th><th></th><th class=\"number\">Standard errors</th><th class=\"number\">p</th><th></th></tr>",
    );
    let mut last = None;
    for verdict in &checked.verdicts {
        let name = if last == Some(verdict.renderer) { "" } else { verdict.renderer.name() };
        text += &row(verdict, name);
        last = Some(verdict.renderer);
    }
    text + "</table></div></article>"
}

fn pictures(checked: &Checked) -> String {
    let white = white(&checked.renders[0]);
    let mut text = String::from("<div class=\"pictures\">");
    for (i, renderer) in checked.check.renderers.iter().enumerate() {
        text += &figure(checked, *renderer, i, white);
    }
    text + "</div>"
}

fn figure(checked: &Checked, renderer: Renderer, i: usize, white: f64) -> String {
    let (check, renders) = (&checked.check, &checked.renders);
    let other = match check.rows.first().map(|row| &row.target) {
        Some(Target::Value(value, _)) if check.is_flat => Some(Other::Value(value * check.unit)),
        _ if i > 0 => Some(Other::Pictures(&renders[0])),
        _ => None,
    };
    let name = renderer.name();
    let picture = |alt: &str, source: &str| format!("<img alt=\"{alt}{name}\" src=\"{source}\">");
    let shown = picture("", &tone_mapped(&renders[i], white));
    let beside = match other {
        Some(other) => Some(difference(&renders[i], &other)),
        // What pixels must have is not known where a picture is uneven: the areas that have a number are shown.
        None => by_area(checked, renderer, renders[i][0].size),
    };
    let beside = beside.map(|map| picture("difference of ", &map));
    format!(
        "<figure><div class=\"pair\">{shown}{}</div><figcaption>{name}</figcaption></figure>",
        beside.unwrap_or_default()
    )
}

/// The areas of which a luminance is known, each in the colour of its deviation.
fn by_area(checked: &Checked, renderer: Renderer, size: [usize; 2]) -> Option<String> {
    let areas: Vec<(Area, f64)> = checked
        .verdicts
        .iter()
        .filter(|verdict| verdict.renderer == renderer)
        .filter_map(|verdict| Some((verdict.area?, verdict.comparison.t)))
        .collect();
    (!areas.is_empty()).then(|| deviations(size, &areas))
}

fn row(verdict: &Verdict, name: &str) -> String {
    let (m, e) = (&verdict.measured, &verdict.expected);
    let half = m.half_interval();
    let deviation = if e.mean == 0.0 { f64::NAN } else { m.mean / e.mean - 1.0 };
    let must = match (verdict.is_bound, e.error > 0.0) {
        (true, _) => format!("≤ {}", number(e.mean)),
        (_, true) => format!("{} <small>± {}</small>", number(e.mean), short(e.half_interval())),
        _ => number(e.mean),
    };
    let said = match &verdict.failure {
        None => "<span class=\"verdict pass\">pass</span>".to_owned(),
        Some(reason) => format!("<span class=\"verdict fail\">{}</span>", reason.words()),
    };
    format!(
        "<tr><td>{}</td><td>{}</td><td class=\"number\">{must}</td><td class=\"number\">{} <small>± {}</small></td>\
         <td class=\"number\">{}</td><td>{}</td><td class=\"number\">{:+.1}</td><td class=\"number\">{}</td><td>{said}</td></tr>",
        name,
        escaped(&verdict.what),
        number(m.mean),
        short(half),
        if deviation.is_nan() {
            "–".to_owned()
        } else {
            format!("{:+.3} %", 100.0 * deviation).replace('-', "−")
        },
        interval(verdict, half),
        verdict.comparison.t,
        probability(verdict.comparison.p)
    )
}

/// The estimate's interval about the expected value, with what would have been noticed as a band: the drawing spans
/// four times the band.
fn interval(verdict: &Verdict, half: f64) -> String {
    let [width, height] = INTERVAL;
    let (m, e) = (&verdict.measured, &verdict.expected);
    // What is 0 has no share: the band is then of what was measured.
    let size = if e.mean == 0.0 { m.mean.abs().max(half) } else { e.mean.abs() };
    let noticed = size * verdict.resolution.max(1e-5);
    let at = |v: f64| {
        let place = (v - e.mean) / noticed * 0.25 * width;
        if place.is_nan() { 0.5 * width } else { (place + 0.5 * width).clamp(2.0, width - 2.0) }
    };
    let middle = 0.5 * height;
    let class = if verdict.failure.is_some() { "interval off" } else { "interval" };
    format!(
        "<svg class=\"{class}\" width=\"{width}\" height=\"{height}\" role=\"img\" aria-label=\"interval\">\
         <rect class=\"band\" x=\"{:.1}\" y=\"3\" width=\"{:.1}\" height=\"{}\" rx=\"2\"/>\
         <line class=\"axis\" x1=\"{c}\" x2=\"{c}\" y1=\"1\" y2=\"{}\"/>\
         <line class=\"whisker\" x1=\"{:.1}\" x2=\"{:.1}\" y1=\"{middle}\" y2=\"{middle}\"/>\
         <circle class=\"dot\" cx=\"{:.1}\" cy=\"{middle}\" r=\"3\"/></svg>",
        0.25 * width,
        0.5 * width,
        height - 6.0,
        height - 1.0,
        at(m.mean - half),
        at(m.mean + half),
        at(m.mean),
        c = 0.5 * width
    )
}

/// Six digits.
fn number(value: f64) -> String {
    match value.abs() {
        0.0 => "0".to_owned(),
        v if !(1e-3..1e6).contains(&v) => format!("{value:.4e}"),
        v => {
            let digits = (5 - v.log10().floor() as i32).max(0) as usize;
            format!("{value:.digits$}")
        }
    }
}

/// Two digits.
fn short(value: f64) -> String {
    if value == 0.0 { "0".to_owned() } else { format!("{value:.1e}") }
}

/// Two digits that count, written out.
fn two_digits(value: f64) -> String {
    let digits = if value > 0.0 { (1 - value.log10().floor() as i32).max(0) as usize } else { 0 };
    format!("{value:.digits$}")
}

fn probability(p: f64) -> String {
    if p < 1e-3 { format!("{p:.0e}") } else { format!("{p:.3}") }
}

fn anchor(name: &str) -> String {
    name.to_lowercase().replace(' ', "-")
}

/// As a sentence: a capital, and a full stop.
fn sentence_case(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(|letter| letter.to_uppercase().to_string());
    first.unwrap_or_default() + letters.as_str() + "."
}

/// Text that cannot break the page.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_six_digits_and_errors_two() {
        assert_eq!(number(0.414_947_6), "0.414948");
        assert_eq!(number(13_926.057_5), "13926.1");
        assert_eq!(number(6.254_62e10), "6.2546e10");
        assert_eq!(short(0.000_123), "1.2e-4");
        assert_eq!(probability(0.5), "0.500");
    }

    #[test]
    fn text_cannot_break_the_page() {
        assert_eq!(escaped("a < b & c"), "a &lt; b &amp; c");
    }
}
