//! Charts of what is measured of a paint, of one pattern or of many.
//!
//! In: a [`Sketch`] of every pattern, all of one paint. Out: the correlogram with how it fades and its spectrum, and
//! histograms of directions, contrasts and cells. Of several patterns means are drawn, with one standard deviation to
//! either side.

use std::f64::consts::PI;

use crate::chart::{self, Bars, Look, Mark, Sector, Series, Spot, Titles};
use crate::metrics::correlogram::Correlogram;
use crate::metrics::decay::{self, Law};
use crate::metrics::spectrum::{FREQUENCIES, frequency};
use crate::metrics::{Measured, Measures, space};

/// Ranges that directions are counted in.
const DIRECTIONS: usize = 36;

/// Ranges that contrasts are counted in.
const CONTRASTS: usize = 25;

/// Ranges that areas of cells are counted in, and the greatest area that is told apart, in mean areas.
const AREAS: usize = 30;
const GREATEST: f64 = 3.0;

/// Points that a fitted curve is drawn through.
const CURVE: u32 = 120;

/// What charts need of a pattern.
#[derive(Debug, Clone)]
pub struct Sketch {
    r: Vec<f64>,
    pairs: Vec<u64>,
    r_hat: Vec<f64>,
    directions: Vec<f64>,
    contrasts: Vec<f64>,
    p5: Option<f64>,
    mean: f64,
    bound: Option<f64>,
    areas: Vec<f64>,
}

/// A chart.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Chart {
    /// What it shows, in one word: `correlogram`, `decay`, `spectrum`, `directions`, `contrast` or `cells`.
    pub kind: &'static str,
    /// The text of the SVG.
    pub svg: String,
}

impl Sketch {
    /// What charts need of a measured pattern.
    #[must_use]
    pub fn new(measured: &Measured, measures: &Measures) -> Self {
        let shares = |of: &[f64], ranges: usize| -> Vec<f64> {
            let mut counts = vec![0u32; ranges];
            of.iter().for_each(|share| counts[((share * ranges as f64) as usize).min(ranges - 1)] += 1);
            counts.into_iter().map(|count| f64::from(count) / of.len().max(1) as f64).collect()
        };
        let areas = space::areas(measured);
        let mean = areas.iter().sum::<f64>() / areas.len().max(1) as f64;
        let areas: Vec<f64> = areas.iter().filter(|_| mean > 0.0).map(|area| area / mean / GREATEST).collect();
        let directions: Vec<f64> = measured.angles.iter().map(|angle| angle.to_radians() / PI).collect();
        let contrasts: Vec<f64> = measured.graph.edges().map(|edge| measured.contrast(edge)).collect();
        Self {
            r: measures.correlogram.r.clone(),
            pairs: measures.correlogram.pairs.clone(),
            r_hat: measures.spectrum.r_hat.clone(),
            directions: shares(&directions, DIRECTIONS),
            contrasts: shares(&contrasts, CONTRASTS),
            p5: measures.contrast.p5_contrast,
            mean: measures.contrast.e_contrast,
            bound: measures.contrast.e_bound,
            areas: shares(&areas, AREAS),
        }
    }
}

/// Draws every chart of some patterns of a paint. `name` stands in their titles.
#[must_use]
pub fn illustrate(name: &str, sketches: &[Sketch]) -> Vec<Chart> {
    let of = match sketches.len() {
        0 | 1 => name.to_owned(),
        count => format!("{name}, {count} patterns, mean ± SD"),
    };
    vec![
        Chart { kind: "correlogram", svg: correlogram(&of, sketches) },
        Chart { kind: "decay", svg: decay(&of, sketches) },
        Chart { kind: "spectrum", svg: spectrum(&of, sketches) },
        Chart { kind: "directions", svg: directions(&of, sketches) },
        Chart { kind: "contrast", svg: contrast(&of, sketches) },
        Chart { kind: "cells", svg: cells(&of, sketches) },
    ]
}

/// A mean, and one standard deviation to either side where there are several values.
#[derive(Debug, Clone, Copy)]
struct Spread {
    mean: f64,
    band: Option<[f64; 2]>,
}

/// The mean of values and their spread; none without values.
fn spread(values: impl Iterator<Item = f64>) -> Option<Spread> {
    let values: Vec<f64> = values.collect();
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares: f64 = values.iter().map(|value| (value - mean) * (value - mean)).sum();
    let sd = (values.len() > 1).then(|| (squares / (count - 1.0)).sqrt());
    (!values.is_empty()).then(|| Spread { mean, band: sd.map(|sd| [mean - sd, mean + sd]) })
}

/// The spread of each place of lists.
fn spreads<'a>(
    sketches: &'a [Sketch],
    count: usize,
    list: impl Fn(&'a Sketch) -> &'a [f64] + Copy + 'a,
) -> impl Iterator<Item = (usize, Spread)> + 'a {
    (0..count).filter_map(move |i| {
        let values = sketches.iter().filter_map(|sketch| list(sketch).get(i).copied());
        Some((i, spread(values)?))
    })
}

/// As many values of R_k as the longest correlogram has that half of the patterns share.
fn reach(sketches: &[Sketch]) -> usize {
    let longest = sketches.iter().map(|sketch| sketch.r.len()).max().unwrap_or(0);
    let is_shared = |k: &usize| 2 * sketches.iter().filter(|sketch| sketch.r.len() > *k).count() >= sketches.len();
    (0..longest).take_while(is_shared).count()
}

fn correlogram(of: &str, sketches: &[Sketch]) -> String {
    let spots = spreads(sketches, reach(sketches), |sketch| &sketch.r);
    let spots = spots.map(|(i, Spread { mean, band })| Spot { x: (i + 1) as f64, y: mean, band }).collect();
    let title = format!("Correlogram of {of}");
    let titles = Titles { title: &title, x: "distance along the links, k", y: "R_k" };
    chart::lines(&titles, &[Series { name: "", look: Look::Joined, spots }], Some([0.0, 0.0]))
}

/// The size of R_k over all patterns, weighed by pairs, and the two laws fitted to it.
fn decay(of: &str, sketches: &[Sketch]) -> String {
    let count = reach(sketches);
    let pooled = |k: usize| {
        let of = sketches.iter().filter_map(move |sketch| Some((*sketch.r.get(k)?, *sketch.pairs.get(k)?)));
        let pairs: u64 = of.clone().map(|(_, pairs)| pairs).sum();
        let sum: f64 = of.map(|(r, pairs)| r * pairs as f64).sum();
        (sum / pairs.max(1) as f64, pairs)
    };
    let (r, pairs): (Vec<f64>, Vec<u64>) = (0..count).map(pooled).unzip();
    let spots = r.iter().zip(1..).map(|(r, k)| Spot { x: f64::from(k), y: r.abs(), band: None }).collect();
    let correlogram = Correlogram { r, pairs, ..Correlogram::default() };
    let fitted = decay::measure(&correlogram);
    let better = |law: Law| if fitted.decay == Some(law) { ", fits better" } else { "" };
    let xi = fitted.xi.filter(|xi| *xi > 0.0);
    let laws = [
        xi.map(|xi| {
            let note = if fitted.xi_at_bound == Some(true) { ", on its bound" } else { better(Law::Exponential) };
            (format!("A exp(-k / {xi:.2}){note}"), curve(&correlogram, |k| libm::exp(-k / xi)))
        }),
        fitted
            .decay_a
            .map(|a| (format!("A k^-{a:.2}{}", better(Law::Power)), curve(&correlogram, |k| libm::pow(k, -a)))),
    ];
    let mut series = vec![Series { name: "|R_k|", look: Look::Markers, spots }];
    series.extend(laws.iter().flatten().map(|(name, spots)| Series { name, look: Look::Line, spots: spots.clone() }));
    let title = format!("Decay of correlations of {of}");
    let titles = Titles { title: &title, x: "distance along the links, k", y: "|R_k|" };
    chart::lines(&titles, &series, Some([0.0, 0.0]))
}

/// A law's curve over the distances of a correlogram. At a least square its amplitude is what the normal equation says.
fn curve(correlogram: &Correlogram, law: impl Fn(f64) -> f64) -> Vec<Spot> {
    let terms = || correlogram.r.iter().zip(&correlogram.pairs).zip(1..);
    let sum = |term: &dyn Fn(f64, f64) -> f64| -> f64 {
        terms().map(|((r, &pairs), k)| pairs as f64 * term(r.abs(), law(f64::from(k)))).sum()
    };
    let amplitude = sum(&|r, law| r * law) / sum(&|_, law| law * law).max(f64::MIN_POSITIVE);
    let last = correlogram.r.len() as f64;
    let at = |i: u32| 1.0 + (last - 1.0) * f64::from(i) / f64::from(CURVE);
    (0..=CURVE).map(at).map(|x| Spot { x, y: amplitude.min(2.0) * law(x), band: None }).collect()
}

fn spectrum(of: &str, sketches: &[Sketch]) -> String {
    let spots = spreads(sketches, FREQUENCIES, |sketch| &sketch.r_hat);
    let spots = spots.map(|(i, Spread { mean, band })| Spot { x: frequency(i) / PI, y: mean, band }).collect();
    let title = format!("Spectrum of {of}");
    let titles = Titles { title: &title, x: "frequency along the links, in half turns a link", y: "r_hat" };
    chart::lines(&titles, &[Series { name: "", look: Look::Line, spots }], Some([0.0, 0.0]))
}

fn directions(of: &str, sketches: &[Sketch]) -> String {
    let sectors: Vec<Sector> = spreads(sketches, DIRECTIONS, |sketch| &sketch.directions)
        .map(|(_, Spread { mean, band })| Sector { share: mean, spread: band })
        .collect();
    let title = format!("Directions of {of}");
    chart::directions(&Titles { title: &title, x: "share of the tiles by their direction", y: "" }, &sectors)
}

fn contrast(of: &str, sketches: &[Sketch]) -> String {
    let mean = |of: &dyn Fn(&Sketch) -> Option<f64>| spread(sketches.iter().filter_map(of)).map(|found| found.mean);
    let marked = |name: &str, value: Option<f64>| value.map(|value| (format!("{name} {value:.3}"), value));
    let marks: Vec<(String, f64)> = [
        marked("5th percentile", mean(&|sketch| sketch.p5)),
        marked("mean", mean(&|sketch| Some(sketch.mean))),
        marked("bound of the mean", mean(&|sketch| sketch.bound)),
    ]
    .into_iter()
    .flatten()
    .collect();
    let marks: Vec<Mark<'_>> = marks.iter().map(|(name, value)| Mark { name, value: *value }).collect();
    let title = format!("Contrasts of neighbours of {of}");
    let titles = Titles { title: &title, x: "contrast: 0 alike, 1 at right angles", y: "share of the links" };
    histogram(&titles, sketches, (CONTRASTS, 1.0), |sketch| &sketch.contrasts, &marks)
}

fn cells(of: &str, sketches: &[Sketch]) -> String {
    let title = format!("Voronoi cells of {of}");
    let words = "area in mean areas; the last bar holds all beyond";
    let titles = Titles { title: &title, x: words, y: "share of the cells" };
    histogram(&titles, sketches, (AREAS, GREATEST), |sketch| &sketch.areas, &[])
}

/// A histogram of shares over so many ranges from zero to an end.
fn histogram<'a>(
    titles: &Titles<'_>,
    sketches: &'a [Sketch],
    (count, end): (usize, f64),
    list: impl Fn(&'a Sketch) -> &'a [f64] + Copy + 'a,
    marks: &[Mark<'_>],
) -> String {
    let found: Vec<Spread> = spreads(sketches, count, list).map(|(_, spread)| spread).collect();
    let heights: Vec<f64> = found.iter().map(|spread| spread.mean).collect();
    let bands: Vec<[f64; 2]> = found.iter().filter_map(|spread| spread.band).collect();
    chart::histogram(titles, &Bars { range: [0.0, end], heights: &heights, spreads: &bands, marks })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sketch(r: Vec<f64>) -> Sketch {
        let pairs = r.iter().map(|_| 100).collect();
        let half = vec![0.5, 0.5];
        Sketch {
            r,
            pairs,
            r_hat: vec![1.0; FREQUENCIES],
            directions: half.clone(),
            contrasts: half.clone(),
            p5: Some(0.25),
            mean: 0.5,
            bound: None,
            areas: half,
        }
    }

    #[test]
    fn every_chart_is_drawn_of_any_number_of_patterns() {
        let empty = Sketch { p5: None, ..sketch(Vec::new()) };
        let all =
            [vec![], vec![sketch(vec![-0.5, 0.25])], vec![sketch(vec![-0.5, 0.2, 0.1]), empty.clone()], vec![empty]];
        for sketches in all {
            let charts = illustrate("a<b", &sketches);
            let kinds: Vec<&str> = charts.iter().map(|chart| chart.kind).collect();
            assert_eq!(kinds, ["correlogram", "decay", "spectrum", "directions", "contrast", "cells"]);
            assert!(charts.iter().all(|chart| chart.svg.contains("a&lt;b") && !chart.svg.contains("NaN")));
        }
    }

    #[test]
    fn curves_pass_through_what_follows_their_law() {
        let r: Vec<f64> = (1..6).map(|k| 0.8 * libm::exp(-f64::from(k) / 1.5)).collect();
        let correlogram = Correlogram { pairs: vec![10, 20, 30, 20, 10], r, ..Correlogram::default() };
        let spots = curve(&correlogram, |k| libm::exp(-k / 1.5));
        assert!(spots.iter().all(|spot| (spot.y - 0.8 * libm::exp(-spot.x / 1.5)).abs() < 1e-12));
    }

    #[test]
    fn what_few_patterns_reach_is_left_out() {
        let short = sketch(vec![0.1]);
        assert_eq!(reach(&[sketch(vec![0.1, 0.2, 0.3]), short.clone(), short]), 1);
    }
}
