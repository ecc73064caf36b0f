//! Whether values look as if they were drawn from a normal distribution.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

use serde::Serialize;

use super::describe::{Moments, is_rounding, sorted};
use super::tails::normal_upper;

/// The test of Shapiro and Wilk.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ShapiroWilk {
    /// The statistic, in (0, 1]: how straight the values lie against those a normal distribution would give.
    pub w: f64,
    /// The probability of so small a statistic were the values normal, in [0, 1].
    pub p: f64,
}

/// As many values as the approximation of p was fitted to; beyond them it is extrapolated.
pub(super) const MOST_FITTED: usize = 5000;

// The polynomials of Royston's table 1, constants first.
/// The correction of the outermost weight, in 1 / sqrt(n).
const OUTERMOST: [f64; 6] = [0.0, 0.221_157, -0.147_981, -2.071_19, 4.434_685, -2.706_056];
/// The correction of the weight next to it, in 1 / sqrt(n).
const NEXT: [f64; 6] = [0.0, 0.042_981, -0.293_762, -1.752_461, 5.682_633, -3.582_633];
/// For 4 to 11 values, in n: what log (1 - w) is taken from, and the mean and the log of the deviation of what comes out.
const SMALL_START: [f64; 2] = [-2.273, 0.459];
const SMALL_MEAN: [f64; 4] = [0.544, -0.399_78, 0.025_054, -6.714e-4];
const SMALL_DEVIATION: [f64; 4] = [1.3822, -0.778_57, 0.062_767, -0.002_032_2];
/// From 12 values on, in log n: the mean and the log of the deviation of log (1 - w).
const LARGE_MEAN: [f64; 4] = [-1.5861, -0.310_82, -0.083_751, 0.003_891_5];
const LARGE_DEVIATION: [f64; 3] = [-0.4803, -0.082_676, 0.003_030_2];

// Numerators and denominators of algorithm AS 111, constants first: up to 0.42 from a half, and beyond.
const MIDDLE_ABOVE: [f64; 4] = [2.506_628_238_84, -18.615_000_625_29, 41.391_197_735_34, -25.441_060_496_37];
const MIDDLE_BELOW: [f64; 5] = [1.0, -8.473_510_930_90, 23.083_367_437_43, -21.062_241_018_26, 3.130_829_098_33];
const TAIL_ABOVE: [f64; 4] = [-2.787_189_311_38, -2.297_964_791_34, 4.850_141_271_35, 2.321_212_768_58];
const TAIL_BELOW: [f64; 3] = [1.0, 3.543_889_247_62, 1.637_067_818_97];

/// The test of Shapiro and Wilk (1965) with Royston's weights and p-values (1995, algorithm AS R94), made for 3 to 5000
/// values. Beyond that p is an extrapolation. `None` for fewer than three values, and for values that do not differ.
#[must_use]
pub fn shapiro_wilk(values: &[f64]) -> Option<ShapiroWilk> {
    let sorted = sorted(values);
    let moments = Moments::of(&sorted)?;
    let n = sorted.len();
    if n < 3 || is_rounding(moments.squares, n, moments.scale) {
        return None;
    }
    let weights = weights(n);
    // Weights mirror each other with opposite signs, so that each goes with the distance between two values.
    let straight: f64 = weights.iter().enumerate().map(|(i, weight)| weight * (sorted[n - 1 - i] - sorted[i])).sum();
    let length = 2.0 * weights.iter().map(|weight| weight * weight).sum::<f64>();
    // 1 - w as a product, which keeps the digits that 1 less a number close to it would lose.
    let whole = (length * moments.squares).sqrt();
    let lack = ((whole - straight) * (whole + straight) / (length * moments.squares)).max(0.0);
    Some(ShapiroWilk { w: 1.0 - lack, p: significance(lack, n) })
}

/// The weights of the upper half of the values, outermost first.
fn weights(n: usize) -> Vec<f64> {
    if n == 3 {
        return vec![FRAC_1_SQRT_2];
    }
    // Blom's approximation of what normal values would be, upper half.
    let mut expected: Vec<f64> = (1..=n / 2).map(|i| upper_quantile((i as f64 - 0.375) / (n as f64 + 0.25))).collect();
    let length = 2.0 * expected.iter().map(|value| value * value).sum::<f64>();
    let (outermost, next) = (expected[0], expected[1]);
    let small = 1.0 / (n as f64).sqrt();
    let first = polynomial(&OUTERMOST, small) + outermost / length.sqrt();
    if n <= 5 {
        let rest = ((length - 2.0 * outermost * outermost) / (1.0 - 2.0 * first * first)).sqrt();
        expected.iter_mut().for_each(|value| *value /= rest);
    } else {
        let second = polynomial(&NEXT, small) + next / length.sqrt();
        let rest = ((length - 2.0 * outermost * outermost - 2.0 * next * next)
            / (1.0 - 2.0 * first * first - 2.0 * second * second))
            .sqrt();
        expected.iter_mut().for_each(|value| *value /= rest);
        expected[1] = second;
    }
    expected[0] = first;
    expected
}

/// The probability of `lack` = 1 - w or more.
fn significance(lack: f64, n: usize) -> f64 {
    if n == 3 {
        // Here the distribution is known exactly.
        let w = (1.0 - lack).clamp(0.75, 1.0);
        return (6.0 / PI * (libm::asin(w.sqrt()) - libm::asin(0.75_f64.sqrt()))).clamp(0.0, 1.0);
    }
    let y = libm::log(lack);
    let (y, mean, deviation) = if n <= 11 {
        let n = n as f64;
        let start = polynomial(&SMALL_START, n);
        if y >= start {
            return 0.0;
        }
        (-libm::log(start - y), polynomial(&SMALL_MEAN, n), polynomial(&SMALL_DEVIATION, n))
    } else {
        let n = libm::log(n as f64);
        (y, polynomial(&LARGE_MEAN, n), polynomial(&LARGE_DEVIATION, n))
    };
    normal_upper((y - mean) / libm::exp(deviation))
}

/// The number that a standard normal one exceeds with probability `p`, up to a half: the approximation of Beasley and
/// Springer (1977, algorithm AS 111), good to 1e-9, with which the polynomials above were fitted and other programs weigh.
fn upper_quantile(p: f64) -> f64 {
    let q = 0.5 - p;
    if q <= 0.42 {
        let r = q * q;
        q * polynomial(&MIDDLE_ABOVE, r) / polynomial(&MIDDLE_BELOW, r)
    } else {
        let r = (-libm::log(p)).sqrt();
        polynomial(&TAIL_ABOVE, r) / polynomial(&TAIL_BELOW, r)
    }
}

/// A polynomial by Horner's rule, constants first.
fn polynomial(coefficients: &[f64], x: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, coefficient| sum * x + coefficient)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn too_few_and_too_equal_values_are_not_tested() {
        assert_eq!(shapiro_wilk(&[1.0, 2.0]), None);
        assert_eq!(shapiro_wilk(&[0.1; 9]), None);
        assert_eq!(shapiro_wilk(&[]), None);
    }

    proptest! {
        #[test]
        fn neither_place_nor_scale_matters(
            values in prop::collection::vec(-1.0..1.0_f64, 3..60), scale in 0.01..100.0_f64, offset in -10.0..10.0_f64
        ) {
            let found = shapiro_wilk(&values).unwrap();
            prop_assert!((0.0..=1.0).contains(&found.w) && (0.0..=1.0).contains(&found.p));
            let moved: Vec<f64> = values.iter().map(|value| value * scale + offset).collect();
            prop_assert!((shapiro_wilk(&moved).unwrap().w - found.w).abs() < 1e-9);
        }
    }
}
