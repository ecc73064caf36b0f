//! `kake experiment`: a scene's experiment, run on all cores, kept as it goes, and written out as tables and pictures.

mod keep;
mod merge;
mod output;

use std::path::PathBuf;
use std::sync::Mutex;

use crate::experiment::{self, Plan, Recipe, Request, Shard, prepare};
use clap::{Args, Subcommand};

use super::build::{Seeds, parse_seeds};
use super::files::open;
use super::progress::Bar;
use super::{Ended, SceneArgs, report};

use keep::{Keep, Kept};

#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub(super) struct ExperimentArgs {
    #[command(subcommand)]
    command: Option<ExperimentCommand>,
    #[command(flatten)]
    scene: Option<SceneArgs>,
    #[command(flatten)]
    run: Option<RunArgs>,
}

#[derive(Debug, Subcommand)]
enum ExperimentCommand {
    /// Put the shards of an experiment together; the files are the same as those of one run
    Merge(merge::MergeArgs),
}

#[derive(Debug, Args)]
struct RunArgs {
    /// The experiment; it may be left out where the scene declares just one
    name: Option<String>,
    /// The folder that the tables, the pictures and the report go to. Runs that are finished there are not done again
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// How many runs are done at a time; by default one for each core. The files do not depend on it
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
    /// Do the I-th of N shares of the runs, to be put together by `kake experiment merge`
    #[arg(long, value_name = "I/N", value_parser = parse_shard)]
    shard: Option<Shard>,
    /// Replace the experiment's seeds
    #[arg(long, value_name = "A..B", value_parser = parse_seeds)]
    seeds: Option<Seeds>,
    /// Measure and draw this paint alone
    #[arg(long, value_name = "PAINT")]
    only: Option<String>,
}

/// More shards than runs are of no use.
const MOST_SHARDS: usize = 1_000_000;

fn parse_shard(text: &str) -> Result<Shard, String> {
    let (index, of) = text.split_once('/').ok_or("expected I/N, as in 1/4")?;
    let number = |text: &str| text.trim().parse::<usize>().map_err(|_| format!("`{text}` is not a whole number"));
    let (index, of) = (number(index)?, number(of)?);
    match of {
        0 => Err("there is at least one shard".to_owned()),
        of if of > MOST_SHARDS => Err(format!("there are at most {MOST_SHARDS} shards")),
        of if index == 0 || index > of => Err(format!("shards are counted from 1/{of} to {of}/{of}")),
        of => Ok(Shard { index, of }),
    }
}

pub(super) fn run(arguments: &ExperimentArgs) -> Ended {
    match (&arguments.command, &arguments.scene, &arguments.run) {
        (Some(ExperimentCommand::Merge(arguments)), ..) => merge::run(arguments),
        (None, Some(scene), Some(arguments)) => experiment(scene, arguments),
        // clap asks for a scene and a folder where there is no other command.
        (None, ..) => Ended::Usage,
    }
}

fn experiment(scene: &SceneArgs, arguments: &RunArgs) -> Ended {
    if let Some(jobs) = arguments.jobs {
        // Fails only where the pool is there already, which nothing before this makes.
        let _ = rayon::ThreadPoolBuilder::new().num_threads(usize::from(jobs)).build_global();
    }
    let opened = match open(&scene.scene, scene.root.as_deref()) {
        Ok(opened) => opened,
        Err(error) => return report::cannot_open(error),
    };
    let mut config = scene.config(None);
    config.only.clone_from(&arguments.only);
    super::picture::take_over(&mut config, &opened);
    let request = Request { name: arguments.name.clone(), seeds: arguments.seeds.map(|Seeds(from, to)| [from, to]) };
    let prepared = prepare(&opened.path, &opened.loader, &config, &request);
    let ended = report::diagnostics(&prepared.lowered.diagnostics, &prepared.lowered.sources);
    let Some((recipe, plan)) = prepared.ready else { return ended };
    if let Some(set) = clash(scene, &plan) {
        eprintln!("kake: `{set}` is a factor of the experiment `{}` and cannot be set besides", plan.name);
        return Ended::Usage;
    }
    let shard = arguments.shard.unwrap_or(Shard::WHOLE);
    let kept = match Keep::open(&arguments.output, &recipe, shard) {
        Ok(kept) => kept,
        Err(ended) => return ended,
    };
    match runs(&recipe, &plan, shard, kept) {
        Ok(kept) if shard.is_whole() => output::write(&arguments.output, &recipe, plan, kept.done),
        Ok(kept) => output::write_shard(&arguments.output, &recipe, (plan, shard), kept.done),
        Err(ended) => ended,
    }
}

/// A parameter that the command line sets although the experiment varies it.
fn clash<'a>(scene: &'a SceneArgs, plan: &Plan) -> Option<&'a str> {
    let varied = |name: &str| plan.factors.iter().any(|factor| factor.param == name);
    scene.set.iter().map(|(name, _)| name.as_str()).find(|name| varied(name))
}

/// Does what is left to do of a share of the runs.
fn runs(recipe: &Recipe, plan: &Plan, shard: Shard, kept: Keep) -> Result<Kept, Ended> {
    let share: Vec<usize> = (0..plan.runs()).filter(|&run| shard.holds(run)).collect();
    let left: Vec<usize> = share.iter().copied().filter(|run| !kept.has(*run)).collect();
    let finished = share.len() - left.len();
    if finished > 0 && !left.is_empty() {
        eprintln!("kake: {finished} of {} runs are finished already", share.len());
    }
    let bar = Bar::new("runs", share.len(), finished);
    let kept = Mutex::new(kept);
    let lock = || kept.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    let ran = experiment::run(recipe, plan, &left, &|done| {
        let added = lock().add(done);
        bar.advance();
        added
    });
    bar.finish();
    let finished = lock().len();
    match ran {
        Ok(()) => Ok(kept.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner).close()),
        Err(error) => {
            eprintln!("kake: {error}");
            eprintln!(
                "kake: {finished} of {} runs are finished and kept; the same command goes on from there",
                share.len()
            );
            Err(Ended::Io)
        }
    }
}
