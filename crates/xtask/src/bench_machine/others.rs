//! Figures of the benchmarks that are programs of their own: rays against Embree, and each way of rendering at equal time.

use super::Figure;
use crate::bench_rays;
use crate::process::{capture, cargo};

/// A benchmark by name.
pub struct Other {
    /// A word.
    pub name: &'static str,
    /// Runs it and gives back what it says.
    run: fn() -> Result<Vec<u8>, String>,
}

/// All of them.
pub const OTHERS: &[Other] = &[
    Other { name: "rays", run: || capture(bench_rays::command()?.args(["--figures", "--reps", "5"])) },
    Other { name: "transport", run: transport },
];

/// Seconds of each mode on each scene, and of references that are not kept yet: a quarter of an hour in all, twice
/// that the first time.
fn transport() -> Result<Vec<u8>, String> {
    let bench = ["bench", "--package", "indigo-render", "--bench", "transport", "--", "--figures"];
    capture(cargo(&bench).args(["--seconds", "10", "--reference", "90"]))
}

impl Other {
    /// Its figures.
    ///
    /// # Errors
    /// That it could not be run, or told nothing.
    pub fn measure(&self) -> Result<Vec<Figure>, String> {
        println!("  {}", self.name);
        let figures = told(&String::from_utf8_lossy(&(self.run)()?));
        if figures.is_empty() {
            Err(format!("the benchmark {} tells no figures", self.name))
        } else {
            Ok(figures)
        }
    }
}

/// The figures in what a benchmark says: `figure`, series, name and value between tabs.
fn told(text: &str) -> Vec<Figure> {
    let figure = |line: &str| {
        let [series, name, value] =
            line.strip_prefix("figure\t")?.split('\t').collect::<Vec<_>>().try_into().ok()?;
        Some(Figure {
            series: series.to_owned(),
            x: 0.0,
            name: name.to_owned(),
            value: value.parse().ok()?,
            spread: None,
        })
    };
    // An error that the reference's own noise swallows is no figure to compare with.
    text.lines().filter_map(figure).filter(|figure| figure.value > 0.0).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_are_told_between_other_lines() {
        let text = "room (10 s a mode)\nfigure\ttransport, room\tpath: rays per second\t2.5e6\npath  1 2\nfigure\tx\n";
        let wanted = Figure {
            series: "transport, room".into(),
            x: 0.0,
            name: "path: rays per second".into(),
            value: 2.5e6,
            spread: None,
        };
        assert_eq!(told(text), [wanted]);
    }
}
