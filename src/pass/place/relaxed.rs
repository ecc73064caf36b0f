//! Lloyd's relaxation: every site moves to the middle of its Voronoi cell, round after round (S. Lloyd, "Least squares
//! quantization in PCM", 1982).

use rayon::prelude::*;

use crate::diag::Diagnostic;
use crate::geom::{Length, Point, Rect, ring_area};
use crate::pass::cut::voronoi::{self, Cells};
use crate::pass::link;
use crate::scene::{Link, Placement};
use crate::stage::{Sites, Torus};

use super::{Ground, find};

/// Sites that one thread moves at a time.
const CHUNK: usize = 1024;

/// The sites of another placement, as many and in the same order, moved so that they lie evenly. Cells end at the extent,
/// or at the domain where all sites lie in it. Of sites in one place only the first moves.
pub(super) fn place(
    placement: &Placement,
    ground: &Ground<'_>,
    inner: &Placement,
    rounds: u32,
) -> Result<Sites, Diagnostic> {
    let mut sites = find(inner, ground)?;
    ground.budget.expect_moves(placement, sites.points.len(), rounds)?;
    let domain = sites.domain;
    let is_within = sites.points.iter().all(|&p| domain.including(p) == domain);
    // On a torus sites go round, and cells end nowhere.
    let wrapped = |p: Point| ground.torus.map_or(p, |period| period.wrapped(p));
    sites.points.iter_mut().for_each(|p| *p = wrapped(*p));
    sites.torus = ground.torus.map(|period| Torus { period, images: Vec::new() });
    let bounds = match ground.torus {
        Some(_) => voronoi::bounds(&sites),
        None if is_within && !domain.is_empty() => domain,
        None => reach(&sites),
    };
    // Rows and columns are no longer.
    sites.cells = None;
    sites.tiling = None;
    for _ in (0..rounds).take_while(|_| !ground.stop.is_asked()) {
        let graph = link::link(&sites, Link::Delaunay);
        let cells = Cells::within(bounds, &sites, &graph, Length::ZERO, Length::ZERO);
        let moved: Vec<Vec<Point>> = (0..sites.points.len().div_ceil(CHUNK))
            .into_par_iter()
            .map(|chunk| {
                let (mut ring, mut spare) = (Vec::new(), Vec::new());
                (chunk * CHUNK..((chunk + 1) * CHUNK).min(sites.points.len()))
                    .map(|site| {
                        cells.outline(site, &mut ring, &mut spare);
                        middle(&ring).map_or(sites.points[site], wrapped)
                    })
                    .collect()
            })
            .collect();
        sites.points = moved.concat();
    }
    Ok(sites)
}

/// The extent and all sites.
fn reach(sites: &Sites) -> Rect {
    sites.points.iter().fold(sites.extent, |bounds, &site| bounds.including(site))
}

/// The centre of a ring's area, if it has one.
fn middle(ring: &[Point]) -> Option<Point> {
    let &origin = ring.first()?;
    let area = ring_area(ring);
    if area <= 0.0 {
        return None;
    }
    let (mut x, mut y) = (0.0, 0.0);
    for pair in ring.windows(2) {
        let (a, b) = (pair[0] - origin, pair[1] - origin);
        let weight = a.cross(b) / (6.0 * area);
        x += (a.x + b.x) * weight;
        y += (a.y + b.y) * weight;
    }
    Some(Point::new(origin.x + x, origin.y + y))
}
