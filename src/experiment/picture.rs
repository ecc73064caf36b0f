//! Pictures of the runs that stand for their conditions.

use std::collections::{BTreeMap, BTreeSet};

use rayon::prelude::*;

use crate::back::metadata::Metadata;
use crate::back::png::{self, PngError};
use crate::compile;

use super::plan::{Plan, Setting};
use super::runner::words;
use super::{Outcome, Recipe};

/// Characters of a file's name before those that tell pictures apart.
const LONGEST: usize = 120;

/// A picture of the run that stands for a condition.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Picture {
    /// Which condition of the plan.
    pub condition: usize,
    /// The seed of the run.
    pub seed: u64,
    /// Which of the plan's pictures.
    pub variant: usize,
    /// The file's name: `CONDITION-PARAM=VALUE….png`.
    pub file: String,
    /// The PNG, in the canvas's own pixels; or why there is none, in words for a person.
    pub png: Result<Vec<u8>, String>,
}

/// Draws every picture that the plan asks for, in parallel: condition by condition. A picture carries its scene with the
/// parameters and the seed, so that `kake build` makes it again.
#[must_use]
pub fn pictures(recipe: &Recipe, outcome: &Outcome, drawn: &(dyn Fn() + Sync)) -> Vec<Picture> {
    let plan = &outcome.plan;
    let mut names = BTreeSet::new();
    let wanted: Vec<(usize, u64, usize, String)> = outcome
        .representatives
        .iter()
        .enumerate()
        .filter_map(|(condition, seed)| Some((condition, (*seed)?)))
        .flat_map(|(condition, seed)| (0..plan.pictures.len()).map(move |variant| (condition, seed, variant)))
        .map(|(condition, seed, variant)| (condition, seed, variant, file(plan, condition, variant, &mut names)))
        .collect();
    wanted
        .into_par_iter()
        .map(|(condition, seed, variant, file)| {
            let png = draw(recipe, [&plan.conditions[condition].sets, &plan.pictures[variant]], seed);
            drawn();
            Picture { condition, seed, variant, file, png }
        })
        .collect()
}

/// How many pictures there will be.
#[must_use]
pub fn count(outcome: &Outcome) -> usize {
    outcome.representatives.iter().flatten().count() * outcome.plan.pictures.len()
}

/// The name of a picture's file, which no other picture has.
fn file(plan: &Plan, condition: usize, variant: usize, taken: &mut BTreeSet<String>) -> String {
    let mut stem = plain(&plan.conditions[condition].name);
    for setting in &plan.pictures[variant] {
        stem.push('-');
        stem.push_str(&plain(&setting.param));
        stem.push('=');
        stem.push_str(&plain(&setting.label));
    }
    let stem: String = stem.chars().take(LONGEST).collect();
    let mut name = stem.clone();
    let mut number = 2;
    // File systems that do not tell capitals apart would mix pictures up.
    while !taken.insert(name.to_lowercase()) {
        name = format!("{stem}-{number}");
        number += 1;
    }
    format!("{name}.png")
}

/// A text as a part of a file's name: letters, digits and a few signs that no system minds, everything else a hyphen.
pub(crate) fn plain(text: &str) -> String {
    let mut out = String::new();
    for letter in text.chars() {
        match letter {
            letter if letter.is_alphanumeric() || matches!(letter, '.' | '_') => out.push(letter),
            _ if out.is_empty() || out.ends_with('-') => {}
            _ => out.push('-'),
        }
    }
    out.trim_end_matches('-').trim_start_matches('.').to_owned()
}

fn draw(recipe: &Recipe, settings: [&[Setting]; 2], seed: u64) -> Result<Vec<u8>, String> {
    let config = recipe.config(&settings, Some(seed));
    let compiled = compile(&recipe.scene, recipe, &config, &mut ());
    let Some(drawing) = &compiled.drawing else {
        return Err(words(compiled.lowered.diagnostics, &compiled.lowered.sources));
    };
    let most = config.lower.limits.megapixels.saturating_mul(1_000_000);
    let [width, height] = drawing.page.pixels;
    if u64::from(width) * u64::from(height) > most {
        let limit = config.lower.limits.megapixels;
        return Err(format!("the picture would have {width} x {height} pixels; the limit is {limit} megapixels"));
    }
    let mut options = BTreeMap::new();
    options.extend(recipe.dpi.map(|dpi| ("dpi".to_owned(), dpi.to_string())));
    options.extend(recipe.only.clone().map(|only| ("only".to_owned(), only)));
    let texts = compiled.lowered.sources.iter().filter(|(_, source)| !source.name.starts_with("--"));
    let metadata = Metadata {
        version: recipe.version.clone(),
        seed,
        scene: recipe.scene.clone(),
        params: config.lower.sets.iter().cloned().collect(),
        options,
        sources: texts.map(|(_, source)| (source.name.clone(), source.text.to_string())).collect(),
        dependencies: recipe.dependencies.clone(),
        files: Vec::new(),
    };
    let mut bytes = Vec::new();
    match png::write(drawing, Some(&metadata), &mut bytes) {
        Ok(()) => Ok(bytes),
        Err(PngError::Io(error)) => Err(error.to_string()),
        Err(PngError::Format(message)) => Err(message),
    }
}
