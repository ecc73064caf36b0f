//! Which of several groups differ.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use serde::Serialize;

use super::describe::{Moments, is_rounding, sorted};
use super::range::studentized_range_upper;
use super::tabled::Law;

/// Pairs whose probabilities are reckoned one by one. Those of more are interpolated, to 1e-7, so that the time no longer
/// grows with their number.
const FEW: usize = 64;

/// Two groups compared.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TukeyRow {
    /// The name of one group.
    pub group1: String,
    /// The name of the other.
    pub group2: String,
    /// The mean of the second less that of the first.
    pub meandiff: f64,
    /// The probability of so great a difference among all the groups were their means equal, in [0, 1].
    pub p_adj: Option<f64>,
    /// The lower end of the difference's interval.
    pub lower: Option<f64>,
    /// The upper end.
    pub upper: Option<f64>,
    /// Whether the means differ at the level that was asked for.
    pub reject: Option<bool>,
}

/// Tukey's test of all pairs (honestly significant differences), for groups of unlike size as Kramer has it (Tukey 1953,
/// Kramer 1956). `alpha` is the probability, in (0, 1), of one false rejection or more among all pairs; the intervals hold
/// all at once with probability 1 - `alpha`.
///
/// Pairs come in the order of the groups; groups without values are left out. Where no group varies, or none holds more
/// than one value, there is no error to judge by and the rows hold the difference alone.
#[must_use]
pub fn tukey(groups: &[(String, Vec<f64>)], alpha: f64) -> Vec<TukeyRow> {
    Tukey::new(alpha).rows(groups)
}

/// [`tukey`] for several measures of the same groups: what they have in common is reckoned once. The rows do not depend on
/// what was tested before.
#[derive(Debug)]
pub struct Tukey {
    alpha: f64,
    /// By the number of groups and the degrees of freedom.
    laws: Mutex<BTreeMap<(usize, usize), Arc<Law>>>,
}

impl Tukey {
    /// A test with a probability, in (0, 1), of one false rejection or more among all pairs of a measure.
    #[must_use]
    pub const fn new(alpha: f64) -> Self {
        Self { alpha, laws: Mutex::new(BTreeMap::new()) }
    }

    fn law(&self, groups: usize, df: usize) -> Arc<Law> {
        // A thread that failed has left no law half made.
        let mut laws = self.laws.lock().unwrap_or_else(PoisonError::into_inner);
        Arc::clone(laws.entry((groups, df)).or_insert_with(|| Arc::new(Law::new(groups, df))))
    }

    /// Tests all pairs of groups.
    #[must_use]
    pub fn rows(&self, groups: &[(String, Vec<f64>)]) -> Vec<TukeyRow> {
        let groups: Vec<(&str, Moments)> = groups
            .iter()
            .filter_map(|(name, values)| Moments::of(&sorted(values)).map(|moments| (name.as_str(), moments)))
            .collect();
        let count = groups.len();
        let n: usize = groups.iter().map(|(_, group)| group.n).sum();
        let squares: f64 = groups.iter().map(|(_, group)| group.squares).sum();
        let scale = groups.iter().fold(0.0_f64, |most, (_, group)| most.max(group.scale));
        let df = n - count;
        let noise = (df > 0 && !is_rounding(squares, n, scale)).then(|| squares / df as f64);
        let law = noise.map(|_| self.law(count, df));
        let critical = law.as_ref().and_then(|law| law.critical(self.alpha));
        let are_few = count * count.saturating_sub(1) / 2 <= FEW;
        let upper =
            |q: f64| if are_few { studentized_range_upper(q, count, df) } else { law.as_ref()?.tabled.upper(q) };

        let pairs = (0..count).flat_map(|first| (first + 1..count).map(move |second| (first, second)));
        pairs
            .map(|(first, second)| {
                let ((group1, a), (group2, b)) = (&groups[first], &groups[second]);
                let meandiff = b.mean - a.mean;
                let error = noise.map(|noise| (noise / 2.0 * (1.0 / a.n as f64 + 1.0 / b.n as f64)).sqrt());
                let q = error.map(|error| meandiff.abs() / error);
                let reach = error.zip(critical).map(|(error, critical)| error * critical);
                TukeyRow {
                    group1: (*group1).to_owned(),
                    group2: (*group2).to_owned(),
                    meandiff,
                    p_adj: q.and_then(upper),
                    lower: reach.map(|reach| meandiff - reach),
                    upper: reach.map(|reach| meandiff + reach),
                    reject: q.zip(critical).map(|(q, critical)| q > critical),
                }
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn groups(values: &[&[f64]]) -> Vec<(String, Vec<f64>)> {
        values.iter().enumerate().map(|(i, values)| (i.to_string(), values.to_vec())).collect()
    }

    #[test]
    fn without_error_only_differences_are_told() {
        for values in [&[&[1.0][..], &[3.0]], &[&[0.1, 0.1, 0.1], &[2.1, 2.1]]] {
            let rows = tukey(&groups(values), 0.05);
            assert_eq!(rows.len(), 1);
            assert_eq!(rows[0].meandiff, 2.0);
            assert_eq!((rows[0].p_adj, rows[0].lower, rows[0].upper, rows[0].reject), (None, None, None, None));
        }
    }

    #[test]
    fn groups_without_values_are_left_out() {
        let rows = tukey(&groups(&[&[1.0, 2.0], &[], &[2.0, 3.5]]), 0.05);
        assert_eq!(rows.iter().map(|row| (&*row.group1, &*row.group2)).collect::<Vec<_>>(), [("0", "2")]);
        assert!(tukey(&groups(&[&[1.0, 2.0]]), 0.05).is_empty());
        assert!(tukey(&[], 0.05).is_empty());
    }

    /// Groups of three whose means lie ever farther apart.
    fn many(count: usize, apart: f64) -> Vec<(String, Vec<f64>)> {
        let group = |i: usize| (0..3).map(|k| apart * i as f64 + libm::sin((3 * i + k) as f64)).collect();
        (0..count).map(|i| (i.to_string(), group(i))).collect()
    }

    #[test]
    fn many_pairs_have_the_probabilities_that_few_would_have() {
        for (count, most) in [(11, 0.0), (13, 1e-7)] {
            let groups = many(count, 0.2);
            let df = 2 * count;
            let values = |i: usize| Moments::of(&groups[i].1).unwrap();
            let noise = (0..count).map(|i| values(i).squares).sum::<f64>() / df as f64;
            for row in tukey(&groups, 0.05) {
                let q = row.meandiff.abs() / (noise / 3.0).sqrt();
                let exact = studentized_range_upper(q, count, df).unwrap();
                assert!((row.p_adj.unwrap() - exact).abs() <= most + 1e-12, "{row:?}: {exact}");
            }
        }
    }

    #[test]
    fn rows_do_not_depend_on_what_was_tested_before() {
        let shared = Tukey::new(0.05);
        for (count, apart) in [(13, 0.1), (12, 0.3), (13, 0.5), (5, 0.1), (13, 0.1)] {
            let groups = many(count, apart);
            assert_eq!(shared.rows(&groups), tukey(&groups, 0.05));
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(16))]

        #[test]
        fn intervals_agree_with_p_and_greater_differences_are_rarer(
            values in prop::collection::vec(prop::collection::vec(-1.0..1.0_f64, 3..8), 2..5)
        ) {
            let values: Vec<&[f64]> = values.iter().map(Vec::as_slice).collect();
            let rows = tukey(&groups(&values), 0.05);
            for row in &rows {
                let (p, lower, upper) = (row.p_adj.unwrap(), row.lower.unwrap(), row.upper.unwrap());
                prop_assert_eq!(row.reject, Some(p < 0.05));
                prop_assert_eq!(row.reject, Some(lower > 0.0 || upper < 0.0));
                for other in &rows {
                    let width = |row: &TukeyRow| row.upper.unwrap() - row.lower.unwrap();
                    let nearer = other.meandiff.abs() / width(other) <= row.meandiff.abs() / width(row);
                    prop_assert!(!nearer || other.p_adj.unwrap() >= p * (1.0 - 1e-9));
                }
            }
        }
    }
}
