//! Arcs about a place on the tile's edge, like scales: the foot of the tile, where the direction of the layer leaves it.

use crate::geom::course::circle;
use crate::geom::{Length, Point, Vec2};
use crate::scene::Hatch;

use super::budget::Exceeded;
use super::curves::{Course, ROUNDNESS, draw_lines, look};
use super::cutout::Cutout;
use super::job::{Job, Layer, Scratch};
use super::lattice::Lattice;
use super::lines::spread;
use super::palette::Batch;

/// Circles about a centre. Their lines are radii.
pub(super) struct Arcs {
    pub(super) centre: Point,
}

impl Course for Arcs {
    fn reach(&self) -> f64 {
        0.0
    }

    fn range(&self, _area: &Cutout, _radius: f64) -> Option<(f64, f64)> {
        Some((0.0, 0.0))
    }

    fn count(&self, _range: (f64, f64)) -> f64 {
        8.0
    }

    fn trace(&self, _number: i64, radius: f64, _range: (f64, f64), chain: &mut Vec<Point>) {
        if radius > 0.0 {
            // They start and end behind the foot, where the tile is not.
            circle(self.centre, Length::mm(radius), Vec2::new(1.0, 0.0), ROUNDNESS, chain);
        }
    }
}

/// Draws the arcs of a layer: on stamps in equal steps from the foot to the other side, on cells at the exact pitch, one of
/// them through the site. Every layer has its foot at another side.
pub(super) fn draw(
    job: &Job<'_>,
    layer: &Layer<'_>,
    hatch: &Hatch,
    scratch: &mut Scratch,
    out: &mut [Batch],
) -> Result<(), Exceeded> {
    spread(job, layer, hatch, scratch);
    look(job, layer, scratch);
    // The outline where the site's own line crosses it; sites lie inside but for rounding.
    let (head, foot) = scratch.curves.whole.along((0.0, 0.0)).unwrap_or(scratch.whole.along());
    let centre = Point::new(foot, 0.0);
    let pitch = hatch.pitch.to_mm();
    let lattice = if job.paint.tone.shape.is_cell() {
        Lattice::cell((0.0, foot - head), foot, pitch)
    } else {
        Lattice::stamp((0.0, foot - head), pitch, hatch.inset, 1)
    };
    let far = scratch.curves.area.corners().iter().map(|corner| corner.distance(centre)).fold(0.0, f64::max);
    draw_lines(job, layer, hatch, &Arcs { centre }, lattice.over((0.0, far)), scratch, out)
}
