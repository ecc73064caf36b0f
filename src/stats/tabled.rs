//! The distribution of the studentized range where many values of it are asked for.
//!
//! One value takes about a millisecond, and all pairs of thirty groups by tens of measures ask for tens of thousands. They
//! lie on one curve, though, which is smooth: exact values at some places of it give the others.

use std::sync::OnceLock;

use super::range::{studentized_range_quantile, studentized_range_upper};

/// How wide the places lie near 0, about a tenth of what the range spreads by. Beyond [`BEND`] they lie wider in
/// proportion to q: with few degrees of freedom the tail is a power of q.
const STEP: f64 = 0.0625;

/// Where places begin to lie wider.
const BEND: f64 = 8.0;

/// The number of places. The last is beyond 1e14; what lies farther out is reckoned as it comes.
const PLACES: usize = 4096;

/// What the probability not to be exceeded is at least: below it the upper tail, close to 1, holds no digits of it.
const LEAST: f64 = 1e-12;

/// The probability that the studentized range of some means exceeds a q, between exact values.
#[derive(Debug)]
pub(super) struct Tabled {
    groups: usize,
    df: usize,
    /// The probabilities at the places. Each is found when it is first needed: most tests use a few dozens.
    places: Vec<OnceLock<f64>>,
}

impl Tabled {
    pub(super) fn new(groups: usize, df: usize) -> Self {
        Self { groups, df, places: vec![OnceLock::new(); PLACES] }
    }

    /// As [`studentized_range_upper`], to 1e-7: greater q never have greater probabilities, but for rounding.
    pub(super) fn upper(&self, q: f64) -> Option<f64> {
        let exact = || studentized_range_upper(q, self.groups, self.df);
        let share = BEND / STEP * libm::log1p(q / BEND);
        if self.groups < 2 || self.df == 0 || !(share >= 0.0 && share < (PLACES - 3) as f64) {
            return exact();
        }
        let at = share as usize;
        let share = share - at as f64;
        // The places i - 2 … i + 3 about the two that q lies between; below 0 the range exceeds everything.
        let mut around = [1.0; 6];
        for (i, p) in around.iter_mut().enumerate() {
            if let Some(place) = (at + i).checked_sub(2) {
                *p = self.place(place)?;
            }
        }
        if around[2] <= 0.0 {
            return Some(0.0);
        }
        if around[5] < f64::MIN_POSITIVE {
            // The logarithm ends where the numbers end.
            return exact();
        }
        let found = between(around.map(straightened), share);
        Some(if found >= straightened(1.0) { 1.0 } else { -libm::expm1(-libm::exp(found)) })
    }

    fn place(&self, place: usize) -> Option<f64> {
        let known = &self.places[place];
        if let Some(known) = known.get() {
            return Some(*known);
        }
        let q = BEND * libm::expm1(place as f64 * STEP / BEND);
        let p = studentized_range_upper(q, self.groups, self.df)?;
        Some(*known.get_or_init(|| p))
    }
}

/// A probability as what is almost a straight line over q. Extremes follow Gumbel's distribution more or less, whose
/// upper tail at q is 1 - exp(-exp(-q)); far out this is the logarithm of the probability, which keeps the digits of small
/// ones.
fn straightened(p: f64) -> f64 {
    libm::log(-libm::log1p(-p.min(1.0 - LEAST)))
}

/// The value at a share of the way from the third to the fourth of six values that fall, by Hermite's cubic. Its slopes are
/// those of the quartics through five values each, held to what keeps a cubic falling (Fritsch and Carlson 1980).
fn between([a, b, c, d, e, f]: [f64; 6], share: f64) -> f64 {
    let rise = (d - c).min(0.0);
    let [from, to] =
        [a - 8.0 * b + 8.0 * d - e, b - 8.0 * c + 8.0 * e - f].map(|twelfths| (twelfths / 12.0).clamp(3.0 * rise, 0.0));
    let rest = 1.0 - share;
    c + rise * share * share * (1.0 + 2.0 * rest) + share * rest * (from * rest - to * share)
}

/// The distribution for one number of groups and of degrees of freedom, with the quantile that a test needs of it.
#[derive(Debug)]
pub(super) struct Law {
    pub(super) tabled: Tabled,
    critical: OnceLock<Option<f64>>,
}

impl Law {
    pub(super) fn new(groups: usize, df: usize) -> Self {
        Self { tabled: Tabled::new(groups, df), critical: OnceLock::new() }
    }

    /// The q that is exceeded with probability `alpha`, which is the same at every call.
    pub(super) fn critical(&self, alpha: f64) -> Option<f64> {
        *self.critical.get_or_init(|| studentized_range_quantile(alpha, self.tabled.groups, self.tabled.df))
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn the_ends_are_those_of_the_exact() {
        let tabled = Tabled::new(12, 30);
        for q in [-1.0, 0.0, 1e15, 1e200, f64::INFINITY, f64::NAN] {
            assert_eq!(tabled.upper(q), studentized_range_upper(q, 12, 30), "{q}");
        }
        assert_eq!(tabled.upper(1e-9), Some(1.0));
        assert_eq!(Tabled::new(12, 0).upper(1.0), None);
        assert_eq!(Tabled::new(1, 5).upper(1.0), Some(0.0));
    }

    #[test]
    fn what_is_greater_is_never_likelier() {
        for (groups, df) in [(12, 1), (32, 32), (100, 2000)] {
            let tabled = Tabled::new(groups, df);
            let values: Vec<f64> = (0..20_000).map(|i| tabled.upper(f64::from(i) * 1e-3).unwrap()).collect();
            assert!(values.windows(2).all(|pair| pair[1] <= pair[0] + 1e-12), "{groups} groups, {df}");
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(48))]

        #[test]
        fn values_between_are_close_to_the_exact(
            q in 0.0..15.0_f64, far in 0.0..8.0_f64, groups in 12..101_usize, df in 1..3000_usize, few in 1..60_usize
        ) {
            for df in [df, few] {
                let tabled = Tabled::new(groups, df);
                for q in [q, libm::exp(far)] {
                    let (found, exact) = (tabled.upper(q).unwrap(), studentized_range_upper(q, groups, df).unwrap());
                    prop_assert!((found - exact).abs() < 1e-7, "{q}, {groups} groups, {df}: {found} for {exact}");
                    // Small ones keep digits.
                    prop_assert!((found - exact).abs() <= 1e-3 * exact, "{q}, {groups}, {df}: {found:e} for {exact:e}");
                }
            }
        }
    }
}
