//! Smooth noise: gradient noise on a square lattice (Perlin, "Improving noise", SIGGRAPH 2002).
//!
//! Gradients are picked by hashing lattice points with the mixing function of SplitMix64 (Steele, Lea and Flood,
//! OOPSLA 2014) instead of a permutation table, so that any seed will do and nothing repeats unless it is told to.

use serde::Serialize;

use crate::geom::{Length, Point};

/// The most octaves that are added up: the last is 2^-16 of the first, far below what can be seen.
const MOST_OCTAVES: u32 = 16;

/// Gradients stand at odd multiples of pi/16: their coordinates in the first quadrant.
const GRADIENTS: [[f64; 2]; 4] = [
    [0.980_785_280_403_230_4, 0.195_090_322_016_128_27],
    [0.831_469_612_302_545_2, 0.555_570_233_019_602_2],
    [0.555_570_233_019_602_2, 0.831_469_612_302_545_2],
    [0.195_090_322_016_128_27, 0.980_785_280_403_230_4],
];

/// Gradient noise in octaves, each half as large and half as strong as the one before.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Noise {
    /// The size of the largest features, greater than zero.
    pub scale: Length,
    /// How many octaves are added up, at least 1.
    pub octaves: u32,
    /// The stream it is drawn from.
    pub seed: u64,
    /// After which width and height it repeats, if it does; the scale is then rounded so that whole features fit.
    pub period: Option<[Length; 2]>,
}

impl Noise {
    /// Noise that never repeats.
    #[must_use]
    pub fn new(scale: Length, octaves: u32, seed: u64) -> Self {
        Self { scale, octaves, seed, period: None }
    }

    /// Noise that repeats after a width and a height.
    #[must_use]
    pub fn repeating(self, width: Length, height: Length) -> Self {
        Self { period: Some([width, height]), ..self }
    }

    /// The value at a point, in [0, 1].
    #[must_use]
    pub fn at(&self, p: Point) -> f64 {
        // Cells in a period, and the size of a cell, each way.
        let cells = self.period.map(|period| period.map(|length| (length / self.scale).round().max(1.0)));
        let size = match (self.period, cells) {
            (Some(period), Some(cells)) => [period[0].to_mm() / cells[0], period[1].to_mm() / cells[1]],
            _ => [self.scale.to_mm(); 2],
        };
        let (mut sum, mut total, mut strength, mut frequency) = (0.0, 0.0, 1.0, 1.0);
        for octave in 0..self.octaves.clamp(1, MOST_OCTAVES) {
            let seed = mix(self.seed.wrapping_add(u64::from(octave).wrapping_mul(0x9e37_79b9_7f4a_7c15)));
            // Gradient noise is zero on its lattice: the octaves' lattices must not coincide.
            let shift = [unit(mix(seed ^ 1)), unit(mix(seed ^ 2))];
            let x = p.x / size[0] * frequency + shift[0];
            let y = p.y / size[1] * frequency + shift[1];
            let wrap = cells.map(|cells| [cells[0] * frequency, cells[1] * frequency]);
            sum += strength * gradient_noise(x, y, seed, wrap);
            total += strength;
            strength *= 0.5;
            frequency *= 2.0;
        }
        // The noise of unit gradients in the plane lies within sqrt(1/2).
        (0.5 + sum / total * std::f64::consts::FRAC_1_SQRT_2).clamp(0.0, 1.0)
    }
}

/// One octave, in units of the lattice.
fn gradient_noise(x: f64, y: f64, seed: u64, wrap: Option<[f64; 2]>) -> f64 {
    let (left, top) = (x.floor(), y.floor());
    let (u, v) = (x - left, y - top);
    let corner = |dx: f64, dy: f64| {
        let (mut column, mut row) = (left + dx, top + dy);
        if let Some([columns, rows]) = wrap {
            column = column.rem_euclid(columns);
            row = row.rem_euclid(rows);
        }
        // Casts saturate: far beyond any page the noise becomes flat, and that is all.
        let hash = mix(mix(seed ^ (column as i64 as u64)).wrapping_add(row as i64 as u64));
        let [gx, gy] = GRADIENTS[(hash & 3) as usize];
        let gx = if hash & 4 == 0 { gx } else { -gx };
        let gy = if hash & 8 == 0 { gy } else { -gy };
        gx * (u - dx) + gy * (v - dy)
    };
    let (s, t) = (fade(u), fade(v));
    let upper = corner(0.0, 0.0) * (1.0 - s) + corner(1.0, 0.0) * s;
    let lower = corner(0.0, 1.0) * (1.0 - s) + corner(1.0, 1.0) * s;
    upper * (1.0 - t) + lower * t
}

/// Perlin's quintic: first and second derivatives vanish at 0 and 1.
fn fade(t: f64) -> f64 {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}

/// A number in [0, 1) from the upper bits of a hash.
fn unit(hash: u64) -> f64 {
    (hash >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
}

/// The output function of SplitMix64.
fn mix(z: u64) -> u64 {
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}
