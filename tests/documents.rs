//! The documents hold what they say: every scene in them compiles, every picture and page they point to is there.
//!
//! Blocks marked `kake` are compiled as they stand, as files of the folder `examples`: scenes that draw to a drawing,
//! libraries to a scene without errors. Blocks marked `toml` that draw are compiled as TOML. Blocks marked
//! `kake,fragment` are left alone.

#![allow(clippy::panic)]

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use kakeami::loader::{LoadError, Loader};
use kakeami::lower::LowerConfig;
use kakeami::{Config, compile};

/// The documents with scenes in them.
const DOCUMENTS: &[&str] = &[
    "README.md",
    "docs/editors.md",
    "docs/language.md",
    "docs/gallery.md",
    "docs/angles.md",
    "docs/diff.md",
    "docs/experiments.md",
    "docs/grain.md",
    "docs/libraries.md",
    "docs/metrics.md",
    "docs/paper.md",
    "docs/preview.md",
    "docs/sheets.md",
    "docs/statistics.md",
];

fn repository() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// A block's text under a name that no example has, with the examples beside it.
struct Beside<'t> {
    name: &'t str,
    text: &'t str,
}

impl Loader for Beside<'_> {
    fn load(&self, path: &str) -> Result<Arc<[u8]>, LoadError> {
        if path == self.name {
            return Ok(self.text.as_bytes().into());
        }
        match fs::read(repository().join("examples").join(path)) {
            Ok(bytes) => Ok(bytes.into()),
            Err(error) => Err(LoadError::Unreadable(error.to_string())),
        }
    }
}

/// A block of code in a document.
pub(crate) struct Block {
    /// What stands behind its first fence.
    pub(crate) info: String,
    pub(crate) text: String,
    /// The line of the document that its first fence is on.
    pub(crate) line: usize,
}

/// The blocks of code of a document, fenced by three backticks at the start of a line.
pub(crate) fn blocks(document: &str) -> Vec<Block> {
    let mut blocks = Vec::new();
    let mut open: Option<Block> = None;
    for (number, line) in document.lines().enumerate() {
        match (line.strip_prefix("```"), &mut open) {
            (Some(info), None) => open = Some(Block { info: info.to_owned(), text: String::new(), line: number + 1 }),
            (Some(_), Some(_)) => blocks.extend(open.take()),
            (None, Some(block)) => {
                block.text.push_str(line);
                block.text.push('\n');
            }
            (None, None) => {}
        }
    }
    assert!(open.is_none(), "a block of code is not closed");
    blocks
}

/// What is wrong with a scene, every diagnostic on a line; nothing where it compiles without so much as a warning.
fn faults(text: &str, extension: &str) -> String {
    let name = format!("block from a document.{extension}");
    let loader = Beside { name: &name, text };
    let draws = text
        .lines()
        .map(str::trim_start)
        .any(|line| ["paint ", "outline ", "[[draw]]"].iter().any(|start| line.starts_with(start)));
    let diagnostics = if draws {
        compile(&name, &loader, &Config::default(), &mut ()).lowered.diagnostics
    } else {
        kakeami::lower::lower(&name, &loader, &LowerConfig::default()).diagnostics
    };
    diagnostics.iter().map(|d| format!("  {}: {}\n", d.code, d.message)).collect()
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

#[test]
fn scenes_in_documents_compile() {
    let mut wrong = String::new();
    let mut compiled = 0;
    for document in DOCUMENTS {
        for block in blocks(&read(&repository().join(document))) {
            let extension = match block.info.as_str() {
                "kake" => "kake",
                "toml" if block.text.contains("[[draw]]") => "toml",
                _ => continue,
            };
            compiled += 1;
            let faults = faults(&block.text, extension);
            if !faults.is_empty() {
                wrong.push_str(&format!("{document}, the block at line {}:\n{faults}", block.line));
            }
        }
    }
    assert!(wrong.is_empty(), "\n{wrong}");
    assert!(compiled >= 20, "only {compiled} blocks were found");
}

#[test]
fn a_mistake_in_a_block_is_found() {
    assert!(faults("let a = 1mm + 2deg\n", "kake").contains("kake::unit"));
    assert!(faults("canvas { size: a4 }\npaint canvas with nothing\n", "kake").contains("kake::unknown-tone"));
}

#[test]
fn scenes_in_documents_have_their_canonical_form() {
    for document in DOCUMENTS {
        for block in blocks(&read(&repository().join(document))).iter().filter(|block| block.info == "kake") {
            let mut sources = kakeami::span::Sources::new();
            let source = sources.add("block.kake", block.text.as_str(), kakeami::span::Syntax::Kake);
            let (tree, _) = kakeami::syntax::kake::parse(source, &block.text);
            let canonical = kakeami::syntax::format::format(&tree, &block.text);
            assert_eq!(canonical, block.text, "{document}, the block at line {}", block.line);
        }
    }
}

/// The targets of a document's links that lie in the repository.
fn targets(document: &str) -> Vec<String> {
    let code_free: String = {
        let mut inside = false;
        let outside = document.lines().filter(|line| {
            let is_fence = line.starts_with("```");
            inside ^= is_fence;
            !inside && !is_fence
        });
        outside.collect::<Vec<_>>().join("\n")
    };
    let ends = code_free.split("](").skip(1).filter_map(|rest| rest.split_once(')'));
    ends.map(|(target, _)| target.to_owned()).filter(|target| !target.contains("://")).collect()
}

#[test]
fn what_documents_point_to_is_there() {
    let others = ["CHANGELOG.md", "docs/decisions.md", "editors/README.md", "examples/data/SOURCES.md"];
    let documents = DOCUMENTS.iter().copied().chain(others);
    for document in documents {
        let path = repository().join(document);
        let text = read(&path);
        for target in targets(&text) {
            let (file, heading) = target.split_once('#').map_or((&*target, None), |(file, h)| (file, Some(h)));
            let file = if file.is_empty() { path.clone() } else { path.with_file_name("").join(file) };
            assert!(file.exists(), "{document}: there is no {target}");
            if let Some(heading) = heading {
                let text = read(&file);
                let mut headings = text.lines().filter(|line| line.starts_with('#')).map(anchor);
                assert!(headings.any(|h| h == heading), "{document}: no heading {target}");
            }
        }
    }
}

/// The anchor that a heading gets where Markdown is shown.
fn anchor(heading: &str) -> String {
    let words = heading.trim_start_matches('#').trim().to_lowercase();
    let kept = words.chars().filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'));
    kept.map(|c| if c == ' ' { '-' } else { c }).collect()
}

#[test]
fn every_picture_is_shown_somewhere() {
    let texts: String = DOCUMENTS.iter().map(|document| read(&repository().join(document))).collect();
    let mut pictures = 0;
    for entry in fs::read_dir(repository().join("docs/pictures")).expect("docs/pictures is there") {
        let name = entry.expect("the folder can be read").file_name().to_string_lossy().into_owned();
        assert!(texts.contains(&format!("pictures/{name}")), "no document shows {name}");
        pictures += 1;
    }
    assert!(pictures > 0);
}
