//! Grey values: what `darkness` asks for is what a rendered page holds, seen from so far that tiles blur.

use kakeami::drawing::Drawing;
use kakeami::field::Field;
use kakeami::scene::Draw;
use kakeami::wedge::{Asks, Wedge, WedgeConfig, wedge};
use kakeami::{Config, compile};

use crate::ink::{Sums, error, ink};
use crate::support::{Folder, here, shown};

/// Fine hatching in cells, as the example has it.
const ETCHED: &str = "place: poisson(radius: 1.5mm) shape: voronoi() fill: lines(pitch: 0.22mm, pen: 0.12mm)";

/// The side of its tiles in millimetres.
const TILE: f64 = 1.5;

/// What its four layers print.
const GREATEST: f64 = 0.957;

/// A page that is painted with a tone which asks for a field.
fn page(size: &str, tone: &str, field: &str) -> (Drawing, Field) {
    let text = format!(
        "canvas {{ size: {size} }} seed 1 field f = {field} tone t {{ {tone} darkness: f }} paint canvas with t"
    );
    let loader = Overlay { text, rest: Folder(here("examples/data")) };
    let compiled = compile("page.kake", &loader, &Config::default(), &mut ());
    let said = shown(&compiled.lowered.diagnostics, &compiled.lowered.sources);
    let drawing = compiled.drawing.unwrap_or_else(|| panic!("{said}"));
    let scene = compiled.lowered.scene.expect("it was drawn");
    let Some(Draw::Paint(paint)) = scene.draws.first() else { panic!("nothing is painted") };
    (drawing, paint.tone.asked.field().clone())
}

/// A page beside the pictures that it reads.
struct Overlay {
    text: String,
    rest: Folder,
}

impl kakeami::loader::Loader for Overlay {
    fn load(&self, path: &str) -> Result<std::sync::Arc<[u8]>, kakeami::loader::LoadError> {
        if path == "page.kake" { Ok(self.text.as_bytes().into()) } else { self.rest.load(path) }
    }
}

#[test]
fn a_wedge_of_one_field_is_even_and_true() {
    let steps = 32;
    let side = 2.0 * TILE;
    let size = format!("({}mm, {}mm)", f64::from(steps) * side, 8.0 * side);
    let (drawing, field) = page(&size, ETCHED, &format!("floor(x / {side}) / {}", steps - 1));
    let error = error(&drawing, &field, GREATEST, 2.0 * TILE);
    assert!(error.mean <= 0.03, "{error:?}");
    let pixels = kakeami::back::raster::render(&drawing);
    let sums = Sums::new(pixels.width, &ink(&pixels));
    let (mut off, mut last) = (0.0, -1.0);
    for step in 0..steps {
        // What tiles of the neighbouring steps reach over is left out.
        let across = [f64::from(step) + 0.25, f64::from(step) + 0.75].map(|at| at * pixels.width as f64 / 32.0);
        let found = sums.mean(across.map(|at| at as usize), [40, pixels.height - 40]);
        let asked = (f64::from(step) / 31.0).min(GREATEST);
        off += (found - asked).abs() / 32.0;
        assert!(found > last || asked >= GREATEST, "step {step} prints {found} after {last}");
        last = found;
    }
    assert!(off <= 0.03, "{off}");
}

#[test]
fn photographs_have_their_greys() {
    for picture in ["astronaut.png", "camera.png"] {
        let size = "(60mm, 60mm)";
        let (drawing, field) = page(size, ETCHED, &format!("1 - image(\"{picture}\", fit: (0mm, 0mm, 60mm, 60mm))"));
        let error = error(&drawing, &field, GREATEST, 2.0 * TILE);
        assert!(error.mean <= 0.05, "{picture}: {error:?}");
        assert!(error.bias.abs() <= 0.02, "{picture}: {error:?}");
    }
}

/// The wedge of a tone of these properties.
fn wedge_of(properties: &str, steps: u32) -> Wedge {
    let text = format!("canvas {{ size: a6, dpi: 600 }} tone t(d: field) {{ {properties} }}");
    let loader = Overlay { text, rest: Folder(here("examples/data")) };
    let config = WedgeConfig { lower: Config::default().lower, steps };
    let drawn = wedge("page.kake", &loader, None, &config);
    let said = shown(&drawn.diagnostics, &drawn.sources);
    drawn.wedge.unwrap_or_else(|| panic!("{said}"))
}

#[test]
fn every_kind_of_tone_prints_what_it_reckons() {
    for (name, tone) in [
        ("squares", "place: poisson(radius: 1.2mm) fill: lines(pitch: 0.2mm, pen: 0.1mm)"),
        ("gutters", "place: poisson(radius: 1.5mm) shape: voronoi(inset: 0.1mm) fill: lines(pitch: 0.2mm, pen: 0.1mm)"),
        ("through", "place: poisson(radius: 1.2mm) stack: through fill: lines(pitch: 0.4mm, pen: 0.1mm)"),
        ("coarse", "place: hex(spacing: 1.5mm) shape: cell(inset: 0.05mm) fill: lines(pitch: 0.5mm, pen: 0.2mm)"),
        ("dots", "place: hex(spacing: 2mm) shape: hexagon(upright: true) fill: dots(pitch: 0.3mm, radius: 0.08mm)"),
        (
            "dashes",
            "place: poisson(radius: 1.5mm) shape: voronoi() fill: dashes(pitch: 0.2mm, pen: 0.1mm, dash: 0.5mm)",
        ),
        (
            "mixed",
            "place: grid(spacing: 2mm) angle: checkerboard
             fill: [lines(pitch: 0.3mm, pen: 0.1mm), dots(pitch: 0.4mm, radius: 0.1mm), solid]",
        ),
    ] {
        let wedge = wedge_of(&format!("{tone} darkness: d"), 9);
        assert_eq!((wedge.asks, wedge.steps.len()), (Asks::Darkness, 9));
        let greatest = wedge.steps[8].reckoned;
        let off = |wanted: fn(f64, f64) -> f64| -> f64 {
            wedge.steps.iter().map(|step| (step.measured - wanted(step.reckoned, step.asked)).abs()).sum::<f64>() / 9.0
        };
        assert!(off(|reckoned, _| reckoned) <= 0.03, "{name}: {:?}", wedge.steps);
        let clipped =
            wedge.steps.iter().map(|step| (step.measured - step.asked.min(greatest)).abs()).sum::<f64>() / 9.0;
        assert!(clipped <= 0.03, "{name}: {:?}", wedge.steps);
        let rising = wedge.steps.windows(2).all(|pair| pair[1].measured >= pair[0].measured - 0.015);
        assert!(rising, "{name}: {:?}", wedge.steps);
    }
}

#[test]
fn layers_have_wedges_too() {
    let wedge = wedge_of("place: grid(spacing: 2mm) shape: cell() fill: lines(pitch: 0.4mm, pen: 0.1mm) k: d", 5);
    assert_eq!(wedge.asks, Asks::K);
    // Each layer leaves three quarters of the paper bare.
    for (layers, step) in wedge.steps.iter().enumerate() {
        let wanted = 1.0 - libm::pow(0.75, layers as f64);
        assert!((step.asked - layers as f64).abs() < 1e-9);
        assert!((step.measured - wanted).abs() < 0.03 && (step.reckoned - wanted).abs() < 0.03, "{step:?}");
    }
    let names: Vec<&str> = wedge.drawing.layers.iter().map(|layer| layer.groups[0].as_str()).collect();
    assert!(names[0].starts_with("k 1.000, prints 0.2"), "{names:?}");
}

/// Ink that spreads is reckoned with, not drawn: what is drawn is lighter by as much as it spreads.
#[test]
fn gain_thins_what_is_drawn() {
    let drawn = |gain: &str| {
        let text = format!(
            "canvas {{ size: (20mm, 20mm), gain: {gain} }} seed 1
             tone t {{ {ETCHED} darkness: 0.4 }} paint canvas with t"
        );
        let loader = Overlay { text, rest: Folder(here("examples/data")) };
        let compiled = compile("page.kake", &loader, &Config::default(), &mut ());
        let pixels = kakeami::back::raster::render(&compiled.drawing.expect("it compiles"));
        ink(&pixels).iter().sum::<f64>() / ink(&pixels).len() as f64
    };
    // Strokes of 0.12 mm print 0.16 mm wide.
    assert!((drawn("0mm") - 0.4).abs() < 0.02, "{}", drawn("0mm"));
    assert!((drawn("0.02mm") - 0.4 * 0.12 / 0.16).abs() < 0.02, "{}", drawn("0.02mm"));
}
