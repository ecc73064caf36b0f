//! Nawaami, rope net: sinuous strokes bundled in trapezoids, which lie about as the strands of a rope do.
//!
//! A strand runs along its tile's direction. Its guide is the trapezoid that is nearest to the tile's outline as seen along the
//! strand: a trapezoid is its own guide, a square has an even one. Strokes spread and draw together with the guide and swing
//! all together in whole half waves from end to end, so that a strand leaves its tile at both ends in the tile's direction
//! itself: where two strands meet their tangents differ as the angles of the tiles do.

use crate::geom::clip::{Frame, Profile};
use crate::geom::course::half_wave;
use crate::geom::{Angle, Cubic, Length, Point, chain};
use crate::scene::{FillKind, Hatch, Paint, Swing};

use super::Stages;
use super::budget::Exceeded;
use super::curves::{Course, draw_lines, look};
use super::cutout::Cutout;
use super::job::{Job, Layer, Scratch};
use super::lattice::Lattice;
use super::lines::spread;
use super::palette::Batch;
use super::waves::push;

/// The widths of an outline are measured at so many places along the strand.
const PLACES: u32 = 8;

/// The narrow end of a guide is at least this share as wide as its middle, so that strokes do not run together.
const NARROWEST: f64 = 0.4;

/// A strand as its strokes see it. Their lines are places across it in its middle.
pub(super) struct Strand {
    /// Its axis across the frame.
    axis: f64,
    /// Where it starts and ends along the frame.
    ends: (f64, f64),
    /// The width of the guide in the middle, and by what share of it the guide widens in a millimetre.
    width: f64,
    widening: f64,
    /// The length of half a wave in millimetres.
    half: f64,
    amplitude: f64,
    rise: Cubic,
}

impl Strand {
    /// The strand of an outline. On cells its axis goes through the site.
    fn new(whole: &Profile, outline: &Cutout, is_cell: bool, swing: &Swing) -> Self {
        let along = whole.along();
        let at = |i: u32| along.0 + (along.1 - along.0) * (f64::from(i) + 0.5) / f64::from(PLACES);
        let middle = (along.0 + along.1) / 2.0;
        let widths: Vec<(f64, (f64, f64))> =
            (0..PLACES).filter_map(|i| Some((at(i), outline.across(at(i))?))).collect();
        let count = widths.len().max(1) as f64;
        let mean = widths.iter().map(|(_, (low, high))| high - low).sum::<f64>() / count;
        // The line that is nearest to the widths; the places lie evenly about the middle.
        let spread: f64 = widths.iter().map(|(u, _)| (u - middle) * (u - middle)).sum();
        let rise: f64 = widths.iter().map(|(u, (low, high))| (u - middle) * (high - low)).sum();
        let axis =
            if is_cell { 0.0 } else { widths.iter().map(|(_, (low, high))| (low + high) / 2.0).sum::<f64>() / count };
        let ends = outline.along((axis, axis)).unwrap_or(along);
        let length = ends.1 - ends.0;
        let steepest = (1.0 - NARROWEST) / (length / 2.0);
        let widening = if spread > 0.0 && mean > 0.0 { (rise / spread / mean).clamp(-steepest, steepest) } else { 0.0 };
        let halves = (length / (swing.wavelength / 2.0).to_mm()).round().max(1.0);
        let half = length / halves;
        let rise = half_wave(Length::mm(half), swing.amplitude);
        Self { axis, ends, width: mean, widening, half, amplitude: swing.amplitude.to_mm(), rise }
    }

    /// How wide the guide is at a place along it, against its middle.
    fn scale(&self, u: f64) -> f64 {
        let middle = (self.ends.0 + self.ends.1) / 2.0;
        (1.0 + self.widening * (u - middle)).max(NARROWEST)
    }

    /// The unit vectors, in the frame, of the axis's swing at both ends.
    fn tangents(&self) -> [crate::geom::Vec2; 2] {
        let mut stroke = Vec::new();
        self.trace(0, 0.0, self.ends, &mut stroke);
        let at = |u: f64| {
            let joints = stroke.iter().step_by(3).enumerate();
            let nearest = joints.min_by(|a, b| (a.1.x - u).abs().total_cmp(&(b.1.x - u).abs()));
            chain::at(&stroke, nearest.map_or(0.0, |(joint, _)| joint as f64)).1
        };
        [at(self.ends.0), at(self.ends.1)]
    }
}

impl Course for Strand {
    fn reach(&self) -> f64 {
        self.amplitude
    }

    fn range(&self, area: &Cutout, _offset: f64) -> Option<(f64, f64)> {
        area.bounds().map(|bounds| (bounds.min.x, bounds.max.x))
    }

    fn count(&self, (start, end): (f64, f64)) -> f64 {
        (end - start) / self.half + 2.0
    }

    fn trace(&self, _number: i64, offset: f64, (start, end): (f64, f64), chain: &mut Vec<Point>) {
        let first = ((start - self.ends.0) / self.half).floor();
        let last = ((end - self.ends.0) / self.half).ceil();
        for i in 0..(last - first) as u64 {
            let number = first + i as f64;
            let side = if (number / 2.0).fract() == 0.0 { 1.0 } else { -1.0 };
            let from = self.ends.0 + number * self.half;
            // The guide's width changes evenly, so that what is added to the wave is straight and the sum exact.
            let line = |u: f64| self.axis + offset * self.scale(u);
            let at = |p: Point| Point::new(from + p.x, line(from + p.x) + side * p.y);
            push(self.rise.map(at), chain);
        }
    }
}

/// Draws the strand of a layer.
pub(super) fn draw(
    job: &Job<'_>,
    layer: &Layer<'_>,
    hatch: &Hatch,
    swing: &Swing,
    scratch: &mut Scratch,
    out: &mut [Batch],
) -> Result<(), Exceeded> {
    spread(job, layer, hatch, scratch);
    look(job, layer, scratch);
    let is_cell = job.paint.tone.shape.is_cell();
    let strand = Strand::new(&scratch.whole, &scratch.curves.whole, is_cell, swing);
    let sides = (-strand.width / 2.0, strand.width / 2.0);
    let pitch = hatch.pitch.to_mm();
    let lattice = if is_cell {
        Lattice::cell(sides, 0.0, pitch)
    } else {
        Lattice::stamp(sides, pitch, hatch.inset, layer.number)
    };
    // Strokes beside the guide swing into the tile, and so do those of a tile that is wider than its guide.
    let reach = strand.reach();
    let offsets = scratch
        .curves
        .area
        .corners()
        .iter()
        .flat_map(|corner| [-reach, reach].map(|swing| (corner.y - strand.axis + swing) / strand.scale(corner.x)));
    let range = offsets.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), o| (low.min(o), high.max(o)));
    draw_lines(job, layer, hatch, &strand, lattice.over(range), scratch, out)
}

/// The directions, in [0, pi), in which the strand of every tile's first layer leaves the tile at its two ends: what takes the
/// place of the tiles' angles in metrics of nawaami. In tiles of other fills both are the tile's angle.
#[must_use]
pub fn tangents(paint: &Paint, stages: &Stages<'_>) -> Vec<[Angle; 2]> {
    let &Stages { sites, angles, tiles, .. } = stages;
    let swing = match paint.tone.fill.first().map(|fill| &fill.kind) {
        Some(FillKind::Nawaami { swing, .. }) => Some(swing),
        _ => None,
    };
    let (mut whole, mut outline) = (Profile::default(), Cutout::default());
    (0..tiles.len())
        .map(|tile| {
            let angle = angles.0[tile];
            let Some(swing) = swing.filter(|_| !tiles.outline(tile).is_empty()) else { return [angle; 2] };
            let frame = Frame::new(sites.points[tile], angle.unit());
            whole.set(tiles.outline(tile), &frame);
            outline.set(tiles.figure(tile), &frame);
            let strand = Strand::new(&whole, &outline, paint.tone.shape.is_cell(), swing);
            strand.tangents().map(|way| Angle::of(frame.along * way.x + frame.along.turned() * way.y).direction())
        })
        .collect()
}
