//! Whether sites stand in rows: the strongest wave among them.
//!
//! A wave is strong where sites stand on its crests: of n sites on crests alone |sum exp(-i q.r)|^2 / n is n, of sites
//! without order about 1 (the structure factor of a crystal and of a liquid: P. Chaikin and T. Lubensky, "Principles of
//! Condensed Matter Physics", chapter 2). Every lattice has a wave as long as its sites' spacing, or an overtone of one,
//! and so have tilings that never repeat. Sites are looked at in windows, because rows that wander over a page stay rows
//! to the eye, and so that time grows with the number of tiles.

use std::f64::consts::PI;

use rayon::prelude::*;

use crate::geom::Point;

/// Sites of a window, at most.
const WINDOW: usize = 256;

/// Windows whose box has room for more than this many times their sites are cut as well.
const ROOM: f64 = 2.0;

/// Windows of fewer sites are not cut for their room.
const SMALL: usize = 32;

/// Windows wider than this many spacings hold islands far apart. They are cut however few their sites are: there would be
/// waves without number to try.
const FAR: f64 = 64.0;

/// Windows that are looked at, at most: spread over the page where there are more.
const WINDOWS: usize = 64;

/// The waves that are tried, as wave numbers times the square root of a cell's area over 2 pi. The longest wave of any
/// lattice has at most (4/3)^(1/4) = 1.075; that of a honeycomb's six-fold stars has 1.32. Longer waves than these are the
/// window's own shape.
const WAVES: [f64; 2] = [0.6, 1.4];

/// Euler's constant.
const EULER: f64 = 0.577_215_664_901_532_9;

/// Sites summed side by side.
const LANES: usize = 4;

/// What share of the power the strongest wave has, in [0, 1], beyond what the strongest of as many waves has where there
/// is no order; the mean over windows. `cell` is the area of a cell.
pub(super) fn strongest(sites: &[Point], cell: f64) -> f64 {
    let spacing = cell.sqrt();
    let windows = windows(sites, spacing);
    let shown = windows.len().min(WINDOWS);
    let shares: Vec<(f64, f64)> = (0..shown)
        .into_par_iter()
        .map(|number| {
            let window = &windows[number * windows.len() / shown];
            (share(window), window.len() as f64)
        })
        .collect();
    let (sum, count) = shares.iter().fold((0.0, 0.0), |(sum, n), (share, sites)| (sum + share * sites, n + sites));
    if count > 0.0 { sum / count } else { 0.0 }
}

/// The sites in compact windows, in units of the spacing: halved across their longer side as long as they are too many.
fn windows(sites: &[Point], spacing: f64) -> Vec<Vec<Point>> {
    let Some(&origin) = sites.first() else { return Vec::new() };
    // Sites of one column stay in one column under rounding, and go by their index.
    let snapped = |x: f64| (x * 1e6).round() as i64;
    let scaled = sites.iter().map(|&p| (p - origin) * (1.0 / spacing)).map(|v| Point::new(v.x, v.y));
    let mut open: Vec<Vec<(u32, Point)>> = vec![(0..).zip(scaled).collect()];
    let mut closed = Vec::new();
    while let Some(mut window) = open.pop() {
        let (low, high) = bounds(window.iter().map(|(_, p)| *p));
        let [width, height] = [high.x - low.x, high.y - low.y];
        let is_roomy = (width + 1.0) * (height + 1.0) > ROOM * window.len() as f64 && window.len() >= SMALL;
        let is_far = width.max(height) > FAR && window.len() > 1;
        if window.len() <= WINDOW && !is_roomy && !is_far {
            closed.push(window.into_iter().map(|(_, p)| p).collect());
            continue;
        }
        let is_high = snapped(height) > snapped(width);
        let half = window.len() / 2;
        window.select_nth_unstable_by_key(half, |&(site, p)| (snapped(if is_high { p.y } else { p.x }), site));
        let rest = window.split_off(half);
        open.extend([window, rest]);
    }
    closed
}

/// The least and the greatest coordinates.
fn bounds(mut points: impl Iterator<Item = Point>) -> (Point, Point) {
    let first = points.next().unwrap_or_default();
    points.fold((first, first), |(low, high), p| {
        (Point::new(low.x.min(p.x), low.y.min(p.y)), Point::new(high.x.max(p.x), high.y.max(p.y)))
    })
}

/// The share of one window, whose sites are in units of the spacing.
fn share(window: &[Point]) -> f64 {
    let (low, high) = bounds(window.iter().copied());
    // Two waves for each that the window could tell apart, so that a peak between two of them is not missed.
    let steps = [PI / (high.x - low.x).max(1.0), PI / (high.y - low.y).max(1.0)];
    let [least, most] = WAVES.map(|wave| wave * 2.0 * PI);
    let columns = Table::new(window.iter().map(|p| p.x - low.x), steps[0], most);
    let rows = Table::new(window.iter().map(|p| p.y - low.y), steps[1], most);
    let (mut best, mut tried) = (0.0f64, 0u32);
    for column in 0..columns.len() {
        for row in 0..rows.len() {
            let wave = libm::hypot(column as f64 * steps[0], row as f64 * steps[1]);
            if wave < least || wave > most {
                continue;
            }
            let [falling, rising] = powers(columns.at(column), rows.at(row));
            best = best.max(falling).max(rising);
            tried += if column > 0 && row > 0 { 2 } else { 1 };
        }
    }
    // The power of one wave over sites without order is exponentially distributed, with mean 1; of so many the greatest is
    // expected to be the logarithm of their number and Euler's constant.
    let n = window.len() as f64;
    let chance = libm::log(f64::from(tried.max(1))) + EULER;
    if n > chance { ((best / n - chance) / (n - chance)).clamp(0.0, 1.0) } else { 0.0 }
}

/// Cosines and sines of whole multiples of the sites' phases along one axis.
struct Table {
    /// How many entries there are for one multiple: the sites, and zeros up to a whole number of lanes.
    width: usize,
    cosines: Vec<f64>,
    sines: Vec<f64>,
}

impl Table {
    /// From 0 up to the multiple of `step` that is the last not beyond `most`.
    fn new(places: impl Iterator<Item = f64>, step: f64, most: f64) -> Self {
        let units: Vec<(f64, f64)> = places.map(|x| libm::sincos(x * step)).collect();
        let width = units.len().next_multiple_of(LANES);
        let multiples = (most / step) as usize + 1;
        let mut table = Self { width, cosines: vec![0.0; width * multiples], sines: vec![0.0; width * multiples] };
        table.cosines[..units.len()].fill(1.0);
        for entry in 0..width * (multiples - 1) {
            let Some(&(sin, cos)) = units.get(entry % width) else { continue };
            let (c, s) = (table.cosines[entry], table.sines[entry]);
            table.cosines[entry + width] = c * cos - s * sin;
            table.sines[entry + width] = s * cos + c * sin;
        }
        table
    }

    /// How many multiples there are.
    fn len(&self) -> usize {
        self.cosines.len() / self.width
    }

    /// Cosines and sines of one multiple.
    fn at(&self, multiple: usize) -> [&[f64]; 2] {
        let range = multiple * self.width..(multiple + 1) * self.width;
        [&self.cosines[range.clone()], &self.sines[range]]
    }
}

/// |sum exp(-i (a + b))|^2 and |sum exp(-i (a - b))|^2 over phases a and b.
fn powers([cos_a, sin_a]: [&[f64]; 2], [cos_b, sin_b]: [&[f64]; 2]) -> [f64; 2] {
    let mut sums = [[0.0; LANES]; 4];
    let phases = cos_a.chunks_exact(LANES).zip(sin_a.chunks_exact(LANES));
    for ((ca, sa), (cb, sb)) in phases.zip(cos_b.chunks_exact(LANES).zip(sin_b.chunks_exact(LANES))) {
        for lane in 0..LANES {
            sums[0][lane] += ca[lane] * cb[lane];
            sums[1][lane] += sa[lane] * sb[lane];
            sums[2][lane] += sa[lane] * cb[lane];
            sums[3][lane] += ca[lane] * sb[lane];
        }
    }
    let [cc, ss, sc, cs] = sums.map(|lanes| lanes.iter().sum::<f64>());
    let power = |re: f64, im: f64| re * re + im * im;
    [power(cc - ss, sc + cs), power(cc + ss, sc - cs)]
}
