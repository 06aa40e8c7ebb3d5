//! Layers: sums over samples that each know their own normalisation.

/// How the sums of a layer become radiance. No caller ever passes a scale.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LayerKind {
    /// Camera samples, each of which belongs to one pixel: pixel = sum / the pixel's own number
    /// of samples.
    PerPixel,
    /// Splats, which fall anywhere: pixel = sum · internal pixels / number of samples.
    ///
    /// A sample is one draw of the technique: a light path, or one mutation of a Markov chain.
    /// Metropolis splats are f / target, without the brightness constant b; once a layer has
    /// brightness estimates, its pixels are multiplied by their mean, b = b_sum / b_count, when the
    /// film is developed. So b improves for ever, and merged runs stay right.
    PerScreen,
}

/// What a layer counts for the film as a whole.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Totals {
    /// Camera samples of a per-pixel layer (counted by the film itself), or draws of a
    /// per-screen layer.
    pub n_samples: f64,
    /// Draws of a Markov chain that had found no light yet: they show nothing, not even darkness, and its sums are not
    /// divided by them.
    pub n_idle: f64,
    /// Sum of the estimates of the Metropolis brightness constant (cd/m²).
    pub b_sum: f64,
    /// Number of the estimates of the Metropolis brightness constant; 0 in any other layer.
    pub b_count: f64,
}

impl Totals {
    /// Adds what another film of the same layer counted.
    pub(crate) fn add(&mut self, other: &Self) {
        self.n_samples += other.n_samples;
        self.n_idle += other.n_idle;
        self.b_sum += other.b_sum;
        self.b_count += other.b_count;
    }

    /// Whether its draws are a Markov chain's: no other layer has brightness estimates.
    fn is_chain(&self) -> bool {
        self.b_count > 0.0
    }

    /// The draws of a film with layers of these totals.
    ///
    /// A chain's mutations are draws of their own, and add to the others. Otherwise layers count what one and the same
    /// draws did (a camera path and the light path drawn with it, or direct and indirect light, fill two layers): the
    /// largest count is theirs.
    pub(crate) fn draws<'a>(layers: impl Iterator<Item = &'a Self>) -> f64 {
        let (mut shared, mut chains) = (0.0_f64, 0.0_f64);
        for totals in layers {
            if totals.is_chain() {
                chains = chains.max(totals.n_samples + totals.n_idle);
            } else {
                shared = shared.max(totals.n_samples);
            }
        }
        shared + chains
    }

    /// The factor by which a per-screen layer's sums become radiance.
    pub(crate) fn screen_scale(&self, internal_pixels: usize) -> f64 {
        if self.n_samples <= 0.0 {
            return 0.0;
        }
        let brightness = if self.b_count > 0.0 { self.b_sum / self.b_count } else { 1.0 };
        brightness * internal_pixels as f64 / self.n_samples
    }
}

/// One layer of a film as plain data.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// Its normalisation.
    pub kind: LayerKind,
    /// Its name: layers of two films merge only where kinds and names agree.
    pub name: String,
    /// Sums of X, Y, Z (cd/m²) and alpha, one per internal pixel, rows from top to bottom.
    pub sums: Vec<[f64; 4]>,
    /// Number of samples of each internal pixel; empty in a per-screen layer.
    pub counts: Vec<f64>,
    /// What the layer counts for the film as a whole.
    pub totals: Totals,
}

impl Layer {
    /// A layer of that many internal pixels without samples.
    pub(crate) fn new(kind: LayerKind, name: &str, pixels: usize) -> Self {
        Self {
            kind,
            name: name.to_owned(),
            sums: vec![[0.0; 4]; pixels],
            counts: vec![0.0; kind.count_slots(pixels)],
            totals: Totals::default(),
        }
    }
}

impl LayerKind {
    /// Bytes of the sums, and of the count if there is one, of a pixel.
    pub(crate) fn pixel_bytes(self) -> usize {
        size_of::<[f64; 4]>() + self.count_slots(1) * size_of::<f64>()
    }

    /// How many of `pixels` pixels need a sample count of their own.
    pub(crate) fn count_slots(self, pixels: usize) -> usize {
        match self {
            Self::PerPixel => pixels,
            Self::PerScreen => 0,
        }
    }
}
