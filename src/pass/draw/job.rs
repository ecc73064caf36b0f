//! One paint as the fills see it: its tiles, what hides what, where strokes end, and what may be spent.

use std::borrow::Cow;

use rayon::prelude::*;

use crate::geom::clip::{Frame, Profile, Ranges};
use crate::geom::{Angle, Figure, Point, Vec2};
use crate::pass::thin::{Thinned, thinned};
use crate::scene::{Asked, FillKind, Paint, Stack};
use crate::stage::{Angles, Layers, Sites, Standing, Tiles};

use super::budget::{Budget, Exceeded, PROFILE};
use super::edge::{self, Bank};
use super::ground::Around;
use super::hand::Bundle;
use super::nearby::Nearby;
use super::palette::{Batch, Palette};
use super::silhouette::Silhouette;
use super::{arcs, crosses, curves, dashes, dots, lines, motif, nawaami, scribble, solid, stroke, waves};

/// Tiles that one thread draws at a time.
const CHUNK: usize = 256;

/// A paint that is being drawn. On a page that repeats its tiles are followed by images of those near the borders, which
/// hide what lies under them; only tiles that are no images are drawn.
#[derive(Clone, Copy)]
pub(super) struct Job<'a> {
    pub(super) paint: &'a Paint,
    pub(super) sites: &'a Sites,
    pub(super) angles: &'a Angles,
    pub(super) tiles: &'a Tiles,
    pub(super) bank: &'a Bank<'a>,
    pub(super) nearby: &'a Nearby<'a>,
    pub(super) palette: &'a Palette,
    pub(super) budget: &'a Budget,
    /// The areas over which the ground continues tiles.
    pub(super) around: Option<&'a Around<'a>>,
}

/// Memory that is used again for every tile.
#[derive(Default)]
pub(super) struct Scratch {
    /// The tiles that hide parts of this one.
    pub(super) covers: Vec<u32>,
    /// The outline that lines are measured on.
    pub(super) whole: Profile,
    /// The outline they are drawn in.
    pub(super) area: Silhouette,
    /// What strokes run on into.
    pub(super) partner: Silhouette,
    /// Silhouettes of the covers; the list may be longer than they are many.
    pub(super) shadows: Vec<Silhouette>,
    /// What is left of a line.
    pub(super) ranges: Ranges,
    /// Other ranges along it.
    pub(super) others: Vec<(f64, f64)>,
    pub(super) edge: edge::Scratch,
    /// From where to where strokes along a line are drawn in one go.
    pub(super) wholes: Vec<(f64, f64)>,
    pub(super) stroke: stroke::Scratch,
    /// A tile's cell, and what it is cut with.
    pub(super) cell: Vec<Point>,
    pub(super) spare: Vec<Point>,
    pub(super) curves: curves::Scratch,
    /// Looks that the budget does not know of as yet.
    pub(super) looks: u64,
}

/// One layer of one tile.
pub(super) struct Layer<'a> {
    /// 1 to 4.
    pub(super) number: u8,
    /// The share of its lines that is drawn; 1 is all.
    pub(super) share: f64,
    /// The site, and the direction of this layer's strokes.
    pub(super) frame: Frame,
    /// The same before the hand turned it.
    pub(super) unturned: Frame,
    /// The tile's outline, over which lines are spread.
    pub(super) outline: &'a [Point],
    /// What is drawn in: the outline, or where the tile's pattern is continued, an area beyond it.
    pub(super) area: Figure<'a>,
    /// Whether the pattern is continued.
    pub(super) is_continued: bool,
    /// Whether the region's outline comes near.
    pub(super) is_clipped: bool,
    /// What strokes run on into beyond the area: the other one of the tile and its cell.
    pub(super) partner: Option<Figure<'a>>,
    /// How a hand draws it, if not ruled.
    pub(super) bundle: Option<Bundle>,
}

/// A tile, or an area that is hatched as one.
pub(super) struct Piece<'a> {
    pub(super) tile: usize,
    /// The convex area where the tile's pattern is continued, if not in the tile itself.
    pub(super) beyond: Option<&'a [Point]>,
    /// Whether the region's outline comes near.
    pub(super) is_clipped: bool,
    /// What strokes run on into beyond it: the other one of the tile and its cell.
    pub(super) partner: Option<Figure<'a>>,
}

impl Job<'_> {
    /// Runs over numbers of tiles in parallel. The batches come back in the order of the tiles.
    pub(super) fn in_chunks(
        &self,
        draw: impl Fn(&mut Scratch, usize, &mut [Batch]) -> Result<(), Exceeded> + Sync,
    ) -> Result<Vec<Vec<Batch>>, Exceeded> {
        let own = self.sites.own();
        (0..own.div_ceil(CHUNK))
            .into_par_iter()
            .map(|chunk| {
                let (mut scratch, mut batches) = (Scratch::default(), self.palette.batches());
                for tile in chunk * CHUNK..((chunk + 1) * CHUNK).min(own) {
                    let before: usize = batches.iter().map(Batch::len).sum();
                    draw(&mut scratch, tile, &mut batches)?;
                    batches.iter_mut().for_each(Batch::end_bundle);
                    self.budget.mark(batches.iter().map(Batch::len).sum::<usize>() - before)?;
                }
                self.budget.work(scratch.looks as f64)?;
                Ok(batches)
            })
            .collect()
    }

    /// Whether tiles hide parts of each other. Cells lie side by side and hide nothing.
    pub(super) fn has_covers(&self) -> bool {
        self.paint.tone.stack == Stack::Cover && !self.paint.tone.shape.is_cell()
    }

    /// What is drawn in layer `number` of a tile, 1 to 4, and which share of its lines.
    pub(super) fn layer_of(&self, layers: Layers, number: u8) -> (Cow<'_, FillKind>, f64) {
        let fills = &self.paint.tone.fill;
        let kind = &fills[usize::from(number.saturating_sub(1)).min(fills.len() - 1)].kind;
        match self.paint.tone.asked {
            _ if number < layers.full || (number == layers.full && layers.last >= 1.0) => (Cow::Borrowed(kind), 1.0),
            Asked::K(_) => (Cow::Borrowed(kind), layers.part),
            Asked::Darkness(_) => {
                let density = if number == layers.full { layers.last } else { layers.part };
                let Thinned { kind, share } = thinned(kind, number, density);
                (Cow::Owned(kind), share)
            }
        }
    }

    /// Draws a tile's own marks.
    pub(super) fn draw_tile(&self, scratch: &mut Scratch, tile: usize, out: &mut [Batch]) -> Result<(), Exceeded> {
        if !self.tiles.is_drawn(tile) {
            return Ok(());
        }
        scratch.covers.clear();
        if self.has_covers() {
            let hand = &self.paint.tone.hand;
            let radius = self.nearby.radius(tile) + (hand.overshoot + hand.wobble).to_mm();
            self.budget.look(&mut scratch.looks, self.nearby.candidates(self.sites.points[tile], radius))?;
            self.nearby.near(self.sites.points[tile], radius, |other| {
                if self.sites.original(other as usize) > tile {
                    scratch.covers.push(other);
                }
            });
        }
        let is_clipped = self.tiles.standing[tile] == Standing::Clipped;
        let mut cell = std::mem::take(&mut scratch.cell);
        let around = self.around.filter(|_| self.paint.tone.hand.has_ends());
        if let Some(around) = around {
            around.outline(tile, &mut cell, &mut scratch.spare);
        }
        let partner = around.map(|_| Figure::convex(&cell));
        let drawn = self.draw_layers(&Piece { tile, beyond: None, is_clipped, partner }, scratch, out);
        scratch.cell = cell;
        drawn
    }

    /// Draws all layers of a tile, or of an area as that tile has them, minus the covers in `scratch`.
    pub(super) fn draw_layers(
        &self,
        piece: &Piece<'_>,
        scratch: &mut Scratch,
        out: &mut [Batch],
    ) -> Result<(), Exceeded> {
        let layers = self.tiles.layers[piece.tile];
        let figure = self.tiles.figure(piece.tile);
        let (fills, hand) = (&self.paint.tone.fill, &self.paint.tone.hand);
        let mut solid_slots = [None; 4];
        for number in 1..=(layers.full + u8::from(layers.part > 0.0)).min(4) {
            let at = usize::from(number - 1).min(fills.len() - 1);
            let slots = self.palette.slots(at);
            let slot = slots.start;
            let (kind, share) = self.layer_of(layers, number);
            let turn = if kind.stands_on_one_lattice() { 1 } else { number };
            let bundle =
                (!hand.is_ruled()).then(|| Bundle::new(self.paint, self.sites.original(piece.tile), i64::from(number)));
            let unturned = Frame::new(self.sites.points[piece.tile], direction(self.angles.0[piece.tile], turn));
            let layer = Layer {
                number,
                share,
                frame: bundle.map_or(unturned, |bundle| bundle.turned(&unturned)),
                unturned,
                outline: figure.outline(),
                area: piece.beyond.map_or(figure, Figure::convex),
                is_continued: piece.beyond.is_some(),
                is_clipped: piece.is_clipped,
                partner: piece.partner,
                bundle,
            };
            if layers.is_solid {
                solid::draw(self, &layer, &scratch.covers, &mut out[self.palette.solid_slot()]);
                return Ok(());
            }
            let batches = &mut out[slots];
            self.budget.look(&mut scratch.looks, PROFILE * (1 + scratch.covers.len() as u64))?;
            match &*kind {
                FillKind::Lines(hatch) => lines::draw(self, &layer, hatch, None, scratch, batches)?,
                FillKind::Dashes { hatch, dash, gap } => {
                    let dashes = dashes::Dashes::new(*dash, *gap);
                    lines::draw(self, &layer, hatch, Some(&dashes), scratch, batches)?;
                }
                FillKind::Dots { hatch, spacing, radius } => {
                    dots::draw(self, &layer, &dots::Dotting::new(hatch, *spacing, *radius), scratch, batches)?;
                }
                FillKind::Crosses { hatch, spacing, size } => {
                    crosses::draw(
                        self,
                        &layer,
                        &crosses::Crossing { hatch, spacing: *spacing, size: *size },
                        scratch,
                        batches,
                    )?;
                }
                FillKind::Arcs(hatch) => arcs::draw(self, &layer, hatch, scratch, batches)?,
                FillKind::Waves { hatch, swing } => {
                    curves::draw(self, &layer, hatch, &waves::Waves::new(swing), scratch, batches)?;
                }
                FillKind::Scribble { hatch, loops, spacing } => {
                    let key = self.sites.original(piece.tile);
                    let scribble = scribble::Scribble::new(self.paint, key, number, *loops, *spacing);
                    curves::draw(self, &layer, hatch, &scribble, scratch, batches)?;
                }
                FillKind::Nawaami { hatch, swing } => nawaami::draw(self, &layer, hatch, swing, scratch, batches)?,
                FillKind::Motif { hatch, spacing, figure } => {
                    motif::draw(self, &layer, &motif::Motif { hatch, spacing: *spacing, figure }, scratch, batches)?;
                }
                FillKind::Solid => {
                    // A second coat of the same ink is not seen.
                    if !solid_slots.contains(&Some(slot)) {
                        solid_slots[usize::from(number - 1)] = Some(slot);
                        solid::draw(self, &layer, &scratch.covers, &mut batches[0]);
                    }
                }
            }
        }
        Ok(())
    }
}

/// The direction of a layer's strokes: layers are turned by 0, 90, 45 and 135 degrees against the tile.
pub(in crate::pass) fn direction(angle: Angle, layer: u8) -> Vec2 {
    let along = angle.unit();
    let across = along.turned();
    let half = std::f64::consts::FRAC_1_SQRT_2;
    match layer {
        0 | 1 => along,
        2 => across,
        3 => (along + across) * half,
        _ => (across - along) * half,
    }
}
