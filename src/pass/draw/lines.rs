//! Hatching with parallel strokes.
//!
//! Strokes are cut by their centre lines to the tile and to what later tiles hide, so that butt ends meet the edges of
//! tiles, and in their whole width to the region. Whatever is then too short is dropped.

use crate::field::Node;
use crate::geom::Length;
use crate::geom::clip::{Frame, TOLERANCE};
use crate::scene::{Blend, Hatch};

use super::budget::{BANK, Exceeded, LINE, SAMPLE};
use super::dashes::Dashes;
use super::job::{Job, Layer, Scratch};
use super::lattice::{Lattice, is_drawn};
use super::palette::Batch;
use super::silhouette::Silhouette;

/// Halvings in the search for the place where a layer ends along the field: from a tenth of a millimetre to a millionth.
const HALVINGS: usize = 24;

/// Draws the lines of a layer, or dashes along them.
pub(super) fn draw(
    job: &Job<'_>,
    layer: &Layer<'_>,
    hatch: &Hatch,
    dashes: Option<&Dashes>,
    scratch: &mut Scratch,
    out: &mut Batch,
) -> Result<(), Exceeded> {
    let lattice = spread(job, layer, hatch, scratch);
    job.budget.work(lattice.count() * LINE as f64)?;
    set_shadows(job, layer, scratch);
    let mut is_backwards = false;
    for (i, v) in lattice.places() {
        if !is_drawn(i, layer.share) {
            continue;
        }
        scratch.area.ranges(v, &mut scratch.others);
        scratch.ranges.set(&scratch.others);
        let mut looks = 0;
        for shadow in &scratch.shadows[..scratch.covers.len()] {
            if scratch.ranges.is_empty() {
                break;
            }
            looks += 1;
            let ranges = &mut scratch.ranges;
            shadow.spans(v, |(start, end)| ranges.subtract(start, end));
        }
        job.budget.look(&mut scratch.looks, looks)?;
        contour(job, layer, v, hatch.pitch, scratch)?;
        if layer.is_clipped && !scratch.ranges.is_empty() {
            job.budget.look(&mut scratch.looks, BANK)?;
            job.bank.clip(&layer.frame, v, hatch, &mut scratch.ranges, &mut scratch.edge);
        }
        if scratch.ranges.is_empty() {
            continue;
        }
        let line = Line { frame: &layer.frame, number: i, v, is_backwards };
        line.emit(job, hatch, dashes, scratch, out)?;
        is_backwards = !is_backwards;
    }
    Ok(())
}

/// Takes the profiles of the layer and spreads lines over it.
pub(super) fn spread(job: &Job<'_>, layer: &Layer<'_>, hatch: &Hatch, scratch: &mut Scratch) -> Lattice {
    scratch.whole.set(layer.outline, &layer.frame);
    scratch.area.set(layer.area, &layer.frame);
    let pitch = hatch.pitch.to_mm();
    let (low, high) = scratch.whole.across();
    let lattice = if job.paint.tone.shape.is_cell() {
        Lattice::cell((low, high), 0.0, pitch)
    } else {
        Lattice::stamp((low, high), pitch, hatch.inset, layer.number)
    };
    if layer.is_continued { lattice.over(scratch.area.across()) } else { lattice }
}

/// Where lines lie, and marks along them, so that no mark falls on one of an earlier layer.
///
/// All layers stand on one lattice of half the pitch and half the spacing, turned with the tile, of which each takes a
/// quarter: the second the middles of the first one's fields, the third and fourth the middles of their sides. The second
/// layer makes the marks of the first denser by the square root of two and turns their lattice by 45 degrees, where pitch
/// and spacing are equal; with the fourth it is square again, at half the distance. Tone grows evenly with every layer.
pub(super) fn interleaved(
    job: &Job<'_>,
    layer: &Layer<'_>,
    hatch: &Hatch,
    spacing: Length,
    scratch: &mut Scratch,
) -> (Lattice, Lattice) {
    let lines = spread(job, layer, hatch, scratch);
    let along = scratch.whole.along();
    let row = if job.paint.tone.shape.is_cell() {
        Lattice::cell(along, 0.0, spacing.to_mm())
    } else {
        Lattice::stamp(along, spacing.to_mm(), 0.5, 1)
    };
    match layer.number {
        0 | 1 => (lines, row),
        2 => (lines.moved(0.5), row.moved(0.5)),
        3 => (lines, row.moved(0.5)),
        _ => (lines.moved(0.5), row),
    }
}

/// Takes the silhouettes of the tiles that hide parts of this one.
fn set_shadows(job: &Job<'_>, layer: &Layer<'_>, scratch: &mut Scratch) {
    let count = scratch.covers.len();
    if scratch.shadows.len() < count {
        scratch.shadows.resize_with(count, Silhouette::default);
    }
    for (shadow, &cover) in scratch.shadows.iter_mut().zip(&scratch.covers) {
        shadow.set(job.nearby.figure(cover), &layer.frame);
    }
}

/// Keeps the parts of a line where the field has this layer, if layers end along the field.
fn contour(job: &Job<'_>, layer: &Layer<'_>, v: f64, pitch: Length, scratch: &mut Scratch) -> Result<(), Exceeded> {
    let field = &job.paint.tone.k;
    if job.paint.tone.blend != Blend::Contour || matches!(field.node(), Node::Constant(_)) {
        return Ok(());
    }
    let threshold = f64::from(layer.number) - 0.5;
    let is_in = |u: f64| field.at(layer.frame.page(u, v)) >= threshold;
    scratch.others.clear();
    for &(start, end) in scratch.ranges.as_slice() {
        let steps = ((end - start) / (pitch.to_mm() / 2.0)).ceil().max(1.0);
        job.budget.work(steps * SAMPLE as f64)?;
        let at = |step: f64| if step < steps { start + (end - start) * (step / steps) } else { end };
        let mut was_in = is_in(start);
        let mut from = start;
        let mut step = 1.0;
        while step <= steps {
            let u = at(step);
            let now_in = is_in(u);
            if now_in != was_in {
                let crossing = cross(at(step - 1.0), u, |u| is_in(u) == was_in);
                if was_in {
                    scratch.others.push((from, crossing));
                }
                (from, was_in) = (crossing, now_in);
            }
            step += 1.0;
        }
        if was_in {
            scratch.others.push((from, end));
        }
    }
    scratch.ranges.intersect(&scratch.others);
    Ok(())
}

/// Where between `low` and `high` something ceases to hold.
fn cross(mut low: f64, mut high: f64, holds: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..HALVINGS {
        let middle = (low + high) / 2.0;
        if holds(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    (low + high) / 2.0
}

/// Pieces of no more than this many millimetres are rounding, however short strokes may be.
pub(super) const CRUMB: f64 = 1e-6;

/// A line of which some ranges are to be drawn.
pub(super) struct Line<'a> {
    pub(super) frame: &'a Frame,
    /// Its number in the lattice.
    pub(super) number: i64,
    /// Its place across the frame.
    pub(super) v: f64,
    /// Whether the pen comes from the far end: it turns round at the end of every line.
    pub(super) is_backwards: bool,
}

impl Line<'_> {
    /// Draws what is left in `scratch.ranges` and long enough.
    pub(super) fn emit(
        &self,
        job: &Job<'_>,
        hatch: &Hatch,
        dashes: Option<&Dashes>,
        scratch: &mut Scratch,
        out: &mut Batch,
    ) -> Result<(), Exceeded> {
        let mut shortest = hatch.shortest.to_mm();
        if let Some(dashes) = dashes {
            scratch.others.clear();
            for &range in scratch.ranges.as_slice() {
                job.budget.work(dashes.count(range))?;
                dashes.cut(range, (self.number, self.v), &mut scratch.others);
            }
            scratch.ranges.intersect(&scratch.others);
            // Dashes that are meant to be short are not too short.
            shortest = shortest.min(dashes.length());
        }
        let shortest = (shortest - TOLERANCE).max(CRUMB);
        let start = out.lines.len();
        for &(from, to) in scratch.ranges.as_slice() {
            if to - from >= shortest {
                out.lines.push([self.frame.page(from, self.v), self.frame.page(to, self.v)]);
            }
        }
        if self.is_backwards {
            out.lines[start..].reverse();
            out.lines[start..].iter_mut().for_each(|line| line.reverse());
        }
        if out.lines.len() > job.budget.limit() { Err(Exceeded::Marks) } else { Ok(()) }
    }
}
