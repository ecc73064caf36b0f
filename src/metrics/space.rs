//! How evenly tiles lie on the region, and how much of it they cover.

use rayon::prelude::*;
use serde::Serialize;

use crate::geom::clip::{HalfPlane, clip_convex};
use crate::geom::{Length, Period, Point, Polygon, Rect, Vec2, ring_area, ring_bounds};
use crate::pass::cut::voronoi::Cells;
use crate::pass::link::link;
use crate::region::Region;
use crate::scene::Link;
use crate::stage::{Graph, Sites, Torus};
use crate::stats::summary;

use super::{Measured, Scalars};

/// Columns and rows of the grid that coverage is looked at on.
const SIDE: usize = 200;

/// Words of a row of the grid.
const WORDS: usize = SIDE.div_ceil(64);

/// Rings of so many corners are cut to every cell at once; others are first cut up among the cells.
const FEW_CORNERS: usize = 64;

/// So few cells are not worth another division of the region.
const FEW_CELLS: usize = 8;

/// Coverage and evenness.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Space {
    /// The share of the region that lies in some tile, in [0, 1]: of a grid of 200 x 200 cell centres over the region's
    /// bounding box, those inside the region are looked at. None without tiles, or where nothing is known of their
    /// outlines or of the region.
    pub c_cov: Option<f64>,
    /// How unevenly tiles lie: the sample standard deviation over the mean of the areas of their sites' Voronoi cells,
    /// clipped to the region; not negative, 0 on a lattice. None for fewer than two tiles or without a region.
    pub u_vor: Option<f64>,
}

impl Space {
    /// The figures by their names.
    #[must_use]
    pub fn scalars(&self) -> Scalars {
        vec![("c_cov".into(), self.c_cov), ("u_vor".into(), self.u_vor)]
    }
}

/// Measures coverage and evenness.
#[must_use]
pub fn measure(measured: &Measured) -> Space {
    Space { c_cov: coverage(measured), u_vor: unevenness(measured) }
}

/// The share of the region that lies in some tile.
fn coverage(measured: &Measured) -> Option<f64> {
    let bounds = measured.region.bounds();
    if measured.outlines.is_empty() || measured.region.is_empty() {
        return None;
    }
    let grid = Grid::new(bounds);
    let (mut inside, mut covered, mut tile) = (Mask::default(), Mask::default(), Mask::default());
    for ring in measured.region.polygons().iter().flat_map(Polygon::rings) {
        grid.toggle(ring.iter().copied(), &mut inside);
    }
    for outline in &measured.outlines {
        let extent = ring_bounds(outline);
        // Tiles of a page that repeats reach round its borders.
        let none = || std::iter::once(Vec2::default());
        let ways: Vec<_> =
            measured.period.map_or_else(|| none().collect(), |period| period.ways(&extent, &bounds).collect());
        for way in ways {
            let rows = grid.toggle(outline.iter().map(|&p| p + way), &mut tile);
            covered.take_over(&mut tile, rows);
        }
    }
    let (all, found) = (inside.count(), covered.common(&inside));
    (all > 0).then(|| f64::from(found) / f64::from(all))
}

/// The centres of the cells of a grid over a box.
struct Grid {
    xs: [f64; SIDE],
    ys: [f64; SIDE],
    bounds: Rect,
}

impl Grid {
    fn new(bounds: Rect) -> Self {
        let centres =
            |start: f64, length: f64| std::array::from_fn(|i| start + (i as f64 + 0.5) * (length / SIDE as f64));
        Self { xs: centres(bounds.min.x, bounds.width()), ys: centres(bounds.min.y, bounds.height()), bounds }
    }

    /// Turns round every centre that a ring holds by the even-odd rule: those to the left of an edge, in the rows that it
    /// spans, for every edge. Each centre is decided as [`crate::geom::ring_contains`] would; one on an edge lies on the same
    /// side of it in whichever sense the edge is run along. Returns the rows that were looked at.
    fn toggle(&self, ring: impl Iterator<Item = Point> + Clone, mask: &mut Mask) -> std::ops::Range<usize> {
        let Some(last) = ring.clone().last() else { return 0..0 };
        let (mut start, mut end) = (SIDE, 0);
        let mut a = last;
        for b in ring {
            let (upper, lower) = if a.y <= b.y { (a, b) } else { (b, a) };
            // The rows from whose centre on each end lies above.
            let rows = self.first(&self.ys, upper.y, self.bounds.min.y, self.bounds.height())
                ..self.first(&self.ys, lower.y, self.bounds.min.y, self.bounds.height());
            (start, end) = (start.min(rows.start), end.max(rows.end));
            let edge = lower - upper;
            for row in rows {
                let y = self.ys[row];
                let is_left = |column: usize| edge.cross(Point::new(self.xs[column], y) - upper) > 0.0;
                // Where the edge crosses the row, but for rounding.
                let x = upper.x + edge.x * ((y - upper.y) / edge.y);
                let mut columns = self.first(&self.xs, x, self.bounds.min.x, self.bounds.width());
                while columns > 0 && !is_left(columns - 1) {
                    columns -= 1;
                }
                while columns < SIDE && is_left(columns) {
                    columns += 1;
                }
                mask.toggle(row, columns);
            }
            a = b;
        }
        start.min(end)..end
    }

    /// The first centre that is not below a value.
    fn first(&self, centres: &[f64; SIDE], value: f64, start: f64, length: f64) -> usize {
        // A cast of what is out of range, or no number, stops at the ends.
        let mut at = (((value - start) / length * SIDE as f64 - 0.5).ceil() as usize).min(SIDE);
        while at > 0 && centres[at - 1] >= value {
            at -= 1;
        }
        while at < SIDE && centres[at] < value {
            at += 1;
        }
        at
    }
}

/// A bit for every centre of a grid.
struct Mask([[u64; WORDS]; SIDE]);

impl Default for Mask {
    fn default() -> Self {
        Self([[0; WORDS]; SIDE])
    }
}

impl Mask {
    /// Turns the first bits of a row round.
    fn toggle(&mut self, row: usize, columns: usize) {
        for (i, word) in self.0[row].iter_mut().enumerate() {
            let bits = columns.saturating_sub(i * 64);
            *word ^= if bits >= 64 { u64::MAX } else { (1 << bits) - 1 };
        }
    }

    /// Adds the bits of some rows of another, which are cleared.
    fn take_over(&mut self, other: &mut Self, rows: std::ops::Range<usize>) {
        for (own, theirs) in self.0[rows.clone()].iter_mut().zip(&mut other.0[rows]) {
            for (own, theirs) in own.iter_mut().zip(theirs) {
                *own |= std::mem::take(theirs);
            }
        }
    }

    fn count(&self) -> u32 {
        self.common(self)
    }

    /// How many bits are set in both.
    fn common(&self, other: &Self) -> u32 {
        let pairs = self.0.as_flattened().iter().zip(other.0.as_flattened());
        pairs.map(|(a, b)| (a & b).count_ones()).sum()
    }
}

/// The sample standard deviation over the mean of the areas of the sites' cells.
fn unevenness(measured: &Measured) -> Option<f64> {
    let areas = summary(&areas(measured))?;
    Some(areas.sd? / areas.mean).filter(|unevenness| unevenness.is_finite())
}

/// The area of every tile's Voronoi cell within the region, in square millimetres.
pub(crate) fn areas(measured: &Measured) -> Vec<f64> {
    cell_areas(&measured.sites, &measured.region, measured.period)
}

/// The outline of every tile's Voronoi cell, whole also where it leaves the region; empty where another site lies at the
/// same place before it.
pub(crate) fn outlines(measured: &Measured) -> Vec<Vec<Point>> {
    let (sites, graph) = triangulated(&measured.sites, &measured.region, measured.period);
    let cells = Cells::new(&sites, &graph, Length::ZERO, Length::ZERO);
    let outline = |site: usize| {
        let mut ring = Vec::new();
        cells.outline(site, &mut ring, &mut Vec::new());
        ring
    };
    (0..sites.points.len()).into_par_iter().map(outline).collect()
}

/// Sites with the links of their triangulation. Links need not be Delaunay's, and sites beyond the region take part in no
/// cell, so that they are triangulated anew.
pub(super) fn triangulated(points: &[Point], region: &Region, period: Option<Period>) -> (Sites, Graph) {
    let bounds = points.iter().fold(region.bounds(), |bounds, &p| bounds.including(p));
    // What the triangulation of a torus begins its search with.
    let spacing = (region.area() / points.len().max(1) as f64).sqrt();
    let torus = period.map(|period| Torus { period, images: Vec::new() });
    let sites =
        Sites { points: points.to_vec(), domain: bounds, extent: bounds, spacing, cells: None, tiling: None, torus };
    let graph = link(&sites, Link::Delaunay);
    (sites, graph)
}

/// The area, in square millimetres, of every site's Voronoi cell clipped to a region. Of several
/// sites in one place the first has the cell.
pub(super) fn cell_areas(points: &[Point], region: &Region, period: Option<Period>) -> Vec<f64> {
    let region_bounds = region.bounds();
    if points.is_empty() || region.is_empty() {
        return vec![0.0; points.len()];
    }
    let (sites, graph) = triangulated(points, region, period);
    let cells = Cells::new(&sites, &graph, Length::ZERO, Length::ZERO);
    let mut pieces: Vec<Piece> = (0..points.len())
        .into_par_iter()
        .flat_map_iter(|site| {
            let mut ring = Vec::new();
            cells.outline(site, &mut ring, &mut Vec::new());
            let extent = ring_bounds(&ring);
            let moved = move |way| Piece { site, way, bounds: Rect::new(extent.min + way, extent.max + way) };
            let ways: Vec<_> = match period {
                _ if ring.is_empty() => Vec::new(),
                Some(period) => period.ways(&extent, &region_bounds).collect(),
                None => vec![Vec2::default()],
            };
            ways.into_iter().map(moved)
        })
        .collect();
    let rings = region.polygons().iter().flat_map(Polygon::rings).cloned().collect();
    let mut areas = vec![0.0; points.len()];
    for (site, area) in share_out(&mut pieces, rings, &|piece, ring| cut(&sites, &graph, piece, ring)) {
        areas[site] += area;
    }
    areas
}

/// A cell, or on a page that repeats one of its images that reach into the region.
struct Piece {
    site: usize,
    way: Vec2,
    bounds: Rect,
}

/// The signed area of what a cell holds of a ring: its cut with a convex cell has the area of what both hold even where
/// the ring is not convex, for what is left of it outside runs back and forth along the cell's border.
fn cut(sites: &Sites, graph: &Graph, piece: &Piece, ring: &[Point]) -> f64 {
    let mut ring: Vec<Point> = ring.iter().map(|&p| p + -piece.way).collect();
    let mut spare = Vec::new();
    let site = sites.points[piece.site];
    for half in graph.places(piece.site, &sites.points).filter_map(|other| HalfPlane::nearer(site, other)) {
        clip_convex(&mut ring, &half, &mut spare);
    }
    ring_area(&ring)
}

/// The area that every cell holds of rings. Where there are many corners and many cells, both are divided in two until
/// there are few: each half of the cells gets what its box holds of the rings, so that the time grows about as the
/// corners and the cells do. Cells are halved, so that the depth is at most the logarithm of their number.
fn share_out(
    pieces: &mut [Piece],
    rings: Vec<Vec<Point>>,
    cut: &(impl Fn(&Piece, &[Point]) -> f64 + Sync),
) -> Vec<(usize, f64)> {
    let corners: usize = rings.iter().map(Vec::len).sum();
    if corners <= FEW_CORNERS || pieces.len() <= FEW_CELLS {
        let area = |piece: &Piece| (piece.site, rings.iter().map(|ring| cut(piece, ring)).sum());
        return pieces.par_iter().map(area).collect();
    }
    let bounds = pieces.iter().fold(Rect::EMPTY, |all, p| all.including(p.bounds.min).including(p.bounds.max));
    let middle = pieces.len() / 2;
    let is_wide = bounds.width() > bounds.height();
    let place = |piece: &Piece| {
        let centre = piece.bounds.centre();
        if is_wide { centre.x } else { centre.y }
    };
    pieces.select_nth_unstable_by(middle, |a, b| place(a).total_cmp(&place(b)).then(a.site.cmp(&b.site)));
    let (near, far) = pieces.split_at_mut(middle);
    let (mut areas, others) = rayon::join(
        || {
            let rings = within(&rings, near);
            share_out(near, rings, cut)
        },
        || {
            let rings = within(&rings, far);
            share_out(far, rings, cut)
        },
    );
    areas.extend(others);
    areas
}

/// What the box round some cells holds of rings.
fn within(rings: &[Vec<Point>], pieces: &[Piece]) -> Vec<Vec<Point>> {
    let bounds = pieces.iter().fold(Rect::EMPTY, |all, p| all.including(p.bounds.min).including(p.bounds.max));
    let corners = bounds.corners();
    let sides = (0..4).filter_map(|i| HalfPlane::inside(corners[i], corners[(i + 1) % 4]));
    let sides: Vec<HalfPlane> = sides.collect();
    let mut spare = Vec::new();
    let clipped = rings.iter().map(|ring| {
        let mut ring = ring.clone();
        sides.iter().for_each(|side| clip_convex(&mut ring, side, &mut spare));
        ring
    });
    clipped.filter(|ring| !ring.is_empty()).collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::geom::{Angle, ring_contains};
    use crate::region::FillRule;

    /// A pattern of tiles on a region; what is not looked at is left empty.
    fn measured(region: Region, sites: Vec<Point>, outlines: Vec<Vec<Point>>, period: Option<Period>) -> Measured {
        let graph = Graph::new(sites.len(), &[], Vec::new());
        let angles = vec![Angle::ZERO; sites.len()];
        Measured { region, sites, outlines, period, angles, ..Measured::nothing(graph) }
    }

    fn square(width: f64, height: f64) -> Region {
        Region::rect(Rect::new(Point::default(), Point::new(width, height)))
    }

    /// A ring of corners at some distances round a point; not convex, as a rule.
    fn star(centre: Point, radii: &[f64]) -> Vec<Point> {
        let turn = 2.0 * std::f64::consts::PI / radii.len() as f64;
        (0..radii.len()).map(|i| centre + Angle::radians(i as f64 * turn).unit() * radii[i]).collect()
    }

    fn points(most: usize) -> impl Strategy<Value = Vec<Point>> {
        prop::collection::vec((0.0..6.0f64, 0.0..4.0f64), 2..most)
            .prop_map(|all| all.into_iter().map(|(x, y)| Point::new(x, y)).collect())
    }

    /// Regions with holes, as wide as 6 and as high as 4.
    fn regions() -> impl Strategy<Value = Region> {
        prop::collection::vec(0.3..2.0f64, 3..40).prop_map(|radii| {
            let hole = star(Point::new(3.0, 2.0), &radii.iter().map(|r| r * 0.4).collect::<Vec<_>>());
            let outer = star(Point::new(3.0, 2.0), &radii);
            Region::from_rings(vec![outer], FillRule::NonZero)
                .difference(&Region::from_rings(vec![hole], FillRule::NonZero))
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(48))]

        #[test]
        fn every_centre_is_asked_about_every_tile(
            region in regions(),
            tiles in prop::collection::vec(
                ((0.0..6.0f64, 0.0..4.0f64), prop::collection::vec(0.05..1.5f64, 3..9)), 1..12),
            is_torus: bool,
        ) {
            let outlines: Vec<Vec<Point>> =
                tiles.iter().map(|((x, y), radii)| star(Point::new(*x, *y), radii)).collect();
            let period = is_torus.then(|| Period::new(Length::mm(6.0), Length::mm(4.0)));
            let sites = tiles.iter().map(|((x, y), _)| Point::new(*x, *y)).collect();
            let found = measure(&measured(region.clone(), sites, outlines.clone(), period)).c_cov;
            let bounds = region.bounds();
            let ways = |i: i32| if is_torus { f64::from(i) } else { 0.0 };
            let (mut all, mut covered) = (0, 0);
            for row in 0..SIDE {
                for column in 0..SIDE {
                    let p = Point::new(
                        bounds.min.x + (column as f64 + 0.5) * (bounds.width() / SIDE as f64),
                        bounds.min.y + (row as f64 + 0.5) * (bounds.height() / SIDE as f64),
                    );
                    if region.contains(p) {
                        all += 1;
                        let images = (-1..=1).flat_map(|i| (-1..=1).map(move |j| (i, j)));
                        covered += u32::from(images.into_iter().any(|(i, j)| {
                            let way = Vec2::new(ways(i) * 6.0, ways(j) * 4.0);
                            outlines.iter().any(|ring| {
                                let ring: Vec<Point> = ring.iter().map(|&corner| corner + way).collect();
                                ring_contains(&ring, p)
                            })
                        }));
                    }
                }
            }
            prop_assert_eq!(found, (all > 0).then(|| f64::from(covered) / f64::from(all)));
        }

        #[test]
        fn cells_share_the_region(region in regions(), sites in points(60), is_torus: bool) {
            let period = is_torus.then(|| Period::new(Length::mm(6.0), Length::mm(4.0)));
            let areas = cell_areas(&sites, &region, period);
            prop_assert!((areas.iter().sum::<f64>() - region.area()).abs() < 1e-6);
            prop_assert!(areas.iter().all(|&area| area > -1e-9));
        }

        /// A point belongs to the cell of its nearest site.
        #[test]
        fn cells_hold_what_is_nearest(sites in points(12)) {
            let region = square(6.0, 4.0);
            let areas = cell_areas(&sites, &region, None);
            let mut counts = vec![0u32; sites.len()];
            for row in 0..60 {
                for column in 0..90 {
                    let p = Point::new((f64::from(column) + 0.5) / 15.0, (f64::from(row) + 0.5) / 15.0);
                    let nearest = (0..sites.len())
                        .min_by(|&a, &b| sites[a].distance_squared(p).total_cmp(&sites[b].distance_squared(p)));
                    counts[nearest.unwrap()] += 1;
                }
            }
            for (count, area) in counts.iter().zip(&areas) {
                // A cell's outline is no longer than the page's and runs through one of two samples a fifteenth apart.
                prop_assert!((f64::from(*count) / 225.0 - area).abs() < 20.0 / 15.0 / 2.0);
            }
        }
    }

    #[test]
    fn cells_divide_a_region_of_many_corners_as_they_do_its_pieces() {
        // More corners than are cut to every cell at once.
        let radii: Vec<f64> = (0..400).map(|i| 1.0 + 0.8 * libm::sin(f64::from(i) * 0.7)).collect();
        let region = Region::from_rings(vec![star(Point::new(3.0, 2.0), &radii)], FillRule::NonZero);
        let sites: Vec<Point> =
            (0..300).map(|i| Point::new(f64::from(i % 20) * 0.3 + 0.1, f64::from(i / 20) * 0.27 + 0.1)).collect();
        let areas = cell_areas(&sites, &region, None);
        assert!((areas.iter().sum::<f64>() - region.area()).abs() < 1e-6);
        for (site, area) in sites.iter().zip(areas) {
            let cell = Region::rect(Rect::new(*site, *site).grown(0.15).intersection(&Rect::new(
                Point::new(f64::NEG_INFINITY, site.y - 0.135),
                Point::new(f64::INFINITY, site.y + 0.135),
            )));
            // Cells at the border of the lattice go on beyond it.
            let is_inner = site.x > 0.2 && site.x < 5.7 && site.y > 0.2 && site.y < 3.8;
            assert!(!is_inner || (cell.intersection(&region).area() - area).abs() < 1e-6);
        }
    }

    #[test]
    fn a_lattice_is_even_and_covered() {
        let sites: Vec<Point> = (0..64).map(|i| Point::new(f64::from(i % 8) + 0.5, f64::from(i / 8) + 0.5)).collect();
        let outlines = sites.iter().map(|&p| Rect::new(p, p).grown(0.25).corners().to_vec()).collect();
        let space = measure(&measured(square(8.0, 8.0), sites, outlines, None));
        assert!(space.u_vor.unwrap() < 1e-12);
        // Of 25 centres along a side of a cell those within the tile: |x| < 0.25 with x in steps of 0.04.
        assert_eq!(space.c_cov, Some(169.0 / 625.0));
    }

    #[test]
    fn a_torus_has_no_rim() {
        let period = Period::new(Length::mm(8.0), Length::mm(8.0));
        // A lattice that is moved off the border's middle stays even.
        let sites: Vec<Point> = (0..64).map(|i| Point::new(f64::from(i % 8) + 0.1, f64::from(i / 8) + 0.9)).collect();
        let even = |period| measure(&measured(square(8.0, 8.0), sites.clone(), Vec::new(), period)).u_vor.unwrap();
        assert!(even(Some(period)) < 1e-12);
        assert!(even(None) > 0.1);
    }

    #[test]
    fn what_cannot_be_said_is_not_said() {
        let one = |region| measure(&measured(region, vec![Point::new(1.0, 1.0)], vec![Vec::new()], None));
        assert_eq!(one(square(2.0, 2.0)), Space { c_cov: Some(0.0), u_vor: None });
        assert_eq!(one(Region::empty()), Space { c_cov: None, u_vor: None });
        let none = measure(&measured(square(2.0, 2.0), Vec::new(), Vec::new(), None));
        assert_eq!(none, Space { c_cov: None, u_vor: None });
        let beyond = vec![Point::new(5.0, 5.0), Point::new(6.0, 6.0)];
        assert_eq!(measure(&measured(Region::empty(), beyond, Vec::new(), None)).u_vor, None);
    }

    #[test]
    fn sites_on_a_line_and_in_one_place_have_cells() {
        let line = |xs: &[f64]| {
            let sites = xs.iter().map(|&x| Point::new(x, 1.0)).collect();
            measure(&measured(square(3.0, 2.0), sites, Vec::new(), None)).u_vor.unwrap()
        };
        assert!(line(&[0.5, 1.5, 2.5]) < 1e-12);
        assert!(line(&[0.5, 1.0, 2.5]) > 0.1);
        // One has all, the other nothing.
        assert!((line(&[1.0, 1.0]) - std::f64::consts::SQRT_2).abs() < 1e-12);
    }
}
