//! The run as a page: ratios to an earlier one, and how figures grow.

use std::fmt::Write;

use serde_json::Value;

use super::series::SERIES;
use super::{Earlier, Figure, about};
use crate::validate::page::escaped;

/// The style of the report of pictures.
const STYLE: &str = include_str!("../validate/page.css");
/// Size of a plot, and room for its labels, in pixels.
const PLOT: [f64; 2] = [320.0, 180.0];
const ROOM: [f64; 2] = [56.0, 28.0];

/// The whole page.
pub fn page(run: &Value, figures: &[Figure], earlier: Option<&Earlier>) -> String {
    let mut page = format!(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width\">\
         <meta name=\"color-scheme\" content=\"light dark\"><title>Indigo: benchmarks</title><style>{STYLE}</style></head><body><main>\
         <h1>How it scales on this machine</h1><p class=\"soft\">{}</p>",
        escaped(&about(run))
    );
    if let Some(earlier) = earlier {
        let _ = write!(
            page,
            "<p>Ratios are to “{}” ({}): how many times better this run is, be it more of a speed or less of anything else.</p>",
            escaped(&earlier.name),
            escaped(&earlier.about)
        );
    }
    // Ratios first.
    for group in figures.chunk_by(|a, b| a.series == b.series) {
        let _ =
            write!(page, "<h2>{}</h2><article>{}</article>", escaped(&heading(group)), table(group, earlier));
    }
    page + &plots(figures, earlier) + "</main></body></html>\n"
}

/// What a series is called.
fn heading(group: &[Figure]) -> String {
    let name = group[0].series.as_str();
    if SERIES.iter().any(|series| series.name == name) { format!("With {name}") } else { name.to_owned() }
}

/// How figures grow, of the series that make something larger.
fn plots(figures: &[Figure], earlier: Option<&Earlier>) -> String {
    let mut page = String::new();
    for series in SERIES {
        let own: Vec<&Figure> = figures.iter().filter(|figure| figure.series == series.name).collect();
        if own.is_empty() {
            continue;
        }
        let _ = write!(page, "<h2>By {}</h2><article><div class=\"pictures\">", series.axis);
        for name in series.figures {
            let points: Vec<[f64; 2]> =
                own.iter().filter(|f| f.name == *name).map(|f| [f.x, f.value]).collect();
            let then = own.iter().filter(|f| f.name == *name);
            let then = then.filter_map(|f| Some([f.x, earlier?.value(f)?])).collect::<Vec<_>>();
            let _ = write!(
                page,
                "<figure>{}<figcaption>{} by {}</figcaption></figure>",
                plot(&points, &then),
                words(name),
                series.axis
            );
        }
        page += "</div></article>";
    }
    page
}

fn words(figure: &str) -> String {
    let (name, unit) = match figure.rsplit_once('_') {
        Some((name, "s")) => (name, ", s"),
        Some((name, "mb")) => (name, ", MB"),
        _ => (figure, ""),
    };
    name.replace('_', " ") + unit
}

fn table(figures: &[Figure], earlier: Option<&Earlier>) -> String {
    let mut text = String::from(
        "<div class=\"scroll\"><table><tr><th class=\"number\">Ratio</th><th>Figure</th><th class=\"number\">At</th>\
         <th class=\"number\">Is</th><th class=\"number\">Least to most</th><th class=\"number\">Was</th></tr>",
    );
    for figure in figures {
        let then = earlier.and_then(|earlier| earlier.value(figure));
        let ratio = then.map_or_else(|| "–".to_owned(), |then| format!("{:.3}", figure.gain(then)));
        let spread = figure
            .spread
            .map_or_else(|| "–".to_owned(), |[least, most]| format!("{} to {}", short(least), short(most)));
        let then = then.map_or_else(|| "–".to_owned(), short);
        let _ = write!(
            text,
            "<tr><td class=\"number\">{ratio}</td><td>{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td>\
             <td class=\"number\">{spread}</td><td class=\"number\">{then}</td></tr>",
            escaped(&words(&figure.name)),
            short(figure.x),
            short(figure.value)
        );
    }
    text + "</table></div>"
}

/// Both axes logarithmic; what was is drawn thin.
fn plot(now: &[[f64; 2]], then: &[[f64; 2]]) -> String {
    let all: Vec<[f64; 2]> = [now, then].concat();
    let range = |axis: usize| {
        let values = all.iter().map(|p| p[axis].max(f64::MIN_POSITIVE).log10());
        let (low, high) = values.fold((f64::MAX, f64::MIN), |(low, high), v| (low.min(v), high.max(v)));
        // At least a factor of two, so that noise does not look like growth.
        let spare = (0.5 * (0.3 - (high - low))).max(0.05);
        [low - spare, high + spare]
    };
    let (x, y) = (range(0), range(1));
    let [width, height] = PLOT;
    let across = |v: f64| ROOM[0] + (v.log10() - x[0]) / (x[1] - x[0]) * (width - ROOM[0] - 20.0);
    let down = |v: f64| {
        let part = (v.max(f64::MIN_POSITIVE).log10() - y[0]) / (y[1] - y[0]);
        (1.0 - part) * (height - ROOM[1] - 8.0) + 8.0
    };
    let line = |points: &[[f64; 2]]| {
        let places: Vec<String> =
            points.iter().map(|p| format!("{:.1},{:.1}", across(p[0]), down(p[1]))).collect();
        places.join(" ")
    };
    let mut text = format!("<svg width=\"{width}\" height=\"{height}\" role=\"img\">");
    let base = height - ROOM[1];
    let _ = write!(
        text,
        "<line class=\"axis\" x1=\"{r}\" x2=\"{width}\" y1=\"{base}\" y2=\"{base}\"/>",
        r = ROOM[0]
    );
    let _ = write!(text, "<line class=\"axis\" x1=\"{r}\" x2=\"{r}\" y1=\"4\" y2=\"{base}\"/>", r = ROOM[0]);
    for p in now {
        let (px, py) = (across(p[0]), down(p[1]));
        let _ = write!(
            text,
            "<text x=\"{px:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>",
            base + 16.0,
            short(p[0])
        );
        let _ = write!(text, "<circle class=\"dot\" cx=\"{px:.1}\" cy=\"{py:.1}\" r=\"3\"/>");
    }
    for end in [y[0], y[1]] {
        let value = 10f64.powf(end);
        let _ = write!(
            text,
            "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
            ROOM[0] - 6.0,
            down(value) + 4.0,
            short(value)
        );
    }
    let _ = write!(text, "<polyline class=\"then\" points=\"{}\"/>", line(then));
    let _ = write!(text, "<polyline class=\"now\" points=\"{}\"/></svg>", line(now));
    text
}

/// Three digits, with k and M.
fn short(value: f64) -> String {
    let (scaled, unit) = match value.abs() {
        v if v >= 1e6 => (value / 1e6, "M"),
        v if v >= 1e4 => (value / 1e3, "k"),
        _ => (value, ""),
    };
    let digits =
        if scaled == 0.0 { 0 } else { (2 - scaled.abs().log10().floor() as i32).clamp(0, 5) as usize };
    let text = format!("{scaled:.digits$}");
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    format!("{text}{unit}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        assert_eq!(
            [short(1.0), short(0.012_34), short(131_072.0), short(2.1e6)],
            ["1", "0.0123", "131k", "2.1M"]
        );
    }

    #[test]
    fn a_plot_of_one_point_has_finite_places() {
        let text = plot(&[[1.0, 5.0]], &[]);
        assert!(!text.contains("NaN") && !text.contains("inf"));
    }

    #[test]
    fn ratios_come_before_plots_and_names_cannot_break_the_page() {
        let figure = |series: &str, x: f64| Figure {
            series: series.into(),
            x,
            name: "rays_per_second".into(),
            value: 1e6,
            spread: Some([0.5e6, 2e6]),
        };
        let figures = [figure("threads", 1.0), figure("<rays>", 0.0)];
        let text = page(&serde_json::json!({"version": "<b>"}), &figures, None);
        assert!(text.rfind("</table>") < text.find("<svg"), "tables first");
        assert!(!text.contains("<rays>") && !text.contains("<b>") && text.contains("500k to 2M"));
    }

    #[test]
    fn figures_are_words() {
        assert_eq!([words("first_pixel_s"), words("rays_per_second")], ["first pixel, s", "rays per second"]);
    }
}
