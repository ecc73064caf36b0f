//! `kake convert`: .kake to .toml and back.

use std::fs;
use std::path::{Path, PathBuf};

use clap::Args;

use crate::bundle;
use crate::span::{Sources, Syntax};
use crate::syntax::{self, format, kake, toml};

use super::files::{plain, print, replace};
use super::{Ended, report};

#[derive(Debug, Args)]
pub(super) struct ConvertArgs {
    /// The scene, .kake or .toml
    input: PathBuf,
    /// Where to: a file of the other kind, or - for standard output
    output: PathBuf,
}

fn syntax(path: &Path) -> Option<Syntax> {
    let extension = path.extension()?.to_str()?;
    match extension.to_ascii_lowercase().as_str() {
        "kake" => Some(Syntax::Kake),
        "toml" => Some(Syntax::Toml),
        _ => None,
    }
}

pub(super) fn run(arguments: &ConvertArgs) -> Ended {
    let stdout = arguments.output == Path::new("-");
    let Some(from) = syntax(&arguments.input) else {
        eprintln!("kake: {} is neither .kake nor .toml", arguments.input.display());
        return Ended::Usage;
    };
    let other = match from {
        Syntax::Kake => Syntax::Toml,
        Syntax::Toml => Syntax::Kake,
    };
    let to = if stdout { Some(other) } else { syntax(&arguments.output) };
    let Some(to) = to else {
        eprintln!("kake: {} is neither .kake nor .toml", arguments.output.display());
        return Ended::Usage;
    };
    let bytes = match fs::read(&arguments.input) {
        Ok(bytes) => bytes,
        Err(error) => {
            eprintln!("kake: cannot read {}: {}", arguments.input.display(), plain(&error));
            return Ended::Io;
        }
    };
    let name = arguments.input.display().to_string();
    let mut sources = Sources::new();
    let (source, text) = match syntax::decode(&name, &bytes, from, &mut sources) {
        Ok(decoded) => decoded,
        Err(diagnostic) => return report::diagnostics(&[diagnostic], &sources),
    };
    if !bundle::split(&text).1.is_empty() {
        eprintln!("kake: {name} is a bundle, and its files would be lost");
        eprintln!("kake: `kake bundle {name} --extract DIR` takes it apart");
        return Ended::Usage;
    }
    let (document, diagnostics) = match from {
        Syntax::Kake => kake::parse(source, &text),
        Syntax::Toml => toml::read(source, &text),
    };
    if report::diagnostics(&diagnostics, &sources) == Ended::Fault {
        return Ended::Fault;
    }
    let converted = match to {
        Syntax::Kake => format::format(&document, if from == Syntax::Kake { &text } else { "" }),
        Syntax::Toml => toml::write(&document),
    };
    if to == Syntax::Toml && !document.comments.is_empty() {
        eprintln!("kake: note: {} comments other than `///` are left behind", document.comments.len());
    }
    if stdout {
        return print(converted.as_bytes());
    }
    replace(&arguments.output, &converted)
}
