//! Hatching with parallel strokes.
//!
//! Strokes are cut by their centre lines to the tile and to what later tiles hide, so that butt ends meet the edges of
//! tiles, and in their whole width to the region. Whatever is then too short is dropped.

use crate::field::Node;
use crate::geom::Length;
use crate::geom::clip::{Frame, Profile};
use crate::scene::{Blend, Hatch};

use super::budget::{BANK, Exceeded, LINE, PROFILE, SAMPLE};
use super::dashes::Dashes;
use super::hand::Line;
use super::job::{Job, Layer, Scratch};
use super::lattice::{Lattice, is_drawn};
use super::palette::Batch;
use super::stroke::Stroke;

/// Halvings in the search for the place where a layer ends along the field: from a tenth of a millimetre to a millionth.
const HALVINGS: usize = 24;

/// Draws the lines of a layer, or dashes along them.
pub(super) fn draw(
    job: &Job<'_>,
    layer: &Layer<'_>,
    hatch: &Hatch,
    dashes: Option<&Dashes>,
    scratch: &mut Scratch,
    out: &mut [Batch],
) -> Result<(), Exceeded> {
    let (lattice, frame, length) = spread(job, layer, hatch, scratch);
    job.budget.work(lattice.count() * LINE as f64)?;
    set_shadows(job, layer, &frame, scratch);
    let bundle = layer.bundle.as_ref();
    let mut is_backwards = false;
    for (i, v) in lattice.places() {
        if !is_drawn(i, layer.share) {
            continue;
        }
        let line = bundle
            .map_or_else(|| Line::ruled(&frame, i, v), |bundle| bundle.line(&frame, (i, v), lattice.step(), length));
        if line.frame != frame {
            job.budget.look(&mut scratch.looks, PROFILE * (1 + scratch.covers.len() as u64))?;
            scratch.area.set(layer.area, &line.frame);
            set_shadows(job, layer, &line.frame, scratch);
        }
        let Some(whole) = ends(layer, &line, scratch) else { continue };
        let mut looks = 0;
        for shadow in &scratch.shadows[..scratch.covers.len()] {
            if scratch.ranges.is_empty() {
                break;
            }
            looks += 1;
            if let Some((start, end)) = line.meet(shadow) {
                scratch.ranges.subtract(start, end);
            }
        }
        job.budget.look(&mut scratch.looks, looks)?;
        contour(job, layer, &line, hatch.pitch, scratch)?;
        let stroke = Stroke::new(line, bundle, hatch, whole, is_backwards);
        if layer.is_clipped && !scratch.ranges.is_empty() {
            job.budget.look(&mut scratch.looks, BANK)?;
            job.bank.clip(&line.frame, line.v, stroke.nib(hatch), &mut scratch.ranges, &mut scratch.edge);
        }
        if scratch.ranges.is_empty() {
            continue;
        }
        stroke.emit(job, hatch, dashes, scratch, out)?;
        is_backwards = !is_backwards;
    }
    Ok(())
}

/// Takes the profiles of the layer and spreads lines over it. The frame that the hand turns them to and the length of the
/// tile along its own are given back as well.
pub(super) fn spread(job: &Job<'_>, layer: &Layer<'_>, hatch: &Hatch, scratch: &mut Scratch) -> (Lattice, Frame, f64) {
    scratch.whole.set(layer.outline, &layer.frame);
    let frame = layer.bundle.as_ref().map_or(layer.frame, |bundle| bundle.turned(&layer.frame));
    scratch.area.set(layer.area, &frame);
    let pitch = hatch.pitch.to_mm();
    let (low, high) = scratch.whole.across();
    let lattice = if job.paint.tone.shape.is_cell() {
        Lattice::cell((low, high), 0.0, pitch)
    } else {
        Lattice::stamp((low, high), pitch, hatch.inset, layer.number)
    };
    let along = scratch.whole.along();
    let length = along.1 - along.0;
    let lattice = if layer.is_continued { lattice.over(scratch.area.across()) } else { lattice };
    (lattice, frame, length)
}

/// Takes the profiles of what strokes run on into and of the tiles that hide parts of them, along a frame.
fn set_shadows(job: &Job<'_>, layer: &Layer<'_>, frame: &Frame, scratch: &mut Scratch) {
    if let Some(partner) = layer.partner {
        scratch.partner.set(partner, frame);
    }
    let count = scratch.covers.len();
    if scratch.shadows.len() < count {
        scratch.shadows.resize_with(count, Profile::default);
    }
    for (shadow, &cover) in scratch.shadows.iter_mut().zip(&scratch.covers) {
        shadow.set(job.nearby.outline(cover), frame);
    }
}

/// Leaves in `scratch.ranges` what the area has of a line. From where to where the stroke along it is drawn in one go is
/// given back: where the ground continues tiles, a stroke ends at the farther one of the tile's edge and its cell's.
fn ends(layer: &Layer<'_>, line: &Line, scratch: &mut Scratch) -> Option<(f64, f64)> {
    let own = line.meet(&scratch.area)?;
    scratch.ranges.reset(own.0, own.1);
    let Some(bundle) = &layer.bundle else { return Some(own) };
    let partner = layer.partner.and_then(|_| line.meet(&scratch.partner));
    let (tile, cell) = match (layer.is_continued, partner) {
        (false, partner) => (own, partner.unwrap_or(own)),
        (true, Some(tile)) => (tile, own),
        (true, None) => return Some(own),
    };
    // Beyond a tile's edge its strokes overshoot, beyond a cell's they do not.
    let over = bundle.overshoots(line.number);
    let start = if cell.0 < tile.0 { cell.0 } else { tile.0 - over.0 };
    let end = if cell.1 > tile.1 { cell.1 } else { tile.1 + over.1 };
    if !layer.is_continued {
        scratch.ranges.reset(if cell.0 < tile.0 { own.0 } else { start }, if cell.1 > tile.1 { own.1 } else { end });
    }
    Some((start, end))
}

/// Keeps the parts of a line where the field has this layer, if layers end along the field.
fn contour(
    job: &Job<'_>,
    layer: &Layer<'_>,
    line: &Line,
    pitch: Length,
    scratch: &mut Scratch,
) -> Result<(), Exceeded> {
    let field = &job.paint.tone.k;
    if job.paint.tone.blend != Blend::Contour || matches!(field.node(), Node::Constant(_)) {
        return Ok(());
    }
    let threshold = f64::from(layer.number) - 0.5;
    let is_in = |u: f64| field.at(line.page(u)) >= threshold;
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
