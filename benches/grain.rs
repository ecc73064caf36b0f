//! The table of `docs/grain.md`: how patterns rank by grain, over seeds and numbers of tiles.
//!
//! `cargo bench --bench grain` prints it for seeds 0 to 99 on the report's square page;
//! `cargo bench --bench grain -- circle 300 100 50` for another page, number of tiles, first seed and number of seeds.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout)]

#[path = "../tests/grain/patterns.rs"]
mod patterns;

use std::time::Instant;

use kakeami::metrics::grain::{self, Grain};
use kakeami::stats::{holm, paired_t, summary, wilcoxon_signed_rank};
use rayon::prelude::*;

use patterns::{BETTER, PROPOSED, Page, Pattern, UNTOLD, WORSE};

/// A page by its name.
fn page(name: &str, tiles: u32) -> Page {
    let square = Page::square(tiles);
    match name {
        "square" => square,
        "oblong" => Page { size: [120.0, 40.0], ..square },
        // A disc has pi / 4 of the page's tiles.
        "circle" => {
            Page { region: "circle(center: (30mm, 30mm), radius: 30mm)", bleed: 2.0, tiles: tiles * 14 / 11, ..square }
        }
        "bleed" => Page { bleed: 2.0, ..square },
        "repeat" => Page { repeat: true, ..square },
        _ => panic!("no page is called {name}: square, oblong, circle, bleed, repeat"),
    }
}

/// The figures of one pattern over seeds.
fn measures(pattern: &Pattern, page: Page, seeds: &[u64]) -> Vec<Grain> {
    seeds.par_iter().map(|&seed| grain::measure(&pattern.measured(page, seed))).collect()
}

/// One figure of all seeds, 0 where there is none.
fn column(grains: &[Grain], figure: impl Fn(&Grain) -> Option<f64>) -> Vec<f64> {
    grains.iter().map(|grain| figure(grain).unwrap_or(0.0)).collect()
}

fn table(name: &str, tiles: u32, seeds: &[u64]) {
    let page = page(name, tiles);
    let start = Instant::now();
    println!("\n{name} page, about {tiles} tiles, seeds {} to {}\n", seeds[0], seeds[seeds.len() - 1]);
    println!(
        "| pattern | grain | SD | less than poisson + bfs by | t | p (Holm) | Wilcoxon | behind | contrast | directions | evenness | disorder | looseness |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|---|");
    let base = measures(&PROPOSED, page, seeds);
    let first = column(&base, |grain| grain.grain);
    // Tilings that never repeat do not on a page that does, and its checkerboard may not close.
    let does_repeat =
        |pattern: &Pattern| !["penrose", "pinwheel", "checkerboard"].iter().any(|it| pattern.name.contains(it));
    let patterns = BETTER.into_iter().chain(UNTOLD).chain(WORSE).filter(|pattern| !page.repeat || does_repeat(pattern));
    let rows: Vec<(Pattern, Vec<Grain>)> = patterns.map(|pattern| (pattern, measures(&pattern, page, seeds))).collect();
    let grains: Vec<Vec<f64>> = rows.iter().map(|(_, grains)| column(grains, |grain| grain.grain)).collect();
    let others = BETTER.len() + UNTOLD.len();
    let worse = &grains[others..];
    let t: Vec<f64> = worse.iter().map(|other| paired_t(&first, other).map_or(f64::NAN, |test| test.p)).collect();
    let w: Vec<f64> =
        worse.iter().map(|other| wilcoxon_signed_rank(&first, other).map_or(f64::NAN, |test| test.p)).collect();
    let (t, w) = (holm(&t), holm(&w));
    let print = |name: &str, grains: &[Grain], tests: [String; 5]| {
        let all = summary(&column(grains, |grain| grain.grain)).expect("there are seeds");
        let mean = |figure: fn(&Grain) -> Option<f64>| summary(&column(grains, figure)).expect("there are seeds").mean;
        println!(
            "| {name} | {:.3} | {:.3} | {} | {:.3} | {:.3} | {:.3} | {:.3} | {:.3} |",
            all.mean,
            all.sd.unwrap_or(0.0),
            tests.join(" | "),
            mean(|grain| grain.grain_contrast),
            mean(|grain| grain.grain_directions),
            mean(|grain| grain.grain_evenness),
            mean(|grain| grain.grain_disorder),
            mean(|grain| grain.grain_looseness),
        );
    };
    print(PROPOSED.name, &base, std::array::from_fn(|_| String::new()));
    for (row, (pattern, grains_of)) in rows.iter().enumerate() {
        let test = paired_t(&first, &grains[row]);
        let behind = first.iter().zip(&grains[row]).filter(|(first, other)| first > other).count();
        let adjusted = |p: &[f64]| row.checked_sub(others).map_or(String::new(), |row| format!("{:.1e}", p[row]));
        let tests = [
            test.map_or(String::new(), |test| format!("{:.3}", test.difference)),
            test.map_or(String::new(), |test| format!("{:.1}", test.t)),
            adjusted(&t),
            adjusted(&w),
            format!("{behind}"),
        ];
        print(pattern.name, grains_of, tests);
    }
    let before_all = (0..seeds.len()).filter(|&seed| worse.iter().all(|other| first[seed] > other[seed])).count();
    println!(
        "\nFirst of all that should come after it on {before_all} of {} seeds; {:.0?}.",
        seeds.len(),
        start.elapsed()
    );
}

/// How long the measure takes.
fn times() {
    for tiles in [69, 2000, 100_000] {
        let measured = PROPOSED.measured(Page::square(tiles), 0);
        let rounds = (200_000 / tiles).max(3);
        let best = (0..rounds).map(|_| {
            let start = Instant::now();
            assert!(grain::measure(&measured).grain.is_some());
            start.elapsed()
        });
        println!("{} tiles: {:?}", measured.sites.len(), best.min().expect("there are rounds"));
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| !argument.starts_with("--")).collect();
    let number =
        |place: usize, default: u64| arguments.get(place).map_or(default, |text| text.parse().expect("a number"));
    let seeds: Vec<u64> = (number(2, 0)..number(2, 0) + number(3, 100)).collect();
    match arguments.first() {
        Some(name) => table(name, number(1, 150) as u32, &seeds),
        None => {
            [69, 150, 300, 700, 2000].into_iter().for_each(|tiles| table("square", tiles, &seeds));
            times();
        }
    }
}
