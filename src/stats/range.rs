//! The distribution of the studentized range: how far apart the extremes of several equal means may fall by chance.
//!
//! The range of k standard normal numbers over an independent root mean square s with given degrees of freedom. As in
//! Copenhaver and Holland (1988) its distribution is an integral over s of that of the range, itself an integral over the
//! least of the numbers. Both are taken as integrals of the upper tail, whose integrands are positive throughout: nothing
//! cancels, and small probabilities keep their digits. Both integrands are smooth and die away at both ends, where plain
//! sums over equal steps converge faster than any power of the step (Trefethen and Weideman 2014).

use std::f64::consts::PI;

use super::tails::normal_upper;

/// Steps over the least of the numbers, for up to 20 groups and for more: halving them changes nothing in the twelfth digit
/// (for more than 1,000 groups, in the tenth).
const STEPS: (f64, f64) = (0.25, 0.125);

/// How far from its middle the integrand over the least number is followed: there it is below 1e-13 of its peak.
const REACH: f64 = 8.0;

/// What a summand may be of the greatest for those beyond it to be left out.
const NEGLIGIBLE: f64 = 1e-15;

/// How close to the logarithm of its probability, and as a share how close to itself, a quantile is searched.
const CLOSE: f64 = 1e-12;

/// Rounds of the search for a quantile at most; half a dozen is the usual.
const ROUNDS: usize = 100;

/// The probability that the studentized range of `groups` means exceeds `q`, with `df` degrees of freedom of the deviation
/// that they share: in [0, 1], to ten digits.
///
/// 0 for fewer than two groups, whose range is 0; `None` without degrees of freedom or for a `q` that is no number.
#[must_use]
pub fn studentized_range_upper(q: f64, groups: usize, df: usize) -> Option<f64> {
    if df == 0 || q.is_nan() {
        return None;
    }
    if groups < 2 || q == f64::INFINITY {
        return Some(0.0);
    }
    if q <= 0.0 {
        return Some(1.0);
    }
    // Over y = log s the density is greatest at 0, and there 1 when its constant is left out; its width is about
    // 1 / sqrt(2 df), and for few degrees of freedom about 1.
    let df = df as f64;
    let step = 0.4 / (2.0 * df + 16.0).sqrt();
    let density = |y: f64| libm::exp(df * (y - 0.5 * libm::expm1(2.0 * y)));
    let whole = sum(step, density, |_| 1.0);
    let beyond = sum(step, density, |y| range_upper(q * libm::exp(y), groups));
    Some((beyond / whole).min(1.0))
}

/// The `q` that the studentized range of `groups` means exceeds with probability `alpha`, to ten digits.
///
/// `None` for fewer than two groups, without degrees of freedom, and for an `alpha` outside (0, 1).
#[must_use]
pub fn studentized_range_quantile(alpha: f64, groups: usize, df: usize) -> Option<f64> {
    if groups < 2 || df == 0 || !(alpha > 0.0 && alpha < 1.0) {
        return None;
    }
    // The logarithm of the probability falls smoothly; a bracket is found by doubling and closed by false position, with
    // the weight of an end that stays reduced (Anderson and Björck 1973).
    let excess = |q: f64| studentized_range_upper(q, groups, df).map(|p| libm::log(p.max(f64::MIN_POSITIVE) / alpha));
    let (mut low, mut high) = (2.0, 2.0);
    let mut at_low = excess(low)?;
    let mut at_high = at_low;
    while at_low < 0.0 {
        (high, at_high) = (low, at_low);
        low /= 2.0;
        at_low = excess(low)?;
    }
    while at_high >= 0.0 {
        (low, at_low) = (high, at_high);
        high *= 2.0;
        at_high = excess(high)?;
    }
    let mut before = 0.0_f64;
    for _ in 0..ROUNDS {
        let middle = (low * at_high - high * at_low) / (at_high - at_low);
        let found = excess(middle)?;
        if found.abs() < CLOSE || high - low < CLOSE * high {
            return Some(middle);
        }
        let same_side = before * found > 0.0;
        // How much less is left than at the end that moves, or a half where there is no less.
        let reduced = |end: f64| if found / end < 1.0 { 1.0 - found / end } else { 0.5 };
        if found > 0.0 {
            at_high *= if same_side { reduced(at_low) } else { 1.0 };
            (low, at_low) = (middle, found);
        } else {
            at_low *= if same_side { reduced(at_high) } else { 1.0 };
            (high, at_high) = (middle, found);
        }
        before = found;
    }
    Some((low + high) / 2.0)
}

/// The sum of a density, greatest at 0, times a factor that falls from 1 to 0, over all multiples of a step.
fn sum(step: f64, density: impl Fn(f64) -> f64, factor: impl Fn(f64) -> f64) -> f64 {
    let mut sum = density(0.0) * factor(0.0);
    let mut greatest = sum;
    // Towards 0 the product rises to its peak; beyond it nothing exceeds the density.
    for i in 1.. {
        let y = -f64::from(i) * step;
        let dense = density(y);
        let product = dense * factor(y);
        sum += product;
        greatest = greatest.max(product);
        if dense <= NEGLIGIBLE * greatest || product < NEGLIGIBLE * greatest {
            break;
        }
    }
    // The other way both fall.
    for i in 1.. {
        let y = f64::from(i) * step;
        let product = density(y) * factor(y);
        sum += product;
        if product <= NEGLIGIBLE * greatest {
            break;
        }
    }
    sum
}

/// The probability that the range of `groups` standard normal numbers exceeds `w`.
fn range_upper(w: f64, groups: usize) -> f64 {
    let others = (groups - 1) as f64;
    let step = if groups <= 20 { STEPS.0 } else { STEPS.1 };
    let mut sum = 0.0;
    for i in 0..=(2.0 * REACH / step) as u32 {
        // With the least at z, all others lie above it; that not all of them lie within w of it is what is asked.
        let z = f64::from(i) * step - REACH - 0.5 * w;
        let above = normal_upper(z);
        let outside = normal_upper(z + w) / above;
        sum += libm::exp(-0.5 * z * z) * libm::pow(above, others) * -libm::expm1(others * libm::log1p(-outside));
    }
    groups as f64 * step / (2.0 * PI).sqrt() * sum
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn two_means_are_students_t() {
        // With 1 degree of freedom the range over s of two is sqrt 2 times Cauchy's variable, folded.
        for q in [0.1, 1.0, 18.0, 1e4, 1e9] {
            let known = 2.0 / PI * libm::atan2(2.0_f64.sqrt(), q);
            let found = studentized_range_upper(q, 2, 1).unwrap();
            assert!((found / known - 1.0).abs() < 1e-10, "{q}: {found:e} for {known:e}");
        }
    }

    #[test]
    fn the_ends_are_what_they_must_be() {
        assert_eq!(studentized_range_upper(0.0, 3, 5), Some(1.0));
        assert_eq!(studentized_range_upper(f64::INFINITY, 3, 5), Some(0.0));
        assert_eq!(studentized_range_upper(1e200, 3, 500), Some(0.0));
        assert_eq!(studentized_range_upper(2.0, 1, 5), Some(0.0));
        assert_eq!(studentized_range_upper(2.0, 3, 0), None);
        assert_eq!(studentized_range_upper(f64::NAN, 3, 5), None);
        assert_eq!(studentized_range_quantile(0.05, 1, 5), None);
        assert_eq!(studentized_range_quantile(0.05, 3, 0), None);
        assert_eq!(studentized_range_quantile(0.0, 3, 5), None);
        assert_eq!(studentized_range_quantile(1.0, 3, 5), None);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]

        #[test]
        fn farther_is_rarer_and_more_groups_range_wider(
            q in 0.01..20.0_f64, more in 1.01..2.0_f64, groups in 2..40_usize, df in 2..2000_usize
        ) {
            let p = studentized_range_upper(q, groups, df).unwrap();
            prop_assert!((0.0..=1.0).contains(&p));
            prop_assert!(studentized_range_upper(q * more, groups, df).unwrap() <= p + 1e-12);
            prop_assert!(studentized_range_upper(q, groups + 1, df).unwrap() >= p - 1e-12);
        }

        #[test]
        fn quantiles_have_their_probability(alpha in 0.0001..0.99_f64, groups in 2..30_usize, df in 3..1000_usize) {
            let q = studentized_range_quantile(alpha, groups, df).unwrap();
            let p = studentized_range_upper(q, groups, df).unwrap();
            prop_assert!((p / alpha - 1.0).abs() < 1e-9, "{q}: {p} for {alpha}");
        }
    }
}
