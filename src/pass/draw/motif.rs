//! A figure along the hatch lines. It is cut where the tile ends, as lines are.

use crate::geom::{Length, chain};
use crate::scene::{Hatch, MotifPath};

use super::budget::{CURVE, Exceeded};
use super::curves::{look, stroke};
use super::hand::Pull;
use super::job::{Job, Layer, Scratch};
use super::lattice::is_drawn;
use super::lines::interleaved;
use super::palette::Batch;

/// How figures are set.
pub(super) struct Motif<'a> {
    pub(super) hatch: &'a Hatch,
    pub(super) spacing: Length,
    pub(super) figure: &'a MotifPath,
}

impl Motif<'_> {
    /// How far a figure reaches from its middle, in millimetres.
    pub(super) fn reach(&self) -> f64 {
        let points = self.figure.0.iter().flatten();
        points.map(|p| p.x.abs().max(p.y.abs())).fold(0.0, f64::max)
    }

    /// What a figure costs in looks.
    pub(super) fn cost(&self) -> u64 {
        self.figure.0.iter().map(|chain| chain::count(chain) as u64 * CURVE).sum()
    }
}

/// Draws the figures of a layer: those of later layers between those of earlier ones.
pub(super) fn draw(
    job: &Job<'_>,
    layer: &Layer<'_>,
    motif: &Motif<'_>,
    scratch: &mut Scratch,
    out: &mut [Batch],
) -> Result<(), Exceeded> {
    let (lines, row) = interleaved(job, layer, motif.hatch, motif.spacing, scratch);
    look(job, layer, scratch);
    let Some(bounds) = scratch.curves.area.bounds() else { return Ok(()) };
    let (reach, cost) = (motif.reach(), motif.cost());
    let lines = lines.over((bounds.min.y - reach, bounds.max.y + reach));
    job.budget.work(lines.count())?;
    let bundle = layer.bundle.as_ref();
    let mut is_backwards = false;
    for (i, v) in lines.places() {
        let range = scratch.curves.area.along((v - reach, v + reach));
        let v = bundle.map_or(v, |bundle| v + bundle.shift(i, lines.step()));
        let Some((start, end)) = range.filter(|_| is_drawn(i, layer.share)) else { continue };
        let row = row.over((start - reach, end + reach));
        job.budget.work(row.count() * cost as f64)?;
        let count = row.count() as u64;
        for place in 0..count {
            // The pen turns round at the end of every line.
            let Some((mark, u)) = row.place(if is_backwards { count - 1 - place } else { place }) else { continue };
            let u = bundle.map_or(u, |bundle| u + bundle.shift_along(i, mark, row.step()));
            let pull =
                Pull { taper: bundle.and_then(|bundle| bundle.taper(i)), ..Pull::mark(bundle, motif.hatch, i, mark) };
            let at = crate::geom::Vec2::new(u, v);
            for strokes in motif.figure.0.iter() {
                scratch.curves.chain.clear();
                scratch.curves.chain.extend(strokes.iter().map(|&p| p + at));
                stroke(job, layer, &pull, false, scratch, out)?;
            }
        }
        is_backwards = !is_backwards;
    }
    Ok(())
}
