//! How scenes reach files: the one trait between the library and the file system, and the names that files have.
//!
//! A file of the scene's own library is called by its path from the root, a file of a dependency by the dependency's key,
//! a colon and its path there: `ink:tones/wash.kake`. The key of what the dependency `ink` calls `base` is `ink/base`,
//! unless a shorter one leads to the same library.

use std::collections::BTreeMap;
use std::sync::Arc;

/// Reads the files that a scene names. Paths are relative to the root of a library, with forward slashes, and never lead
/// out of it: lowering has resolved `..` before it asks.
///
/// A loader that stands before another one passes every question on, those with an answer of their own as well.
pub trait Loader: Sync {
    /// The bytes of a file.
    ///
    /// # Errors
    /// Says why the file cannot be read, or that it lies outside the root (through a link, say).
    fn load(&self, path: &str) -> Result<Arc<[u8]>, LoadError>;

    /// What stands in for a standard library of the program (`std:manga`), where something does: a picture keeps the
    /// text that it was made with.
    fn library(&self, _name: &str) -> Option<Arc<[u8]>> {
        None
    }

    /// The key of what the library `of` (a key itself, empty for the scene's own) calls its dependency `name`.
    ///
    /// # Errors
    /// Where it has no such dependency.
    fn dependency(&self, of: &str, name: &str) -> Result<String, UnknownDependency> {
        Ok(key(of, name))
    }
}

/// Why a file cannot be read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum LoadError {
    /// There is none.
    Missing,
    /// It lies outside the root.
    Outside,
    /// Anything else, in the system's words.
    Unreadable(String),
}

/// A library has no dependency of the name that was asked for.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct UnknownDependency {
    /// Those that it has.
    pub known: Vec<String>,
}

/// Why a path names no file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Unfound {
    /// It leads out of the library that it lies in.
    Outside,
    /// It names a dependency that the library does not have.
    NoDependency {
        /// The name.
        name: String,
        /// The dependencies that there are.
        known: Vec<String>,
    },
}

/// Files held in memory.
#[derive(Debug, Clone, Default)]
pub struct MemoryLoader {
    /// The bytes by path.
    pub files: BTreeMap<String, Arc<[u8]>>,
}

impl Loader for MemoryLoader {
    fn load(&self, path: &str) -> Result<Arc<[u8]>, LoadError> {
        self.files.get(path).cloned().ok_or(LoadError::Missing)
    }
}

/// Whether dependencies may have this name: letters of the alphabet, digits, `-` and `_`, at least two of them and a
/// letter first (a single letter before a colon is a drive).
#[must_use]
pub fn is_name(name: &str) -> bool {
    (2..=64).contains(&name.len())
        && name.starts_with(|c: char| c.is_ascii_alphabetic())
        && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '-' || c == '_')
}

/// The key of what the library `of` calls `name`, unless another one leads to the same library.
#[must_use]
pub fn key(of: &str, name: &str) -> String {
    if of.is_empty() { name.to_owned() } else { format!("{of}/{name}") }
}

/// A file's name as the key of its library, empty for the scene's own, and the path in there.
#[must_use]
pub fn split(file: &str) -> (&str, &str) {
    match file.split_once(':') {
        Some((key, path)) if key.split('/').all(is_name) => (key, path),
        _ => ("", file),
    }
}

/// The name of the file at a path of a library.
#[must_use]
pub fn join(key: &str, path: &str) -> String {
    if key.is_empty() { path.to_owned() } else { format!("{key}:{path}") }
}

/// Finds the file that the file `from` means by a path: beside it in its own library, or in a dependency of that
/// (`"ink:tones/wash.kake"`).
///
/// # Errors
/// Where the path names no file.
pub fn find(loader: &dyn Loader, from: &str, path: &str) -> Result<String, Unfound> {
    let (of, beside) = split(from);
    match path.split_once(':') {
        Some((name, inside)) if is_name(name) => {
            let known = |unknown: UnknownDependency| unknown.known;
            let key = loader
                .dependency(of, name)
                .map_err(|unknown| Unfound::NoDependency { name: name.to_owned(), known: known(unknown) })?;
            resolve("", inside).map(|inside| join(&key, &inside)).ok_or(Unfound::Outside)
        }
        _ => resolve(beside, path).map(|path| join(of, &path)).ok_or(Unfound::Outside),
    }
}

/// Joins a path that a file names to that file's own path, both relative to the root of their library. `None` where it
/// leads out of the root or is absolute.
#[must_use]
pub fn resolve(from: &str, path: &str) -> Option<String> {
    let path = path.replace('\\', "/");
    if path.starts_with('/') || path.as_bytes().get(1) == Some(&b':') {
        return None;
    }
    let mut parts: Vec<&str> = from.split('/').collect();
    parts.pop();
    for part in path.split('/') {
        match part {
            "" | "." => {}
            ".." => {
                parts.pop()?;
            }
            name => parts.push(name),
        }
    }
    Some(parts.join("/"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_say_their_library() {
        assert_eq!(split("scene.kake"), ("", "scene.kake"));
        assert_eq!(split("ink:tones/wash.kake"), ("ink", "tones/wash.kake"));
        assert_eq!(split("ink/base:wash.kake"), ("ink/base", "wash.kake"));
        assert_eq!(split("C:wash.kake"), ("", "C:wash.kake"), "a drive is no library");
        assert_eq!(join("ink/base", "wash.kake"), "ink/base:wash.kake");
    }

    #[test]
    fn paths_stay_in_their_library() {
        let loader = MemoryLoader::default();
        let find = |from: &str, path: &str| find(&loader, from, path);
        assert_eq!(find("a/b.kake", "../c.kake"), Ok("c.kake".into()));
        assert_eq!(find("a/b.kake", "ink:x/c.kake"), Ok("ink:x/c.kake".into()));
        assert_eq!(find("ink:x/c.kake", "../d.png"), Ok("ink:d.png".into()));
        assert_eq!(find("ink:x/c.kake", "base:./e.kake"), Ok("ink/base:e.kake".into()));
        for (from, path) in [("a.kake", "../b.kake"), ("ink:a.kake", "../b.kake"), ("a.kake", "ink:../b.kake")] {
            assert_eq!(find(from, path), Err(Unfound::Outside), "{path} in {from}");
        }
        assert_eq!(find("a.kake", "ink:/etc/passwd"), Err(Unfound::Outside));
    }
}
