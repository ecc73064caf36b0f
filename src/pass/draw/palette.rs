//! From the fills of a tone to the layers of the drawing: which marks lie together.
//!
//! A slot is a list of marks of one ink and one pen; where the hand changes the pen, each of its weights has one. Threads fill batches, one for each slot; batches are put together in
//! the order of the tiles.

use std::ops::Range;

use crate::drawing::{Curves, Dots, Layer, Strokes, Tapers};
use crate::geom::{Length, Point};
use crate::scene::{Asked, Cap, Colour, Darkness, Fill, FillKind, Ground, Hand, Paint};

use super::hand::{weighed, weights};
use super::solid;

/// What a slot holds.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    Areas,
    Strokes(Length, Cap),
    Dots(Length),
}

impl Kind {
    fn of(fill: &Fill) -> Self {
        match &fill.kind {
            FillKind::Lines(hatch)
            | FillKind::Dashes { hatch, .. }
            | FillKind::Crosses { hatch, .. }
            | FillKind::Arcs(hatch)
            | FillKind::Waves { hatch, .. }
            | FillKind::Scribble { hatch, .. }
            | FillKind::Nawaami { hatch, .. }
            | FillKind::Motif { hatch, .. } => Self::Strokes(hatch.pen, hatch.cap),
            FillKind::Dots { radius, .. } => Self::Dots(*radius),
            FillKind::Solid => Self::Areas,
        }
    }

    /// What is drawn of it with each weight of a hand.
    fn by_weight(self, hand: &Hand) -> Vec<Self> {
        let weights = 0..weights(hand);
        match self {
            Self::Areas => vec![self],
            Self::Strokes(pen, cap) => weights.map(|weight| Self::Strokes(weighed(pen, hand, weight), cap)).collect(),
            Self::Dots(radius) => weights.map(|weight| Self::Dots(weighed(radius, hand, weight))).collect(),
        }
    }
}

/// The slots of a paint.
pub(super) struct Palette {
    slots: Vec<(Colour, Kind)>,
    /// The slots of every fill, one for each weight.
    fills: Vec<Range<usize>>,
    /// The slots of the ground's own fill.
    ground: Range<usize>,
    /// The slot of tiles that are inked all over because they are dark.
    solid: usize,
}

impl Palette {
    /// `ink` is used by fills without their own.
    pub(super) fn new(paint: &Paint, ink: Colour) -> Self {
        let mut slots = Vec::new();
        let mut families: Vec<((Colour, Kind), Range<usize>)> = Vec::new();
        let mut slot = |fill: &Fill| {
            let (ink, kind) = (fill.ink.unwrap_or(ink), Kind::of(fill));
            if let Some((_, range)) = families.iter().find(|(family, _)| *family == (ink, kind)) {
                return range.clone();
            }
            let start = slots.len();
            slots.extend(kind.by_weight(&paint.tone.hand).into_iter().map(|kind| (ink, kind)));
            families.push(((ink, kind), start..slots.len()));
            start..slots.len()
        };
        // The ground comes first, for it lies lowest.
        let ground = match &paint.tone.ground {
            Some(Ground::Fill { fill, .. }) => slot(fill),
            Some(Ground::Nearest) | None => 0..0,
        };
        let fills = paint.tone.fill.iter().map(&mut slot).collect();
        // They take the ink of the first layer.
        let solid = match &paint.tone.asked {
            Asked::Darkness(Darkness { solid: Some(_), .. }) => {
                let ink = paint.tone.fill.first().and_then(|fill| fill.ink);
                slot(&Fill { kind: FillKind::Solid, ink }).start
            }
            Asked::Darkness(_) | Asked::K(_) => 0,
        };
        Self { slots, fills, ground, solid }
    }

    /// One empty batch for each slot.
    pub(super) fn batches(&self) -> Vec<Batch> {
        self.slots.iter().map(|_| Batch::default()).collect()
    }

    /// The slots of a fill by its place in the tone's list, one for each weight.
    pub(super) fn slots(&self, fill: usize) -> Range<usize> {
        self.fills[fill].clone()
    }

    /// The slots of the ground's own fill, one for each weight.
    pub(super) fn ground_slots(&self) -> Range<usize> {
        self.ground.clone()
    }

    /// The slot of tiles that are inked all over because they are dark.
    pub(super) fn solid_slot(&self) -> usize {
        self.solid
    }

    /// Puts batches together, in order; layers without a mark are left out.
    pub(super) fn layers(&self, name: &str, groups: &[String], chunks: Vec<Vec<Batch>>) -> Vec<Layer> {
        let mut whole = self.batches();
        for (slot, batch) in whole.iter_mut().enumerate() {
            let total = |count: fn(&Batch) -> usize| chunks.iter().map(|chunk| count(&chunk[slot])).sum();
            batch.lines.reserve_exact(total(|b| b.lines.len()));
            batch.dots.reserve_exact(total(|b| b.dots.len()));
            batch.ends.reserve_exact(total(|b| b.ends.len()));
        }
        for chunk in chunks {
            for (whole, part) in whole.iter_mut().zip(chunk) {
                let start = whole.lines.len() + whole.dots.len();
                whole.lines.extend_from_slice(&part.lines);
                whole.dots.extend_from_slice(&part.dots);
                whole.ends.extend(part.ends.iter().map(|end| start + end));
                whole.areas.extend(part.areas);
                whole.curves.append(&part.curves);
                whole.tapers.append(&part.tapers);
            }
        }
        let mut layers: Vec<Layer> = Vec::new();
        for (&(ink, kind), batch) in self.slots.iter().zip(whole).filter(|(_, batch)| !batch.is_empty()) {
            let at = layers.iter().position(|layer| layer.ink == ink).unwrap_or_else(|| {
                let (groups, name) = (groups.to_vec(), name.to_owned());
                layers.push(Layer::new(groups, name, ink));
                layers.len() - 1
            });
            let layer = &mut layers[at];
            match kind {
                Kind::Areas => layer.areas = solid::united(batch.areas),
                Kind::Strokes(pen, cap) => {
                    let (lines, bundle_ends, curves) = (batch.lines, batch.ends, batch.curves);
                    if !(lines.is_empty() && curves.is_empty()) {
                        layer.strokes.push(Strokes { lines, bundle_ends, curves, ..Strokes::new(pen, cap) });
                    }
                    layer.tapers.append(&batch.tapers);
                }
                Kind::Dots(radius) => {
                    layer.dots.push(Dots { radius, centres: batch.dots, bundle_ends: batch.ends });
                }
            }
        }
        layers
    }
}

/// Marks of one slot. All are of the slot's kind.
#[derive(Default)]
pub(super) struct Batch {
    pub(super) lines: Vec<[Point; 2]>,
    pub(super) dots: Vec<Point>,
    pub(super) areas: Vec<Vec<Vec<Point>>>,
    /// Curved strokes of the slot's pen.
    pub(super) curves: Curves,
    /// Strokes that run out.
    pub(super) tapers: Tapers,
    /// Where each tile's lines or dots end.
    ends: Vec<usize>,
}

impl Batch {
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// How many marks there are.
    pub(super) fn len(&self) -> usize {
        self.lines.len() + self.dots.len() + self.areas.len() + self.curves.len() + self.tapers.spines.len()
    }

    /// Ends the marks of a tile, if it has any.
    pub(super) fn end_bundle(&mut self) {
        let end = self.lines.len() + self.dots.len();
        if end > self.ends.last().copied().unwrap_or(0) {
            self.ends.push(end);
        }
        self.curves.end_bundle();
        self.tapers.spines.end_bundle();
    }
}
