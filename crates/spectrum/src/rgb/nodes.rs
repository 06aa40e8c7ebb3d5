//! Quadrature of the colour, under D65, of a sigmoid reflectance.

use crate::adaptation::XYZ_TO_RGB;
use crate::grid::COUNT;
use crate::illuminant::D65;
use crate::observer::CMF;

/// Nodes that are summed side by side, so that the compiler makes vector instructions of them.
const WIDTH: usize = 4;

/// `N` groups of nodes: where each lies, from 0 at 360 nm to 1 at 830 nm, and what a reflectance
/// there adds to linear red, green and blue.
pub(super) struct Nodes<const N: usize> {
    position: [[f64; WIDTH]; N],
    weights: [[[f64; WIDTH]; 3]; N],
}

/// Every nanometre.
pub(super) static FINE: Nodes<118> = Nodes::new(1);
/// Every third nanometre: for tables of many fits.
pub(super) static COARSE: Nodes<40> = Nodes::new(3);

impl<const N: usize> Nodes<N> {
    /// Nodes at a step in nm. What lies between two nodes is shared between them, as if the
    /// reflectance were linear there.
    const fn new(step: usize) -> Self {
        let mut nodes = Self { position: [[0.0; WIDTH]; N], weights: [[[0.0; WIDTH]; 3]; N] };
        let mut k = 0;
        while k < N * WIDTH {
            nodes.position[k / WIDTH][k % WIDTH] = (k * step) as f64 / (COUNT - 1) as f64;
            k += 1;
        }
        let mut i = 0;
        while i < COUNT {
            let rgb = rgb_weight(i);
            let (low, share) = (i / step, (i % step) as f64 / step as f64);
            nodes.add(low, rgb, 1.0 - share);
            if share > 0.0 {
                nodes.add(low + 1, rgb, share);
            }
            i += 1;
        }
        nodes
    }

    const fn add(&mut self, node: usize, rgb: [f64; 3], share: f64) {
        let mut c = 0;
        while c < 3 {
            self.weights[node / WIDTH][c][node % WIDTH] += rgb[c] * share;
            c += 1;
        }
    }

    /// Weights of the red, green and blue of a node.
    pub(super) fn weights(&self, node: usize) -> [f64; 3] {
        self.weights[node / WIDTH].map(|row| row[node % WIDTH])
    }

    /// Colour of the sigmoid with these coefficients, and its derivatives: row = channel, column = coefficient.
    pub(super) fn linearise(&self, [c0, c1, c2]: [f64; 3]) -> ([f64; 3], [[f64; 3]; 3]) {
        let mut colour = [[0.0; WIDTH]; 3];
        let mut change = [[[0.0; WIDTH]; 3]; 3];
        for (position, weights) in self.position.iter().zip(&self.weights) {
            for k in 0..WIDTH {
                let t = position[k];
                let x = (c0 * t + c1) * t + c2;
                let inverse_root = 1.0 / (1.0 + x * x).sqrt();
                let value = 0.5 + 0.5 * x * inverse_root;
                let slope = 0.5 * inverse_root * inverse_root * inverse_root;
                for c in 0..3 {
                    let w = weights[c][k] * slope;
                    colour[c][k] += weights[c][k] * value;
                    change[c][0][k] += w * t * t;
                    change[c][1][k] += w * t;
                    change[c][2][k] += w;
                }
            }
        }
        let total = |parts: [f64; WIDTH]| parts.iter().sum::<f64>();
        (colour.map(total), change.map(|row| row.map(total)))
    }
}

/// What a reflectance at grid point `i` adds to the linear RGB of a surface lit by D65.
const fn rgb_weight(i: usize) -> [f64; 3] {
    let mut rgb = [0.0; 3];
    let mut c = 0;
    while c < 3 {
        let row = 3 * c;
        let matched =
            XYZ_TO_RGB[row] * CMF[i][0] + XYZ_TO_RGB[row + 1] * CMF[i][1] + XYZ_TO_RGB[row + 2] * CMF[i][2];
        rgb[c] = matched * D65[i] / LUMINANCE;
        c += 1;
    }
    rgb
}

/// Sum over the grid of D65 times the luminous efficiency.
const LUMINANCE: f64 = {
    let (mut sum, mut i) = (0.0, 0);
    while i < COUNT {
        sum += CMF[i][1] * D65[i];
        i += 1;
    }
    sum
};
