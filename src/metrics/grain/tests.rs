//! What each factor finds where it is known.

use crate::geom::{Angle, Length, Period, Point, Rect};
use crate::metrics::Measured;
use crate::pass::link;
use crate::random::Key;
use crate::region::Region;
use crate::scene::Link;
use crate::stage::{Graph, Sites};

use super::*;

/// A pattern of sites and nothing else, on a region as large as given.
fn pattern(points: Vec<Point>, width: f64, height: f64) -> Measured {
    let bounds = Rect::new(Point::default(), Point::new(width, height));
    let sites = Sites { points, domain: bounds, extent: bounds, spacing: 1.0, cells: None, tiling: None, torus: None };
    let graph = link::link(&sites, Link::Delaunay);
    Measured { region: Region::rect(bounds), sites: sites.points, ..Measured::nothing(graph) }
}

/// Points of a lattice in a box, its rows turned.
fn lattice(row: [f64; 2], next: [f64; 2], turn: Angle, size: f64) -> Vec<Point> {
    let (sin, cos) = turn.sin_cos();
    let steps = (-100..100).flat_map(|i| (-100..100).map(move |j| (f64::from(i) + 0.31, f64::from(j) + 0.27)));
    let points = steps.map(|(i, j)| (i * row[0] + j * next[0], i * row[1] + j * next[1]));
    let points = points.map(|(x, y)| Point::new(x * cos - y * sin, x * sin + y * cos));
    points.filter(|p| (0.0..size).contains(&p.x) && (0.0..size).contains(&p.y)).collect()
}

fn scattered(count: usize, size: f64) -> Vec<Point> {
    let mut stream = Key { seed: 1, name: "grain", purpose: "test" }.stream();
    (0..count).map(|_| Point::new(stream.unit() * size, stream.unit() * size)).collect()
}

#[test]
fn random_sites_lie_as_theory_says() {
    let measured = pattern(scattered(20_000, 100.0), 100.0, 100.0);
    let lie = lie::Lie::new(&measured).unwrap();
    assert!((lie.triangles - SCATTERED).abs() < 0.02, "{}", lie.triangles);
    // The variance of a cell's area is 0.280 (E. Gilbert, "Random subdivisions of space into crystals", 1962).
    assert!((lie.cells.unwrap() - 0.529).abs() < 0.02, "{:?}", lie.cells);
    assert!((lie.cell - 0.5).abs() < 0.01, "{}", lie.cell);
    assert!(waves::strongest(&measured.sites, lie.cell) < 0.01);
}

#[test]
fn lattices_have_one_wave_however_they_are_turned() {
    for (row, next) in
        [([1.0, 0.0], [0.0, 1.0]), ([1.0, 0.0], [0.5, 0.866]), ([2.0, 0.0], [1.0, 0.7]), ([1.0, 0.0], [0.3, 1.1])]
    {
        for degrees in [0.0, 11.0, 45.0, 77.7] {
            let points = lattice(row, next, Angle::degrees(degrees), 15.0);
            let area = row[0] * next[1] - row[1] * next[0];
            let measured = pattern(points, 15.0, 15.0);
            let lie = lie::Lie::new(&measured).unwrap();
            // Along the outline a few triangles are others.
            assert!((lie.cell / area - 1.0).abs() < 0.05, "{} {area}", lie.cell);
            assert!(lie.triangles < 0.2 && lie.cells.is_none_or(|cells| cells < 0.05), "{degrees}");
            let share = waves::strongest(&measured.sites, lie.cell);
            assert!(share > 0.75, "{row:?} {next:?} {degrees}: {share}");
        }
    }
}

#[test]
fn large_pages_are_looked_at_in_windows() {
    let points = lattice([1.0, 0.0], [0.5, 0.866], Angle::degrees(20.0), 60.0);
    assert!(points.len() > 4000);
    assert!(waves::strongest(&points, 0.866) > 0.9);
    // Sites in one place, or in one row, are no trouble.
    assert!(waves::strongest(&[Point::new(1.0, 1.0); 40], 1.0) <= 1.0);
    let row: Vec<Point> = (0..5000).map(|x| Point::new(f64::from(x), 3.0)).collect();
    assert!((0.0..=1.0).contains(&waves::strongest(&row, 1.0)));
    assert!((waves::strongest(&[], 1.0)).abs() < 1e-12);
}

#[test]
fn directions_are_counted_where_they_are_seen() {
    let points = lattice([1.0, 0.0], [0.0, 1.0], Angle::degrees(10.0), 40.0);
    let mut measured = pattern(points, 40.0, 40.0);
    let mut number = |direction: &dyn Fn(usize, Point) -> f64| {
        measured.angles =
            (0..).zip(&measured.sites).map(|(i, &p)| Angle::degrees(direction(i, p)).direction()).collect();
        directions::effective(&measured).unwrap()
    };
    let mut stream = Key { seed: 1, name: "grain", purpose: "test" }.stream();
    let random: Vec<f64> = (0..2000).map(|_| stream.unit()).collect();
    assert!((number(&|_, _| 7.0) - 1.0).abs() < 1e-12);
    // Chance makes a few alike: of so many directions each is seen 1 in so many times.
    assert!((number(&|i, _| (random[i] * 4.0).floor() * 45.0) - 4.0).abs() < 0.1);
    assert!((number(&|i, _| (random[i] * 9.0).floor() * 20.0) - 9.0).abs() < 0.4);
    // Even directions are alike within half a bin of 24.
    assert!((number(&|i, _| random[i] * 180.0) - 24.0).abs() < 2.0);
    // Two on the left, two others on the right: two wherever one looks.
    assert!(number(&|i, p| (random[i] * 2.0).floor() * 90.0 + if p.x < 20.0 { 0.0 } else { 45.0 }) < 2.1);
    // Whether bins of directions begin here or there.
    let before = number(&|i, _| random[i] * 20.0 + 170.0);
    assert!((number(&|i, _| random[i] * 20.0 + 43.21) - before).abs() < 1e-9);
    measured.graph = Graph::new(measured.sites.len(), &[], Vec::new());
    assert_eq!(directions::effective(&measured), None);
}

#[test]
fn what_is_not_known_is_not_said() {
    assert_eq!(measure(&Measured::nothing(Graph::default())), Grain::default());
    // A pattern from elsewhere has no region: its sites' box is taken.
    let mut measured = pattern(scattered(200, 10.0), 10.0, 10.0);
    measured.angles = vec![Angle::ZERO; 200];
    let whole = measure(&measured).grain_evenness.unwrap();
    measured.region = Region::empty();
    assert!((measure(&measured).grain_evenness.unwrap() - whole).abs() < 0.1);
}

#[test]
fn a_row_that_goes_round_a_page_is_measured() {
    for height in [0.0, 1e-12] {
        let sites: Vec<Point> =
            (0..12).map(|i| Point::new(2.0 + 4.0 * f64::from(i), 10.0 + height * f64::from(i % 2))).collect();
        let edges: Vec<[u32; 2]> = (0..12).map(|i| [i, (i + 1) % 12]).collect();
        let angles = (0..12).map(|i| Angle::degrees(f64::from(i * 77)).direction()).collect();
        let period = Some(Period::new(Length::mm(48.0), Length::mm(48.0)));
        let graph = Graph::new(12, &edges, Vec::new());
        let found = measure(&Measured { sites, angles, period, ..Measured::nothing(graph) });
        assert!(found.grain.is_none_or(|grain| (0.0..=1.0).contains(&grain)), "{found:?}");
    }
}

#[test]
fn islands_far_apart_have_no_more_waves_than_one() {
    let mut sites = scattered(31, 5.0);
    sites.extend(scattered(9, 5.0).into_iter().map(|p| Point::new(p.x + 9e7, p.y - 3e8)));
    let strongest = waves::strongest(&sites, 0.8);
    assert!((0.0..=1.0).contains(&strongest), "{strongest}");
}

#[test]
fn a_hub_has_as_many_directions_as_its_page() {
    let count = 60_000u32;
    let mut stream = Key { seed: 2, name: "grain", purpose: "test" }.stream();
    let angles: Vec<Angle> = (0..count).map(|_| Angle::degrees(stream.unit() * 180.0)).collect();
    let edges: Vec<[u32; 2]> = (1..count).map(|site| [0, site]).collect();
    let graph = Graph::new(count as usize, &edges, Vec::new());
    let found =
        directions::effective(&Measured { angles, sites: scattered(count as usize, 1.0), ..Measured::nothing(graph) });
    // Two directions of a turn without preference are alike by a 24th of it.
    assert!((found.unwrap() - 24.0).abs() < 0.5, "{found:?}");
}
