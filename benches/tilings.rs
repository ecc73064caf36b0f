//! How long it takes to place and link a million cells of an inflation tiling: `cargo bench --bench tilings`. The items
//! are cells, so that the throughput says whether the time grows in step with them.

mod support;

use divan::Bencher;
use divan::counter::ItemsCount;
use kakeami::pass::{link, place};
use kakeami::scene::{Canvas, Limits, Paint};

/// About how many cells there are.
const CELLS: [u32; 3] = [10_000, 100_000, 1_000_000];

fn main() {
    divan::main();
}

/// A paint over so many cells, given the mean area of one in square edges.
fn scene(tiling: &str, area: f64, cells: u32) -> (Canvas, Paint) {
    let side = (f64::from(cells) * area).sqrt();
    let text = format!(
        "canvas {{ size: ({side}mm, {side}mm) }}
         seed 1
         tone plate {{ place: {tiling}(edge: 1mm) shape: cell() bleed: 0mm fill: lines(pitch: 0.2mm) }}
         paint canvas with plate"
    );
    support::painted(&text)
}

fn place_and_link(bencher: Bencher<'_, '_>, (canvas, paint): (Canvas, Paint), cells: u32) {
    bencher.counter(ItemsCount::new(cells)).bench(|| {
        let sites = place::place(&paint, &canvas, &Limits::default());
        sites.map(|sites| link::link(&sites, paint.tone.link)).ok()
    });
}

#[divan::bench(args = CELLS, sample_count = 5)]
fn penrose(bencher: Bencher<'_, '_>, cells: u32) {
    place_and_link(bencher, scene("penrose", 0.8123, cells), cells);
}

#[divan::bench(args = CELLS, sample_count = 5)]
fn pinwheel(bencher: Bencher<'_, '_>, cells: u32) {
    place_and_link(bencher, scene("pinwheel", 1.0, cells), cells);
}

#[divan::bench(args = CELLS, sample_count = 5)]
fn triangles(bencher: Bencher<'_, '_>, cells: u32) {
    place_and_link(bencher, scene("triangles", 0.433, cells), cells);
}
