//! The distribution of the studentized range: how far apart the extremes of several equal means may fall by chance.
//!
//! The range of k standard normal numbers over an independent root mean square s with given degrees of freedom. As in
//! Copenhaver and Holland (1988) its distribution is an integral over s of that of the range, itself an integral over the
//! least of the numbers. Both are taken as integrals of the upper tail, whose integrands are positive throughout: nothing
//! cancels, and small probabilities keep their digits. Both integrands are smooth and die away at both ends, where plain
//! sums over equal steps converge faster than any power of the step (Trefethen and Weideman 2014).

use std::f64::consts::PI;

use super::tails::normal_upper;

/// The step over the least of the numbers. Halving it changes nothing in the twelfth digit.
const STEP: f64 = 0.125;

/// How far from its middle the integrand over the least number is followed: there it is below 1e-17 of its peak.
const REACH: f64 = 9.0;

/// What a summand may be of the greatest for those beyond it to be left out.
const NEGLIGIBLE: f64 = 1e-18;

/// Rounds of the search for a quantile; a dozen is the usual.
const ROUNDS: usize = 200;

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
    // the weight of an end that stays halved (Dowell and Jarratt 1971).
    let excess = |q: f64| studentized_range_upper(q, groups, df).map(|p| libm::log(p / alpha));
    let (mut low, mut high) = (1.0, 2.0);
    while excess(low)? < 0.0 {
        (low, high) = (low / 2.0, low);
    }
    while excess(high)? > 0.0 {
        (low, high) = (high, high * 2.0);
    }
    let (mut at_low, mut at_high) = (excess(low)?, excess(high)?);
    if at_high == f64::NEG_INFINITY {
        at_high = -1e3;
    }
    for _ in 0..ROUNDS {
        let middle = (low * at_high - high * at_low) / (at_high - at_low);
        let found = excess(middle)?;
        if found.abs() < 1e-13 || high - low < 1e-13 * high {
            return Some(middle);
        }
        if found > 0.0 {
            (low, at_low, at_high) = (middle, found, at_high / 2.0);
        } else {
            (high, at_high, at_low) = (middle, found, at_low / 2.0);
        }
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
    let mut sum = 0.0;
    for i in 0..=(2.0 * REACH / STEP) as u32 {
        // With the least at z, all others lie above it; that not all of them lie within w of it is what is asked.
        let z = f64::from(i) * STEP - REACH - 0.5 * w;
        let above = normal_upper(z);
        let outside = normal_upper(z + w) / above;
        sum += libm::exp(-0.5 * z * z) * libm::pow(above, others) * -libm::expm1(others * libm::log1p(-outside));
    }
    groups as f64 * STEP / (2.0 * PI).sqrt() * sum
}
