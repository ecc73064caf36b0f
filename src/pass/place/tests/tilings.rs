//! What holds for the cells of every tiling.

use proptest::prelude::*;

use super::*;
use crate::geom::clip::{HalfPlane, clip_convex};
use crate::geom::{Angle, Figure, ring_area};
use crate::scene::{Domain, GridSize};
use crate::stage::Tiling;

const GOLDEN: f64 = 1.618_033_988_749_895;

fn tilings(edge: f64) -> [Placement; 5] {
    let edge = Length::mm(edge);
    [
        Placement::Grid(GridSize::Spacing(edge)),
        Placement::Hex { spacing: edge },
        Placement::Triangles { edge },
        Placement::Penrose { edge },
        Placement::Pinwheel { edge },
    ]
}

/// The sites of a placement with their cells, over a box.
fn celled(place: Placement, domain: Rect, bleed: Option<f64>, seed: u64) -> Sites {
    let (mut paint, canvas) = plain(place);
    paint.region = Region::rect(domain);
    paint.seed = seed;
    paint.tone.domain = Domain::Region;
    paint.tone.bleed = bleed.map(Length::mm);
    paint.tone.link = Link::Edges;
    super::super::place(&paint, &canvas, &Limits::default()).unwrap()
}

fn cells(tiling: &Tiling) -> impl Iterator<Item = &[Point]> {
    (0..tiling.len()).map(|i| tiling.cell(i))
}

/// The area that a cell has in a box.
fn area_in(cell: &[Point], bounds: &Rect) -> f64 {
    let (mut ring, mut spare) = (cell.to_vec(), Vec::new());
    let corners = bounds.corners();
    for (i, &a) in corners.iter().enumerate() {
        clip_convex(&mut ring, &HalfPlane::inside(a, corners[(i + 1) % 4]).unwrap(), &mut spare);
    }
    ring_area(&ring)
}

fn sides(cell: &[Point]) -> impl Iterator<Item = (Point, Point)> + '_ {
    cell.iter().zip(cell.iter().cycle().skip(1)).map(|(&a, &b)| (a, b))
}

/// How much of their outlines two cells have in common.
fn shared_length(one: &[Point], other: &[Point]) -> f64 {
    let mut most = 0.0f64;
    for (a, b) in sides(one) {
        let along = (b - a) * (1.0 / a.distance(b));
        for (c, d) in sides(other) {
            if along.cross(c - a).abs() < 1e-7 && along.cross(d - a).abs() < 1e-7 {
                let (from, to) = ((c - a).dot(along), (d - a).dot(along));
                most = most.max(from.max(to).min(a.distance(b)) - from.min(to).max(0.0));
            }
        }
    }
    most
}

fn links(tiling: &Tiling) -> Vec<[u32; 2]> {
    let mut links: Vec<[u32; 2]> = tiling.edges.iter().map(|&[a, b]| [a.min(b), a.max(b)]).collect();
    links.sort_unstable();
    links
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn cells_cover_the_extent_without_gap_or_overlap(
        kind in 0..5usize, edge in 0.7..9.0f64, seed: u64, (x, y) in (-40.0..40.0f64, -40.0..40.0f64),
        (width, height) in (0.2..25.0f64, 0.2..25.0f64), bleed in prop::option::of(0.0..6.0f64),
    ) {
        let domain = rect(x, y, x + width, y + height);
        let sites = celled(tilings(edge)[kind].clone(), domain, bleed, seed);
        let tiling = sites.tiling.as_ref().unwrap();
        prop_assert_eq!(tiling.len(), sites.points.len());
        prop_assert_eq!(sites.extent, domain.grown(bleed.unwrap_or(sites.spacing)));
        let areas: Vec<f64> = cells(tiling).map(|cell| area_in(cell, &sites.extent)).collect();
        let extent = sites.extent.width() * sites.extent.height();
        // Were they to overlap, the sum would be too great; were there gaps, too small; were both, cells would
        // overlap their neighbours.
        prop_assert!((areas.iter().sum::<f64>() / extent - 1.0).abs() < 1e-9);
        prop_assert!(areas.iter().all(|&area| area > 0.0), "some cell lies outside");
        for (cell, &site) in cells(tiling).zip(&sites.points) {
            prop_assert!(ring_area(cell) > 0.0);
            prop_assert!(Figure::convex(cell).clearance(site) > 0.0);
        }
        for [a, b] in links(tiling) {
            let (one, other) = (Figure::convex(tiling.cell(a as usize)), Figure::convex(tiling.cell(b as usize)));
            prop_assert!(!one.overlaps(other));
        }
    }

    #[test]
    fn neighbours_are_the_cells_that_share_a_part_of_an_edge(kind in 0..5usize, edge in 1.0..4.0f64, seed: u64) {
        let sites = celled(tilings(edge)[kind].clone(), rect(3.0, 2.0, 3.0 + 6.0 * edge, 2.0 + 4.0 * edge), None, seed);
        let tiling = sites.tiling.as_ref().unwrap();
        let mut expected = Vec::new();
        for b in 0..tiling.len() {
            for a in 0..b {
                if shared_length(tiling.cell(a), tiling.cell(b)) > 1e-6 {
                    expected.push([a as u32, b as u32]);
                }
            }
        }
        expected.sort_unstable();
        prop_assert_eq!(links(tiling), expected);
    }

    #[test]
    fn a_wider_bleed_moves_no_cell(kind in 2..5usize, seed: u64) {
        let domain = rect(0.0, 0.0, 20.0, 15.0);
        let near = celled(tilings(2.5)[kind].clone(), domain, Some(0.0), seed);
        let far = celled(tilings(2.5)[kind].clone(), domain, Some(9.0), seed);
        let (near, far) = (near.tiling.unwrap(), far.tiling.unwrap());
        // In the same order, too.
        let mut rest = cells(&far);
        prop_assert!(cells(&near).all(|cell| rest.any(|other| other == cell)));
    }
}

#[test]
fn rhombs_are_thick_and_thin_in_the_golden_ratio() {
    let sites = celled(Placement::Penrose { edge: Length::mm(2.0) }, rect(0.0, 0.0, 150.0, 150.0), None, 7);
    let tiling = sites.tiling.unwrap();
    let (mut thick, mut thin) = (0.0, 0.0);
    for cell in cells(&tiling) {
        assert_eq!(cell.len(), 4);
        assert!(sides(cell).all(|(a, b)| (a.distance(b) - 2.0).abs() < 1e-6));
        for (a, b) in sides(cell) {
            let tenths = Angle::of(b - a).to_radians() / Angle::degrees(36.0).to_radians();
            assert!((tenths - tenths.round()).abs() < 1e-6);
        }
        let sine = ring_area(cell) / 4.0;
        if (sine - Angle::degrees(72.0).unit().y).abs() < 1e-6 {
            thick += 1.0;
        } else {
            assert!((sine - Angle::degrees(36.0).unit().y).abs() < 1e-6);
            thin += 1.0;
        }
    }
    assert!(thick + thin > 7000.0);
    assert!((thick / thin - GOLDEN).abs() < 0.02, "{thick} to {thin}");
    assert!((sites.spacing * sites.spacing - 4.0 * 0.8123).abs() < 1e-3);
}

#[test]
fn pinwheels_turn_in_many_directions_and_both_hands() {
    let sites = celled(Placement::Pinwheel { edge: Length::mm(2.0) }, rect(0.0, 0.0, 80.0, 80.0), None, 7);
    let tiling = sites.tiling.unwrap();
    let mut hands = [0, 0];
    let mut directions = Vec::new();
    for cell in cells(&tiling) {
        let mut lengths: Vec<(f64, usize)> = sides(cell).map(|(a, b)| a.distance(b)).zip(0..).collect();
        lengths.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (length, expected) in lengths.iter().zip([2.0, 4.0, 20f64.sqrt()]) {
            assert!((length.0 - expected).abs() < 1e-9);
        }
        // Whether the long leg follows the short one.
        hands[usize::from((lengths[0].1 + 1) % 3 == lengths[1].1)] += 1;
        let (a, b) = (cell[lengths[0].1], cell[(lengths[0].1 + 1) % 3]);
        directions.push((Angle::of(b - a).direction().to_radians() * 1e6).round() as i64);
    }
    assert!(hands.iter().all(|&hand| hand * 5 > tiling.len() * 2), "{hands:?}");
    directions.sort_unstable();
    directions.dedup();
    assert!(directions.len() >= 8, "{} directions", directions.len());
    // The edge is the side of a square as large as a cell.
    assert_eq!(sites.spacing, 2.0);
}

#[test]
fn seeds_choose_what_part_of_a_tiling_is_seen() {
    for kind in 3..5 {
        let sites = |seed| celled(tilings(3.0)[kind].clone(), rect(0.0, 0.0, 30.0, 20.0), None, seed).points;
        assert_eq!(sites(1), sites(1));
        assert_ne!(sites(1), sites(2));
    }
}

#[test]
fn counted_grids_have_just_their_cells() {
    let sites = celled(Placement::Grid(GridSize::Cells { columns: 7, rows: 3 }), rect(1.0, 2.0, 11.0, 17.0), None, 0);
    let tiling = sites.tiling.unwrap();
    assert_eq!((tiling.len(), tiling.edges.len()), (21, 6 * 3 + 7 * 2));
    assert!(cells(&tiling).all(|cell| (ring_area(cell) - 50.0 / 7.0).abs() < 1e-12));
}

#[test]
fn cells_are_made_only_where_they_are_asked_for() {
    for place in tilings(3.0) {
        let without = found(place.clone());
        assert!(without.tiling.is_none() && !without.points.is_empty());
    }
}

#[test]
fn too_many_cells_are_refused_before_they_are_made() {
    for place in tilings(1e-7) {
        let (paint, canvas) = plain(place);
        assert_eq!(super::super::place(&paint, &canvas, &Limits::default()).unwrap_err().code, Code::Limit);
    }
    // A long way for few cells.
    let limits = Limits { tiles: u64::MAX, ..Limits::default() };
    for kind in 3..5 {
        let (mut paint, canvas) = plain(tilings(1e-3)[kind].clone());
        paint.region = Region::rect(rect(0.0, 0.0, 1e5, 1e-3));
        paint.tone.domain = Domain::Region;
        assert_eq!(super::super::place(&paint, &canvas, &limits).unwrap_err().code, Code::Limit);
    }
}

fn relaxed(placement: Placement, rounds: u32) -> Placement {
    Placement::Relaxed { placement: Box::new(placement), rounds }
}

#[test]
fn relaxed_sites_lie_more_evenly() {
    let inner = Placement::Uniform { amount: Amount::Count { count: 150, density: None } };
    let before = found(inner.clone());
    assert_eq!(found(relaxed(inner.clone(), 0)).points, before.points);
    let after = found(relaxed(inner.clone(), 20));
    assert_eq!(after.points.len(), 150);
    assert!(after.points.iter().all(|&p| after.domain.contains(p)));
    assert!(least_distance(&after.points) > 0.5 * after.spacing);
    assert!(least_distance(&before.points) < 0.2 * before.spacing);
    // Each goes a short way only, so that they keep their order.
    let farthest = before.points.iter().zip(&after.points).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    assert!(farthest < 3.0 * before.spacing, "{farthest}");
}

#[test]
fn relaxed_sites_keep_their_number_and_bleed() {
    for inner in [poisson(2.0, None), Placement::Hex { spacing: Length::mm(2.0) }] {
        let (mut paint, canvas) = plain(inner.clone());
        paint.tone.bleed = None;
        let before = super::super::place(&paint, &canvas, &Limits::default()).unwrap();
        paint.tone.place = relaxed(inner, 3);
        let after = super::super::place(&paint, &canvas, &Limits::default()).unwrap();
        assert_eq!((after.points.len(), after.extent), (before.points.len(), before.extent));
        assert!(after.points.iter().all(|&p| is_within(&after.extent, p)));
    }
    let twice = Placement::Points(vec![Point::new(1.0, 1.0), Point::new(1.0, 1.0)]);
    let both = found(relaxed(twice, 1)).points;
    assert!(both[0].distance(Point::new(15.0, 10.0)) < 1e-9 && both[1] == Point::new(1.0, 1.0));
}

#[test]
fn endless_relaxation_is_refused() {
    let (paint, canvas) = plain(relaxed(poisson(1.0, None), 1000));
    let limits = Limits { tiles: 1000, ..Limits::default() };
    let diagnostic = super::super::place(&paint, &canvas, &limits).unwrap_err();
    assert_eq!(diagnostic.code, Code::Limit);
    assert!(diagnostic.message.contains("would move tiles"), "{}", diagnostic.message);
}
