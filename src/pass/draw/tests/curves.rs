//! What holds for curved strokes: where they lie, how much ink they are, how strands meet.

use proptest::prelude::*;

use super::*;
use crate::drawing::{Curves, Strokes};
use crate::geom::bezier::{cubics, flatten};
use crate::geom::chain;
use crate::pass::draw::knockout::Stencil;
use crate::region::path;
use crate::scene::{MotifPath, Swing};

/// Ink may reach over an outline by this much: see `CUTTING`.
const OVER: f64 = 0.011;

fn swing(wavelength: f64, amplitude: f64) -> Swing {
    Swing { wavelength: Length::mm(wavelength), amplitude: Length::mm(amplitude) }
}

fn motif(data: &str, pitch: f64, spacing: f64) -> FillKind {
    let figure = MotifPath(path::chains(data, Length::mm(1.0)).unwrap().into());
    FillKind::Motif { hatch: hatch(pitch, 0.1), spacing: Length::mm(spacing), figure }
}

/// Every fill that draws curves.
fn curved() -> [FillKind; 5] {
    let (loops, spacing) = (Length::mm(0.7), Length::mm(0.4));
    [
        FillKind::Arcs(hatch(0.4, 0.1)),
        FillKind::Waves { hatch: hatch(0.4, 0.1), swing: swing(1.3, 0.3) },
        FillKind::Scribble { hatch: hatch(0.6, 0.1), loops, spacing },
        FillKind::Nawaami { hatch: hatch(0.4, 0.1), swing: swing(1.6, 0.2) },
        motif("M-.3 0C-.1-.4 .1 .4 .3 0M-.2 .2h.3v.1h-.3z", 0.7, 0.8),
    ]
}

fn shapes() -> impl Strategy<Value = Shape> {
    prop_oneof![
        Just(rect_shape(None, None)),
        Just(Shape::Hexagon { size: None, overlap: None, upright: false }),
        Just(voronoi(0.1, 0.0)),
        Just(voronoi(0.0, 0.4)),
    ]
}

fn curves(layers: &[Layer]) -> Curves {
    let mut all = Curves::default();
    layers.iter().flat_map(|layer| &layer.strokes).for_each(|strokes| all.append(&strokes.curves));
    all
}

fn curved_length(layers: &[Layer]) -> f64 {
    curves(layers).iter().map(chain::length).sum()
}

/// Both edges of a curved stroke, and its middle.
fn edges_of(curve: &[Point], half: f64) -> impl Iterator<Item = Point> {
    cubics(curve).flat_map(move |cubic| {
        (0..=8).map(move |i| f64::from(i) / 8.0).flat_map(move |t| {
            let side = cubic.tangent(t).unwrap().turned() * half;
            [cubic.at(t), cubic.at(t) + side, cubic.at(t) + -side]
        })
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn curves_end_where_they_should(shape in shapes(), which in 0usize..5, is_round in any::<bool>(), seed in any::<u64>()) {
        let canvas = canvas(9.0, 9.0);
        let mut paint = paint(&canvas);
        paint.seed = seed;
        paint.region = lens(&canvas);
        paint.tone.shape = shape;
        let mut kind = curved()[which].clone();
        if is_round && let FillKind::Arcs(hatch) | FillKind::Waves { hatch, .. } = &mut kind {
            hatch.cap = Cap::Round;
        }
        paint.tone.fill = vec![fill(kind)];
        paint.tone.asked = Asked::K(linear(Point::new(9.0, 9.0), 1.0, 4.0));
        let run = Run::new(&paint, &canvas);
        let drawn = layers(&paint, &canvas, &run);
        let strokes = &drawn[0].strokes[0];
        prop_assert!(!strokes.curves.is_empty());
        let mut next = 0;
        let mut start = 0;
        for &end in strokes.curves.bundle_ends() {
            let bundle: Vec<&[Point]> = (start..end).map(|i| strokes.curves.chain(i)).collect();
            start = end;
            let points = || bundle.iter().flat_map(|curve| flatten(curve, Length::mm(0.01)));
            let clearance = |tile: usize, p: Point| {
                if run.tiles.is_drawn(tile) { convex_clearance(run.tiles.outline(tile), p) } else { f64::NEG_INFINITY }
            };
            let is_on_top = |tile: usize| points().all(|p| {
                clearance(tile, p) > -NEAR && (tile + 1..run.tiles.len()).all(|later| clearance(later, p) < NEAR)
            });
            let tile = (next..run.tiles.len()).find(|&tile| is_on_top(tile));
            prop_assert!(tile.is_some(), "a bundle of no tile after {}", next);
            next = tile.unwrap() + 1;
            for curve in bundle {
                for p in edges_of(curve, 0.05) {
                    let distance = run.visible.signed_distance(p);
                    prop_assert!(distance > -OVER, "{curve:?} reaches {distance} over the region at {p:?}");
                }
                if strokes.cap == Cap::Round {
                    for p in [curve[0], curve[curve.len() - 1]] {
                        prop_assert!(run.visible.signed_distance(p) > 0.05 - OVER);
                    }
                }
            }
        }
    }

    #[test]
    fn tangents_of_strands_differ_as_angles_do(shape in shapes(), wavelength in 0.3..9.0f64, seed in any::<u64>()) {
        let canvas = canvas(9.0, 9.0);
        let mut paint = paint(&canvas);
        paint.seed = seed;
        paint.tone.shape = shape;
        paint.tone.fill = vec![fill(FillKind::Nawaami { hatch: hatch(0.3, 0.05), swing: swing(wavelength, 0.2) })];
        let run = Run::new(&paint, &canvas);
        let tangents = tangents(&paint, &run.stages());
        for [i, j] in run.graph.edges() {
            let (i, j) = (i as usize, j as usize);
            let expected = run.angles.0[i].rp1_distance(run.angles.0[j]).to_radians();
            // Whichever of its two ends a strand has at the edge.
            for (a, b) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let found = tangents[i][a].rp1_distance(tangents[j][b]).to_radians();
                prop_assert!((found - expected).abs() < 1e-7, "{} {}", found, expected);
            }
        }
    }
}

#[test]
fn strokes_end_in_the_tangents_that_are_told() {
    let canvas = canvas(20.0, 20.0);
    let mut paint = single(&canvas, Point::new(10.0, 10.0), 6.0);
    paint.tone.angle = AngleRule::Fixed(Angle::degrees(30.0));
    paint.tone.fill = vec![fill(FillKind::Nawaami { hatch: hatch(2.0, 0.1), swing: swing(3.7, 0.4) })];
    let run = Run::new(&paint, &canvas);
    let drawn = curves(&layers(&paint, &canvas, &run));
    let told = tangents(&paint, &run.stages())[0];
    assert_eq!(drawn.len(), 3);
    // The square's strand does not widen, so that all its strokes run alike.
    for stroke in drawn.iter() {
        let ways = [chain::at(stroke, 0.0).1, chain::at(stroke, chain::count(stroke) as f64).1];
        for way in ways {
            assert!(
                told.iter().all(|angle| angle.rp1_distance(Angle::of(way)).to_radians() < 1e-6),
                "{way:?} {told:?}"
            );
        }
    }
}

#[test]
fn ink_is_what_coverage_says() {
    let canvas = canvas(60.0, 60.0);
    let crosses = FillKind::Crosses { hatch: hatch(1.0, 0.1), spacing: Length::mm(0.9), size: Length::mm(0.6) };
    let dashes = FillKind::Dashes { hatch: hatch(0.5, 0.1), dash: Length::mm(0.7), gap: Length::mm(0.4) };
    let straight = [FillKind::Lines(hatch(0.5, 0.1)), dashes, crosses.clone()];
    for kind in curved().into_iter().chain(straight) {
        let mut paint = single(&canvas, Point::new(30.0, 30.0), 50.0);
        paint.tone.fill = vec![fill(kind.clone())];
        let run = Run::new(&paint, &canvas);
        let drawn = layers(&paint, &canvas, &run);
        let mut ink = (curved_length(&drawn) + length(&lines(&drawn))) * 0.1;
        if kind == crosses {
            ink -= (lines(&drawn).len() / 2) as f64 * 0.01;
        }
        let found = ink / 2500.0;
        // Uneven loops are a little longer than even ones.
        let slack = if matches!(kind, FillKind::Scribble { .. }) { 0.1 } else { 0.03 };
        assert!((found / kind.coverage() - 1.0).abs() < slack, "{kind:?}: {found} {}", kind.coverage());
    }
    let solid = FillKind::Solid.coverage();
    assert!((solid - 1.0).abs() < 1e-12 && (dots(2.0, 1.0, 0.5).coverage() - std::f64::consts::PI / 8.0).abs() < 1e-12);
}

/// What a knockout of one square leaves of a layer.
fn knocked_out(mut layer: Layer) -> Layer {
    let canvas = canvas(20.0, 20.0);
    let mut hole = single(&canvas, Point::new(10.0, 10.0), 8.0);
    hole.region = Region::rect(fixture::rect(0.0, 0.0, 12.0, 20.0));
    let run = Run::new(&hole, &canvas);
    Stencil::new(&hole, &run.visible, &run.sites, &run.tiles).cut(&mut layer);
    layer
}

/// From (2, 10) to (18, 10) in a bow through (10, 7).
fn bow() -> Vec<Point> {
    [(2.0, 10.0), (6.0, 6.0), (14.0, 6.0), (18.0, 10.0)].map(|(x, y)| Point::new(x, y)).to_vec()
}

#[test]
fn knockout_cuts_curves_and_what_runs_out() {
    let mut layer = Layer::new(Vec::new(), "bow".to_owned(), Colour::BLACK);
    let mut strokes = Strokes::new(Length::mm(0.2), Cap::Butt);
    strokes.curves.push(&bow());
    layer.strokes.push(strokes);
    layer.tapers.push(&bow(), &[1.0, 0.0]);
    let left = knocked_out(layer);
    // The square reaches from 6 to 14, its region only to 12.
    let (curves, tapers): (Vec<_>, Vec<_>) = (left.strokes[0].curves.iter().collect(), left.tapers.iter().collect());
    assert_eq!((curves.len(), tapers.len()), (2, 2));
    let end = |chain: &[Point]| *chain.last().unwrap();
    assert!((end(curves[0]).x - 6.0).abs() < 1e-9, "{:?}", curves[0]);
    assert!((curves[1][0].x - 12.0).abs() < 1e-6, "{:?}", curves[1]);
    assert_eq!((curves[0][0], end(curves[1])), (bow()[0], bow()[3]));
    let (spine, widths) = tapers[0];
    assert_eq!(spine, curves[0]);
    // x is 2 + 12 t + 12 t^2 - 8 t^3, which is 6 at the parameter below; the width falls evenly with the parameter.
    let t = 1.0 - widths[1];
    assert_eq!(widths[0], 1.0);
    assert!((2.0 + 12.0 * t + 12.0 * t * t - 8.0 * t * t * t - 6.0).abs() < 1e-9);
    assert_eq!(tapers[1].1[1], 0.0);
}

#[test]
fn a_closed_curve_stays_one_through_its_first_point() {
    let mut circle = Vec::new();
    let centre = Point::new(10.0, 4.0);
    crate::geom::course::circle(centre, Length::mm(3.0), Vec2::new(1.0, 0.0), Length::mm(0.01), &mut circle);
    let mut layer = Layer::new(Vec::new(), "circle".to_owned(), Colour::BLACK);
    let mut strokes = Strokes::new(Length::mm(0.2), Cap::Butt);
    strokes.curves.push(&circle);
    layer.strokes.push(strokes);
    let drawn = knocked_out(layer);
    let left: Vec<&[Point]> = drawn.strokes[0].curves.iter().collect();
    // Its lowest part lies in the square, which begins at y = 6 and ends at x = 12; its start, at the right, does not.
    assert_eq!(left.len(), 1);
    assert!((left[0][0].y - 6.0).abs() < 1e-9 && (left[0].last().unwrap().x - 12.0).abs() < 1e-6, "{left:?}");
    assert!(left[0].contains(&Point::new(13.0, 4.0)));
}

#[test]
fn too_fine_curves_are_refused() {
    let canvas = canvas(20.0, 20.0);
    let limits = Limits { strokes: 2_000_000, ..Limits::default() };
    let fine = [
        FillKind::Waves { hatch: hatch(1.0, 0.1), swing: swing(1e-9, 0.1) },
        FillKind::Waves { hatch: hatch(1.0, 0.1), swing: swing(1e-320, 1e-320) },
        FillKind::Nawaami { hatch: hatch(1.0, 0.1), swing: swing(1e-9, 1e9) },
        FillKind::Scribble { hatch: hatch(1.0, 0.1), loops: Length::mm(1e12), spacing: Length::mm(1e-12) },
        FillKind::Arcs(hatch(1e-9, 0.1)),
        FillKind::Crosses { hatch: hatch(1e-6, 0.1), spacing: Length::mm(1e-6), size: Length::mm(1.0) },
        motif("M0 0h1", 1e-5, 1e-5),
    ];
    for kind in fine {
        for is_ground in [false, true] {
            let mut paint = single(&canvas, Point::new(10.0, 10.0), 6.0);
            paint.tone.fill = vec![fill(kind.clone())];
            if is_ground {
                paint.tone.fill = vec![fill(FillKind::Solid)];
                paint.tone.ground = Some(Ground::Fill { fill: fill(kind.clone()), angle: Angle::degrees(45.0) });
            }
            let run = Run::new(&paint, &canvas);
            let drawn = draw(&paint, &canvas, &setting(), &run.stages(), &limits);
            assert_eq!(drawn.unwrap_err().code, Code::Limit, "{kind:?}");
        }
    }
}
