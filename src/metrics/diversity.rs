//! How many directions there are.

use std::f64::consts::PI;

use serde::Serialize;

use super::{Measured, Scalars};

/// Bins that directions are counted in.
const BINS: usize = 12;

/// Rotations of the bins that are averaged over; the next would be the first again.
const ROTATIONS: usize = 24;

/// Directions nearer to where a bin starts, as a share of a rotation's step, lie there but for rounding.
const ROUNDING: f64 = 1e-9;

/// Entropies of the directions.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Diversity {
    /// Shannon's entropy of the directions over 12 equal bins of [0, pi), over ln 12: in [0, 1]. A bin holds its lower
    /// end.
    pub h_angle: f64,
    /// The same averaged over 24 rotations of the bins by pi/288, which together are one bin: it does not depend on where
    /// bins start.
    pub h_angle_mean: f64,
}

impl Diversity {
    /// The figures by their names.
    #[must_use]
    pub fn scalars(&self) -> Scalars {
        vec![("h_angle".into(), Some(self.h_angle)), ("h_angle_mean".into(), Some(self.h_angle_mean))]
    }
}

/// Measures the diversity of the directions.
#[must_use]
pub fn measure(measured: &Measured) -> Diversity {
    let mut counts = [0u32; BINS];
    // Bins as wide as a rotation's step: every rotation's bins are made of them.
    let mut fine = [0u32; BINS * ROTATIONS];
    for angle in &measured.angles {
        let share = angle.to_radians() / PI;
        counts[((share * BINS as f64) as usize).min(BINS - 1)] += 1;
        let step = share * fine.len() as f64;
        let step = if (step - step.round()).abs() < ROUNDING { step.round() } else { step.floor() };
        fine[step as usize % fine.len()] += 1;
    }
    let rotated = |by: usize| {
        std::array::from_fn(|bin| (0..ROTATIONS).map(|i| fine[(bin * ROTATIONS + by + i) % fine.len()]).sum())
    };
    let mean = (0..ROTATIONS).map(|by| entropy(&rotated(by))).sum::<f64>() / ROTATIONS as f64;
    Diversity { h_angle: entropy(&counts), h_angle_mean: mean }
}

/// Shannon's entropy over its greatest value; 0 of nothing.
fn entropy(counts: &[u32; BINS]) -> f64 {
    let n: u32 = counts.iter().sum();
    let shares = counts.iter().filter(|&&count| count > 0).map(|&count| f64::from(count) / f64::from(n));
    // One bin alone has -0, which is to be printed as 0.
    shares.map(|p| -p * libm::log(p)).sum::<f64>() / libm::log(BINS as f64) + 0.0
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::geom::Angle;
    use crate::stage::Graph;

    fn turned(angles: &[f64]) -> Diversity {
        let angles = angles.iter().map(|&angle| Angle::degrees(angle).direction()).collect();
        measure(&Measured { angles, ..Measured::nothing(Graph::new(0, &[], Vec::new())) })
    }

    proptest! {
        #[test]
        fn the_mean_is_that_of_every_rotation(angles in prop::collection::vec(0.001..179.999f64, 1..60)) {
            let rotated = |by: u32| {
                let back = f64::from(by) * 180.0 / 288.0;
                turned(&angles.iter().map(|angle| angle - back).collect::<Vec<_>>())
            };
            let mean = (0..24).map(|by| rotated(by).h_angle).sum::<f64>() / 24.0;
            prop_assert!((mean - turned(&angles).h_angle_mean).abs() < 1e-9);
            // A turn by steps of a rotation changes nothing.
            prop_assert!((rotated(7).h_angle_mean - turned(&angles).h_angle_mean).abs() < 1e-9);
        }
    }

    #[test]
    fn where_bins_start_decides_no_more() {
        // Seen from the first bins two directions, from half of all rotations one.
        let found = turned(&[0.0, 7.5]);
        assert_eq!(found.h_angle, 0.0);
        let two = libm::log(2.0) / libm::log(12.0);
        assert!((found.h_angle_mean - two / 2.0).abs() < 1e-12);
        let even: Vec<f64> = (0..360).map(|i| f64::from(i) / 2.0).collect();
        assert!((turned(&even).h_angle_mean - 1.0).abs() < 1e-3);
    }

    #[test]
    fn nothing_has_no_diversity() {
        assert_eq!(turned(&[]), Diversity { h_angle: 0.0, h_angle_mean: 0.0 });
        let one = turned(&[40.0; 5]);
        assert!(one.h_angle == 0.0 && one.h_angle.is_sign_positive());
        assert!(one.h_angle_mean == 0.0 && one.h_angle_mean.is_sign_positive());
    }
}
