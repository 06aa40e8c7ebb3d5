//! The fast Fourier transform of Cooley & Tukey (1965) for lengths that are powers of two: all that
//! drawings of apertures need.

// tidy: load-time mathematics

/// Real and imaginary part.
pub(super) type Complex = [f32; 2];

/// A plan for one length.
pub(super) struct Transform {
    /// exp(-2πi k / length) for the first half of a turn.
    roots: Vec<Complex>,
}

impl Transform {
    /// For a length that is a power of two, and at least 2.
    pub fn new(length: usize) -> Self {
        let root = |k: usize| {
            let (s, c) = (-std::f64::consts::TAU * k as f64 / length as f64).sin_cos();
            [c as f32, s as f32]
        };
        Self { roots: (0..length / 2).map(root).collect() }
    }

    /// Transforms a sequence of the plan's length in place.
    pub fn process(&self, data: &mut [Complex]) {
        let length = 2 * self.roots.len();
        reorder(&mut data[..length]);
        let mut half = 1;
        while half < length {
            let stride = self.roots.len() / half;
            for block in data.chunks_exact_mut(2 * half) {
                let (first, second) = block.split_at_mut(half);
                for ((a, b), w) in first.iter_mut().zip(second).zip(self.roots.iter().step_by(stride)) {
                    let turned = [b[0] * w[0] - b[1] * w[1], b[0] * w[1] + b[1] * w[0]];
                    (*a, *b) = ([a[0] + turned[0], a[1] + turned[1]], [a[0] - turned[0], a[1] - turned[1]]);
                }
            }
            half *= 2;
        }
    }
}

/// Puts each item where its index read from the other end of its bits says.
fn reorder(data: &mut [Complex]) {
    let shift = usize::BITS - data.len().trailing_zeros();
    for i in 0..data.len() {
        let j = i.reverse_bits() >> shift;
        if i < j {
            data.swap(i, j);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_the_sum_that_defines_it() {
        for length in [2usize, 4, 64, 512] {
            let value = |i: usize| [((i * 7) % 5) as f32 - 2.0, ((i * 3) % 7) as f32 - 3.0];
            let mut data: Vec<Complex> = (0..length).map(value).collect();
            Transform::new(length).process(&mut data);
            for (k, got) in data.iter().enumerate() {
                let mut sum = [0.0f64; 2];
                for i in 0..length {
                    let (s, c) = (-std::f64::consts::TAU * (i * k) as f64 / length as f64).sin_cos();
                    let [re, im] = value(i).map(f64::from);
                    sum = [sum[0] + re * c - im * s, sum[1] + re * s + im * c];
                }
                let off = (f64::from(got[0]) - sum[0]).hypot(f64::from(got[1]) - sum[1]);
                assert!(off < 1e-6 * length as f64, "{length}, {k}: off by {off}");
            }
        }
    }
}
