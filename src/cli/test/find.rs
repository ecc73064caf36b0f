//! Which swatches are tested.
//!
//! In: paths. Out: libraries with their swatches, every one once, in the order of their names.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::cli::Ended;
use crate::cli::files::{plain, slashed};
use crate::cli::packages::{Packages, is_foreign};
use crate::library::MANIFEST;

/// The folder of the swatches.
const SWATCHES: &str = "swatches";

/// A library that is tested.
#[derive(Debug)]
pub(super) struct Library {
    /// Its folder, links followed.
    pub(super) root: PathBuf,
    /// What is tested of it, in the order of the names.
    pub(super) swatches: Vec<File>,
    /// Whether all of it is, so that a pin without a swatch can be told.
    pub(super) is_whole: bool,
}

/// A swatch's file.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct File {
    /// The path below `swatches/` without its ending.
    pub(super) name: String,
    /// Where it lies, links not followed.
    pub(super) path: PathBuf,
}

impl Library {
    /// The library's name and version, or its folder's.
    pub(super) fn title(&self, packages: &Packages) -> String {
        match packages.get("").and_then(|package| package.manifest.library.as_ref()) {
            Some(library) => format!("{} {}", library.name, library.version),
            None => self.folder(),
        }
    }

    /// The name of its folder.
    pub(super) fn folder(&self) -> String {
        self.root.file_name().unwrap_or_default().to_string_lossy().into_owned()
    }
}

type Wrong = (String, Ended);

/// Finds the swatches at some paths, those alone whose names hold `filter`.
pub(super) fn find(paths: &[PathBuf], filter: Option<&str>) -> Result<Vec<Library>, Wrong> {
    let mut libraries: BTreeMap<PathBuf, Library> = BTreeMap::new();
    for path in paths {
        let full = path.canonicalize().map_err(|error| unreadable(path, &error))?;
        let Some(root) = full.ancestors().find(|folder| folder.join(MANIFEST).is_file()) else {
            let words = format!("{} lies in no library: no folder from there upwards has a {MANIFEST}", path.display());
            return Err((format!("{words}\nkake: `kake new DIR` makes a library"), Ended::Usage));
        };
        let folder = root.join(SWATCHES);
        let mut found = Vec::new();
        let is_whole = full == root;
        if full.is_file() {
            // A link is the swatch of its own name.
            let given = std::path::absolute(path).map_err(|error| unreadable(path, &error))?;
            let parent = given.parent().and_then(|parent| parent.canonicalize().ok());
            let given = match (parent, given.file_name()) {
                (Some(parent), Some(name)) => parent.join(name),
                _ => full.clone(),
            };
            if !given.starts_with(&folder) {
                let words = format!("{} is no swatch: it does not lie in {}", path.display(), folder.display());
                return Err((words, Ended::Usage));
            }
            found.extend(swatch(&folder, given));
            if found.is_empty() {
                return Err((format!("{} is no scene: swatches are .kake or .toml", path.display()), Ended::Usage));
            }
        } else {
            let from = if is_whole { folder.clone() } else { full.clone() };
            if !from.starts_with(&folder) {
                let words = format!("{} holds no swatches: they lie in {}", path.display(), folder.display());
                return Err((words, Ended::Usage));
            }
            walk(&folder, &from, &mut found).map_err(|error| unreadable(&from, &error))?;
        }
        found.retain(|file| filter.is_none_or(|filter| file.name.contains(filter)));
        let library = libraries.entry(root.to_owned()).or_insert_with(|| Library {
            root: root.to_owned(),
            swatches: Vec::new(),
            is_whole: false,
        });
        library.is_whole |= is_whole && filter.is_none();
        library.swatches.extend(found);
    }
    for library in libraries.values_mut() {
        library.swatches.sort();
        library.swatches.dedup();
        if let Some([one, other]) = library.swatches.windows(2).find(|pair| matches!(pair, [a, b] if a.name == b.name))
        {
            let words = format!("{} and {} have the same pin", one.path.display(), other.path.display());
            return Err((format!("{words}; give one of them another name"), Ended::Usage));
        }
    }
    if let Some(filter) = filter
        && libraries.values().all(|library| library.swatches.is_empty())
    {
        return Err((format!("no swatch has `{filter}` in its name"), Ended::Usage));
    }
    Ok(libraries.into_values().collect())
}

fn unreadable(path: &Path, error: &io::Error) -> Wrong {
    (format!("cannot read {}: {}", path.display(), plain(error)), Ended::Io)
}

/// The swatch at a path, if it is a scene.
fn swatch(folder: &Path, path: PathBuf) -> Option<File> {
    let is_scene = path
        .extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("kake") || extension.eq_ignore_ascii_case("toml"));
    let name = slashed(path.strip_prefix(folder).ok()?.with_extension("").as_path());
    is_scene.then_some(File { name, path })
}

/// Every swatch below a folder. Links to folders are not followed: they may lead round and out.
fn walk(folder: &Path, from: &Path, found: &mut Vec<File>) -> io::Result<()> {
    let mut folders = vec![from.to_owned()];
    while let Some(next) = folders.pop() {
        let entries = match fs::read_dir(&next) {
            Ok(entries) => entries,
            // A library may have no swatches yet.
            Err(error) if error.kind() == io::ErrorKind::NotFound && next == folder => return Ok(()),
            Err(error) => return Err(error),
        };
        for entry in entries {
            let entry = entry?;
            let (path, kind) = (entry.path(), entry.file_type()?);
            // Editors keep locks and copies under names that begin with a point.
            let name = entry.file_name().to_string_lossy().into_owned();
            if is_foreign(&name) || name.starts_with('.') {
                continue;
            }
            // Pipes and sockets are no scenes, and would be waited for; a link that leads nowhere is a broken swatch.
            let is_other = fs::metadata(&path).is_ok_and(|found| !found.is_file());
            if kind.is_dir() {
                folders.push(path);
            } else if !is_other {
                found.extend(swatch(folder, path));
            }
        }
    }
    Ok(())
}
