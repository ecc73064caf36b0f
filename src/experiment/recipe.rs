//! All that the runs of an experiment depend on: the scene with every file it reads, and how it is compiled.
//!
//! A [`Recorder`] stands between a loader and lowering and keeps what is read. The [`Recipe`] that comes of it does not
//! look at the disk again: a file that is edited while runs are under way changes none of them, two sittings that have
//! equal recipes may share their runs, and the runs of several machines can be drawn on one that has no copy of the scene.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use base64::Engine;
use base64::engine::general_purpose::STANDARD as BASE64;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::Config;
use crate::loader::{self, LoadError, Loader, UnknownDependency};
use crate::lower::LowerConfig;
use crate::scene::Limits;

use super::plan::Setting;

/// What the runs of an experiment depend on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Recipe {
    /// The version of the program.
    pub version: String,
    /// The path of the scene from its root.
    pub scene: String,
    /// The experiment's name.
    pub experiment: String,
    /// First and last seed, where they are not the scene's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seeds: Option<[u64; 2]>,
    /// Parameters that every run sets, as expressions.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sets: Vec<(String, String)>,
    /// The resolution, in pixels per inch, where it is not the scene's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dpi: Option<f64>,
    /// The paint that is measured and drawn alone, where not all are.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub only: Option<String>,
    /// Limits that a scene can meet, by their names.
    pub limits: BTreeMap<String, u64>,
    /// Every file by its path from the root; libraries by the names they are imported by.
    pub files: BTreeMap<String, Bytes>,
    /// Keys of dependencies that go by another, shorter one.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub dependencies: BTreeMap<String, String>,
}

/// The bytes of a file: text stays legible where it is serialised.
#[derive(Debug, Clone, PartialEq)]
pub struct Bytes(pub Arc<[u8]>);

#[derive(Serialize, Deserialize)]
enum Written {
    #[serde(rename = "text")]
    Text(String),
    #[serde(rename = "base64")]
    Base64(String),
}

impl Serialize for Bytes {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match std::str::from_utf8(&self.0) {
            Ok(text) => Written::Text(text.to_owned()),
            Err(_) => Written::Base64(BASE64.encode(&self.0)),
        }
        .serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Bytes {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let bytes = match Written::deserialize(deserializer)? {
            Written::Text(text) => text.into_bytes(),
            Written::Base64(text) => BASE64.decode(text).map_err(serde::de::Error::custom)?,
        };
        Ok(Self(bytes.into()))
    }
}

impl Recipe {
    /// The limits by their names.
    #[must_use]
    pub fn named(limits: &Limits) -> BTreeMap<String, u64> {
        let &Limits { tiles, strokes, iterations, megapixels, nesting, runs, stop: _ } = limits;
        let names = [
            ("tiles", tiles),
            ("strokes", strokes),
            ("iterations", iterations),
            ("megapixels", megapixels),
            ("nesting", nesting),
            ("runs", runs),
        ];
        names.into_iter().map(|(name, value)| (name.to_owned(), value)).collect()
    }

    fn limits(&self) -> Limits {
        let default = Limits::default();
        let get = |name: &str, default: u64| self.limits.get(name).copied().unwrap_or(default);
        Limits {
            tiles: get("tiles", default.tiles),
            strokes: get("strokes", default.strokes),
            iterations: get("iterations", default.iterations),
            megapixels: get("megapixels", default.megapixels),
            nesting: get("nesting", default.nesting),
            runs: get("runs", default.runs),
            stop: default.stop,
        }
    }

    /// How a run is compiled that sets these besides.
    #[must_use]
    pub fn config(&self, settings: &[&[Setting]], seed: Option<u64>) -> Config {
        let mut sets = self.sets.clone();
        for setting in settings.iter().copied().flatten() {
            sets.retain(|(name, _)| *name != setting.param);
            sets.push((setting.param.clone(), setting.expression.clone()));
        }
        let lower = LowerConfig { sets, seed, dpi: self.dpi, limits: self.limits() };
        Config { lower, only: self.only.clone(), overlays: Vec::new() }
    }
}

impl Loader for Recipe {
    fn load(&self, path: &str) -> Result<Arc<[u8]>, LoadError> {
        self.files.get(path).map(|bytes| Arc::clone(&bytes.0)).ok_or(LoadError::Missing)
    }

    fn library(&self, name: &str) -> Option<Arc<[u8]>> {
        self.files.get(name).map(|bytes| Arc::clone(&bytes.0))
    }

    fn dependency(&self, of: &str, name: &str) -> Result<String, UnknownDependency> {
        let key = loader::key(of, name);
        Ok(self.dependencies.get(&key).cloned().unwrap_or(key))
    }
}

/// Keeps every file that is read through it, and reads each once.
#[derive(Debug)]
pub struct Recorder<'a, L: ?Sized> {
    loader: &'a L,
    kept: Mutex<Kept>,
}

/// What was read, and which dependencies go by shorter keys.
#[derive(Debug, Default)]
struct Kept {
    files: BTreeMap<String, Bytes>,
    dependencies: BTreeMap<String, String>,
}

impl<'a, L: Loader + ?Sized> Recorder<'a, L> {
    /// Reads through a loader.
    #[must_use]
    pub fn new(loader: &'a L) -> Self {
        Self { loader, kept: Mutex::default() }
    }

    /// What was read so far.
    #[must_use]
    pub fn files(&self) -> BTreeMap<String, Bytes> {
        self.lock().files.clone()
    }

    /// Keys of dependencies that go by another, shorter one.
    #[must_use]
    pub fn dependencies(&self) -> BTreeMap<String, String> {
        self.lock().dependencies.clone()
    }

    fn lock(&self) -> MutexGuard<'_, Kept> {
        self.kept.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl<L: Loader + ?Sized> Loader for Recorder<'_, L> {
    fn load(&self, path: &str) -> Result<Arc<[u8]>, LoadError> {
        if let Some(known) = self.lock().files.get(path) {
            return Ok(Arc::clone(&known.0));
        }
        let bytes = self.loader.load(path)?;
        self.lock().files.insert(path.to_owned(), Bytes(Arc::clone(&bytes)));
        Ok(bytes)
    }

    fn library(&self, name: &str) -> Option<Arc<[u8]>> {
        let bytes = self.loader.library(name)?;
        self.lock().files.insert(name.to_owned(), Bytes(Arc::clone(&bytes)));
        Some(bytes)
    }

    fn dependency(&self, of: &str, name: &str) -> Result<String, UnknownDependency> {
        let (chain, found) = (loader::key(of, name), self.loader.dependency(of, name)?);
        if found != chain {
            self.lock().dependencies.insert(chain, found.clone());
        }
        Ok(found)
    }
}
