//! A library with all it depends on, as they lie on disk.
//!
//! In: the root folder of a library. Out: its manifest, those of its dependencies and of theirs, where each lies, and what
//! each calls the others. Only folders whose `kake.toml` names a library can be depended on, so that no path opens folders
//! that were not meant to be read. Links are followed before anything is compared.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::diag::{Code, Diagnostic, Severity, sort};
use crate::library::lock::{Change, ContentHash, Locked};
use crate::library::{Dependency, LOCK, Lock, MANIFEST, Manifest};
use crate::loader::{self, UnknownDependency};
use crate::span::{Sources, Span, Syntax};
use crate::syntax;

use super::files::{plain, slashed};

/// More libraries than anyone depends on.
const MOST: usize = 256;

/// More files than a library has.
const MOST_FILES: usize = 100_000;

/// The largest manifest and lock file.
const LARGEST: u64 = 1 << 20;

/// Folders and files that are no part of a library: what other programs keep there.
const FOREIGN: [&str; 8] = [".git", ".hg", ".jj", ".svn", ".kake", ".DS_Store", "Thumbs.db", "desktop.ini"];

/// Whether a path of a library is no part of it.
pub(super) fn is_foreign(path: &str) -> bool {
    path.split('/').any(|part| FOREIGN.iter().any(|foreign| part.eq_ignore_ascii_case(foreign)))
}

/// One library.
#[derive(Debug)]
pub(super) struct Package {
    /// What its files' names begin with: `ink`, or `ink/base`; empty for the first one.
    pub(super) key: String,
    /// Its folder, links followed.
    pub(super) folder: PathBuf,
    /// Its folder from the first one's, as the manifests say.
    path: String,
    pub(super) manifest: Manifest,
    /// Where it is declared.
    declared: Option<Span>,
    /// What it calls its dependencies, with their places in the list.
    dependencies: BTreeMap<String, usize>,
}

/// A library with all it depends on.
#[derive(Debug)]
pub(super) struct Packages {
    /// The library itself first, then by how far away they are.
    list: Vec<Package>,
    /// The manifests' texts.
    pub(super) sources: Sources,
}

/// Why libraries cannot be found: what is wrong with their manifests.
#[derive(Debug)]
pub(super) struct Faults {
    pub(super) diagnostics: Vec<Diagnostic>,
    pub(super) sources: Sources,
}

impl Packages {
    /// Reads the manifest of a folder, if it has one, and finds all it depends on.
    pub(super) fn find(root: &Path) -> Result<Self, Faults> {
        let mut finder = Finder { diagnostics: Vec::new(), sources: Sources::new(), list: Vec::new() };
        let manifest = match root.join(MANIFEST).is_file() {
            true => finder.manifest(root, "").unwrap_or_default(),
            false => Manifest::default(),
        };
        let (key, path) = (String::new(), String::new());
        let dependencies = BTreeMap::new();
        finder.list.push(Package { key, folder: root.to_owned(), path, manifest, declared: None, dependencies });
        let mut next = 0;
        while next < finder.list.len() {
            finder.follow(next);
            next += 1;
        }
        finder.refuse_cycles();
        let Finder { mut diagnostics, sources, list } = finder;
        if diagnostics.is_empty() {
            return Ok(Self { list, sources });
        }
        sort(&mut diagnostics);
        Err(Faults { diagnostics, sources })
    }

    /// A folder without dependencies.
    pub(super) fn alone(root: &Path) -> Self {
        let root = Package {
            key: String::new(),
            folder: root.to_owned(),
            path: String::new(),
            manifest: Manifest::default(),
            declared: None,
            dependencies: BTreeMap::new(),
        };
        Self { list: vec![root], sources: Sources::new() }
    }

    /// The library of a key, which may be a longer one than its own.
    pub(super) fn get(&self, key: &str) -> Option<&Package> {
        let mut at = self.list.first()?;
        for name in key.split('/').filter(|name| !name.is_empty()) {
            at = self.list.get(*at.dependencies.get(name)?)?;
        }
        Some(at)
    }

    /// The key of what a library calls one of its dependencies.
    pub(super) fn dependency(&self, of: &str, name: &str) -> Result<String, UnknownDependency> {
        let of = self.get(of).ok_or_else(UnknownDependency::default)?;
        let found = of.dependencies.get(name).and_then(|&index| self.list.get(index));
        let known = || UnknownDependency { known: of.dependencies.keys().cloned().collect() };
        found.map(|package| package.key.clone()).ok_or_else(known)
    }

    /// The keys that stand for shorter ones.
    pub(super) fn aliases(&self) -> BTreeMap<String, String> {
        let all = self.list.iter().flat_map(|package| {
            package.dependencies.iter().filter_map(|(name, &index)| {
                let (chain, key) = (loader::key(&package.key, name), &self.list.get(index)?.key);
                (chain != *key).then(|| (chain, key.clone()))
            })
        });
        all.collect()
    }

    /// Every dependency, and theirs.
    pub(super) fn dependencies(&self) -> &[Package] {
        self.list.get(1..).unwrap_or_default()
    }

    /// The dependencies as they are now, or which of them cannot be read and why.
    pub(super) fn lock(&self) -> Result<Lock, String> {
        let locked = |package: &Package| {
            let failed = |error: io::Error| {
                format!("cannot read the files of the dependency `{}`: {}", package.key, plain(&error))
            };
            let version = package.manifest.library.as_ref().map(|library| library.version.clone());
            Ok(Locked {
                name: package.key.clone(),
                path: package.path.clone(),
                version: version.unwrap_or_default(),
                sha256: content(&package.folder).map_err(failed)?,
            })
        };
        let mut dependencies: Vec<Locked> = self.dependencies().iter().map(locked).collect::<Result<_, String>>()?;
        dependencies.sort_by(|a, b| a.name.cmp(&b.name));
        Ok(Lock { dependencies })
    }

    /// How the dependencies differ from what was locked, as warnings; none where nothing was. `sources` are the
    /// manifests' with the lock file's.
    pub(super) fn unlocked(&self) -> (Vec<Diagnostic>, Sources) {
        let mut sources = self.sources.clone();
        let Some(root) = self.list.first() else { return (Vec::new(), sources) };
        let file = root.folder.join(LOCK);
        if !file.is_file() {
            return (Vec::new(), sources);
        }
        let hint = "`kake lock` locks what is there now";
        let warning = |span: Option<Span>, message: String| {
            let diagnostic = Diagnostic::without_span(Code::Lock, message).hint(hint);
            Diagnostic { span, severity: Severity::Warning, ..diagnostic }
        };
        let text = match read_below(&root.folder, LOCK) {
            Ok(bytes) => bytes,
            Err(error) => return (vec![warning(None, format!("cannot read `{LOCK}`: {}", plain(&error)))], sources),
        };
        let parsed = syntax::decode(LOCK, &text, Syntax::Toml, &mut sources)
            .map_err(|diagnostic| vec![diagnostic])
            .and_then(|(source, text)| Lock::parse(source, &text));
        let was = match parsed {
            Ok(lock) => lock,
            Err(diagnostics) => {
                let warned = diagnostics.into_iter().map(|diagnostic| {
                    let hint = diagnostic.hint.clone().or_else(|| Some("`kake lock` writes the file anew".to_owned()));
                    Diagnostic { severity: Severity::Warning, hint, ..diagnostic }
                });
                return (warned.collect(), sources);
            }
        };
        let diagnostics = match self.lock() {
            Ok(now) => {
                was.changes(&now).iter().map(|change| warning(self.declared(change), change.to_string())).collect()
            }
            Err(words) => vec![warning(None, words)],
        };
        (diagnostics, sources)
    }

    /// Where a dependency is declared that is not what was locked.
    fn declared(&self, change: &Change) -> Option<Span> {
        self.dependencies().iter().find(|package| package.key == change.name())?.declared
    }
}

struct Finder {
    diagnostics: Vec<Diagnostic>,
    sources: Sources,
    list: Vec<Package>,
}

impl Finder {
    /// Reads the manifest of the library of a key.
    fn manifest(&mut self, folder: &Path, key: &str) -> Option<Manifest> {
        let name = loader::join(key, MANIFEST);
        let bytes = match read_below(folder, MANIFEST) {
            Ok(bytes) => bytes,
            Err(error) => {
                let message = format!("`{name}` cannot be read: {}", plain(&error));
                self.diagnostics.push(Diagnostic::without_span(Code::Manifest, message));
                return None;
            }
        };
        match syntax::decode(&name, &bytes, Syntax::Toml, &mut self.sources) {
            Ok((source, text)) => {
                let (manifest, diagnostics) = Manifest::parse(source, &text);
                self.diagnostics.extend(diagnostics);
                Some(manifest)
            }
            Err(diagnostic) => {
                self.diagnostics.push(diagnostic);
                None
            }
        }
    }

    /// Finds the dependencies of one library.
    fn follow(&mut self, index: usize) {
        let dependencies = self.list[index].manifest.dependencies.clone();
        for dependency in &dependencies {
            match self.find(index, dependency) {
                Ok(found) => {
                    self.list[index].dependencies.insert(dependency.name.clone(), found);
                }
                Err(diagnostic) => self.diagnostics.extend(diagnostic),
            }
        }
    }

    /// The place in the list of a library that another depends on. An error of its manifest is reported already.
    fn find(&mut self, of: usize, dependency: &Dependency) -> Result<usize, Option<Diagnostic>> {
        let Dependency { name, path, path_span, .. } = dependency;
        let wrong = |code, message: String, hint: &str| Diagnostic::error(code, *path_span, message).hint(hint);
        let depender = &self.list[of];
        let missing = |why: &str| {
            let message = format!("there is no library at `{path}`: {why}");
            wrong(Code::Dependency, message, "a library is a folder with a `kake.toml` that has `[library]`")
        };
        let folder = match depender.folder.join(path).canonicalize() {
            Ok(folder) => folder,
            Err(error) => return Err(Some(missing(&plain(&error)))),
        };
        if !folder.is_dir() {
            return Err(Some(missing("it is not a folder")));
        }
        if depender.folder == folder {
            let hint = "imports within a library are paths without a name";
            return Err(Some(wrong(Code::Manifest, "a library cannot depend on itself".to_owned(), hint)));
        }
        if depender.folder.starts_with(&folder) {
            let message = format!("the library at `{path}` lies around the one that depends on it");
            return Err(Some(wrong(Code::Manifest, message, "libraries lie beside each other, or within each other")));
        }
        if let Some(known) = self.list.iter().position(|package| package.folder == folder) {
            return Ok(known);
        }
        if self.list.len() >= MOST {
            let message = format!("more than {MOST} libraries depend on each other");
            return Err(Some(Diagnostic::error(Code::Limit, *path_span, message)));
        }
        if !folder.join(MANIFEST).is_file() {
            return Err(Some(missing("it has no `kake.toml`")));
        }
        let (key, place) = (loader::key(&depender.key, name), walked(&depender.path, path));
        let before = self.diagnostics.len();
        let Some(manifest) = self.manifest(&folder, &key) else { return Err(None) };
        if manifest.library.is_none() && self.diagnostics.len() == before {
            return Err(Some(missing("its `kake.toml` has no `[library]`")));
        }
        let declared = Some(dependency.name_span);
        let dependencies = BTreeMap::new();
        self.list.push(Package { key, folder, path: place, manifest, declared, dependencies });
        Ok(self.list.len() - 1)
    }

    /// Reports libraries that depend on each other in a round.
    fn refuse_cycles(&mut self) {
        // What is left when all that depend on nothing that is left are taken away, again and again.
        let mut left: BTreeSet<usize> = (0..self.list.len()).collect();
        loop {
            let depends = |index: &usize| self.list[*index].dependencies.values().any(|found| left.contains(found));
            let free: Vec<usize> = left.iter().copied().filter(|index| !depends(index)).collect();
            if free.is_empty() {
                break;
            }
            left.retain(|index| !free.contains(index));
        }
        // From any of them one comes round: every one depends on one that is left.
        let Some(&first) = left.first() else { return };
        let mut way = vec![first];
        while let Some((name, &next)) =
            way.last().and_then(|&at| self.list[at].dependencies.iter().find(|(_, found)| left.contains(found)))
        {
            let Some(start) = way.iter().position(|&passed| passed == next) else {
                way.push(next);
                continue;
            };
            let around = &way[start..];
            let called = |index: &usize| match self.list[*index].manifest.library.as_ref() {
                Some(library) => format!("`{}`", library.name),
                None => "this library".to_owned(),
            };
            let mut message = format!("{} depends on itself", called(&next));
            let others: Vec<String> = around.iter().skip(1).map(called).collect();
            if !others.is_empty() {
                message = format!("{message} by way of {}", others.join(" and "));
            }
            let last = way.last().map(|&at| &self.list[at]);
            let span = last.and_then(|at| at.manifest.dependencies.iter().find(|dependency| dependency.name == *name));
            let Some(span) = span.map(|dependency| dependency.name_span) else { return };
            let mut diagnostic = Diagnostic::error(Code::Cycle, span, message).label("and round again");
            for &passed in around.iter().skip(1) {
                let Some(declared) = self.list[passed].declared else { continue };
                diagnostic = diagnostic.note(declared, format!("{} is a dependency here", called(&passed)));
            }
            self.diagnostics.push(diagnostic);
            return;
        }
    }
}

/// A path from a folder that is itself a path, without steps there and back.
fn walked(from: &str, path: &str) -> String {
    let mut parts: Vec<&str> = from.split('/').filter(|part| !part.is_empty()).collect();
    for part in path.split('/') {
        match part {
            "" | "." => {}
            ".." if parts.last().is_some_and(|last| *last != "..") => {
                parts.pop();
            }
            part => parts.push(part),
        }
    }
    parts.join("/")
}

/// The place of a file of a folder that is to be written, its folder made: no link leads out of the folder.
pub(super) fn below(folder: &Path, file: &str) -> io::Result<PathBuf> {
    let out = || io::Error::other("a link there leads out of the library's folder");
    let target = folder.join(file);
    // The nearest folder that is there already says where new ones are made.
    let parent = target.parent().unwrap_or(folder);
    let there = parent.ancestors().find(|folder| folder.symlink_metadata().is_ok()).unwrap_or(folder);
    if !there.canonicalize()?.starts_with(folder) {
        return Err(out());
    }
    fs::create_dir_all(parent)?;
    match target.symlink_metadata() {
        Ok(kind) if kind.is_symlink() && !target.canonicalize().is_ok_and(|full| full.starts_with(folder)) => {
            Err(out())
        }
        _ => Ok(target),
    }
}

/// Reads a small file of a folder, which no link leads out of.
pub(super) fn read_below(folder: &Path, file: &str) -> io::Result<Vec<u8>> {
    let full = folder.join(file).canonicalize()?;
    if !full.starts_with(folder) {
        return Err(io::Error::other("it is a link that leads out of its folder"));
    }
    let kind = fs::metadata(&full)?;
    if !kind.is_file() {
        return Err(io::Error::other("it is not a file"));
    }
    if kind.len() > LARGEST {
        return Err(io::Error::other("it is larger than 1 MiB"));
    }
    fs::read(full)
}

/// The hash of a library's files. Links are part of it as what they say, not as what they lead to.
fn content(folder: &Path) -> io::Result<String> {
    let mut found: Vec<(String, PathBuf, fs::FileType)> = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(&next)? {
            let entry = entry?;
            let (path, kind) = (entry.path(), entry.file_type()?);
            let inside = slashed(path.strip_prefix(folder).unwrap_or(&path));
            if is_foreign(&inside) {
                continue;
            }
            if kind.is_dir() {
                folders.push(path);
            } else {
                found.push((inside, path, kind));
            }
            if found.len() + folders.len() > MOST_FILES {
                return Err(io::Error::other(format!("there are more than {MOST_FILES} of them")));
            }
        }
    }
    found.sort_by(|a, b| a.0.as_bytes().cmp(b.0.as_bytes()));
    let mut hash = ContentHash::default();
    for (inside, path, kind) in found {
        if kind.is_symlink() {
            hash.link(&inside, &fs::read_link(&path)?.to_string_lossy());
        } else if kind.is_file() {
            let mut file = fs::File::open(&path)?;
            let length = file.metadata()?.len();
            hash.file(&inside, length, &mut file)?;
        }
    }
    Ok(hash.finish())
}
