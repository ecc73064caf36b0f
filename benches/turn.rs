//! How long it takes to turn tiles: `cargo bench --bench turn`. The items are tiles, so that the throughput says whether
//! the time grows in step with them; `tuned` runs its 300 rounds, on one thread and on all.

mod support;

use divan::Bencher;
use divan::counter::ItemsCount;
use kakeami::pass::{link, place, turn};
use kakeami::scene::{Limits, Paint};
use kakeami::stage::{Graph, Sites};
use kakeami::stop::Stop;

/// About how many tiles there are.
const TILES: [u32; 3] = [100, 10_000, 100_000];

fn main() {
    divan::main();
}

/// So many tiles that are turned by a rule, placed and linked.
fn placed(rule: &str, tiles: u32) -> (Paint, Sites, Graph) {
    // A disk of Poisson's takes 0.57 square millimetres at a radius of 0.6.
    let side = (f64::from(tiles) * 0.57).sqrt();
    let text = format!(
        "canvas {{ size: ({side}mm, {side}mm) }}
         tone plate {{ place: poisson(radius: 0.6mm) angle: {rule} bleed: 0mm fill: lines(pitch: 0.1mm) k: 2 }}
         paint canvas with plate"
    );
    let (canvas, paint) = support::painted(&text);
    let sites = place::place(&paint, &canvas, &Limits::default());
    let sites = sites.unwrap_or_else(|_| unreachable!("the tiles are within the limit"));
    let graph = link::link(&sites, paint.tone.link);
    (paint, sites, graph)
}

/// Turns tiles on so many threads, 0 for one a core.
fn turned(bencher: Bencher<'_, '_>, rule: &str, tiles: u32, threads: usize) {
    let (paint, sites, graph) = placed(rule, tiles);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.unwrap_or_else(|error| unreachable!("{error}"));
    let bencher = bencher.counter(ItemsCount::new(sites.points.len()));
    bencher.bench(|| pool.install(|| turn::turn(&paint, &sites, &graph, &Stop::default())));
}

#[divan::bench(args = TILES, sample_count = 3, sample_size = 1)]
fn tuned_on_one_thread(bencher: Bencher<'_, '_>, tiles: u32) {
    turned(bencher, "tuned()", tiles, 1);
}

#[divan::bench(args = TILES, sample_count = 3, sample_size = 1)]
fn tuned_on_all_threads(bencher: Bencher<'_, '_>, tiles: u32) {
    turned(bencher, "tuned()", tiles, 0);
}

#[divan::bench(args = TILES, sample_count = 3, sample_size = 1)]
fn tuned_to_all_layers(bencher: Bencher<'_, '_>, tiles: u32) {
    turned(bencher, "tuned(see: layers)", tiles, 1);
}

#[divan::bench(args = TILES, sample_count = 3, sample_size = 1)]
fn coloured(bencher: Bencher<'_, '_>, tiles: u32) {
    turned(bencher, "coloured(4)", tiles, 1);
}

#[divan::bench(args = TILES, sample_count = 3, sample_size = 1)]
fn bfs(bencher: Bencher<'_, '_>, tiles: u32) {
    turned(bencher, "bfs()", tiles, 1);
}
