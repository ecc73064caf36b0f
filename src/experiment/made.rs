//! How an experiment's files were made: all that it takes to make them again, and no dates.

use serde::Serialize;

use crate::scene::Limits;

use super::{Figure, Outcome, Picture, Recipe};

#[derive(Serialize)]
struct Made<'a> {
    program: String,
    command: String,
    experiment: &'a str,
    scene: &'a str,
    seeds: [u64; 2],
    runs: usize,
    conditions: Vec<Condition<'a>>,
    pictures: Vec<Drawn<'a>>,
    charts: Vec<&'a str>,
    recipe: &'a Recipe,
}

#[derive(Serialize)]
struct Condition<'a> {
    name: &'a str,
    in_design: bool,
    set: Vec<(&'a str, &'a str)>,
    runs: usize,
    failed: usize,
    represented_by_seed: Option<u64>,
}

#[derive(Serialize)]
struct Drawn<'a> {
    file: &'a str,
    condition: &'a str,
    seed: u64,
    set: Vec<(&'a str, &'a str)>,
}

/// The command that does the same again, in a folder that holds the scene.
#[must_use]
pub fn command(recipe: &Recipe) -> String {
    let mut words = vec!["kake".to_owned(), "experiment".to_owned(), quoted(&recipe.scene), quoted(&recipe.experiment)];
    words.extend(recipe.sets.iter().map(|(name, value)| format!("--set {}", quoted(&format!("{name}={value}")))));
    // Limits are part of the recipe: without those that were lifted, runs would fail, or be taken for another's.
    let default = Recipe::named(&Limits::default());
    let lifted = recipe.limits.iter().filter(|&(name, value)| default.get(name) != Some(value));
    words.extend(lifted.map(|(name, value)| format!("--limit {}", quoted(&format!("{name}={value}")))));
    words.extend(recipe.seeds.map(|[from, to]| format!("--seeds {from}..{to}")));
    words.extend(recipe.only.as_ref().map(|only| format!("--only {}", quoted(only))));
    words.push("-o DIR".to_owned());
    words.join(" ")
}

/// A word as a shell takes it.
fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "-_./=+,:".contains(c);
    match word.chars().all(is_plain) && !word.is_empty() {
        true => word.to_owned(),
        false => format!("'{}'", word.replace('\'', r"'\''")),
    }
}

/// How it was made, as JSON.
///
/// # Errors
/// If it cannot be serialised.
pub fn made(recipe: &Recipe, outcome: &Outcome, pictures: &[Picture], charts: &[Figure]) -> serde_json::Result<String> {
    let plan = &outcome.plan;
    let conditions = plan.conditions.iter().enumerate().map(|(number, condition)| Condition {
        name: &condition.name,
        in_design: condition.levels.is_some(),
        set: condition.sets.iter().map(|set| (set.param.as_str(), set.expression.as_str())).collect(),
        runs: plan.seed_count(),
        failed: outcome.failures.iter().filter(|failure| failure.condition == number).count(),
        represented_by_seed: outcome.representatives[number],
    });
    let drawn = pictures.iter().filter(|picture| picture.png.is_ok()).map(|picture| Drawn {
        file: &picture.file,
        condition: &plan.conditions[picture.condition].name,
        seed: picture.seed,
        set: plan.pictures[picture.variant].iter().map(|set| (set.param.as_str(), set.expression.as_str())).collect(),
    });
    serde_json::to_string_pretty(&Made {
        program: format!("kake {}", recipe.version),
        command: command(recipe),
        experiment: &plan.name,
        scene: &recipe.scene,
        seeds: plan.seeds,
        runs: plan.runs(),
        conditions: conditions.collect(),
        pictures: drawn.collect(),
        charts: charts.iter().map(|chart| chart.file.as_str()).collect(),
        recipe,
    })
    .map(|json| json + "\n")
}
