//! What layers a tile needs for a share of ink, and what ink it then has.

use std::f64::consts::PI;

use crate::geom::clip::{Frame, TOLERANCE};
use crate::geom::{Length, ring_area};
use crate::pass::draw::job::direction;
use crate::pass::draw::lattice::Lattice;
use crate::pass::draw::silhouette::Silhouette;
use crate::pass::thin::{Thinned, thinned};
use crate::scene::{Asked, Fill, FillKind, Hatch, Stack};
use crate::stage::Layers;

use super::cover::Cover;
use super::ink::{self, DOTS};
use super::{Bed, LAYERS, NEAR};

/// So many lines over a cell, or dots along one side of it, lie evenly enough that they need not be counted.
const FINE: f64 = 8.0;

/// Less than so much of a line or dot is not drawn: it would be far too dark.
const LEAST: f64 = 0.5;

/// The least share of its strokes that a layer over others comes with: fewer look like slips of the pen.
const FEWEST: f64 = 1.0 / 3.0;

/// Tiles over a place, on average, from which on what is seen of a tile is no longer its own outline.
const OVERLAPPING: f64 = 1.05;

/// Where the outermost dots of a line of a stamp lie, in steps from its edge.
const DOT_INSET: f64 = 0.5;

/// Crosses lose about the share of their arms that is their size over so many radii of the tile: across an edge of length
/// p an eighth of the square of an arm's length is cut off for each millimetre, and p / area is 2 / radius.
const ARMS_LOST: f64 = 6.0;

/// The most dots that are counted in a tile.
const MOST_DOTS: f64 = 10_000.0;

/// Tiles that full layers are reckoned on.
const SAMPLES: usize = 64;

/// Over what the ink of a tile is reckoned.
#[derive(Clone, Copy)]
enum Yard {
    /// The tile itself.
    Tile,
    /// What later tiles leave of it, which is about a disc of this radius in millimetres.
    Disc(f64),
}

/// Chooses layers, one tile after the other.
pub(super) struct Reckoner<'a> {
    bed: &'a Bed<'a>,
    fills: &'a [Fill],
    yard: Yard,
    /// What tiles hold of a full layer, against a layer without end: lines come in whole numbers, dots are not cut.
    held: [f64; LAYERS],
    /// The share of a tile that 0 to 4 full layers cover.
    levels: [f64; LAYERS + 1],
    areas: Vec<f64>,
    seen: Silhouette,
}

impl<'a> Reckoner<'a> {
    pub(super) fn new(bed: &'a Bed<'a>, cover: &Cover) -> Self {
        let tone = &bed.paint.tone;
        let areas: Vec<f64> = (0..bed.tiles.len()).map(|tile| ring_area(bed.tiles.outline(tile)).abs()).collect();
        let extent = bed.sites.extent.width() * bed.sites.extent.height();
        let radius = (extent * cover.covered() / areas.len().max(1) as f64 / PI).sqrt();
        let is_overlapped = !tone.shape.is_cell() && tone.stack == Stack::Cover && cover.depth() > OVERLAPPING;
        let yard = if is_overlapped && radius > 0.0 { Yard::Disc(radius) } else { Yard::Tile };
        let (held, levels) = ([1.0; LAYERS], [0.0; LAYERS + 1]);
        let mut reckoner = Self { bed, fills: &tone.fill, yard, held, levels, areas, seen: Silhouette::default() };
        let held = [1, 2, 3, 4].map(|number| reckoner.mean_held(number));
        reckoner.held = held;
        let mean = match yard {
            Yard::Tile => (reckoner.areas.iter().sum::<f64>() / reckoner.areas.len().max(1) as f64 / PI).sqrt(),
            Yard::Disc(radius) => radius,
        };
        // Where there is no tile there is nothing to reckon.
        let mean = if mean > 0.0 { mean } else { bed.sites.spacing };
        reckoner.levels = ink::levels(&tone.fill, bed.canvas.gain, &held, Length::mm(mean));
        reckoner
    }

    /// The share that four full layers cover.
    pub(super) fn greatest(&self) -> f64 {
        self.levels[LAYERS]
    }

    /// The area of a tile in square millimetres.
    pub(super) fn area(&self, tile: usize) -> f64 {
        self.areas[tile]
    }

    /// As many full layers as wanted and of the next a part that makes up the rest, and the share of ink that comes of
    /// it.
    pub(super) fn choose(&mut self, tile: usize, wanted: f64) -> (Layers, f64) {
        let levels = self.levels;
        let full = (1..=LAYERS).take_while(|&n| levels[n] <= wanted + NEAR).count();
        let Some(&above) = levels.get(full + 1) else { return (Layers::new(full as u8, 0.0), levels[full]) };
        let room = above - levels[full];
        let part = if room > NEAR { (wanted - levels[full]).max(0.0) / room } else { 0.0 };
        let part = self.density(full as u8 + 1, part);
        if full > 0
            && part > NEAR
            && part < FEWEST
            && let Some(crossed) = self.crossed(tile, full, wanted)
        {
            return crossed;
        }
        let drawn = if part > NEAR { self.drawn(tile, full as u8 + 1, part) } else { 0.0 };
        let part = if drawn > 0.0 { part } else { 0.0 };
        (Layers::new(full as u8, part), levels[full] + room * drawn)
    }

    /// The last full layer and the one after it where the latter alone would be a stroke or two over a finished tile: it
    /// comes with its fewest strokes, and the last full layer makes room for them.
    fn crossed(&mut self, tile: usize, full: usize, wanted: f64) -> Option<(Layers, f64)> {
        let is_stroked = |number: usize| match self.kind(number as u8) {
            FillKind::Lines(_) | FillKind::Dashes { .. } | FillKind::Waves { .. } | FillKind::Nawaami { .. } => true,
            FillKind::Arcs(_)
            | FillKind::Scribble { .. }
            | FillKind::Dots { .. }
            | FillKind::Crosses { .. }
            | FillKind::Motif { .. }
            | FillKind::Solid => false,
        };
        let (bare, [below, above]) = ink::steps(&self.levels, full)?;
        if !is_stroked(full) || !is_stroked(full + 1) {
            return None;
        }
        let left = 1.0 - above * self.drawn(tile, full as u8 + 1, FEWEST);
        if left >= 1.0 {
            return None;
        }
        let last = ((1.0 - (1.0 - wanted) / (bare * left)) / below).clamp(FEWEST, 1.0);
        let layers = Layers { last, ..Layers::new(full as u8, FEWEST) };
        Some((layers, self.ink(tile, layers)))
    }

    /// The share of ink that a tile has of its layers.
    pub(super) fn ink(&mut self, tile: usize, layers: Layers) -> f64 {
        let levels = self.levels;
        let is_thinned = matches!(self.bed.paint.tone.asked, Asked::Darkness(_));
        ink::of_layers(&levels, layers, |number, density| {
            // What is a share of the lines is drawn as it is.
            if is_thinned { self.drawn(tile, number, density) } else { density }
        })
    }

    /// How densely a layer stands that has a share of the ink of a full one: loops of scribble that stand farther apart lie
    /// less on each other.
    fn density(&self, number: u8, share: f64) -> f64 {
        // A full layer covers 1 - exp(-n) of the paper with n times its area of ink.
        let full = ink::heaped(self.kind(number), self.bed.canvas.gain);
        full.map_or(share, |full| libm::log(1.0 - share * full) / libm::log(1.0 - full))
    }

    /// What of a full layer is drawn in a tile if it is thinned to `part`: about that much, but in whole lines or dots.
    fn drawn(&mut self, tile: usize, number: u8, part: f64) -> f64 {
        let held = self.held[usize::from(number) - 1];
        let Thinned { kind, share } = thinned(self.kind(number), number, part);
        match &kind {
            FillKind::Lines(hatch)
            | FillKind::Dashes { hatch, .. }
            | FillKind::Waves { hatch, .. }
            | FillKind::Scribble { hatch, .. }
            | FillKind::Nawaami { hatch, .. } => {
                ink::inked(self.kind(number), self.bed.canvas.gain, part) * self.lines(tile, number, hatch) / held
            }
            FillKind::Dots { hatch, spacing, radius } if number == 1 => {
                let area = hatch.pitch.to_mm() * spacing.to_mm();
                let is_few = self.yard_area(tile) < FINE * FINE * area;
                part * if is_few { self.dots(tile, number, hatch, *spacing, *radius) / held } else { 1.0 }
            }
            // One arc goes through the site, however few there are.
            FillKind::Arcs(hatch) => {
                let arcs = (self.yard_area(tile) / PI).sqrt() / hatch.pitch.to_mm();
                if arcs < LEAST { 0.0 } else { part }
            }
            // A row of them is cut anywhere.
            FillKind::Dots { hatch, spacing, .. }
            | FillKind::Crosses { hatch, spacing, .. }
            | FillKind::Motif { hatch, spacing, .. } => {
                let marks = share * self.yard_area(tile) / (hatch.pitch.to_mm() * spacing.to_mm());
                if marks < LEAST { 0.0 } else { part }
            }
            FillKind::Solid => f64::from(u8::from(share >= LEAST)),
        }
    }

    /// What is drawn in a layer.
    fn kind(&self, number: u8) -> &'a FillKind {
        &self.fills[usize::from(number - 1).min(self.fills.len() - 1)].kind
    }

    /// What tiles hold of a full layer on average, looked at on some of them; never nothing.
    fn mean_held(&mut self, number: u8) -> f64 {
        let step = self.areas.len().div_ceil(SAMPLES).max(1);
        let (mut sum, mut count) = (0.0, 0.0);
        for tile in (0..self.areas.len()).step_by(step) {
            if self.areas[tile] <= 0.0 {
                continue;
            }
            sum += match self.kind(number) {
                FillKind::Lines(hatch)
                | FillKind::Dashes { hatch, .. }
                | FillKind::Waves { hatch, .. }
                | FillKind::Scribble { hatch, .. }
                | FillKind::Nawaami { hatch, .. } => self.lines(tile, number, hatch),
                FillKind::Dots { hatch, spacing, radius } => self.dots(tile, number, hatch, *spacing, *radius),
                // The arms of a cross end where the tile does; its neighbour takes none of them.
                FillKind::Crosses { size, .. } => {
                    let radius = (self.yard_area(tile) / PI).sqrt();
                    (1.0 - size.to_mm() / (ARMS_LOST * radius)).max(0.0)
                }
                FillKind::Arcs(_) | FillKind::Motif { .. } | FillKind::Solid => 1.0,
            };
            count += 1.0;
        }
        if sum > 0.0 { sum / count } else { 1.0 }
    }

    /// The area over which a tile's ink is reckoned, in square millimetres.
    fn yard_area(&self, tile: usize) -> f64 {
        match self.yard {
            Yard::Tile => self.areas[tile],
            Yard::Disc(radius) => PI * radius * radius,
        }
    }

    /// What a tile holds of parallel strokes, against strokes without end at the same pitch.
    fn lines(&mut self, tile: usize, number: u8, hatch: &Hatch) -> f64 {
        let (pitch, area) = (hatch.pitch.to_mm(), self.yard_area(tile));
        let is_cell = self.bed.paint.tone.shape.is_cell();
        let is_fine = area > (FINE * pitch) * (FINE * pitch);
        if area <= 0.0 || (is_cell && is_fine) {
            return 1.0;
        }
        let lattice = self.lattice(tile, number, hatch);
        if is_fine {
            return pitch / lattice.step();
        }
        let chord = |v: f64| match self.yard {
            Yard::Tile => {
                let mut length = 0.0;
                self.seen.spans(&v, |(start, end)| length += end - start);
                length
            }
            Yard::Disc(radius) => 2.0 * (radius * radius - v * v).max(0.0).sqrt(),
        };
        // Ink in lengths of stroke.
        let wanted = area / pitch;
        if wanted < LEAST * chord(0.0) {
            return 0.0;
        }
        let shortest = hatch.shortest.to_mm() - TOLERANCE;
        lattice.places().map(|(_, v)| chord(v)).filter(|&chord| chord >= shortest).sum::<f64>() / wanted
    }

    /// What a tile holds of the dots of one layer, against dots without end.
    fn dots(&mut self, tile: usize, number: u8, hatch: &Hatch, spacing: Length, radius: Length) -> f64 {
        let (spacing, radius) = (spacing.to_mm(), radius.to_mm());
        let wanted = self.yard_area(tile) / (hatch.pitch.to_mm() * spacing);
        if wanted < LEAST {
            return 0.0;
        }
        let lines = self.lattice(tile, 1, hatch);
        let along = self.seen.along();
        let row = if self.bed.paint.tone.shape.is_cell() {
            Lattice::cell(along, 0.0, spacing)
        } else {
            Lattice::stamp(along, spacing, DOT_INSET, 1)
        };
        let [u, v] = DOTS[usize::from(number) - 1];
        let inner = |(low, high): (f64, f64)| (low + radius, high - radius);
        let (lines, row) = (lines.moved(v).over(inner(self.seen.across())), row.moved(u).over(inner(along)));
        let frame = self.frame(tile, 1);
        let is_whole = |u: f64, v: f64| match self.yard {
            Yard::Tile => self.bed.tiles.figure(tile).clearance(frame.page(u, v)) >= radius - TOLERANCE,
            Yard::Disc(yard) => u * u + v * v <= (yard - radius).max(0.0) * (yard - radius).max(0.0),
        };
        let most = lines.count() * row.count();
        if most > MOST_DOTS {
            // Too many to count, and so many that they lie evenly.
            return 1.0;
        }
        let dots = lines.places().flat_map(|(_, v)| row.places().map(move |(_, u)| (u, v)));
        dots.filter(|&(u, v)| is_whole(u, v)).count() as f64 / wanted
    }

    fn frame(&self, tile: usize, number: u8) -> Frame {
        Frame::new(self.bed.sites.points[tile], direction(self.bed.angles.0[tile], number))
    }

    /// Where the lines of a layer lie in a tile, whose profile is taken.
    fn lattice(&mut self, tile: usize, number: u8, hatch: &Hatch) -> Lattice {
        let frame = self.frame(tile, number);
        self.seen.set(self.bed.tiles.figure(tile), &frame);
        if self.bed.paint.tone.shape.is_cell() {
            Lattice::cell(self.seen.across(), 0.0, hatch.pitch.to_mm())
        } else {
            Lattice::stamp(self.seen.across(), hatch.pitch.to_mm(), hatch.inset, number)
        }
    }
}
