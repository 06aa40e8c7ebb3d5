//! What is checked: a scene, who renders it, and what its picture must be.

use super::console::Picture;
use super::statistics::{Comparison, Estimate, quantile, sidak};

/// Probability that any comparison of a run fails although nothing is wrong.
pub const FAMILY: f64 = 1e-3;
/// Relative difference that sums of single-precision numbers may make, and their storage in a file.
const ROUNDING: f64 = 1e-5;

/// Who renders a scene, and how.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Renderer {
    /// Path tracing.
    Path,
    /// Bidirectional path tracing.
    Bidirectional,
    /// Metropolis sampling of paths.
    PathMetropolis,
    /// Metropolis sampling of bidirectional path tracing.
    Metropolis,
    /// Direct light by samples of its own, the rest by Metropolis sampling.
    Hybrid,
    /// Mitsuba 3, of its own description of the scene.
    Mitsuba,
}

/// Path tracing alone.
pub const PATH: &[Renderer] = &[Renderer::Path];
/// The two techniques.
pub const TECHNIQUES: &[Renderer] = &[Renderer::Path, Renderer::Bidirectional];
/// The two techniques and a driver that correlates samples.
pub const THREE: &[Renderer] = &[Renderer::Path, Renderer::Bidirectional, Renderer::Metropolis];
/// All ways that Indigo renders.
pub const ALL: &[Renderer] = &[
    Renderer::Path,
    Renderer::Bidirectional,
    Renderer::PathMetropolis,
    Renderer::Metropolis,
    Renderer::Hybrid,
];

impl Renderer {
    /// As it is called in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Path => "path",
            Self::Bidirectional => "bidirectional",
            Self::PathMetropolis => "path, Metropolis",
            Self::Metropolis => "bidirectional, Metropolis",
            Self::Hybrid => "bidirectional, hybrid",
            Self::Mitsuba => "Mitsuba 3",
        }
    }

    /// Its part of a scene's settings.
    pub fn settings(self) -> String {
        let (bidirectional, metropolis, hybrid) = match self {
            Self::Path | Self::Mitsuba => (false, false, false),
            Self::Bidirectional => (true, false, false),
            Self::PathMetropolis => (false, true, false),
            Self::Metropolis => (true, true, false),
            Self::Hybrid => (true, true, true),
        };
        // That chains are cut short after many rejections is a bias, if a tiny one.
        format!(
            "<metropolis>{metropolis}</metropolis><bidirectional>{bidirectional}</bidirectional><hybrid>{hybrid}</hybrid>\
             <max_num_consec_rejections>1000000000</max_num_consec_rejections>"
        )
    }
}

/// A number made of a picture's mean X, Y, Z.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Luminance.
    Y,
    /// X over Y, which is x over y of the chromaticity.
    XOverY,
    /// Z over Y.
    ZOverY,
}

/// What a number must be.
#[derive(Clone, Debug)]
pub enum Target {
    /// A value, known to the uncertainty.
    Value(f64, f64),
    /// A value of another program's random samples.
    Sampled(Estimate),
    /// No more than this.
    AtMost(f64),
    /// What the first renderer of the check has, but for a share of it that a known difference of models explains.
    First(f64),
}

/// Columns x0 to x1 (excluded) and rows y0 to y1 of a picture.
pub type Area = [usize; 4];

/// One number of a check.
#[derive(Clone, Debug)]
pub struct Row {
    /// What it is; empty where the check has one only.
    pub what: String,
    /// Which number.
    pub quantity: Quantity,
    /// Of which part of the picture; all without.
    pub area: Option<Area>,
    /// What it must be.
    pub target: Target,
}

/// A scene and what must be seen in it.
#[derive(Clone, Debug)]
pub struct Check {
    /// The chapter of the report.
    pub group: &'static str,
    /// A few words.
    pub name: String,
    /// What is expected, and by which formula or source.
    pub about: String,
    /// The scene; it holds `text::settings`, of which the technique is replaced.
    pub scene: String,
    /// Files that it names.
    pub files: Vec<(String, Vec<u8>)>,
    /// The scene as Mitsuba's dictionary.
    pub mitsuba: Option<serde_json::Value>,
    /// Luminance in cd/m² of one unit of the numbers.
    pub unit: f64,
    /// Who renders it; others are compared with the first, pixel by pixel.
    pub renderers: Vec<Renderer>,
    /// Samples per pixel of each render by path tracing.
    pub samples: u32,
    /// The numbers.
    pub rows: Vec<Row>,
    /// A deviation of this share of the value must be seen, or the check fails for its noise.
    pub resolution: f64,
    /// Whether every pixel should have the value of the first row: the report then draws how far each is from it.
    pub is_flat: bool,
    /// Rendered in the full run only.
    pub full_only: bool,
}

impl Check {
    /// One number of the whole picture, by some renderers, that must resolve half a percent.
    pub fn new(
        group: &'static str,
        name: impl Into<String>,
        about: impl Into<String>,
        scene: String,
    ) -> Self {
        Self {
            group,
            name: name.into(),
            about: about.into(),
            scene,
            files: vec![],
            mitsuba: None,
            unit: 1.0,
            renderers: THREE.to_vec(),
            samples: 256,
            rows: vec![],
            resolution: 5e-3,
            is_flat: false,
            full_only: false,
        }
    }

    /// Expects a luminance of the whole picture, known to an uncertainty.
    #[must_use]
    pub fn is(self, value: f64, uncertainty: f64) -> Self {
        self.row("", Quantity::Y, None, Target::Value(value, uncertainty))
    }

    /// Expects one more number.
    #[must_use]
    pub fn row(mut self, what: &str, quantity: Quantity, area: Option<Area>, target: Target) -> Self {
        self.rows.push(Row { what: what.to_owned(), quantity, area, target });
        self
    }

    /// In another unit.
    #[must_use]
    pub fn unit(self, unit: f64) -> Self {
        Self { unit, ..self }
    }

    /// Rendered by these.
    #[must_use]
    pub fn by(self, renderers: &[Renderer]) -> Self {
        Self { renderers: renderers.to_vec(), ..self }
    }

    /// With so many samples per pixel, of which a deviation of a share must be seen.
    #[must_use]
    pub fn effort(self, samples: u32, resolution: f64) -> Self {
        Self { samples, resolution, ..self }
    }

    /// With the same value in every pixel.
    #[must_use]
    pub fn flat(self) -> Self {
        Self { is_flat: true, ..self }
    }

    /// A name for its files.
    pub fn slug(&self) -> String {
        let words = format!("{} {}", self.group, self.name).to_lowercase();
        let plain: String = words.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).collect();
        plain.split('-').filter(|part| !part.is_empty()).collect::<Vec<_>>().join("-")
    }

    /// How many comparisons it makes.
    pub fn comparisons(&self) -> usize {
        let against_first = usize::from(self.is_against_first());
        self.rows.len() * (self.renderers.len() - against_first)
            + (self.renderers.len() - 1) * usize::from(self.compares_pictures())
    }

    fn is_against_first(&self) -> bool {
        self.rows.iter().any(|row| matches!(row.target, Target::First(_)))
    }

    /// Whether pictures of several ways of rendering are compared by blocks.
    pub fn compares_pictures(&self) -> bool {
        self.renderers[0] != Renderer::Mitsuba && self.renderers.len() > 1
    }
}

/// What one comparison said.
#[derive(Clone, Debug)]
pub struct Verdict {
    /// Who rendered.
    pub renderer: Renderer,
    /// Which number.
    pub what: String,
    /// What was expected, with what it is known to.
    pub expected: Estimate,
    /// Whether less is as good.
    pub is_bound: bool,
    /// What came out.
    pub measured: Estimate,
    /// The test.
    pub comparison: Comparison,
    /// What a right renderer may deviate by: what the value is known to, and rounding.
    pub allowance: f64,
    /// The share of the value that a deviation must have to be seen.
    pub resolution: f64,
    /// The p-value below which it fails.
    pub threshold: f64,
    /// Why it failed, if it did.
    pub failure: Option<String>,
}

/// Judges all renders of a check: for each renderer the pictures of its seeds.
pub fn judge(check: &Check, renders: &[Vec<Picture>], comparisons: usize) -> Vec<Verdict> {
    let threshold = sidak(FAMILY, comparisons);
    let mut verdicts = vec![];
    for (i, renderer) in check.renderers.iter().enumerate() {
        for row in &check.rows {
            if matches!(row.target, Target::First(_)) && i == 0 {
                continue;
            }
            verdicts.push(judge_row(check, row, *renderer, renders, i, threshold));
        }
        if i > 0 && check.compares_pictures() {
            verdicts.push(judge_blocks(check, *renderer, &renders[0], &renders[i], threshold));
        }
    }
    verdicts
}

fn judge_row(
    check: &Check,
    row: &Row,
    renderer: Renderer,
    renders: &[Vec<Picture>],
    i: usize,
    threshold: f64,
) -> Verdict {
    let measure = |pictures: &[Picture]| {
        let values: Vec<f64> = pictures.iter().map(|p| p.value(row.quantity, row.area, check.unit)).collect();
        Estimate::of(&values)
    };
    let measured = measure(&renders[i]);
    let (expected, uncertainty) = match row.target {
        Target::Value(value, uncertainty) => (Estimate::exact(value), uncertainty),
        Target::AtMost(value) => (Estimate::exact(value), 0.0),
        Target::Sampled(estimate) => (estimate, 0.0),
        Target::First(slack) => {
            let first = measure(&renders[0]);
            (first, slack * first.mean.abs())
        }
    };
    let allowance = uncertainty + ROUNDING * expected.mean.abs().max(measured.mean.abs());
    let is_bound = matches!(row.target, Target::AtMost(_));
    let mut comparison = Comparison::of(&measured, &expected, allowance);
    if is_bound && measured.mean <= expected.mean {
        comparison = Comparison { t: comparison.t.min(0.0), p: 1.0, ..comparison };
    }
    let scale = if expected.mean == 0.0 { check.unit } else { expected.mean.abs() };
    // What is granted is not noticed.
    let resolution = (quantile(threshold, comparison.freedom) * comparison.error + allowance) / scale;
    let mut failure = None;
    if comparison.p < threshold {
        failure = Some("deviates".to_owned());
    } else if resolution > check.resolution {
        failure = Some("too noisy to tell".to_owned());
    }
    let what = row.what.clone();
    Verdict {
        renderer,
        what,
        expected,
        is_bound,
        measured,
        comparison,
        allowance,
        resolution,
        threshold,
        failure,
    }
}

/// Blocks along a side of a picture.
pub const BLOCKS: usize = 4;

/// The most surprising of all blocks and of X, Y and Z, as if it were one test (Šidák).
fn judge_blocks(
    check: &Check,
    renderer: Renderer,
    first: &[Picture],
    own: &[Picture],
    threshold: f64,
) -> Verdict {
    let [width, height] = first[0].size;
    let cut = |i: usize, n: usize| i * n / BLOCKS;
    let mut worst: Option<(Estimate, Estimate, Comparison)> = None;
    let mut resolutions = vec![];
    for block in 0..BLOCKS * BLOCKS {
        let (x, y) = (block % BLOCKS, block / BLOCKS);
        let area = [cut(x, width), cut(x + 1, width), cut(y, height), cut(y + 1, height)];
        for c in 0..3 {
            let measure = |pictures: &[Picture]| {
                Estimate::of(&pictures.iter().map(|p| p.mean(Some(area))[c] / check.unit).collect::<Vec<_>>())
            };
            let (a, b) = (measure(own), measure(first));
            let comparison = Comparison::of(&a, &b, ROUNDING * a.mean.abs().max(b.mean.abs()));
            resolutions.push(comparison.error / b.mean.abs());
            if worst.as_ref().is_none_or(|(.., w)| comparison.p < w.p) {
                worst = Some((a, b, comparison));
            }
        }
    }
    let tests = BLOCKS * BLOCKS * 3;
    let (measured, expected, mut comparison) = worst.expect("there are blocks");
    comparison.p = -((-comparison.p).ln_1p() * tests as f64).exp_m1();
    resolutions.sort_by(f64::total_cmp);
    let failure = (comparison.p < threshold).then(|| "a block deviates".to_owned());
    Verdict {
        renderer,
        what: format!("worst of {tests} block means"),
        expected,
        is_bound: false,
        measured,
        comparison,
        allowance: ROUNDING * expected.mean.abs(),
        resolution: resolutions[tests / 2] * quantile(sidak(threshold, tests), comparison.freedom),
        threshold,
        failure,
    }
}
