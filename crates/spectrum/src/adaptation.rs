//! Chromatic adaptation and the RGB space of pictures: matrices between XYZ and linear Rec. 709.

use indigo_math::{Mat3, Vec3d};

/// Chromaticity of the display's white, D65 as Rec. 709 rounds it.
pub const D65_XY: [f64; 2] = [0.3127, 0.3290];

/// XYZ to cone response (Lam 1985, the "Bradford" matrix).
const BRADFORD: [f64; 9] = [0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296];

/// XYZ of a chromaticity (x, y) at luminance 1.
pub fn xyz_of_white([x, y]: [f64; 2]) -> Vec3d {
    Vec3d::new(x / y, 1.0, (1.0 - x - y) / y)
}

/// The matrix that adapts XYZ seen under the white `from` to the display's white D65
/// (0.3127, 0.3290), both given as chromaticities: each of the three Bradford cone responses is
/// scaled by the quotient of the whites' responses. `None` where `from` is
/// no colour: its y, or one of its cone responses, is 0 or not finite.
pub fn bradford_to_d65(from: [f64; 2]) -> Option<Mat3<f64>> {
    let cones = Mat3::from_rows(BRADFORD);
    let (source, target) = (cones * xyz_of_white(from), cones * xyz_of_white(D65_XY));
    let gains = Mat3::from_rows([
        target.x / source.x,
        0.0,
        0.0, //
        0.0,
        target.y / source.y,
        0.0, //
        0.0,
        0.0,
        target.z / source.z,
    ]);
    let adapted = cones.inverse()? * gains * cones;
    // What a cone would answer by less than nothing is no light.
    let is_light = source.x > 0.0 && source.y > 0.0 && source.z > 0.0;
    (is_light && adapted.rows.iter().all(|row| row.is_finite())).then_some(adapted)
}

/// How far apart chromaticities may be that are the same: the rounding of those that are published.
const SAME: f64 = 1e-4;

/// The chromaticities (x, y) of the primaries of ITU-R BT.709 and of its white.
const REC709: [[f64; 2]; 4] = [[0.64, 0.33], [0.30, 0.60], [0.15, 0.06], D65_XY];

/// The matrix from linear RGB of some primaries (chromaticities of red, green, blue and of the white, (1, 1, 1)) to
/// linear Rec. 709, without adaptation: light stays what it is, and its luminance of 1 at (1, 1, 1). The identity where
/// the primaries are those of Rec. 709 but for rounding; `None` where they do not span the colours.
///
/// With P the primaries' XYZ as columns and w the white's, XYZ = P diag(P⁻¹ w) RGB (SMPTE RP 177-1993).
pub fn rec709_of(primaries: [[f64; 2]; 4]) -> Option<Mat3<f64>> {
    let pairs = primaries.as_flattened().iter().zip(REC709.as_flattened());
    if pairs.clone().all(|(a, b)| (a - b).abs() < SAME) {
        return Some(Mat3::IDENTITY);
    }
    let [red, green, blue] = [0, 1, 2].map(|i: usize| {
        let [x, y] = primaries[i];
        Vec3d::new(x, y, 1.0 - x - y)
    });
    let columns = Mat3 { rows: [red, green, blue] }.transposed();
    let shares = columns.inverse()? * xyz_of_white(primaries[3]);
    let to_xyz = Mat3 { rows: [red * shares.x, green * shares.y, blue * shares.z] }.transposed();
    let matrix = Mat3::from_rows(XYZ_TO_RGB) * to_xyz;
    (matrix.rows.iter().all(|row| row.is_finite()) && shares.x.min(shares.y).min(shares.z) > 0.0)
        .then_some(matrix)
}

/// Linear Rec. 709 RGB to XYZ, row-major; white (1, 1, 1) has Y = 1. From the primaries of ITU-R
/// BT.709 item 1.3 and the white [`D65_XY`], rounded once.
pub const RGB_TO_XYZ: [f64; 9] = [
    0.4123907992659595,
    0.35758433938387796,
    0.1804807884018343, //
    0.21263900587151036,
    0.7151686787677559,
    0.07219231536073371, //
    0.01933081871559185,
    0.11919477979462599,
    0.9505321522496606,
];

/// XYZ to linear Rec. 709 RGB, row-major: the inverse of [`RGB_TO_XYZ`], rounded once.
pub const XYZ_TO_RGB: [f64; 9] = [
    3.2409699419045213,
    -1.5373831775700935,
    -0.4986107602930033, //
    -0.9692436362808798,
    1.8759675015077206,
    0.04155505740717561, //
    0.05563007969699361,
    -0.20397695888897657,
    1.0569715142428786,
];

/// Linear Rec. 709 RGB of XYZ on any scale.
pub fn rgb_of_xyz(xyz: [f64; 3]) -> [f64; 3] {
    (Mat3::from_rows(XYZ_TO_RGB) * Vec3d::from(xyz)).to_array()
}

/// XYZ of linear Rec. 709 RGB on any scale.
pub fn xyz_of_rgb(rgb: [f64; 3]) -> [f64; 3] {
    (Mat3::from_rows(RGB_TO_XYZ) * Vec3d::from(rgb)).to_array()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::illuminant;

    fn largest_difference(a: &Mat3<f64>, b: &Mat3<f64>) -> f64 {
        (0..3).map(|i| (a.rows[i] - b.rows[i]).abs().max_component()).fold(0.0, f64::max)
    }

    #[test]
    fn the_matrices_follow_from_the_primaries() {
        let columns = Mat3 { rows: [0, 1, 2].map(|i: usize| xyz_of_white(REC709[i])) }.transposed();
        let amounts = columns.inverse().unwrap() * xyz_of_white(D65_XY);
        let scaled =
            columns * Mat3::from_rows([amounts.x, 0.0, 0.0, 0.0, amounts.y, 0.0, 0.0, 0.0, amounts.z]);
        assert!(largest_difference(&scaled, &Mat3::from_rows(RGB_TO_XYZ)) < 1e-15);
        assert!(largest_difference(&scaled.inverse().unwrap(), &Mat3::from_rows(XYZ_TO_RGB)) < 1e-14);
    }

    /// Of Rec. 2020: the matrix of ITU-R BT.2087-0, section 3 (to four digits). Of others: the primaries and the
    /// white are the colours that they are said to be.
    #[test]
    fn light_of_other_primaries_stays_what_it_is() {
        let wide = [[0.708, 0.292], [0.170, 0.797], [0.131, 0.046], D65_XY];
        let published = [1.6605, -0.5876, -0.0728, -0.1246, 1.1329, -0.0083, -0.0182, -0.1006, 1.1187];
        assert!(largest_difference(&rec709_of(wide).unwrap(), &Mat3::from_rows(published)) < 1e-4);
        let other = [[0.64, 0.33], [0.29, 0.60], [0.15, 0.06], [1.0 / 3.0, 1.0 / 3.0]];
        let matrix = rec709_of(other).unwrap();
        let units = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0; 3]];
        for (rgb, [x, y]) in units.into_iter().zip(other) {
            let [a, b, c] = xyz_of_rgb((matrix * Vec3d::from(rgb)).to_array());
            let sum = a + b + c;
            assert!((a / sum - x).abs() < 1e-12 && (b / sum - y).abs() < 1e-12, "{rgb:?}");
            assert!(rgb != [1.0; 3] || (b - 1.0).abs() < 1e-12);
        }
        let near = [[0.6400, 0.3300], [0.2995, 0.6000], [0.1500, 0.0600], D65_XY];
        assert!(rec709_of(near).unwrap() != Mat3::IDENTITY);
        let rounded = REC709.map(|c| c.map(|v| f64::from(v as f32) + 2e-5));
        assert_eq!(rec709_of(rounded), Some(Mat3::IDENTITY));
        assert!(rec709_of([[0.3, 0.3]; 4]).is_none() && rec709_of([[f64::NAN, 0.3]; 4]).is_none());
        // A white that is no mixture, and one that is no colour.
        assert!(rec709_of([wide[0], wide[1], wide[2], [0.7, 0.1]]).is_none());
        assert!(rec709_of([wide[0], wide[1], wide[2], [0.3, 0.0]]).is_none());
    }

    #[test]
    fn bradford_takes_a_white_to_d65() {
        for white in illuminant::ALL.iter().map(|i| i.white_xy) {
            let adapted = bradford_to_d65(white).unwrap() * xyz_of_white(white);
            assert!((adapted - xyz_of_white(D65_XY)).abs().max_component() < 1e-14);
        }
    }

    /// Rows of the published-whites table computed apart from this program (illuminants A, D50 and F12).
    #[test]
    fn bradford_matches_independent_numbers() {
        let expected = [
            (
                "A",
                [
                    0.84468001,
                    -0.11793686,
                    0.39497316,
                    -0.13663386,
                    1.10410746,
                    0.12922217,
                    0.07988570,
                    -0.13496444,
                    3.19336046,
                ],
            ),
            (
                "D50",
                [
                    0.95553939,
                    -0.02305835,
                    0.06322404,
                    -0.02831194,
                    1.00994706,
                    0.02102750,
                    0.01231027,
                    -0.02050341,
                    1.33023150,
                ],
            ),
            (
                "F12",
                [
                    0.85379254,
                    -0.10591197,
                    0.34128271,
                    -0.12423445,
                    1.09030181,
                    0.11198491,
                    0.06856908,
                    -0.11556315,
                    2.88199368,
                ],
            ),
        ];
        for (name, rows) in expected {
            let matrix = bradford_to_d65(illuminant::find(name).unwrap().white_xy).unwrap();
            assert!(largest_difference(&matrix, &Mat3::from_rows(rows)) < 1e-8, "{name}");
        }
    }

    #[test]
    fn a_white_that_is_no_colour_is_refused() {
        for white in [[0.5, 0.0], [f64::NAN, 0.3], [0.0, 0.0]] {
            assert!(bradford_to_d65(white).is_none(), "{white:?}");
        }
    }
}
