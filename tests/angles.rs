//! Angle rules on the graphs of the report: 100 Poisson placements of about 69 tiles, seeds 0 to 99.
//!
//! The tables of `docs/angles.md` are measured here, so that they are true. Run with `KAKE_PICTURES=write` to write them
//! and the curves anew.

use std::collections::VecDeque;
use std::fs;
use std::sync::LazyLock;

use kakeami::chart::{Look, Series, Spot, Titles, lines};
use kakeami::geom::Angle;
use kakeami::loader::MemoryLoader;
use kakeami::lower::{LowerConfig, lower};
use kakeami::pass::{link, place, turn};
use kakeami::scene::{Limits, Paint};
use kakeami::stage::{Angles, Graph, Sites};
use kakeami::stop::Stop;
use rayon::prelude::*;

use crate::support::{here, shown};

const PAGE: &str = "docs/angles.md";

/// The graphs of the report, each with the seed of its paint.
static GRAPHS: LazyLock<Vec<(Sites, Graph)>> = LazyLock::new(|| {
    let (canvas, paint) = paint("poisson(radius: 0.6)", "random", 1);
    let placed = |seed| {
        let sites = place::place(&Paint { seed, ..paint.clone() }, &canvas, &Limits::default()).expect("few tiles");
        let graph = link::link(&sites, paint.tone.link);
        (sites, graph)
    };
    (0..100).map(placed).collect()
});

/// A paint of the report's canvas.
fn paint(place: &str, rule: &str, k: u8) -> (kakeami::scene::Canvas, Paint) {
    let text = format!(
        "canvas {{ size: (6, 6) }}
         tone plate {{ place: {place} bleed: 0 angle: {rule} fill: lines(pitch: 0.08) k: {k} }}
         paint canvas with plate"
    );
    let mut loader = MemoryLoader::default();
    loader.files.insert("scene.kake".to_owned(), text.into_bytes().into());
    let lowered = lower("scene.kake", &loader, &LowerConfig::default());
    let said = shown(&lowered.diagnostics, &lowered.sources);
    let scene = lowered.scene.expect(&said);
    let paint = kakeami::paints(&scene).next().expect("it paints once").clone();
    (scene.canvas, paint)
}

/// What is measured of one graph.
#[derive(Debug, Clone, Copy, Default)]
struct Figures {
    e_contrast: f64,
    e_share: f64,
    p5: f64,
    min: f64,
    h_angle: f64,
    h_angle_mean: f64,
    r: [f64; 3],
}

impl Figures {
    const COUNT: usize = 9;

    fn list(&self) -> [f64; Self::COUNT] {
        let [r1, r2, r3] = self.r;
        [self.e_contrast, self.e_share, self.p5, self.min, self.h_angle, self.h_angle_mean, r1, r2, r3]
    }

    fn new(graph: &Graph, angles: &[Angle]) -> Self {
        let contrast = |[a, b]: [u32; 2]| angles[a as usize].rp1_distance(angles[b as usize]).to_radians() / RIGHT;
        let mut contrasts: Vec<f64> = graph.edges().map(contrast).collect();
        contrasts.sort_by(f64::total_cmp);
        let links = contrasts.len() as f64;
        let e_contrast = contrasts.iter().sum::<f64>() / links;
        let triangles = graph.triangles.len() as f64;
        let hull = 2.0 * links - 3.0 * triangles;
        let turned = (0..24).map(|turn| entropy(angles, f64::from(turn) / 288.0));
        Self {
            e_contrast,
            e_share: e_contrast * 2.0 * links / (2.0 * triangles + hull),
            p5: fifth(&contrasts),
            min: contrasts[0],
            h_angle: entropy(angles, 0.0),
            h_angle_mean: turned.sum::<f64>() / 24.0,
            r: correlations(graph, angles),
        }
    }
}

const RIGHT: f64 = std::f64::consts::FRAC_PI_2;

/// The 5th percentile of sorted numbers.
fn fifth(sorted: &[f64]) -> f64 {
    let place = 0.05 * (sorted.len() - 1) as f64;
    let (below, above) = (sorted[place.floor() as usize], sorted[place.ceil() as usize]);
    below + (above - below) * place.fract()
}

/// Entropy over twelve bins, of angles that are turned by a share of pi.
fn entropy(angles: &[Angle], turned: f64) -> f64 {
    let mut bins = [0.0; 12];
    for angle in angles {
        let place = (angle.to_radians() / std::f64::consts::PI + turned).fract() * 12.0;
        bins[(place as usize).min(11)] += 1.0 / angles.len() as f64;
    }
    bins.iter().filter(|&&p| p > 0.0).map(|&p| -p * libm::log(p)).sum::<f64>() / libm::log(12.0)
}

/// R1, R2 and R3.
fn correlations(graph: &Graph, angles: &[Angle]) -> [f64; 3] {
    let (mut sums, mut counts) = ([0.0; 3], [0.0; 3]);
    for start in 0..graph.len() {
        let mut links = vec![usize::MAX; graph.len()];
        links[start] = 0;
        let mut queue = VecDeque::from([start]);
        while let Some(site) = queue.pop_front() {
            if links[site] > 0 {
                sums[links[site] - 1] += ((angles[start] - angles[site]) * 2.0).unit().x;
                counts[links[site] - 1] += 1.0;
            }
            for &other in graph.neighbours(site) {
                if links[other as usize] == usize::MAX && links[site] < 3 {
                    links[other as usize] = links[site] + 1;
                    queue.push_back(other as usize);
                }
            }
        }
    }
    [0, 1, 2].map(|k| sums[k] / counts[k])
}

/// The angles of a rule on every graph.
fn turned(rule: &str, k: u8) -> Vec<Vec<Angle>> {
    let (_, paint) = paint("poisson(radius: 0.6)", rule, k);
    let paints: Vec<Paint> = (0..100).map(|seed| Paint { seed, ..paint.clone() }).collect();
    let turned = paints.par_iter().zip(&*GRAPHS).map(|(paint, (sites, graph))| {
        let Angles(angles) = turn::turn(paint, sites, graph, &Stop::default());
        angles
    });
    turned.collect()
}

/// What is measured of a rule on every graph.
fn measured(rule: &str) -> Vec<Figures> {
    turned(rule, 1).iter().zip(&*GRAPHS).map(|(angles, (_, graph))| Figures::new(graph, angles)).collect()
}

fn mean(figures: &[Figures]) -> [f64; Figures::COUNT] {
    let mut means = [0.0; Figures::COUNT];
    for figures in figures {
        for (mean, figure) in means.iter_mut().zip(figures.list()) {
            *mean += figure;
        }
    }
    means.map(|sum| sum / figures.len() as f64)
}

/// The rules of the page's first table.
const RULES: [&str; 9] = [
    "random",
    "bfs",
    "coloured(4)",
    "tuned",
    "tuned(grain: 0.15, least: 0.46)",
    "tuned(grain: 5.4, least: 0.386)",
    "tuned(grain: 0, least: 0.42, diversity: 5)",
    "tuned(grain: 0, least: 0.03)",
    "tuned(rounds: 50)",
];

/// Holds a part of the page, between two comments, against what it should be, or writes it.
fn hold(name: &str, text: &str) {
    let page = fs::read_to_string(here(PAGE)).expect("the page is there");
    let (start, end) = (format!("<!-- {name} -->\n"), format!("<!-- end of {name} -->"));
    let (before, rest) = page.split_once(&start).expect("the part begins");
    let (there, after) = rest.split_once(&end).expect("the part ends");
    if std::env::var("KAKE_PICTURES").is_ok_and(|value| value == "write") {
        fs::write(here(PAGE), format!("{before}{start}{text}{end}{after}")).expect("the page can be written");
    } else {
        assert_eq!(there, text, "{PAGE}: {name}");
    }
}

#[test]
fn the_page_s_tables_are_measured() {
    let mut table = String::from(
        "| angles | e_contrast | e_share | p5_contrast | min_contrast | h_angle | h_angle_mean | R1 | R2 | R3 | beats bfs |\n\
         |---|---|---|---|---|---|---|---|---|---|---|\n",
    );
    let bfs = measured("bfs");
    for rule in RULES {
        let figures = measured(rule);
        let means = mean(&figures).map(|figure| format!("{figure:.3}").replace("-0.000", "0.000"));
        let wins = figures.iter().zip(&bfs).filter(|(a, b)| {
            a.e_contrast > b.e_contrast && a.p5 > b.p5 && a.h_angle > b.h_angle && a.r[1].abs() < b.r[1].abs()
        });
        let wins = wins.count();
        table += &format!("| `{rule}` | {} | {wins} |\n", means.join(" | "));
        if rule == "tuned" {
            assert!(wins >= 95, "{wins} of 100");
            let [e_contrast, _, p5, min, h_angle, _, _, r2, r3] = mean(&figures);
            assert!(e_contrast >= 0.6615 && p5 >= 0.394 && min >= 0.378 && h_angle >= 0.995, "{table}");
            assert!(r2.abs() <= 0.124 && r3.abs() <= 0.016, "{table}");
        }
    }
    hold("rules", &table);
}

#[test]
fn what_the_eye_sees_is_told_apart() {
    let mut table = String::from(
        "| k | angles | neighbours within 10° (5° at k 3 and 4) | mean distance | p5 |\n|---|---|---|---|---|\n",
    );
    for k in [1, 2, 3, 4] {
        for rule in ["bfs", "bfs(see: layers)", "tuned", "tuned(see: layers)"] {
            let near = if k < 3 { 10.0 } else { 5.0 };
            let (mut within, mut links, mut sum, mut fifths) = (0.0, 0.0, 0.0, 0.0);
            for (angles, (_, graph)) in turned(rule, k).iter().zip(&*GRAPHS) {
                let distance = |[a, b]: [u32; 2]| {
                    let distance = angles[a as usize].layered_distance(k, angles[b as usize], k);
                    distance.expect("tiles have layers").to_radians().to_degrees()
                };
                let mut distances: Vec<f64> = graph.edges().map(distance).collect();
                distances.sort_by(f64::total_cmp);
                within += distances.iter().filter(|&&distance| distance < near - 1e-9).count() as f64;
                links += distances.len() as f64;
                sum += distances.iter().sum::<f64>();
                fifths += fifth(&distances) / 100.0;
            }
            let share = within / links * 100.0;
            table += &format!("| {k} | `{rule}` | {share:.1} % | {:.1}° | {fifths:.1}° |\n", sum / links);
            assert!(!rule.contains("layers") || share < 0.1, "{rule}: {share} %");
        }
    }
    hold("layers", &table);
}

/// Means of a rule with an argument at several values.
fn curve(rule: impl Fn(f64) -> String, values: &[f64], place: impl Fn([f64; Figures::COUNT]) -> [f64; 2]) -> Vec<Spot> {
    values
        .iter()
        .map(|&value| {
            let [x, y] = place(mean(&measured(&rule(value))));
            Spot { x, y, band: None }
        })
        .collect()
}

/// The curves take longer than a test may, so they are only drawn when they are to be written.
#[test]
fn curves_show_what_is_weighed() {
    let is_written = std::env::var("KAKE_PICTURES").is_ok_and(|value| value == "write");
    let page = fs::read_to_string(here(PAGE)).expect("the page is there");
    for (name, chart) in [("angles-fusion", fusion as fn() -> String), ("angles-repetition", repetition)] {
        let path = here("docs/pictures").join(format!("{name}.svg"));
        assert!(page.contains(&format!("(pictures/{name}.svg)")), "{PAGE} shows {name}");
        if is_written {
            fs::write(path, chart()).expect("the picture can be written");
        } else {
            assert!(path.is_file(), "{} is not there: write the pictures", path.display());
        }
    }
}

fn series(name: &str, look: Look, spots: Vec<Spot>) -> Series<'_> {
    Series { name, look, spots }
}

fn fusion() -> String {
    let place = |f: [f64; Figures::COUNT]| [f[5], f[2]];
    let weights = [0.0, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0];
    let apart = curve(|d| format!("tuned(diversity: {d}, least: 0.5, grain: 0)"), &weights, place);
    let usual = curve(|d| format!("tuned(diversity: {d})"), &weights, place);
    lines(
        &Titles {
            title: "No fusion against many directions",
            x: "h_angle_mean, as diversity grows from 0 to 30",
            y: "p5_contrast",
        },
        &[
            series("tuned(least: 0.5, grain: 0)", Look::Joined, apart),
            series("tuned", Look::Joined, usual),
            series("bfs", Look::Markers, curve(|_| "bfs".to_owned(), &[0.0], place)),
            series("random", Look::Markers, curve(|_| "random".to_owned(), &[0.0], place)),
        ],
        None,
    )
}

fn repetition() -> String {
    let place = |f: [f64; Figures::COUNT]| [f[7].abs(), f[0]];
    let weights = [8.0, 6.0, 4.0, 2.0, 1.0, 0.5, 0.0];
    let usual = curve(|g| format!("tuned(grain: {g})"), &weights, place);
    let free = curve(|g| format!("tuned(grain: {g}, least: 0)"), &weights, place);
    lines(
        &Titles { title: "Contrast against repetition", x: "|R2|, as grain falls from 8 to 0", y: "e_contrast" },
        &[
            series("tuned", Look::Joined, usual),
            series("tuned(least: 0)", Look::Joined, free),
            series("coloured(4)", Look::Markers, curve(|_| "coloured(4)".to_owned(), &[0.0], place)),
            series("bfs", Look::Markers, curve(|_| "bfs".to_owned(), &[0.0], place)),
        ],
        None,
    )
}
