//! Curved strokes: what is seen of them, cut out of the curves themselves.
//!
//! A stroke comes in as a chain of cubic Béziers in the layer's frame and goes out as parts of it, so that curves stay
//! curves. Like straight ones, strokes are cut by their centre lines to the tile and to what later tiles hide, there to
//! rounding, and in their whole width to the region, there within [`CUTTING`].

use crate::field::Node;
use crate::geom::bezier::cubics;
use crate::geom::clip::{Frame, Ranges, TOLERANCE};
use crate::geom::{Cubic, Figure, Length, Point, Rect, Vec2, chain};
use crate::region::FLATTENING;
use crate::scene::{Blend, Cap, Hatch};

use super::budget::{BANK, CURVE, DRAWN, Exceeded, SAMPLE};
use super::cutout::{Cutout, unite};
use super::edge::Bank;
use super::hand::Pull;
use super::job::{Job, Layer, Scratch as JobScratch};
use super::lattice::{Lattice, is_drawn};
use super::lines::spread;
use super::palette::Batch;
use super::run::Run;
use super::stroke::CRUMB;
use super::wander::Wander;

/// Where a curve comes near the region's outline it is looked at in steps of this many millimetres: ink reaches over the
/// outline by half of it at most, in notches that are narrower.
pub(super) const CUTTING: Length = Length::mm(0.02);

/// The farthest that circles drawn as Béziers may lie from circles.
pub(super) const ROUNDNESS: Length = FLATTENING;

/// The most curves of one stroke; more are finer than anything that can be seen.
const MOST_CURVES: f64 = 1e6;

/// How far along a stroke may wander into an area, for every millimetre that it comes off its line.
const MARGIN: f64 = 4.0;

/// Halvings in the search for the place where a curve crosses something.
const HALVINGS: usize = 30;

/// Curves along the lines of a lattice.
pub(super) trait Course: Sync {
    /// How far strokes reach to either side of their line, in millimetres.
    fn reach(&self) -> f64;

    /// What of the line at `v` may come into an area: a range along it.
    fn range(&self, area: &Cutout, v: f64) -> Option<(f64, f64)> {
        area.along((v - self.reach(), v + self.reach()))
    }

    /// About how many curves the stroke along a range has. It may be infinite.
    fn count(&self, range: (f64, f64)) -> f64;

    /// Appends the stroke of a line: its number, its place across the frame, and the range along it that is wanted at the
    /// least. Nothing is appended where the line has no stroke.
    fn trace(&self, number: i64, v: f64, range: (f64, f64), chain: &mut Vec<Point>);
}

/// Memory that is used again for every stroke.
#[derive(Default)]
pub(super) struct Scratch {
    /// The tile's own outline, over which strokes are spread.
    pub(super) whole: Cutout,
    /// What is drawn in.
    pub(super) area: Cutout,
    /// What strokes run on into.
    partner: Cutout,
    /// What is hidden; the list may be longer than there are covers.
    pub(super) hidden: Vec<Cutout>,
    /// The stroke at hand.
    pub(super) chain: Vec<Point>,
    /// Boxes around its curves.
    boxes: Vec<Rect>,
    /// A seen part of it.
    piece: Vec<Point>,
    /// What is left of it.
    pub(super) ranges: Ranges,
    pub(super) found: Vec<(f64, f64)>,
    spans: Vec<(f64, f64)>,
    /// From where to where strokes are drawn in one go, whatever hides parts of them.
    wholes: Vec<(f64, f64)>,
    run: Run,
}

/// Draws the strokes of a layer.
pub(super) fn draw(
    job: &Job<'_>,
    layer: &Layer<'_>,
    hatch: &Hatch,
    course: &impl Course,
    scratch: &mut JobScratch,
    out: &mut [Batch],
) -> Result<(), Exceeded> {
    let lattice = spread(job, layer, hatch, scratch);
    look(job, layer, scratch);
    let Some(bounds) = scratch.curves.area.bounds() else { return Ok(()) };
    // Strokes beside the tile swing into it.
    let reach = course.reach();
    let lattice = lattice.over((bounds.min.y - reach, bounds.max.y + reach));
    draw_lines(job, layer, hatch, course, lattice, scratch, out)
}

/// Draws the strokes along some lines; the outlines have been taken.
pub(super) fn draw_lines(
    job: &Job<'_>,
    layer: &Layer<'_>,
    hatch: &Hatch,
    course: &impl Course,
    lattice: Lattice,
    scratch: &mut JobScratch,
    out: &mut [Batch],
) -> Result<(), Exceeded> {
    job.budget.work(lattice.count() * CURVE as f64)?;
    let bundle = layer.bundle.as_ref();
    let length = scratch.whole.along().1 - scratch.whole.along().0;
    let mut is_backwards = false;
    for (i, v) in lattice.places() {
        if !is_drawn(i, layer.share) {
            continue;
        }
        let pull = Pull::line(bundle, hatch, i);
        let (v, wander) =
            bundle.map_or((v, Wander::NONE), |bundle| (v + bundle.shift(i, lattice.step()), bundle.wander(i, length)));
        let Some(mut range) = course.range(&scratch.curves.area, v) else { continue };
        if let Some(more) = layer.partner.and_then(|_| course.range(&scratch.curves.partner, v)) {
            range = (range.0.min(more.0), range.1.max(more.1));
        }
        // A stroke that wanders into the area there may come from farther along.
        let margin = MARGIN * wander.amplitude();
        let range = (range.0 - pull.over.0 - margin, range.1 + pull.over.1 + margin);
        trace(job, course, (i, v), range, &mut scratch.curves.chain)?;
        wander.bend(&mut scratch.curves.chain);
        if stroke(job, layer, &pull, is_backwards, scratch, out)? {
            is_backwards = !is_backwards;
        }
    }
    Ok(())
}

/// Takes the stroke of a line, if it has not too many curves.
pub(super) fn trace(
    job: &Job<'_>,
    course: &impl Course,
    (number, v): (i64, f64),
    range: (f64, f64),
    chain: &mut Vec<Point>,
) -> Result<(), Exceeded> {
    let count = course.count(range);
    if count.is_nan() || count > MOST_CURVES {
        return Err(Exceeded::Places { what: "curves", count: count as u64 });
    }
    job.budget.work(count * CURVE as f64)?;
    chain.clear();
    course.trace(number, v, range, chain);
    Ok(())
}

/// Takes the outlines of the layer and of the tiles that hide parts of it.
pub(super) fn look(job: &Job<'_>, layer: &Layer<'_>, scratch: &mut JobScratch) {
    let JobScratch { covers, curves, .. } = scratch;
    curves.whole.set(Figure::convex(layer.outline), &layer.frame);
    curves.area.set(layer.area, &layer.frame);
    if let Some(partner) = layer.partner {
        curves.partner.set(partner, &layer.frame);
    }
    if curves.hidden.len() < covers.len() {
        curves.hidden.resize_with(covers.len(), Cutout::default);
    }
    for (hidden, &cover) in curves.hidden.iter_mut().zip(covers.iter()) {
        hidden.set(job.nearby.figure(cover), &layer.frame);
    }
}

/// Draws what is seen of the stroke in `scratch`, and says whether anything is.
pub(super) fn stroke(
    job: &Job<'_>,
    layer: &Layer<'_>,
    pull: &Pull,
    is_backwards: bool,
    scratch: &mut JobScratch,
    out: &mut [Batch],
) -> Result<bool, Exceeded> {
    let (covers, looks) = (scratch.covers.len(), &mut scratch.looks);
    let Scratch { area, partner, hidden, chain, boxes, ranges, found, wholes, .. } = &mut scratch.curves;
    let bounds = chain::bounds(chain);
    if !area.may_meet(&bounds) {
        return Ok(false);
    }
    boxes.clear();
    boxes.extend(cubics(chain).map(Cubic::bounds));
    ranges.reset(0.0, boxes.len() as f64);
    area.cut_within(chain, boxes, ranges.as_slice(), found);
    wholes.clear();
    // Where the ground goes on with it, a stroke ends where the farther one of the tile and its cell does.
    if layer.partner.is_some() {
        wholes.append(found);
        partner.cut_within(chain, boxes, ranges.as_slice(), found);
        wholes.append(found);
        unite(wholes);
        area.cut_within(chain, boxes, ranges.as_slice(), found);
    } else {
        overshoot(chain, pull.over, found);
        wholes.extend_from_slice(found);
    }
    ranges.intersect(found);
    for cover in &mut hidden[..covers] {
        if ranges.is_empty() {
            return Ok(false);
        }
        job.budget.look(looks, 1)?;
        if cover.may_meet(&bounds) {
            job.budget.look(looks, boxes.len() as u64)?;
            cover.cut_within(chain, boxes, ranges.as_slice(), found);
            found.iter().for_each(|&(start, end)| ranges.subtract(start, end));
        }
    }
    contour(job, layer, pull.hatch.pitch, scratch)?;
    if layer.is_clipped {
        clip(job, &layer.frame, &pull.hatch, scratch)?;
    }
    emit(job, &layer.frame, pull, is_backwards, &mut scratch.curves, out)
}

/// Draws ranges of a chain out at both ends by so many millimetres, as far as the chain goes.
fn overshoot(chain: &[Point], over: (f64, f64), ranges: &mut Vec<(f64, f64)>) {
    if over == (0.0, 0.0) {
        return;
    }
    let end = chain::count(chain) as f64;
    let further = |s: f64, by: f64| {
        let speed = chain::at(chain, s).1.length();
        if speed > 0.0 { by / speed } else { 0.0 }
    };
    for range in ranges.iter_mut() {
        *range = ((range.0 - further(range.0, over.0)).max(0.0), (range.1 + further(range.1, over.1)).min(end));
    }
    unite(ranges);
}

/// Keeps the parts of the stroke where the field has this layer, if layers end along the field.
fn contour(job: &Job<'_>, layer: &Layer<'_>, pitch: Length, scratch: &mut JobScratch) -> Result<(), Exceeded> {
    let field = job.paint.tone.asked.field();
    if job.paint.tone.blend != Blend::Contour || matches!(field.node(), Node::Constant(_)) {
        return Ok(());
    }
    let threshold = f64::from(layer.number) - 0.5;
    let looks = &mut scratch.looks;
    let Scratch { chain, ranges, found, .. } = &mut scratch.curves;
    keep(chain, ranges, found, pitch.to_mm() / 2.0, |p, _| {
        job.budget.look(looks, SAMPLE)?;
        Ok((field.at(layer.frame.page(p.x, p.y)) >= threshold, 0.0))
    })
}

/// Keeps the parts of the stroke that lie in the region in their whole width.
pub(super) fn clip(job: &Job<'_>, frame: &Frame, hatch: &Hatch, scratch: &mut JobScratch) -> Result<(), Exceeded> {
    let looks = &mut scratch.looks;
    let Scratch { chain, ranges, found, spans, .. } = &mut scratch.curves;
    let half = hatch.pen.to_mm() / 2.0;
    keep(chain, ranges, found, CUTTING.to_mm(), |p, way| {
        job.budget.look(looks, BANK)?;
        let side = page_way(frame, way).turned().unit().map(|normal| normal * half);
        Ok(nib(job.bank, frame.page(p.x, p.y), side, half, hatch.cap, spans))
    })
}

/// A way in the frame as one on the page.
fn page_way(frame: &Frame, way: Vec2) -> Vec2 {
    frame.along * way.x + frame.along.turned() * way.y
}

/// Whether the nib at a place lies in the region, and how far the place can move without a change. A nib is as wide as the
/// stroke and has no length; of a stroke with round ends it is a disc.
fn nib(
    bank: &Bank<'_>,
    place: Point,
    side: Option<Vec2>,
    half: f64,
    cap: Cap,
    spans: &mut Vec<(f64, f64)>,
) -> (bool, f64) {
    let distance = bank.distance(place);
    match (cap, side) {
        (Cap::Butt, Some(side)) if (0.0..half).contains(&distance) => {
            (bank.holds_line(place + -side, place + side, spans), 0.0)
        }
        (Cap::Butt, _) if distance < half => (false, -distance),
        (Cap::Butt | Cap::Round, _) => (distance >= half, (distance - half).abs()),
    }
}

/// Keeps of some ranges of a chain what something holds for. It is told place and way, and tells whether it holds and how
/// many millimetres on nothing can change; otherwise it is asked again after `step` millimetres.
pub(super) fn keep<E>(
    chain: &[Point],
    ranges: &mut Ranges,
    found: &mut Vec<(f64, f64)>,
    step: f64,
    mut holds: impl FnMut(Point, Vec2) -> Result<(bool, f64), E>,
) -> Result<(), E> {
    found.clear();
    let mut ask = |s: f64| {
        let (place, way) = chain::at(chain, s);
        holds(place, way)
    };
    for &(start, end) in ranges.as_slice() {
        let (mut s, mut from) = (start, start);
        let (mut was_in, mut free) = ask(s)?;
        while s < end {
            let Some((cubic, t)) = chain::locate(chain, s) else { break };
            let [a, b, c, d] = cubic.0;
            let speed = 3.0 * a.distance(b).max(b.distance(c)).max(c.distance(d));
            // Rounding must not keep the place where it is.
            let on = (free.max(step) / speed).max(1e-9);
            let next = if on < 1.0 - t { s + on } else { s - t + 1.0 }.min(end);
            let (now_in, next_free) = ask(next)?;
            if now_in != was_in {
                let (mut low, mut high) = (s, next);
                for _ in 0..HALVINGS {
                    let middle = (low + high) / 2.0;
                    if ask(middle)?.0 == was_in { low = middle } else { high = middle }
                }
                // The side on which it holds.
                if was_in {
                    found.push((from, low));
                } else {
                    from = high;
                }
                was_in = now_in;
            }
            (s, free) = (next, next_free);
        }
        if was_in {
            found.push((from, end));
        }
    }
    found.retain(|range| range.0 < range.1);
    ranges.intersect(found);
    Ok(())
}

/// Draws the ranges of the stroke in `scratch` that are long enough, and says whether any is.
pub(super) fn emit(
    job: &Job<'_>,
    frame: &Frame,
    pull: &Pull,
    is_backwards: bool,
    scratch: &mut Scratch,
    out: &mut [Batch],
) -> Result<bool, Exceeded> {
    let Scratch { chain, ranges, piece, wholes, run, .. } = scratch;
    let out = &mut out[pull.weight];
    let end = chain::count(chain) as f64;
    let before = out.len();
    let mut draw = |ranges: &[(f64, f64)]| -> Result<(), Exceeded> {
        piece.clear();
        let taper = match ranges {
            [range] => run.out(chain, wholes, pull, *range),
            // A closed stroke has no end to run out at.
            _ => None,
        };
        match taper {
            Some(_) => run.joints().windows(2).for_each(|pair| chain::part(chain, (pair[0], pair[1]), piece)),
            None => ranges.iter().for_each(|&range| chain::part(chain, range, piece)),
        }
        // A stroke of which nothing was cut is meant to be as short as it is.
        let is_whole = matches!(ranges, [(from, to)] if *from == 0.0 && *to == end);
        if is_whole || is_long(piece, pull.hatch.shortest) {
            job.budget.work((chain::count(piece) as u64 * DRAWN) as f64)?;
            piece.iter_mut().for_each(|p| *p = frame.page(p.x, p.y));
            if is_backwards {
                piece.reverse();
            }
            match taper {
                Some(taper) => out.tapers.push(piece, run.widths(&taper, pull, is_backwards)),
                None => out.curves.push(piece),
            }
        }
        Ok(())
    };
    let (middle, ends) = pieces(chain, ranges.as_slice());
    for i in 0..middle.len() {
        draw(&[middle[if is_backwards { middle.len() - 1 - i } else { i }]])?;
    }
    if let Some(ends) = ends {
        draw(&ends)?;
    }
    if out.len() > job.budget.limit() { Err(Exceeded::Marks) } else { Ok(out.len() > before) }
}

/// The ranges of a chain that are strokes by themselves, and two that are one.
type Strokes<'r> = (&'r [(f64, f64)], Option<[(f64, f64); 2]>);

/// The ranges of a chain that are strokes by themselves, and the two that are one: a closed chain that is cut elsewhere runs
/// on through its first point.
pub(super) fn pieces<'r>(chain: &[Point], ranges: &'r [(f64, f64)]) -> Strokes<'r> {
    let end = chain::count(chain) as f64;
    match ranges {
        [first, middle @ .., last] if chain.first() == chain.last() && first.0 == 0.0 && last.1 == end => {
            (middle, Some([*last, *first]))
        }
        ranges => (ranges, None),
    }
}

/// Whether a chain is no crumb.
pub(super) fn is_long(chain: &[Point], shortest: Length) -> bool {
    let shortest = (shortest.to_mm() - TOLERANCE).max(CRUMB);
    let (Some(&start), Some(&end)) = (chain.first(), chain.last()) else { return false };
    // The chord is no longer than the curve and quicker to measure.
    start.distance(end) >= shortest || chain::length(chain) >= shortest
}

/// The middle and the radius of a disc that holds a box.
pub(super) fn disc(bounds: &Rect) -> (Point, f64) {
    (bounds.centre(), Vec2::new(bounds.width(), bounds.height()).length() / 2.0)
}
