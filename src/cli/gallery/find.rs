//! The files that a gallery shows: libraries and folders opened up.

use std::fs;
use std::path::{Path, PathBuf};

use crate::cli::Ended;
use crate::library::{MANIFEST, Manifest};
use crate::span::{Sources, Syntax};
use crate::syntax;

use super::cannot_read;

/// The folders of a library that are shown.
const SHOWN: [&str; 2] = ["tones", "swatches"];

/// So many folders deep files are looked for.
const DEEPEST: usize = 16;

/// What was found.
#[derive(Debug, Default)]
pub(super) struct Found {
    /// What the gallery is called.
    pub(super) title: String,
    /// What it is about, where a library says so.
    pub(super) about: Option<String>,
    /// The name under which the files are imported elsewhere.
    pub(super) library: Option<String>,
    /// The files in the order they are shown.
    pub(super) files: Vec<PathBuf>,
}

/// Finds the files below some paths.
///
/// # Errors
/// Words where a path is not there or holds nothing, with how the command ends.
pub(super) fn find(paths: &[PathBuf]) -> Result<Found, (String, Ended)> {
    let mut found = Found::default();
    for path in paths {
        if path.to_string_lossy().starts_with("std:") {
            push(&mut found.files, path.clone());
            continue;
        }
        let kind = fs::metadata(path).map_err(|error| cannot_read(path, &error))?;
        if !kind.is_dir() {
            push(&mut found.files, path.clone());
            continue;
        }
        let mut files = Vec::new();
        let is_library = path.join(MANIFEST).is_file() || path.join(SHOWN[0]).is_dir();
        match is_library {
            true => SHOWN.iter().try_for_each(|folder| within(&path.join(folder), DEEPEST, &mut files))?,
            false => within(path, 0, &mut files)?,
        }
        if files.is_empty() {
            let words = match is_library {
                true => format!("{} has nothing in its folders `tones` and `swatches`", path.display()),
                false => format!("{} holds no .kake file", path.display()),
            };
            return Err((words, Ended::Usage));
        }
        for file in files {
            push(&mut found.files, file);
        }
    }
    match paths {
        [one] => name(one, &mut found),
        _ => found.title = "Gallery".to_owned(),
    }
    Ok(found)
}

fn push(files: &mut Vec<PathBuf>, file: PathBuf) {
    if !files.contains(&file) {
        files.push(file);
    }
}

/// The name of what one path leads to.
fn name(path: &Path, found: &mut Found) {
    let full = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    found.title = full.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
    let Ok(text) = fs::read_to_string(path.join(MANIFEST)) else { return };
    let mut sources = Sources::new();
    let source = sources.add(MANIFEST, text.as_str(), Syntax::Toml);
    // What is wrong with a manifest is said by whatever needs it whole.
    let (manifest, _) = Manifest::parse(source, &text);
    if let Some(library) = manifest.library {
        found.title.clone_from(&library.name);
        found.library = Some(library.name);
        found.about = library.description;
    }
}

/// The scenes in a folder and, so many levels deep, in those below, in order.
fn within(folder: &Path, deep: usize, files: &mut Vec<PathBuf>) -> Result<(), (String, Ended)> {
    if !folder.is_dir() {
        return Ok(());
    }
    let mut open = vec![(folder.to_owned(), deep)];
    let mut found = Vec::new();
    while let Some((folder, deep)) = open.pop() {
        let entries = fs::read_dir(&folder).map_err(|error| cannot_read(&folder, &error))?;
        for entry in entries {
            let entry = entry.map_err(|error| cannot_read(&folder, &error))?;
            let path = entry.path();
            // Links to folders may lead in circles.
            if entry.file_type().is_ok_and(|kind| kind.is_dir()) && deep > 0 {
                open.push((path, deep - 1));
            } else if is_scene(&path) {
                found.push(path);
            }
        }
    }
    found.sort();
    files.extend(found);
    Ok(())
}

/// Whether a file is a scene or a library: of those in TOML, which are many other things too, what reads as one.
fn is_scene(path: &Path) -> bool {
    let extension = path.extension().unwrap_or_default();
    if extension.eq_ignore_ascii_case("kake") {
        return path.is_file();
    }
    if !extension.eq_ignore_ascii_case("toml") || path.file_name().is_some_and(|name| name == MANIFEST) {
        return false;
    }
    let Ok(bytes) = fs::read(path) else { return false };
    let mut sources = Sources::new();
    let decoded = syntax::decode("", &bytes, Syntax::Toml, &mut sources);
    decoded.is_ok_and(|(source, text)| {
        let (document, diagnostics) = syntax::toml::read(source, &text);
        diagnostics.is_empty() && !document.statements.is_empty()
    })
}
