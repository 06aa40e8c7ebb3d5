//! What is checked: a scene, who renders it, and what its picture must be.

use super::statistics::Estimate;

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
    /// Direct light by samples of its own, and the rest by Metropolis sampling, of bidirectional path tracing.
    Hybrid,
    /// Mitsuba 3, of its own description of the scene.
    Mitsuba,
    /// Direct light by samples of its own, and the rest by Metropolis sampling, of paths alone.
    PathHybrid,
    /// Nothing set: as the console renders a scene that says nothing, on two threads.
    AsItComes,
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
    Renderer::PathHybrid,
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
            Self::PathHybrid => "path, hybrid",
            Self::Hybrid => "bidirectional, hybrid",
            Self::Mitsuba => "Mitsuba 3",
            Self::AsItComes => "as it comes",
        }
    }

    /// On how many threads: several pictures are rendered at once.
    pub fn threads(self) -> u32 {
        if self == Self::AsItComes { 2 } else { 1 }
    }

    /// Its part of a scene's settings.
    pub fn settings(self) -> String {
        let (bidirectional, metropolis, hybrid) = match self {
            Self::AsItComes => return String::new(),
            Self::Path | Self::Mitsuba => (false, false, false),
            Self::Bidirectional => (true, false, false),
            Self::PathMetropolis => (false, true, false),
            Self::Metropolis => (true, true, false),
            Self::PathHybrid => (false, true, true),
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
    /// Which share of it must be seen, where that is not the check's.
    pub demand: Option<f64>,
}

/// How finely a picture is rendered, and what must be seen in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Demand {
    /// Samples per pixel of each render, but by those who take [longer](Check::longer).
    pub samples: u32,
    /// A deviation of this share of a number must be seen, or the number is unresolved, which fails where it is so beyond the
    /// error of the standard error.
    pub resolution: f64,
    /// A deviation of this share of its value must be seen in half of the blocks where blocks are compared.
    pub blocks: f64,
}

/// How much of it all is rendered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// For after a change: minutes.
    Quick,
    /// For before a release: hours.
    Full,
}

impl Form {
    /// Independent renders of each picture.
    pub fn seeds(self) -> usize {
        match self {
            Self::Quick => 16,
            Self::Full => 64,
        }
    }

    /// What it asks of a check.
    pub fn demand(self, check: &Check) -> Demand {
        match self {
            Self::Quick => check.quick,
            Self::Full => check.full,
        }
    }
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
    /// The numbers.
    pub rows: Vec<Row>,
    /// Who takes how many times as many samples as the others, who need fewer to show as much.
    pub longer: Vec<(Renderer, u32)>,
    /// What the quick form renders, and must show.
    pub quick: Demand,
    /// What the full form does.
    pub full: Demand,
    /// What a luminance of 1 cd/m² is on a screen whose white is 1, where the codes of the PNG are to be judged.
    pub screen: Option<f64>,
    /// Whether each part of the picture should have the value of the first row.
    pub is_flat: bool,
    /// Rendered in the full run only.
    pub full_only: bool,
}

impl Check {
    /// One number of the whole picture, by some renderers, of which half a percent must be seen.
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
            rows: vec![],
            longer: vec![],
            quick: Demand { samples: 128, resolution: 5e-3, blocks: 0.2 },
            full: Demand { samples: 256, resolution: 5e-3, blocks: 0.2 },
            screen: None,
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
        self.rows.push(Row { what: what.to_owned(), quantity, area, target, demand: None });
        self
    }

    /// Asks more of the last number than of the others: a deviation of this share must be seen.
    #[must_use]
    pub fn finely(mut self, resolution: f64) -> Self {
        self.rows.iter_mut().rev().take(1).for_each(|row| row.demand = Some(resolution));
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
        let of = |demand: Demand| Demand { samples, resolution, ..demand };
        Self { quick: of(self.quick), full: of(self.full), ..self }
    }

    /// With fewer samples in the quick form, where they show enough.
    #[must_use]
    pub fn quickly(self, samples: u32) -> Self {
        Self { quick: Demand { samples, ..self.quick }, ..self }
    }

    /// With so many times the samples for one of those who render it.
    #[must_use]
    pub fn longer(mut self, renderer: Renderer, times: u32) -> Self {
        self.longer.push((renderer, times));
        self
    }

    /// Samples per pixel of each render by one of them.
    pub fn samples(&self, form: Form, renderer: Renderer) -> u32 {
        let times = self.longer.iter().find(|(longer, _)| *longer == renderer).map_or(1, |(_, times)| *times);
        form.demand(self).samples * times
    }

    /// With other samples and another demand in the full form.
    #[must_use]
    pub fn in_full(self, samples: u32, resolution: f64) -> Self {
        Self { full: Demand { samples, resolution, ..self.full }, ..self }
    }

    /// With shares that must be seen in half of the blocks, in the quick form and in the full one.
    #[must_use]
    pub fn blocks(mut self, quick: f64, full: f64) -> Self {
        (self.quick.blocks, self.full.blocks) = (quick, full);
        self
    }

    /// With the same value everywhere in the picture.
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
            + self.renderers.len() * (usize::from(self.is_flat) + usize::from(self.screen.is_some()))
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
