//! The files of an experiment: all are written beside their places before the first is put there.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use serde::Deserialize;

use crate::cli::Ended;
use crate::cli::files::{Pending, plain, write_beside};
use crate::cli::progress::Bar;
use crate::experiment::{self, Done, Outcome, Picture, Plan, Recipe, Shard, tables};

use super::keep;

/// The folder of the pictures.
const IMAGES: &str = "images";

/// The page that shows it all, and the folder of its charts.
const REPORT: &str = "report.html";
const FIGURES: &str = "figures";

/// How the files were made.
const MADE: &str = "made.json";

/// Writes everything that follows from all runs of an experiment.
pub(super) fn write(folder: &Path, recipe: &Recipe, plan: Plan, done: BTreeMap<usize, Done>) -> Ended {
    let journal = keep::complete(recipe, Shard::WHOLE, &done);
    let outcome = Outcome::new(plan, done.into_values());
    let worst = failures(&outcome);
    if outcome.runs.is_empty() {
        eprintln!("kake: no run could be measured, so that nothing is written");
        return Ended::Fault;
    }
    let bar = Bar::new("pictures", experiment::picture_count(&outcome), 0);
    let mut pictures = experiment::pictures(recipe, &outcome, &|| bar.advance());
    bar.finish();
    let worst = match undrawn(&mut pictures, &outcome) {
        Ended::Done => worst,
        fault => fault,
    };
    let files = match files(recipe, &outcome, pictures, journal) {
        Ok(files) => files,
        Err((path, error)) => return failed(&folder.join(path), &error),
    };
    let stale = stale(folder, &files);
    if let Err((path, error)) = put(folder, files) {
        return failed(&folder.join(path), &error);
    }
    // Pictures and charts of an earlier outcome would be taken for this one's.
    for file in stale {
        let _ = fs::remove_file(file);
    }
    worst
}

/// Writes what follows from a share of the runs: the journal, to be merged, and its rows, to be looked at.
pub(super) fn write_shard(
    folder: &Path,
    recipe: &Recipe,
    (plan, shard): (Plan, Shard),
    done: BTreeMap<usize, Done>,
) -> Ended {
    let journal = keep::complete(recipe, shard, &done);
    let outcome = Outcome::of_runs(plan, done.into_values());
    let worst = failures(&outcome);
    let rows = format!("runs-{}-of-{}.csv", shard.index, shard.of);
    let written =
        table(tables::runs(&outcome)).and_then(|bytes| Ok(vec![(rows, bytes), (keep::name(shard), journal?)]));
    let files = written.map_err(|error| (String::new(), error));
    match files.and_then(|files| put(folder, files)) {
        Ok(()) => worst,
        Err((path, error)) => failed(&folder.join(path), &error),
    }
}

type Files = Vec<(String, Vec<u8>)>;

/// The files by their paths from the folder. The journal is the last to be put in its place.
fn files(
    recipe: &Recipe,
    outcome: &Outcome,
    pictures: Vec<Picture>,
    journal: io::Result<Vec<u8>>,
) -> Result<Files, (String, io::Error)> {
    let named = |name: &str, bytes: io::Result<Vec<u8>>| match bytes {
        Ok(bytes) => Ok((name.to_owned(), bytes)),
        Err(error) => Err((name.to_owned(), error)),
    };
    let mut files = Vec::new();
    for (name, bytes) in table(tables::tables(outcome)).map_err(|error| ("runs.csv".to_owned(), error))? {
        files.push((name.to_owned(), bytes));
    }
    files.push(named("runs.parquet", experiment::parquet::runs(outcome).map_err(io::Error::other))?);
    let report = experiment::report(recipe, outcome, &pictures);
    let made = experiment::made(recipe, outcome, &pictures, &report.figures);
    files.push(named(MADE, made.map(String::into_bytes).map_err(io::Error::from))?);
    files.push((REPORT.to_owned(), report.html.into_bytes()));
    files.extend(
        report.figures.into_iter().map(|figure| (format!("{FIGURES}/{}", figure.file), figure.svg.into_bytes())),
    );
    for picture in pictures {
        files.extend(picture.png.ok().map(|png| (format!("{IMAGES}/{}", picture.file), png)));
    }
    files.push(named(&keep::name(Shard::WHOLE), journal)?);
    Ok(files)
}

fn table<T>(table: csv::Result<T>) -> io::Result<T> {
    table.map_err(io::Error::other)
}

/// Writes all files, then puts them in their places.
fn put(folder: &Path, files: Files) -> Result<(), (String, io::Error)> {
    let mut pending: Vec<(String, Pending)> = Vec::new();
    for (path, bytes) in files {
        let target = folder.join(&path);
        let made = target.parent().map_or(Ok(()), fs::create_dir_all);
        match made.and_then(|()| write_beside(&target, |out| out.write_all(&bytes))) {
            Ok(file) => pending.push((path, file)),
            Err(error) => return Err((path, error)),
        }
    }
    for (path, file) in pending {
        file.keep().map_err(|error| (path, error))?;
    }
    Ok(())
}

fn failed(path: &Path, error: &io::Error) -> Ended {
    eprintln!("kake: cannot write {}: {}", path.display(), plain(error));
    eprintln!("kake: the runs are finished and kept; the same command writes the rest");
    Ended::Io
}

/// Says which runs could not be done: what all seeds of a condition met is said once.
fn failures(outcome: &Outcome) -> Ended {
    let mut said: BTreeMap<(usize, &str), Vec<u64>> = BTreeMap::new();
    for failure in &outcome.failures {
        said.entry((failure.condition, &failure.words)).or_default().push(failure.seed);
    }
    for ((condition, words), seeds) in &said {
        let name = &outcome.plan.conditions[*condition].name;
        let seeds = match seeds.as_slice() {
            seeds if seeds.len() == outcome.plan.seed_count() => "all its runs are".to_owned(),
            [seed] => format!("the run of seed {seed} is"),
            [first, ..] => format!("{} of its runs, the first that of seed {first}, are", seeds.len()),
            [] => continue,
        };
        eprintln!("kake: the condition `{name}` is at fault: {seeds} left out");
        eprint!("{words}");
    }
    if said.is_empty() { Ended::Done } else { Ended::Fault }
}

/// Says which pictures could not be drawn.
fn undrawn(pictures: &mut [Picture], outcome: &Outcome) -> Ended {
    let mut worst = Ended::Done;
    for picture in pictures {
        if let Err(words) = &picture.png {
            let name = &outcome.plan.conditions[picture.condition].name;
            eprintln!("kake: the condition `{name}` has no picture {}", picture.file);
            eprintln!("{}", words.trim_end());
            worst = Ended::Fault;
        }
    }
    worst
}

#[derive(Deserialize)]
struct Earlier {
    pictures: Vec<Drawn>,
    charts: Vec<String>,
}

#[derive(Deserialize)]
struct Drawn {
    file: String,
}

/// Pictures and charts that the folder's earlier outcome has, and this one has not.
fn stale(folder: &Path, files: &Files) -> Vec<PathBuf> {
    let Ok(bytes) = fs::read(folder.join(MADE)) else { return Vec::new() };
    let Ok(earlier) = serde_json::from_slice::<Earlier>(&bytes) else { return Vec::new() };
    let now: BTreeSet<&str> = files.iter().map(|(path, _)| path.as_str()).collect();
    let is_plain = |file: &str| !file.contains(['/', '\\']) && (file.ends_with(".png") || file.ends_with(".svg"));
    let pictures = earlier.pictures.into_iter().map(|drawn| (IMAGES, drawn.file));
    let all = pictures.chain(earlier.charts.into_iter().map(|file| (FIGURES, file)));
    let gone = all.filter(|(of, file)| is_plain(file) && !now.contains(format!("{of}/{file}").as_str()));
    gone.map(|(of, file)| folder.join(of).join(file)).collect()
}
