//! How scenes reach files: the one trait between the library and the file system.

use std::collections::BTreeMap;
use std::sync::Arc;

/// Reads the files that a scene names. Paths are relative to the scene's root, with forward slashes, and never lead out
/// of it: lowering has resolved `..` before it asks.
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

/// Joins a path that a file names to that file's own path, both relative to the root. `None` where it leads out of the
/// root or is absolute.
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
