//! How long it takes from a slider's move to the new picture on the screen, in headless Chromium: `cargo bench --bench
//! preview`. Asked are 50 ms for small scenes and 300 ms for 20,000 tiles.
//!
//! The time is the browser's own: from the slider's input event to the paint of the picture (of its last tile) as the browser
//! presents it.

#![allow(clippy::print_stdout, clippy::expect_used, clippy::panic)]

#[path = "../tests/browser.rs"]
mod browser;

use std::fs;

use browser::{Page, Server};

/// How often each slider is moved.
const MOVES: usize = 30;

/// A sheet of about 20,000 tiles.
const LARGE: &str = "canvas { size: (300mm, 200mm) }
seed 1
param tile: length = 2.2mm in 2.15mm .. 2.25mm
tone sheet {
  place: poisson(radius: tile / 1.6)
  shape: rect(size: tile)
  angle: bfs()
  fill: lines(pitch: 0.6mm, pen: 0.1mm)
  k: 2
}
paint canvas with sheet
";

/// The first scene of all with a slider.
const SMALL: &str = "param tile: length = 6mm in 4mm .. 8mm\ncanvas { size: (60mm, 60mm) }\nseed 42\ntone plain {\n  \
                     place: poisson(radius: tile)\n  shape: rect()\n  angle: bfs()\n  fill: lines(pitch: 0.8mm, pen: 0.2mm)\n  \
                     k: 2\n}\npaint canvas with plain\n";

/// Moves the first slider by a step and waits for the paint of what comes of it.
const MOVE: &str = "await new Promise((resolve) => {
    const slider = document.querySelector('.param input[type=range]');
    let start = 0, last = 0, timer = 0;
    const seen = new PerformanceObserver((list) => {
        for (const { renderTime, startTime } of list.getEntries()) last = Math.max(last, renderTime || startTime);
        clearTimeout(timer);
        timer = setTimeout(() => { seen.disconnect(); resolve(last - start); }, 300);
    });
    seen.observe({ type: 'element' });
    const isHigh = Number(slider.value) > (Number(slider.min) + Number(slider.max)) / 2;
    slider.value = Number(slider.value) + (isHigh ? -1 : 1) * Number(slider.step) * (1 + Math.floor(Math.random() * 40));
    start = performance.now();
    slider.dispatchEvent(new Event('input', { bubbles: true }));
})";

fn main() {
    let paper =
        fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/examples/paper.kake")).expect("the example is there");
    println!("{:<22} {:>7} {:>8} {:>8} {:>8} {:>9}", "scene", "tiles", "median", "slowest", "server", "requests");
    for (name, scene) in [("hello, with a slider", SMALL), ("paper.kake", &paper), ("20,000 tiles", LARGE)] {
        measure(name, scene);
    }
}

fn measure(name: &str, scene: &str) {
    let server = Server::start(scene);
    let Some(page) = Page::open(&server.address, server.path("profile")) else {
        println!("no Chromium is here");
        return;
    };
    let before = page.requests.lock().expect("nothing panics").len();
    let mut times: Vec<f64> = (0..MOVES).map(|_| page.ask(MOVE).parse().expect("times are numbers")).collect();
    times.sort_by(f64::total_cmp);
    // A move asks for the drawing and for its picture, or its tiles.
    let requests = (page.requests.lock().expect("nothing panics").len() - before) / MOVES;
    let figures = page.ask("document.querySelector('#figures').textContent");
    let tiles = figures.split(' ').next().unwrap_or_default();
    let server = figures.rsplit(" · ").next().unwrap_or_default();
    let slowest = times.last().copied().unwrap_or_default();
    println!("{name:<22} {tiles:>7} {:>5.0} ms {slowest:>5.0} ms {server:>8} {requests:>9}", times[times.len() / 2]);
}
