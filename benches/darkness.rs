//! How true the grey values of `darkness` are at 600 dpi, printed as a table: `cargo bench --bench darkness`.

#![allow(clippy::print_stdout, clippy::unwrap_used, clippy::panic)]

#[path = "../tests/ink.rs"]
mod ink;

use std::time::Instant;

use kakeami::drawing::Drawing;
use kakeami::field::Field;
use kakeami::loader::MemoryLoader;
use kakeami::scene::Draw;
use kakeami::{Config, compile};

/// A page and the field that it is filled with.
fn page(text: &str, loader: &MemoryLoader) -> (Drawing, Field) {
    let mut loader = loader.clone();
    loader.files.insert("page.kake".to_owned(), text.as_bytes().into());
    let compiled = compile("page.kake", &loader, &Config::default(), &mut ());
    let Some(drawing) = compiled.drawing else { panic!("{:?}", compiled.lowered.diagnostics) };
    let scene = compiled.lowered.scene.unwrap();
    let Some(Draw::Paint(paint)) = scene.draws.first() else { panic!("nothing is painted") };
    (drawing, paint.tone.asked.field().clone())
}

/// Tones by name, with the side of a tile in millimetres.
const TONES: [(&str, f64, &str); 9] = [
    ("etched", 2.4, "place: poisson(radius: 2.4mm) shape: voronoi() fill: lines(pitch: 0.22mm, pen: 0.12mm)"),
    ("gutters", 4.0, "place: poisson(radius: 4mm) shape: voronoi(inset: 0.2mm) fill: lines(pitch: 0.3mm, pen: 0.12mm)"),
    ("squares", 2.4, "place: poisson(radius: 2.4mm) fill: lines(pitch: 0.22mm, pen: 0.12mm)"),
    ("kakeami", 4.7, "place: poisson(radius: 4.7mm) shape: rect(size: 7.5mm) fill: lines(pitch: 0.9mm, pen: 0.2mm)"),
    ("through", 2.4, "place: poisson(radius: 2.4mm) stack: through fill: lines(pitch: 0.4mm, pen: 0.12mm)"),
    ("coarse", 2.4, "place: poisson(radius: 2.4mm) shape: voronoi() fill: lines(pitch: 0.8mm, pen: 0.4mm)"),
    (
        "stipple",
        5.0,
        "place: hex(spacing: 5mm) shape: hexagon(size: 4.8mm, upright: true) fill: dots(pitch: 0.8mm, radius: 0.15mm)",
    ),
    ("dots", 3.0, "place: poisson(radius: 3mm) shape: voronoi() fill: dots(pitch: 0.5mm, radius: 0.12mm)"),
    (
        "dashes",
        3.0,
        "place: poisson(radius: 3mm) shape: voronoi() fill: dashes(pitch: 0.25mm, pen: 0.12mm, dash: 1mm, gap: 0.3mm)",
    ),
];

fn main() {
    let mut loader = MemoryLoader::default();
    for picture in ["astronaut.png", "camera.png"] {
        let bytes = std::fs::read(format!("examples/data/{picture}")).unwrap();
        loader.files.insert(picture.to_owned(), bytes.into());
    }
    let only = std::env::args().nth(1).filter(|only| !only.starts_with('-'));
    for (name, tile, tone) in TONES.iter().filter(|(name, ..)| only.as_deref().is_none_or(|only| only == *name)) {
        let scene = |size: &str, field: &str| {
            format!(
                "canvas {{ size: {size} }} seed 1 field f = {field} tone t {{ {tone} darkness: f }} paint canvas with t"
            )
        };
        let (black, one) = page(&scene("(60mm, 60mm)", "1"), &loader);
        let pixels = kakeami::back::raster::render(&black);
        let greatest = ink::Sums::new(pixels.width, &ink::ink(&pixels))
            .mean([200, pixels.width - 200], [200, pixels.height - 200]);
        let _ = one;
        println!("{name}: prints up to {greatest:.3}");
        // Steps of two tiles and more, so that the wedge's inner boxes are pure.
        let step = 6.0 * tile;
        let wedge = scene(&format!("({}mm, {}mm)", 32.0 * step, 4.0 * step), &format!("floor(x / {step}) / 31"));
        let start = Instant::now();
        let (drawing, field) = page(&wedge, &loader);
        let spent = start.elapsed().as_millis();
        let pixels = kakeami::back::raster::render(&drawing);
        let sums = ink::Sums::new(pixels.width, &ink::ink(&pixels));
        let width = pixels.width as f64 / 32.0;
        let margin = 1.0 / 6.0;
        let (mut off, mut last, mut falls) = (0.0, -1.0, 0);
        let mut line = String::new();
        for i in 0..32u32 {
            let across = [f64::from(i) + margin, f64::from(i + 1) - margin].map(|at| (at * width) as usize);
            let down = [(tile / 25.4 * 600.0) as usize, pixels.height - (tile / 25.4 * 600.0) as usize];
            let (asked, found) = ((f64::from(i) / 31.0).min(greatest), sums.mean(across, down));
            off += (found - asked).abs() / 32.0;
            falls += usize::from(found < last - 1e-3 && asked < greatest);
            last = found;
            line += &format!("{:+.3} ", found - asked);
        }
        println!("  wedge: steps off by {off:.4}, {falls} falls\n  {line}");
        let ink::Error { mean, bias } = ink::error(&drawing, &field, greatest, 2.0 * tile);
        println!("  wedge: off by {mean:.4}, bias {bias:+.4} ({spent} ms)");
        for picture in ["astronaut", "camera"] {
            let image = format!("1 - image(\"{picture}.png\", fit: (0mm, 0mm, 105mm, 105mm))");
            let (drawing, field) = page(&scene("(105mm, 105mm)", &image), &loader);
            let ink::Error { mean, bias } = ink::error(&drawing, &field, greatest, 2.0 * tile);
            println!("  {picture}: off by {mean:.4}, bias {bias:+.4}");
        }
    }
}
