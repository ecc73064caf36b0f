//! Values that belong together by twos: the same seed under two conditions.

use serde::Serialize;

use super::describe::{Moments, is_rounding};
use super::tails::{normal_upper, t_both};

/// Student's test of paired differences.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PairedT {
    /// How many pairs there are.
    pub n: usize,
    /// The mean of the first less the second.
    pub difference: f64,
    /// The statistic.
    pub t: f64,
    /// Degrees of freedom.
    pub df: usize,
    /// The probability of a statistic so far from 0, on either side.
    pub p: f64,
    /// The probability of so great a statistic: small when the first is greater.
    pub p_greater: f64,
}

/// Wilcoxon's test of signed ranks.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SignedRank {
    /// How many pairs differ.
    pub n: usize,
    /// The sum of the ranks of pairs whose first is greater.
    pub plus: f64,
    /// The sum of the ranks of pairs whose first is less.
    pub minus: f64,
    /// The standardised sum: positive when the first is greater.
    pub z: f64,
    /// The probability of a sum so far from its mean, on either side.
    pub p: f64,
    /// The probability of so great a sum: small when the first is greater.
    pub p_greater: f64,
}

/// Student's t-test of the differences of pairs, `a` less `b` (Student 1908).
///
/// Pairs with a value that is not finite are passed over, as is what of the longer list has no partner. `None` for fewer
/// than two pairs and when all differences are equal.
#[must_use]
pub fn paired_t(a: &[f64], b: &[f64]) -> Option<PairedT> {
    let (differences, scale) = differences(a, b);
    let moments = Moments::of(&differences)?;
    let variance = moments.variance()?;
    if is_rounding(moments.squares, moments.n, scale) {
        return None;
    }
    let t = moments.mean / (variance / moments.n as f64).sqrt();
    let df = moments.n - 1;
    let p = t_both(t, df)?;
    let p_greater = if t > 0.0 { p / 2.0 } else { 1.0 - p / 2.0 };
    Some(PairedT { n: moments.n, difference: moments.mean, t, df, p, p_greater })
}

/// Wilcoxon's signed-rank test of pairs (Wilcoxon 1945), by the normal approximation without correction for continuity:
/// pairs that are equal are left out, equal differences share their ranks, and the variance is corrected for them.
///
/// Pairs with a value that is not finite are passed over, as is what of the longer list has no partner. `None` when no
/// pair differs. For fewer than some 20 pairs the approximation is rough.
#[must_use]
pub fn wilcoxon_signed_rank(a: &[f64], b: &[f64]) -> Option<SignedRank> {
    let (mut differences, _) = differences(a, b);
    differences.retain(|difference| *difference != 0.0);
    differences.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
    let n = differences.len();
    let (mut plus, mut minus, mut ties) = (0.0, 0.0, 0.0);
    let mut before = 0.0;
    for equal in differences.chunk_by(|a, b| a.abs() == b.abs()) {
        let count = equal.len() as f64;
        let rank = before + (count + 1.0) / 2.0;
        let positive = equal.iter().filter(|difference| **difference > 0.0).count() as f64;
        plus += rank * positive;
        minus += rank * (count - positive);
        ties += count * (count * count - 1.0);
        before += count;
    }
    let count = n as f64;
    let mean = count * (count + 1.0) / 4.0;
    let variance = (count * (count + 1.0) * (2.0 * count + 1.0) - ties / 2.0) / 24.0;
    if n == 0 || variance <= 0.0 {
        return None;
    }
    let z = (plus - mean) / variance.sqrt();
    Some(SignedRank { n, plus, minus, z, p: (2.0 * normal_upper(z.abs())).min(1.0), p_greater: normal_upper(z) })
}

/// The differences of pairs, and the greatest absolute value among what they are differences of.
fn differences(a: &[f64], b: &[f64]) -> (Vec<f64>, f64) {
    let pairs = || a.iter().zip(b).filter(|(a, b)| a.is_finite() && b.is_finite());
    let scale = pairs().fold(0.0_f64, |most, (a, b)| most.max(a.abs()).max(b.abs()));
    (pairs().map(|(a, b)| a - b).collect(), scale)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn what_does_not_differ_is_not_tested() {
        assert_eq!(paired_t(&[1.1, 2.1, 3.1], &[0.1, 1.1, 2.1]), None);
        assert_eq!(paired_t(&[1.0], &[0.0]), None);
        assert_eq!(paired_t(&[], &[]), None);
        assert_eq!(wilcoxon_signed_rank(&[1.0, 2.0], &[1.0, 2.0]), None);
        assert_eq!(wilcoxon_signed_rank(&[], &[]), None);
    }

    #[test]
    fn pairs_without_a_value_are_passed_over() {
        let (a, b) = ([1.0, 5.0, 3.0, f64::NAN, 2.0], [0.0, 2.0, 1.0, 4.0]);
        assert_eq!(paired_t(&a, &b), paired_t(&a[..3], &b[..3]));
        assert_eq!(paired_t(&a, &b).unwrap().n, 3);
        assert_eq!(wilcoxon_signed_rank(&a, &b).unwrap().plus, 6.0);
    }

    proptest! {
        #[test]
        fn the_two_sides_add_up(
            pairs in prop::collection::vec((-1.0..1.0_f64, -1.0..1.0_f64), 3..30)
        ) {
            let (a, b): (Vec<f64>, Vec<f64>) = pairs.into_iter().unzip();
            let (here, there) = (paired_t(&a, &b).unwrap(), paired_t(&b, &a).unwrap());
            prop_assert!((here.p_greater + there.p_greater - 1.0).abs() < 1e-12);
            prop_assert!((here.p - there.p).abs() < 1e-12);
            let (here, there) = (wilcoxon_signed_rank(&a, &b).unwrap(), wilcoxon_signed_rank(&b, &a).unwrap());
            prop_assert!((here.p_greater + there.p_greater - 1.0).abs() < 1e-12);
            prop_assert_eq!((here.plus, here.minus), (there.minus, there.plus));
        }
    }
}
