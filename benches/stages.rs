//! How long each stage takes on scenes of ten thousand to a million tiles of about eleven strokes, from sites to SVG
//! text: `cargo bench --bench stages`. The items are tiles, so that the throughput says whether a stage's time grows in
//! step with them.

mod support;

use divan::Bencher;
use divan::counter::ItemsCount;
use kakeami::PaintStages;
use kakeami::drawing::Drawing;
use kakeami::pass::draw::{Assembly, Setting};
use kakeami::pass::{cut, link, place, turn};
use kakeami::scene::{Canvas, Limits, Link, Paint};
use kakeami::stop::Stop;

/// About how many tiles there are.
const TILES: [u32; 4] = [10_000, 90_000, 100_000, 1_000_000];

/// Poisson-disk sampling finds so many sites in a square of its radius.
const DENSITY: f64 = 0.627;

fn main() {
    divan::main();
}

/// The report's tone on a canvas of so many tiles.
fn scene(tiles: u32) -> (Canvas, Paint) {
    let side = 0.6 * (f64::from(tiles) / DENSITY).sqrt();
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

fn drawing(canvas: &Canvas, paint: &Paint, stages: &PaintStages) -> Drawing {
    let limits = Limits::default();
    let mut assembly = Assembly::new(canvas, &limits);
    let setting = Setting { groups: Vec::new(), ink: canvas.ink };
    match assembly.paint(paint, &setting, &stages.borrow()) {
        Ok(_) => assembly.finish(),
        Err(diagnostic) => unreachable!("{}", diagnostic.message),
    }
}

#[divan::bench(args = TILES, sample_count = 5)]
fn stage_1_place(bencher: Bencher<'_, '_>, tiles: u32) {
    let (canvas, paint) = scene(tiles);
    bencher.counter(ItemsCount::new(tiles)).bench(|| place::place(&paint, &canvas, &Limits::default()));
}

#[divan::bench(args = TILES, sample_count = 5)]
fn stage_2_link(bencher: Bencher<'_, '_>, tiles: u32) {
    let (canvas, paint) = scene(tiles);
    let stages = stages(&canvas, &paint);
    bencher.counter(ItemsCount::new(tiles)).bench(|| link::link(&stages.sites, Link::Delaunay));
}

#[divan::bench(args = TILES, sample_count = 5)]
fn stage_3_turn(bencher: Bencher<'_, '_>, tiles: u32) {
    let (canvas, paint) = scene(tiles);
    let stages = stages(&canvas, &paint);
    bencher
        .counter(ItemsCount::new(tiles))
        .bench(|| turn::turn(&paint, &stages.sites, &stages.graph, &Stop::default()));
}

#[divan::bench(args = TILES, sample_count = 5)]
fn stage_4_cut(bencher: Bencher<'_, '_>, tiles: u32) {
    let (canvas, paint) = scene(tiles);
    let PaintStages { sites, graph, angles, .. } = stages(&canvas, &paint);
    bencher
        .counter(ItemsCount::new(tiles))
        .bench(|| cut::cut(&paint, &canvas, &sites, &graph, &angles, &mut Vec::new()));
}

#[divan::bench(args = TILES, sample_count = 5)]
fn stage_5_draw(bencher: Bencher<'_, '_>, tiles: u32) {
    let (canvas, paint) = scene(tiles);
    let stages = stages(&canvas, &paint);
    bencher.counter(ItemsCount::new(tiles)).bench(|| drawing(&canvas, &paint, &stages));
}

#[divan::bench(args = TILES, sample_count = 5)]
fn stage_6_svg(bencher: Bencher<'_, '_>, tiles: u32) {
    let (canvas, paint) = scene(tiles);
    let drawing = drawing(&canvas, &paint, &stages(&canvas, &paint));
    bencher.counter(ItemsCount::new(tiles)).bench(|| kakeami::back::svg::write(&drawing, None, &mut std::io::sink()));
}
