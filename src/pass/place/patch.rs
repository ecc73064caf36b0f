//! A part of an inflation tiling: the cells that touch the extent, and which of them share an edge.
//!
//! Tilings by inflation grow from one great tile that is cut into smaller ones again and again; whatever does not come
//! near the extent is left out on the way, so that the time it takes grows with the cells that are kept. Vertices are
//! exact integers of the tiling's own ring, which is what makes equal places equal to the last bit.

use rayon::prelude::*;

use crate::diag::Diagnostic;
use crate::geom::clip::convex_overlap;
use crate::geom::{Point, Rect, ring_bounds};
use crate::scene::Placement;
use crate::stage::{Sites, Tiling};

use super::Ground;

/// The greatest distance from the middle of the domain that cells may have, in edges: beyond it keys would run over.
pub(super) const MOST_REACH: f64 = 1e7;

/// Divisions of an edge that tell the middles of sides apart: no two come nearer than three tenths of an edge.
const DIVISIONS: f64 = 8.0;

/// The cells of a tiling round the middle of the domain.
pub(super) struct Patch<'a> {
    ground: &'a Ground<'a>,
    /// The tiling's edge in millimetres.
    edge: f64,
    spacing: f64,
    extent: Rect,
    centre: Point,
    points: Vec<Point>,
    tiling: Tiling,
    /// For every part of a side its middle and its cell.
    sides: Vec<(u64, u32)>,
}

/// A cell that is offered to a patch, in edges from the middle of the domain.
pub(super) struct Cell<'a> {
    /// Clockwise on the page.
    pub(super) corners: &'a [Point],
    /// The site.
    pub(super) site: Point,
    /// The middles of its sides, or of the parts that they fall into where cells do not meet edge to edge.
    pub(super) sides: &'a [Point],
}

impl<'a> Patch<'a> {
    /// An empty patch for cells of `area` square edges on average.
    pub(super) fn new(placement: &Placement, ground: &'a Ground<'a>, edge: f64, area: f64) -> Result<Self, Diagnostic> {
        let spacing = edge * area.sqrt();
        let extent = ground.extent(spacing);
        // Cells that only reach in are counted as well.
        let (width, height) = ((extent.width() + edge) / spacing, (extent.height() + edge) / spacing);
        let patch = Self {
            ground,
            edge,
            spacing,
            extent,
            centre: ground.domain.centre(),
            points: Vec::new(),
            tiling: Tiling::default(),
            sides: Vec::new(),
        };
        let estimate = width * height;
        let is_within_reach = patch.reach() <= MOST_REACH;
        ground.budget.expect(placement, if is_within_reach { estimate } else { f64::INFINITY })?;
        Ok(patch)
    }

    /// How far cells may lie from the middle of the domain, in edges.
    fn reach(&self) -> f64 {
        let Rect { min, max } = self.extent;
        let far = |from: f64, low: f64, high: f64| (from - low).max(high - from);
        let (x, y) = (far(self.centre.x, min.x, max.x), far(self.centre.y, min.y, max.y));
        (x * x + y * y).sqrt() / self.edge + 4.0
    }

    /// A place that is given in edges from the middle of the domain.
    fn page(&self, p: Point) -> Point {
        Point::new(self.centre.x + p.x * self.edge, self.centre.y + p.y * self.edge)
    }

    /// Whether tiles with these corners may have a cell in the extent that reaches over their sides by `margin` edges.
    pub(super) fn comes_near(&self, corners: &[Point], margin: f64) -> bool {
        let bounds = corners.iter().fold(Rect::EMPTY, |bounds, &p| bounds.including(self.page(p)));
        // A great tile's corners are only as exact as it is great.
        let rounding = 1e-12 * (bounds.width() + bounds.height());
        bounds.grown(margin * self.edge + rounding).touches(&self.extent)
    }

    /// Keeps a cell if it touches the extent.
    pub(super) fn offer(&mut self, cell: &Cell<'_>) {
        let corners: Vec<Point> = cell.corners.iter().map(|&p| self.page(p)).collect();
        let bounds = ring_bounds(&corners);
        let is_inside = self.extent.intersection(&bounds) == bounds;
        let comes_in = || bounds.touches(&self.extent) && convex_overlap(&corners, &self.extent.corners());
        if !is_inside && !comes_in() {
            return;
        }
        if self.ground.wants_cells {
            let site = self.points.len() as u32;
            self.sides.extend(cell.sides.iter().map(|&side| (key(side), site)));
            self.tiling.push(&corners);
        }
        self.points.push(self.page(cell.site));
    }

    /// The sites, with their cells if they are wanted.
    pub(super) fn finish(self) -> Sites {
        let mut sites = self.ground.sites(self.points, self.spacing, self.spacing);
        if self.ground.wants_cells {
            let mut tiling = self.tiling;
            tiling.edges = shared(self.sides);
            sites.tiling = Some(tiling);
        }
        sites
    }
}

/// Names the middle of a side by the square of a fine grid that it lies in.
fn key(p: Point) -> u64 {
    // Within the greatest reach both numbers have 28 bits; a cast wraps negative ones.
    let part = |x: f64| u64::from((x * DIVISIONS).round() as i32 as u32);
    part(p.x) << 32 | part(p.y)
}

/// The pairs of cells that have a side in common, each once, in order.
fn shared(mut sides: Vec<(u64, u32)>) -> Vec<[u32; 2]> {
    sides.par_sort_unstable();
    let twins = sides.windows(2).filter(|pair| pair[0].0 == pair[1].0);
    let mut pairs: Vec<[u32; 2]> = twins.map(|pair| [pair[0].1, pair[1].1]).collect();
    pairs.par_sort_unstable();
    // Cells may share both halves of a long side.
    pairs.dedup();
    pairs
}
