//! The upper tails of the distributions that tests are held against.
//!
//! Tails are reckoned as such, never as one less the rest: a p-value of 1e-248 stands.

use statrs::function::beta::checked_beta_reg;

/// The probability that F with `between` and `within` degrees of freedom exceeds `f`: the regularised incomplete beta
/// function (Abramowitz and Stegun 1964, 26.6.2). `None` without degrees of freedom.
pub(super) fn f_upper(f: f64, between: usize, within: usize) -> Option<f64> {
    let (between, within) = (between as f64, within as f64);
    checked_beta_reg(within / 2.0, between / 2.0, share(within, between * f.max(0.0))).ok()
}

/// The probability that Student's t with `df` degrees of freedom lies farther from 0 than `t`, on either side (Abramowitz
/// and Stegun 1964, 26.7.1). `None` without degrees of freedom.
pub(super) fn t_both(t: f64, df: usize) -> Option<f64> {
    let df = df as f64;
    checked_beta_reg(df / 2.0, 0.5, share(df, t * t)).ok()
}

/// The probability that a standard normal number exceeds `z`.
pub(super) fn normal_upper(z: f64) -> f64 {
    0.5 * libm::erfc(z * std::f64::consts::FRAC_1_SQRT_2)
}

/// What `a` is of `a + b`, for a positive `a` and a `b` that may be infinite.
fn share(a: f64, b: f64) -> f64 {
    if b.is_finite() { a / (a + b) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// From SciPy 1.17: `stats.f.sf`, `2 * stats.t.sf`, `stats.norm.sf`.
    #[test]
    fn tails_agree_far_out() {
        let near = |found: f64, known: f64| assert!((found / known - 1.0).abs() < 1e-8, "{found:e} for {known:e}");
        near(f_upper(6512.318964196599, 1, 396).unwrap(), 5.800770229793482e-248);
        near(f_upper(1.4695969402636626, 1, 396).unwrap(), 0.22613206129500132);
        near(normal_upper(-1.0), 0.8413447460685429);
    }
}
