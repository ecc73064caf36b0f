//! What it costs a page to repeat, from scene to drawing: `cargo bench --bench repeat`.

use divan::Bencher;
use kakeami::loader::MemoryLoader;
use kakeami::{Config, compile};

/// Shapes, each with a ground that looks at every gap or none.
const SHAPES: [&str; 3] = ["rect(size: 6mm)", "voronoi(inset: 0.1mm)", "rect(size: 4mm) ground: nearest"];

fn main() {
    divan::main();
}

fn run(bencher: Bencher<'_, '_>, shape: &str, repeat: &str) {
    let text = format!(
        "canvas {{ size: (200mm, 200mm), repeat: {repeat} }}
         seed 1
         tone page {{ place: poisson(radius: 3.6mm) shape: {shape} angle: bfs() fill: lines(pitch: 0.7mm) k: 2 }}
         paint canvas with page"
    );
    let mut loader = MemoryLoader::default();
    loader.files.insert("bench.kake".to_owned(), text.into_bytes().into());
    bencher.bench_local(|| {
        let compiled = compile("bench.kake", &loader, &Config::default(), &mut ());
        assert!(compiled.drawing.is_some());
    });
}

#[divan::bench(args = SHAPES, sample_count = 20)]
fn with_an_end(bencher: Bencher<'_, '_>, shape: &str) {
    run(bencher, shape, "false");
}

#[divan::bench(args = SHAPES, sample_count = 20)]
fn repeating(bencher: Bencher<'_, '_>, shape: &str) {
    run(bencher, shape, "true");
}
