//! How long measuring takes, all of it and its heavy families, on the report's scene and on a hundred thousand tiles:
//! `cargo bench --bench metrics`. The items are tiles.

mod support;

use divan::Bencher;
use divan::counter::ItemsCount;
use kakeami::PaintStages;
use kakeami::metrics::{Measured, Measures, correlogram, decay, grain, space};
use kakeami::scene::{Canvas, Limits, Paint};

/// Sides of square canvases, in millimetres: the report's of 69 tiles or so, one of two thousand, and one of 100,000.
const SIDES: [f64; 3] = [6.0, 34.0, 240.0];

fn main() {
    divan::main();
}

/// The report's tone on a canvas of this side.
fn scene(side: f64) -> (Canvas, Paint) {
    let text = format!(
        "canvas {{ size: ({side}mm, {side}mm) }}
         seed 1
         tone plate {{
           place: poisson(radius: 0.6mm)
           shape: rect(size: 0.88mm)
           angle: bfs()
           bleed: 0mm
           fill: lines(pitch: 0.08mm, pen: 0.005mm)
           k: 1
         }}
         paint canvas with plate"
    );
    support::painted(&text)
}

fn stages(canvas: &Canvas, paint: &Paint) -> PaintStages {
    match PaintStages::new(paint, canvas, &Limits::default(), &mut (), &mut Vec::new()) {
        Ok(stages) => stages,
        Err(diagnostic) => unreachable!("{}", diagnostic.message),
    }
}

fn measured(side: f64) -> Measured {
    let (canvas, paint) = scene(side);
    Measured::new(&paint, &stages(&canvas, &paint).borrow())
}

/// From the stages to what families of measures read.
#[divan::bench(args = SIDES, max_time = 3)]
fn gather(bencher: Bencher<'_, '_>, side: f64) {
    let (canvas, paint) = scene(side);
    let stages = stages(&canvas, &paint);
    bencher.counter(ItemsCount::new(measured(side).sites.len())).bench(|| Measured::new(&paint, &stages.borrow()));
}

/// All measures.
#[divan::bench(args = SIDES, max_time = 3)]
fn measures(bencher: Bencher<'_, '_>, side: f64) {
    let measured = measured(side);
    bencher.counter(ItemsCount::new(measured.sites.len())).bench(|| Measures::new(&measured));
}

#[divan::bench(args = SIDES, max_time = 3)]
fn family_correlogram(bencher: Bencher<'_, '_>, side: f64) {
    let measured = measured(side);
    bencher.counter(ItemsCount::new(measured.sites.len())).bench(|| correlogram::measure(&measured));
}

#[divan::bench(args = SIDES, max_time = 3)]
fn family_decay(bencher: Bencher<'_, '_>, side: f64) {
    let measured = measured(side);
    let correlogram = correlogram::measure(&measured);
    bencher.counter(ItemsCount::new(measured.sites.len())).bench(|| decay::measure(&correlogram));
}

#[divan::bench(args = SIDES, max_time = 3)]
fn family_space(bencher: Bencher<'_, '_>, side: f64) {
    let measured = measured(side);
    bencher.counter(ItemsCount::new(measured.sites.len())).bench(|| space::measure(&measured));
}

#[divan::bench(args = SIDES, max_time = 3)]
fn family_grain(bencher: Bencher<'_, '_>, side: f64) {
    let measured = measured(side);
    bencher.counter(ItemsCount::new(measured.sites.len())).bench(|| grain::measure(&measured));
}
