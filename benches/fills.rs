//! How many strokes a second one thread draws of every fill, from tiles to drawing: `cargo bench --bench fills`. The items
//! are strokes as they come out, cut to pieces by the tiles that lie over each other.

mod support;

use divan::Bencher;
use divan::counter::ItemsCount;
use kakeami::PaintStages;
use kakeami::drawing::{Drawing, Layer};
use kakeami::pass::draw::{Assembly, Setting};
use kakeami::scene::{Canvas, Limits, Paint};

/// Every fill at the spacing that a page has.
const FILLS: [(&str, &str); 9] = [
    ("lines", "lines(pitch: 0.5mm, pen: 0.1mm)"),
    ("dashes", "dashes(pitch: 0.5mm, pen: 0.1mm, dash: 1mm, gap: 0.5mm)"),
    ("dots", "dots(pitch: 0.6mm, radius: 0.1mm)"),
    ("crosses", "crosses(pitch: 1mm, pen: 0.1mm)"),
    ("arcs", "arcs(pitch: 0.5mm, pen: 0.1mm)"),
    ("waves", "waves(pitch: 0.5mm, pen: 0.1mm)"),
    ("scribble", "scribble(pitch: 0.8mm, pen: 0.1mm)"),
    ("nawaami", "nawaami(pitch: 0.5mm, pen: 0.1mm)"),
    ("motif", "motif(\"M0 0C1-2 3 2 4 0M0 1C1-1 3 3 4 1\", size: 0.8mm, pen: 0.1mm)"),
];

const SHAPES: [&str; 2] = ["rect(size: 6mm)", "voronoi(inset: 0.1mm)"];

fn main() {
    divan::main();
}

/// A page of some thousand tiles.
fn scene(fill: &str, shape: &str) -> (Canvas, Paint) {
    let text = format!(
        "canvas {{ size: (200mm, 200mm) }}
         seed 1
         tone page {{ place: poisson(radius: 3.6mm) shape: {shape} angle: bfs() fill: {fill} k: 2 }}
         paint canvas with page"
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

fn bench(bencher: Bencher<'_, '_>, name: &str, shape: &str) {
    let fill = FILLS.iter().find(|(fill, _)| *fill == name).map_or("", |(_, fill)| fill);
    let (canvas, paint) = scene(fill, shape);
    let stages = match PaintStages::new(&paint, &canvas, &Limits::default(), &mut (), &mut Vec::new()) {
        Ok(stages) => stages,
        Err(diagnostic) => unreachable!("{}", diagnostic.message),
    };
    let strokes: u64 = drawing(&canvas, &paint, &stages).layers.iter().map(Layer::marks).sum();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    let pool = pool.unwrap_or_else(|error| unreachable!("{error}"));
    bencher.counter(ItemsCount::new(strokes)).bench(|| pool.install(|| drawing(&canvas, &paint, &stages)));
}

#[divan::bench(args = FILLS.map(|(name, _)| name), sample_count = 5)]
fn stamps(bencher: Bencher<'_, '_>, fill: &str) {
    bench(bencher, fill, SHAPES[0]);
}

#[divan::bench(args = FILLS.map(|(name, _)| name), sample_count = 5)]
fn cells(bencher: Bencher<'_, '_>, fill: &str) {
    bench(bencher, fill, SHAPES[1]);
}
