//! Links: which tiles are neighbours.
//!
//! In: the sites. Out: a [`Graph`] over them. Every site has its place in the graph, with no links where it has none.

use spade::{DelaunayTriangulation, HasPosition, Point2, Triangulation};

use crate::geom::{Point, Vec2};
use crate::scene::Link;
use crate::stage::{Graph, Sites};

/// Links the sites.
#[must_use]
pub fn link(sites: &Sites, link: Link) -> Graph {
    match link {
        Link::Delaunay => delaunay(&sites.points),
    }
}

/// The edges and triangles of the Delaunay triangulation.
///
/// Where four or more sites lie on one circle with none inside, several triangulations are Delaunay's, and rounding or
/// the order of insertion would choose between them. Here the whole polygon of such sites is cut into the fan from its
/// site of least index, so that lattices look the same everywhere and on every machine. Of sites that lie in one place
/// only the first is linked. Sites on one line are linked along it.
fn delaunay(points: &[Point]) -> Graph {
    if let Some(edges) = links_along_line(points) {
        return Graph::new(points.len(), &edges, Vec::new());
    }
    let all: Vec<u32> = (0..points.len() as u32).collect();
    let mut triangulation = triangulate(points, &all);
    if triangulation.num_vertices() < points.len() {
        triangulation = triangulate(points, &without_repeats(points));
    }
    let mut edges = Vec::with_capacity(triangulation.num_undirected_edges());
    let mut triangles = Vec::with_capacity(triangulation.num_inner_faces());
    // For every edge whether it merely halves a polygon of sites on one circle.
    let tied: Vec<bool> = triangulation.undirected_edges().map(|edge| is_tied(edge.as_directed())).collect();
    for (edge, &tied) in triangulation.undirected_edges().zip(&tied) {
        if !tied {
            edges.push(edge.vertices().map(|vertex| vertex.data().site));
        }
    }
    let mut polygon = Vec::new();
    let mut seen = vec![false; triangulation.num_all_faces()];
    for face in triangulation.inner_faces() {
        // Polygons are walked along their outline, so from a face that has a part in it.
        let Some(start) = face.adjacent_edges().into_iter().find(|edge| !tied[edge.as_undirected().index()]) else {
            continue;
        };
        if seen[face.index()] {
            continue;
        }
        polygon.clear();
        let mut edge = start;
        loop {
            polygon.push(edge.from().data().site);
            seen[edge.face().index()] = true;
            edge = edge.next();
            while tied[edge.as_undirected().index()] {
                edge = edge.rev();
                seen[edge.face().index()] = true;
                edge = edge.next();
            }
            if edge == start {
                break;
            }
        }
        cut(&mut polygon, &mut triangles, &mut edges);
    }
    Graph::new(points.len(), &edges, sorted(points.len(), &triangles))
}

/// Cuts a polygon into the fan from its site of least index.
fn cut(polygon: &mut [u32], triangles: &mut Vec<[u32; 3]>, edges: &mut Vec<[u32; 2]>) {
    let least = (0..polygon.len()).min_by_key(|&i| polygon[i]).unwrap_or(0);
    polygon.rotate_left(least);
    let [apex, rest @ ..] = polygon else { return };
    for pair in rest.windows(2) {
        triangles.push([*apex, pair[0], pair[1]]);
    }
    // The first and the last of the fan's edges belong to the outline.
    if let [_, inner @ .., _] = rest {
        edges.extend(inner.iter().map(|&site| [*apex, site]));
    }
}

/// Triangles in order. Their first corners are indices of sites, so that one pass over counts sorts nearly all of it.
fn sorted(sites: usize, triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let mut starts = vec![0u32; sites + 1];
    for triangle in triangles {
        starts[triangle[0] as usize + 1] += 1;
    }
    for i in 0..sites {
        starts[i + 1] += starts[i];
    }
    let mut next = starts.clone();
    let mut out = vec![[0; 3]; triangles.len()];
    for &triangle in triangles {
        let slot = &mut next[triangle[0] as usize];
        out[*slot as usize] = triangle;
        *slot += 1;
    }
    for bounds in starts.windows(2) {
        out[bounds[0] as usize..bounds[1] as usize].sort_unstable();
    }
    out
}

/// A site as spade keeps it.
struct Vertex {
    position: Point2<f64>,
    site: u32,
}

impl HasPosition for Vertex {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        self.position
    }
}

/// Triangulates those of the points that are named.
fn triangulate(points: &[Point], sites: &[u32]) -> DelaunayTriangulation<Vertex> {
    let vertices = sites.iter().map(|&site| {
        let p = points[site as usize];
        Vertex { position: Point2::new(representable(p.x), representable(p.y)), site }
    });
    // Not `bulk_load_stable`: it keeps the vertices that it puts off in a hash set, so that their order, and with it
    // the outcome of a tie, would change from run to run. Coordinates are in range, so that loading cannot fail.
    DelaunayTriangulation::bulk_load(vertices.collect()).unwrap_or_default()
}

/// A coordinate within the range that spade's exact predicates work in. No page comes near its ends.
fn representable(x: f64) -> f64 {
    if x.abs() < spade::MIN_ALLOWED_VALUE { 0.0 } else { x.clamp(-spade::MAX_ALLOWED_VALUE, spade::MAX_ALLOWED_VALUE) }
}

/// The first of the sites at every place, in the order of their indices.
fn without_repeats(points: &[Point]) -> Vec<u32> {
    let place = |&site: &u32| {
        let p = points[site as usize];
        (representable(p.x), representable(p.y))
    };
    let mut sites: Vec<u32> = (0..points.len() as u32).collect();
    // The sort is stable: of several in one place the first comes first, and that one stays.
    sites.sort_by(|a, b| place(a).partial_cmp(&place(b)).unwrap_or(std::cmp::Ordering::Equal));
    sites.dedup_by_key(|site| place(site));
    sites.sort_unstable();
    sites
}

/// The sine of what the two angles opposite an edge have to make up half a turn by, for its four sites to lie on one
/// circle. Coordinates are good to 1e-13 of a spacing on any page.
const SAME_CIRCLE: f64 = 1e-9;

/// The sine of an angle below which a triangle is a sliver at the rim, whose circle is too large to be compared. There
/// the exact predicates decide alone.
const SLIVER: f64 = 1e-6;

/// Whether the triangles on both sides of an edge have one circumcircle.
fn is_tied(edge: spade::handles::DirectedEdgeHandle<'_, Vertex, (), (), ()>) -> bool {
    let (Some(left), Some(right)) = (edge.opposite_vertex(), edge.rev().opposite_vertex()) else { return false };
    let [from, to] = edge.positions();
    let angle_at = |apex: Point2<f64>| {
        let a = Vec2::new(from.x - apex.x, from.y - apex.y);
        let b = Vec2::new(to.x - apex.x, to.y - apex.y);
        (a.cross(b), a.dot(b), a.length_squared() * b.length_squared())
    };
    let (left_sine, left_cosine, left_scale) = angle_at(left.position());
    let (right_sine, right_cosine, right_scale) = angle_at(right.position());
    // Both angles are measured in the sense in which the left one is positive.
    let right_sine = -right_sine;
    let scale = (left_scale * right_scale).sqrt();
    let sine_of_sum = left_sine * right_cosine + left_cosine * right_sine;
    sine_of_sum.abs() <= SAME_CIRCLE * scale && left_sine.abs() > SLIVER * left_scale.sqrt()
}

/// The links of sites that all lie on one line, or `None` if they do not.
///
/// They are told apart from the rest because inserting them one by one would take quadratic time, and because there is
/// no triangle to begin with.
fn links_along_line(points: &[Point]) -> Option<Vec<[u32; 2]>> {
    let Some(&first) = points.first() else { return Some(Vec::new()) };
    let farthest = points
        .iter()
        .copied()
        .fold(first, |far, p| if p.distance_squared(first) > far.distance_squared(first) { p } else { far });
    let along = farthest - first;
    if points.iter().any(|&p| along.cross(p - first) != 0.0) {
        return None;
    }
    let mut order: Vec<(f64, u32)> = (0u32..).zip(points).map(|(i, &p)| (along.dot(p - first), i)).collect();
    // By place, then by index, so that of several in one place the first is linked.
    order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    order.dedup_by_key(|&mut (_, i)| points[i as usize]);
    Some(order.windows(2).map(|pair| [pair[0].1, pair[1].1]).collect())
}
