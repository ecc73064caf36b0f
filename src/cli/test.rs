//! `kake test`: does every swatch of a library look as it was pinned?

mod find;
mod judge;
mod keep;
mod words;

use std::path::{Path, PathBuf};

use clap::Args;
use rayon::prelude::*;

use crate::library::LOCK;
use crate::library::review::{Outcome, Review, Swatch};

use super::files::{OpenError, print};
use super::packages::{Faults, Packages};
use super::{Ended, report};
use find::{Library, find};
use judge::{Judged, judge, orphans};

#[derive(Debug, Args)]
pub(super) struct TestArgs {
    /// Libraries, folders of swatches, or swatches
    #[arg(value_name = "PATH", default_value = ".")]
    paths: Vec<PathBuf>,
    /// Pin every swatch as it is now, and remove pins that have no swatch
    #[arg(long)]
    accept: bool,
    /// Write report.md, junit.xml, review.html and the pictures into this folder, for a review system
    #[arg(long, value_name = "DIR")]
    report: Option<PathBuf>,
    /// How many swatches are built at a time; by default one for each core
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
    /// Test only swatches that have this in their names
    #[arg(long, value_name = "TEXT")]
    filter: Option<String>,
}

pub(super) fn run(arguments: &TestArgs) -> Ended {
    let libraries = match find(&arguments.paths, arguments.filter.as_deref()) {
        Ok(libraries) => libraries,
        Err((words, ended)) => {
            eprintln!("kake: {words}");
            return ended;
        }
    };
    if let Some(jobs) = arguments.jobs {
        // Fails only where the pool is there already, which nothing before this makes.
        let _ = rayon::ThreadPoolBuilder::new().num_threads(usize::from(jobs)).build_global();
    }
    let mut worst = Ended::Done;
    let mut reviews = Vec::new();
    for library in &libraries {
        let (ended, review) = test(library, arguments);
        worst = worse(worst, ended);
        reviews.push(review);
    }
    if let Some(folder) = &arguments.report {
        worst = worse(worst, keep::report(folder, &mut reviews));
    }
    worst
}

/// The graver of two ends: a file that could not be written is graver than a swatch that changed.
fn worse(a: Ended, b: Ended) -> Ended {
    match (a, b) {
        (Ended::Done, other) | (other, Ended::Done) => other,
        (Ended::Io, _) | (_, Ended::Io) => Ended::Io,
        (Ended::Usage, _) | (_, Ended::Usage) => Ended::Usage,
        (Ended::Fault, Ended::Fault) => Ended::Fault,
    }
}

/// Tests one library, prints what was found and accepts it if asked.
fn test(library: &Library, arguments: &TestArgs) -> (Ended, Review) {
    let packages = match Packages::find(&library.root) {
        Ok(packages) => packages,
        Err(Faults { diagnostics, sources }) => {
            let faults = diagnostics.iter().map(|diagnostic| diagnostic.message.clone()).collect();
            report::cannot_open(OpenError::Manifest(Faults { diagnostics, sources }));
            return (Ended::Fault, Review { title: library.folder(), swatches: Vec::new(), faults });
        }
    };
    let mut faults = locks(library, &packages);
    let mut judged: Vec<Judged> = library.swatches.par_iter().map(|file| judge(library, file)).collect();
    if library.is_whole {
        match orphans(library) {
            Ok(found) => judged.extend(found),
            Err(words) => faults.push(words),
        }
    }
    judged.sort_by(|a, b| a.swatch.name.cmp(&b.swatch.name));
    let swatches = judged.iter().map(|judged| judged.swatch.clone()).collect();
    let review = Review { title: library.title(&packages), swatches, faults };
    for said in review.swatches.iter().map(|swatch| &swatch.said).filter(|said| !said.is_empty()) {
        eprint!("{said}");
    }
    let accepted = if arguments.accept { keep::accept(library, &judged) } else { Ended::Done };
    let is_accepted = arguments.accept && accepted == Ended::Done;
    let printed = print(words::text(&review, is_accepted).as_bytes());
    let kept = if arguments.accept { accepted } else { keep::page(library, &review) };
    let ended = if is_passed(&review, is_accepted) { Ended::Done } else { Ended::Fault };
    (worse(worse(ended, kept), printed), review)
}

/// Whether all is as it should be.
fn is_passed(review: &Review, is_accepted: bool) -> bool {
    let passes = |swatch: &Swatch| swatch.outcome == Outcome::Same || is_accepted && swatch.outcome.is_acceptable();
    review.faults.is_empty() && review.swatches.iter().all(passes)
}

/// What is not locked as it is.
fn locks(library: &Library, packages: &Packages) -> Vec<String> {
    if !packages.dependencies().is_empty() && !library.root.join(LOCK).is_file() {
        return vec![format!("the dependencies are not locked: there is no {LOCK}; `kake lock` writes it")];
    }
    let (found, sources) = packages.unlocked();
    report::diagnostics(&found, &sources);
    found.into_iter().map(|diagnostic| format!("{}; `kake lock` locks what is there now", diagnostic.message)).collect()
}

/// Pins every swatch of the library in a folder as it is.
pub(super) fn pin_all(folder: &Path) -> Result<(), String> {
    let libraries = find(&[folder.to_owned()], None).map_err(|(words, _)| words)?;
    for library in &libraries {
        let judged: Vec<Judged> = library.swatches.par_iter().map(|file| judge(library, file)).collect();
        if let Some(broken) = judged.iter().find(|judged| judged.swatch.outcome == Outcome::Broken) {
            return Err(format!("{} does not compile:\n{}", broken.swatch.file, broken.swatch.said));
        }
        if keep::accept(library, &judged) != Ended::Done {
            return Err("its pins cannot be written".to_owned());
        }
    }
    Ok(())
}
