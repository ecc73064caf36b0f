//! Doing runs: a scene compiled as far as its tiles and measured, for one condition and seed at a time, on all cores.

use rayon::prelude::*;

use crate::diag::{Diagnostic, RenderConfig, render};
use crate::lower::lower;
use crate::metrics::{Measured, Measures};
use crate::span::Sources;
use crate::{Config, PaintStages, no_such_paint, paints};

use super::{Plan, Recipe};

/// Columns of diagnostics.
const WIDTH: usize = 100;

/// A run that is over.
#[derive(Debug, Clone, PartialEq)]
pub struct Done {
    /// Which run of the plan.
    pub run: usize,
    /// The paints that were measured, from the bottom up; or why nothing could be, in words for a person.
    pub found: Result<Vec<PaintFigures>, String>,
}

/// What was measured of a paint.
#[derive(Debug, Clone, PartialEq)]
pub struct PaintFigures {
    /// Its name.
    pub paint: String,
    /// Every single figure by its name.
    pub figures: Vec<(String, Option<f64>)>,
}

/// Does the runs of these numbers, in parallel, and hands each to `keep` as soon as it is over, in whatever order that
/// is. The first error of `keep` ends it.
///
/// # Errors
/// What `keep` says.
pub fn run<E: Send>(
    recipe: &Recipe,
    plan: &Plan,
    numbers: &[usize],
    keep: &(dyn Fn(Done) -> Result<(), E> + Sync),
) -> Result<(), E> {
    numbers.par_iter().try_for_each(|&number| keep(one(recipe, plan, number)))
}

/// Does one run.
#[must_use]
pub fn one(recipe: &Recipe, plan: &Plan, number: usize) -> Done {
    let (condition, seed) = plan.run(number);
    let config = recipe.config(&[&plan.conditions[condition].sets], Some(seed));
    Done { run: number, found: measure(recipe, &config) }
}

fn measure(recipe: &Recipe, config: &Config) -> Result<Vec<PaintFigures>, String> {
    let lowered = lower(&recipe.scene, recipe, &config.lower);
    let Some(scene) = &lowered.scene else { return Err(words(lowered.diagnostics, &lowered.sources)) };
    let is_wanted = |name: &str| config.only.as_deref().is_none_or(|only| only == name);
    let mut found = Vec::new();
    // Warnings are the scene's and not the run's.
    let mut warnings = Vec::new();
    for paint in paints(scene).filter(|paint| is_wanted(&paint.name)) {
        let stages = PaintStages::new(paint, &scene.canvas, &config.lower.limits, &mut (), &mut warnings)
            .map_err(|limit| words(vec![limit], &lowered.sources))?;
        let measures = Measures::new(&Measured::new(paint, &stages.borrow()));
        let figures = measures.scalars().into_iter().map(|(name, value)| (name.into_owned(), value)).collect();
        found.push(PaintFigures { paint: paint.name.clone(), figures });
    }
    match (&config.only, found.is_empty()) {
        (Some(only), true) => {
            let names: Vec<String> = paints(scene).map(|paint| paint.name.clone()).collect();
            Err(words(vec![no_such_paint(only, &names)], &lowered.sources))
        }
        _ => Ok(found),
    }
}

/// The errors among diagnostics as they are shown to a person.
pub(super) fn words(mut diagnostics: Vec<Diagnostic>, sources: &Sources) -> String {
    diagnostics.retain(Diagnostic::is_error);
    render(&diagnostics, sources, RenderConfig { width: WIDTH, colour: false, unicode: true })
}
