//! The sRGB transfer function (IEC 61966-2-1).

/// Cells of the table from light to 8-bit codes. The function's steepest part has 12.92 · 255 =
/// 3295 codes per unit of light, so that no cell of 4096 holds more than one step between codes.
const CELLS: usize = 4096;

/// Linear light in [0, 1] to an sRGB value in [0, 1].
pub(crate) fn encode(linear: f64) -> f64 {
    if linear <= 0.0031308 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// The inverse of [`encode`].
pub(crate) fn decode(value: f64) -> f64 {
    if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

/// Linear light in [0, 1] to the nearest 16-bit code.
pub(crate) fn encode16(linear: f32) -> u16 {
    (encode(f64::from(linear)) * 65535.0).round() as u16
}

/// Encodes linear light to the nearest 8-bit code, exactly, without a power for each value.
pub(crate) struct Encoder8 {
    /// The code at the start of each cell.
    codes: Vec<u8>,
    /// The light from which on each next code is the nearest; none after the last.
    thresholds: Vec<f32>,
}

impl Encoder8 {
    pub(crate) fn new() -> Self {
        let codes = (0..=CELLS).map(|i| (encode(i as f64 / CELLS as f64) * 255.0).round() as u8);
        let next = |code: u32| decode((f64::from(code) + 0.5) / 255.0) as f32;
        Self { codes: codes.collect(), thresholds: (0..255).map(next).chain([f32::INFINITY]).collect() }
    }

    /// The nearest code of light in [0, 1].
    #[inline]
    pub(crate) fn encode(&self, linear: f32) -> u8 {
        let code = self.codes[((linear * CELLS as f32) as usize).min(CELLS)];
        code + u8::from(linear >= self.thresholds[code as usize])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn table_is_exact() {
        let encoder = Encoder8::new();
        for i in 0..=1_000_000 {
            let linear = i as f32 / 1e6;
            let value = encode(f64::from(linear)) * 255.0;
            // Right at a threshold either neighbour is the nearest to single precision.
            assert!((f64::from(encoder.encode(linear)) - value).abs() <= 0.5 + 1e-4, "{linear}");
        }
        assert_eq!((encoder.encode(0.0), encoder.encode(1.0)), (0, 255));
    }

    #[test]
    fn known_values() {
        // 18% grey is code 118; the linear part ends at 0.0031308 = 0.04045 · 255 = 10.3.
        let encoder = Encoder8::new();
        assert_eq!(encoder.encode(0.18), 118);
        assert_eq!(encoder.encode(0.0031308), 10);
        assert_eq!(encoder.encode(0.5), 188);
        assert_eq!(encode16(0.5), 48192);
        assert_eq!(encode16(1.0), 65535);
        assert!((decode(encode(0.3)) - 0.3).abs() < 1e-12);
    }
}
