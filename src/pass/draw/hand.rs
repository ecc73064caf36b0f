//! How a hand draws the strokes of a bundle: what it is asked to stray by, and where it strays to.
//!
//! Each of the six ways of straying has a table of random numbers of its own for every tile, read by layer and line, so
//! that switching one on, or hiding a stroke, leaves all others where they were.

use crate::geom::clip::{Frame, Profile};
use crate::geom::{Angle, Length, Point};
use crate::random::{Key, Table};
use crate::scene::{Hand, Hatch, Paint};

use super::silhouette::Meet;

/// How many widths the strokes of a pen have where the hand changes it: marks are grouped by their width.
pub(super) const WEIGHTS: usize = 17;

/// The plain width stands in their middle.
const MIDDLE: f64 = 8.0;

/// A stroke turns against its bundle by this share of what bundles turn by.
const OWN_TURN: f64 = 0.25;

/// The length of a wave that a stroke wanders along, in millimetres: about as much as fingers draw without the wrist.
const WAVE: f64 = 4.0;

/// A stroke of a short bundle wanders too: a wave is at most this share of the bundle's length.
const WAVE_SHARE: f64 = 0.5;

/// How much of a stroke's wandering its whole bundle shares, the turn of the wrist.
const SHARED: f64 = 0.5;

/// A smooth curve through numbers between -1 and 1 reaches 1.25 at most (Catmull and Rom 1974, half way between two equal
/// ones whose neighbours lie opposite).
const CURVE: f64 = 0.8;

/// A curve through such numbers rises by no more than this in one step from number to number.
const STEEPEST: f64 = 3.0;

/// Along a stroke that runs out, measured from its tip: the share of the way, and the share of the full width there. A nib
/// that is lifted narrows slowly at first.
const TIP: [(f64, f64); 3] = [(0.0, 0.0), (0.35, 0.5), (1.0, 1.0)];

/// Differences of less mean nothing in shares of a width.
const ROUNDING: f64 = 1e-9;

/// The least share of the taper that a stroke's own may be.
const LEAST_TAPER: f64 = 0.7;

/// Rows of a tile's table: those of layers are their numbers, and this is the ground's.
pub(super) const GROUND: i64 = 0;

/// The row of a layer's table that all its lines share.
const BUNDLE: i64 = i64::MIN;

/// The width that a stroke of a pen has by its weight.
pub(super) fn weighed(pen: Length, hand: &Hand, weight: usize) -> Length {
    if hand.pen == 0.0 { pen } else { pen * (1.0 + hand.pen * (weight as f64 - MIDDLE) / MIDDLE) }
}

/// How many weights the strokes of a pen have.
pub(super) fn weights(hand: &Hand) -> usize {
    if hand.pen == 0.0 { 1 } else { WEIGHTS }
}

/// One layer of one tile as a hand draws it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bundle {
    hand: Hand,
    angle: Table,
    spacing: Table,
    pen: Table,
    taper: Table,
    overshoot: Table,
    wobble: Table,
}

impl Bundle {
    /// `tile` is the number that random draws for the tile are keyed by.
    pub(super) fn new(paint: &Paint, tile: usize, layer: i64) -> Self {
        let hand = paint.tone.hand;
        let table = |purpose: &str, is_used: bool| {
            let key = Key { seed: paint.seed, name: &paint.name, purpose };
            if is_used { key.table(tile).row(layer) } else { Table::ZERO }
        };
        Self {
            hand,
            angle: table("hand angle", hand.angle > Angle::ZERO),
            spacing: table("hand spacing", hand.spacing > 0.0),
            pen: table("hand pen", hand.pen > 0.0),
            taper: table("hand taper", hand.taper > 0.0),
            overshoot: table("hand overshoot", hand.overshoot > Length::ZERO),
            wobble: table("hand wobble", hand.wobble > Length::ZERO),
        }
    }

    /// The bundle of a ground, which is turned by nothing and has no tile to overshoot.
    pub(super) fn ground(paint: &Paint) -> Self {
        let mut bundle = Self::new(paint, usize::MAX, GROUND);
        bundle.hand = Hand { angle: Angle::ZERO, taper: 0.0, overshoot: Length::ZERO, ..bundle.hand };
        bundle
    }

    /// What the hand is asked for.
    pub(super) fn hand(&self) -> &Hand {
        &self.hand
    }

    /// The frame of the bundle's lines, turned about its origin.
    pub(super) fn turned(&self, frame: &Frame) -> Frame {
        if self.hand.angle == Angle::ZERO {
            return *frame;
        }
        turned(frame, self.hand.angle * self.angle.stray(BUNDLE))
    }

    /// How far a line lies off its place in millimetres.
    pub(super) fn shift(&self, number: i64, step: f64) -> f64 {
        if self.hand.spacing == 0.0 { 0.0 } else { self.hand.spacing * step * self.spacing.stray(number) }
    }

    /// How far a mark on a line lies off its place along it in millimetres.
    pub(super) fn shift_along(&self, number: i64, mark: i64, step: f64) -> f64 {
        if self.hand.spacing == 0.0 { 0.0 } else { self.hand.spacing * step * self.spacing.row(number).stray(mark) }
    }

    /// The weight of a line, below [`weights`].
    pub(super) fn weight(&self, number: i64) -> usize {
        if self.hand.pen == 0.0 { 0 } else { (MIDDLE + (self.pen.stray(number) * MIDDLE).round()) as usize }
    }

    /// The weight of a mark on a line.
    pub(super) fn weight_of(&self, number: i64, mark: i64) -> usize {
        if self.hand.pen == 0.0 { 0 } else { (MIDDLE + (self.pen.row(number).stray(mark) * MIDDLE).round()) as usize }
    }

    /// How far a line runs beyond both its ends in millimetres.
    pub(super) fn overshoots(&self, number: i64) -> (f64, f64) {
        if self.hand.overshoot == Length::ZERO {
            return (0.0, 0.0);
        }
        let (row, most) = (self.overshoot.row(number), self.hand.overshoot.to_mm());
        (most * row.unit(0), most * row.unit(1))
    }

    /// How a line's width runs out.
    pub(super) fn taper(&self, number: i64) -> Option<Taper> {
        if self.hand.taper == 0.0 {
            return None;
        }
        let share = self.hand.taper * (LEAST_TAPER + (1.0 - LEAST_TAPER) * self.taper.unit(number));
        // All strokes of a bundle are pulled one way.
        Some(Taper { share, is_at_start: self.taper.unit(BUNDLE) < 0.5 })
    }

    /// How a line of a bundle of this length in millimetres wanders.
    pub(super) fn wander(&self, number: i64, length: f64) -> Wander {
        let wave = WAVE.min(length * WAVE_SHARE);
        if self.hand.wobble == Length::ZERO || wave <= 0.0 {
            return Wander::NONE;
        }
        let shared = self.wobble.row(BUNDLE);
        Wander {
            amplitude: self.hand.wobble.to_mm(),
            wave,
            phase: self.wobble.unit(BUNDLE),
            shared,
            own: self.wobble.row(number),
        }
    }

    /// A line at place `v` of the bundle's own frame.
    pub(super) fn line(&self, frame: &Frame, (number, v): (i64, f64), step: f64, length: f64) -> Line {
        let v = v + self.shift(number, step);
        let wander = self.wander(number, length);
        if self.hand.angle == Angle::ZERO {
            return Line { frame: *frame, number, v, wander };
        }
        let turn = self.hand.angle * (OWN_TURN * self.angle.stray(number));
        let frame = turned(&Frame::new(frame.page(0.0, v), frame.along), turn);
        Line { frame, number, v: 0.0, wander }
    }
}

fn turned(frame: &Frame, by: Angle) -> Frame {
    let turn = by.unit();
    Frame::new(frame.origin, frame.along * turn.x + frame.along.turned() * turn.y)
}

/// How one stroke or mark of a hatch is drawn.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pull {
    /// The hatch, with the stroke's own width.
    pub(super) hatch: Hatch,
    /// Its place among the weights of its pen.
    pub(super) weight: usize,
    pub(super) taper: Option<Taper>,
    /// How far it runs beyond both its ends in millimetres.
    pub(super) over: (f64, f64),
}

impl Pull {
    /// The stroke along a line.
    pub(super) fn line(bundle: Option<&Bundle>, hatch: &Hatch, number: i64) -> Self {
        let Some(bundle) = bundle else { return Self::ruled(hatch) };
        let (taper, over) = (bundle.taper(number), bundle.overshoots(number));
        Self { taper, over, ..Self::weighed(bundle, hatch, bundle.weight(number)) }
    }

    /// A mark on a line, which is whole in itself and overshoots nothing.
    pub(super) fn mark(bundle: Option<&Bundle>, hatch: &Hatch, number: i64, mark: i64) -> Self {
        let Some(bundle) = bundle else { return Self::ruled(hatch) };
        Self::weighed(bundle, hatch, bundle.weight_of(number, mark))
    }

    fn weighed(bundle: &Bundle, hatch: &Hatch, weight: usize) -> Self {
        let pen = weighed(hatch.pen, &bundle.hand, weight);
        Self { hatch: Hatch { pen, ..*hatch }, weight, taper: None, over: (0.0, 0.0) }
    }

    fn ruled(hatch: &Hatch) -> Self {
        Self { hatch: *hatch, weight: 0, taper: None, over: (0.0, 0.0) }
    }
}

/// A line that strokes are drawn along.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line {
    pub(super) frame: Frame,
    /// Its number in the lattice.
    pub(super) number: i64,
    /// Its place across the frame.
    pub(super) v: f64,
    /// How it wanders about that place.
    pub(super) wander: Wander,
}

impl Line {
    /// A line that does not stray.
    pub(super) fn ruled(frame: &Frame, number: i64, v: f64) -> Self {
        Self { frame: *frame, number, v, wander: Wander::NONE }
    }

    /// A place along it on the page.
    pub(super) fn page(&self, u: f64) -> Point {
        if self.wander.is_none() {
            return self.frame.page(u, self.v);
        }
        self.frame.page(u, self.v + self.wander.at(u).0)
    }
}

impl Meet for Line {
    fn meet(&self, profile: &Profile) -> Option<(f64, f64)> {
        let (start, end) = profile.span(self.v)?;
        if self.wander.is_none() {
            return Some((start, end));
        }
        // One step towards where the line as it wanders meets the outline: what is left is the square of its slope.
        let near = |u: f64| profile.span(self.v + self.wander.at(u).0).unwrap_or((start, end));
        let (start, end) = (near(start).0, near(end).1);
        (start < end).then_some((start, end))
    }
}

/// How a line's width runs out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Taper {
    /// Over which share of the whole stroke.
    share: f64,
    /// Whether the tip lies where the stroke starts.
    is_at_start: bool,
}

impl Taper {
    /// The taper of a stroke from one place to another.
    pub(super) fn over(self, whole: (f64, f64)) -> RunOut {
        let length = self.share * (whole.1 - whole.0);
        if self.is_at_start { RunOut { tip: whole.0, length } } else { RunOut { tip: whole.1, length: -length } }
    }
}

/// How the width of one stroke runs out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct RunOut {
    /// Where the width is nothing, as a place along the stroke.
    tip: f64,
    /// From there to where it is full; negative where that is nearer to the stroke's start.
    length: f64,
}

impl RunOut {
    /// Calls `visit` with the places between two others where the width begins to change in another way, in any order.
    pub(super) fn joints(&self, (from, to): (f64, f64), mut visit: impl FnMut(f64)) {
        for (way, _) in TIP {
            let u = self.tip + way * self.length;
            if from < u && u < to {
                visit(u);
            }
        }
    }

    /// The share of the full width at a place.
    pub(super) fn at(&self, u: f64) -> f64 {
        // Joints lie where rounding puts them: what is all but full is full, and what is all but nothing is nothing.
        let way = (u - self.tip) / self.length;
        if way > 1.0 - ROUNDING {
            return 1.0;
        }
        let mut pieces = TIP.iter().zip(&TIP[1..]);
        let width = pieces
            .find(|(_, end)| way < end.0)
            .map_or(1.0, |(start, end)| start.1 + (end.1 - start.1) * (way - start.0) / (end.0 - start.0));
        if width < ROUNDING { 0.0 } else { width }
    }
}

/// How a line wanders: a smooth curve through random numbers at equal steps along it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wander {
    /// The farthest it comes off its line in millimetres.
    amplitude: f64,
    /// From number to number in millimetres.
    wave: f64,
    /// Where along the line the first lies, in waves.
    phase: f64,
    /// What the bundle wanders by, and the line.
    shared: Table,
    own: Table,
}

impl Wander {
    /// Straight on.
    pub(super) const NONE: Self = Self { amplitude: 0.0, wave: 1.0, phase: 0.0, shared: Table::ZERO, own: Table::ZERO };

    /// Whether it goes straight on.
    pub(super) fn is_none(&self) -> bool {
        self.amplitude == 0.0
    }

    /// The farthest that a line comes off its place in millimetres.
    pub(super) fn amplitude(&self) -> f64 {
        self.amplitude
    }

    /// How much a line rises at the most for what it goes.
    pub(super) fn steepest(&self) -> f64 {
        self.amplitude * CURVE * STEEPEST / self.wave
    }

    /// How far the line lies off its place at `u`, and how much it rises there.
    pub(super) fn at(&self, u: f64) -> (f64, f64) {
        let place = u / self.wave + self.phase;
        let first = place.floor();
        let t = place - first;
        let knot = |i: i64| {
            let place = first as i64 + i;
            let even = |table: Table| 2.0 * table.unit(place) - 1.0;
            SHARED * even(self.shared) + (1.0 - SHARED) * even(self.own)
        };
        let [a, b, c, d] = [knot(-1), knot(0), knot(1), knot(2)];
        // The cubic through b and c whose slopes there are those of the lines from a to c and from b to d.
        let (m, n) = ((c - a) / 2.0, (d - b) / 2.0);
        let (square, cube) = (2.0 * m + n + 3.0 * (b - c), m + n + 2.0 * (b - c));
        let scale = self.amplitude * CURVE;
        let offset = b + t * (m + t * (cube * t - square));
        let slope = m + t * (3.0 * cube * t - 2.0 * square);
        (scale * offset, scale * slope / self.wave)
    }

    /// Makes a chain of Béziers wander, as smooth as it is.
    pub(super) fn bend(&self, chain: &mut [Point]) {
        if self.is_none() {
            return;
        }
        for joint in (0..chain.len()).step_by(3) {
            let place = chain[joint];
            let (offset, slope) = self.at(place.x);
            for i in joint.saturating_sub(1)..(joint + 2).min(chain.len()) {
                chain[i].y += offset + slope * (chain[i].x - place.x);
            }
        }
    }

    /// Calls `visit` with the places between two others where one cubic ends and the next begins, in order.
    pub(super) fn joints(&self, (from, to): (f64, f64), mut visit: impl FnMut(f64)) {
        let mut place = (from / self.wave + self.phase).floor() + 1.0;
        loop {
            let u = (place - self.phase) * self.wave;
            if u >= to {
                break;
            }
            if u > from {
                visit(u);
            }
            place += 1.0;
        }
    }

    /// The two control points between two places of one cubic, as ways across the line.
    pub(super) fn controls(&self, from: f64, to: f64) -> (f64, f64) {
        // At a joint the cubic that is meant is the one between them.
        let third = (to - from) / 3.0;
        let (start, end) = (self.at(from), self.at(to));
        (start.0 + start.1 * third, end.0 - end.1 * third)
    }
}
