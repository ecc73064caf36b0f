//! How numbers are written on the page, and what measures are in a few words.

/// Probabilities below this are no more told apart: what is behind them are not the data but the tails of a formula.
const LEAST_P: f64 = 1e-12;

/// Most decimal places.
const MOST_PLACES: usize = 6;

/// When a measure is at its best.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Goal {
    /// The higher the better.
    Higher,
    /// The lower the better.
    Lower,
    /// The nearer to zero the better.
    Zero,
}

impl Goal {
    /// The goal of a measure, where it has one.
    pub(super) fn of(measure: &str) -> Option<Self> {
        match measure {
            "e_contrast" | "e_share" | "e_contrast_layers" | "e_contrast_k" | "p5_contrast" | "p5_contrast_layers"
            | "min_contrast" | "h_angle" | "h_angle_mean" | "joint" | "c_cov" | "grain" => Some(Self::Higher),
            "u_vor" | "xi" => Some(Self::Lower),
            measure if distance(measure).is_some() => Some(Self::Zero),
            _ => None,
        }
    }

    /// How far a value is from the best; the least is the best.
    pub(super) fn loss(self, value: f64) -> f64 {
        match self {
            Self::Higher => -value,
            Self::Lower => value,
            Self::Zero => value.abs(),
        }
    }

    pub(super) fn words(self) -> &'static str {
        match self {
            Self::Higher => "higher is better",
            Self::Lower => "lower is better",
            Self::Zero => "nearer to 0 is better",
        }
    }
}

/// The k of the correlogram's `r1`, `r2`, …
pub(super) fn distance(measure: &str) -> Option<u32> {
    let k = measure.strip_prefix('r')?;
    if k.starts_with(|c: char| c.is_ascii_digit()) { k.parse().ok() } else { None }
}

/// What a measure is.
pub(super) fn description(measure: &str) -> &'static str {
    match measure {
        "tiles" => "tiles measured",
        "edges" => "links among them",
        "e_contrast" => "mean contrast of neighbours",
        "e_bound" => "the greatest mean contrast its graph allows",
        "e_share" => "share of that bound reached",
        "e_contrast_layers" => "mean contrast of the nearest layers of neighbours",
        "e_contrast_k" => "mean contrast, weighted by layers",
        "p5_contrast" => "5th percentile of the contrast of neighbours",
        "p5_contrast_layers" => "the same of the nearest layers",
        "min_contrast" => "least contrast of neighbours",
        "h_angle" => "entropy of directions in 12 bins",
        "h_angle_mean" => "the same, averaged over turns of the bins",
        "joint" => "contrast and entropy at once",
        "xi" => "correlation length",
        "xi_r2" => "how well the exponential fits",
        "xi_r2_weighted" => "the same, weighed by pairs",
        "xi_at_bound" => "share of the runs whose fit ended on a bound",
        "decay_a" => "exponent of the power law of decay",
        "aicc_exp" => "AICc of the exponential",
        "aicc_power" => "AICc of the power law",
        "decay_power" => "share of the runs that the power law fits better",
        "r_hat_peak" => "frequency along the links of the spectrum's peak",
        "e_contrast_tangent" => "mean contrast of strokes where they leave tiles",
        "sampled" => "tiles that correlations were looked up from",
        "c_cov" => "share of the region that tiles cover",
        "u_vor" => "unevenness of the Voronoi cells' areas",
        "density_contrast" => "mean difference of ink between neighbours",
        "tile_isotropy" => "how evenly a tile's strokes point everywhere",
        "grain" => "contrast everywhere, many directions, even but not regular",
        "grain_contrast" => "its factor: neighbours part everywhere",
        "grain_directions" => "its factor: there are many directions wherever one looks",
        "grain_evenness" => "its factor: tiles lie evenly",
        "grain_disorder" => "its factor: tiles stand in no rows",
        "grain_looseness" => "its factor: cells are not all of one size",
        measure if distance(measure).is_some() => "correlation of directions at this distance along the links",
        _ => "",
    }
}

/// How many decimal places show the spreads of some values, or the values where they do not spread.
pub(super) fn places(means: &[f64], sds: &[f64]) -> usize {
    let mut sds: Vec<f64> = sds.iter().copied().filter(|&sd| sd > 1e-12).collect();
    sds.sort_by(f64::total_cmp);
    if let Some(small) = sds.get(sds.len().saturating_sub(1) / 3) {
        // Two digits of a small spread, though not of the smallest of many: one condition that hardly spreads asks for no
        // more digits of all others.
        return (1.0 - libm::floor(libm::log10(*small))).clamp(0.0, MOST_PLACES as f64) as usize;
    }
    if means.iter().all(|mean| mean.fract() == 0.0) { 0 } else { 3 }
}

/// A number with so many decimal places.
pub(super) fn fixed(value: f64, places: usize) -> String {
    let text = match value.abs() {
        size if size >= 1e9 => format!("{value:.3e}"),
        _ => format!("{value:.places$}"),
    };
    // What rounds to zero has no sign.
    let is_zero = text.trim_start_matches('-').chars().all(|c| matches!(c, '0' | '.'));
    if is_zero { text.trim_start_matches('-').to_owned() } else { text.replace('-', "\u{2212}") }
}

/// A number with about so many digits.
pub(super) fn digits(value: f64, digits: usize) -> String {
    match value.abs() {
        0.0 => "0".to_owned(),
        size if !(1e-4..1e6).contains(&size) => {
            format!("{value:.*e}", digits.saturating_sub(1)).replace('-', "\u{2212}")
        }
        size => {
            let before = libm::floor(libm::log10(size)) + 1.0;
            fixed(value, (digits as f64 - before).clamp(0.0, 9.0) as usize)
        }
    }
}

/// A probability.
pub(super) fn probability(p: f64) -> String {
    match p {
        p if p < LEAST_P => "< 1e\u{2212}12".to_owned(),
        p if p < 0.001 => format!("{p:.1e}").replace('-', "\u{2212}"),
        p => format!("{p:.4}"),
    }
}

/// A number that may be missing.
pub(super) fn maybe(value: Option<f64>, write: impl Fn(f64) -> String) -> String {
    value.filter(|value| value.is_finite()).map_or_else(|| "\u{2013}".to_owned(), write)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_written_for_people() {
        assert_eq!(
            [probability(1e-40), probability(3.21e-5), probability(0.04)],
            ["< 1e\u{2212}12", "3.2e\u{2212}5", "0.0400"]
        );
        assert_eq!([digits(0.0, 4), digits(12.3456, 4), digits(-0.012_345_6, 3)], ["0", "12.35", "\u{2212}0.0123"]);
        assert_eq!([digits(1.5e-7, 3), digits(123_456.0, 3)], ["1.50e\u{2212}7", "123456"]);
        assert_eq!([fixed(-0.0001, 2), fixed(-0.5, 1)], ["0.00", "\u{2212}0.5"]);
        assert_eq!([places(&[0.64], &[0.0052]), places(&[64.0], &[0.0]), places(&[0.5], &[])], [4, 0, 3]);
        assert_eq!(maybe(Some(f64::NAN), |v| digits(v, 3)), "\u{2013}");
    }

    #[test]
    fn only_the_correlogram_has_distances() {
        assert_eq!(
            [distance("r12"), distance("r"), distance("r_hat"), distance("r+1"), distance("xi")],
            [Some(12), None, None, None, None]
        );
    }
}
