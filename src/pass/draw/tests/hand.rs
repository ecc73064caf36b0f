//! What holds for strokes that a hand draws.

use proptest::prelude::*;

use super::*;
use crate::pass::draw::hand::{Bundle, WEIGHTS};
use crate::scene::Hand;

/// A hand that does all six.
const LOOSE: Hand = Hand {
    angle: Angle::radians(0.1),
    spacing: 0.2,
    pen: 0.3,
    taper: 0.4,
    overshoot: Length::mm(0.2),
    wobble: Length::mm(0.06),
};

/// One of the six at a time, by its number.
fn only(component: usize) -> Hand {
    with(1 << component)
}

/// Those of the six whose bits are set.
fn with(components: usize) -> Hand {
    let is_on = |component: usize| components & (1 << component) != 0;
    let share = |component, share| if is_on(component) { share } else { 0.0 };
    Hand {
        angle: if is_on(0) { LOOSE.angle } else { Angle::ZERO },
        spacing: share(1, LOOSE.spacing),
        pen: share(2, LOOSE.pen),
        taper: share(3, LOOSE.taper),
        overshoot: if is_on(4) { LOOSE.overshoot } else { Length::ZERO },
        wobble: if is_on(5) { LOOSE.wobble } else { Length::ZERO },
    }
}

/// A stroke or a piece of one: a chain of cubics and the width at its joints.
fn strokes(layers: &[Layer]) -> Vec<(Vec<Point>, Vec<f64>)> {
    let mut found = Vec::new();
    for layer in layers {
        for strokes in &layer.strokes {
            let pen = strokes.pen.to_mm();
            let third = |a: Point, b: Point| vec![a, a.lerp(b, 1.0 / 3.0), a.lerp(b, 2.0 / 3.0), b];
            found.extend(strokes.lines.iter().map(|&[a, b]| (third(a, b), vec![pen; 2])));
            found.extend(strokes.curves.iter().map(|chain| (chain.to_vec(), vec![pen; chain.len() / 3 + 1])));
        }
        found.extend(layer.tapers.iter().map(|(spine, widths)| (spine.to_vec(), widths.to_vec())));
    }
    found
}

/// Points along both edges of a stroke.
fn rims(spine: &[Point], widths: &[f64]) -> Vec<Point> {
    let mut rims = Vec::new();
    for (i, width) in widths.windows(2).enumerate() {
        let [a, b, c, d] = [0, 1, 2, 3].map(|j| spine[3 * i + j]);
        for step in 0..=24 {
            let t = f64::from(step) / 24.0;
            let (ab, bc, cd) = (a.lerp(b, t), b.lerp(c, t), c.lerp(d, t));
            let (from, to) = (ab.lerp(bc, t), bc.lerp(cd, t));
            let side = (to - from).turned() * (0.5 * (width[0] + (width[1] - width[0]) * t) / from.distance(to));
            let place = from.lerp(to, t);
            rims.extend([place + side, place - side]);
        }
    }
    rims
}

fn drawn(paint: &Paint, canvas: &Canvas) -> Vec<(Vec<Point>, Vec<f64>)> {
    strokes(&layers(paint, canvas, &Run::new(paint, canvas)))
}

/// One tile of ten lines at angle 0, so that strokes come as they are.
fn lone(canvas: &Canvas, hand: Hand) -> Paint {
    let mut paint = single(canvas, Point::new(6.0, 6.0), 5.0);
    paint.tone.fill = vec![fill(FillKind::Lines(hatch(0.5, 0.2)))];
    paint.tone.hand = hand;
    paint
}

#[test]
fn each_way_of_straying_has_a_stream_of_its_own() {
    let canvas = canvas(12.0, 12.0);
    let bundle = |components| Bundle::new(&lone(&canvas, with(components)), 3, 1);
    let frame = crate::geom::clip::Frame::new(Point::default(), Vec2::new(1.0, 0.0));
    for components in 0..64 {
        let bundle_with = bundle(components);
        for number in -4..12 {
            let draws = |bundle: &Bundle, component: usize| match component {
                0 => format!("{:?}", bundle.line(&bundle.turned(&frame), (number, 0.5), 0.0, 0.0).frame.along),
                1 => format!("{} {}", bundle.shift(number, 1.0), bundle.shift_along(number, 2, 1.0)),
                2 => format!("{} {}", bundle.weight(number), bundle.weight_of(number, 2)),
                3 => format!("{:?}", bundle.taper(number)),
                4 => format!("{:?}", bundle.overshoots(number)),
                _ => format!("{:?}", bundle.wander(number, 9.0)),
            };
            for component in (0..6).filter(|component| components & (1 << component) != 0) {
                let alone = bundle(1 << component);
                assert_eq!(draws(&bundle_with, component), draws(&alone, component), "{component} of {components:06b}");
            }
        }
    }
}

#[test]
fn each_way_of_straying_keeps_to_its_bounds() {
    let canvas = canvas(12.0, 12.0);
    let plain = drawn(&lone(&canvas, Hand::RULED), &canvas);
    assert_eq!(plain.len(), 10);
    let straight = |spine: &[Point]| (spine[0], spine[spine.len() - 1]);
    for (component, name) in ["angle", "spacing", "pen", "taper", "overshoot", "wobble"].iter().enumerate() {
        let strayed = drawn(&lone(&canvas, only(component)), &canvas);
        assert_eq!(strayed.len(), 10, "{name}");
        // Strokes come by their width; from the top down they are those of the plain drawing.
        let mut by_place = strayed.clone();
        by_place.sort_by(|(a, _), (b, _)| (a[0].y + a[a.len() - 1].y).total_cmp(&(b[0].y + b[b.len() - 1].y)));
        let mut farthest = [0.0f64; 6];
        for ((spine, widths), (plain, _)) in by_place.iter().zip(&plain) {
            let ((a, b), (from, to)) = (straight(spine), straight(plain));
            let (a, b) = if a.x < b.x { (a, b) } else { (b, a) };
            let (from, to) = if from.x < to.x { (from, to) } else { (to, from) };
            let turn = Angle::of(b - a).to_radians().abs();
            let shift = ((a.y + b.y - from.y - to.y) / 2.0).abs();
            let width = (widths.iter().copied().fold(0.0, f64::max) / 0.2 - 1.0).abs();
            let tip = widths.iter().copied().fold(f64::INFINITY, f64::min);
            let over = (from.x - a.x).max(b.x - to.x);
            let middle = rims(spine, &vec![0.0; widths.len()]);
            let wander = middle.iter().map(|p| (p.y - from.y).abs()).fold(0.0, f64::max);
            let taper = if tip < 0.1 { LOOSE.taper } else { 0.0 };
            for (farthest, value) in farthest.iter_mut().zip([turn, shift, width, taper, over, wander]) {
                *farthest = farthest.max(value);
            }
        }
        let bounds = [0.1 * 1.25, 0.2 * 0.5, 0.3, 0.4, 0.2, 0.06];
        assert!(farthest[component] > 0.1 * bounds[component], "{name}: {farthest:?}");
        assert!(farthest[component] <= bounds[component] + NEAR, "{name}: {farthest:?}");
        // What it does not touch stays: a turn shortens strokes and moves them, a wander moves them.
        let others = (0..5).filter(|&other| other != component && (component != 0 || other == 2 || other == 3));
        for other in others.filter(|&other| component != 5 || other > 1) {
            assert!(farthest[other] < NEAR, "{name} changes {other}: {farthest:?}");
        }
    }
}

#[test]
fn widths_are_few() {
    let canvas = canvas(40.0, 40.0);
    let mut paint = paint(&canvas);
    paint.tone.hand = only(2);
    // Where a region ends strokes end by their width.
    paint.tone.edge = Edge::Centre;
    let run = Run::new(&paint, &canvas);
    let layer = &layers(&paint, &canvas, &run)[0];
    assert_eq!(layer.strokes.len(), WEIGHTS);
    assert!(layer.strokes.iter().all(|strokes| strokes.bundle_ends.last() == Some(&strokes.lines.len())));
    // All of the plain drawing's strokes are there, and where they were.
    let key = |line: &[Point; 2]| {
        let ends = line.map(|p| (p.x.to_bits(), p.y.to_bits()));
        (ends[0].min(ends[1]), ends[0].max(ends[1]))
    };
    let keys = |paint: &Paint| {
        let mut keys: Vec<_> = lines(&layers(paint, &canvas, &run)).iter().map(key).collect();
        keys.sort_unstable();
        keys
    };
    let strayed = keys(&paint);
    paint.tone.hand = Hand::RULED;
    assert!(strayed == keys(&paint));
    paint.tone.fill = vec![fill(dots(0.4, 0.4, 0.1))];
    let dots = |paint: &Paint| layers(paint, &canvas, &run)[0].dots.len();
    assert_eq!(dots(&paint), 1);
    paint.tone.hand = only(2);
    assert_eq!(dots(&paint), WEIGHTS);
}

#[test]
fn a_stroke_draws_the_same_whichever_others_are_drawn() {
    let canvas = canvas(12.0, 12.0);
    let mut paint = lone(&canvas, LOOSE);
    let all = drawn(&paint, &canvas);
    paint.tone.blend = Blend::Partial;
    paint.tone.asked = Asked::K(Field::constant(0.5));
    let some = drawn(&paint, &canvas);
    assert_eq!(some.len(), 5);
    let turned = |(spine, widths): &(Vec<Point>, Vec<f64>)| {
        (spine.iter().rev().copied().collect::<Vec<_>>(), widths.iter().rev().copied().collect::<Vec<_>>())
    };
    assert!(some.iter().all(|stroke| all.contains(stroke) || all.contains(&turned(stroke))));
}

#[test]
fn what_hides_a_stroke_leaves_its_width() {
    let canvas = canvas(12.0, 12.0);
    let mut paint = lone(&canvas, Hand { taper: 0.5, ..Hand::RULED });
    let whole = drawn(&paint, &canvas);
    // A tile over the middle of the other.
    paint.tone.place = Placement::Points(vec![Point::new(6.0, 6.0), Point::new(6.0, 9.0)]);
    paint.tone.shape = rect_shape(Some(5.0), None);
    let cut = drawn(&paint, &canvas);
    let tip = |(_, widths): &&(Vec<Point>, Vec<f64>)| widths.contains(&0.0);
    assert_eq!(whole.iter().filter(tip).count(), 10);
    assert_eq!(cut.iter().filter(tip).count(), 16);
    paint.tone.place = Placement::Points(vec![Point::new(6.0, 6.0), Point::new(10.0, 6.0)]);
    let cut = drawn(&paint, &canvas);
    for (spine, widths) in cut.iter().filter(|(spine, _)| spine.iter().all(|p| p.x < 7.5 + NEAR)) {
        // Those that are cut end as wide as they are there in the whole.
        let (_, full) = whole.iter().find(|(whole, _)| (whole[0].y - spine[0].y).abs() < NEAR).unwrap();
        assert!(widths.iter().all(|width| *width <= full.iter().copied().fold(0.0, f64::max)));
        let is_right = spine[0].x.max(spine[spine.len() - 1].x) > 7.5 - NEAR;
        assert!(is_right, "{spine:?}");
    }
}

#[test]
fn strokes_run_on_into_the_ground_that_continues_them() {
    let canvas = canvas(12.0, 12.0);
    let mut paint = lone(&canvas, Hand { taper: 0.3, overshoot: Length::mm(0.2), ..Hand::RULED });
    paint.tone.ground = Some(Ground::Nearest);
    paint.tone.place = Placement::Points(vec![Point::new(6.0, 6.0)]);
    for (spine, widths) in drawn(&paint, &canvas) {
        let ends = [(spine[0], widths[0]), (spine[spine.len() - 1], widths[widths.len() - 1])];
        for (end, width) in ends {
            // No tip lies within the page: strokes run out where the cell ends, beyond it.
            assert!(width > 0.01, "{end:?}");
            let is_edge = [0.0, 3.5, 8.5, 12.0].iter().any(|x| (end.x - x).abs() < NEAR);
            assert!(is_edge, "{end:?}");
        }
    }
}

/// Curved fills, or none, for lines.
fn curved() -> impl Strategy<Value = Option<FillKind>> {
    let swing = crate::scene::Swing { wavelength: Length::mm(0.9), amplitude: Length::mm(0.1) };
    prop_oneof![
        Just(None),
        Just(Some(FillKind::Waves { hatch: hatch(0.31, 0.08), swing })),
        Just(Some(FillKind::Arcs(hatch(0.31, 0.08)))),
        Just(Some(FillKind::Nawaami { hatch: hatch(0.31, 0.08), swing })),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    #[test]
    fn no_ink_leaves_a_clipped_region(
        (canvas, paint) in super::laws::hatched(),
        components in 1usize..64,
        is_nearest in any::<bool>(),
        kind in curved(),
    ) {
        let mut paint = paint;
        paint.tone.hand = with(components);
        // Straight strokes end at the outline itself, curved ones within half of the step that they are looked at in.
        let tolerance = if kind.is_some() { 0.5 * crate::pass::draw::curves::CUTTING.to_mm() } else { 0.0 } + NEAR;
        if let Some(kind) = kind {
            paint.tone.fill = vec![fill(kind)];
        }
        paint.tone.ground = Some(if is_nearest {
            Ground::Nearest
        } else {
            Ground::Fill { fill: fill(FillKind::Lines(hatch(0.4, 0.05))), angle: Angle::degrees(45.0) }
        });
        let run = Run::new(&paint, &canvas);
        let drawn = layers(&paint, &canvas, &run);
        for (spine, widths) in strokes(&drawn) {
            for p in rims(&spine, &widths) {
                let distance = run.visible.signed_distance(p);
                prop_assert!(distance > -tolerance, "ink reaches {distance} over the region at {p:?}");
            }
        }
    }

    #[test]
    fn later_tiles_hide_what_lies_under_them((canvas, paint) in super::laws::hatched(), components in 1usize..64) {
        let mut paint = paint;
        // Without the ground, whose strokes come first.
        paint.tone.hand = with(components);
        paint.tone.stack = crate::scene::Stack::Cover;
        prop_assume!(!paint.tone.shape.is_cell());
        let run = Run::new(&paint, &canvas);
        let margin = paint.tone.hand.wobble.to_mm() * 1.2 + NEAR;
        let reach = 0.2 + margin;
        for (spine, _) in strokes(&layers(&paint, &canvas, &run)) {
            // Some tile holds the piece but for what it overshoots, and no later one comes over it.
            let clearance = |tile: usize, p: Point| run.tiles.figure(tile).clearance(p);
            let is_of = |&tile: &usize| {
                run.tiles.is_drawn(tile)
                    && spine.iter().all(|&p| clearance(tile, p) > -reach)
                    && (tile + 1..run.tiles.len())
                        .all(|later| !run.tiles.is_drawn(later) || spine.iter().all(|&p| clearance(later, p) < margin))
            };
            prop_assert!((0..run.tiles.len()).any(|tile| is_of(&tile)));
        }
    }

    #[test]
    fn dots_of_a_hand_lie_free((canvas, paint) in super::laws::hatched(), components in 1usize..8) {
        let mut paint = paint;
        paint.tone.hand = with(components);
        paint.tone.fill = vec![fill(dots(0.4, 0.5, 0.1))];
        let run = Run::new(&paint, &canvas);
        for layer in layers(&paint, &canvas, &run) {
            for dots in &layer.dots {
                let radius = dots.radius.to_mm();
                prop_assert!((radius / 0.1 - 1.0).abs() <= LOOSE.pen + NEAR);
                for &p in &dots.centres {
                    let tile = run.top(p).unwrap();
                    prop_assert!(run.tiles.figure(tile).clearance(p) > radius - NEAR);
                    prop_assert!(run.visible.signed_distance(p) > radius - NEAR);
                }
            }
        }
    }
}
