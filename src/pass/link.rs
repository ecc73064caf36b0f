//! Links: which tiles are neighbours.
//!
//! In: the sites. Out: a [`Graph`] over them. Every site has its place in the graph, with no links where it has none. On
//! a page that repeats sites are linked across its borders.

mod torus;

use std::cmp::Ordering;

use std::borrow::Cow;

use spade::{DelaunayTriangulation, HasPosition, Point2, Triangulation};

use crate::geom::{Point, Rect, Vec2, hilbert};
use crate::scene::Link;
use crate::stage::{Graph, Sites};

/// Links the sites.
#[must_use]
pub fn link(sites: &Sites, link: Link) -> Graph {
    match link {
        Link::Delaunay => match sites.period() {
            Some(period) => torus::delaunay(&sites.points, period, sites.spacing),
            None => delaunay(&sites.points, Ord::cmp),
        },
        Link::Edges => shared_edges(sites),
    }
}

/// The Delaunay links of sites that `graph` links by another rule: those bound Voronoi cells, whatever makes neighbours.
pub(super) fn delaunay_links<'a>(sites: &Sites, graph: &'a Graph, rule: Link) -> Cow<'a, Graph> {
    match rule {
        Link::Delaunay => Cow::Borrowed(graph),
        Link::Edges => Cow::Owned(link(sites, Link::Delaunay)),
    }
}

/// The cells of a tiling that share an edge. Lowering lets only tilings come here; sites without cells are left alone.
fn shared_edges(sites: &Sites) -> Graph {
    let edges = sites.tiling.as_ref().map_or(&[][..], |tiling| &tiling.edges);
    Graph::new(sites.points.len(), edges, Vec::new())
}

/// The edges and triangles of the Delaunay triangulation.
///
/// Where four or more sites lie on one circle with none inside, several triangulations are Delaunay's, and rounding or
/// the order of insertion would choose between them. Here the whole polygon of such sites is cut into the fan from its
/// site of least index, so that lattices look the same everywhere and on every machine. Of sites that lie in one place
/// only the first is linked. Sites on one line are linked along it. `order` is that of the indices.
fn delaunay(points: &[Point], order: impl Fn(&u32, &u32) -> Ordering) -> Graph {
    let corners = match widest_triangle(points) {
        Ok(corners) => corners,
        Err(line) => return Graph::new(points.len(), &line, Vec::new()),
    };
    let all: Vec<u32> = (0..points.len() as u32).collect();
    let mut triangulation = triangulate(points, &all, corners);
    if triangulation.num_vertices() < points.len() {
        // Which of several sites in one place spade keeps depends on the order, so only the first is offered again.
        let sites = without_repeats(points);
        triangulation = triangulate(points, &sites, corners);
    }
    let mut edges = Vec::with_capacity(triangulation.num_undirected_edges());
    let mut triangles = Vec::with_capacity(triangulation.num_inner_faces());
    // For every edge whether it merely halves a polygon of sites on one circle.
    let mut tied = vec![false; triangulation.num_undirected_edges()];
    for edge in triangulation.undirected_edges() {
        if is_tied(edge.as_directed()) {
            tied[edge.index()] = true;
        } else {
            edges.push(edge.vertices().map(|vertex| vertex.data().site));
        }
    }
    let mut polygon = Vec::new();
    let mut seen = vec![false; triangulation.num_all_faces()];
    for face in triangulation.inner_faces() {
        let sides = face.adjacent_edges();
        polygon.clear();
        if sides.iter().all(|edge| !tied[edge.as_undirected().index()]) {
            polygon.extend(sides.map(|edge| edge.from().data().site));
            cut(&mut polygon, &order, &mut triangles, &mut edges);
            continue;
        }
        // Greater polygons are walked along their outline, so from a face that has a part in it.
        let start = sides.into_iter().find(|edge| !tied[edge.as_undirected().index()]);
        let Some(start) = start.filter(|_| !seen[face.index()]) else { continue };
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
        cut(&mut polygon, &order, &mut triangles, &mut edges);
    }
    Graph::new(points.len(), &edges, sorted(points.len(), &triangles))
}

/// Cuts a polygon into the fan from its site of least index.
fn cut(
    polygon: &mut [u32],
    order: impl Fn(&u32, &u32) -> Ordering,
    triangles: &mut Vec<[u32; 3]>,
    edges: &mut Vec<[u32; 2]>,
) {
    let least = (0..polygon.len()).min_by(|&i, &j| order(&polygon[i], &polygon[j])).unwrap_or(0);
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

/// Triangulates those of the points that are named; they do not all lie on one line.
///
/// They are inserted one by one, in rounds of twice as many each, and along a Hilbert curve within a round, so that each
/// is found from the one before (the biased randomized insertion order of Amenta, Choi and Rote, SoCG 2003). Spade's own
/// bulk loading is a little faster on evenly spread sites, but takes quadratic time where most lie on a line, and its
/// stable variant keeps vertices that it puts off in a hash set, so that a tie could turn out otherwise from run to run.
fn triangulate(points: &[Point], sites: &[u32], corners: [u32; 3]) -> DelaunayTriangulation<Vertex> {
    let bounds = sites.iter().fold(Rect::EMPTY, |bounds, &site| bounds.including(points[site as usize]));
    let scale = f64::from(u16::MAX) / bounds.width().max(bounds.height());
    let mut order: Vec<(u64, u32)> = sites
        .iter()
        .map(|&site| {
            let way = points[site as usize] - bounds.min;
            // A site's round is random: half of them come in the last, a quarter in the one before.
            let round = u64::from(scrambled(site).leading_zeros());
            let place = hilbert::place((way.x * scale) as u16, (way.y * scale) as u16);
            ((64 - round) << 32 | u64::from(place), site)
        })
        .collect();
    order.sort_unstable();
    let mut triangulation = DelaunayTriangulation::with_capacity(sites.len(), sites.len() * 3, sites.len() * 2);
    let mut last = None;
    // A triangle to begin with, since looking for a place among sites on a line takes linear time.
    for site in corners.into_iter().chain(order.into_iter().map(|(_, site)| site)) {
        let p = points[site as usize];
        let vertex = Vertex { position: Point2::new(representable(p.x), representable(p.y)), site };
        let inserted = match last {
            Some(hint) => triangulation.insert_with_hint(vertex, hint),
            None => triangulation.insert(vertex),
        };
        // Coordinates are in range, so that no insertion fails.
        last = inserted.ok().or(last);
    }
    triangulation
}

/// A number that looks random (the finalizer of MurmurHash3).
fn scrambled(mut x: u32) -> u32 {
    x ^= x >> 16;
    x = x.wrapping_mul(0x85eb_ca6b);
    x ^= x >> 13;
    x = x.wrapping_mul(0xc2b2_ae35);
    x ^ x >> 16
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
    sites.sort_by(|a, b| place(a).partial_cmp(&place(b)).unwrap_or(Ordering::Equal));
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

/// Three sites far from lying on one line, or, if all of them lie on one, the links along it.
fn widest_triangle(points: &[Point]) -> Result<[u32; 3], Vec<[u32; 2]>> {
    let Some(&first) = points.first() else { return Err(Vec::new()) };
    // Of several in one place the first is taken.
    let greatest = |measure: &dyn Fn(Point) -> f64| {
        (0u32..)
            .zip(points)
            .fold((0, 0.0), |best, (site, &p)| if measure(p) > best.1 { (site, measure(p)) } else { best })
    };
    let (farthest, _) = greatest(&|p| p.distance_squared(first));
    let along = points[farthest as usize] - first;
    let (outermost, area) = greatest(&|p| along.cross(p - first).abs());
    if area > 0.0 {
        return Ok([0, farthest, outermost]);
    }
    let mut order: Vec<(f64, u32)> = (0u32..).zip(points).map(|(i, &p)| (along.dot(p - first), i)).collect();
    // By place, then by index, so that of several in one place the first is linked.
    order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    order.dedup_by_key(|&mut (_, i)| points[i as usize]);
    Err(order.windows(2).map(|pair| [pair[0].1, pair[1].1]).collect())
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use std::collections::BTreeSet;

    use proptest::prelude::*;

    use super::*;
    use crate::geom::ring_area;
    use crate::pass::fixture::{canvas, paint, rect};
    use crate::pass::place::place;
    use crate::scene::{AngleRule, GridSize, Limits, Placement};

    fn linked(points: &[Point]) -> Graph {
        let area = rect(0.0, 0.0, 1.0, 1.0);
        let sites = Sites {
            points: points.to_vec(),
            domain: area,
            extent: area,
            spacing: 1.0,
            cells: None,
            tiling: None,
            torus: None,
        };
        link(&sites, Link::Delaunay)
    }

    fn placed(width: f64, height: f64, placement: Placement) -> Vec<Point> {
        let canvas = canvas(width, height);
        place(&paint(&canvas, placement, AngleRule::Random), &canvas, &Limits::default()).unwrap().points
    }

    fn edges(graph: &Graph) -> Vec<[u32; 2]> {
        graph.edges().collect()
    }

    fn area(points: &[Point], triangle: &[u32; 3]) -> f64 {
        ring_area(&triangle.map(|site| points[site as usize]))
    }

    /// Triangles are in order and of one sense, their sides are the edges, and no site lies in a circumcircle.
    fn check(points: &[Point], graph: &Graph) {
        assert!(graph.triangles.is_sorted());
        let mut sides = BTreeSet::new();
        for triangle in &graph.triangles {
            let &[a, b, c] = triangle;
            assert!(a < b && a < c);
            assert!(area(points, triangle) > 0.0);
            sides.extend([[a, b], [b, c], [c, a]].map(|[a, b]| [a.min(b), a.max(b)]));
            let [a, b, c] = triangle.map(|site| points[site as usize]);
            for &d in points {
                let row = |p: Point| (p.x - d.x, p.y - d.y, (p - d).length_squared());
                let ((ax, ay, az), (bx, by, bz), (cx, cy, cz)) = (row(a), row(b), row(c));
                let inside = ax * (by * cz - bz * cy) - ay * (bx * cz - bz * cx) + az * (bx * cy - by * cx);
                assert!(inside < 1e-6, "{inside}");
            }
        }
        assert_eq!(sides.into_iter().collect::<Vec<_>>(), edges(graph));
    }

    fn points(coordinates: std::ops::Range<i32>, count: usize) -> impl Strategy<Value = Vec<Point>> {
        let coordinate = move || coordinates.clone().prop_map(|x| f64::from(x) / 8.0);
        proptest::collection::btree_set((0..64i32, 0..64i32), 0..count)
            .prop_flat_map(move |set| {
                let near = proptest::collection::vec((coordinate(), coordinate()), set.len());
                (Just(set), near)
            })
            .prop_map(|(set, near)| {
                let point = |((x, y), (dx, dy)): ((i32, i32), (f64, f64))| {
                    Point::new(f64::from(x) + dx * 0.9, f64::from(y) + dy * 0.9)
                };
                set.into_iter().zip(near).map(point).collect()
            })
            .prop_shuffle()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(128))]

        #[test]
        fn links_are_delaunay_s(points in points(0..8, 60)) {
            prop_assume!(widest_triangle(&points).is_ok());
            let graph = linked(&points);
            check(&points, &graph);
            prop_assert_eq!(edges(&graph).len() + 1, points.len() + graph.triangles.len());
        }

        #[test]
        fn ties_on_a_lattice_are_cut_too(points in points(0..1, 300)) {
            prop_assume!(widest_triangle(&points).is_ok());
            check(&points, &linked(&points));
        }

        #[test]
        fn links_do_not_depend_on_the_order_of_sites(points in points(0..1000, 60), turn in 0usize..60) {
            // Sites at odd places leave no ties.
            let points: Vec<Point> =
                points.iter().enumerate().map(|(i, p)| Point::new(p.x + 1e-4 * i as f64, p.y)).collect();
            let turn = turn % points.len().max(1);
            let mut turned = points.clone();
            turned.rotate_left(turn);
            let number = |site: u32| ((site as usize + turn) % points.len()) as u32;
            let mut there: Vec<[u32; 2]> = linked(&turned)
                .edges()
                .map(|edge| edge.map(number))
                .map(|[a, b]| [a.min(b), a.max(b)])
                .collect();
            there.sort_unstable();
            prop_assert_eq!(there, edges(&linked(&points)));
        }
    }

    #[test]
    fn squares_are_halved_from_their_first_site() {
        let grid = placed(6.0, 6.0, Placement::Grid(GridSize::Cells { columns: 8, rows: 8 }));
        let graph = linked(&grid);
        check(&grid, &graph);
        assert_eq!((edges(&graph).len(), graph.triangles.len()), (161, 98));
        // An inner site has its four neighbours in the lattice and those at either end of one diagonal.
        assert_eq!(graph.neighbours(27), [18, 19, 26, 28, 35, 36]);
        // The same where coordinates are rounded.
        let grid = placed(97.3, 61.7, Placement::Grid(GridSize::Cells { columns: 37, rows: 23 }));
        let graph = linked(&grid);
        let diagonals = 36 * 22;
        assert_eq!(edges(&graph).len(), 36 * 23 + 37 * 22 + diagonals);
        assert!(graph.edges().all(|[a, b]| [1, 37, 38].contains(&(b - a))));
    }

    #[test]
    fn a_hexagonal_lattice_has_six_neighbours() {
        let lattice = placed(30.0, 20.0, Placement::Hex { spacing: crate::geom::Length::mm(1.3) });
        let graph = linked(&lattice);
        check(&lattice, &graph);
        let middle = rect(3.0, 3.0, 27.0, 17.0);
        let inner: Vec<usize> = (0..lattice.len()).filter(|&i| middle.contains(lattice[i])).collect();
        assert!(inner.len() > 200);
        for site in inner {
            let lengths = graph.neighbours(site).iter().map(|&j| lattice[j as usize].distance(lattice[site]));
            assert_eq!(lengths.filter(|length| (length - 1.3).abs() < 1e-9).count(), 6);
            assert_eq!(graph.neighbours(site).len(), 6);
        }
    }

    #[test]
    fn a_regular_polygon_is_a_fan() {
        let corner = |i: u32| {
            let way = crate::geom::Angle::degrees(30.0 * f64::from(i * 5 % 12)).unit();
            Point::new(20.0, 20.0) + way * 7.0
        };
        let ring: Vec<Point> = (0..12).map(corner).collect();
        let graph = linked(&ring);
        check(&ring, &graph);
        assert_eq!(graph.neighbours(0), (1..12).collect::<Vec<u32>>());
    }

    #[test]
    fn few_sites_and_sites_in_a_row_have_no_triangles() {
        let row = |xs: &[f64]| -> Vec<Point> { xs.iter().map(|&x| Point::new(x, 3.0 * x)).collect() };
        let cases: [(&[f64], &[[u32; 2]]); 5] = [
            (&[], &[]),
            (&[4.0], &[]),
            (&[4.0, 1.0], &[[0, 1]]),
            (&[4.0, 1.0, 8.0, 2.0], &[[0, 2], [0, 3], [1, 3]]),
            (&[4.0, 4.0, 1.0, 4.0, 1.0], &[[0, 2]]),
        ];
        for (xs, links) in cases {
            let graph = linked(&row(xs));
            assert_eq!((graph.len(), graph.triangles.len()), (xs.len(), 0));
            assert_eq!(edges(&graph), links);
        }
    }

    #[test]
    fn long_rows_and_crosses_are_linked_in_little_time() {
        let mut row: Vec<Point> = (0..100_000).map(|i| Point::new(f64::from(i) * 0.1, 5.0)).collect();
        assert_eq!(linked(&row).edges().count(), 99_999);
        row[777] = Point::new(8.0, 9.0);
        assert_eq!(linked(&row).triangles.len(), 99_998);
        let slanted: Vec<Point> = row.iter().map(|p| Point::new(p.x, p.x * 0.3)).collect();
        assert!(linked(&slanted).edges().count() >= 99_999);
        let cross: Vec<Point> = row.iter().map(|p| if p.x % 0.2 < 0.1 { *p } else { Point::new(p.y, p.x) }).collect();
        assert!(linked(&cross).triangles.len() > 99_000);
    }

    #[test]
    fn of_sites_in_one_place_the_first_is_linked() {
        let corners = [(0.0, 0.0), (5.0, 0.0), (5.0, 0.0), (0.0, 5.0), (-0.0, 0.0), (5.0, 6.0), (1e-50, 0.0)];
        let graph = linked(&corners.map(|(x, y)| Point::new(x, y)));
        assert_eq!(edges(&graph), [[0, 1], [0, 3], [1, 3], [1, 5], [3, 5]]);
        assert_eq!(graph.triangles.len(), 2);
    }

    #[test]
    fn far_away_sites_are_linked() {
        let graph = linked(&[(0.0, 0.0), (1e300, 0.0), (0.0, 1e300), (1e-300, 1e-300)].map(|(x, y)| Point::new(x, y)));
        assert_eq!(edges(&graph), [[0, 1], [0, 2], [1, 2]]);
    }
}
