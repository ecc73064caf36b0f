//! `kake diff`: what changed between two scenes, two revisions of one, or two copies that git holds out.

mod call;
mod findings;
mod git;
mod lines;
mod output;
mod page;
mod side;
mod tones;
mod words;

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use crate::Config;
use crate::compare::Difference;
use crate::diag::Diagnostic;
use crate::lower::LowerConfig;
use crate::span::Sources;

use super::build::cannot_write;
use super::files::{OpenError, plain, print};
use super::progress::Progress;
use super::{Ended, limits, report};

use call::{Call, Caller, Version};
use findings::{Findings, compare};
use git::Which;
use output::{Form, Sheets};
use side::{Given, Made, Side};
use words::Paintbox;

#[derive(Debug, Args)]
pub(super) struct DiffArgs {
    /// The old scene and the new one: files, pictures that hold a scene, or REVISION:PATH, as in HEAD~2:scene.kake (:PATH is
    /// what is staged). Or what git gives a driver
    #[arg(required = true, value_name = "OLD NEW")]
    sides: Vec<OsString>,
    /// A picture of what went, came and stayed: FILE.png, FILE.svg, or FILE.html with a slider between old and new; several
    /// times for several files. {name} in it is the scene's name
    #[arg(short, long, value_name = "FILE")]
    output: Vec<PathBuf>,
    /// How the findings are printed
    #[arg(long, value_enum, default_value_t = Format::Human)]
    format: Format,
    /// Set a parameter of both: NAME=VALUE. A side that has no such parameter goes without
    #[arg(long, value_name = "NAME=VALUE", value_parser = limits::parse_set)]
    set: Vec<(String, String)>,
    /// Replace the seed of both
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// Compare this paint alone
    #[arg(long, value_name = "PAINT")]
    only: Option<String>,
    /// The path in the repository that OLD and NEW are copies of: their imports and images are looked for there
    #[arg(long, value_name = "PATH")]
    path: Option<String>,
    /// The folder whose files the scenes may read
    #[arg(long, value_name = "DIR")]
    root: Option<PathBuf>,
    /// Lift a limit: tiles, strokes, iterations, megapixels, nesting or runs
    #[arg(long, value_name = "NAME=N", value_parser = limits::parse_limit)]
    limit: Vec<(limits::Limit, u64)>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Format {
    /// For people
    Human,
    /// A JSON object
    Json,
}

/// Of which files the lines that differ are shown after the words.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Lines {
    /// Of those that draw nothing by themselves: there is no picture that says more.
    OfLibraries,
    /// Of all: git shows none where a driver is set.
    OfAll,
}

/// Who calls, as the environment says.
fn caller() -> Caller {
    Caller::new(|name| std::env::var_os(name).is_some())
}

/// The command line with `--` before what git has appended to it, so that no path is taken for an option.
pub(super) fn guarded(arguments: impl IntoIterator<Item = OsString>) -> Vec<OsString> {
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    if arguments.get(1).is_some_and(|command| command == "diff") {
        call::guarded(arguments, caller())
    } else {
        arguments
    }
}

pub(super) fn run(arguments: &DiffArgs) -> Ended {
    let usage = |message: String| {
        eprintln!("kake: {message}");
        Ended::Usage
    };
    let forms: Result<Vec<Form>, String> = arguments.output.iter().map(|output| Form::of(output)).collect();
    let forms = match forms {
        Ok(forms) => forms,
        Err(message) => return usage(message),
    };
    let caller = caller();
    match call::call(&arguments.sides, caller) {
        Err(message) => usage(message),
        Ok(Call::Unmerged(path)) => {
            println!(
                "{} is not merged: its versions are compared when it is",
                words::printable(&path.display().to_string())
            );
            Ended::Done
        }
        Ok(Call::Pair(sides)) => {
            let [old, new] = sides.each_ref().map(Path::new);
            if old == Path::new("-") && new == Path::new("-") {
                return usage("standard input holds one scene, not two".to_owned());
            }
            if let Some(output) = arguments.output.iter().find(|output| is_same(output, old) || is_same(output, new)) {
                return usage(format!("{} is one of the scenes", output.display()));
            }
            let stands = arguments.path.clone().or_else(|| copied(caller));
            let given = Given { root: arguments.root.as_deref(), stands: stands.as_deref() };
            let opened = [(old, Which::Old), (new, Which::New)].map(|(side, which)| Side::open(side, &given, which));
            finish(arguments, &forms, opened, stands.as_deref(), Lines::OfLibraries)
        }
        Ok(Call::Driver(versions)) => drive(arguments, &forms, &versions),
    }
}

/// Where the file lies of which a tool is given copies.
fn copied(caller: Caller) -> Option<String> {
    match caller {
        Caller::Tool => std::env::var("BASE").ok().filter(|path| !path.is_empty()),
        Caller::Driver | Caller::Nobody => None,
    }
}

/// Answers git as a driver: it takes everything for a failure but 0, unless it was told to trust the exit status.
fn drive(arguments: &DiffArgs, forms: &[Form], versions: &[Version; 2]) -> Ended {
    let given = Given { root: arguments.root.as_deref(), stands: None };
    let [old, new] = versions;
    let opened = [(old, Which::Old), (new, Which::New)].map(|(version, which)| Side::version(version, &given, which));
    let name = new.path.to_string_lossy();
    let ended = finish(arguments, forms, opened, Some(&name), Lines::OfAll);
    match ended {
        Ended::Fault if git::trusts(&old.path) => Ended::Fault,
        Ended::Done | Ended::Fault | Ended::Usage | Ended::Io => Ended::Done,
    }
}

fn is_same(output: &Path, side: &Path) -> bool {
    matches!((output.canonicalize(), side.canonicalize()), (Ok(output), Ok(side)) if output == side)
}

/// Compiles both sides, compares them, says what differs and writes what is asked for.
fn finish(
    arguments: &DiffArgs,
    forms: &[Form],
    [old, new]: [Result<Side, OpenError>; 2],
    stands: Option<&str>,
    shown: Lines,
) -> Ended {
    let (old, new) = match (old, new) {
        (Ok(old), Ok(new)) => (old, new),
        (old, new) => {
            // Both are told of before it ends, by the worse of the two.
            let ended = [old.err(), new.err()].into_iter().flatten().map(report::cannot_open);
            return ended.max_by_key(|ended| matches!(ended, Ended::Io)).unwrap_or(Ended::Io);
        }
    };
    let mut progress = Progress::new();
    let mut config = Config { only: arguments.only.clone(), ..Config::default() };
    config.lower = LowerConfig {
        sets: arguments.set.clone(),
        seed: arguments.seed,
        dpi: None,
        limits: limits::apply(&arguments.limit),
    };
    progress.step("compiling both", "");
    let (before, after) = rayon::join(|| old.make(&config), || new.make(&config));
    progress.step("comparing", "");
    let mut findings = compare([&old.name, &new.name], [before.as_ref(), after.as_ref()]);
    let unknown = unknown_to_all(&arguments.set, [before.as_ref(), after.as_ref()]);
    let faulty = [&before, &after].map(|made| made.as_ref().is_some_and(Made::is_faulty));
    let mut said = Vec::new();
    for (name, made) in [(&old.name, &before), (&new.name, &after)] {
        said.extend(made.as_ref().map(|made| (name.clone(), made.diagnostics(), made.lowered.sources.clone())));
    }
    let texts = [&before, &after].map(|made| made.as_ref().map_or(String::new(), |made| made.text().to_owned()));
    let drawing = |made: Option<Made>| made.and_then(|made| made.drawing);
    let mut sheets = match faulty {
        [false, false] => Sheets::new(drawing(before), drawing(after)),
        _ => None,
    };
    let mut written = Ended::Done;
    if let Some(sheets) = &mut sheets
        && (!findings.same || !forms.is_empty())
    {
        progress.step("looking", "");
        let (difference, pixels) = sheets.pixels();
        findings.pixels = Some(pixels);
        progress.step("writing", "");
        written = write(arguments, forms, sheets, &difference, &findings, stands.unwrap_or(&new.name));
    }
    progress.finish();
    if arguments.format == Format::Human {
        diagnose(said);
    }
    if !unknown.is_empty() {
        for name in &unknown {
            eprintln!("kake: neither scene has a parameter `{}`", words::printable(name));
        }
        return Ended::Fault;
    }
    let printed = match arguments.format {
        Format::Human => {
            let paintbox = Paintbox::new();
            let mut text = words::words(&findings, paintbox);
            if shown == Lines::OfAll || findings.old.draws_nothing || findings.new.draws_nothing {
                text.push_str(&lines::lines([&old.name, &new.name], texts.each_ref().map(String::as_str), paintbox));
            }
            print(text.as_bytes())
        }
        Format::Json => match serde_json::to_string_pretty(&findings) {
            Ok(json) => print(format!("{json}\n").as_bytes()),
            Err(error) => {
                eprintln!("kake: {error}");
                Ended::Io
            }
        },
    };
    if !forms.is_empty() && sheets.is_none() {
        let why =
            if faulty == [false, false] { "neither draws anything by itself" } else { "not both scenes can be drawn" };
        eprintln!("kake: there is no picture of the difference: {why}");
    }
    match (printed, written) {
        (Ended::Done, Ended::Done) if findings.same => Ended::Done,
        (Ended::Done, Ended::Done) => Ended::Fault,
        (Ended::Done, failed) | (failed, _) => failed,
    }
}

/// Parameters that were set and that no side has.
fn unknown_to_all(sets: &[(String, String)], made: [Option<&Made>; 2]) -> Vec<String> {
    let names = sets.iter().map(|(name, _)| name);
    let is_unknown = |name: &&String| {
        made.iter().any(Option::is_some) && made.iter().flatten().all(|made| made.unknown.contains(*name))
    };
    names.filter(is_unknown).cloned().collect()
}

/// What is wrong with each side, under its name.
fn diagnose(said: Vec<(String, Vec<Diagnostic>, Sources)>) {
    for (name, found, sources) in said {
        if !found.is_empty() {
            eprintln!("{}:", words::printable(&name));
            report::diagnostics(&found, &sources);
        }
    }
}

/// Writes all outputs, or none.
fn write(
    arguments: &DiffArgs,
    forms: &[Form],
    sheets: &mut Sheets,
    difference: &Difference,
    findings: &Findings,
    name: &str,
) -> Ended {
    let mut pending = Vec::new();
    for (output, form) in arguments.output.iter().zip(forms) {
        let target = output::target(output, name);
        match output::write(*form, &target, sheets, difference, findings) {
            Ok(file) => pending.push((target, file)),
            Err(error) => return cannot_write(&target, &error),
        }
    }
    for (target, file) in pending {
        if let Err(error) = file.keep() {
            eprintln!("kake: cannot write {}: {}", target.display(), plain(&error));
            return Ended::Io;
        }
    }
    Ended::Done
}
