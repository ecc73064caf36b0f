//! How evenly sites lie, told from Delaunay's triangles between them.

use std::borrow::Cow;

use crate::geom::{Point, Rect, Vec2};
use crate::metrics::{Measured, space};
use crate::region::Region;
use crate::stage::Graph;

use super::variation;

/// Triangles, and whole cells, below which their areas say nothing.
const FEWEST: usize = 8;

/// How sites lie.
pub(super) struct Lie {
    /// How much the triangles' areas vary, as SD over mean.
    pub(super) triangles: f64,
    /// How much the areas of whole Voronoi cells vary; none where there are too few.
    pub(super) cells: Option<f64>,
    /// The mean area of a cell, in square millimetres.
    pub(super) cell: f64,
}

impl Lie {
    /// None where there are too few triangles.
    ///
    /// A triangle counts where the centre of its circle lies in the region, or in the box of the sites where the region is
    /// not known: those that do not are slivers along the outline, whose shape is the outline's. A cell is whole where
    /// triangles go all round its site and all of them count.
    pub(super) fn new(measured: &Measured) -> Option<Self> {
        let region = if measured.region.is_empty() { Region::rect(around(measured)) } else { measured.region.clone() };
        let graph = triangulated(measured, &region);
        let mut areas = Vec::with_capacity(graph.triangles.len());
        let mut cells = vec![Cell::default(); measured.sites.len()];
        for &corners in &graph.triangles {
            let Some(triangle) = Triangle::new(measured, &region, corners) else { continue };
            areas.push(triangle.area);
            for (corner, part) in corners.into_iter().zip(triangle.parts) {
                let cell = &mut cells[corner as usize];
                cell.area += part;
                cell.triangles += 1;
            }
        }
        if areas.len() < FEWEST {
            return None;
        }
        let whole = (0..).zip(&cells).filter(|(site, cell)| cell.triangles == graph.neighbours(*site).len());
        let whole: Vec<f64> = whole.map(|(_, cell)| cell.area).filter(|&area| area > 0.0).collect();
        Some(Self {
            triangles: variation(&areas)?,
            cells: if whole.len() < FEWEST { None } else { variation(&whole) },
            // There are two triangles for every site.
            cell: areas.iter().sum::<f64>() / areas.len() as f64 * 2.0,
        })
    }
}

/// What is known of a Voronoi cell.
#[derive(Clone, Default)]
struct Cell {
    area: f64,
    /// How many of the triangles at its site count.
    triangles: usize,
}

/// The triangulation of the sites: the graph itself, unless its links are others.
fn triangulated<'a>(measured: &'a Measured, region: &Region) -> Cow<'a, Graph> {
    if !measured.graph.triangles.is_empty() {
        return Cow::Borrowed(&measured.graph);
    }
    Cow::Owned(space::triangulated(&measured.sites, region, measured.period).1)
}

/// The box around the sites.
fn around(measured: &Measured) -> Rect {
    let first = measured.sites.first().copied().unwrap_or_default();
    measured.sites.iter().fold(Rect::new(first, first), |bounds, &p| bounds.including(p))
}

/// A triangle that counts.
struct Triangle {
    area: f64,
    /// How much of it belongs to each corner's Voronoi cell: signed, so that what an obtuse angle gives away is taken
    /// back by the neighbour (M. Meyer et al., "Discrete Differential-Geometry Operators for Triangulated 2-Manifolds",
    /// 2003, section 3.3).
    parts: [f64; 3],
}

impl Triangle {
    fn new(measured: &Measured, region: &Region, corners: [u32; 3]) -> Option<Self> {
        let [a, b, c] = corners.map(|corner| measured.sites[corner as usize]);
        let way = |from: Point, to: Point| measured.period.map_or(to - from, |period| period.shortest(to - from));
        let (u, v) = (way(a, b), way(a, c));
        let twice = u.cross(v);
        let (uu, vv) = (u.length_squared(), v.length_squared());
        let centre = a + Vec2::new((v.y * uu - u.y * vv) / (2.0 * twice), (u.x * vv - v.x * uu) / (2.0 * twice));
        // Where the corners lie on a line the centre is no number, and nowhere.
        let is_inside = centre.x.is_finite() && centre.y.is_finite();
        if !is_inside || (measured.period.is_none() && !region.contains(centre)) {
            return None;
        }
        // Cotangents at the corners, and what each gives the ends of the side across.
        let w = v - u;
        let at_a = u.dot(v) / twice.abs() * w.length_squared() / 8.0;
        let at_b = -u.dot(w) / twice.abs() * vv / 8.0;
        let at_c = v.dot(w) / twice.abs() * uu / 8.0;
        Some(Self { area: twice.abs() / 2.0, parts: [at_b + at_c, at_a + at_c, at_a + at_b] })
    }
}
