//! Plans, journals and outcomes on their own.

use super::*;
use crate::Config;
use crate::loader::MemoryLoader;
use crate::lower::lower;
use crate::scene::Limits;

fn prepared(text: &str) -> Prepared {
    let mut loader = MemoryLoader::default();
    loader.files.insert("scene.kake".to_owned(), text.as_bytes().into());
    prepare("scene.kake", &loader, &Config::default(), &Request::default())
}

fn ready(text: &str) -> (Recipe, Plan) {
    let prepared = prepared(text);
    prepared.ready.unwrap_or_else(|| panic!("{:?}", prepared.lowered.diagnostics))
}

#[test]
fn levels_of_every_type_come_back_to_the_bit() {
    let (recipe, plan) = ready(
        r##"param s = "a" in ["a", "q\"\\\{b\} \n\u{7} é"]
        param n = 1
        param l = 3in in 1in .. 3in
        param a = 0.1rad
        param p = 7%
        param c = #123
        param b = false
        param xs = [1, 2]
        param at = (1mm, 2in)
        param r = 1 .. 2
        param place = hex(spacing: 3mm)
        let two = [poisson(radius: 2mm), grid(spacing: 2mm)]
        experiment e {
          seeds: 0 .. 0
          factors: { s: ["q\"\\\{b\} \n\u{7} é"], n: [0.1, -3], l: 3in, a: [1turn, -0.3rad], p: [0.1%, 33.3%],
            c: [#12345678, #fff], b: [true], xs: [[3, 4], []], at: [(1in, -2mm)], r: [0.5 .. 3], place: two }
          reference: [{ place: uniform(count: 5) }]
        }"##,
    );
    assert_eq!(plan.conditions.len(), 65);
    let first = &plan.conditions[0];
    assert_eq!(first.labels[0], "q\"\\{b} \n\u{7} é");
    for condition in &plan.conditions {
        let config = recipe.config(&[&condition.sets], Some(0));
        let lowered = lower(&recipe.scene, &recipe, &config.lower);
        let scene = lowered.scene.unwrap_or_else(|| panic!("{:?}", lowered.diagnostics));
        let experiment = &scene.experiments[0];
        let Some(levels) = &condition.levels else { continue };
        for (factor, &level) in experiment.factors.iter().zip(levels) {
            let value = &scene.params.iter().find(|param| param.name == factor.param).unwrap().value;
            let asked = &factor.levels[level];
            assert_eq!(value.number.map(f64::to_bits), asked.number.map(f64::to_bits), "{}", factor.param);
            // A placement has no text of its own.
            if factor.param != "place" {
                assert_eq!(value.text, asked.text);
            }
        }
    }
    assert_eq!(plan.conditions[64].sets[0].expression, "uniform(count: 5)");
    assert_eq!(plan.conditions[1].sets.last().unwrap().expression, "(two)[1]");
}

#[test]
fn conditions_are_named_apart() {
    let (_, plan) = ready(
        "param a = \"x\" in [\"x\", \"y\"] param k: number = 1
        experiment e { seeds: 7 .. 8 factors: { a: [\"x\", \"y\"], k: [1, 2] } reference: [{ a: \"x\", k: 1 }, {}] }",
    );
    let names: Vec<&str> = plan.conditions.iter().map(|condition| condition.name.as_str()).collect();
    assert_eq!(names, ["x + k 1", "x + k 2", "y + k 1", "y + k 2", "x + k 1 (2)", "e"]);
    assert_eq!(plan.conditions[5].labels, ["x", "1"]);
    assert_eq!((plan.runs(), plan.run(3), plan.run(10)), (12, (1, 8), (5, 7)));
    assert_eq!(plan.design().collect::<Vec<_>>(), [0, 1, 2, 3]);
    assert_eq!(plan.pictures, [Vec::new()]);
}

#[test]
fn levels_that_cannot_be_written_down_are_asked_for() {
    let prepared = prepared(
        "param place = hex(spacing: 3mm) let all = { place: [grid(spacing: 2mm)] }
        experiment e { seeds: 0 .. 0 factors: all }",
    );
    assert!(prepared.ready.is_none());
    let message = &prepared.lowered.diagnostics[0].message;
    assert_eq!(message, "a placement as a level is written out in the experiment");
}

/// A run of these figures.
fn done(run: usize, figures: &[(&str, Option<f64>)]) -> Done {
    let figures = figures.iter().map(|&(name, value)| (name.to_owned(), value)).collect();
    Done { run, found: Ok(vec![PaintFigures { paint: "p".to_owned(), figures }]) }
}

const TWO: &str = "param a = 1 experiment e { seeds: 0 .. 3 factors: { a: [1, 2] } }";

#[test]
fn commands_name_the_limits_that_were_lifted() {
    let (mut recipe, _) = ready(TWO);
    assert_eq!(command(&recipe), "kake experiment scene.kake e -o DIR");
    recipe.limits = Recipe::named(&Limits { tiles: 5, runs: 2_000_000, ..Limits::default() });
    recipe.seeds = Some([1, 2]);
    let words = "kake experiment scene.kake e --limit runs=2000000 --limit tiles=5 --seeds 1..2 -o DIR";
    assert_eq!(command(&recipe), words);
}

#[test]
fn journals_come_back_to_the_bit() {
    let (recipe, _) = ready(TWO);
    let shard = Shard { index: 2, of: 3 };
    let runs = [
        done(4, &[("x", Some(0.1 + 0.2)), ("y", None), ("z", Some(-0.0)), ("tiny", Some(5e-324))]),
        Done { run: 1, found: Err("no\nway".to_owned()) },
        done(7, &[]),
    ];
    let mut text = head(&recipe, shard).unwrap();
    runs.iter().for_each(|run| text.push_str(&entry(run).unwrap()));
    let journal = Journal::read(text.as_bytes()).unwrap();
    assert_eq!((&journal.recipe, journal.shard, journal.damaged, journal.whole), (&recipe, shard, 0, text.len()));
    assert_eq!(journal.done.values().cloned().collect::<Vec<_>>(), [runs[1].clone(), runs[0].clone(), runs[2].clone()]);
    // Wherever it is cut, whole lines are kept and nothing else.
    let head = text.find('\n').unwrap() + 1;
    for cut in 0..text.len() {
        let journal = Journal::read(&text.as_bytes()[..cut]);
        assert_eq!(journal.is_some(), cut >= head);
        if let Some(journal) = journal {
            let lines = text[..cut].matches('\n').count();
            assert_eq!(journal.done.len(), lines - 1);
            assert_eq!(journal.whole, text[..cut].rfind('\n').unwrap() + 1);
        }
    }
}

#[test]
fn outcomes_do_not_depend_on_the_order_of_runs() {
    let (_, plan) = ready(TWO);
    let value = |run: usize| [0.5, 0.1, 0.3, 0.7, 0.2, 0.9, 0.4, 0.8][run];
    let figures = |run: usize| {
        let far = [("r1", Some(1.0)), ("r2", (run > 2).then_some(2.0))];
        let shown = if run.is_multiple_of(2) { 1 } else { 2 };
        done(run, &[&[("e_contrast", Some(value(run)))], &far[..shown], &[("xi", Some(f64::INFINITY))]].concat())
    };
    let forth = Outcome::new(plan.clone(), (0..8).map(figures));
    let back = Outcome::new(plan, (0..8).rev().map(figures));
    assert_eq!(forth.measures, ["e_contrast", "r1", "r2", "xi"]);
    assert_eq!(forth.runs, back.runs);
    assert_eq!(tables::runs(&forth).unwrap(), tables::runs(&back).unwrap());
    assert_eq!(parquet::runs(&forth).unwrap(), parquet::runs(&back).unwrap());
    // 0.3 and 0.5 lie equally far from 0.4, 0.4 and 0.8 from 0.6: the lower seed stands for the condition.
    assert_eq!(forth.representatives, [Some(0), Some(2)]);
    // What has no value anywhere has no statistics.
    let analysed: Vec<usize> = forth.analyses.iter().map(|analysis| analysis.measure).collect();
    assert_eq!(analysed, [0, 1, 2]);
}

#[test]
fn pairs_beyond_the_most_are_left_out_with_a_note() {
    let note = "101 conditions make 5050 pairs; pairs are compared up to 5000";
    for (count, pairs) in [(100, 4950), (101, 0)] {
        let levels: Vec<String> = (0..count).map(|level| level.to_string()).collect();
        let levels = levels.join(", ");
        let (_, plan) = ready(&format!("param a = 1 experiment e {{ seeds: 0 .. 2 factors: {{ a: [{levels}] }} }}"));
        let runs = (0..plan.runs()).map(|run| done(run, &[("e_contrast", Some(libm::sin(run as f64)))]));
        let outcome = Outcome::new(plan.clone(), runs);
        let analysis = &outcome.analyses[0];
        assert_eq!((analysis.cohen_d.len(), analysis.tukey.len()), (pairs, pairs));
        let said = analysis.assumptions.note.as_deref().unwrap_or_default();
        assert_eq!(said.ends_with(note), pairs == 0, "{said}");
        for (file, table) in tables::tables(&outcome).unwrap() {
            let text = String::from_utf8(table).unwrap();
            match file {
                "cohen_d.csv" | "tukey.csv" => assert_eq!(text.lines().count(), 1 + pairs),
                "assumptions.csv" => assert_eq!(text.contains(note), pairs == 0),
                _ => (),
            }
        }
    }
}

#[test]
fn numbers_are_as_short_as_they_can_be() {
    for (value, text) in
        [(0.1, "0.1"), (64.0, "64"), (-0.25, "-0.25"), (1e-300, "1e-300"), (1.5e20, "1.5e20"), (0.0, "0")]
    {
        assert_eq!(tables::number(value), text);
    }
}
