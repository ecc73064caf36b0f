//! The thread that looks at scenes, one job after another.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{self, Sender};
use std::time::{Duration, Instant};
use std::{io, thread};

use lsp_server::RequestId;
use serde_json::Value;

use crate::diag::Diagnostic;
use crate::lsp::Analysis;
use crate::span::{SourceId, Sources};
use crate::stop::Stop;

use super::drafts::{Drafts, Texts};
use super::server::{Event, Refusal};

/// A scene that was looked at, with where its files lie.
#[derive(Debug)]
pub(super) struct Looked {
    pub(super) analysis: Analysis,
    /// The count of edits that it holds.
    pub(super) revision: u64,
    /// The root folder of its library.
    pub(super) root: PathBuf,
    places: Vec<Option<PathBuf>>,
    /// Where the files lie that it reads besides.
    reads: Vec<PathBuf>,
    /// What is wrong with the manifest of its library.
    pub(super) faults: Option<(PathBuf, Vec<Diagnostic>, Sources)>,
    pub(super) took: Duration,
}

impl Looked {
    /// Looks at the scene that is, or will be, at a path.
    pub(super) fn new(scene: &Path, texts: &Arc<Texts>, revision: u64, stop: &Stop) -> Self {
        let begun = Instant::now();
        let (mut drafts, name) = Drafts::of(scene, texts);
        let analysis = drafts.look(&name, stop.clone());
        let places = analysis.sources.iter().map(|(_, source)| drafts.place(&source.name)).collect();
        let reads = analysis.files.iter().filter_map(|name| drafts.place(name)).collect();
        let manifest = drafts.root().join(crate::library::MANIFEST);
        let faults = drafts.faults.take().map(|faults| (manifest, faults.diagnostics, faults.sources));
        let root = drafts.root().to_owned();
        Self { analysis, revision, root, places, reads, faults, took: begun.elapsed() }
    }

    /// The text of the scene itself.
    pub(super) fn main(&self) -> Option<SourceId> {
        self.analysis.sources.iter().next().map(|(id, _)| id)
    }

    /// Where a text lies, where it lies in a file.
    pub(super) fn place(&self, source: SourceId) -> Option<&Path> {
        let at = self.analysis.sources.iter().position(|(id, _)| id == source)?;
        self.places.get(at)?.as_deref()
    }

    /// Whether the scene reads a file.
    pub(super) fn reads(&self, path: &Path) -> bool {
        self.places.iter().flatten().chain(&self.reads).any(|place| place == path)
    }
}

/// What a job is about.
#[derive(Debug, Clone)]
pub(super) enum About {
    /// A look at the scene of this address.
    Scene(String),
    /// A request.
    Request(RequestId),
}

/// What a job came to.
#[derive(Debug)]
pub(super) enum Outcome {
    Looked(Box<Looked>),
    /// An answer, with words for the person.
    Answer(Result<Value, Refusal>, Option<String>),
    /// The program is at fault.
    Failed,
}

type Job = Box<dyn FnOnce() -> Outcome + Send>;

/// The thread's inbox.
pub(super) struct Worker {
    jobs: Sender<(About, Job)>,
}

impl Worker {
    /// Starts the thread. It ends when this is dropped.
    pub(super) fn new(events: Sender<Event>) -> io::Result<Self> {
        let (jobs, inbox) = mpsc::channel::<(About, Job)>();
        thread::Builder::new().spawn(move || {
            for (about, job) in inbox {
                // A fault of the program in one scene must not leave the editor without answers to all others.
                let outcome = catch_unwind(AssertUnwindSafe(job)).unwrap_or(Outcome::Failed);
                if events.send(Event::Done(about, outcome)).is_err() {
                    return;
                }
            }
        })?;
        Ok(Self { jobs })
    }

    /// Hands over a job.
    pub(super) fn start(&self, about: About, job: Job) {
        // The thread lives as long as this does.
        let _ = self.jobs.send((about, job));
    }
}
