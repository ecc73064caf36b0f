//! Floods: a drawing's lines and a point come in, the area that paint poured out there would fill goes out.
//!
//! It ends at the centres of lines and at the outlines of dark areas, under which it reaches by [`UNDER`]. Gaps up to a
//! width are bridged first (`gaps`): from every open end to the nearest other end and to the nearest line. Closed lines
//! inside are holes; lines that end inside leave no slit.
//!
//! The page is cut by walls a hair's breadth thick along all lines and bridges, and the piece that holds the point is
//! grown until the walls are gone. All is arithmetic on the grid of regions, so that equal lines give equal floods.

mod gaps;
#[cfg(test)]
mod tests;

use std::fmt;

use super::{FillRule, Operation, Region, Tangled, overlay};
use crate::geom::{Length, Point, Polygon, Rect, Vec2, ring_contains};
use gaps::{Bridge, Network, Piece};

/// Half the thickness of a wall in millimetres.
const WALL: f64 = 1.0 / 16_384.0;

/// Slits narrower than twice this many millimetres are closed, the ends of lines among them.
const SLIT: f64 = 1.0 / 1024.0;

/// How far a flood reaches under dark areas, so that no white shows between the two.
pub const UNDER: Length = Length::mm(0.25);

/// Corners lie on multiples of this many millimetres.
const SNAP: f64 = 1.0 / 1024.0;

/// Most straight pieces that lines may consist of.
const MOST_PIECES: usize = 200_000;

/// The widest gaps that are looked for where a flood leaks, in millimetres, unless `close` is near it.
const WIDEST: f64 = 10.0;

/// What a flood runs up against.
#[derive(Debug, Clone)]
pub struct Lines {
    /// The page of the drawing.
    pub page: Rect,
    /// The centres of strokes.
    pub centres: Vec<Centre>,
    /// Areas of ink.
    pub dark: Region,
}

/// The centre of a stroke.
#[derive(Debug, Clone)]
pub struct Centre {
    /// Its corners; the last is the first where it is closed.
    pub points: Vec<Point>,
    /// Half the stroke's width in millimetres.
    pub radius: f64,
    /// How far the stroke's ink reaches beyond its ends, in millimetres.
    pub beyond: f64,
}

/// How a flood is made.
#[derive(Debug, Clone, Copy)]
pub struct FloodConfig {
    /// Where it starts.
    pub at: Point,
    /// The widest gap between the ink of two lines that is bridged.
    pub close: Length,
    /// What the border of the page is.
    pub border: Border,
}

/// What the border of a drawing's page is to a flood.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Border {
    /// Nothing that holds it: a flood that comes there has leaked.
    Open,
    /// A line.
    Wall,
}

/// Why there is no flood.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FloodError {
    /// It starts outside the page.
    OffPage(Rect),
    /// It starts on a line or on something dark.
    OnLine,
    /// The lines have too many pieces.
    TooLarge {
        /// How many they may have.
        most: usize,
    },
    /// The lines cross too often.
    TooTangled,
    /// It reaches the border of the page.
    Leak(Option<Gap>),
}

/// A gap that a flood leaks through: with it and all that are narrower bridged, it would not leak.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gap {
    /// From ink to ink.
    pub width: Length,
    /// Its middle.
    pub at: Point,
}

impl fmt::Display for FloodError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let tenth = |v: f64| (v * 10.0).round() / 10.0;
        match self {
            Self::OffPage(page) => {
                let [x0, y0, x1, y1] = [page.min.x, page.min.y, page.max.x, page.max.y].map(tenth);
                write!(
                    f,
                    "the flood starts outside the drawing, whose page goes from ({x0}mm, {y0}mm) to ({x1}mm, {y1}mm)"
                )
            }
            Self::OnLine => f.write_str("the flood starts on a line"),
            Self::TooLarge { most } => write!(f, "the lines have more than {most} straight pieces"),
            Self::TooTangled => f.write_str("the lines cross more than a million times"),
            Self::Leak(Some(Gap { width, at })) => {
                let width = (width.to_mm() * 100.0).round() / 100.0;
                let (x, y) = (tenth(at.x), tenth(at.y));
                write!(f, "the flood leaks through a gap of {width}mm near ({x}mm, {y}mm)")
            }
            Self::Leak(None) => f.write_str("the flood leaks: no line holds it before the border of the page"),
        }
    }
}

impl std::error::Error for FloodError {}

impl From<Tangled> for FloodError {
    fn from(_: Tangled) -> Self {
        Self::TooTangled
    }
}

impl Lines {
    /// The area around a point that no line parts from it.
    ///
    /// # Errors
    /// Where the flood starts on a line or off the page, reaches the border of an open page, or there are too many lines.
    pub fn flood(&self, config: &FloodConfig) -> Result<Region, FloodError> {
        let FloodConfig { at, close, border } = *config;
        if !self.page.contains(at) {
            return Err(FloodError::OffPage(self.page));
        }
        let network = Network::new(self, border);
        if network.pieces.len() > MOST_PIECES {
            return Err(FloodError::TooLarge { most: MOST_PIECES });
        }
        if self.dark.contains(at) || network.is_on_line(at) {
            return Err(FloodError::OnLine);
        }
        let walls: Vec<Vec<Point>> = network
            .strokes()
            .iter()
            .filter_map(|piece| wall(piece.a, piece.b))
            .chain(self.dark.polygons().iter().flat_map(Polygon::rings).cloned())
            .collect();
        let bridges = network.bridges(&self.dark, close.to_mm(), close.to_mm());
        let Some(face) = self.face(&walls, &bridges, at)? else { return Err(FloodError::OnLine) };
        if border == Border::Open && self.reaches_border(&face) {
            return Err(FloodError::Leak(self.leak(&network, &walls, config)?));
        }
        self.finish(face, at)
    }

    /// The piece of the page that holds a point; none if a wall does.
    fn face(&self, walls: &[Vec<Point>], bridges: &[Bridge], at: Point) -> Result<Option<Polygon>, Tangled> {
        let page = Polygon { outer: self.page.corners().to_vec(), holes: Vec::new() };
        let rings: Vec<Vec<Point>> =
            walls.iter().cloned().chain(bridges.iter().filter_map(|bridge| wall(bridge.from, bridge.to))).collect();
        overlay::check(&rings)?;
        let walls: Vec<Polygon> = rings.into_iter().map(|outer| Polygon { outer, holes: Vec::new() }).collect();
        Ok(holding(overlay::combine(&[page], &walls, Operation::Difference), at))
    }

    fn reaches_border(&self, face: &Polygon) -> bool {
        const NEAR: f64 = 1e-6;
        let Rect { min, max } = self.page;
        let near = |a: f64, b: f64| (a - b).abs() < NEAR;
        face.outer.iter().any(|p| near(p.x, min.x) || near(p.x, max.x) || near(p.y, min.y) || near(p.y, max.y))
    }

    /// The widest of the gaps that have to be bridged, by halving the list of all that could be.
    fn leak(&self, network: &Network, walls: &[Vec<Point>], config: &FloodConfig) -> Result<Option<Gap>, Tangled> {
        let close = config.close.to_mm();
        let all = network.bridges(&self.dark, close, WIDEST.max(close * 2.0));
        let holds = |count: usize| -> Result<bool, Tangled> {
            let face = self.face(walls, all.get(..count).unwrap_or(&all), config.at)?;
            Ok(face.is_none_or(|face| !self.reaches_border(&face)))
        };
        if !holds(all.len())? {
            return Ok(None);
        }
        let (mut leaks, mut tight) = (all.partition_point(|bridge| bridge.gap <= close), all.len());
        while leaks + 1 < tight {
            let middle = leaks.midpoint(tight);
            if holds(middle)? {
                tight = middle;
            } else {
                leaks = middle;
            }
        }
        let gap = tight.checked_sub(1).and_then(|last| all.get(last));
        Ok(gap.map(|bridge| Gap { width: Length::mm(bridge.gap), at: bridge.from.lerp(bridge.to, 0.5) }))
    }

    /// Grows a piece of the page over the walls around it, and under dark areas.
    fn finish(&self, face: Polygon, at: Point) -> Result<Region, FloodError> {
        let part = |region: &Region| {
            let polygon = holding(region.polygons().to_vec(), at);
            Region::from_resolved(polygon.into_iter().collect())
        };
        let face = Region::from_resolved(vec![face]);
        let grown = face.try_inset(Length::mm(-WALL - SLIT))?.try_inset(Length::mm(SLIT))?;
        let mut grown = part(&grown);
        if !self.dark.is_empty() {
            let under = grown.try_inset(UNDER * -1.0)?.try_combined(&self.dark, Operation::Intersection)?;
            grown = part(&grown.try_combined(&under, Operation::Union)?);
        }
        let snap = |v: f64| (v / SNAP).round() * SNAP;
        let snapped = |ring: &Vec<Point>| ring.iter().map(|p| Point::new(snap(p.x), snap(p.y))).collect();
        let rings = grown.polygons().iter().flat_map(Polygon::rings).map(snapped).collect();
        Ok(part(&Region::try_from_rings(rings, FillRule::NonZero)?))
    }
}

/// The polygon that holds a point.
fn holding(polygons: Vec<Polygon>, at: Point) -> Option<Polygon> {
    let holds = |polygon: &Polygon| {
        ring_contains(&polygon.outer, at) && !polygon.holes.iter().any(|hole| ring_contains(hole, at))
    };
    polygons.into_iter().find(holds)
}

/// A wall along a straight piece, a little longer than it so that no corner is left open; clockwise on the page.
fn wall(a: Point, b: Point) -> Option<Vec<Point>> {
    let length = a.distance(b);
    if !(length > 0.0 && length.is_finite()) {
        return None;
    }
    let along = (b - a) * (WALL / length);
    let across = Vec2::new(-along.y, along.x);
    let (a, b) = (a - along, b + along);
    Some(vec![a - across, b - across, b + across, a + across])
}

impl Piece {
    fn nearest(&self, p: Point) -> (Point, f64) {
        let way = self.b - self.a;
        let length_squared = way.length_squared();
        let share = if length_squared > 0.0 { ((p - self.a).dot(way) / length_squared).clamp(0.0, 1.0) } else { 0.0 };
        (self.a + way * share, self.from + share * length_squared.sqrt())
    }
}
