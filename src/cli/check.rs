//! `kake check`: what is wrong with scenes.

use std::collections::BTreeSet;
use std::path::PathBuf;

use clap::{Args, ValueEnum};
use serde_json::Value;

use crate::diag::{Diagnostic, to_json};
use crate::lower::lower;
use crate::span::Sources;

use super::files::{OpenError, open, print};
use super::{Ended, SceneArgs, report};

#[derive(Debug, Args)]
pub(super) struct CheckArgs {
    #[command(flatten)]
    first: SceneArgs,
    /// Further scenes
    more: Vec<PathBuf>,
    /// How the diagnostics are printed
    #[arg(long, value_enum, default_value_t = Format::Human)]
    format: Format,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Format {
    /// For people, on standard error
    Human,
    /// A JSON list on standard output
    Json,
}

/// Prints diagnostics, or puts them to those that are printed in the end.
fn say(format: Format, diagnostics: &[Diagnostic], sources: &Sources, all: &mut Vec<Value>) {
    match format {
        Format::Human => {
            report::diagnostics(diagnostics, sources);
        }
        Format::Json => match to_json(diagnostics, sources) {
            Value::Array(list) => all.extend(list),
            other => all.push(other),
        },
    }
}

pub(super) fn run(arguments: &CheckArgs) -> Ended {
    let mut ended = Ended::Done;
    let mut all = Vec::new();
    let mut warned = BTreeSet::new();
    for scene in std::iter::once(&arguments.first.scene).chain(&arguments.more) {
        let opened = match open(scene, arguments.first.root.as_deref()) {
            Ok(opened) => opened,
            Err(OpenError::Manifest(faults)) => {
                say(arguments.format, &faults.diagnostics, &faults.sources, &mut all);
                ended = if ended == Ended::Done { Ended::Fault } else { ended };
                continue;
            }
            Err(error) => {
                ended = report::cannot_open(error);
                continue;
            }
        };
        let mut config = arguments.first.config(None);
        super::picture::take_over(&mut config, &opened);
        let lowered = lower(&opened.path, &opened.loader, &config.lower);
        // Several scenes of a library have the same dependencies.
        if warned.insert(opened.loader.root().to_owned()) {
            let (warnings, sources) = opened.loader.packages().unlocked();
            say(arguments.format, &warnings, &sources, &mut all);
        }
        say(arguments.format, &lowered.diagnostics, &lowered.sources, &mut all);
        if lowered.diagnostics.iter().any(Diagnostic::is_error) && ended == Ended::Done {
            ended = Ended::Fault;
        }
    }
    if arguments.format == Format::Json {
        let printed = print(format!("{:#}\n", Value::Array(all)).as_bytes());
        if printed != Ended::Done {
            return printed;
        }
    }
    ended
}
