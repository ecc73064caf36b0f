//! Marks as outlines to fill: strokes, dots and areas in millimetres go in, paths in a tile's pixels come out.
//!
//! All pieces of a mark run clockwise on the page, so that the non-zero rule fills what any of them covers. Coordinates
//! are rounded to 1/256 of a pixel of the whole sheet before the tile's corner is taken away, which is then exact: two
//! tiles that hold parts of one mark agree about it.

use std::f64::consts::{PI, TAU};

use tiny_skia::{FillRule, PathBuilder};

use crate::drawing::{Curves, Tapers};
use crate::geom::bezier::{cubics, flatten};
use crate::geom::{Length, Point, Rect, Vec2};
use crate::scene::Cap;

/// How far, in pixels, a round end may stray from the circle.
const TOLERANCE: f64 = 0.02;
/// How far, in pixels, lines may stray from a curve that they stand for.
const FLATTENING: f64 = 0.04;
/// Marks with a point farther from the sheet's corner, in millimetres, are left out: nothing that is cut to a sheet lies
/// there, and single precision ends.
const FAR: f64 = 1e7;
/// How far, in pixels, a mark may reach out of its tile before it is cut.
const MARGIN: f64 = 4_096.0;
/// The tangent of the angle up to which strokes run the same way.
const ALIKE: f64 = 0.2;
/// What is added and taken away again to round to 1/256: 1.5 times 2^44, where neighbouring numbers are that far apart.
const ROUNDER: f64 = 26_388_279_066_624.0;

/// Pixels in a millimetre, across and down.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scale {
    x: f64,
    y: f64,
}

impl Scale {
    /// Of a raster over a page.
    pub(super) fn new(pixels: [u32; 2], width: Length, height: Length) -> Self {
        Self { x: f64::from(pixels[0]) / width.to_mm(), y: f64::from(pixels[1]) / height.to_mm() }
    }

    /// The same across and down, in pixels a millimetre.
    pub(super) fn even(per_mm: f64) -> Self {
        Self { x: per_mm, y: per_mm }
    }

    /// How far lines may stray from a curve.
    fn flattening(self) -> Length {
        Length::mm(FLATTENING / self.x.max(self.y))
    }

    /// A box on the page in pixels.
    pub(super) fn bounds(self, mm: Rect) -> Rect {
        let scaled = |p: Point| Point::new(p.x * self.x, p.y * self.y);
        Rect::new(scaled(mm.min), scaled(mm.max))
    }
}

/// A part of the raster, in pixels.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tile {
    /// Its top left corner.
    pub(super) origin: [usize; 2],
    /// Its width and height.
    pub(super) size: [usize; 2],
    /// Pixels in a millimetre.
    pub(super) scale: Scale,
}

impl Tile {
    /// What of the page a mark must touch to be seen in the tile, for a mark that reaches `margin` millimetres beyond its
    /// points.
    pub(super) fn reach(&self, margin: f64) -> Rect {
        let [left, top] = self.origin.map(|n| n as f64);
        let [width, height] = self.size.map(|n| n as f64);
        let corner = |x: f64, y: f64| Point::new(x / self.scale.x, y / self.scale.y);
        // A pixel more than needed on each side, for rounding.
        Rect::new(corner(left - 1.0, top - 1.0), corner(left + width + 1.0, top + height + 1.0)).grown(margin)
    }

    /// A place on the page in the tile's pixels.
    fn place(&self, p: Point) -> Point {
        let round = |v: f64| (v + ROUNDER) - ROUNDER;
        let (x, y) = (round(p.x * self.scale.x), round(p.y * self.scale.y));
        Point::new(x - self.origin[0] as f64, y - self.origin[1] as f64)
    }
}

/// Marks that are filled as one path.
#[derive(Debug, Clone, Copy)]
pub(super) enum Marks<'a> {
    /// Straight strokes.
    Lines {
        /// Their width.
        pen: Length,
        /// How they end.
        cap: Cap,
        /// Their ends.
        lines: &'a [[Point; 2]],
    },
    /// A stroke of more points with round joins; closed where it ends at its first.
    Polyline {
        /// Its width.
        pen: Length,
        /// How it ends.
        cap: Cap,
        /// Its points.
        points: &'a [Point],
    },
    /// Curved strokes with round joins; closed where they end at their first point.
    Curves {
        /// Their width.
        pen: Length,
        /// How they end.
        cap: Cap,
        /// They and others.
        curves: &'a Curves,
        /// The first of them, and the first that is none of them.
        range: [usize; 2],
    },
    /// Strokes of changing width.
    Tapers {
        /// They and others.
        tapers: &'a Tapers,
        /// The first of them, and the first that is none of them.
        range: [usize; 2],
    },
    /// Dots.
    Dots {
        /// Their radius.
        radius: Length,
        /// Their centres.
        centres: &'a [Point],
    },
    /// An area by the even-odd rule.
    Area(&'a [Vec<Point>]),
}

impl Marks<'_> {
    /// A box around all of it.
    pub(super) fn bounds(&self) -> Rect {
        let around = |bounds: Rect, p: &Point| bounds.including(*p);
        match self {
            Self::Lines { pen, lines, .. } => lines.iter().flatten().fold(Rect::EMPTY, around).grown(pen.to_mm()),
            Self::Polyline { pen, points, .. } => points.iter().fold(Rect::EMPTY, around).grown(pen.to_mm()),
            Self::Curves { pen, curves, range: [from, to], .. } => {
                (*from..*to).flat_map(|i| curves.chain(i)).fold(Rect::EMPTY, around).grown(pen.to_mm())
            }
            Self::Tapers { tapers, range: [from, to] } => {
                let strokes = || (*from..*to).filter_map(|i| tapers.stroke(i));
                let bounds = strokes().flat_map(|(spine, _)| spine).fold(Rect::EMPTY, around);
                bounds.grown(strokes().flat_map(|(_, widths)| widths).fold(0.0, |widest, &width| width.max(widest)))
            }
            Self::Dots { radius, centres } => centres.iter().fold(Rect::EMPTY, around).grown(radius.to_mm()),
            Self::Area(rings) => rings.iter().flatten().fold(Rect::EMPTY, around),
        }
    }

    /// The width of its widest stroke or dot, in pixels; infinite for areas.
    pub(super) fn width(&self, scale: Scale) -> f64 {
        let mm = match self {
            Self::Lines { pen, .. } | Self::Polyline { pen, .. } | Self::Curves { pen, .. } => pen.to_mm(),
            Self::Tapers { tapers, range: [from, to] } => {
                let strokes = (*from..*to).filter_map(|i| tapers.stroke(i));
                strokes.flat_map(|(_, widths)| widths).fold(0.0, |widest, &width| width.max(widest))
            }
            Self::Dots { radius, .. } => radius.to_mm() * 2.0,
            Self::Area(_) => f64::INFINITY,
        };
        mm * scale.x.max(scale.y)
    }

    /// Gives parts whose strokes hardly overlap: those side by side stay together, those that cross do not.
    pub(super) fn parts(self, mut take: impl FnMut(Self)) {
        match self {
            Self::Lines { pen, cap, lines } => {
                let parts = lines.chunk_by(|before, after| are_alike(Some(*before), Some(*after)));
                parts.for_each(|lines| take(Self::Lines { pen, cap, lines }));
            }
            Self::Curves { pen, cap, curves, range } => {
                let ends = |i| ends(curves.chain(i));
                alike(range, ends, |range| take(Self::Curves { pen, cap, curves, range }));
            }
            Self::Tapers { tapers, range } => {
                let ends = |i| tapers.stroke(i).and_then(|(spine, _)| ends(spine));
                alike(range, ends, |range| take(Self::Tapers { tapers, range }));
            }
            Self::Polyline { .. } | Self::Dots { .. } | Self::Area(_) => take(self),
        }
    }
}

/// The first and the last point of a stroke.
fn ends(points: &[Point]) -> Option<[Point; 2]> {
    Some([*points.first()?, *points.last()?])
}

/// Whether strokes between these points run nearly the same way, or against each other.
fn are_alike(one: Option<[Point; 2]>, other: Option<[Point; 2]>) -> bool {
    let (Some([a, b]), Some([c, d])) = (one, other) else { return false };
    (b - a).cross(d - c).abs() <= ALIKE * (b - a).dot(d - c).abs()
}

/// Cuts a range where a stroke does not run as the one before it.
fn alike([from, to]: [usize; 2], ends: impl Fn(usize) -> Option<[Point; 2]>, mut take: impl FnMut([usize; 2])) {
    let mut start = from;
    for i in from + 1..=to {
        if i == to || !are_alike(ends(i - 1), ends(i)) {
            take([start, i]);
            start = i;
        }
    }
}

/// Makes outlines, and remembers the last circle it needed.
#[derive(Debug, Default)]
pub(super) struct Outliner {
    /// Corners of a circle of radius 1, from +x towards +y; their number is a multiple of 4.
    circle: Vec<Vec2>,
}

impl Outliner {
    /// Adds the outline of what of the marks can be seen in a tile to a path, and says by which rule it is filled.
    pub(super) fn outline(&mut self, marks: Marks<'_>, tile: Tile, path: &mut PathBuilder) -> FillRule {
        match marks {
            Marks::Lines { pen, cap, lines } => {
                let half = pen.to_mm() / 2.0;
                self.prepare(half, tile.scale);
                let reach = tile.reach(half);
                for &[a, b] in lines {
                    if is_near(a, b, &reach) {
                        self.stroke(a, b, half, cap, tile, path);
                    }
                }
                FillRule::Winding
            }
            Marks::Polyline { pen, cap, points } => {
                let half = pen.to_mm() / 2.0;
                self.prepare(half, tile.scale);
                self.polyline(points, half, cap, tile, path);
                FillRule::Winding
            }
            Marks::Curves { pen, cap, curves, range: [from, to] } => {
                let half = pen.to_mm() / 2.0;
                self.prepare(half, tile.scale);
                let reach = tile.reach(half);
                for chain in (from..to).map(|i| curves.chain(i)).filter(|chain| is_any_near(chain, &reach)) {
                    self.polyline(&flatten(chain, tile.scale.flattening()), half, cap, tile, path);
                }
                FillRule::Winding
            }
            Marks::Tapers { tapers, range: [from, to] } => {
                for (spine, widths) in (from..to).filter_map(|i| tapers.stroke(i)) {
                    self.taper(spine, widths, tile, path);
                }
                FillRule::Winding
            }
            Marks::Dots { radius, centres } => {
                let radius = radius.to_mm();
                self.prepare(radius, tile.scale);
                let reach = tile.reach(radius);
                for &centre in centres {
                    if is_near(centre, centre, &reach) {
                        self.disc(centre, radius, tile, path);
                    }
                }
                FillRule::Winding
            }
            Marks::Area(rings) => {
                if rings.iter().flatten().all(|&p| is_sound(p)) {
                    for ring in rings {
                        trace(ring.iter().copied(), tile, path);
                    }
                }
                FillRule::EvenOdd
            }
        }
    }

    /// Makes the circle fine enough for a radius.
    fn prepare(&mut self, radius: f64, scale: Scale) {
        let pixels = radius * scale.x.max(scale.y);
        // The sagitta of an arc of half-angle pi / n is r (1 - cos(pi / n)).
        let half_angle = libm::acos((1.0 - TOLERANCE / pixels).clamp(0.0, 1.0));
        let quarter = (PI / half_angle / 4.0).ceil().clamp(2.0, 64.0) as usize;
        let corners = quarter * 4;
        if self.circle.len() != corners {
            let corner = |i: usize| {
                let (sin, cos) = libm::sincos(TAU * i as f64 / corners as f64);
                Vec2::new(cos, sin)
            };
            self.circle = (0..corners).map(corner).collect();
        }
    }

    fn disc(&self, centre: Point, radius: f64, tile: Tile, path: &mut PathBuilder) {
        trace(self.circle.iter().map(|&corner| centre + corner * radius), tile, path);
    }

    /// A straight stroke, with its ends.
    fn stroke(&self, a: Point, b: Point, half: f64, cap: Cap, tile: Tile, path: &mut PathBuilder) {
        match (cap, direction(a, b)) {
            (Cap::Butt, Some(along)) => bar(a, b, along, half, tile, path),
            (Cap::Butt, None) => {}
            (Cap::Round, None) => self.disc(a, half, tile, path),
            (Cap::Round, Some(along)) => {
                // Half a circle round each end: from the last quarter of the circle over its first corner.
                let (corners, quarter) = (self.circle.len(), self.circle.len() / 4);
                let turned = |i: usize| {
                    let corner = self.circle[(corners - quarter + i) % corners];
                    Vec2::new(corner.x * along.x - corner.y * along.y, corner.x * along.y + corner.y * along.x) * half
                };
                let far = (0..=2 * quarter).map(|i| b + turned(i));
                let near = (0..=2 * quarter).map(|i| a + -turned(i));
                trace(far.chain(near), tile, path);
            }
        }
    }

    /// A stroke of several points: a bar for each step and what fills the gap at each turn.
    fn polyline(&self, points: &[Point], half: f64, cap: Cap, tile: Tile, path: &mut PathBuilder) {
        let reach = tile.reach(half);
        let mut first: Option<Vec2> = None;
        let mut before: Option<Vec2> = None;
        for pair in points.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            let Some(along) = direction(a, b) else { continue };
            if let Some(before) = before.filter(|_| is_near(a, a, &reach)) {
                self.join(a, before, along, half, tile, path);
            }
            if is_near(a, b, &reach) {
                bar(a, b, along, half, tile, path);
            }
            first = first.or(Some(along));
            before = Some(along);
        }
        let (Some(&start), Some(&end)) = (points.first(), points.last()) else { return };
        let closed = start == end && points.len() > 2;
        match (before.zip(first), cap) {
            (Some((last, first)), _) if closed => {
                if is_near(start, start, &reach) {
                    self.join(start, last, first, half, tile, path);
                }
            }
            (_, Cap::Butt) => {}
            (_, Cap::Round) => {
                for p in [start, end] {
                    if is_near(p, p, &reach) {
                        self.disc(p, half, tile, path);
                    }
                }
            }
        }
    }

    /// A stroke of changing width: a bar for each short step and what fills the gap at each turn.
    fn taper(&mut self, spine: &[Point], widths: &[f64], tile: Tile, path: &mut PathBuilder) {
        let widest = widths.iter().fold(0.0, |widest: f64, &width| width.max(widest)) / 2.0;
        let reach = tile.reach(widest);
        if !is_any_near(spine, &reach) {
            return;
        }
        self.prepare(widest, tile.scale);
        let mut before: Option<Vec2> = None;
        for (cubic, width) in cubics(spine).zip(widths.windows(2)) {
            let mut a = cubic.start();
            let mut half = width[0] / 2.0;
            let steps = cubic.steps(tile.scale.flattening());
            for (i, b) in (1..=steps).zip(cubic.flatten(tile.scale.flattening())) {
                let half_at_b = (width[0] + (width[1] - width[0]) * f64::from(i) / f64::from(steps)) / 2.0;
                let Some(along) = direction(a, b) else { continue };
                if is_near(a, b, &reach) {
                    if let Some(before) = before {
                        self.join(a, before, along, half, tile, path);
                    }
                    let (side, side_at_b) = (along.turned() * half, along.turned() * half_at_b);
                    trace([a + -side, b + -side_at_b, b + side_at_b, a + side].into_iter(), tile, path);
                }
                before = Some(along);
                (a, half) = (b, half_at_b);
            }
        }
    }

    /// Fills the outer side of a turn: with a disc, or with a triangle where that comes near enough to one.
    fn join(&self, p: Point, before: Vec2, after: Vec2, half: f64, tile: Tile, path: &mut PathBuilder) {
        let cos_half = ((1.0 + before.dot(after)) / 2.0).max(0.0).sqrt();
        if half * tile.scale.x.max(tile.scale.y) * (1.0 - cos_half) > TOLERANCE {
            self.disc(p, half, tile, path);
            return;
        }
        let (from, to) = (before.turned() * half, after.turned() * half);
        let turn = before.cross(after);
        if turn > 0.0 {
            trace([p, p + -from, p + -to].into_iter(), tile, path);
        } else if turn < 0.0 {
            trace([p, p + to, p + from].into_iter(), tile, path);
        }
    }
}

/// The unit vector from one point to another, if they differ.
fn direction(a: Point, b: Point) -> Option<Vec2> {
    (b - a).unit()
}

/// A straight stroke that ends at its points.
fn bar(a: Point, b: Point, along: Vec2, half: f64, tile: Tile, path: &mut PathBuilder) {
    let side = along.turned() * half;
    trace([a + -side, b + -side, b + side, a + side].into_iter(), tile, path);
}

/// Adds a closed ring to a path. What lies far outside the tile is cut off first: the scan converter computes with few
/// bits.
fn trace(corners: impl Iterator<Item = Point> + Clone, tile: Tile, path: &mut PathBuilder) {
    let [width, height] = tile.size.map(|n| n as f64);
    let bounds = Rect::new(Point::default(), Point::new(width, height)).grown(MARGIN);
    let placed = corners.map(|corner| tile.place(corner));
    if placed.clone().all(|p| bounds.contains(p)) {
        push_ring(placed, path);
    } else {
        push_ring(cut_ring(placed.collect(), &bounds).into_iter(), path);
    }
}

fn push_ring(corners: impl Iterator<Item = Point>, path: &mut PathBuilder) {
    let mut started = false;
    for corner in corners {
        if started {
            path.line_to(corner.x as f32, corner.y as f32);
        } else {
            path.move_to(corner.x as f32, corner.y as f32);
            started = true;
        }
    }
    if started {
        path.close();
    }
}

/// What of a ring lies in a box (Sutherland and Hodgman 1974). Parts that fall apart stay joined along the box's sides.
fn cut_ring(mut ring: Vec<Point>, bounds: &Rect) -> Vec<Point> {
    let sides: [fn(Point, &Rect) -> f64; 4] = [
        |p, bounds| p.x - bounds.min.x,
        |p, bounds| bounds.max.x - p.x,
        |p, bounds| p.y - bounds.min.y,
        |p, bounds| bounds.max.y - p.y,
    ];
    for inside in sides {
        let Some(&last) = ring.last() else { break };
        let mut kept = Vec::with_capacity(ring.len() + 4);
        let mut a = last;
        for b in ring {
            let (depth_a, depth_b) = (inside(a, bounds), inside(b, bounds));
            if (depth_a >= 0.0) != (depth_b >= 0.0) {
                kept.push(a.lerp(b, depth_a / (depth_a - depth_b)));
            }
            if depth_b >= 0.0 {
                kept.push(b);
            }
            a = b;
        }
        ring = kept;
    }
    ring
}

/// Whether a point is a number, and on this side of [`FAR`].
fn is_sound(p: Point) -> bool {
    p.x.abs() < FAR && p.y.abs() < FAR
}

/// Whether the box around two sound points touches another.
fn is_near(a: Point, b: Point, reach: &Rect) -> bool {
    let bounds = Rect::new(Point::new(a.x.min(b.x), a.y.min(b.y)), Point::new(a.x.max(b.x), a.y.max(b.y)));
    is_sound(a) && is_sound(b) && bounds.touches(reach)
}

/// Whether the box around points, all of them sound, touches another.
fn is_any_near(points: &[Point], reach: &Rect) -> bool {
    let bounds = points.iter().fold(Rect::EMPTY, |bounds, &p| bounds.including(p));
    points.iter().all(|&p| is_sound(p)) && bounds.touches(reach)
}
