//! What holds for every paint: where strokes, dots and the ground lie.

use proptest::prelude::*;

use super::*;

/// A hatched paint: what it is placed and cut by.
pub(super) fn hatched() -> impl Strategy<Value = (Canvas, Paint)> {
    let shapes = prop_oneof![
        Just(rect_shape(None, None)),
        Just(rect_shape(Some(1.9), Some(1.3))),
        Just(Shape::Hexagon { size: None, overlap: None, upright: false }),
        Just(Shape::Rect { width: None, height: Some(Length::mm(1.4)), overlap: None, upright: true }),
        Just(star(1.2)),
        Just(voronoi(0.1, 0.0)),
        Just(voronoi(0.0, 0.4)),
    ];
    let caps = prop_oneof![Just(Cap::Butt), Just(Cap::Round)];
    let insets = prop_oneof![Just(0.5), Just(0.0), 0.0..2.0];
    (shapes, caps, insets, any::<u64>(), 0.0..4.0).prop_map(|(shape, cap, inset, seed, k)| {
        let canvas = canvas(9.0, 9.0);
        let mut paint = paint(&canvas);
        paint.seed = seed;
        paint.region = lens(&canvas);
        paint.tone.shape = shape;
        paint.tone.fill = vec![fill(FillKind::Lines(Hatch { cap, inset, ..hatch(0.31, 0.1) }))];
        paint.tone.asked = Asked::K(linear(Point::new(9.0, 9.0), k, 4.0 - k));
        (canvas, paint)
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn strokes_end_where_they_should((canvas, paint) in hatched(), is_dashed in any::<bool>()) {
        let mut paint = paint;
        if is_dashed {
            let hatch = *paint.tone.fill[0].kind.hatch().unwrap();
            paint.tone.fill[0].kind = FillKind::Dashes { hatch, dash: Length::mm(0.4), gap: Length::mm(0.2) };
        }
        let run = Run::new(&paint, &canvas);
        let drawn = layers(&paint, &canvas, &run);
        let strokes = &drawn[0].strokes[0];
        prop_assert_eq!(strokes.bundle_ends.last(), Some(&strokes.lines.len()));
        let mut next = 0;
        for bundle in strokes.bundles() {
            // Some tile, after that of the bundle before, holds all of it, and no later one comes over it.
            let points = || bundle.iter().copied().flat_map(samples);
            let clearance = |tile: usize, p: Point| {
                if run.tiles.is_drawn(tile) { run.tiles.figure(tile).clearance(p) } else { f64::NEG_INFINITY }
            };
            let is_on_top = |tile: usize| points().all(|p| {
                clearance(tile, p) > -NEAR && (tile + 1..run.tiles.len()).all(|later| clearance(later, p) < NEAR)
            });
            let tile = (next..run.tiles.len()).find(|&tile| is_on_top(tile)).unwrap();
            next = tile + 1;
            for &line in bundle {
                prop_assert!(!is_dashed || line[0].distance(line[1]) < 0.4 + NEAR);
                for p in edges(line, 0.1).into_iter().flat_map(samples) {
                    let distance = run.visible.signed_distance(p);
                    prop_assert!(distance > -NEAR, "{line:?} reaches {distance} over the region at {p:?}");
                }
                if strokes.cap == Cap::Round {
                    prop_assert!(line.iter().all(|&p| run.visible.signed_distance(p) > 0.05 - NEAR));
                }
                let along = Angle::of(line[1] - line[0]);
                let turn = (along - run.angles.0[tile]).to_radians() / std::f64::consts::FRAC_PI_4;
                prop_assert!((turn - turn.round()).abs() < 1e-5, "layers are turned by eighths: {}", turn);
            }
        }
    }

    #[test]
    fn what_is_drawn_is_what_is_not_hidden((canvas, paint) in hatched()) {
        let mut paint = paint;
        // Without the region and with one layer, so that the lines can be listed here.
        paint.region = Region::rect(canvas.bounds());
        paint.tone.edge = Edge::Centre;
        paint.tone.asked = Asked::K(Field::constant(1.0));
        let run = Run::new(&paint, &canvas);
        let drawn = length(&lines(&layers(&paint, &canvas, &run)));
        let inset = paint.tone.fill[0].kind.hatch().unwrap().inset;
        let mut expected = 0.0;
        const STEP: f64 = 0.01;
        for tile in (0..run.tiles.len()).filter(|&i| run.tiles.is_drawn(i)) {
            let (site, along) = (run.sites.points[tile], run.angles.0[tile].unit());
            let outline = run.tiles.outline(tile);
            let across: Vec<f64> = outline.iter().map(|&p| (p - site).dot(along.turned())).collect();
            let low = across.iter().copied().fold(f64::INFINITY, f64::min);
            let high = across.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let places: Vec<f64> = if paint.tone.shape.is_cell() {
                (-40..40).map(|i| f64::from(i) * 0.31).collect()
            } else {
                let steps = ((high - low) / 0.31 - 2.0 * inset).round().max(0.0);
                let step = (high - low) / (steps + 2.0 * inset);
                // A hair inwards, for whether the frame's own points lie inside is a matter of rounding.
                (0..=steps as i32).map(|i| (low + (inset + f64::from(i)) * step).clamp(low + 1e-7, high - 1e-7)).collect()
            };
            for (i, v) in places.into_iter().enumerate() {
                // Lines of equal tiles are looked at in other places each, or all would be off by the same.
                let phase = (0.618 * tile as f64 + 0.755 * i as f64).fract();
                for u in -400..400 {
                    let p = site + along * ((f64::from(u) + phase) * STEP) + along.turned() * v;
                    if run.tiles.figure(tile).clearance(p) > 0.0 && run.top(p) == Some(tile) {
                        expected += STEP;
                    }
                }
            }
        }
        prop_assert!((drawn / expected - 1.0).abs() < 5e-3, "{} of {}", drawn, expected);
    }

    #[test]
    fn dots_lie_free((canvas, paint) in hatched()) {
        let mut paint = paint;
        paint.tone.fill = vec![fill(dots(0.4, 0.5, 0.12))];
        let run = Run::new(&paint, &canvas);
        let drawn = layers(&paint, &canvas, &run);
        for bundle in drawn.iter().flat_map(|layer| &layer.dots).flat_map(|dots| dots.bundles()) {
            let tile = run.top(bundle[0]).unwrap();
            for &p in bundle {
                prop_assert!(run.tiles.figure(tile).clearance(p) > 0.12 - NEAR);
                prop_assert!(run.visible.signed_distance(p) > 0.12 - NEAR);
                for later in (tile + 1..run.tiles.len()).filter(|&i| run.tiles.is_drawn(i)) {
                    prop_assert!(run.tiles.figure(later).clearance(p) < NEAR - 0.12);
                }
            }
        }
    }

    #[test]
    fn the_ground_is_where_no_tile_is((canvas, paint) in hatched(), is_nearest in any::<bool>()) {
        let mut paint = paint;
        paint.tone.asked = Asked::K(Field::constant(1.0));
        paint.tone.shape = rect_shape(Some(1.2), None);
        // Four equal steps of 0.3.
        paint.tone.fill = vec![fill(FillKind::Lines(hatch(0.31, 0.1)))];
        let blue = Colour { b: 255, ..Colour::BLACK };
        let without = {
            let run = Run::new(&paint, &canvas);
            lines(&layers(&paint, &canvas, &run)).len()
        };
        let kind = FillKind::Lines(hatch(0.2, 0.05));
        paint.tone.ground = Some(if is_nearest {
            Ground::Nearest
        } else {
            Ground::Fill { fill: Fill { ink: Some(blue), ..fill(kind) }, angle: Angle::degrees(30.0) }
        });
        let run = Run::new(&paint, &canvas);
        let drawn = layers(&paint, &canvas, &run);
        // Ground comes first, in its own layer or before the tiles in theirs.
        let mut ground = lines(&drawn[..1]);
        let pen = drawn[0].strokes[0].pen.to_mm();
        if is_nearest {
            ground.truncate(ground.len() - without);
        }
        for &line in &ground {
            for p in samples(line) {
                let tiles = (0..run.tiles.len()).filter(|&i| run.tiles.is_drawn(i));
                prop_assert!(tiles.map(|i| run.tiles.figure(i).clearance(p)).all(|clearance| clearance < NEAR));
            }
            for p in edges(line, pen).into_iter().flat_map(samples) {
                prop_assert!(run.visible.signed_distance(p) > -NEAR);
            }
        }
        // Length times pitch is the area of the gaps, but for what stroke width and cells' rims take.
        let pitch = if is_nearest { 0.3 } else { 0.2 };
        let bounds = canvas.bounds();
        let cells = 180;
        let place = |i: i32| (f64::from(i % cells) + 0.5, f64::from(i / cells) + 0.5);
        let gaps = (0..cells * cells).map(place).map(|(x, y)| {
            bounds.min + Vec2::new(x * bounds.width(), y * bounds.height()) * (1.0 / f64::from(cells))
        });
        let gaps = gaps.filter(|&p| run.visible.contains(p) && run.top(p).is_none()).count();
        let area = gaps as f64 * bounds.width() * bounds.height() / f64::from(cells * cells);
        let hatched = length(&ground) * pitch;
        prop_assert!(hatched < area * 1.15 && hatched > area * 0.7, "{} of {}", hatched, area);
    }
}
