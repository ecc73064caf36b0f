//! How many strokes a second a hand draws, one way of straying at a time, from tiles to the drawing:
//! `cargo bench --bench hand`. The items are strokes; `RAYON_NUM_THREADS=1` says what one core does.

mod support;

use divan::Bencher;
use divan::counter::ItemsCount;
use kakeami::PaintStages;
use kakeami::drawing::{Drawing, Layer};
use kakeami::pass::draw::{Assembly, Setting};
use kakeami::scene::{Canvas, Limits, Paint};

const HANDS: [&str; 9] = [
    "angle: 0deg",
    "angle: 3deg",
    "spacing: 12%",
    "pen: 15%",
    "taper: 30%",
    "overshoot: 0.3mm",
    "wobble: 0.1mm",
    "angle: 3deg, spacing: 12%, pen: 15%, taper: 30%, overshoot: 0.3mm",
    "",
];

fn main() {
    divan::main();
}

/// Ten thousand tiles of the classic kakeami, drawn by a hand.
fn scene(hand: &str) -> (Canvas, Paint) {
    let text = format!(
        "canvas {{ size: (595mm, 595mm) }}
         seed 1
         tone kakeami {{
           place: poisson(radius: 4.7mm)
           shape: rect(size: 7.5mm)
           angle: bfs()
           fill: lines(pitch: 0.9mm, pen: 0.2mm)
           hand: hand({hand})
         }}
         paint canvas with kakeami"
    );
    support::painted(&text)
}

fn drawing(canvas: &Canvas, paint: &Paint, stages: &PaintStages) -> Drawing {
    let limits = Limits::default();
    let mut assembly = Assembly::new(canvas, &limits);
    let setting = Setting { groups: Vec::new(), ink: canvas.ink };
    match assembly.paint(paint, &setting, &stages.borrow()) {
        Ok(_) => assembly.finish(),
        Err(diagnostic) => unreachable!("{}", diagnostic.message),
    }
}

#[divan::bench(args = HANDS, sample_count = 10)]
fn hand(bencher: Bencher<'_, '_>, hand: &str) {
    let (canvas, paint) = scene(hand);
    let stages = match PaintStages::new(&paint, &canvas, &Limits::default(), &mut (), &mut Vec::new()) {
        Ok(stages) => stages,
        Err(diagnostic) => unreachable!("{}", diagnostic.message),
    };
    let strokes: u64 = drawing(&canvas, &paint, &stages).layers.iter().map(Layer::marks).sum();
    bencher.counter(ItemsCount::new(strokes)).bench(|| drawing(&canvas, &paint, &stages));
}
