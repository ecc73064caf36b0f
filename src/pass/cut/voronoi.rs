//! Voronoi cells of the sites, drawn in and rounded.
//!
//! A cell is a box cut down to the half-planes that lie nearer to its site than to each of its neighbours in the Delaunay
//! triangulation, which are just the neighbours that bound it. All outlines are convex and run clockwise on the page.

use crate::geom::clip::{HalfPlane, TOLERANCE, clip_convex};
use crate::geom::{Length, Point, Rect, Vec2};
use crate::stage::{Graph, Sites};

/// How far the corners of a rounded cell may lie from the true arc, in millimetres; a twelfth of a pixel at 600 dpi.
const ARC_TOLERANCE: f64 = 0.0035;

/// Halvings in the search for the greatest radius that still fits a cell.
const HALVINGS: usize = 40;

/// Makes cells.
pub(crate) struct Cells<'a> {
    sites: &'a Sites,
    graph: &'a Graph,
    bounds: Rect,
    /// Whether no site has a neighbour: there is one site, or all coincide, and the page does not repeat.
    is_single: bool,
    inset: f64,
    round: f64,
}

impl<'a> Cells<'a> {
    /// For the cells of these sites, each drawn in by `inset` and with corners of radius `round`.
    pub(crate) fn new(sites: &'a Sites, graph: &'a Graph, inset: Length, round: Length) -> Self {
        Self::within(bounds(sites), sites, graph, inset, round)
    }

    /// The same, but cells end at a box that holds all sites.
    pub(crate) fn within(bounds: Rect, sites: &'a Sites, graph: &'a Graph, inset: Length, round: Length) -> Self {
        Self {
            sites,
            graph,
            bounds,
            is_single: sites.torus.is_none() && graph.edges().next().is_none(),
            inset: inset.to_mm(),
            round: round.to_mm(),
        }
    }

    /// Writes the outline of a cell: empty where the inset leaves nothing and where another site lies at the same place
    /// before it.
    pub(crate) fn outline(&self, tile: usize, ring: &mut Vec<Point>, spare: &mut Vec<Point>) {
        let site = self.sites.points[tile];
        let mut neighbours = self.graph.places(tile, &self.sites.points).peekable();
        ring.clear();
        if neighbours.peek().is_none() && !(self.is_single && tile == 0) {
            return;
        }
        ring.extend(self.bounds.corners());
        for neighbour in neighbours {
            if let Some(half) = HalfPlane::nearer(site, neighbour) {
                clip_convex(ring, &half, spare);
            }
        }
        if self.inset > 0.0 {
            shrink(ring, self.inset, spare);
        }
        if self.round > 0.0 {
            round_corners(ring, self.round, spare);
        }
    }
}

/// The box that cells end in: the extent of the sites, and half a spacing round the sites on its border or beyond. On a
/// torus no cell comes as far as a period beyond the first.
pub(crate) fn bounds(sites: &Sites) -> Rect {
    if let Some(period) = sites.period() {
        let size = period.area().max - Point::default();
        return Rect::new(Point::default() - size, Point::default() + size * 2.0);
    }
    let reach = Vec2::new(sites.spacing / 2.0, sites.spacing / 2.0);
    let within = sites.extent.grown(-TOLERANCE);
    let beyond = sites.points.iter().filter(|&&site| !within.contains(site));
    beyond.fold(sites.extent, |bounds, &site| bounds.including(site - reach).including(site + reach))
}

/// Moves every edge inwards.
pub(super) fn shrink(ring: &mut Vec<Point>, by: f64, spare: &mut Vec<Point>) {
    let Some(&last) = ring.last() else { return };
    let mut a = last;
    let mut halves = Vec::with_capacity(ring.len());
    for &b in ring.iter() {
        halves.extend(HalfPlane::inside(a, b).map(|half| half.inset(by)));
        a = b;
    }
    for half in &halves {
        clip_convex(ring, half, spare);
    }
}

/// Rounds the corners: what a disc of this radius can reach without leaving the ring. Where none fits, the greatest
/// that does is taken.
fn round_corners(ring: &mut Vec<Point>, radius: f64, spare: &mut Vec<Point>) {
    let mut core = ring.clone();
    shrink(&mut core, radius, spare);
    let mut radius = radius;
    if core.is_empty() {
        // The core shrinks to nothing somewhere in between; `core` is always that of `low`.
        let (mut low, mut high) = (0.0, radius);
        core.clone_from(ring);
        for _ in 0..HALVINGS {
            let middle = (low + high) / 2.0;
            let mut candidate = ring.clone();
            shrink(&mut candidate, middle, spare);
            if candidate.is_empty() {
                high = middle;
            } else {
                (low, core) = (middle, candidate);
            }
        }
        radius = low;
    }
    let step = 2.0 * libm::acos(1.0 - (ARC_TOLERANCE / radius).min(1.0));
    ring.clear();
    for i in 0..core.len() {
        let corner = core[i];
        let before = core[(i + core.len() - 1) % core.len()];
        let after = core[(i + 1) % core.len()];
        let (Some(from), Some(to)) = (HalfPlane::inside(before, corner), HalfPlane::inside(corner, after)) else {
            continue;
        };
        let turn = libm::atan2(from.normal.cross(to.normal), from.normal.dot(to.normal));
        let pieces = (turn / step).ceil().max(1.0) as u32;
        for piece in 0..=pieces {
            let (sin, cos) = libm::sincos(turn * f64::from(piece) / f64::from(pieces));
            let normal = from.normal * cos + from.normal.turned() * sin;
            ring.push(corner + normal * radius);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::clip::convex_clearance;
    use crate::geom::ring_area;

    /// Sites on a square lattice with the triangulation's links, diagonals included.
    fn lattice(side: usize) -> (Sites, Graph) {
        let mut points = Vec::new();
        let mut edges = Vec::new();
        for row in 0..side {
            for column in 0..side {
                points.push(Point::new(column as f64 + 0.5, row as f64 + 0.5));
                let here = (row * side + column) as u32;
                if column + 1 < side {
                    edges.push([here, here + 1]);
                }
                if row + 1 < side {
                    edges.push([here, here + side as u32]);
                }
                if column + 1 < side && row + 1 < side {
                    edges.push([here, here + side as u32 + 1]);
                }
            }
        }
        let extent = Rect::new(Point::default(), Point::new(side as f64, side as f64));
        let graph = Graph::new(points.len(), &edges, Vec::new());
        (Sites { points, domain: extent, extent, spacing: 1.0, cells: None, tiling: None, torus: None }, graph)
    }

    fn outline(sites: &Sites, graph: &Graph, inset: f64, round: f64, tile: usize) -> Vec<Point> {
        let mut ring = Vec::new();
        Cells::new(sites, graph, Length::mm(inset), Length::mm(round)).outline(tile, &mut ring, &mut Vec::new());
        ring
    }

    #[test]
    fn cells_of_a_lattice_are_its_squares() {
        let (sites, graph) = lattice(3);
        for tile in 0..9 {
            let ring = outline(&sites, &graph, 0.0, 0.0, tile);
            assert_eq!(ring.len(), 4);
            assert!((ring_area(&ring) - 1.0).abs() < 1e-12);
            assert!((convex_clearance(&ring, sites.points[tile]) - 0.5).abs() < 1e-12);
        }
    }

    #[test]
    fn insets_and_round_corners_take_their_share() {
        let (sites, graph) = lattice(3);
        assert!((ring_area(&outline(&sites, &graph, 0.1, 0.0, 4)) - 0.64).abs() < 1e-12);
        assert!(outline(&sites, &graph, 0.6, 0.0, 4).is_empty());
        let round = ring_area(&outline(&sites, &graph, 0.0, 0.2, 4));
        let corners = 0.04 * (4.0 - std::f64::consts::PI);
        // Flattened arcs run inside the true ones.
        assert!(round <= 1.0 - corners && round > 1.0 - corners - 4.0 * ARC_TOLERANCE);
        let disc = ring_area(&outline(&sites, &graph, 0.0, 3.0, 4));
        assert!((disc - std::f64::consts::PI / 4.0).abs() < 3.2 * ARC_TOLERANCE);
    }

    #[test]
    fn a_site_alone_has_the_box_and_its_duplicates_nothing() {
        let extent = Rect::new(Point::default(), Point::new(2.0, 2.0));
        let points = vec![Point::new(1.0, 1.0); 2];
        let sites = Sites { points, domain: extent, extent, spacing: 1.0, cells: None, tiling: None, torus: None };
        let graph = Graph::new(2, &[], Vec::new());
        assert!((ring_area(&outline(&sites, &graph, 0.0, 0.0, 0)) - 4.0).abs() < 1e-12);
        assert!(outline(&sites, &graph, 0.0, 0.0, 1).is_empty());
    }

    #[test]
    fn sites_on_the_border_have_whole_cells() {
        let extent = Rect::new(Point::default(), Point::new(1.0, 1.0));
        let points = vec![Point::new(0.0, 0.0), Point::new(1.0, 0.0)];
        let sites = Sites { points, domain: extent, extent, spacing: 1.0, cells: None, tiling: None, torus: None };
        let graph = Graph::new(2, &[[0, 1]], Vec::new());
        let ring = outline(&sites, &graph, 0.0, 0.0, 0);
        assert!((ring_area(&ring) - 1.5).abs() < 1e-12);
    }
}
