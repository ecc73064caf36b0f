//! The correlogram as a spectrum: which period along the links the angles repeat with.
//!
//! In: the correlogram. Out: r_hat(w) = sum over k of R_k e^(-i w k), over both sides and with R_0 = 1, which is
//! 1 + 2 sum over k >= 1 of R_k cos(w k), a real number. Neighbours that stand across each other show at w = pi, domains
//! of like angles at 0. The sum ends at k = 15, so that lines are no narrower than about 0.2.

use std::f64::consts::PI;

use serde::Serialize;

use super::Scalars;
use super::correlogram::Correlogram;

/// How many frequencies there are, evenly in [0, pi] with both ends.
pub const FREQUENCIES: usize = 64;

/// The spectrum of the angles along the links.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Spectrum {
    /// r_hat at pi j / 63 for j from 0 to 63; empty where there are no links.
    pub r_hat: Vec<f64>,
    /// The frequency of its greatest value, in radians a link, in [0, pi]; the least where several are as great.
    pub r_hat_peak: Option<f64>,
}

impl Spectrum {
    /// The figures by their names.
    #[must_use]
    pub fn scalars(&self) -> Scalars {
        vec![("r_hat_peak".into(), self.r_hat_peak)]
    }
}

/// The frequency of an entry of `r_hat`, in radians a link.
#[must_use]
pub fn frequency(entry: usize) -> f64 {
    PI * entry as f64 / (FREQUENCIES - 1) as f64
}

/// Measures the spectrum of a correlogram.
#[must_use]
pub fn measure(correlogram: &Correlogram) -> Spectrum {
    if correlogram.r.is_empty() {
        return Spectrum::default();
    }
    let cosines: Vec<f64> = (0..FREQUENCIES).map(|entry| libm::cos(frequency(entry))).collect();
    // The cosine of w k is that of another frequency in the list, a whole turn being twice the list.
    let half = FREQUENCIES - 1;
    let cosine = |entry: usize| cosines[half - half.abs_diff(entry % (2 * half))];
    let at = |entry: usize| 1.0 + 2.0 * correlogram.r.iter().zip(1..).map(|(r, k)| r * cosine(entry * k)).sum::<f64>();
    let r_hat: Vec<f64> = (0..FREQUENCIES).map(at).collect();
    let peak = (0..FREQUENCIES).fold(0, |best, entry| if r_hat[entry] > r_hat[best] { entry } else { best });
    Spectrum { r_hat, r_hat_peak: Some(frequency(peak)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(r: &[f64]) -> Spectrum {
        measure(&Correlogram { r: r.to_vec(), pairs: vec![1; r.len()], ..Correlogram::default() })
    }

    #[test]
    fn the_sum_is_over_both_sides() {
        let r = [-0.36, 0.21, -0.11, 0.05, -0.02, 0.01, 0.4, 0.3, 0.2, 0.1, 0.05, 0.04, 0.03, 0.02, 0.01];
        let spectrum = of(&r);
        assert_eq!(spectrum.r_hat.len(), FREQUENCIES);
        for (entry, value) in spectrum.r_hat.iter().enumerate() {
            let mut sum = 0.0;
            for k in -15i32..=15 {
                let r = if k == 0 { 1.0 } else { r[k.unsigned_abs() as usize - 1] };
                sum += r * libm::cos(frequency(entry) * f64::from(k));
            }
            assert!((value - sum).abs() < 1e-12, "{entry}: {value} {sum}");
        }
    }

    #[test]
    fn the_peak_tells_the_period() {
        assert_eq!(of(&[-1.0, 1.0, -1.0]).r_hat_peak, Some(PI));
        assert_eq!(of(&[1.0, 1.0, 1.0]).r_hat_peak, Some(0.0));
        // Stripes that repeat after three tiles.
        let thirds: Vec<f64> = (1..=15).map(|k| if k % 3 == 0 { 1.0 } else { -0.5 }).collect();
        assert!((of(&thirds).r_hat_peak.unwrap() - 2.0 * PI / 3.0).abs() < 1e-12);
        assert_eq!(of(&[]), Spectrum::default());
    }
}
