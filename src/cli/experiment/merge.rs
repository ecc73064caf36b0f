//! `kake experiment merge`: the shards of an experiment put together.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use clap::Args;

use crate::cli::files::plain;
use crate::cli::{Ended, report};
use crate::experiment::{Done, Journal, Recipe, Request, Shard, prepare};

use super::{keep, output};

#[derive(Debug, Args)]
pub(super) struct MergeArgs {
    /// The folders that `kake experiment --shard` wrote
    #[arg(required = true, value_name = "DIR")]
    shards: Vec<PathBuf>,
    /// The folder that the tables, the pictures and the report go to
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
}

pub(super) fn run(arguments: &MergeArgs) -> Ended {
    let mut journals = Vec::new();
    for folder in &arguments.shards {
        match read(folder) {
            Ok(found) => journals.extend(found),
            Err((words, ended)) => return said(&words, ended),
        }
    }
    let (recipe, done, of) = match together(journals) {
        Ok(whole) => whole,
        Err(words) => return said(&words, Ended::Usage),
    };
    let request = Request { name: Some(recipe.experiment.clone()), seeds: recipe.seeds };
    let prepared = prepare(&recipe.scene, &recipe, &recipe.config(&[], None), &request);
    let ended = report::diagnostics(&prepared.lowered.diagnostics, &prepared.lowered.sources);
    let Some((_, plan)) = prepared.ready else { return ended };
    if let Err(words) = complete(&done, plan.runs(), of) {
        return said(&words, Ended::Usage);
    }
    let kept = match keep::Keep::open(&arguments.output, &recipe, Shard::WHOLE) {
        Ok(kept) => kept.close(),
        Err(ended) => return ended,
    };
    let done = done.into_values().map(|(_, done)| (done.run, done)).collect();
    let ended = output::write(&arguments.output, &recipe, plan, done);
    drop(kept);
    ended
}

fn said(words: &str, ended: Ended) -> Ended {
    eprintln!("kake: {words}");
    ended
}

/// The journals of shards in a folder.
fn read(folder: &Path) -> Result<Vec<(PathBuf, Journal)>, (String, Ended)> {
    let cannot =
        |path: &Path, error: &std::io::Error| (format!("cannot read {}: {}", path.display(), plain(error)), Ended::Io);
    let mut paths = Vec::new();
    for entry in fs::read_dir(folder).map_err(|error| cannot(folder, &error))? {
        let path = entry.map_err(|error| cannot(folder, &error))?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if name.starts_with("runs-") && name.ends_with(".journal") {
            paths.push(path);
        }
    }
    paths.sort();
    // One shard of one is a whole run.
    let whole = folder.join(keep::name(Shard::WHOLE));
    if paths.is_empty() && whole.is_file() {
        paths.push(whole);
    }
    if paths.is_empty() {
        let words = format!("{} holds no shard: `kake experiment --shard I/N` writes one", folder.display());
        return Err((words, Ended::Usage));
    }
    let mut journals = Vec::new();
    for path in paths {
        let bytes = fs::read(&path).map_err(|error| cannot(&path, &error))?;
        match Journal::read(&bytes) {
            Some(journal) => journals.push((path, journal)),
            None => return Err((format!("{} is damaged: its shard is done anew", path.display()), Ended::Usage)),
        }
    }
    Ok(journals)
}

/// Runs with the journals that hold them.
type Found = BTreeMap<usize, (PathBuf, Done)>;

/// What the shards say together, if they are of one experiment, and each is there once.
fn together(journals: Vec<(PathBuf, Journal)>) -> Result<(Recipe, Found, usize), String> {
    let Some((first, Journal { recipe, shard, .. })) = journals.first().cloned() else {
        return Err("there are no shards".to_owned());
    };
    if recipe.version != env!("CARGO_PKG_VERSION") {
        let (made, own) = (&recipe.version, env!("CARGO_PKG_VERSION"));
        return Err(format!("{} was written by kake {made}, and this is kake {own}", first.display()));
    }
    let mut places: BTreeMap<usize, PathBuf> = BTreeMap::new();
    let mut found = Found::new();
    for (path, journal) in journals {
        if journal.recipe != recipe {
            let what = difference(&recipe, &journal.recipe);
            return Err(format!("{} and {} are not of one experiment: {what}", first.display(), path.display()));
        }
        if journal.shard.of != shard.of {
            let (a, b) = (shard.of, journal.shard.of);
            return Err(format!("{} is one of {a} shards, {} one of {b}", first.display(), path.display()));
        }
        if let Some(earlier) = places.insert(journal.shard.index, path.clone()) {
            let Shard { index, of } = journal.shard;
            return Err(format!("the shard {index}/{of} is given twice: {} and {}", earlier.display(), path.display()));
        }
        let own = journal.done.into_iter().filter(|(run, _)| journal.shard.holds(*run));
        found.extend(own.map(|(run, done)| (run, (path.clone(), done))));
    }
    let missing: Vec<String> = (1..=shard.of)
        .filter(|index| !places.contains_key(index))
        .map(|index| format!("{index}/{}", shard.of))
        .collect();
    match missing.as_slice() {
        [] => Ok((recipe, found, shard.of)),
        [one] => Err(format!("the shard {one} is missing")),
        [first, .., last] if missing.len() > 4 => {
            Err(format!("{} shards are missing, the first {first}, the last {last}", missing.len()))
        }
        several => Err(format!("the shards {} are missing", several.join(", "))),
    }
}

/// In what two recipes differ, in words.
fn difference(a: &Recipe, b: &Recipe) -> String {
    if a.version != b.version {
        return format!("they were written by kake {} and kake {}", a.version, b.version);
    }
    if a.scene != b.scene || a.experiment != b.experiment {
        return format!("they ran `{}` of {} and `{}` of {}", a.experiment, a.scene, b.experiment, b.scene);
    }
    let name = a.files.keys().chain(b.files.keys()).find(|name| a.files.get(*name) != b.files.get(*name));
    match name {
        Some(name) => format!("{name} is not the same"),
        None => "they were run with other parameters, seeds or limits".to_owned(),
    }
}

/// Whether every run is there.
fn complete(done: &Found, runs: usize, of: usize) -> Result<(), String> {
    match (0..runs).find(|run| !done.contains_key(run)) {
        None => Ok(()),
        Some(run) => {
            let shard = Shard { index: run % of + 1, of };
            let count = (0..runs).filter(|&run| shard.holds(run)).count();
            let there = done.keys().filter(|&&run| run < runs && shard.holds(run)).count();
            let words = format!("the shard {}/{of} is not finished: {there} of {count} runs are", shard.index);
            Err(format!("{words}; `--shard {}/{of}` goes on with it", shard.index))
        }
    }
}
