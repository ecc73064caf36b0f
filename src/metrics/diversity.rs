//! How many directions there are.

use std::f64::consts::PI;

use serde::Serialize;

use super::{Measured, Scalars};

/// Bins that directions are counted in.
const BINS: usize = 12;

/// Entropies of the directions.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Diversity {
    /// Shannon's entropy of the directions over 12 equal bins of [0, pi), over ln 12: in [0, 1]. A bin holds its lower
    /// end.
    pub h_angle: f64,
}

impl Diversity {
    /// The figures by their names.
    #[must_use]
    pub fn scalars(&self) -> Scalars {
        vec![("h_angle".into(), Some(self.h_angle))]
    }
}

/// Measures the diversity of the directions.
#[must_use]
pub fn measure(measured: &Measured) -> Diversity {
    let mut counts = [0u32; BINS];
    for angle in &measured.angles {
        let bin = (angle.to_radians() / PI * BINS as f64) as usize;
        counts[bin.min(BINS - 1)] += 1;
    }
    let n = measured.angles.len() as f64;
    let entropy: f64 = counts.iter().filter(|&&c| c > 0).map(|&c| f64::from(c) / n).map(|p| -p * libm::log(p)).sum();
    Diversity { h_angle: entropy / libm::log(BINS as f64) }
}
