use std::collections::BTreeMap;

use super::*;
use crate::experiment::{Bytes, Condition, Done, Factor, PaintFigures, ParamType, Plan};

/// An experiment of two by two conditions and a reference; `value` gives the measures of a run.
fn outcome(seeds: [u64; 2], paints: &[&str], value: impl Fn(usize, u64) -> Vec<(String, Option<f64>)>) -> Outcome {
    let factor =
        |param: &str, levels: [&str; 2]| Factor { param: param.to_owned(), levels: levels.map(str::to_owned).to_vec() };
    let factors = vec![factor("place", ["<poisson>", "uniform & co"]), factor("angles", ["bfs", "random"])];
    let condition = |name: String, levels| Condition { name, levels, sets: Vec::new(), labels: Vec::new() };
    let design = |a: usize, b: usize| {
        condition(format!("{} + {}", factors[0].levels[a], factors[1].levels[b]), Some(vec![a, b]))
    };
    let conditions = vec![design(0, 0), design(0, 1), design(1, 0), design(1, 1), condition("grid".to_owned(), None)];
    let params = vec![ParamType { name: "place".to_owned(), ty: "string".to_owned() }];
    let plan = Plan { name: "t<e>st".to_owned(), seeds, factors, params, conditions, pictures: vec![Vec::new()] };
    let runs = 0..plan.runs();
    let done: Vec<Done> = runs
        .map(|run| {
            let (condition, seed) = plan.run(run);
            let figures = |paint: &&str| PaintFigures { paint: (*paint).to_owned(), figures: value(condition, seed) };
            Done { run, found: Ok(paints.iter().map(figures).collect()) }
        })
        .collect();
    Outcome::new(plan, done)
}

fn recipe() -> Recipe {
    Recipe {
        version: "1.2.3".to_owned(),
        scene: "a<b>.kake".to_owned(),
        experiment: "test".to_owned(),
        seeds: None,
        sets: Vec::new(),
        dpi: None,
        only: None,
        limits: BTreeMap::new(),
        files: BTreeMap::from([("a<b>.kake".to_owned(), Bytes(b"// 1 < 2 && <script>".as_slice().into()))]),
        dependencies: BTreeMap::new(),
    }
}

fn figures(condition: usize, seed: u64) -> Vec<(String, Option<f64>)> {
    let value = condition as f64 * 0.1 + libm::sin(seed as f64 + condition as f64) * 0.01;
    let r = |k: u32| (format!("r{k}"), Some(value / f64::from(k)));
    [("e_contrast".to_owned(), Some(value)), ("xi".to_owned(), (condition != 1).then_some(value))]
        .into_iter()
        .chain((1..6).map(r))
        .collect()
}

#[test]
fn the_page_is_whole_and_alone() {
    let outcome = outcome([0, 5], &["plate"], figures);
    let report = report(&recipe(), &outcome, &[]);
    let page = &report.html;
    assert_eq!(report.html, super::report(&recipe(), &outcome, &[]).html);
    // Nothing is fetched and nothing runs.
    for alien in ["<script", "http://", "https://", "<link", "@import", "url("] {
        let page = page.replace("xmlns=\"http://www.w3.org/2000/svg\"", "");
        assert!(!page.contains(alien), "{alien}");
    }
    assert!(page.contains("// 1 &lt; 2 &amp;&amp; &lt;script&gt;"));
    assert!(page.contains("t&lt;e&gt;st") && page.contains("&lt;poisson&gt; + bfs"));
    assert!(!page.contains("NaN") && !page.contains("inf<"));
    // Every link leads somewhere on the page.
    for target in page.split("href=\"#").skip(1).filter_map(|rest| rest.split('"').next()) {
        assert!(page.contains(&format!("id=\"{target}\"")), "{target}");
    }
    // Charts have names of their own, and stand on the page.
    let mut files: Vec<&str> = report.figures.iter().map(|figure| figure.file.as_str()).collect();
    for kind in ["boxes-e_contrast.svg", "effect-e_contrast-place-angles.svg", "correlogram.svg", "cohen_d-xi.svg"] {
        assert!(files.contains(&kind), "{files:?}");
    }
    assert!(report.figures.iter().all(|figure| page.contains(&figure.svg)));
    files.sort_unstable();
    files.dedup();
    assert_eq!(files.len(), report.figures.len());
}

#[test]
fn the_best_condition_is_marked() {
    let outcome = outcome([0, 5], &["plate"], figures);
    let page = report(&recipe(), &outcome, &[]).html;
    let row = page.split("<code>e_contrast</code></th>").nth(1).and_then(|rest| rest.split("</tr>").next());
    let classes: Vec<bool> =
        row.unwrap_or_default().split("<td").skip(1).map(|td| td.starts_with(" class=\"best\"")).collect();
    assert_eq!(classes, [false, false, false, false, true]);
}

#[test]
fn what_cannot_be_said_is_noted() {
    let one_seed = outcome([3, 3], &["sky", "ground"], |condition, _| {
        vec![
            ("e_contrast".to_owned(), Some(0.5)),
            ("xi".to_owned(), (condition == 0).then_some(1.0)),
            ("never".to_owned(), None),
        ]
    });
    let page = report(&recipe(), &one_seed, &[]).html;
    assert!(page.contains("xi of ground in 1 of 1 runs of &lt;poisson&gt; + random"), "{page}");
    assert!(!page.contains("NaN"));
    assert!(page.contains("id=\"p2-m-e_contrast\""));
    let nothing = report(&recipe(), &outcome([0, 1], &[], |_, _| Vec::new()), &[]);
    assert!(nothing.figures.is_empty() && nothing.html.contains("How it was made"));
}
