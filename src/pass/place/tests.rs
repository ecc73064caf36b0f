mod tilings;

use proptest::prelude::*;

use super::*;
use crate::diag::Code;
use crate::field::{Field, Node, Operator};
use crate::geom::Length;
use crate::pass::fixture::{canvas, paint, rect};
use crate::region::Region;
use crate::scene::AngleRule;

fn poisson(radius: f64, density: Option<Field>) -> Placement {
    Placement::Poisson { radius: Length::mm(radius), tries: 30, density }
}

/// A paint of a canvas of 30 x 20 mm.
fn plain(place: Placement) -> (Paint, Canvas) {
    let canvas = canvas(30.0, 20.0);
    (paint(&canvas, place, AngleRule::Random), canvas)
}

fn found(place: Placement) -> Sites {
    let (paint, canvas) = plain(place);
    super::place(&paint, &canvas, &Limits::default()).unwrap()
}

/// The field that is 1 to the left of `x` mm and 0 elsewhere.
fn left_of(x: f64) -> Field {
    let place = Field::new(Node::X(Length::mm(1.0)));
    Field::new(Node::Binary(Operator::Less, place, Field::constant(x)))
}

fn is_within(rect: &Rect, p: Point) -> bool {
    rect.grown(1e-6).contains(p)
}

/// The least distance of two of the points, by comparing all.
fn least_distance(points: &[Point]) -> f64 {
    let mut least = f64::INFINITY;
    for (i, a) in points.iter().enumerate() {
        for b in &points[..i] {
            least = least.min(a.distance(*b));
        }
    }
    least
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn poisson_keeps_its_distance_and_leaves_no_hole(
        seed: u64, radius in 0.8..9.0f64, width in 0.1..30.0f64, height in 0.1..30.0f64, bleed in 0.0..5.0f64,
    ) {
        let canvas = canvas(width, height);
        let mut paint = paint(&canvas, poisson(radius, None), AngleRule::Random);
        paint.seed = seed;
        paint.tone.bleed = Some(Length::mm(bleed));
        let sites = super::place(&paint, &canvas, &Limits::default()).unwrap();
        prop_assert!(least_distance(&sites.points) >= radius);
        prop_assert!(sites.points.iter().all(|&p| sites.extent.contains(p)));
        // A hole as wide as this would have taken a site.
        for row in 0..=20 {
            for column in 0..=20 {
                let way = Point::new(
                    sites.extent.min.x + sites.extent.width() * f64::from(column) / 20.0,
                    sites.extent.min.y + sites.extent.height() * f64::from(row) / 20.0,
                );
                prop_assert!(sites.points.iter().any(|p| p.distance(way) < 2.0 * radius));
            }
        }
    }

    #[test]
    fn a_density_sets_the_distance(seed: u64, slope in 0.01..0.05f64) {
        let density = Field::new(Node::Binary(
            Operator::Multiply,
            Field::new(Node::X(Length::mm(1.0))),
            Field::constant(slope),
        ));
        let (mut paint, canvas) = plain(poisson(0.6, Some(density.clone())));
        paint.seed = seed;
        let sites = super::place(&paint, &canvas, &Limits::default()).unwrap();
        for (i, a) in sites.points.iter().enumerate() {
            let d = density.at(*a);
            prop_assert!(d >= 1.0 / 64.0);
            let radius = 0.6 / d.min(1.0).sqrt();
            prop_assert!(sites.points[..i].iter().all(|b| a.distance_squared(*b) >= radius * radius));
        }
    }

    #[test]
    fn counted_points_are_as_many_as_asked_for(seed: u64, count in 1u32..300, bleed in 0.0..4.0f64, weighted: bool) {
        let density = weighted.then(|| left_of(11.0));
        let amount = Amount::Count { count, density };
        let (mut paint, canvas) = plain(Placement::Uniform { amount });
        paint.seed = seed;
        paint.tone.bleed = Some(Length::mm(bleed));
        let sites = super::place(&paint, &canvas, &Limits::default()).unwrap();
        let inside = sites.points.iter().filter(|&&p| sites.domain.contains(p)).count();
        prop_assert_eq!(inside, count as usize);
        prop_assert!(sites.points[..inside].iter().all(|&p| sites.domain.contains(p)));
        prop_assert!(sites.points.iter().all(|&p| sites.extent.contains(p)));
        prop_assert!(!weighted || sites.points.iter().all(|p| p.x < 11.0));
    }

    #[test]
    fn lattices_lie_in_their_extent_and_fill_it(
        width in 0.5..40.0f64, height in 0.5..40.0f64, spacing in 0.7..6.0f64, hexagonal: bool,
    ) {
        let spacing = Length::mm(spacing);
        let place = if hexagonal { Placement::Hex { spacing } } else { Placement::Grid(GridSize::Spacing(spacing)) };
        let canvas = canvas(width, height);
        let mut paint = paint(&canvas, place, AngleRule::Random);
        paint.tone.bleed = None;
        let sites = super::place(&paint, &canvas, &Limits::default()).unwrap();
        prop_assert!(sites.points.iter().all(|&p| is_within(&sites.extent, p)));
        prop_assert!(least_distance(&sites.points) > spacing.to_mm() * (1.0 - 1e-9));
        // No corner of the domain is farther from a site than the corner of a cell is.
        let reach = spacing.to_mm() * (0.5f64.sqrt() + 1e-9);
        for corner in sites.domain.corners() {
            prop_assert!(sites.points.iter().any(|p| p.distance(corner) <= reach));
        }
        // A lattice is centred: turned by half a turn it is the same.
        let centre = sites.domain.centre();
        let turned_has = |p: Point| {
            let opposite = centre + (centre - p);
            sites.points.iter().any(|q| q.distance(opposite) < 1e-9 * spacing.to_mm())
        };
        prop_assert!(hexagonal || sites.points.iter().all(|&p| turned_has(p)));
    }
}

#[test]
fn islands_are_reached() {
    let gap = Field::new(Node::Binary(
        Operator::Or,
        left_of(5.0),
        Field::new(Node::Binary(Operator::Less, Field::constant(20.0), Field::new(Node::X(Length::mm(1.0))))),
    ));
    let sites = found(poisson(0.8, Some(gap)));
    let left = sites.points.iter().filter(|p| p.x < 5.0).count();
    let right = sites.points.iter().filter(|p| p.x > 20.0).count();
    assert_eq!(left + right, sites.points.len());
    assert!(left > 80 && right > 160, "{left} and {right}");
}

#[test]
fn a_quarter_of_the_density_takes_a_quarter_of_the_sites() {
    let full = found(poisson(0.5, Some(Field::constant(1.0)))).points.len() as f64;
    let quarter = found(poisson(0.5, Some(Field::constant(0.25)))).points.len() as f64;
    assert!((quarter / full - 0.25).abs() < 0.03, "{quarter} of {full}");
    assert_eq!(found(poisson(0.5, Some(Field::constant(0.01)))).points, []);
}

#[test]
fn uniform_points_can_be_as_many_as_poisson_finds() {
    for seed in 0..10 {
        let (mut disk, canvas) = plain(poisson(1.3, None));
        disk.seed = seed;
        let mut uniform = disk.clone();
        uniform.tone.place = Placement::Uniform { amount: Amount::AsMany(Box::new(disk.tone.place.clone())) };
        let disk = super::place(&disk, &canvas, &Limits::default()).unwrap();
        let uniform = super::place(&uniform, &canvas, &Limits::default()).unwrap();
        assert_eq!(disk.points.len(), uniform.points.len());
        assert_ne!(disk.points, uniform.points);
        assert_eq!(uniform.extent, uniform.domain);
    }
}

#[test]
fn a_density_counts_by_the_canvas_unit() {
    let amount = |density, unit| Amount::Density { density, unit: Length::mm(unit) };
    let even = found(Placement::Uniform { amount: amount(Field::constant(2.0), 1.0) });
    assert_eq!(even.points.len(), 1200);
    assert!((even.spacing - 0.5f64.sqrt()).abs() < 1e-12);
    assert_eq!(found(Placement::Uniform { amount: amount(Field::constant(2.0), 10.0) }).points.len(), 12);
    let left = found(Placement::Uniform { amount: amount(left_of(15.0), 1.0) });
    assert_eq!(left.points.len(), 300);
    assert!(left.points.iter().all(|p| p.x < 15.0));
    assert_eq!(found(Placement::Uniform { amount: amount(Field::constant(0.0), 1.0) }).points, []);
}

#[test]
fn the_report_s_grid_stands_where_it_stood() {
    let canvas = canvas(6.0, 6.0);
    let grid = Placement::Grid(GridSize::Cells { columns: 8, rows: 8 });
    let sites = super::place(&paint(&canvas, grid, AngleRule::Checkerboard), &canvas, &Limits::default()).unwrap();
    let cells = sites.cells.unwrap();
    assert_eq!(sites.points.len(), 64);
    assert_eq!(sites.spacing, 0.75);
    for (i, (p, cell)) in sites.points.iter().zip(cells).enumerate() {
        let (column, row) = (i % 8, i / 8);
        assert_eq!(cell, [column as i32, row as i32]);
        assert_eq!(*p, Point::new(0.375 + 0.75 * column as f64, 0.375 + 0.75 * row as f64));
    }
}

#[test]
fn a_bleed_continues_a_grid() {
    let (mut paint, canvas) = plain(Placement::Grid(GridSize::Cells { columns: 3, rows: 2 }));
    paint.tone.bleed = Some(Length::mm(12.0));
    let sites = super::place(&paint, &canvas, &Limits::default()).unwrap();
    let cells = sites.cells.unwrap();
    assert_eq!((cells[0], cells[cells.len() - 1]), ([-1, -1], [3, 2]));
    assert_eq!((sites.points[0], cells.len()), (Point::new(-5.0, -5.0), 20));
    assert_eq!(sites.spacing, 10.0);
}

#[test]
fn rows_of_a_hexagonal_lattice_are_straight() {
    let sites = found(Placement::Hex { spacing: Length::mm(1.7) });
    let mut rows: Vec<f64> = sites.points.iter().map(|p| p.y).collect();
    rows.dedup();
    assert_eq!(rows.len(), 14);
    let mut columns: Vec<f64> = sites.points.iter().map(|p| p.x).collect();
    columns.sort_by(f64::total_cmp);
    columns.dedup();
    assert_eq!(columns.len(), 36);
}

#[test]
fn points_are_left_as_they_are() {
    let given = vec![Point::new(-50.0, 3.0), Point::new(4.0, 5.0), Point::new(4.0, 5.0)];
    let sites = found(Placement::Points(given.clone()));
    assert_eq!(sites.points, given);
    assert!((sites.spacing - 200f64.sqrt()).abs() < 1e-12);
}

#[test]
fn counts_and_region_domains_take_the_region_s_box() {
    let area = rect(2.0, 3.0, 8.0, 7.0);
    let cells = Placement::Grid(GridSize::Cells { columns: 3, rows: 2 });
    for (place, domain) in [(poisson(1.0, None), Domain::Region), (cells, Domain::Canvas)] {
        let (mut paint, canvas) = plain(place);
        paint.region = Region::rect(area);
        paint.tone.domain = domain;
        let sites = super::place(&paint, &canvas, &Limits::default()).unwrap();
        assert_eq!(sites.domain, area);
        assert!(sites.points.iter().all(|&p| area.contains(p)));
    }
}

#[test]
fn nothing_is_placed_in_nothing() {
    let places = [
        poisson(1.0, None),
        Placement::Uniform { amount: Amount::Count { count: 5, density: None } },
        Placement::Uniform { amount: Amount::AsMany(Box::new(poisson(1.0, None))) },
        Placement::Grid(GridSize::Cells { columns: 2, rows: 2 }),
        Placement::Hex { spacing: Length::mm(1.0) },
        Placement::Points(Vec::new()),
    ];
    for place in places {
        let (mut paint, canvas) = plain(place);
        paint.region = Region::empty();
        paint.tone.domain = Domain::Region;
        let sites = super::place(&paint, &canvas, &Limits::default()).unwrap();
        assert_eq!(sites.points, []);
        assert!(sites.spacing > 0.0 && sites.extent.width().is_finite());
    }
}

#[test]
fn too_many_tiles_are_refused_before_they_are_placed() {
    let tiny = Length::mm(1e-3);
    let cases = [
        (poisson(1e-3, None), "`poisson(radius: 0.001mm)` would place about 390,000,000 tiles; the limit is 2,000,000"),
        (
            Placement::Grid(GridSize::Spacing(tiny)),
            "`grid(spacing: 0.001mm)` would place about 600,000,000 tiles; the limit is 2,000,000",
        ),
        (
            Placement::Hex { spacing: tiny },
            "`hex(spacing: 0.001mm)` would place about 693,000,000 tiles; the limit is 2,000,000",
        ),
        (
            Placement::Grid(GridSize::Cells { columns: u32::MAX, rows: u32::MAX }),
            "`grid(columns: 4294967295, rows: 4294967295)` would place more than 1,000,000,000,000,000 tiles; the \
             limit is 2,000,000",
        ),
        (
            Placement::Uniform { amount: Amount::Count { count: 3_000_000, density: None } },
            "`uniform(count: 3000000)` would place about 3,000,000 tiles; the limit is 2,000,000",
        ),
        (
            Placement::Uniform { amount: Amount::AsMany(Box::new(poisson(1e-200, None))) },
            "`poisson(radius: 1e-200mm)` would place more than 1,000,000,000,000,000 tiles; the limit is 2,000,000",
        ),
    ];
    for (place, message) in cases {
        let (paint, canvas) = plain(place);
        let diagnostic = super::place(&paint, &canvas, &Limits::default()).unwrap_err();
        assert_eq!((diagnostic.code, diagnostic.span), (Code::Limit, Some(paint.tone.place_span)));
        assert_eq!(diagnostic.message, message);
        assert!(diagnostic.hint.unwrap().starts_with("`--limit tiles=N` lifts it, or use "));
    }
}

#[test]
fn the_limit_holds_for_what_is_really_placed() {
    // The estimate samples the density and misses the narrow stripe that holds all sites.
    let refused = |radius| {
        let (paint, canvas) = plain(poisson(radius, Some(left_of(0.23))));
        super::place(&paint, &canvas, &Limits { tiles: 80, ..Limits::default() }).unwrap_err().message
    };
    assert_eq!(refused(0.2), "`poisson(radius: 0.2mm)` places more than 80 tiles, which is the limit");
    assert_eq!(
        refused(0.1),
        "`poisson(radius: 0.1mm)` would search a grid of about 125,000 cells, too many for a limit of 80 tiles"
    );
}

#[test]
fn a_paint_s_name_and_seed_are_its_stream() {
    let (paint, canvas) = plain(poisson(2.0, None));
    let points = |paint: &Paint| super::place(paint, &canvas, &Limits::default()).unwrap().points;
    let first = points(&paint);
    assert_eq!(first, points(&paint.clone()));
    assert_ne!(first, points(&Paint { seed: 1, ..paint.clone() }));
    assert_ne!(first, points(&Paint { name: "other".to_owned(), ..paint.clone() }));
    // Moving the region moves no tile.
    assert_eq!(first, points(&Paint { region: Region::rect(rect(1.0, 1.0, 2.0, 2.0)), ..paint.clone() }));
}
