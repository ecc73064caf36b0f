//! How fast correlations fade with the distance: the correlation length of the report, and whether a power law says it
//! better.
//!
//! In: the correlogram. Both laws are fitted to |R_k| by least squares, each k weighed by its number of pairs n_k:
//! A exp(-k / xi) from A = |R_1| and xi = 2, within 0 <= A <= 2 and 0.01 <= xi <= 100, and A k^-a from a = 1, within
//! the same A and 0 <= a <= 100, so that neither can say that correlations grow.

use serde::Serialize;

use super::Scalars;
use super::correlogram::Correlogram;
use super::trust::{Bounds, Pair, Row, fit};

/// Correlations below this are none.
const NONE: f64 = 0.01;

/// Parameters that a law has, and one more for the variance.
const PARAMETERS: f64 = 3.0;

/// A and xi.
const EXPONENTIAL: Bounds = Bounds { low: [0.0, 0.01], high: [2.0, 100.0] };

/// A and a.
const POWER: Bounds = Bounds { low: [0.0, 0.0], high: [2.0, 100.0] };

/// A law of decay.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Law {
    /// A exp(-k / xi).
    Exponential,
    /// A k^-a.
    Power,
}

/// How fast correlations fade.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Decay {
    /// The correlation length, in links; 0 where all |R_k| are below 0.01, none where there are fewer than two.
    pub xi: Option<f64>,
    /// What share of the variance of |R_k| the exponential explains: 1 - SS_res / SS_tot without weights, as the report has
    /// it, so that it may be negative. None where nothing was fitted, or all |R_k| are alike.
    pub xi_r2: Option<f64>,
    /// The same with the weights of the fit.
    pub xi_r2_weighted: Option<f64>,
    /// Whether the fit ended on a bound, so that `xi` says no more than where the bound is. None where nothing was fitted.
    pub xi_at_bound: Option<bool>,
    /// The exponent of the power law, in [0, 100].
    pub decay_a: Option<f64>,
    /// Akaike's criterion of the exponential, corrected for few points.
    pub aicc_exp: Option<f64>,
    /// And of the power law.
    pub aicc_power: Option<f64>,
    /// Which of the two has the lesser criterion.
    pub decay: Option<Law>,
}

impl Decay {
    /// The figures by their names. `xi_at_bound` is 1 or 0, so that its mean over runs is the share that ended on a bound,
    /// and `decay_power` is 1 where the power law says it better.
    #[must_use]
    pub fn scalars(&self) -> Scalars {
        vec![
            ("xi".into(), self.xi),
            ("xi_r2".into(), self.xi_r2),
            ("xi_r2_weighted".into(), self.xi_r2_weighted),
            ("xi_at_bound".into(), self.xi_at_bound.map(f64::from)),
            ("decay_a".into(), self.decay_a),
            ("aicc_exp".into(), self.aicc_exp),
            ("aicc_power".into(), self.aicc_power),
            ("decay_power".into(), self.decay.map(|law| f64::from(law == Law::Power))),
        ]
    }
}

/// Fits what the correlogram of a pattern shows.
#[must_use]
pub fn measure(correlogram: &Correlogram) -> Decay {
    let envelope: Envelope =
        Envelope(correlogram.r.iter().zip(&correlogram.pairs).map(|(r, &n)| [r.abs(), n as f64]).collect());
    if envelope.0.len() < 2 {
        return Decay::default();
    }
    if envelope.0.iter().all(|[r, _]| *r < NONE) {
        return Decay { xi: Some(0.0), ..Decay::default() };
    }
    let first = envelope.0[0][0];
    let exponential = envelope.fit([first, 2.0], EXPONENTIAL, |[a, xi]| {
        let step = libm::exp(-1.0 / xi);
        let mut share = 1.0;
        move |k| {
            share *= step;
            (a * share, [share, a * share * k / (xi * xi)])
        }
    });
    let power = envelope.fit([first, 1.0], POWER, |[a, exponent]| {
        move |k| {
            let log = libm::log(k);
            let share = libm::exp(-exponent * log);
            (a * share, [share, -a * share * log])
        }
    });
    let [aicc_exp, aicc_power] = [&exponential, &power].map(|fitted| envelope.criterion(fitted));
    // Of equal laws the simpler to speak of.
    let law = |(exp, power): (f64, f64)| if power < exp { Law::Power } else { Law::Exponential };
    Decay {
        xi: Some(exponential.parameters[1]),
        xi_r2: envelope.explained(&exponential, |_| 1.0),
        xi_r2_weighted: envelope.explained(&exponential, |n| n),
        xi_at_bound: Some(exponential.is_at_bound),
        decay_a: Some(power.parameters[1]),
        aicc_exp,
        aicc_power,
        decay: aicc_exp.zip(aicc_power).map(law),
    }
}

/// |R_k| and n_k for k = 1, 2, …
struct Envelope(Vec<[f64; 2]>);

/// A law fitted.
struct Fitted {
    parameters: Pair,
    is_at_bound: bool,
    /// What the law says for each k.
    values: Vec<f64>,
}

impl Envelope {
    /// Fits a law: what gives, for parameters, its values and their derivatives at k = 1, 2, … in order.
    fn fit<L: FnMut(f64) -> (f64, Pair)>(&self, start: Pair, bounds: Bounds, law: impl Fn(Pair) -> L) -> Fitted {
        let rows = |parameters: Pair| -> Vec<Row> {
            let mut law = law(parameters);
            let row = |(k, [r, n]): (f64, &[f64; 2])| {
                let (value, slopes) = law(k);
                let weight = n.sqrt();
                (weight * (value - r), slopes.map(|slope| weight * slope))
            };
            distances().zip(&self.0).map(row).collect()
        };
        let (parameters, is_at_bound) = bounds.snapped(fit(start, bounds, rows));
        let mut law = law(parameters);
        Fitted { parameters, is_at_bound, values: distances().take(self.0.len()).map(|k| law(k).0).collect() }
    }

    /// 1 - SS_res / SS_tot, with weights by the number of pairs.
    fn explained(&self, fitted: &Fitted, weight: impl Fn(f64) -> f64) -> Option<f64> {
        let all: f64 = self.0.iter().map(|&[_, n]| weight(n)).sum();
        let mean = self.0.iter().map(|&[r, n]| weight(n) * r).sum::<f64>() / all;
        let squares = |left: &dyn Fn(usize, f64) -> f64| -> f64 {
            self.0.iter().enumerate().map(|(i, &[r, n])| weight(n) * left(i, r) * left(i, r)).sum()
        };
        let total = squares(&|_, r| r - mean);
        // What remains of equal values is rounding.
        let is_constant = total <= 1e-24 * all;
        (!is_constant).then(|| 1.0 - squares(&|i, r| r - fitted.values[i]) / total)
    }

    /// Akaike's information criterion for few points (Burnham and Anderson 2002, Model Selection and Multimodel Inference,
    /// sections 2.2 and 2.4): N ln(RSS / N) + 2 K + 2 K (K + 1) / (N - K - 1), where N counts the distances, K = 3 the
    /// parameters with the variance, and RSS is the sum of squares with the weights n_k over their mean. None with
    /// fewer than five distances, and where nothing is left to explain.
    fn criterion(&self, fitted: &Fitted) -> Option<f64> {
        let count = self.0.len() as f64;
        let room = count - PARAMETERS - 1.0;
        let mean = self.0.iter().map(|[_, n]| n).sum::<f64>() / count;
        let left: f64 =
            self.0.iter().zip(&fitted.values).map(|([r, n], value)| n / mean * (r - value) * (r - value)).sum();
        (room > 0.0 && left > 1e-24 * count)
            .then(|| count * libm::log(left / count) + 2.0 * PARAMETERS + 2.0 * PARAMETERS * (PARAMETERS + 1.0) / room)
    }
}

/// 1, 2, …
fn distances() -> impl Iterator<Item = f64> {
    (1u32..).map(f64::from)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(r: &[f64], pairs: &[u64]) -> Decay {
        measure(&Correlogram { r: r.to_vec(), pairs: pairs.to_vec(), ..Correlogram::default() })
    }

    /// A law with a little that it does not say, alternating in sign.
    fn of_law(law: impl Fn(f64) -> f64) -> Decay {
        let r: Vec<f64> = distances()
            .take(12)
            .zip([1.0, -1.0, -1.0, 1.0].into_iter().cycle())
            .map(|(k, sign)| sign * law(k) + 1e-4 * sign)
            .collect();
        of(&r, &[200, 400, 600, 700, 800, 800, 700, 600, 400, 200, 100, 10])
    }

    #[test]
    fn laws_are_told_apart() {
        let exponential = of_law(|k| 0.8 * libm::exp(-k / 3.0));
        assert_eq!((exponential.decay, exponential.xi_at_bound), (Some(Law::Exponential), Some(false)));
        assert!((exponential.xi.unwrap() - 3.0).abs() < 0.01, "{exponential:?}");
        assert!(exponential.xi_r2.unwrap() > 0.999 && exponential.xi_r2_weighted.unwrap() > 0.999);
        let power = of_law(|k| 0.8 * libm::pow(k, -1.5));
        assert_eq!(power.decay, Some(Law::Power));
        assert!((power.decay_a.unwrap() - 1.5).abs() < 0.01, "{power:?}");
    }

    #[test]
    fn what_cannot_be_said_is_none() {
        assert_eq!(of(&[], &[]), Decay::default());
        assert_eq!(of(&[0.5], &[10]), Decay::default());
        assert_eq!(of(&[0.005, -0.009], &[10, 10]), Decay { xi: Some(0.0), ..Decay::default() });
        // Two parameters and the variance leave nothing to compare by with four distances.
        let few = of(&[-0.4, 0.2, -0.1, 0.07], &[10, 20, 20, 10]);
        assert_eq!((few.aicc_exp, few.aicc_power, few.decay), (None, None, None));
        assert!(few.xi.is_some() && few.decay_a.is_some());
    }

    #[test]
    fn what_does_not_fade_ends_on_the_bound() {
        let decay = of(&[1.0; 8], &[10; 8]);
        assert_eq!((decay.xi, decay.xi_at_bound), (Some(100.0), Some(true)));
        assert_eq!((decay.xi_r2, decay.xi_r2_weighted), (None, None));
        assert_eq!(decay.decay_a, Some(0.0));
        // A fall too steep for an amplitude of 2 ends on that.
        let decay = of(&[0.5, 0.0001, 0.0001], &[10; 3]);
        assert_eq!(decay.xi_at_bound, Some(true));
        assert!((decay.xi.unwrap() - 0.67117).abs() < 1e-4, "{decay:?}");
    }
}
