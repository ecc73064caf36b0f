//! One side of a comparison: where a scene comes from, and what is compiled of it.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::cli::files::{FsLoader, OpenError, Opened, is_picture, open, picture, plain};
use crate::cli::{Ended, picture as pictures};
use crate::compare::Pattern;
use crate::diag::{Code, Diagnostic};
use crate::drawing::Drawing;
use crate::library::MANIFEST;
use crate::loader::{LoadError, Loader};
use crate::lower::{Lowered, lower};
use crate::metrics::{Measured, Measures, Scalars};
use crate::scene::Paint;
use crate::span;
use crate::{Compiled, Config, Observer, PaintStages, Step, compile};

use super::call::{Version, is_null, revision};
use super::git::{GitLoader, Repository, Which, below};

/// Paints of more tiles are not measured: it takes longer than anyone waits for a difference.
pub(super) const MOST_MEASURED: usize = 200_000;

/// A scene that is one side of a comparison.
pub(super) struct Side {
    /// What messages call it.
    pub(super) name: String,
    source: Source,
}

enum Source {
    /// There is none: the file came or went.
    Nothing,
    /// A file, or what a picture holds.
    Opened(Box<Opened>),
    /// A version in a repository, and the scene's path from its root.
    Git(Box<GitLoader>, String),
}

/// What a side is made with.
pub(super) struct Given<'a> {
    /// The folder whose files scenes may read.
    pub(super) root: Option<&'a Path>,
    /// Where in the repository the scene lies that both are versions of, where they are copies.
    pub(super) stands: Option<&'a str>,
}

impl Side {
    /// Without a scene.
    fn nothing(name: String) -> Self {
        Self { name, source: Source::Nothing }
    }

    /// Opens what a person names: a file, or a path of a revision.
    pub(super) fn open(side: &Path, given: &Given<'_>, which: Which) -> Result<Self, OpenError> {
        let name = side.display().to_string();
        if is_null(side) {
            return Ok(Self::nothing(name));
        }
        if side.is_dir() {
            let words = format!("{name} is a folder: scenes are compared one by one");
            return Err(OpenError::Words(words, Ended::Usage));
        }
        if let Some(stands) = given.stands
            && let Some(copy) = Self::copy(side, stands, given, which)?
        {
            return Ok(copy);
        }
        if side != Path::new("-")
            && !side.exists()
            && let Some((revision, path)) = side.to_str().and_then(revision)
        {
            return Self::revision(&name, revision, path, given);
        }
        let opened = open(side, given.root).map_err(|error| without_path(side, given).unwrap_or(error))?;
        Ok(Self { name, source: Source::Opened(Box::new(opened)) })
    }

    /// Opens a path of a revision.
    fn revision(name: &str, revision: &str, path: &str, given: &Given<'_>) -> Result<Self, OpenError> {
        let failed = |words: String| OpenError::Words(format!("cannot read {name}: {words}"), Ended::Io);
        let repository = Repository::find().map_err(failed)?;
        let state = repository.state(revision).map_err(failed)?;
        let Some(inside) = repository.path(path) else {
            return Err(failed("the path leads out of the repository".to_owned()));
        };
        let bytes = repository.read(&state, &inside).map_err(|error| {
            let beside = repository.beside(path).filter(|beside| repository.read(&state, beside).is_ok());
            failed(match (error, beside) {
                (LoadError::Missing, Some(beside)) => {
                    format!("there is no file `{inside}` there; did you mean `{revision}:{beside}`, or `{revision}:./{path}`?")
                }
                (LoadError::Missing, None) => format!("there is no file `{inside}` there"),
                (LoadError::Outside, _) => "it is a link that leads out of the repository".to_owned(),
                (LoadError::Unreadable(why), _) => why,
            })
        })?;
        let disk = |root: &str| repository.top.as_ref().map_or_else(|| PathBuf::from("."), |top| top.join(root));
        if is_picture(Path::new(&inside)) {
            let opened = picture(&bytes, &existing(disk("")), name.to_owned())?;
            return Ok(Self { name: name.to_owned(), source: Source::Opened(Box::new(opened)) });
        }
        let is_root = |folder: &str| repository.read(&state, &below(folder, MANIFEST)).is_ok();
        let root = root(&inside, given, &repository, is_root)?;
        let files = FsLoader::at(existing(disk(&root)), BTreeMap::new()).map_err(OpenError::Manifest)?;
        let path = from_root(&inside, &root);
        let loader = GitLoader::known(repository.clone(), state, root, files);
        Ok(Self { name: name.to_owned(), source: Source::Git(Box::new(loader), path) })
    }

    /// Opens what a driver is given.
    pub(super) fn version(version: &Version, given: &Given<'_>, which: Which) -> Result<Self, OpenError> {
        let name = version.path.display().to_string();
        if version.is_nothing() || is_null(&version.file) {
            return Ok(Self::nothing(name));
        }
        if version.is_other() {
            return Err(OpenError::Words(format!("{name} is a link or another repository, no scene"), Ended::Fault));
        }
        let path = version.path.to_string_lossy().replace('\\', "/");
        Self::in_repository(&version.file, &path, Some(version.hex.clone()), given, which)
    }

    /// Opens a copy of a version of a file that stands at a path of the repository; none where it is the file itself.
    fn copy(file: &Path, stands: &str, given: &Given<'_>, which: Which) -> Result<Option<Self>, OpenError> {
        let top = Repository::find().ok().and_then(|repository| repository.top);
        let own = top.and_then(|top| top.join(stands).canonicalize().ok());
        if !file.is_file() || file.canonicalize().ok() == own {
            return Ok(None);
        }
        let hex = Repository::hash(&file.canonicalize().unwrap_or_else(|_| file.to_owned()));
        Self::in_repository(file, stands, hex, given, which).map(Some)
    }

    /// Opens a file as the version of a path of the repository that a blob is.
    fn in_repository(
        file: &Path,
        path: &str,
        hex: Option<String>,
        given: &Given<'_>,
        which: Which,
    ) -> Result<Self, OpenError> {
        let failed = |error: &io::Error| {
            OpenError::Words(format!("cannot read {}: {}", file.display(), plain(error)), Ended::Io)
        };
        let bytes = fs::read(file).map_err(|error| failed(&error))?;
        let words = |words: String| OpenError::Words(format!("cannot read {path}: {words}"), Ended::Io);
        let repository = Repository::find().map_err(words)?;
        let disk = |root: &str| repository.top.as_ref().map_or_else(|| PathBuf::from("."), |top| top.join(root));
        // Of a version that git knows the beginning of its blob's name says which it is.
        let blob = hex.as_deref().filter(|hex| hex.bytes().any(|digit| digit != b'0')).and_then(|hex| hex.get(..7));
        let name = blob.map_or_else(|| path.to_owned(), |blob| format!("{path} ({blob})"));
        if is_picture(Path::new(path)) {
            let opened = picture(&bytes, &existing(disk("")), name.clone())?;
            return Ok(Self { name, source: Source::Opened(Box::new(opened)) });
        }
        let root = root(path, given, &repository, |folder| disk(folder).join(MANIFEST).is_file())?;
        let inside = from_root(path, &root);
        let bytes: Arc<[u8]> = bytes.into();
        let held = (inside.clone(), Arc::clone(&bytes));
        let files = FsLoader::at(existing(disk(&root)), BTreeMap::from([held.clone()])).map_err(OpenError::Manifest)?;
        let sought = (path.to_owned(), hex.unwrap_or_default(), which);
        let loader = GitLoader::sought(repository.clone(), sought, root, held, files);
        Ok(Self { name, source: Source::Git(Box::new(loader), inside) })
    }

    /// Compiles it; none where there is no scene.
    pub(super) fn make(&self, config: &Config) -> Option<Made> {
        let mut config = config.clone();
        let (loader, path): (&dyn Loader, &str) = match &self.source {
            Source::Nothing => return None,
            Source::Opened(opened) => {
                pictures::take_over(&mut config, opened);
                config.overlays = pictures::overlays(&[], opened);
                (&opened.loader, &opened.path)
            }
            Source::Git(loader, path) => (loader.as_ref(), path),
        };
        // What was set by hand may be new: a side that does not know it goes without.
        let mut unknown = Vec::new();
        if !config.lower.sets.is_empty() {
            let sets = std::mem::take(&mut config.lower.sets);
            let plain = lower(path, loader, &config.lower);
            config.lower.sets = sets;
            if let Some(scene) = &plain.scene {
                let is_known = |set: &(String, String)| scene.params.iter().any(|param| param.name == set.0);
                let (known, others) = config.lower.sets.into_iter().partition(is_known);
                (config.lower.sets, unknown) = (known, others);
            }
        }
        let mut watch = Watch::default();
        let Compiled { drawing, lowered, .. } = compile(path, loader, &config, &mut watch);
        let stood = match &self.source {
            Source::Git(loader, _) => loader.found().map(str::to_owned),
            Source::Opened(_) | Source::Nothing => None,
        };
        let unknown = unknown.into_iter().map(|(name, _)| name).collect();
        Some(Made { drawing, lowered, painted: watch.painted, unknown, stood })
    }
}

/// What is said of a file that is not there and has the name of a revision.
fn without_path(side: &Path, given: &Given<'_>) -> Option<OpenError> {
    let name = side.to_str().filter(|_| !side.exists())?;
    Repository::find().ok()?.state(name).ok()?;
    let path = given.stands.unwrap_or("scene.kake");
    let words = format!("cannot read {name}: no such file or directory; a revision needs a path: `{name}:{path}`");
    Some(OpenError::Words(words, Ended::Io))
}

/// The nearest folder upwards that is there.
fn existing(folder: PathBuf) -> PathBuf {
    let there = folder.ancestors().find(|folder| folder.is_dir()).unwrap_or(Path::new("."));
    there.canonicalize().unwrap_or(folder)
}

/// The folder of what a scene in a repository may read, from the top: what the command line says, or the nearest upwards
/// that is one, or the scene's own.
fn root(
    path: &str,
    given: &Given<'_>,
    repository: &Repository,
    is_root: impl Fn(&str) -> bool,
) -> Result<String, OpenError> {
    let folder = path.rsplit_once('/').map_or("", |(folder, _)| folder);
    if let Some(root) = given.root {
        let failed = |words: &str| OpenError::Words(format!("{} {words}", root.display()), Ended::Usage);
        let full = root.canonicalize().map_err(|error| {
            OpenError::Words(format!("cannot read {}: {}", root.display(), plain(&error)), Ended::Io)
        })?;
        let top = repository.top.as_ref().ok_or_else(|| failed("lies in no working tree"))?;
        let inside = full.strip_prefix(top).map_err(|_| failed("does not lie in the repository"))?;
        let inside = crate::cli::files::slashed(inside);
        if !inside.is_empty() && folder != inside && !folder.starts_with(&format!("{inside}/")) {
            return Err(failed(&format!("does not hold {path}")));
        }
        return Ok(inside);
    }
    let mut at = folder;
    loop {
        if is_root(at) {
            return Ok(at.to_owned());
        }
        match at.rsplit_once('/') {
            Some((above, _)) => at = above,
            None if at.is_empty() => return Ok(folder.to_owned()),
            None => at = "",
        }
    }
}

/// A path from the root, of one from the top.
fn from_root(path: &str, root: &str) -> String {
    let inside = path.strip_prefix(root).unwrap_or(path);
    inside.strip_prefix('/').filter(|_| !root.is_empty()).unwrap_or(inside).to_owned()
}

/// What is compiled of a side.
pub(super) struct Made {
    /// The picture, unless the scene is at fault.
    pub(super) drawing: Option<Drawing>,
    pub(super) lowered: Lowered,
    /// The paints, from the bottom up.
    pub(super) painted: Vec<Painted>,
    /// Parameters that were set and that the scene does not have.
    pub(super) unknown: Vec<String>,
    /// The state of the repository in which the scene's imports and images were read, where that was found out.
    pub(super) stood: Option<String>,
}

impl Made {
    /// Whether anything keeps it from being drawn.
    pub(super) fn is_faulty(&self) -> bool {
        let is_faulty = self.lowered.diagnostics.iter().any(Diagnostic::is_error);
        (self.drawing.is_none() || is_faulty) && !self.draws_nothing()
    }

    /// Whether it is without fault and has nothing to draw, as libraries of tones have not.
    pub(super) fn draws_nothing(&self) -> bool {
        let mut errors = self.lowered.diagnostics.iter().filter(|diagnostic| diagnostic.is_error()).peekable();
        self.drawing.is_none() && errors.peek().is_some() && errors.all(|error| error.code == Code::Empty)
    }

    /// What is to be said of it: that it draws nothing is none of that.
    pub(super) fn diagnostics(&self) -> Vec<Diagnostic> {
        self.lowered.diagnostics.iter().filter(|diagnostic| diagnostic.code != Code::Empty).cloned().collect()
    }

    /// The scene's own text.
    pub(super) fn text(&self) -> &str {
        self.own().next().map_or("", |source| source.text.as_ref())
    }

    /// The texts that were read, the scene's first.
    fn own(&self) -> impl Iterator<Item = &span::Source> {
        self.lowered.sources.iter().map(|(_, source)| source).filter(|source| !source.name.starts_with("--"))
    }

    /// Every text and file that was read, for whoever wants to know whether one changed.
    pub(super) fn texts(&self) -> (Vec<&str>, Vec<&[u8]>) {
        (
            self.own().map(|source| source.text.as_ref()).collect(),
            self.lowered.files.values().map(AsRef::as_ref).collect(),
        )
    }
}

/// What is compared of a paint besides its marks.
pub(super) struct Painted {
    pub(super) name: String,
    /// What is painted and with what, to tell a paint of another name by.
    pub(super) likeness: [String; 2],
    pub(super) pattern: Pattern,
    /// What it measures from, unless it has too many tiles.
    measured: Option<Box<Measured>>,
}

impl Painted {
    /// What it measures; none where it has too many tiles.
    pub(super) fn scalars(&self) -> Option<Scalars> {
        self.measured.as_deref().map(|measured| Measures::new(measured).scalars())
    }
}

/// Keeps what is compared of every paint as it is compiled.
#[derive(Default)]
struct Watch {
    painted: Vec<Painted>,
}

impl Observer for Watch {
    fn begin(&mut self, _step: Step, _paint: &str) {}

    fn found(&mut self, paint: &Paint, stages: &PaintStages) {
        let pattern = Pattern::new(&stages.sites, &stages.angles, &stages.tiles);
        let is_small = stages.tiles.len() <= MOST_MEASURED;
        let json = |value: Result<String, _>| value.unwrap_or_else(|_: serde_json::Error| paint.name.clone());
        self.painted.push(Painted {
            name: paint.name.clone(),
            likeness: [json(serde_json::to_string(&paint.region)), json(serde_json::to_string(&paint.tone))],
            pattern,
            measured: is_small.then(|| Box::new(Measured::new(paint, &stages.borrow()))),
        });
    }
}
