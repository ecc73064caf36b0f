//! The gallery: every picture on the page is what the scene above it draws.
//!
//! A picture carries its scene, so a test can tell without drawing whether it is that of another; then its pixels are
//! held against a new one, to within a grey level, for the last bit of an edge may differ between machines. Run with
//! `KAKE_PICTURES=write` to write the pictures anew.

use std::collections::BTreeSet;
use std::fs;
use std::io::Cursor;
use std::path::PathBuf;

use kakeami::back::metadata::{Metadata, extract};
use kakeami::back::png;
use kakeami::diag::Diagnostic;
use kakeami::loader::{LoadError, Loader, MemoryLoader};
use kakeami::{Config, compile};

use crate::documents::blocks;
use crate::support::{here, shown};

/// The page, from the root of the repository.
const PAGE: &str = "docs/gallery.md";

/// The folder of its pictures, as the page names them.
const PICTURES: &str = "pictures/gallery/";

/// All pictures together are not larger, in bytes.
const LARGEST: u64 = 2 << 20;

/// A scene of the page with the name of its picture.
struct Shown {
    name: String,
    text: String,
}

impl Shown {
    fn path(&self) -> PathBuf {
        here("docs").join(PICTURES).join(format!("{}.png", self.name))
    }

    /// The picture as it is drawn today, with the metadata that it carries.
    fn draw(&self) -> (Vec<u8>, Metadata) {
        let file = format!("{}.kake", self.name);
        let mut loader = MemoryLoader::default();
        loader.files.insert(file.clone(), self.text.as_bytes().into());
        let photograph = fs::read(here("examples/data/astronaut.png")).expect("the picture is there");
        loader.files.insert("data/astronaut.png".to_owned(), photograph.into());
        let compiled = compile(&file, &loader, &Config::default(), &mut ());
        let said = shown(&compiled.lowered.diagnostics, &compiled.lowered.sources);
        assert!(said.is_empty(), "{file}:\n{said}");
        let (Some(drawing), Some(scene)) = (compiled.drawing, compiled.lowered.scene) else {
            panic!("{file} draws nothing");
        };
        let sources = compiled.lowered.sources.iter();
        let metadata = Metadata {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            seed: scene.seed,
            scene: file,
            sources: sources.map(|(_, source)| (source.name.clone(), source.text.to_string())).collect(),
            ..Metadata::default()
        };
        let mut bytes = Vec::new();
        png::write(&drawing, Some(&metadata), &mut bytes).expect("memory takes all that is written");
        (bytes, metadata)
    }
}

/// The scenes of the page, each with the picture that is shown after it.
fn gallery() -> Vec<Shown> {
    let page = fs::read_to_string(here(PAGE)).expect("the page is there");
    let mut lines = page.lines();
    let mut after = 0;
    let mut gallery = Vec::new();
    for block in blocks(&page).into_iter().filter(|block| block.info == "kake") {
        let end = block.line + block.text.lines().count() + 1;
        lines.by_ref().take(end - after).for_each(drop);
        after = end;
        let shown = lines.clone().take_while(|line| !line.starts_with("```"));
        let picture = shown
            .filter_map(|line| line.split_once("]("))
            .find_map(|(_, target)| target.strip_prefix(PICTURES)?.split_once(".png").map(|(name, _)| name.to_owned()));
        let Some(name) = picture else { panic!("{PAGE}: no picture is shown of the scene at line {}", block.line) };
        gallery.push(Shown { name, text: block.text });
    }
    assert!(gallery.len() >= 12, "only {} scenes were found", gallery.len());
    gallery
}

fn pixels(bytes: &[u8]) -> image::GrayImage {
    let decoded = image::load(Cursor::new(bytes), image::ImageFormat::Png);
    decoded.expect("it is a PNG").into_luma8()
}

#[test]
fn pictures_are_of_the_scenes_above_them() {
    let writes = std::env::var_os("KAKE_PICTURES").is_some_and(|mode| mode == "write");
    let mut stale = Vec::new();
    for scene in gallery() {
        let (bytes, metadata) = scene.draw();
        let held = fs::read(scene.path()).unwrap_or_default();
        let carried = extract(&held);
        let is_same = carried.is_some_and(|carried| {
            let version = metadata.version.clone();
            Metadata { version, ..carried } == metadata && is_near(&pixels(&held), &pixels(&bytes))
        });
        if is_same {
            continue;
        }
        if writes {
            fs::create_dir_all(here("docs").join(PICTURES)).expect("the folder can be made");
            fs::write(scene.path(), &bytes).expect("the picture can be written");
        } else {
            stale.push(scene.name);
        }
    }
    assert!(
        stale.is_empty(),
        "not of their scenes: {stale:?}; `KAKE_PICTURES=write cargo test gallery` draws them anew"
    );
}

/// Whether two pictures differ by a grey level at most.
fn is_near(a: &image::GrayImage, b: &image::GrayImage) -> bool {
    a.dimensions() == b.dimensions() && a.pixels().zip(b.pixels()).all(|(a, b)| a.0[0].abs_diff(b.0[0]) <= 1)
}

#[test]
fn every_picture_has_its_scene() {
    let shown: Vec<String> = gallery().into_iter().map(|scene| format!("{}.png", scene.name)).collect();
    let names: BTreeSet<&str> = shown.iter().map(String::as_str).collect();
    assert_eq!(names.len(), shown.len(), "a picture is shown twice");
    let mut bytes = 0;
    let mut held = BTreeSet::new();
    for entry in fs::read_dir(here("docs").join(PICTURES)).expect("the folder is there") {
        let entry = entry.expect("the folder can be read");
        bytes += entry.metadata().expect("the file is there").len();
        held.insert(entry.file_name().to_string_lossy().into_owned());
    }
    assert_eq!(held.iter().map(String::as_str).collect::<BTreeSet<_>>(), names);
    assert!(bytes < LARGEST, "{bytes} bytes of pictures");
}

/// The tones of a library with their doc comments.
fn tones(library: &str) -> Vec<(String, bool)> {
    let lines: Vec<&str> = library.lines().collect();
    let declared = lines.iter().enumerate().filter_map(|(i, line)| {
        let name = line.strip_prefix("tone ")?.split('(').next()?;
        Some((name.to_owned(), i > 0 && lines[i - 1].starts_with("///")))
    });
    declared.collect()
}

#[test]
fn every_tone_of_the_library_is_documented_and_shown() {
    let library = fs::read_to_string(here("std/manga.kake")).expect("the library is there");
    let page = fs::read_to_string(here(PAGE)).expect("the page is there");
    let scenes: String = gallery().into_iter().map(|scene| scene.text).collect();
    let tones = tones(&library);
    assert!(tones.len() >= 10);
    for (name, is_documented) in tones {
        assert!(is_documented, "`{name}` has no doc comment");
        assert!(scenes.contains(&format!("with {name}")), "no scene shows `{name}`");
        assert!(page.contains(&format!("`{name}(")), "the page does not give the parameters of `{name}`");
    }
}

/// The libraries stand on their own: every tone and function is checked, and nothing is warned of.
#[test]
fn the_library_is_without_fault() {
    struct None;
    impl Loader for None {
        fn load(&self, _path: &str) -> Result<std::sync::Arc<[u8]>, LoadError> {
            Ok(b"import \"std:manga\"\nimport \"std:manga\" as manga\n".as_slice().into())
        }
    }
    let lowered = kakeami::lower::lower("scene.kake", &None, &kakeami::lower::LowerConfig::default());
    assert!(!lowered.diagnostics.iter().any(Diagnostic::is_error), "{}", shown(&lowered.diagnostics, &lowered.sources));
    assert!(lowered.diagnostics.is_empty(), "{}", shown(&lowered.diagnostics, &lowered.sources));
}
