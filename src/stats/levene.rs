//! Whether groups vary equally.

use serde::Serialize;

use super::describe::{Moments, is_rounding, of_sorted, sorted};
use super::tails::f_upper;

/// Levene's test.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Levene {
    /// The statistic.
    pub f: f64,
    /// The probability of so great a statistic were the spreads equal, in [0, 1].
    pub p: f64,
}

/// Levene's test about the medians (Brown and Forsythe 1974): an analysis of variance of the distances from each group's
/// median. Groups without values are left out; `None` with fewer than two groups, with no more values than groups, and
/// when the distances do not differ within any group.
#[must_use]
pub fn levene<'a>(groups: impl IntoIterator<Item = &'a [f64]>) -> Option<Levene> {
    let mut scale = 0.0_f64;
    let distances: Vec<Vec<f64>> = groups
        .into_iter()
        .filter_map(|group| {
            let sorted = sorted(group);
            let median = of_sorted(&sorted, 50.0)?;
            scale = sorted.iter().fold(scale, |most, value| most.max(value.abs()));
            Some(sorted.iter().map(|value| (value - median).abs()).collect())
        })
        .collect();
    let parts: Vec<Moments> = distances.iter().filter_map(|group| Moments::of(group)).collect();
    let n: usize = parts.iter().map(|part| part.n).sum();
    let between_df = parts.len().checked_sub(1).filter(|df| *df > 0)?;
    let within_df = n.checked_sub(parts.len()).filter(|df| *df > 0)?;

    let mean = parts.iter().map(|part| part.n as f64 * part.mean).sum::<f64>() / n as f64;
    let between: f64 = parts.iter().map(|part| part.n as f64 * (part.mean - mean) * (part.mean - mean)).sum();
    let within: f64 = parts.iter().map(|part| part.squares).sum();
    if is_rounding(within, n, scale) {
        return None;
    }
    let f = (between / between_df as f64) / (within / within_df as f64);
    Some(Levene { f, p: f_upper(f, between_df, within_df)? })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// From SciPy 1.17: `stats.levene([1, 2, 3, 4], [1, 3, 5, 9, 2])`.
    #[test]
    fn spreads_are_compared() {
        let found = levene([&[1.0, 2.0, 3.0, 4.0][..], &[1.0, 3.0, 5.0, 9.0, 2.0], &[]]).unwrap();
        assert!((found.f - 1.027_522_935_779_816_8).abs() < 1e-12, "{found:?}");
    }

    #[test]
    fn without_spread_there_is_no_test() {
        assert_eq!(levene([&[1.0, 1.0][..], &[2.0, 2.0]]), None);
        assert_eq!(levene([&[1.0][..], &[2.0]]), None);
        assert_eq!(levene([&[1.0, 2.0][..]]), None);
        assert_eq!(levene([]), None);
    }
}
