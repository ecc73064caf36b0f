#![allow(clippy::unwrap_used)]

use super::*;

/// A page of 40 x 40 mm with strokes of a width, as lists of corners.
fn lines(radius: f64, strokes: &[&[(f64, f64)]]) -> Lines {
    let centres = strokes
        .iter()
        .map(|stroke| Centre { points: stroke.iter().map(|&(x, y)| Point::new(x, y)).collect(), radius, beyond: 0.0 })
        .collect();
    Lines { page: Rect::new(Point::new(0.0, 0.0), Point::new(40.0, 40.0)), centres, dark: Region::empty() }
}

fn flood(lines: &Lines, at: (f64, f64), close: f64, border: Border) -> Result<Region, FloodError> {
    lines.flood(&FloodConfig { at: Point::new(at.0, at.1), close: Length::mm(close), border })
}

/// A square from (10, 10) to (30, 30) whose outline ends `gap` before it comes back.
fn square(gap: f64) -> Vec<(f64, f64)> {
    vec![(10.0, 10.0), (30.0, 10.0), (30.0, 30.0), (10.0, 30.0), (10.0, 10.0 + gap)]
}

const CLOSED: [(f64, f64); 5] = [(10.0, 10.0), (30.0, 10.0), (30.0, 30.0), (10.0, 30.0), (10.0, 10.0)];

fn is(area: f64, expected: f64) {
    assert!((area - expected).abs() < 0.01, "{area} is not {expected}");
}

#[test]
fn a_flood_ends_at_the_centres_of_lines() {
    let region = flood(&lines(0.25, &[&CLOSED]), (20.0, 20.0), 0.0, Border::Open).unwrap();
    assert_eq!(region.bounds(), Rect::new(Point::new(10.0, 10.0), Point::new(30.0, 30.0)));
    is(region.area(), 400.0);
    assert_eq!(region.polygons()[0].outer.len(), 4);
}

#[test]
fn gaps_are_bridged_up_to_close() {
    for (gap, close, holds) in
        [(0.4, 0.5, true), (0.5, 0.5, true), (0.51, 0.5, false), (3.0, 3.0, true), (0.4, 0.0, false)]
    {
        let found = flood(&lines(0.0, &[&square(gap)]), (20.0, 20.0), close, Border::Open);
        match found {
            Ok(region) => {
                assert!(holds, "{gap}");
                is(region.area(), 400.0);
            }
            Err(FloodError::Leak(Some(found))) => {
                assert!(!holds, "{gap}");
                is(found.width.to_mm(), gap);
                assert!(found.at.distance(Point::new(10.0, 10.0 + gap / 2.0)) < 1e-9);
            }
            Err(other) => panic!("{other}"),
        }
    }
}

#[test]
fn gaps_are_measured_from_ink_to_ink() {
    // The centres are 0.7 mm apart, but the strokes are 0.4 mm wide: 0.5 mm of white at the side of one, and 0.3 mm
    // between round ends.
    let mut drawing = lines(0.2, &[&square(0.7)]);
    assert!(matches!(flood(&drawing, (20.0, 20.0), 0.4, Border::Open), Err(FloodError::Leak(Some(_)))));
    drawing.centres[0].beyond = 0.2;
    assert!(flood(&drawing, (20.0, 20.0), 0.31, Border::Open).is_ok());
}

#[test]
fn the_widest_of_several_gaps_is_named() {
    let sides: [&[(f64, f64)]; 4] = [
        &[(10.0, 10.0), (29.3, 10.0)],
        &[(30.0, 10.0), (30.0, 29.1)],
        &[(30.0, 30.0), (10.6, 30.0)],
        &[(10.0, 30.0), (10.0, 10.0)],
    ];
    let drawing = lines(0.0, &sides);
    let Err(FloodError::Leak(Some(gap))) = flood(&drawing, (20.0, 20.0), 0.5, Border::Open) else { panic!("a leak") };
    is(gap.width.to_mm(), 0.9);
    assert!(gap.at.distance(Point::new(30.0, 29.55)) < 1e-9);
    is(flood(&drawing, (20.0, 20.0), 0.9, Border::Open).unwrap().area(), 400.0);
    // Nothing near holds a flood outside.
    assert_eq!(flood(&drawing, (3.0, 3.0), 1.0, Border::Open).unwrap_err(), FloodError::Leak(None));
}

#[test]
fn the_border_may_hold_a_flood() {
    let drawing = lines(0.0, &[&CLOSED]);
    let outside = flood(&drawing, (3.0, 3.0), 0.5, Border::Wall).unwrap();
    is(outside.area(), 1600.0 - 400.0);
    assert_eq!(outside.polygons()[0].holes.len(), 1);
    // A horizon that ends short of the border is bridged to it.
    let horizon = lines(0.0, &[&[(0.4, 20.0), (39.7, 20.0)]]);
    is(flood(&horizon, (3.0, 3.0), 0.5, Border::Wall).unwrap().area(), 800.0);
    is(flood(&horizon, (3.0, 3.0), 0.3, Border::Wall).unwrap().area(), 1600.0);
}

#[test]
fn islands_are_holes_and_rings_lie_in_each_other() {
    let ring = |d: f64| [(d, d), (40.0 - d, d), (40.0 - d, 40.0 - d), (d, 40.0 - d), (d, d)];
    let (outer, middle, inner) = (ring(5.0), ring(10.0), ring(15.0));
    let island = [(6.0, 6.0), (8.0, 6.0), (8.0, 8.0), (6.0, 8.0), (6.0, 6.0)];
    let drawing = lines(0.1, &[&outer, &middle, &inner, &island]);
    is(flood(&drawing, (20.0, 9.0), 0.3, Border::Open).unwrap().area(), 900.0 - 400.0 - 4.0);
    is(flood(&drawing, (20.0, 14.0), 0.3, Border::Open).unwrap().area(), 400.0 - 100.0);
    is(flood(&drawing, (20.0, 20.0), 0.3, Border::Open).unwrap().area(), 100.0);
}

#[test]
fn lines_that_end_inside_leave_no_slit() {
    let cross: [&[(f64, f64)]; 5] = [
        &CLOSED,
        &[(15.0, 12.0), (17.1, 26.3)],
        &[(12.0, 21.0), (22.0, 18.3)],
        // From a side inwards, and a kinked one on its own.
        &[(30.0, 20.0), (24.0, 21.7), (23.0, 25.0)],
        &[(20.0, 14.0), (25.0, 14.1), (21.0, 15.3)],
    ];
    let region = flood(&lines(0.1, &cross), (11.0, 11.0), 0.5, Border::Open).unwrap();
    is(region.area(), 400.0);
    let polygon = &region.polygons()[0];
    assert_eq!((polygon.holes.len(), polygon.outer.len()), (0, 4));
}

#[test]
fn lines_that_meet_part_the_page() {
    // Four T junctions: two lines that stop at a third, one that stops 0.2 mm short and one that runs over.
    let tees: [&[(f64, f64)]; 4] =
        [&CLOSED, &[(10.0, 20.0), (30.0, 20.0)], &[(20.0, 10.0), (20.0, 19.8)], &[(15.0, 9.7), (15.0, 20.3)]];
    let drawing = lines(0.0, &tees);
    is(flood(&drawing, (12.0, 12.0), 0.5, Border::Open).unwrap().area(), 50.0);
    is(flood(&drawing, (18.0, 12.0), 0.5, Border::Open).unwrap().area(), 50.0);
    is(flood(&drawing, (25.0, 12.0), 0.5, Border::Open).unwrap().area(), 100.0);
    // What runs over by less than `close` is not bridged to anything, so that no corner is cut off.
    is(flood(&drawing, (12.0, 25.0), 0.5, Border::Open).unwrap().area(), 200.0);
}

#[test]
fn dark_shapes_hold_a_flood_that_reaches_under_them() {
    // A thick bar across the square, and a thin sliver that ends 0.3 mm before the side.
    let mut drawing = lines(0.1, &[&CLOSED]);
    let shape = |corners: &[(f64, f64)]| {
        Region::polygon(&corners.iter().map(|&(x, y)| Point::new(x, y)).collect::<Vec<_>>()).unwrap()
    };
    let bar = shape(&[(10.0, 15.0), (30.0, 15.0), (30.0, 18.0), (10.0, 18.0)]);
    let sliver = shape(&[(9.9, 24.9), (20.0, 24.8), (29.7, 25.0), (20.0, 25.0)]);
    drawing.dark = bar.union(&sliver);
    is(flood(&drawing, (20.0, 12.0), 0.0, Border::Open).unwrap().area(), 20.0 * 5.25);
    // The sliver is thinner than the reach under it, so that it is covered; its tip leaks, or is bridged.
    let leaking = flood(&drawing, (20.0, 20.0), 0.1, Border::Open).unwrap();
    assert!((leaking.area() - 20.0 * 12.25).abs() < 0.1, "{}", leaking.area());
    let held = flood(&drawing, (20.0, 20.0), 0.3, Border::Open).unwrap();
    assert!((held.area() - 20.0 * 7.25).abs() < 1.5, "{}", held.area());
    assert_eq!(flood(&drawing, (20.0, 16.0), 0.1, Border::Open).unwrap_err(), FloodError::OnLine);
}

#[test]
fn a_flood_starts_in_the_white_of_the_page() {
    let drawing = lines(0.25, &[&CLOSED]);
    assert_eq!(flood(&drawing, (10.2, 20.0), 0.5, Border::Open).unwrap_err(), FloodError::OnLine);
    assert!(flood(&drawing, (10.3, 20.0), 0.5, Border::Open).is_ok());
    assert!(matches!(flood(&drawing, (41.0, 20.0), 0.5, Border::Open), Err(FloodError::OffPage(_))));
}

#[test]
fn too_many_lines_are_refused() {
    let comb: Vec<(f64, f64)> =
        (0..=MOST_PIECES + 1).map(|i| (i as f64 * 1e-4, if i % 2 == 0 { 5.0 } else { 6.0 })).collect();
    assert!(matches!(flood(&lines(0.0, &[&comb]), (1.0, 1.0), 0.5, Border::Wall), Err(FloodError::TooLarge { .. })));
    let mut tangle = Vec::new();
    for i in 0..3000 {
        let across = f64::from(i) * 0.01;
        tangle.extend([(across, 0.0), (across + 0.003, 30.0), (0.0, across), (30.0, across + 0.003)]);
    }
    assert_eq!(flood(&lines(0.0, &[&tangle]), (39.0, 39.0), 0.5, Border::Wall).unwrap_err(), FloodError::TooTangled);
}
