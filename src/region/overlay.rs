//! Booleans and offsets of outlines: rings of points in millimetres in, polygons that do not cross out.
//!
//! Coordinates are put on a grid of [`GRID`] millimetres and everything else is integer arithmetic (i_overlay), so the
//! result is the same on every machine, and a point that lies on the grid already stays where it is however often it
//! passes through here. The grid does not depend on the size of what is cut.

use i_overlay::core::fill_rule::FillRule as Rule;
use i_overlay::core::overlay::{IntOverlayOptions, Overlay};
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::i_float::int::angle::Angle as BinaryAngle;
use i_overlay::i_float::int::point::IntPoint;
use i_overlay::mesh::int::arc::ArcOptions;
use i_overlay::mesh::int::outline::offset::IntOutlineOffset;
use i_overlay::mesh::int::style::{IntLineJoin, IntOutlineStyle};

use super::tangle::{self, Tangled};
use super::{FLATTENING, FillRule};
use crate::geom::{Angle, Length, Point, Polygon, Vec2};

/// The distance of neighbouring coordinates in millimetres, 2^-24 (0.06 nanometres).
const GRID: f64 = 1.0 / STEPS;

/// Steps of the grid in a millimetre.
const STEPS: f64 = (1u64 << 24) as f64;

/// The farthest a coordinate may lie from the origin in millimetres; what lies beyond is moved here.
const FARTHEST: f64 = 1e8;

/// Areas and holes below this many square millimetres are dropped: a square of a thousandth of a millimetre.
const SLIVER: f64 = 1e-6;

/// Most pieces of the arcs of an outline that grows.
const MOST_ARC_PIECES: f64 = 4e6;

/// How two areas are combined.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Operation {
    /// What either holds.
    Union,
    /// What the first holds and the second does not.
    Difference,
    /// What both hold.
    Intersection,
}

pub(super) type Ring = Vec<IntPoint<i64>>;

/// The area that rings enclose. Rings with a coordinate that is not finite are left out.
pub(super) fn resolve<'a>(rings: impl IntoIterator<Item = &'a Vec<Point>>, rule: FillRule) -> Vec<Polygon> {
    let rings = to_grid(rings);
    let mut overlay = Overlay::<i64>::from_subj_custom(&rings, options(), Default::default());
    let rule = match rule {
        FillRule::NonZero => Rule::NonZero,
        FillRule::EvenOdd => Rule::EvenOdd,
    };
    to_polygons(overlay.overlay(OverlayRule::Subject, rule))
}

/// # Errors
/// Where resolving the rings would meet too many crossings.
pub(super) fn check<'a>(rings: impl IntoIterator<Item = &'a Vec<Point>>) -> Result<(), Tangled> {
    tangle::check(&to_grid(rings))
}

/// Combines two areas.
pub(super) fn combine(a: &[Polygon], b: &[Polygon], operation: Operation) -> Vec<Polygon> {
    let a = to_grid(a.iter().flat_map(Polygon::rings));
    let b = to_grid(b.iter().flat_map(Polygon::rings));
    let mut overlay = Overlay::<i64>::from_subj_and_clip_custom(&a, &b, options(), Default::default());
    let operation = match operation {
        Operation::Union => OverlayRule::Union,
        Operation::Difference => OverlayRule::Difference,
        Operation::Intersection => OverlayRule::Intersect,
    };
    to_polygons(overlay.overlay(operation, Rule::NonZero))
}

/// Moves the outline outwards by `by`, which may be negative. Corners that grow are rounded, within [`FLATTENING`].
pub(super) fn grow(polygons: &[Polygon], by: Length) -> Vec<Polygon> {
    let rings = to_grid(polygons.iter().flat_map(Polygon::rings));
    let by = by.to_mm().clamp(-FARTHEST, FARTHEST);
    let max_step = BinaryAngle::from_radians(arc_step(by)).unwrap_or(ArcOptions::MIN_STEP);
    let style = IntOutlineStyle::<i64>::new((by * STEPS).round() as i64)
        .line_join(IntLineJoin::Round(ArcOptions { max_step, ..ArcOptions::default() }));
    // The error is never returned by construction: it belongs to a check of ranges that FARTHEST makes needless.
    to_polygons(rings.outline_custom(&style, options()).unwrap_or_default())
}

/// The outline that [`grow`] resolves, with arcs in eighths of a circle, which are enough to see where it crosses.
///
/// # Errors
/// Where it would meet too many crossings, or consist of too many pieces.
pub(super) fn check_growth(polygons: &[Polygon], by: Length) -> Result<(), Tangled> {
    let by = by.to_mm().clamp(-FARTHEST, FARTHEST);
    let step = arc_step(by);
    let mut turns = 0.0;
    let mut moved = Vec::new();
    for ring in polygons.iter().flat_map(Polygon::rings) {
        let mut outline = Vec::with_capacity(ring.len() * 2);
        for (i, &b) in ring.iter().enumerate() {
            let a = ring[(i + ring.len() - 1) % ring.len()];
            let c = ring[(i + 1) % ring.len()];
            let (before, after) = (b - a, c - b);
            // Outlines run clockwise on the page, so that outside lies to the left.
            let outwards = |v: Vec2| Vec2::new(v.y, -v.x) * (by / v.length_squared().sqrt());
            let (from, to) = (outwards(before), outwards(after));
            outline.push(b + from);
            let turn = libm::atan2(before.cross(after), before.dot(after));
            if turn * by > 0.0 {
                turns += turn.abs();
                let pieces = (turn.abs() / std::f64::consts::FRAC_PI_4).ceil();
                for k in 1..pieces as usize {
                    let (sin, cos) = Angle::radians(turn * k as f64 / pieces).sin_cos();
                    outline.push(b + Vec2::new(from.x * cos - from.y * sin, from.x * sin + from.y * cos));
                }
            }
            outline.push(b + to);
        }
        moved.push(outline);
    }
    if turns / step > MOST_ARC_PIECES { Err(Tangled) } else { check(&moved) }
}

/// The angle of the pieces that an arc of a radius is made of.
fn arc_step(radius: f64) -> f64 {
    // The sagitta of an arc of angle s and radius r is r (1 - cos(s / 2)).
    let share = (FLATTENING.to_mm() / radius.abs()).min(1.0);
    (2.0 * libm::acos(1.0 - share)).min(std::f64::consts::FRAC_PI_4)
}

fn options() -> IntOverlayOptions<u128> {
    IntOverlayOptions { min_output_area: (SLIVER * STEPS * STEPS) as u128, ..IntOverlayOptions::default() }
}

fn to_grid<'a>(rings: impl IntoIterator<Item = &'a Vec<Point>>) -> Vec<Ring> {
    let finite = |ring: &&Vec<Point>| ring.iter().all(|p| p.x.is_finite() && p.y.is_finite());
    let step = |v: f64| (v.clamp(-FARTHEST, FARTHEST) * STEPS).round() as i64;
    rings
        .into_iter()
        .filter(finite)
        .map(|ring| ring.iter().map(|p| IntPoint::new(step(p.x), step(p.y))).collect())
        .collect()
}

/// Rings begin at their uppermost point (of several the one farthest left) and polygons stand in the order of these
/// points, so that equal areas are equal lists.
fn to_polygons(shapes: Vec<Vec<Ring>>) -> Vec<Polygon> {
    let from_grid = |mut ring: Ring| -> Vec<Point> {
        let first = (0..ring.len()).min_by_key(|&i| key(ring[i])).unwrap_or(0);
        ring.rotate_left(first);
        ring.into_iter().map(|p| Point::new(p.x as f64 * GRID, p.y as f64 * GRID)).collect()
    };
    let mut shapes: Vec<Vec<Ring>> = shapes.into_iter().filter(|shape| !shape.is_empty()).collect();
    let least = |ring: &Ring| ring.iter().map(|&p| key(p)).min();
    for shape in &mut shapes {
        if let Some((_, holes)) = shape.split_first_mut() {
            holes.sort_by_key(least);
        }
    }
    shapes.sort_by_key(|shape| shape.first().and_then(least));
    shapes
        .into_iter()
        .filter_map(|shape| {
            let mut rings = shape.into_iter().map(from_grid);
            Some(Polygon { outer: rings.next()?, holes: rings.collect() })
        })
        .collect()
}

fn key(p: IntPoint<i64>) -> (i64, i64) {
    (p.y, p.x)
}
