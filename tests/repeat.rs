//! Canvases that repeat: every mark that leaves the page on one side enters it on the other, and copies of a picture set
//! side by side show no seam.

use std::fmt::Write as _;

use kakeami::Config;
use kakeami::drawing::{Drawing, Layer};
use kakeami::geom::{Point, Vec2};
use proptest::prelude::*;

use crate::support::{compile_text, drawing, shown};

const PLACEMENTS: [&str; 9] = [
    "poisson(radius: 3mm)",
    "poisson(radius: 2.5mm, density: 0.3 + 0.7 * cells)",
    "uniform(count: 40)",
    "grid(spacing: 3mm)",
    "grid(columns: 7, rows: 5)",
    "hex(spacing: 3.2mm)",
    "triangles(edge: 4mm)",
    "relaxed(poisson(radius: 3mm), rounds: 2)",
    "points([
       (1mm, 1mm), (19mm, 11mm), (-4mm, 7mm), (10mm, 30mm), (6mm, 6mm), (15mm, 3mm), (4mm, 3mm), (8mm, 1mm),
       (12mm, 2mm), (18mm, 6mm), (2mm, 9mm), (5mm, 11mm), (9mm, 9mm), (13mm, 7mm), (14mm, 11mm), (17mm, 1mm),
       (10mm, 5mm), (0mm, 4mm), (7mm, 8mm), (12mm, 10mm), (1mm, 12mm), (3mm, 6mm), (19mm, 8mm), (16mm, 9mm),
     ])",
];
const SHAPES: [&str; 7] = [
    "rect()",
    "rect(size: 5mm)",
    "rect(width: 5mm, height: 2mm, upright: true)",
    "hexagon()",
    "stamp([(-2mm, -2mm), (2mm, -2mm), (0mm, 0mm), (2mm, 2mm), (-2mm, 2mm)])",
    "voronoi(inset: 0.1mm)",
    "voronoi(inset: 0.1mm, round: 0.5mm)",
];
const FILLS: [&str; 5] = [
    "lines(pitch: 0.8mm, pen: 0.2mm)",
    "lines(pitch: 0.8mm, pen: 0.2mm, cap: round)",
    "dashes(pitch: 0.8mm, dash: 1.1mm, gap: 0.5mm, pen: 0.2mm)",
    "dots(pitch: 0.9mm, spacing: 0.9mm, radius: 0.2mm)",
    "solid()",
];
const GROUNDS: [&str; 5] = [
    "",
    "ground: nearest",
    "ground: lines(pitch: 0.7mm, pen: 0.1mm)",
    "ground: dashes(pitch: 0.7mm, dash: 1mm, gap: 0.6mm, pen: 0.1mm)",
    "ground: dots(pitch: 0.8mm, spacing: 0.8mm, radius: 0.15mm)",
];
const REGIONS: [&str; 4] = [
    "canvas",
    "circle(center: (20mm, 3mm), radius: 5mm)",
    "rect(at: (-4mm, 2mm), size: (11mm, 7mm))",
    "rect(at: (0mm, 3mm), size: (20mm, 6mm))",
];
const MORE: [&str; 6] = ["", "blend: partial", "blend: dither", "blend: contour", "stack: through", "edge: whole"];

/// Where marks lie on a canvas of 20 by 13 mm.
const PERIOD: [f64; 2] = [20.0, 13.0];

/// Places on the page, and whether ink is there, from straight strokes and dots alone.
struct Marks {
    lines: Vec<([Point; 2], f64, bool)>,
    dots: Vec<(Point, f64)>,
}

impl Marks {
    fn of(drawing: &Drawing) -> Self {
        let (mut lines, mut dots) = (Vec::new(), Vec::new());
        for layer in &drawing.layers {
            for strokes in &layer.strokes {
                let round = strokes.cap == kakeami::scene::Cap::Round;
                lines.extend(strokes.lines.iter().map(|&line| (line, strokes.pen.to_mm(), round)));
            }
            for of_size in &layer.dots {
                dots.extend(of_size.centres.iter().map(|&centre| (centre, of_size.radius.to_mm())));
            }
        }
        Self { lines, dots }
    }

    /// Where strokes meet the line at `x` (or `y`, with the axes swapped): places along it, directions and pens.
    fn crossings(&self, axis: usize, at: f64) -> Vec<[f64; 3]> {
        let swap = |p: Point| if axis == 0 { p } else { Point::new(p.y, p.x) };
        let mut found: Vec<[f64; 3]> = self
            .lines
            .iter()
            .filter_map(|&([a, b], pen, _)| {
                let (a, b) = (swap(a), swap(b));
                let (low, high) = if a.x < b.x { (a, b) } else { (b, a) };
                if !(low.x < at && at < high.x) {
                    return None;
                }
                let y = low.y + (high.y - low.y) * (at - low.x) / (high.x - low.x);
                let slope = (high.y - low.y) / (high.x - low.x);
                Some([y, slope, pen])
            })
            .filter(|[y, slope, pen]| {
                let other = PERIOD[1 - axis];
                // Ends of what a corner of the page cuts are not compared: elsewhere their copies are.
                let reach = pen + slope.abs() * pen;
                *y > reach && *y < other - reach && slope.abs() < 50.0
            })
            .collect();
        found.sort_by(|a, b| a.partial_cmp(b).expect("places are numbers"));
        found
    }
}

/// Both borders of both axes meet the same strokes.
fn check_continuations(drawing: &Drawing) -> Result<(), String> {
    let marks = Marks::of(drawing);
    // Beside the borders, within the reach of the thinnest pen: on them tiles of a lattice may end exactly.
    for (axis, beside) in [(0, 0.0371), (0, -0.0371), (1, 0.0371), (1, -0.0371)] {
        let (near, far) = (marks.crossings(axis, beside), marks.crossings(axis, PERIOD[axis] + beside));
        if near.len() != far.len() {
            return Err(format!("axis {axis}: strokes at {near:?} at one border, at {far:?} at the other"));
        }
        for (a, b) in near.iter().zip(&far) {
            if (a[0] - b[0]).abs() > 1e-9 * (1.0 + a[1].abs()) || (a[1] - b[1]).abs() > 1e-6 || a[2] != b[2] {
                return Err(format!("axis {axis}: {a:?} at one border, {b:?} at the other"));
            }
        }
    }
    for &(centre, radius) in &marks.dots {
        for column in [-1.0, 0.0, 1.0] {
            for row in [-1.0, 0.0, 1.0] {
                let there = centre + Vec2::new(column * PERIOD[0], row * PERIOD[1]);
                let reach = radius - 1e-6;
                let is_seen =
                    -reach < there.x && there.x < PERIOD[0] + reach && -reach < there.y && there.y < PERIOD[1] + reach;
                let has = |&(other, size): &(Point, f64)| size == radius && other.distance(there) < 1e-9;
                if is_seen && !marks.dots.iter().any(has) {
                    return Err(format!("the dot at {centre:?} does not come in at {there:?}"));
                }
            }
        }
    }
    for layer in &drawing.layers {
        check_areas(layer)?;
    }
    Ok(())
}

/// Areas hold the same places at both borders.
fn check_areas(layer: &Layer) -> Result<(), String> {
    let holds = |p: Point| {
        let crossed = |ring: &Vec<Point>| {
            let mut a = *ring.last().expect("rings have corners");
            let mut inside = false;
            for &b in ring {
                if (a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y) {
                    inside = !inside;
                }
                a = b;
            }
            inside
        };
        layer.areas.iter().any(|area| area.iter().filter(|ring| crossed(ring)).count() % 2 == 1)
    };
    let mut differing = 0;
    for i in 0..400 {
        let at = (f64::from(i) + 0.5) / 400.0;
        let pairs = [
            [Point::new(1e-7, at * PERIOD[1]), Point::new(PERIOD[0] + 1e-7, at * PERIOD[1])],
            [Point::new(at * PERIOD[0], 1e-7), Point::new(at * PERIOD[0], PERIOD[1] + 1e-7)],
        ];
        // What lies just beyond the far border is only drawn where it belongs to an area that crosses it.
        for [near, far] in pairs {
            differing += usize::from(holds(far) && !holds(near));
        }
    }
    // An edge of an area may lie between two places that rounding tells apart.
    if differing > 2 { Err(format!("areas differ in {differing} places")) } else { Ok(()) }
}

fn scene(place: &str, shape: &str, fill: &str, (ground, region, more): (&str, &str, &str), seed: u64) -> String {
    let mut text = format!("canvas {{ size: (20mm, 13mm), repeat: true }}\nseed {seed}\n");
    writeln!(text, "field cells = noise(scale: 4mm)").expect("text grows");
    writeln!(text, "tone t {{ place: {place} shape: {shape} fill: {fill} k: 0.4 + 2 * cells {ground} {more} }}")
        .expect("text grows");
    writeln!(text, "paint {region} with t").expect("text grows");
    text
}

fn one_of<const N: usize>(list: [&'static str; N]) -> impl Strategy<Value = &'static str> {
    prop::sample::select(list.to_vec())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn every_stroke_has_its_continuation(
        (place, shape, fill) in (one_of(PLACEMENTS), one_of(SHAPES), one_of(FILLS)),
        rest in (one_of(GROUNDS), one_of(REGIONS), one_of(MORE)),
        seed in 0u64..1000,
    ) {
        let text = scene(place, shape, fill, rest, seed);
        let compiled = compile_text(&text);
        let said = shown(&compiled.lowered.diagnostics, &compiled.lowered.sources);
        let drawing = compiled.drawing.ok_or_else(|| TestCaseError::fail(said))?;
        check_continuations(&drawing).map_err(|error| TestCaseError::fail(format!("{error}\n{text}")))?;
    }

    #[test]
    fn knockouts_go_round(seed in 0u64..1000, ground in one_of(GROUNDS)) {
        let mut text = scene(PLACEMENTS[0], SHAPES[1], FILLS[0], (ground, "canvas", ""), seed);
        text.push_str("tone over { place: poisson(radius: 5mm) shape: hexagon(size: 4mm) fill: lines(pitch: 1mm)
            over: knockout }\npaint canvas with over\noutline circle(center: (1mm, 12mm), radius: 3mm) pen 0.3mm");
        check_continuations(&drawing(&text)).map_err(TestCaseError::fail)?;
    }

    #[test]
    fn no_two_sites_are_closer_than_the_radius(seed in 0u64..1000, radius in 0.8..6.0f64) {
        let text = format!(
            "canvas {{ size: (20mm, 13mm), repeat: true }} seed {seed}
             tone t {{ place: poisson(radius: {radius}mm) shape: rect(size: 1mm) fill: solid() }} paint canvas with t"
        );
        let compiled = compile_text(&text);
        let scene = compiled.lowered.scene.expect("the scene is without fault");
        let paint = kakeami::paints(&scene).next().expect("it paints");
        let limits = Config::default().lower.limits;
        let sites = kakeami::pass::place::place(paint, &scene.canvas, &limits).expect("within limits").points;
        let period = scene.canvas.period().expect("it repeats");
        for (i, &a) in sites.iter().enumerate() {
            prop_assert!(period.area().contains(a));
            for &b in &sites[..i] {
                prop_assert!(period.shortest(b - a).length() >= radius - 1e-9);
            }
        }
        // They are as dense as on a page with an end, and as Bridson's algorithm has them.
        let density = sites.len() as f64 * radius * radius / (20.0 * 13.0);
        prop_assert!((0.25..0.95).contains(&density), "{density}");
    }
}

/// The pixels of a drawing, dark ones high.
fn pixels(drawing: &Drawing) -> (usize, usize, Vec<f64>) {
    let pixels = kakeami::back::raster::render(drawing);
    let value = |x: usize, y: usize| f64::from(255 - pixels.colour(x, y).expect("it is on the page").r);
    let values = (0..pixels.height).flat_map(|y| (0..pixels.width).map(move |x| (x, y))).map(|(x, y)| value(x, y));
    (pixels.width, pixels.height, values.collect())
}

/// The mean difference of every column to the next, the last one to the first: the seam of two copies.
fn steps(width: usize, height: usize, at: impl Fn(usize, usize) -> f64) -> Vec<f64> {
    let step = |x: usize| (0..height).map(|y| (at(x, y) - at((x + 1) % width, y)).abs()).sum::<f64>() / height as f64;
    (0..width).map(step).collect()
}

#[test]
fn copies_side_by_side_show_no_seam() {
    for (place, shape, fill, ground) in [
        (PLACEMENTS[0], SHAPES[1], FILLS[0], GROUNDS[0]),
        (PLACEMENTS[0], SHAPES[5], FILLS[0], GROUNDS[0]),
        (PLACEMENTS[5], SHAPES[3], FILLS[3], GROUNDS[0]),
        (PLACEMENTS[0], "rect(size: 2mm)", FILLS[0], GROUNDS[1]),
        (PLACEMENTS[0], "rect(size: 2mm)", FILLS[0], GROUNDS[2]),
        (PLACEMENTS[2], SHAPES[0], FILLS[1], GROUNDS[0]),
    ] {
        // 473 by 307 pixels: neither is a whole number, and the scales differ.
        let text = scene(place, shape, fill, (ground, "canvas", ""), 5);
        let (width, height, values) = pixels(&drawing(&text));
        assert_eq!((width, height), (472, 307));
        let across = steps(width, height, |x, y| values[y * width + x]);
        let down = steps(height, width, |y, x| values[y * width + x]);
        for steps in [across, down] {
            let (seam, interior) = steps.split_last().expect("there are columns");
            let mean = interior.iter().sum::<f64>() / interior.len() as f64;
            let variance =
                interior.iter().map(|step| (step - mean) * (step - mean)).sum::<f64>() / interior.len() as f64;
            let score = (seam - mean) / variance.sqrt();
            assert!(score.abs() < 3.0, "{place} {shape} {ground}: the seam stands out by {score} deviations");
            let rank = interior.iter().filter(|step| *step > seam).count();
            assert!(rank > 0, "{place} {shape} {ground}: no step inside is as great as the seam's");
        }
    }
}

/// What is compared at the borders is there: strokes cross them where the canvas repeats, and end there where it does not.
#[test]
fn strokes_cross_the_borders_of_what_repeats() {
    let text = scene(PLACEMENTS[0], SHAPES[1], FILLS[0], ("", "canvas", ""), 5);
    let crossings = |text: &str| Marks::of(&drawing(text)).crossings(0, 0.0).len();
    assert!(crossings(&text) > 5);
    assert_eq!(crossings(&text.replace("repeat: true", "repeat: false")), 0);
}

#[test]
fn lattices_go_round_whole() {
    for (place, sites, edges) in [
        ("grid(spacing: 3mm)", 28, 56),
        ("grid(columns: 7, rows: 5)", 35, 70),
        ("hex(spacing: 3.2mm)", 24, 72),
        ("triangles(edge: 4mm)", 40, 60),
    ] {
        let text = format!(
            "canvas {{ size: (20mm, 13mm), repeat: true }}
             tone t {{ place: {place} shape: cell(inset: 0.1mm) link: edges fill: lines(pitch: 1mm) }} paint canvas with t"
        );
        let compiled = compile_text(&text);
        let scene = compiled.lowered.scene.expect("the scene is without fault");
        let paint = kakeami::paints(&scene).next().expect("it paints");
        let limits = Config::default().lower.limits;
        let stages =
            kakeami::PaintStages::new(paint, &scene.canvas, &limits, &mut (), &mut Vec::new()).expect("it is small");
        assert_eq!((stages.sites.points.len(), stages.graph.edges().count()), (sites, edges), "{place}");
        assert!(stages.tiles.inside.iter().all(|&inside| inside));
        check_continuations(&compiled.drawing.expect("it is drawn")).expect(place);
    }
}

#[test]
fn swatches_have_one_bit_and_clear_paper() {
    let text = "canvas { size: (20mm, 13mm), repeat: true, paper: none, depth: 1 }
                tone t { place: poisson(radius: 3mm) fill: lines(pitch: 0.8mm) } paint canvas with t";
    let mut bytes = Vec::new();
    kakeami::back::png::write(&drawing(text), None, &mut bytes).expect("memory takes all that is written");
    let reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().expect("it is a PNG");
    let info = reader.info();
    assert_eq!((info.color_type, info.bit_depth), (png::ColorType::Indexed, png::BitDepth::One));
    assert_eq!(info.trns.as_deref(), Some([0, 255].as_slice()));
}
