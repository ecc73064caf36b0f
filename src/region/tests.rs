//! Laws of regions: what the index says agrees with counting over all segments, booleans agree with points.

#![allow(clippy::unwrap_used, clippy::expect_used)]

use proptest::prelude::*;

use super::*;

fn p(x: f64, y: f64) -> Point {
    Point::new(x, y)
}

fn square(x: f64, y: f64, side: f64) -> Region {
    Region::rect(Rect::new(p(x, y), p(x + side, y + side)))
}

/// Whether a point is inside, by looking at every segment; the point must not lie on the outline.
fn inside_by_counting(region: &Region, at: Point) -> bool {
    region.polygons().iter().flat_map(Polygon::rings).filter(|ring| crate::geom::ring_contains(ring, at)).count() % 2
        == 1
}

/// The distance to the outline, by looking at every segment.
fn distance_by_looking(region: &Region, at: Point) -> f64 {
    let mut best = f64::INFINITY;
    for ring in region.polygons().iter().flat_map(Polygon::rings) {
        for i in 0..ring.len() {
            let (a, b) = (ring[i], ring[(i + 1) % ring.len()]);
            let share = ((at - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
            best = best.min(at.distance(a.lerp(b, share)));
        }
    }
    best
}

/// Rings on whole millimetres, so that corners, edges and test points often coincide.
fn rings() -> impl Strategy<Value = Vec<Vec<Point>>> {
    let point = (0..12i32, 0..12i32).prop_map(|(x, y)| p(f64::from(x), f64::from(y)));
    prop::collection::vec(prop::collection::vec(point, 3..9), 1..5)
}

/// Anything from a few crossing rings to a wavy outline of many corners.
fn region() -> impl Strategy<Value = Region> {
    let rule = prop_oneof![Just(FillRule::NonZero), Just(FillRule::EvenOdd)];
    let crossing = (rings(), rule).prop_map(|(rings, rule)| Region::from_rings(rings, rule));
    let wavy = (3..400usize, 1..9u32, 0.0..0.9f64).prop_map(|(count, waves, depth)| {
        let corner = |i: usize| {
            let angle = Angle::radians(std::f64::consts::TAU * i as f64 / count as f64);
            p(6.0, 6.0) + angle.unit() * (5.0 * (1.0 - depth * (angle * f64::from(waves)).sin_cos().0.abs()))
        };
        Region::polygon(&(0..count).map(corner).collect::<Vec<_>>()).unwrap()
    });
    prop_oneof![crossing, wavy]
}

/// Points of the page, half of them on a lattice of half millimetres.
fn point() -> impl Strategy<Value = Point> {
    let lattice = (-2..28i32, -2..28i32).prop_map(|(x, y)| p(f64::from(x) / 2.0, f64::from(y) / 2.0));
    let anywhere = (-1.0..13.0, -1.0..13.0).prop_map(|(x, y)| p(x, y));
    prop_oneof![lattice, anywhere]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn points_agree_with_counting(region in region(), points in prop::collection::vec(point(), 40)) {
        for at in points {
            if distance_by_looking(&region, at) > 1e-9 {
                prop_assert_eq!(region.contains(at), inside_by_counting(&region, at), "{:?}", at);
            }
        }
    }

    #[test]
    fn distances_agree_with_looking(region in region(), at in point()) {
        let expected = distance_by_looking(&region, at);
        let found = region.signed_distance(at);
        prop_assert!(found.abs() == expected || (found.abs() - expected).abs() < 1e-9);
        prop_assert!(expected < 1e-9 || (found > 0.0) == inside_by_counting(&region, at));
    }

    #[test]
    fn pieces_of_lines_lie_inside_and_gaps_outside(region in region(), a in point(), b in point()) {
        prop_assume!(a != b);
        let mut pieces = Vec::new();
        region.clip_line(a, b, &mut pieces);
        let check = |from: f64, to: f64, expected: bool| {
            let at = a.lerp(b, (from + to) / 2.0);
            if from < to && distance_by_looking(&region, at) > 1e-7 {
                prop_assert_eq!(inside_by_counting(&region, at), expected, "{} to {}: {:?}", from, to, pieces);
            }
            Ok(())
        };
        let mut end = 0.0;
        for &(from, to) in &pieces {
            prop_assert!(end <= from && from < to && to <= 1.0);
            check(end, from, false)?;
            check(from, to, true)?;
            end = to;
        }
        check(end, 1.0, false)?;
    }

    #[test]
    fn a_line_and_its_reverse_are_cut_alike(region in region(), a in point(), b in point()) {
        let (mut there, mut back) = (Vec::new(), Vec::new());
        region.clip_line(a, b, &mut there);
        region.clip_line(b, a, &mut back);
        let length = |pieces: &[(f64, f64)]| pieces.iter().map(|(from, to)| to - from).sum::<f64>();
        prop_assert!((length(&there) - length(&back)).abs() < 1e-6, "{:?} {:?}", there, back);
    }

    #[test]
    fn a_box_is_touched_where_outline_comes_in(region in region(), a in point(), b in point()) {
        let area = Rect::EMPTY.including(a).including(b);
        let expected = region.polygons().iter().flat_map(Polygon::rings).any(|ring| {
            (0..ring.len()).any(|i| {
                let mut pieces = Vec::new();
                let (from, to) = (ring[i], ring[(i + 1) % ring.len()]);
                Region::rect(area).clip_line(from, to, &mut pieces);
                !pieces.is_empty()
            })
        });
        // A box without area, and one that is only touched from outside, are outlines' business alone.
        if expected {
            prop_assert!(region.touches_outline(area));
        }
        if !region.touches_outline(area) && !area.is_empty() {
            let inside = region.contains(area.centre());
            for corner in area.corners() {
                prop_assert_eq!(inside_by_counting(&region, corner), inside);
            }
        }
    }

    #[test]
    fn booleans_agree_with_points(a in region(), b in region(), points in prop::collection::vec(point(), 40)) {
        let (union, difference, intersection) = (a.union(&b), a.difference(&b), a.intersection(&b));
        prop_assert!((union.area() - (a.area() + b.area() - intersection.area())).abs() < 1e-4);
        prop_assert!((difference.area() - (a.area() - intersection.area())).abs() < 1e-4);
        for at in points {
            if distance_by_looking(&a, at).min(distance_by_looking(&b, at)) < 1e-6 {
                continue;
            }
            let (in_a, in_b) = (a.contains(at), b.contains(at));
            prop_assert_eq!(union.contains(at), in_a || in_b);
            prop_assert_eq!(difference.contains(at), in_a && !in_b);
            prop_assert_eq!(intersection.contains(at), in_a && in_b);
        }
    }

    #[test]
    fn an_inset_is_what_lies_deeper(region in region(), by in -2.0..2.0f64, points in prop::collection::vec(point(), 40)) {
        let inset = region.inset(Length::mm(by));
        for at in points {
            // Arcs stand for rounded corners within the tolerance.
            let depth = region.signed_distance(at);
            if (depth - by).abs() > FLATTENING.to_mm() * 1.1 {
                prop_assert_eq!(inset.contains(at), depth > by, "{:?} lies {} deep", at, depth);
            }
        }
    }

    #[test]
    fn rings_of_a_region_run_one_way_and_holes_the_other(region in region()) {
        for polygon in region.polygons() {
            prop_assert!(crate::geom::ring_area(&polygon.outer) > 0.0);
            for hole in &polygon.holes {
                prop_assert!(crate::geom::ring_area(hole) < 0.0);
            }
        }
        // What is resolved stays as it is, under either rule.
        let rings: Vec<Vec<Point>> = region.polygons().iter().flat_map(Polygon::rings).cloned().collect();
        for rule in [FillRule::NonZero, FillRule::EvenOdd] {
            let again = Region::from_rings(rings.clone(), rule);
            prop_assert_eq!(again.polygons(), region.polygons());
        }
    }
}

#[test]
fn circles_have_their_bounds_and_area() {
    let disc = Region::circle(p(50.0, 40.0), Length::mm(30.0));
    assert_eq!(disc.bounds(), Rect::new(p(20.0, 10.0), p(80.0, 70.0)));
    let area = std::f64::consts::PI * 900.0;
    assert!(disc.area() < area && disc.area() > area * 0.9995);
    assert!(Region::circle(p(0.0, 0.0), Length::ZERO).is_empty());
}

#[test]
fn neighbouring_boxes_share_no_point_and_leave_none_out() {
    let (left, right) = (square(0.0, 0.0, 1.0), square(1.0, 0.0, 1.0));
    for y in [0.0, 0.25, 0.5] {
        assert!(left.contains(p(0.0, y)) && !right.contains(p(0.0, y)));
        assert!(!left.contains(p(1.0, y)) && right.contains(p(1.0, y)));
        assert!(!right.contains(p(2.0, y)));
    }
    assert!(left.contains(p(0.0, 0.0)) && !left.contains(p(0.0, 1.0)));
    let mut pieces = Vec::new();
    left.clip_line(p(0.0, 0.0), p(1.0, 0.0), &mut pieces);
    left.clip_line(p(1.0, 0.0), p(0.0, 0.0), &mut pieces);
    assert_eq!(pieces, [(0.0, 1.0), (0.0, 1.0)]);
    pieces.clear();
    left.clip_line(p(0.0, 1.0), p(1.0, 1.0), &mut pieces);
    assert_eq!(pieces, []);
}

#[test]
fn slivers_are_dropped() {
    let thin = Region::rect(Rect::new(p(0.0, 0.0), p(1.0, 1e-7)));
    assert!(thin.union(&square(5.0, 5.0, 1.0)).polygons().len() == 1);
    // The same outline cut from itself leaves nothing, wherever it lies.
    let disc = Region::circle(p(12.3, 45.6), Length::mm(7.89)).rotated(Angle::degrees(12.3), p(1.0, 2.0));
    assert!(disc.difference(&disc).is_empty());
}

#[test]
fn coordinates_that_are_no_numbers_are_left_out() {
    assert!(Region::polygon(&[p(0.0, 0.0), p(f64::NAN, 1.0), p(1.0, 1.0)]).unwrap().is_empty());
    assert!(Region::rect(Rect::new(p(0.0, 0.0), p(f64::INFINITY, 1.0))).is_empty());
    let region = square(0.0, 0.0, 1.0);
    assert!(!region.contains(p(f64::NAN, 0.5)));
    let mut pieces = Vec::new();
    region.clip_line(p(f64::NAN, 0.0), p(1.0, 1.0), &mut pieces);
    region.clip_line(p(0.5, 0.5), p(0.5, 0.5), &mut pieces);
    assert!(pieces.is_empty());
    assert!(!region.touches_outline(Rect::EMPTY));
    assert!(!Region::empty().contains(p(0.0, 0.0)));
    assert_eq!(Region::empty().signed_distance(p(0.0, 0.0)), f64::NEG_INFINITY);
}

#[test]
fn maps_move_turn_and_scale() {
    let region = square(1.0, 1.0, 2.0);
    assert_eq!(region.translated(Vec2::new(3.0, -1.0)).bounds(), Rect::new(p(4.0, 0.0), p(6.0, 2.0)));
    let turned = region.rotated(Angle::RIGHT, p(1.0, 1.0));
    assert!((turned.bounds().min.x + 1.0).abs() < 1e-6 && (turned.bounds().max.y - 3.0).abs() < 1e-6);
    let mirrored = region.scaled([-2.0, 1.0], p(0.0, 0.0));
    assert_eq!(mirrored.bounds(), Rect::new(p(-6.0, 1.0), p(-2.0, 3.0)));
    assert!((mirrored.area() - 8.0).abs() < 1e-9);
    assert!(region.scaled([0.0, 1.0], p(0.0, 0.0)).is_empty());
}

#[test]
fn boxes_are_contained_in_the_middle() {
    let fit = Rect::new(p(10.0, 10.0), p(30.0, 20.0));
    assert_eq!(contained(1.0, 1.0, fit), Rect::new(p(15.0, 10.0), p(25.0, 20.0)));
    assert_eq!(contained(4.0, 1.0, fit), Rect::new(p(10.0, 12.5), p(30.0, 17.5)));
    assert_eq!(contained(0.0, 1.0, fit), fit);
}

#[test]
fn far_coordinates_are_moved_nearer_and_overflow_nothing() {
    let huge = Region::polygon(&[p(-1e300, -1e300), p(1e300, -1e300), p(1e300, 1e300), p(-1e300, 1e300)]).unwrap();
    assert_eq!(huge.bounds(), Rect::new(p(-1e8, -1e8), p(1e8, 1e8)));
    assert!(huge.contains(p(3.0, 4.0)) && huge.inset(Length::mm(-1e9)).contains(p(1.5e8, 0.0)));
    assert!(huge.inset(Length::mm(1e9)).is_empty());
    let disc = Region::circle(p(0.0, 0.0), Length::mm(1e7));
    assert!((disc.area() / (std::f64::consts::PI * 1e14) - 1.0).abs() < 1e-6);
    let mut pieces = Vec::new();
    disc.clip_line(p(-9e7, 0.0), p(9e7, 0.0), &mut pieces);
    assert_eq!(pieces.len(), 1);
    assert!((disc.difference(&square(0.0, 0.0, 1.0)).signed_distance(p(0.5, 0.25)) + 0.25).abs() < 1e-6);
}
