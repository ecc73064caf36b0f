//! Which of several groups differ.

use serde::Serialize;

use super::describe::{Moments, is_rounding, sorted};
use super::range::{studentized_range_quantile, studentized_range_upper};

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
    let groups: Vec<(&str, Moments)> = groups
        .iter()
        .filter_map(|(name, values)| Moments::of(&sorted(values)).map(|moments| (name.as_str(), moments)))
        .collect();
    let n: usize = groups.iter().map(|(_, group)| group.n).sum();
    let squares: f64 = groups.iter().map(|(_, group)| group.squares).sum();
    let scale = groups.iter().fold(0.0_f64, |most, (_, group)| most.max(group.scale));
    let df = n - groups.len();
    let noise = (df > 0 && !is_rounding(squares, n, scale)).then(|| squares / df as f64);
    let critical = noise.and_then(|_| studentized_range_quantile(alpha, groups.len(), df));

    let pairs = (0..groups.len()).flat_map(|first| (first + 1..groups.len()).map(move |second| (first, second)));
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
                p_adj: q.and_then(|q| studentized_range_upper(q, groups.len(), df)),
                lower: reach.map(|reach| meandiff - reach),
                upper: reach.map(|reach| meandiff + reach),
                reject: q.zip(critical).map(|(q, critical)| q > critical),
            }
        })
        .collect()
}
