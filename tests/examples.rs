//! The example scenes: they compile as they stand, and formatting and converting leaves their meaning alone.

use std::fs;
use std::path::Path;

use kakeami::diag::{Code, Diagnostic};
use kakeami::span::{Sources, Syntax};
use kakeami::syntax::ast::Document;
use kakeami::syntax::{format, kake, toml};
use kakeami::{Compiled, Config, compile};

use crate::support::{Folder, each, formatted, here, name, scenes, shown, svg};

fn build(file: &str) -> Compiled {
    compile(file, &Folder(here("examples")), &Config::default(), &mut ())
}

fn is_library(path: &Path) -> bool {
    ["hand.kake", "manga.kake"].contains(&name(path))
}

#[test]
fn every_example_compiles() {
    each(&scenes("examples"), |path| {
        let compiled = build(name(path));
        let diagnostics = &compiled.lowered.diagnostics;
        let said = shown(diagnostics, &compiled.lowered.sources);
        if is_library(path) {
            let codes: Vec<Code> = diagnostics.iter().map(|diagnostic| diagnostic.code).collect();
            assert_eq!(codes, [Code::Empty], "{said}");
            assert!(compiled.lowered.scene.is_some(), "a library is a scene that draws nothing");
            return;
        }
        assert!(!diagnostics.iter().any(Diagnostic::is_error), "{said}");
        let marks: u64 = compiled.drawing.iter().flat_map(|drawing| &drawing.layers).map(|layer| layer.marks()).sum();
        assert!(marks > 0, "{} draws nothing", path.display());
    });
}

#[test]
fn both_hellos_are_one_drawing() {
    let [kake, toml] = ["hello.kake", "hello.toml"].map(|file| svg(&build(file).drawing.expect("it compiles")));
    assert!(kake == toml, "hello.kake and hello.toml draw different pictures");
}

/// Documents are compared by how they are written in TOML: that leaves places and plain comments out.
fn meaning(document: &Document) -> String {
    toml::write(document)
}

fn parse(text: &str) -> Document {
    let mut sources = Sources::new();
    let source = sources.add("scene.kake", text, Syntax::Kake);
    let (document, diagnostics) = kake::parse(source, text);
    assert!(diagnostics.is_empty(), "{}", shown(&diagnostics, &sources));
    document
}

/// Formatting is done once and for all, and keeps the meaning; so does the way to TOML and back.
fn keeps_its_meaning(path: &Path) {
    let text = fs::read_to_string(path).expect("the scene can be read");
    let document = parse(&text);
    let once = format::format(&document, &text);
    assert_eq!(formatted(&once), once, "{}: formatting twice is not formatting once", path.display());
    assert_eq!(meaning(&parse(&once)), meaning(&document), "{}: formatting changes the meaning", path.display());
    let comments = |text: &str| text.matches("//").count();
    assert_eq!(comments(&once), comments(&text), "{}: comments are lost", path.display());

    let converted = toml::write(&document);
    let mut sources = Sources::new();
    let source = sources.add("scene.toml", converted.as_str(), Syntax::Toml);
    let (back, diagnostics) = toml::read(source, &converted);
    assert!(diagnostics.is_empty(), "{}", shown(&diagnostics, &sources));
    assert_eq!(meaning(&back), converted, "{}: converting changes the meaning", path.display());
    let kake = format::format(&back, "");
    assert_eq!(meaning(&parse(&kake)), converted, "{}: converting back changes the meaning", path.display());
}

#[test]
fn formatting_and_converting_keep_the_meaning() {
    let all: Vec<_> = ["examples", "tests/cases/build"].into_iter().flat_map(scenes).collect();
    let kake: Vec<_> = all.into_iter().filter(|path| path.extension().is_some_and(|e| e == "kake")).collect();
    each(&kake, keeps_its_meaning);
}

/// The drawing of a scene that was converted is the same, to the last byte.
#[test]
fn converted_scenes_draw_the_same() {
    let root = here("tests/cases");
    let kake = scenes("tests/cases/build").into_iter().filter(|path| path.extension().is_some_and(|e| e == "kake"));
    let kake: Vec<_> = kake.filter(|path| name(path) != "set.kake").collect();
    each(&kake, |path| {
        let text = fs::read_to_string(path).expect("the case can be read");
        let document = parse(&text);
        let picture = |file: &str, text: String| {
            let loader = Overlay { file: format!("build/{file}"), text, rest: Folder(root.clone()) };
            let compiled = compile(&loader.file, &loader, &Config::default(), &mut ());
            let said = shown(&compiled.lowered.diagnostics, &compiled.lowered.sources);
            svg(&compiled.drawing.unwrap_or_else(|| panic!("{file}: {said}")))
        };
        let original = picture("scene.kake", text.clone());
        assert!(original == picture("scene.toml", toml::write(&document)), "{} in TOML", path.display());
        assert!(original == picture("scene.kake", format::format(&document, &text)), "{} formatted", path.display());
    });
}

/// A folder in which one file has another text.
struct Overlay {
    file: String,
    text: String,
    rest: Folder,
}

impl kakeami::loader::Loader for Overlay {
    fn load(&self, path: &str) -> Result<std::sync::Arc<[u8]>, kakeami::loader::LoadError> {
        if path == self.file { Ok(self.text.as_bytes().into()) } else { self.rest.load(path) }
    }
}
