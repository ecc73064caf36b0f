//! Grain over patterns: what comes first, and what changes nothing.

mod patterns;

use kakeami::geom::{Angle, Point, Vec2};
use kakeami::metrics::{Measured, grain};
use kakeami::stats::paired_t;
use rayon::prelude::*;

use patterns::{BETTER, PROPOSED, Page, Pattern, UNTOLD, WORSE};

/// The grain of a pattern over seeds.
fn grains(pattern: &Pattern, page: Page, seeds: u64) -> Vec<f64> {
    let grain = |seed| grain::measure(&pattern.measured(page, seed)).grain;
    (0..seeds).into_par_iter().map(|seed| grain(seed).unwrap_or(0.0)).collect()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// The proposed pattern comes before all that look worse and after those that look better, by a test of Student's whose
/// level leaves room for all the patterns.
fn comes_first(page: Page, seeds: u64) {
    let first = grains(&PROPOSED, page, seeds);
    let mut firsts = vec![true; seeds as usize];
    for pattern in WORSE {
        let others = grains(&pattern, page, seeds);
        let test = paired_t(&first, &others).unwrap();
        let level = 0.01 / WORSE.len() as f64;
        assert!(test.difference > 0.0 && test.p < level, "{}: {test:?}", pattern.name);
        firsts.iter_mut().zip(first.iter().zip(&others)).for_each(|(is, (first, other))| *is &= first > other);
    }
    let share = firsts.iter().filter(|&&is| is).count() as f64 / seeds as f64;
    assert!(share >= 0.9, "first of all on {share} of the seeds");
    for pattern in BETTER {
        let others = grains(&pattern, page, seeds);
        assert!(mean(&others) >= mean(&first), "{}: {} before {}", pattern.name, mean(&first), mean(&others));
    }
}

#[test]
fn seventy_tiles_are_enough() {
    comes_first(Page::square(69), 20);
}

#[test]
fn beyond_the_outline_tiles_may_go_on() {
    comes_first(Page { bleed: 2.0, ..Page::square(150) }, 10);
}

/// What grain does not see, and the page on it admits: a dozen directions are as good to it as many.
#[test]
fn a_dozen_directions_pass_for_many() {
    let first = mean(&grains(&PROPOSED, Page::square(150), 6));
    for pattern in UNTOLD {
        let other = mean(&grains(&pattern, Page::square(150), 6));
        assert!((first - other).abs() < 0.05, "{}: {first} {other}", pattern.name);
    }
}

/// A pattern that is turned tile by tile, moved and scaled.
fn changed(measured: &Measured, turn: Angle, by: Vec2, factor: f64) -> Measured {
    let origin = Point::default();
    let place = |p: &Point| origin + (*p - origin) * factor + by;
    Measured {
        region: measured.region.scaled([factor; 2], origin).translated(by),
        sites: measured.sites.iter().map(place).collect(),
        angles: measured.angles.iter().map(|&angle| (angle + turn).direction()).collect(),
        ..measured.clone()
    }
}

#[test]
fn turning_moving_and_scaling_change_nothing() {
    for pattern in BETTER.into_iter().chain(WORSE).chain([PROPOSED]) {
        let measured = pattern.measured(Page::square(69), 7);
        let grain = grain::measure(&measured).grain.unwrap();
        assert!((0.0..=1.0).contains(&grain), "{}: {grain}", pattern.name);
        for (degrees, by, factor) in [(33.0, [0.0, 0.0], 1.0), (0.3, [-17.3, 4e3], 0.01), (91.7, [0.0, 1.0], 321.0)] {
            let changed = changed(&measured, Angle::degrees(degrees), Vec2::new(by[0], by[1]), factor);
            let other = grain::measure(&changed).grain.unwrap();
            // Where lattices have no grain but by rounding, its root is not as small.
            assert!((grain - other).abs() < 1e-6 || grain.max(other) < 1e-2, "{}: {grain} {other}", pattern.name);
        }
    }
}

#[test]
fn layers_and_the_seed_s_name_change_nothing() {
    let mut measured = PROPOSED.measured(Page::square(69), 1);
    let before = grain::measure(&measured);
    measured.k.iter_mut().for_each(|k| *k = 4.0);
    measured.name.push('!');
    assert_eq!(grain::measure(&measured), before);
}

#[test]
fn any_region_has_a_grain_and_a_page_that_repeats() {
    let square = Page::square(150);
    let ring = "circle(center: (30mm, 30mm), radius: 30mm) - circle(center: (30mm, 30mm), radius: 12mm)";
    let pages = [
        Page { region: ring, bleed: 1.0, ..square },
        Page { size: [240.0, 15.0], ..square },
        Page { repeat: true, ..square },
    ];
    for page in pages {
        let first = grains(&PROPOSED, page, 5);
        assert!(first.iter().all(|grain| (0.85..1.0).contains(grain)), "{page:?}: {first:?}");
        let hex = patterns::WORSE.iter().find(|pattern| pattern.name == "turned hex lattice + bfs").unwrap();
        // A lattice has a fault where a page repeats.
        assert!(page.repeat || mean(&grains(hex, page, 5)) < 0.5, "{page:?}");
    }
}

#[test]
fn too_little_has_no_grain() {
    let few = grain::measure(&PROPOSED.measured(Page::square(5), 0));
    assert_eq!(few, grain::Grain::default());
    let mut loose = PROPOSED.measured(Page::square(69), 0);
    loose.graph = kakeami::stage::Graph::new(loose.sites.len(), &[], Vec::new());
    let loose = grain::measure(&loose);
    assert_eq!((loose.grain, loose.grain_contrast, loose.grain_directions), (None, None, None));
    // Sites still lie as they do.
    assert!(loose.grain_evenness.is_some());
    let mut row = PROPOSED.measured(Page::square(69), 0);
    row.sites.iter_mut().for_each(|p| p.y = 1.0);
    row.graph.triangles.clear();
    assert_eq!(grain::measure(&row).grain, None);
}
