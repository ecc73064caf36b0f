//! Delaunay's links on a page that repeats.
//!
//! The triangulation of the torus is that of the whole plane covered with periods. A part of it around the first period
//! is triangulated, and what it says of the first period's own sites is true as soon as their triangles' circumcircles
//! lie in that part: no site beyond could lie in them (Caroli and Teillaud, "Delaunay triangulations of closed Euclidean
//! d-orbifolds", 2016). A disc that is as wide as the period's diagonal holds an image of every site, so that a part that
//! reaches a diagonal beyond the period is always enough.

use std::cmp::Ordering;

use crate::geom::{Period, Point, Rect};
use crate::stage::Graph;

use super::delaunay as plane;

/// How far beyond the period sites are looked at first, in spacings. Empty discs among Poisson-disk sites are less than
/// three spacings wide.
const FIRST_REACH: f64 = 3.0;

/// Links sites of the first period across its borders.
pub(super) fn delaunay(points: &[Point], period: Period, spacing: f64) -> Graph {
    let size = period.area();
    // A little more than the diagonal, so that no rounding is needed to be kind.
    let enough = size.min.distance(size.max) * 1.01;
    // Sites of one place or one row have no spacing of their own; doubling has to begin with something.
    let mut reach = (spacing * FIRST_REACH).max(enough / 4096.0).min(enough);
    loop {
        let cover = Cover::new(points, period, reach);
        let graph = plane(&cover.points, |a, b| cover.order(*a, *b));
        if reach >= enough || cover.is_settled(&graph) {
            return cover.wrapped(&graph);
        }
        reach = (reach * 2.0).min(enough);
    }
}

/// A part of the plane that is covered with periods.
struct Cover {
    /// The sites of the first period, then their images.
    points: Vec<Point>,
    /// The site that each is or is an image of.
    originals: Vec<u32>,
    /// How many are no images.
    own: usize,
    area: Rect,
}

impl Cover {
    /// As far as `reach` millimetres beyond the first period.
    fn new(points: &[Point], period: Period, reach: f64) -> Self {
        let area = period.area().grown(reach);
        let mut cover =
            Self { points: points.to_vec(), originals: (0..points.len() as u32).collect(), own: points.len(), area };
        for (site, &p) in (0u32..).zip(points) {
            // The first way is no way at all.
            for way in period.ways(&Rect::new(p, p), &area).skip(1) {
                cover.points.push(p + way);
                cover.originals.push(site);
            }
        }
        cover
    }

    /// The order in which ties are broken: the same for all images of some sites.
    fn order(&self, a: u32, b: u32) -> Ordering {
        let (p, q) = (self.points[a as usize], self.points[b as usize]);
        let original = |site: u32| self.originals[site as usize];
        original(a).cmp(&original(b)).then(p.y.total_cmp(&q.y)).then(p.x.total_cmp(&q.x))
    }

    /// Whether nothing beyond the area could change a triangle of an own site.
    fn is_settled(&self, graph: &Graph) -> bool {
        let mut corners = vec![0usize; self.own];
        for triangle in &graph.triangles {
            if triangle.iter().all(|&site| site as usize >= self.own) {
                continue;
            }
            if !self.holds_circle(triangle.map(|site| self.points[site as usize])) {
                return false;
            }
            for &site in triangle {
                if let Some(count) = corners.get_mut(site as usize) {
                    *count += 1;
                }
            }
        }
        // Where the first site has triangles, only sites at the place of an earlier one have none. Round a site that lies on
        // no rim there are as many triangles as neighbours.
        corners.first().is_none_or(|&count| count > 0)
            && (0..self.own).all(|site| corners[site] == graph.neighbours(site).len())
    }

    /// Whether the circle through three points lies in the area.
    fn holds_circle(&self, [a, b, c]: [Point; 3]) -> bool {
        let (u, v) = (b - a, c - a);
        let twice = 2.0 * u.cross(v);
        let (uu, vv) = (u.length_squared(), v.length_squared());
        let way = crate::geom::Vec2::new((v.y * uu - u.y * vv) / twice, (u.x * vv - v.x * uu) / twice);
        let (centre, radius) = (a + way, way.length());
        // What is no number is not less.
        centre.x - radius > self.area.min.x
            && centre.y - radius > self.area.min.y
            && centre.x + radius < self.area.max.x
            && centre.y + radius < self.area.max.y
    }

    /// The graph of the own sites, every triangle once.
    fn wrapped(&self, graph: &Graph) -> Graph {
        let original = |site: u32| self.originals[site as usize];
        let star = |site: usize| {
            graph.neighbours(site).iter().map(|&other| (original(other), self.points[other as usize])).collect()
        };
        let stars: Vec<Vec<(u32, Point)>> = (0..self.own).map(star).collect();
        let mut triangles: Vec<[u32; 3]> = graph
            .triangles
            .iter()
            .filter_map(|triangle| {
                let mut corners = *triangle;
                let least = (0..3).min_by(|&i, &j| self.order(corners[i], corners[j]))?;
                corners.rotate_left(least);
                // Of a triangle's images the one whose first corner is no image.
                ((corners[0] as usize) < self.own).then(|| corners.map(original))
            })
            .collect();
        triangles.sort_unstable();
        Graph::around(&stars, triangles)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::geom::Length;

    const PERIOD: Period = Period::new(Length::mm(8.0), Length::mm(5.0));

    /// Every triangle of images within two periods that has no site in its circle, by the way to its corners.
    fn stars(points: &[Point], period: Period) -> Vec<Vec<Point>> {
        let cover = Cover::new(points, period, 2.0 * period.width.max(period.height).to_mm());
        let is_empty = |p: Point, q: Point, r: Point| {
            cover.points.iter().all(|&d| {
                let row = |p: Point| (p.x - d.x, p.y - d.y, (p - d).length_squared());
                let ((ax, ay, az), (bx, by, bz), (cx, cy, cz)) = (row(p), row(q), row(r));
                ax * (by * cz - bz * cy) - ay * (bx * cz - bz * cx) + az * (bx * cy - by * cx) < 1e-9
            })
        };
        let star = |&p: &Point| {
            let others = || cover.points.iter().copied().filter(|&q| q != p);
            let is_linked = |&q: &Point| others().any(|r| (q - p).cross(r - p) > 1e-9 && is_empty(p, q, r));
            let mut star: Vec<Point> = others().filter(is_linked).collect();
            star.sort_by(|a, b| a.y.total_cmp(&b.y).then(a.x.total_cmp(&b.x)));
            star
        };
        points.iter().map(star).collect()
    }

    fn sites(count: std::ops::Range<usize>) -> impl Strategy<Value = Vec<Point>> {
        proptest::collection::vec((0.0..8.0f64, 0.0..5.0f64), count)
            .prop_map(|sites| sites.into_iter().map(|(x, y)| Point::new(x, y)).collect())
    }

    /// How many links there are, those between the same sites by different ways counted each.
    fn links(graph: &Graph, points: &[Point]) -> usize {
        (0..points.len()).map(|site| graph.places(site, points).count()).sum::<usize>() / 2
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(48))]

        #[test]
        fn links_are_those_of_the_plane(points in sites(2..7), spacing in 0.1..4.0f64) {
            let graph = delaunay(&points, PERIOD, spacing);
            for (site, star) in stars(&points, PERIOD).into_iter().enumerate() {
                let mut found: Vec<Point> = graph.places(site, &points).collect();
                found.sort_by(|a, b| a.y.total_cmp(&b.y).then(a.x.total_cmp(&b.x)));
                prop_assert_eq!(found.len(), star.len());
                prop_assert!(found.iter().zip(&star).all(|(a, b)| a.distance(*b) < 1e-9));
            }
        }

        #[test]
        fn euler_s_formula_holds(points in sites(1..200), spacing in 0.1..4.0f64) {
            let graph = delaunay(&points, PERIOD, spacing);
            prop_assert_eq!(links(&graph, &points), 3 * points.len());
            prop_assert_eq!(graph.triangles.len(), 2 * points.len());
        }
    }

    #[test]
    fn ties_are_broken_alike_all_round() {
        let lattice = |columns: u32, rows: u32| -> Vec<Point> {
            let size = PERIOD.area().max;
            let at = |i: u32| {
                let (column, row) = (f64::from(i % columns), f64::from(i / columns));
                Point::new((column + 0.5) * size.x / f64::from(columns), (row + 0.5) * size.y / f64::from(rows))
            };
            (0..columns * rows).map(at).collect()
        };
        for (columns, rows) in [(1, 1), (2, 1), (2, 2), (3, 3), (7, 4), (37, 23)] {
            let points = lattice(columns, rows);
            let graph = delaunay(&points, PERIOD, 0.5);
            assert_eq!(links(&graph, &points), 3 * points.len(), "{columns} x {rows}");
            assert_eq!(graph.triangles.len(), 2 * points.len());
        }
    }

    #[test]
    fn of_sites_in_one_place_the_first_is_linked() {
        let points = [(1.0, 1.0), (6.0, 2.0), (1.0, 1.0), (3.0, 4.0)].map(|(x, y)| Point::new(x, y));
        let graph = delaunay(&points, PERIOD, 1.0);
        assert_eq!(graph.places(2, &points).count(), 0);
        assert_eq!(links(&graph, &points), 9);
        assert!(delaunay(&[], PERIOD, 1.0).is_empty());
    }
}
