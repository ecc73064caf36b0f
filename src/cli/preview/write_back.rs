//! Writing what was found back into the scene: values of parameters as their defaults, and the seed.
//!
//! Nothing is written unless the file is as it was drawn, and what comes out is a scene without fault.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::sync::Arc;

use serde::Deserialize;

use crate::cli::files::{FsLoader, plain, read_file, write_beside};
use crate::diag::Diagnostic;
use crate::loader::{LoadError, Loader, UnknownDependency};
use crate::lower::{LowerConfig, lower};
use crate::scene::{Limits, Param};
use crate::stop::Stop;
use crate::syntax::edit::{self, Changes};
use crate::syntax::kake::decode_utf8;

use super::save::fault;
use super::session::{Seed, Session};

/// What is to be written.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
pub(super) struct Writing {
    sets: BTreeMap<String, String>,
    seed: Option<Seed>,
    /// The state of the files that was drawn.
    revision: u64,
}

/// Why nothing was written.
#[derive(Debug)]
pub(super) enum Refused {
    /// The scene is not what was drawn.
    Changed(String),
    /// It cannot be written so.
    Fault(String),
    /// The file cannot be written.
    Io(String),
}

/// The scene's files, one of them with another text.
struct Draft<'a> {
    loader: &'a FsLoader,
    path: &'a str,
    bytes: Arc<[u8]>,
}

impl Loader for Draft<'_> {
    fn load(&self, path: &str) -> Result<Arc<[u8]>, LoadError> {
        if path == self.path { Ok(Arc::clone(&self.bytes)) } else { self.loader.load(path) }
    }

    fn library(&self, name: &str) -> Option<Arc<[u8]>> {
        self.loader.library(name)
    }

    fn dependency(&self, of: &str, name: &str) -> Result<String, UnknownDependency> {
        self.loader.dependency(of, name)
    }
}

/// Whether somebody has taken away the permission to write a file. A new file could take its place all the same, but
/// whoever locks a scene means it.
pub(super) fn is_locked(file: &Path) -> bool {
    fs::metadata(file).is_ok_and(|kind| kind.permissions().readonly())
}

/// Writes values and seed into the scene; what was written, by name.
pub(super) fn write_back(session: &Session, writing: &Writing, stop: &Stop) -> Result<Vec<String>, Refused> {
    let changed = || {
        Refused::Changed("the scene was saved since it was drawn; look at it as it is now, then write again".to_owned())
    };
    let drawn = session.last().text.clone();
    let Some((_, text)) = drawn.filter(|(drawn, _)| *drawn == writing.revision && session.revision() == *drawn) else {
        return Err(changed());
    };
    let opened = session.open().map_err(|unmade| Refused::Fault(unmade.words()))?;
    let place = opened.loader.place(&opened.path).filter(|_| opened.picture.is_none());
    let Some(place) = place else {
        return Err(Refused::Fault("the scene lies inside a picture, which is not written into".to_owned()));
    };
    let read =
        || read_file(&place).map_err(|error| Refused::Io(format!("the scene cannot be read: {}", plain(&error))));
    if is_locked(&place) {
        return Err(Refused::Fault("the scene's file may only be read; it was not written".to_owned()));
    }
    let bytes = read()?;
    if decode_utf8(&bytes).ok() != Some(&*text) {
        return Err(changed());
    }
    let limits = Limits { stop: stop.clone(), ..session.settings.limits.clone() };
    let sets = writing.sets.iter().map(|(name, value)| (name.clone(), value.clone())).collect();
    let config = LowerConfig { sets, seed: writing.seed.map(|seed| seed.0), dpi: None, limits };
    let lowered = lower(&opened.path, &opened.loader, &config);
    let Some(scene) = &lowered.scene else { return Err(Refused::Fault(first_error(&lowered.diagnostics))) };
    let Some((id, source)) = lowered.sources.iter().next() else { return Err(changed()) };
    let own = edit::params(id, source);
    let params: Vec<(String, String)> = scene
        .params
        .iter()
        .filter(|param| own.contains(&param.name) && param.value.text != param.default.text)
        .filter_map(|param| Some((param.name.clone(), value(param, writing.sets.get(&param.name)?))))
        .collect();
    let changes = Changes { params: &params, seed: writing.seed.map(|seed| seed.0) };
    let syntax = source.syntax;
    let edited = edit::edit(&text, syntax, &changes).map_err(|error| Refused::Fault(error.to_string()))?;
    let mark = if bytes.starts_with("\u{feff}".as_bytes()) { "\u{feff}" } else { "" };
    let new: Arc<[u8]> = format!("{mark}{edited}").into_bytes().into();
    let draft = Draft { loader: &opened.loader, path: &opened.path, bytes: Arc::clone(&new) };
    let after = lower(&opened.path, &draft, &LowerConfig { sets: Vec::new(), seed: None, ..config.clone() });
    if after.scene.is_none() {
        return Err(Refused::Fault(first_error(&after.diagnostics)));
    }
    let mut written: Vec<String> = params.into_iter().map(|(name, _)| name).collect();
    written.extend(writing.seed.map(|_| "seed".to_owned()));
    if edited == *text {
        return Ok(written);
    }
    // An end waits until the file is there.
    let _writing = session.writing();
    if read()? != bytes {
        return Err(changed());
    }
    let kept = write_beside(&place, |out| out.write_all(&new)).and_then(|file| file.keep());
    kept.map_err(|error| Refused::Io(format!("the scene cannot be written: {}", plain(&error))))?;
    eprintln!("kake: wrote {} into {}", written.join(", "), session.settings.given.display());
    Ok(written)
}

/// A value as an expression: as it was settled where that says it all, otherwise as it was given.
fn value(param: &Param, given: &str) -> String {
    match param.ty.as_str() {
        "number" | "length" | "angle" | "percentage" | "colour" | "string" | "bool" => param.value.text.clone(),
        _ => given.to_owned(),
    }
}

fn first_error(diagnostics: &[Diagnostic]) -> String {
    let first = diagnostics.iter().find(|diagnostic| diagnostic.is_error());
    first.map_or_else(|| "the scene has a fault".to_owned(), fault)
}
