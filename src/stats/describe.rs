//! Values in a few numbers: their middle, their spread, their order.

use serde::Serialize;

/// What a sample looks like.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Summary {
    /// How many values there are, at least 1.
    pub n: usize,
    /// Their mean.
    pub mean: f64,
    /// Their standard deviation (n - 1); `None` for a single value.
    pub sd: Option<f64>,
    /// The least.
    pub min: f64,
    /// The lower quartile, interpolated linearly.
    pub q1: f64,
    /// The median.
    pub median: f64,
    /// The upper quartile, interpolated linearly.
    pub q3: f64,
    /// The greatest.
    pub max: f64,
}

/// Describes values; `None` when there are none.
#[must_use]
pub fn summary(values: &[f64]) -> Option<Summary> {
    let sorted = sorted(values);
    let moments = Moments::of(&sorted)?;
    Some(Summary {
        n: moments.n,
        mean: moments.mean,
        sd: moments.variance().map(f64::sqrt),
        min: *sorted.first()?,
        q1: of_sorted(&sorted, 25.0)?,
        median: of_sorted(&sorted, 50.0)?,
        q3: of_sorted(&sorted, 75.0)?,
        max: *sorted.last()?,
    })
}

/// The value below which `q` per cent of the values lie, between two of them interpolated linearly (Hyndman and Fan 1996,
/// definition 7). `q` is held to [0, 100]; `None` without values.
#[must_use]
pub fn percentile(values: &[f64], q: f64) -> Option<f64> {
    of_sorted(&sorted(values), q)
}

/// The percentile of values in ascending order.
pub(super) fn of_sorted(sorted: &[f64], q: f64) -> Option<f64> {
    let last = sorted.len().checked_sub(1)?;
    let at = (q / 100.0).clamp(0.0, 1.0) * last as f64;
    let below = (at.floor() as usize).min(last);
    let (low, high) = (sorted[below], sorted[(below + 1).min(last)]);
    let share = at - below as f64;
    // From the nearer end, so that a share of one gives the upper value itself.
    Some(if share < 0.5 { low + (high - low) * share } else { high - (high - low) * (1.0 - share) })
}

/// The finite values in ascending order.
pub(super) fn sorted(values: &[f64]) -> Vec<f64> {
    let mut sorted: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    sorted
}

/// Count, mean and sum of squares about the mean.
#[derive(Debug, Clone, Copy)]
pub(super) struct Moments {
    /// How many values there are.
    pub(super) n: usize,
    /// Their mean.
    pub(super) mean: f64,
    /// The sum of the squared distances from the mean.
    pub(super) squares: f64,
    /// The greatest absolute value.
    pub(super) scale: f64,
}

impl Moments {
    /// Reckons in passes, each from the mean that the one before found: equal values have exactly no spread, and large
    /// offsets cost no digits. `None` without values.
    pub(super) fn of(values: &[f64]) -> Option<Self> {
        let mut mean = *values.first()?;
        let n = values.len();
        for _ in 0..2 {
            mean += values.iter().map(|value| value - mean).sum::<f64>() / n as f64;
        }
        let squares = values.iter().map(|value| (value - mean) * (value - mean)).sum();
        let scale = values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        Some(Self { n, mean, squares, scale })
    }

    /// The variance (n - 1); `None` for a single value.
    pub(super) fn variance(&self) -> Option<f64> {
        (self.n > 1).then(|| self.squares / (self.n - 1) as f64)
    }
}

/// Whether a sum of squares of `n` distances between values up to `scale` is no more than rounding can leave behind.
pub(super) fn is_rounding(squares: f64, n: usize, scale: f64) -> bool {
    let step = 8.0 * f64::EPSILON * scale;
    squares <= n as f64 * step * step
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn quartiles_lie_between_the_values() {
        let found = summary(&[4.0, 1.0, 3.0, 2.0]).unwrap();
        assert_eq!((found.min, found.q1, found.median, found.q3, found.max), (1.0, 1.75, 2.5, 3.25, 4.0));
        assert_eq!((found.n, found.mean), (4, 2.5));
        assert!((found.sd.unwrap() - 1.290_994_448_735_805_6).abs() < 1e-15);
    }

    #[test]
    fn one_value_has_no_deviation_and_none_no_summary() {
        assert_eq!(summary(&[7.0]).unwrap().sd, None);
        assert_eq!(summary(&[]), None);
        assert_eq!(percentile(&[], 50.0), None);
    }

    #[test]
    fn equal_values_have_no_spread_at_all() {
        let found = summary(&[0.1; 100]).unwrap();
        assert_eq!((found.mean, found.sd), (0.1, Some(0.0)));
    }

    #[test]
    fn what_is_not_finite_is_passed_over() {
        assert_eq!(summary(&[1.0, f64::NAN, f64::INFINITY, 3.0]), summary(&[1.0, 3.0]));
    }

    proptest! {
        #[test]
        fn an_offset_moves_the_mean_and_leaves_the_deviation(
            values in prop::collection::vec(-1.0..1.0_f64, 2..40), offset in -1e6..1e6_f64
        ) {
            let plain = summary(&values).unwrap();
            let moved: Vec<f64> = values.iter().map(|value| value + offset).collect();
            let moved = summary(&moved).unwrap();
            prop_assert!((moved.mean - offset - plain.mean).abs() < 1e-9);
            prop_assert!((moved.sd.unwrap() - plain.sd.unwrap()).abs() < 1e-9);
        }

        #[test]
        fn percentiles_rise(values in prop::collection::vec(-1e3..1e3, 1..30), a in 0.0..100.0, b in 0.0..100.0) {
            let (low, high) = (f64::min(a, b), f64::max(a, b));
            prop_assert!(percentile(&values, low) <= percentile(&values, high));
        }
    }
}
