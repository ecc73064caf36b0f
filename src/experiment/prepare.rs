//! From a scene to what its experiment's runs depend on.
//!
//! In: the path of a scene, a loader, what the command line sets. Out: the plan of the experiment that is asked for, and a
//! recipe that holds every file that some condition or picture of it reads.

use std::collections::BTreeMap;

use rayon::prelude::*;

use crate::diag::{Code, Diagnostic, did_you_mean};
use crate::loader::Loader;
use crate::lower::{LowerConfig, Lowered, lower};
use crate::scene::{Experiment, Scene};
use crate::{Config, no_such_paint, paints};

use super::{Plan, Recipe, Recorder, Setting};

/// Which experiment is asked for.
#[derive(Debug, Clone, Default)]
pub struct Request {
    /// Its name; it may be left out where the scene declares just one.
    pub name: Option<String>,
    /// First and last seed, in place of the experiment's own.
    pub seeds: Option<[u64; 2]>,
}

/// What a scene gave.
#[derive(Debug)]
pub struct Prepared {
    /// The scene as it stands, with every diagnostic.
    pub lowered: Lowered,
    /// What there is to do, unless something is at fault.
    pub ready: Option<(Recipe, Plan)>,
}

/// Reads a scene and plans its experiment.
#[must_use]
pub fn prepare<L: Loader>(path: &str, loader: &L, config: &Config, request: &Request) -> Prepared {
    let recorder = Recorder::new(loader);
    // Every run has a seed of its own.
    let config = Config { lower: LowerConfig { seed: None, ..config.lower.clone() }, ..config.clone() };
    let mut lowered = lower(path, &recorder, &config.lower);
    let Some(planned) = lowered.scene.as_ref().map(|scene| plan(scene, &config, request)) else {
        return Prepared { lowered, ready: None };
    };
    let plan = match planned {
        Ok(plan) => plan,
        Err(diagnostic) => {
            lowered.diagnostics.push(diagnostic);
            return Prepared { lowered, ready: None };
        }
    };
    let mut recipe = Recipe {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        scene: path.to_owned(),
        experiment: plan.name.clone(),
        seeds: request.seeds,
        sets: config.lower.sets.clone(),
        dpi: config.lower.dpi,
        only: config.only.clone(),
        limits: Recipe::named(&config.lower.limits),
        files: recorder.files(),
        dependencies: BTreeMap::new(),
    };
    // What a picture was built with does not stand against what the experiment varies.
    recipe.sets.retain(|(name, _)| plan.factors.iter().all(|factor| factor.param != *name));
    read(&recipe, &plan, &recorder);
    recipe.files = recorder.files();
    recipe.dependencies = recorder.dependencies();
    Prepared { lowered, ready: Some((recipe, plan)) }
}

/// The plan of the experiment that is asked for.
fn plan(scene: &Scene, config: &Config, request: &Request) -> Result<Plan, Diagnostic> {
    let names: Vec<String> = paints(scene).map(|paint| paint.name.clone()).collect();
    if let Some(only) = config.only.as_ref().filter(|only| !names.contains(only)) {
        return Err(no_such_paint(only, &names));
    }
    let experiment = chosen(scene, request.name.as_deref())?;
    let seeds = request.seeds.unwrap_or(experiment.seeds);
    Plan::new(&Experiment { seeds, ..experiment.clone() }, &scene.params, &config.lower.limits)
}

/// The experiment of a name, or the only one.
fn chosen<'a>(scene: &'a Scene, name: Option<&str>) -> Result<&'a Experiment, Diagnostic> {
    let names = || scene.experiments.iter().map(|experiment| experiment.name.as_str());
    let listed = || names().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
    match (name, scene.experiments.as_slice()) {
        (_, []) => Err(Diagnostic::without_span(Code::Missing, "the scene declares no experiment")
            .hint("`experiment name { seeds: 0 .. 99  factors: { param: [a, b] } }`")),
        (None, [experiment]) => Ok(experiment),
        (None, _) => {
            let message = "the scene declares several experiments, and none is named";
            Err(Diagnostic::without_span(Code::Missing, message).hint(format!("name one of {}", listed())))
        }
        (Some(name), experiments) => experiments.iter().find(|experiment| experiment.name == name).ok_or_else(|| {
            let hint = did_you_mean(name, names()).unwrap_or_else(|| format!("it declares {}", listed()));
            let message = format!("the scene declares no experiment `{name}`");
            Diagnostic::without_span(Code::UnknownName, message).hint(hint)
        }),
    }
}

/// Has every file read that some condition or picture needs.
fn read<L: Loader>(recipe: &Recipe, plan: &Plan, recorder: &Recorder<'_, L>) {
    let lower = |settings: &[&[Setting]]| {
        let config = recipe.config(settings, Some(plan.seeds[0]));
        // What is at fault comes to light when it is run.
        let _ = lower(&recipe.scene, recorder, &config.lower);
    };
    plan.conditions.par_iter().for_each(|condition| {
        lower(&[&condition.sets]);
        for picture in plan.pictures.iter().filter(|picture| !picture.is_empty()) {
            lower(&[&condition.sets, picture]);
        }
    });
}
