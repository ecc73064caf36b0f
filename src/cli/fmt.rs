//! `kake fmt`: scenes in their canonical form.

use std::fs;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use clap::Args;

use crate::bundle;
use crate::span::{Sources, Syntax};
use crate::syntax::{self, format, kake};

use super::files::{plain, print, replace};
use super::{Ended, report};

#[derive(Debug, Args)]
pub(super) struct FmtArgs {
    /// Scenes in .kake; - reads standard input and prints the result
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Change nothing; name the files that are not in canonical form and fail if there are any
    #[arg(long)]
    check: bool,
}

pub(super) fn run(arguments: &FmtArgs) -> Ended {
    let mut worst = Ended::Done;
    for file in &arguments.files {
        let ended = one(file, arguments.check);
        worst = match (worst, ended) {
            (Ended::Done, ended) => ended,
            (Ended::Fault, Ended::Io | Ended::Usage) => ended,
            (worst, _) => worst,
        };
    }
    worst
}

fn one(file: &Path, check: bool) -> Ended {
    let stdin = file == Path::new("-");
    if file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml")) {
        eprintln!("kake: {} is TOML; `kake fmt` formats .kake files", file.display());
        return Ended::Usage;
    }
    let read = if stdin {
        let mut bytes = Vec::new();
        io::stdin().read_to_end(&mut bytes).map(|_| bytes)
    } else {
        fs::read(file)
    };
    let bytes = match read {
        Ok(bytes) => bytes,
        Err(error) => {
            eprintln!("kake: cannot read {}: {}", file.display(), plain(&error));
            return Ended::Io;
        }
    };
    let name = file.display().to_string();
    let formatted = match formatted(&name, &bytes) {
        Ok(formatted) => formatted,
        Err(ended) => return ended,
    };
    let unchanged = formatted.as_bytes() == bytes;
    match (check, stdin) {
        (true, _) if unchanged => Ended::Done,
        (true, _) => {
            let printed = print(format!("{name}\n").as_bytes());
            if printed == Ended::Done { Ended::Fault } else { printed }
        }
        (false, true) => print(formatted.as_bytes()),
        (false, false) if unchanged => Ended::Done,
        (false, false) => replace(file, &formatted),
    }
}

/// The canonical form of a scene; a scene with syntax errors has none.
fn formatted(name: &str, bytes: &[u8]) -> Result<String, Ended> {
    let mut sources = Sources::new();
    let (source, text) = match syntax::decode(name, bytes, Syntax::Kake, &mut sources) {
        Ok(decoded) => decoded,
        Err(diagnostic) => return Err(report::diagnostics(&[diagnostic], &sources)),
    };
    // The files behind a bundle's scene stay as they are.
    let (text, files) = bundle::split(&text);
    let (document, diagnostics) = kake::parse(source, text);
    if report::diagnostics(&diagnostics, &sources) == Ended::Fault {
        return Err(Ended::Fault);
    }
    let blank = if files.is_empty() { "" } else { "\n" };
    Ok(format::format(&document, text) + blank + files)
}
