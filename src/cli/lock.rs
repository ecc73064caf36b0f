//! `kake lock`: what the dependencies of a library are, written down.

use std::fs;
use std::path::{Path, PathBuf};

use clap::Args;

use crate::library::{LOCK, MANIFEST};

use super::files::{OpenError, plain, replace};
use super::packages::{Packages, below};
use super::{Ended, report};

/// Digits of a hash that people are shown.
const DIGITS: usize = 12;

#[derive(Debug, Args)]
pub(super) struct LockArgs {
    /// The library's folder
    #[arg(default_value = ".")]
    folder: PathBuf,
    /// Change nothing; say what is not locked as it is, and fail if there is anything
    #[arg(long)]
    check: bool,
}

pub(super) fn run(arguments: &LockArgs) -> Ended {
    let folder = match arguments.folder.canonicalize() {
        Ok(folder) => folder,
        Err(error) => {
            eprintln!("kake: cannot read {}: {}", arguments.folder.display(), plain(&error));
            return Ended::Io;
        }
    };
    if !folder.join(MANIFEST).is_file() {
        eprintln!("kake: {} is no library: it has no {MANIFEST}", arguments.folder.display());
        eprintln!("kake: `kake new DIR` makes one");
        return Ended::Usage;
    }
    let packages = match Packages::find(&folder) {
        Ok(packages) => packages,
        Err(faults) => return report::cannot_open(OpenError::Manifest(faults)),
    };
    if arguments.check { check(&folder, &packages) } else { write(&folder, &packages) }
}

/// Says what is not as it was locked.
fn check(folder: &Path, packages: &Packages) -> Ended {
    if !folder.join(LOCK).is_file() && !packages.dependencies().is_empty() {
        eprintln!("kake: there is no {LOCK}; `kake lock` writes it");
        return Ended::Fault;
    }
    let (found, sources) = packages.unlocked();
    report::diagnostics(&found, &sources);
    if found.is_empty() { Ended::Done } else { Ended::Fault }
}

fn write(folder: &Path, packages: &Packages) -> Ended {
    let lock = match packages.lock() {
        Ok(lock) => lock,
        Err(words) => {
            eprintln!("kake: {words}");
            return Ended::Io;
        }
    };
    let (file, text) = (folder.join(LOCK), lock.to_string());
    if fs::read(&file).ok().as_deref() != Some(text.as_bytes()) {
        if let Err(error) = below(folder, LOCK) {
            eprintln!("kake: cannot write {}: {}", file.display(), plain(&error));
            return Ended::Io;
        }
        match replace(&file, &text) {
            Ended::Done => {}
            ended => return ended,
        }
    }
    let width = lock.dependencies.iter().map(|locked| locked.name.len()).max().unwrap_or(0);
    for locked in &lock.dependencies {
        let hash = locked.sha256.get(..DIGITS).unwrap_or_default();
        eprintln!("{:width$}  {}  {}  sha256:{hash}…", locked.name, locked.version, locked.path);
    }
    match lock.dependencies.len() {
        0 => eprintln!("this library has no dependencies"),
        1 => eprintln!("1 dependency is locked"),
        several => eprintln!("{several} dependencies are locked"),
    }
    Ended::Done
}
