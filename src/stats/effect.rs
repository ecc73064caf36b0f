//! How far two groups lie apart.

use super::describe::{Moments, is_rounding, sorted};

/// Cohen's d: the difference of the means, `a` less `b`, over the pooled standard deviation (Cohen 1988, section 2.5.1).
///
/// `None` when a group is empty, when both hold one value, and when neither varies though their means differ; groups that
/// do not vary and have one mean are 0 apart.
#[must_use]
pub fn cohen_d(a: &[f64], b: &[f64]) -> Option<f64> {
    let (a, b) = (Moments::of(&sorted(a))?, Moments::of(&sorted(b))?);
    let df = (a.n + b.n).checked_sub(2).filter(|df| *df > 0)?;
    let difference = a.mean - b.mean;
    let squares = a.squares + b.squares;
    let scale = a.scale.max(b.scale);
    if is_rounding(squares, a.n + b.n, scale) {
        return is_rounding(difference * difference, 1, scale).then_some(0.0);
    }
    Some(difference / (squares / df as f64).sqrt())
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn a_difference_is_told_in_deviations() {
        assert_eq!(cohen_d(&[3.0, 5.0], &[1.0, 3.0]), Some(2.0 / 2.0_f64.sqrt()));
        assert_eq!(cohen_d(&[2.0, 4.0], &[2.0, 4.0, 3.0]), Some(0.0));
    }

    #[test]
    fn without_spread_only_equality_can_be_told() {
        assert_eq!(cohen_d(&[1.0, 1.0], &[1.0, 1.0]), Some(0.0));
        assert_eq!(cohen_d(&[1.0, 1.0], &[2.0, 2.0]), None);
        assert_eq!(cohen_d(&[1.0], &[2.0]), None);
        assert_eq!(cohen_d(&[], &[2.0, 3.0]), None);
    }

    proptest! {
        #[test]
        fn the_other_way_round_only_the_sign_changes(
            a in prop::collection::vec(-1.0..1.0, 2..20), b in prop::collection::vec(-1.0..1.0, 2..20)
        ) {
            prop_assert_eq!(cohen_d(&a, &b), cohen_d(&b, &a).map(|d| if d == 0.0 { d } else { -d }));
        }
    }
}
