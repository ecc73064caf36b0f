//! Hatching with parallel strokes.
//!
//! Strokes are cut by their centre lines to the tile and to what later tiles hide, so that butt ends meet the edges of
//! tiles, and in their whole width to the region. Whatever is then too short is dropped.

use crate::field::Node;
use crate::geom::Length;
use crate::geom::clip::Frame;
use crate::scene::{Blend, Hatch};

use super::budget::{BANK, Exceeded, LINE, PROFILE, SAMPLE};
use super::dashes::Dashes;
use super::job::{Job, Layer, Scratch};
use super::lattice::{Lattice, is_drawn};
use super::palette::Batch;
use super::silhouette::Silhouette;
use super::stroke::Stroke;
use super::wander::Line;

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
    let lattice = spread(job, layer, hatch, scratch);
    job.budget.work(lattice.count() * LINE as f64)?;
    set_shadows(job, layer, &layer.frame, scratch);
    let length = scratch.whole.along().1 - scratch.whole.along().0;
    let bundle = layer.bundle.as_ref();
    let mut is_backwards = false;
    for (i, v) in lattice.places() {
        if !is_drawn(i, layer.share) {
            continue;
        }
        let line = bundle.map_or_else(
            || Line::ruled(&layer.frame, i, v),
            |bundle| bundle.line(&layer.frame, (i, v), lattice.step(), length),
        );
        if line.frame != layer.frame {
            job.budget.look(&mut scratch.looks, PROFILE * (1 + scratch.covers.len() as u64))?;
            scratch.area.set(layer.area, &line.frame);
            set_shadows(job, layer, &line.frame, scratch);
        }
        ends(layer, &line, scratch);
        let mut looks = 0;
        for shadow in &scratch.shadows[..scratch.covers.len()] {
            if scratch.ranges.is_empty() {
                break;
            }
            looks += 1;
            let ranges = &mut scratch.ranges;
            shadow.spans(&line, |(start, end)| ranges.subtract(start, end));
        }
        job.budget.look(&mut scratch.looks, looks)?;
        contour(job, layer, &line, hatch.pitch, scratch)?;
        let stroke = Stroke::new(line, bundle, hatch, is_backwards);
        if layer.is_clipped && !scratch.ranges.is_empty() {
            job.budget.look(&mut scratch.looks, BANK)?;
            job.bank.clip(&line.frame, line.v, stroke.nib(), &mut scratch.ranges, &mut scratch.edge);
        }
        if scratch.ranges.is_empty() {
            continue;
        }
        stroke.emit(job, dashes, scratch, out)?;
        is_backwards = !is_backwards;
    }
    Ok(())
}

/// Takes the silhouettes of the layer and spreads lines over it. How the hand turns them makes no difference to their number.
pub(super) fn spread(job: &Job<'_>, layer: &Layer<'_>, hatch: &Hatch, scratch: &mut Scratch) -> Lattice {
    scratch.whole.set(layer.outline, &layer.unturned);
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

/// Takes the silhouettes of what strokes run on into and of the tiles that hide parts of them, along a frame.
fn set_shadows(job: &Job<'_>, layer: &Layer<'_>, frame: &Frame, scratch: &mut Scratch) {
    if let Some(partner) = layer.partner {
        scratch.partner.set(partner, frame);
    }
    let count = scratch.covers.len();
    if scratch.shadows.len() < count {
        scratch.shadows.resize_with(count, Silhouette::default);
    }
    for (shadow, &cover) in scratch.shadows.iter_mut().zip(&scratch.covers) {
        shadow.set(job.nearby.figure(cover), frame);
    }
}

/// Leaves in `scratch.ranges` what the area has of a line, and in `scratch.wholes` from where to where the strokes along it
/// are drawn in one go, whatever hides parts of them. Where the ground continues tiles, a stroke ends at the farther one of
/// the tile's edge and its cell's.
fn ends(layer: &Layer<'_>, line: &Line, scratch: &mut Scratch) {
    let Scratch { area, partner, ranges, others, wholes, .. } = scratch;
    area.ranges(line, others);
    wholes.clear();
    wholes.extend_from_slice(others);
    let (Some(bundle), Some(&first), Some(&last)) = (&layer.bundle, others.first(), others.last()) else {
        ranges.set(others);
        return;
    };
    let over = bundle.overshoots(line.number);
    if layer.partner.is_none() {
        // Neighbours that overshoot into each other are one.
        wholes.iter_mut().for_each(|whole| *whole = (whole.0 - over.0, whole.1 + over.1));
        wholes.dedup_by(|next, whole| {
            let touches = next.0 <= whole.1;
            if touches {
                whole.1 = next.1;
            }
            touches
        });
        ranges.set(wholes);
        return;
    }
    let own = (first.0, last.1);
    let mut other: Option<(f64, f64)> = None;
    partner.spans(line, |(start, end)| {
        other = Some(other.map_or((start, end), |other| (other.0.min(start), other.1.max(end))));
    });
    let (tile, cell) = match (layer.is_continued, other) {
        (false, other) => (own, other.unwrap_or(own)),
        (true, Some(tile)) => (tile, own),
        (true, None) => {
            ranges.set(others);
            return;
        }
    };
    // Beyond a tile's edge its strokes overshoot, beyond a cell's they do not.
    let whole = (
        if cell.0 < tile.0 { cell.0 } else { tile.0 - over.0 },
        if cell.1 > tile.1 { cell.1 } else { tile.1 + over.1 },
    );
    wholes.clear();
    wholes.push(whole);
    if !layer.is_continued {
        if let Some(first) = others.first_mut().filter(|_| cell.0 >= tile.0) {
            first.0 = whole.0;
        }
        if let Some(last) = others.last_mut().filter(|_| cell.1 <= tile.1) {
            last.1 = whole.1;
        }
    }
    ranges.set(others);
}

/// Keeps the parts of a line where the field has this layer, if layers end along the field.
fn contour(
    job: &Job<'_>,
    layer: &Layer<'_>,
    line: &Line,
    pitch: Length,
    scratch: &mut Scratch,
) -> Result<(), Exceeded> {
    let field = job.paint.tone.asked.field();
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
