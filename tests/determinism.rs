//! The same scene gives the same bytes, and a change leaves alone what it does not concern.

use kakeami::drawing::{Drawing, Layer};
use proptest::prelude::*;

use crate::support::{compile_case, drawing, each, scenes, svg};

/// What `make` gives on pools of one and of four threads.
fn on_threads<T: Send>(make: impl Fn() -> T + Sync) -> [T; 2] {
    [1, 4].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be had");
        pool.install(&make)
    })
}

#[test]
fn threads_make_no_difference() {
    each(&scenes("tests/cases/build"), |path| {
        let [one, four] = on_threads(|| {
            let drawing = compile_case(path).drawing.expect("the case compiles");
            let mut png = Vec::new();
            kakeami::back::png::write(&drawing, None, &mut png).expect("memory takes all that is written");
            (svg(&drawing), png)
        });
        assert!(one == four, "{}: threads make a difference", path.display());
    });
}

const HEAD: &str = "edition 1
canvas { size: (30mm, 30mm) }
seed 5
";
const TONES: &str = "tone a { place: poisson(radius: 3mm) fill: lines(pitch: 1mm) k: 2 }
tone b { place: uniform(count: 20) shape: voronoi() angle: random() fill: dots(pitch: 1mm, radius: 0.2mm) }
";
const DISC: &str = "region disc = circle(center: (15mm, 15mm), radius: 9mm)\n";

/// The marks of a paint.
fn paint<'d>(drawing: &'d Drawing, name: &str) -> &'d Layer {
    drawing.layers.iter().find(|layer| layer.name == name).expect("the paint is drawn")
}

/// Two scenes draw these paints alike.
#[track_caller]
fn alike(first: &str, second: &str, names: &[&str]) {
    let (first, second) = (drawing(first), drawing(second));
    for name in names {
        let (first, second) = (paint(&first, name), paint(&second, name));
        assert!(first.marks() > 0, "{name} draws nothing");
        assert_eq!(first.areas, second.areas, "{name}");
        assert_eq!(format!("{:?}", first.strokes), format!("{:?}", second.strokes), "{name}");
        assert_eq!(format!("{:?}", first.dots), format!("{:?}", second.dots), "{name}");
    }
}

#[test]
fn a_hand_that_strays_by_nothing_is_none() {
    let tone = |hand: &str| {
        let text = format!(
            "{HEAD}tone t {{ place: poisson(radius: 3mm) fill: [lines(pitch: 0.7mm), dashes(pitch: 1mm, dash: 1mm),
             dots(pitch: 1mm)] k: 3 ground: nearest {hand} }}\n{DISC}paint disc with t"
        );
        svg(&drawing(&text))
    };
    let plain = tone("");
    assert_eq!(plain, tone("hand: hand(angle: 0deg)"));
    let zeros = "hand: hand(angle: 0deg, spacing: 0%, pen: 0%, taper: 0%, overshoot: 0mm, wobble: 0mm)";
    assert_eq!(plain, tone(zeros));
    assert_ne!(plain, tone("hand: hand()"));
}

fn base() -> String {
    format!("{HEAD}{TONES}{DISC}paint canvas with a as \"sky\"\npaint disc with b as \"moon\"\n")
}

#[test]
fn another_paint_leaves_the_others_alone() {
    let more = format!(
        "{HEAD}{TONES}{DISC}paint disc with a as \"new\"\npaint canvas with a as \"sky\"\n\
         paint disc with b as \"newer\"\npaint disc with b as \"moon\"\n"
    );
    alike(&base(), &more, &["sky", "moon"]);
}

#[test]
fn declarations_may_stand_in_any_order() {
    let turned = format!("{HEAD}{DISC}paint canvas with a as \"sky\"\npaint disc with b as \"moon\"\n{TONES}");
    alike(&base(), &turned, &["sky", "moon"]);
    assert!(svg(&drawing(&base())) == svg(&drawing(&turned)));
}

#[test]
fn another_tone_leaves_the_other_paints_alone() {
    let other = base().replace("poisson(radius: 3mm)", "poisson(radius: 2mm, tries: 5)");
    alike(&base(), &other, &["moon"]);
    assert_ne!(svg(&drawing(&base())), svg(&drawing(&other)));
}

#[test]
fn the_order_of_paints_moves_no_tile() {
    let turned = format!("{HEAD}{TONES}{DISC}paint disc with b as \"moon\"\npaint canvas with a as \"sky\"\n");
    alike(&base(), &turned, &["sky", "moon"]);
}

#[test]
fn seeds_make_the_difference() {
    let other = base().replace("seed 5", "seed 6");
    let (first, second) = (drawing(&base()), drawing(&other));
    for name in ["sky", "moon"] {
        let strokes = |drawing| format!("{:?}{:?}", paint(drawing, name).strokes, paint(drawing, name).dots);
        assert_ne!(strokes(&first), strokes(&second), "{name}");
    }
    // A paint's own seed is its own: the scene's does not reach it.
    let own = base().replace("as \"moon\"", "as \"moon\" seed 9");
    alike(&own, &own.replace("seed 5", "seed 6"), &["moon"]);
    alike(&base(), &own, &["sky"]);
}

#[test]
fn a_name_given_to_a_paint_is_the_only_thing_that_keys_it() {
    // The same tone under another name draws the same on the same paint.
    let renamed = base().replace("tone a {", "tone zz {").replace("with a ", "with zz ");
    alike(&base(), &renamed, &["sky", "moon"]);
}

#[test]
fn a_noise_is_keyed_by_its_name() {
    let scene = |fields: &str| {
        format!(
            "{HEAD}{fields}tone a {{ place: grid(spacing: 3mm) fill: lines(pitch: 1mm) k: 4 * clouds }}\n\
             paint canvas with a\n"
        )
    };
    let alone = scene("field clouds = noise(scale: 8mm)\n");
    let together = scene("field waves = noise(scale: 3mm)\nfield clouds = noise(scale: 8mm)\n");
    alike(&alone, &together, &["a"]);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, ..ProptestConfig::default() })]

    /// With the canvas as domain a region only selects: tiles wholly inside two regions are drawn alike in both.
    #[test]
    fn moving_an_outline_moves_no_tile(x in 8.0f64..22.0, y in 8.0f64..22.0, radius in 6.0f64..12.0, seed in 0u32..1000) {
        let scene = |centre: (f64, f64), radius: f64| {
            let (x, y) = centre;
            format!(
                "canvas {{ size: (30mm, 30mm) }}\nseed {seed}\n\
                 tone a {{ place: poisson(radius: 3mm) shape: voronoi(inset: 0.2mm) fill: lines(pitch: 1mm) edge: whole }}\n\
                 paint circle(center: ({x}mm, {y}mm), radius: {radius}mm) with a\n"
            )
        };
        let everywhere = drawing(&scene((15.0, 15.0), 60.0));
        let everywhere: std::collections::BTreeSet<String> =
            paint(&everywhere, "a").strokes.iter().flat_map(|s| s.bundles()).map(|tile| format!("{tile:?}")).collect();
        let compiled = crate::support::compile_text(&scene((x, y), radius));
        let part = compiled.drawing.expect("it compiles");
        for strokes in part.layers.iter().flat_map(|layer| &layer.strokes) {
            for tile in strokes.bundles() {
                let tile = format!("{tile:?}");
                prop_assert!(everywhere.contains(&tile), "{}", tile);
            }
        }
    }

    /// Strokes end at the region's outline: none has a point outside, by more than the last digits.
    #[test]
    fn strokes_stay_in_their_region(
        x in 5.0f64..25.0,
        y in 5.0f64..25.0,
        radius in 2.0f64..9.0,
        seed in 0u32..1000,
        fill in prop::sample::select(vec![
            "lines(pitch: 0.8mm, pen: 0.3mm)",
            "dashes(pitch: 0.8mm, pen: 0.2mm, dash: 1mm, gap: 0.3mm)",
            "dots(pitch: 0.8mm, radius: 0.25mm)",
            "solid()",
        ]),
        blend in prop::sample::select(vec!["step", "partial", "dither", "contour"]),
        shape in prop::sample::select(vec!["rect()", "voronoi()", "hexagon(overlap: 1.3)"]),
    ) {
        let drawn = drawing(&format!(
            "canvas {{ size: (30mm, 30mm) }}\nseed {seed}\n\
             tone a {{ place: poisson(radius: 2.5mm) shape: {shape} fill: {fill} blend: {blend} k: x / 8 }}\n\
             paint circle(center: ({x}mm, {y}mm), radius: {radius}mm) with a\n"
        ));
        // A circle is drawn as a polygon around it at most this much larger.
        let far = radius + 0.01;
        let middle = kakeami::geom::Point::new(x, y);
        let from_middle = |point: kakeami::geom::Point| point.distance(middle);
        for layer in &drawn.layers {
            for strokes in &layer.strokes {
                let half = strokes.pen.to_mm() / 2.0;
                for &[a, b] in &strokes.lines {
                    let length = a.distance(b);
                    let across = ((b.y - a.y) / length * half, (a.x - b.x) / length * half);
                    for (end, side) in [(a, 1.0), (a, -1.0), (b, 1.0), (b, -1.0)] {
                        let corner = kakeami::geom::Point::new(end.x + side * across.0, end.y + side * across.1);
                        prop_assert!(from_middle(corner) <= far, "{a:?} {b:?} is {} outside", from_middle(corner) - radius);
                    }
                }
                for point in strokes.polylines.iter().flatten() {
                    prop_assert!(from_middle(*point) <= far);
                }
            }
            for dots in &layer.dots {
                for centre in &dots.centres {
                    prop_assert!(from_middle(*centre) <= far);
                }
            }
            for point in layer.areas.iter().flatten().flatten() {
                prop_assert!(from_middle(*point) <= far);
            }
        }
    }
}
