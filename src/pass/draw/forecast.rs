//! What a paint will cost at the least, reckoned before anything is drawn, so that what is hopeless is refused at once.

use rayon::prelude::*;

use crate::geom::{Length, chain, ring_area};
use crate::scene::{FillKind, Hatch};

use super::budget::{CURVE, DOT, Exceeded, LINE, UNITED};
use super::job::Job;

/// Looks, and places of lines, dots and curves.
#[derive(Default, Clone, Copy)]
struct Cost {
    overlap: u128,
    lines: u128,
    dots: u128,
    curves: u128,
}

impl Cost {
    fn plus(self, other: Self) -> Self {
        Self {
            overlap: self.overlap + other.overlap,
            lines: self.lines + other.lines,
            dots: self.dots + other.dots,
            curves: self.curves + other.curves,
        }
    }
}

/// Checks that a paint's tiles can be drawn within its budget.
pub(super) fn check(job: &Job<'_>) -> Result<(), Exceeded> {
    let tiles = (0..job.sites.own()).into_par_iter().filter(|&tile| job.tiles.is_drawn(tile));
    let cost = tiles.map(|tile| cost(job, tile)).reduce(Cost::default, Cost::plus);
    let (lines, dots) = (cost.lines * u128::from(LINE), cost.dots * u128::from(DOT));
    let curves = cost.curves * u128::from(CURVE);
    if cost.overlap + lines + dots + curves <= u128::from(job.budget.most_work()) {
        return Ok(());
    }
    let whole = |count: u128| u64::try_from(count).unwrap_or(u64::MAX);
    Err(if cost.overlap > lines + dots + curves {
        overlap(job)
    } else if curves > lines.max(dots) {
        Exceeded::Places { what: "curves", count: whole(cost.curves) }
    } else if lines > dots {
        Exceeded::Places { what: "lines", count: whole(cost.lines) }
    } else {
        Exceeded::Places { what: "dots", count: whole(cost.dots) }
    })
}

/// What one tile costs.
fn cost(job: &Job<'_>, tile: usize) -> Cost {
    let mut cost = Cost::default();
    let (area, radius) = (ring_area(job.tiles.outline(tile)).abs(), job.nearby.radius(tile));
    let layers = job.tiles.layers[tile];
    let count = (layers.full + u8::from(layers.part > 0.0)).min(4);
    for number in 1..=count {
        let (kind, share) = job.layer_of(layers, number);
        // A tile is nowhere narrower than its area over its diameter. Casts of what is too great give the greatest number.
        let lines = |pitch: f64| area / (2.0 * radius) / pitch;
        let places =
            |hatch: &Hatch, spacing: Length| u128::from((share * area / hatch.pitch.to_mm() / spacing.to_mm()) as u64);
        match &*kind {
            FillKind::Lines(hatch) | FillKind::Dashes { hatch, .. } => {
                cost.lines += u128::from(lines(hatch.pitch.to_mm()) as u64);
            }
            FillKind::Dots { hatch, spacing, .. } => {
                cost.dots += places(hatch, *spacing);
                cost.lines += u128::from(lines(hatch.pitch.to_mm()) as u64);
            }
            FillKind::Crosses { hatch, spacing, .. } => cost.dots += 2 * places(hatch, *spacing),
            FillKind::Arcs(hatch) => cost.curves += 4 * u128::from(lines(hatch.pitch.to_mm()) as u64),
            FillKind::Waves { hatch, swing } | FillKind::Nawaami { hatch, swing } => {
                cost.curves += places(hatch, swing.wavelength / 2.0);
            }
            FillKind::Scribble { hatch, spacing, .. } => cost.curves += 2 * places(hatch, *spacing),
            FillKind::Motif { hatch, spacing, figure } => {
                let curves: usize = figure.0.iter().map(|strokes| chain::count(strokes)).sum();
                cost.curves = cost.curves.saturating_add(places(hatch, *spacing).saturating_mul(curves as u128));
            }
            FillKind::Solid => {}
        }
    }
    let is_solid = layers.is_solid || job.paint.tone.fill.iter().any(|fill| matches!(fill.kind, FillKind::Solid));
    if is_solid && !job.paint.tone.shape.is_cell() {
        let candidates = job.nearby.candidates(job.sites.points[tile], radius);
        cost.overlap += u128::from(candidates) * u128::from(UNITED);
    }
    if job.has_covers() {
        // At least a quarter of what is looked at does hide, and its profile is taken once a layer.
        let candidates = job.nearby.candidates(job.sites.points[tile], radius);
        cost.overlap = u128::from(candidates) * u128::from(1 + count);
    }
    cost
}

/// How deeply the drawn tiles overlap.
fn overlap(job: &Job<'_>) -> Exceeded {
    let drawn = || (0..job.sites.own()).filter(|&tile| job.tiles.is_drawn(tile));
    let count = drawn().count().max(1) as f64;
    let area = drawn().map(|tile| ring_area(job.tiles.outline(tile)).abs()).sum::<f64>() / count;
    let spacing = job.sites.spacing;
    Exceeded::Overlap { side: area.sqrt(), spacing, depth: (area / (spacing * spacing)).min(count) as u64 }
}
