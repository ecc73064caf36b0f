//! How a hand draws the strokes of a bundle: what it is asked to stray by, and where it strays to.
//!
//! Each of the six ways of straying has a table of random numbers of its own for every tile, read by layer and line, so
//! that switching one on, or hiding a stroke, leaves all others where they were.

use crate::geom::clip::Frame;
use crate::geom::{Angle, Length};
use crate::random::{Key, Table};
use crate::scene::{Hand, Hatch, Paint};

use super::taper::Taper;
use super::wander::{Line, Wander};

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
