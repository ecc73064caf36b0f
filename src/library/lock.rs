//! `kake.lock`: what the dependencies of a library were when it was last locked.
//!
//! ```toml
//! version = 1
//!
//! [[dependency]]
//! name = "ink"
//! path = "../ink"
//! version = "0.1.0"
//! sha256 = "9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08"
//! ```
//!
//! A dependency's hash is SHA-256 over all of its files in the order of their paths, each as its kind, its path, the
//! number of its bytes and the bytes as they are.

use std::fmt;
use std::io::{self, Read};

use sha2::{Digest, Sha256};

use crate::diag::{Code, Diagnostic, sort};
use crate::span::SourceId;
use crate::syntax::toml::data::{Entry, Kind, data};

/// The form of the file that this program reads and writes.
const VERSION: i64 = 1;

/// What a lock file holds.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Lock {
    /// Every dependency, those of dependencies too, in the order of their names.
    pub dependencies: Vec<Locked>,
}

/// One dependency as it was locked.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Locked {
    /// Its key: `ink`, or `ink/base` for what `ink` calls `base`.
    pub name: String,
    /// Its folder, relative to that of the library that is locked.
    pub path: String,
    /// Its version.
    pub version: String,
    /// The hash of its files, 64 hexadecimal digits.
    pub sha256: String,
}

/// How a dependency differs from what was locked.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Change {
    /// It was not locked.
    Added(String),
    /// It was locked, and nothing depends on it any more.
    Removed(String),
    /// Its files are others; the version that was locked and the one that is there.
    Content(String, [String; 2]),
    /// It lies elsewhere now, with the same files: where it was and where it is.
    Path(String, [String; 2]),
}

impl Change {
    /// The key of the dependency.
    #[must_use]
    pub fn name(&self) -> &str {
        match self {
            Self::Added(name) | Self::Removed(name) | Self::Content(name, _) | Self::Path(name, _) => name,
        }
    }
}

impl fmt::Display for Change {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Added(name) => write!(f, "the dependency `{name}` is not locked"),
            Self::Removed(name) => write!(f, "`{name}` is locked, but nothing depends on it"),
            Self::Content(name, [was, is]) if was == is => {
                write!(f, "the files of the dependency `{name}` are not those that were locked")
            }
            Self::Content(name, [was, is]) => {
                write!(f, "the dependency `{name}` was locked in version {was} and is version {is} now")
            }
            Self::Path(name, [was, is]) => {
                write!(f, "the dependency `{name}` was locked at `{was}` and lies at `{is}` now")
            }
        }
    }
}

impl Lock {
    /// Reads a lock file.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn parse(source: SourceId, text: &str) -> Result<Self, Vec<Diagnostic>> {
        let (entries, mut diagnostics) = data(source, text);
        let mut lock = Self::default();
        for entry in &entries {
            match (entry.key.as_str(), &entry.value.kind) {
                ("version", Kind::Integer(VERSION)) | (_, Kind::Lost) => {}
                ("version", _) => {
                    let message = "the lock file has a form that this program does not know";
                    diagnostics.push(
                        Diagnostic::error(Code::Lock, entry.value.span, message)
                            .hint("`kake lock` writes it anew; a newer kake may have written this one"),
                    );
                }
                ("dependency", Kind::List(list)) => {
                    for member in list {
                        match &member.kind {
                            Kind::Table(entries) => lock.dependencies.push(locked(entries, &mut diagnostics)),
                            _ => diagnostics.push(entry.wrong_type("an array of tables")),
                        }
                    }
                }
                _ => diagnostics.push(entry.unknown("a lock file", &["version", "dependency"])),
            }
        }
        lock.dependencies.sort_by(|a, b| a.name.cmp(&b.name));
        sort(&mut diagnostics);
        if diagnostics.is_empty() { Ok(lock) } else { Err(diagnostics) }
    }

    /// How what is there now differs from this, in the order of the names.
    #[must_use]
    pub fn changes(&self, now: &Self) -> Vec<Change> {
        let find = |lock: &Self, name: &str| lock.dependencies.iter().find(|locked| locked.name == name).cloned();
        let mut changes = Vec::new();
        for is in &now.dependencies {
            changes.extend(match find(self, &is.name) {
                None => Some(Change::Added(is.name.clone())),
                Some(was) if was.sha256 != is.sha256 => {
                    Some(Change::Content(is.name.clone(), [was.version, is.version.clone()]))
                }
                Some(was) if was.path != is.path => Some(Change::Path(is.name.clone(), [was.path, is.path.clone()])),
                Some(_) => None,
            });
        }
        let gone = self.dependencies.iter().filter(|was| find(now, &was.name).is_none());
        changes.extend(gone.map(|was| Change::Removed(was.name.clone())));
        changes.sort_by(|a, b| a.name().cmp(b.name()));
        changes
    }
}

/// As the text of the file.
impl fmt::Display for Lock {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "# What the dependencies were, written by `kake lock`. Keep it under version control.")?;
        writeln!(f, "version = {VERSION}")?;
        for locked in &self.dependencies {
            let Locked { name, path, version, sha256 } = locked;
            writeln!(f, "\n[[dependency]]")?;
            writeln!(f, "name = {}", quoted(name))?;
            writeln!(f, "path = {}", quoted(path))?;
            writeln!(f, "version = {}", quoted(version))?;
            writeln!(f, "sha256 = {}", quoted(sha256))?;
        }
        Ok(())
    }
}

/// A basic string of TOML.
#[must_use]
pub(super) fn quoted(text: &str) -> String {
    let mut out = String::from("\"");
    for character in text.chars() {
        match character {
            '"' | '\\' => out.extend(['\\', character]),
            '\n' => out.push_str("\\n"),
            control if control.is_control() => out.push_str(&format!("\\u{:04X}", u32::from(control))),
            other => out.push(other),
        }
    }
    out.push('"');
    out
}

fn locked(entries: &[Entry], diagnostics: &mut Vec<Diagnostic>) -> Locked {
    let mut locked = Locked::default();
    for entry in entries {
        let target = match entry.key.as_str() {
            "name" => &mut locked.name,
            "path" => &mut locked.path,
            "version" => &mut locked.version,
            "sha256" => &mut locked.sha256,
            _ => {
                diagnostics.push(entry.unknown("a locked dependency", &["name", "path", "version", "sha256"]));
                continue;
            }
        };
        match &entry.value.kind {
            Kind::Text(text) => target.clone_from(text),
            _ => diagnostics.push(entry.wrong_type("a string")),
        }
    }
    locked
}

/// The hash of a library's files, which are added in the order of their paths.
#[derive(Debug, Clone, Default)]
pub struct ContentHash(Sha256);

impl ContentHash {
    /// Adds a file of so many bytes.
    ///
    /// # Errors
    /// If it cannot be read, or if it has not that many bytes.
    pub fn file(&mut self, path: &str, length: u64, content: &mut dyn Read) -> io::Result<()> {
        self.begin(b'f', path, length);
        let mut chunk = [0; 1 << 14];
        let mut left = length;
        loop {
            let read = content.read(&mut chunk)?;
            match left.checked_sub(read as u64) {
                Some(rest) if read > 0 => left = rest,
                Some(0) => return Ok(()),
                _ => return Err(io::Error::other("it changed while it was read")),
            }
            self.0.update(chunk.get(..read).unwrap_or_default());
        }
    }

    /// Adds a link by what it leads to.
    pub fn link(&mut self, path: &str, target: &str) {
        self.begin(b'l', path, target.len() as u64);
        self.0.update(target.as_bytes());
    }

    fn begin(&mut self, kind: u8, path: &str, length: u64) {
        self.0.update([kind]);
        self.0.update((path.len() as u64).to_le_bytes());
        self.0.update(path.as_bytes());
        self.0.update(length.to_le_bytes());
    }

    /// The hash of all that was added, as hexadecimal digits.
    #[must_use]
    pub fn finish(self) -> String {
        self.0.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::span::{Sources, Syntax};

    fn parse(text: &str) -> Result<Lock, Vec<Diagnostic>> {
        let mut sources = Sources::new();
        let source = sources.add("kake.lock", text, Syntax::Toml);
        Lock::parse(source, text)
    }

    fn sample(name: &str, sha256: &str) -> Locked {
        let (name, sha256) = (name.to_owned(), sha256.to_owned());
        Locked { name, path: "../it \"here\"".to_owned(), version: "0.1.0".to_owned(), sha256 }
    }

    #[test]
    fn what_is_written_is_read() {
        for dependencies in [vec![], vec![sample("ink", "12"), sample("ink/base", "34")]] {
            let lock = Lock { dependencies };
            assert_eq!(parse(&lock.to_string()), Ok(lock));
        }
    }

    #[test]
    fn every_change_is_found() {
        let was = Lock { dependencies: vec![sample("cut", "1"), sample("ink", "2"), sample("old", "3")] };
        let moved = Locked { path: "../cut".into(), ..sample("cut", "1") };
        let now = Lock { dependencies: vec![moved, sample("ink", "5"), sample("new", "6")] };
        let words: Vec<String> = was.changes(&now).iter().map(ToString::to_string).collect();
        assert_eq!(
            words,
            [
                "the dependency `cut` was locked at `../it \"here\"` and lies at `../cut` now",
                "the files of the dependency `ink` are not those that were locked",
                "the dependency `new` is not locked",
                "`old` is locked, but nothing depends on it",
            ]
        );
        assert_eq!(now.changes(&now), []);
    }

    #[test]
    fn locks_of_other_forms_are_refused() {
        for text in ["version = 2\n", "[[dependency]]\nnam = \"x\"\n", "dependency = [1]\n", "<<<<<<< HEAD\n"] {
            assert!(parse(text).is_err(), "{text}");
        }
    }

    #[test]
    fn hashes_tell_files_apart() {
        let hash = |files: &[(&str, &str)]| {
            let mut hash = ContentHash::default();
            for (path, text) in files {
                hash.file(path, text.len() as u64, &mut text.as_bytes()).expect("memory can be read");
            }
            hash.finish()
        };
        // SHA-256 of nothing (FIPS 180-4).
        assert_eq!(hash(&[]), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
        let all = [hash(&[("a", "bc")]), hash(&[("ab", "c")]), hash(&[("a", "b"), ("c", "")]), hash(&[("a", "b\r\n")])];
        assert!((1..all.len()).all(|i| !all[..i].contains(&all[i])), "{all:?}");
        assert_eq!(all[0], hash(&[("a", "bc")]));
        let mut short = ContentHash::default();
        assert!(short.file("a", 3, &mut "ab".as_bytes()).is_err());
        assert!(ContentHash::default().file("a", 1, &mut "ab".as_bytes()).is_err());
    }
}
