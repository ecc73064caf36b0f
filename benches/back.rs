//! How fast drawings become files: an A4 page of short strokes, ten to a tile.

use std::io;

use divan::Bencher;
use divan::counter::ItemsCount;
use kakeami::back::plot::plot;
use kakeami::back::{pdf, png, svg};
use kakeami::drawing::{Drawing, Layer, Page, Strokes};
use kakeami::geom::{Length, Point, Vec2};
use kakeami::random::Key;
use kakeami::scene::{Cap, Colour, Depth};

fn main() {
    divan::main();
}

/// So many strokes of 2 mm with a pen of 0.1 mm, on A4 at 600 pixels an inch.
fn page(strokes: usize, depth: Depth) -> Drawing {
    let (width, height) = (210.0, 297.0);
    let mut random = Key { seed: 1, name: "page", purpose: "bench" }.stream();
    let mut layer = Strokes::new(Length::mm(0.1), Cap::Butt);
    for _ in 0..strokes / 10 {
        let site = Point::new(random.unit() * width, random.unit() * height);
        let (sin, cos) = libm::sincos(random.unit() * std::f64::consts::PI);
        let (along, across) = (Vec2::new(cos, sin), Vec2::new(-sin, cos));
        for line in 0..10 {
            let middle = site + across * (f64::from(line) * 0.2 - 0.9);
            layer.lines.push([middle + -along, middle + along]);
        }
        layer.bundle_ends.push(layer.lines.len());
    }
    Drawing {
        page: Page {
            width: Length::mm(width),
            height: Length::mm(height),
            bleed: Length::ZERO,
            pixels: [4961, 7016],
            dpi: 600.0,
            paper: Some(Colour::WHITE),
            depth,
        },
        layers: vec![Layer { strokes: vec![layer], ..Layer::new(Vec::new(), "page".to_owned(), Colour::BLACK) }],
    }
}

#[divan::bench(args = [1, 2], sample_count = 10)]
fn svg_text(bencher: Bencher<'_, '_>, threads: usize) {
    let drawing = page(1_500_000, Depth::Eight);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let write = || {
        let written = svg::write(&drawing, None, &mut io::sink());
        assert!(written.is_ok());
    };
    bencher.counter(ItemsCount::new(1_500_000_usize)).bench_local(|| match &pool {
        Ok(pool) => pool.install(write),
        Err(_) => write(),
    });
}

#[divan::bench(args = [Depth::Eight, Depth::One], sample_count = 5)]
fn png_of_a_page(bencher: Bencher<'_, '_>, depth: Depth) {
    let drawing = page(100_000, depth);
    bencher.bench_local(|| {
        let written = png::write(&drawing, None, &mut io::sink());
        assert!(written.is_ok());
    });
}

#[divan::bench(sample_count = 5)]
fn pixels_of_a_page(bencher: Bencher<'_, '_>) {
    let drawing = page(100_000, Depth::Eight);
    bencher.bench_local(|| kakeami::back::raster::render(&drawing));
}

#[divan::bench(args = [1, 2], sample_count = 5)]
fn pdf_of_strokes(bencher: Bencher<'_, '_>, threads: usize) {
    let drawing = page(1_000_000, Depth::Eight);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let write = || {
        let written = pdf::write(&drawing, None, &mut io::sink());
        assert!(written.is_ok());
    };
    bencher.counter(ItemsCount::new(1_000_000_usize)).bench_local(|| match &pool {
        Ok(pool) => pool.install(write),
        Err(_) => write(),
    });
}

#[divan::bench(args = [10_000, 100_000], sample_count = 3)]
fn plot_of_strokes(bencher: Bencher<'_, '_>, strokes: usize) {
    let drawing = page(strokes, Depth::Eight);
    bencher.counter(ItemsCount::new(strokes)).bench_local(|| plot(&drawing));
}
