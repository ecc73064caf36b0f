//! `kake.toml`: which library a folder is, and what it depends on.
//!
//! ```toml
//! [library]
//! name = "ink"
//! version = "0.1.0"
//! edition = 1
//! description = "Tones for night scenes"   # optional
//!
//! [dependencies]
//! base = { path = "../base" }
//! ```
//!
//! An empty file is a manifest too: it marks a root folder and says no more.

use crate::diag::{Code, Diagnostic, sort};
use crate::loader::is_name;
use crate::span::{SourceId, Span};
use crate::syntax::toml::data::{Entry, Kind, Value, data};

/// The one edition of the language.
const EDITION: i64 = 1;

/// What a `kake.toml` says.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Manifest {
    /// Which library it is, where it says so. Only those that do can be depended on.
    pub library: Option<Library>,
    /// What it depends on, in the order of the text.
    pub dependencies: Vec<Dependency>,
}

/// Which library a folder is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Library {
    /// Its name.
    pub name: String,
    /// Its version, `MAJOR.MINOR.PATCH` with an optional `-suffix`.
    pub version: String,
    /// The edition of the language that it is written in.
    pub edition: i64,
    /// What it is, in a sentence.
    pub description: Option<String>,
}

/// Another library that this one uses.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Dependency {
    /// What this library calls it.
    pub name: String,
    /// Where the name stands.
    pub name_span: Span,
    /// Its folder, relative to this library's, with forward slashes.
    pub path: String,
    /// Where the path stands.
    pub path_span: Span,
}

impl Manifest {
    /// Reads a `kake.toml`. The manifest holds whatever could be read; the diagnostics say what could not.
    #[must_use]
    pub fn parse(source: SourceId, text: &str) -> (Self, Vec<Diagnostic>) {
        let (entries, diagnostics) = data(source, text);
        let mut reader = Reader { is_sound: diagnostics.is_empty(), diagnostics };
        let mut manifest = Self::default();
        for entry in &entries {
            match (entry.key.as_str(), &entry.value.kind) {
                ("library", Kind::Table(entries)) => manifest.library = reader.library(entry, entries),
                ("dependencies", Kind::Table(entries)) => {
                    manifest.dependencies = entries.iter().filter_map(|entry| reader.dependency(entry)).collect();
                }
                ("library" | "dependencies", Kind::Lost) => {}
                ("library" | "dependencies", _) => {
                    let hint = format!("write `[{}]` on a line of its own", entry.key);
                    reader.diagnostics.push(entry.wrong_type("a table").hint(hint));
                }
                _ => reader.diagnostics.push(entry.unknown("a manifest", &["library", "dependencies"])),
            }
        }
        sort(&mut reader.diagnostics);
        (manifest, reader.diagnostics)
    }
}

struct Reader {
    diagnostics: Vec<Diagnostic>,
    /// Whether the text is TOML; if not, what is missing may only be unreadable.
    is_sound: bool,
}

impl Reader {
    fn library(&mut self, table: &Entry, entries: &[Entry]) -> Option<Library> {
        const KEYS: [&str; 4] = ["name", "version", "edition", "description"];
        let (mut name, mut version, mut edition, mut description) = (None, None, None, None);
        for entry in entries {
            match entry.key.as_str() {
                "name" => name = self.text(entry).filter(|name| self.is_name(name, entry.value.span)),
                "version" => version = self.text(entry).filter(|version| self.is_version(version, &entry.value)),
                "edition" => edition = self.edition(entry),
                "description" => description = self.text(entry),
                _ => self.diagnostics.push(entry.unknown("`[library]`", &KEYS)),
            }
        }
        for (key, example) in
            [("name", "name = \"ink\""), ("version", "version = \"0.1.0\""), ("edition", "edition = 1")]
        {
            if self.is_sound && entries.iter().all(|entry| entry.key != key) {
                let message = format!("`[library]` lacks its `{key}`");
                self.diagnostics.push(Diagnostic::error(Code::Missing, table.span, message).hint(example));
            }
        }
        Some(Library { name: name?, version: version?, edition: edition?, description })
    }

    fn dependency(&mut self, entry: &Entry) -> Option<Dependency> {
        let hint = || format!("write `{} = {{ path = \"../{}\" }}`", entry.key, entry.key);
        let entries = match &entry.value.kind {
            Kind::Table(entries) => entries,
            Kind::Lost => return None,
            _ => {
                self.diagnostics.push(entry.wrong_type("a table with a `path`").hint(hint()));
                return None;
            }
        };
        if !self.is_dependency_name(&entry.key, entry.span) {
            return None;
        }
        let mut found = None;
        for inner in entries {
            match inner.key.as_str() {
                "path" => {
                    found = self.text(inner).and_then(|path| self.path(path, &inner.value));
                }
                _ => self.diagnostics.push(inner.unknown("a dependency", &["path"])),
            }
        }
        if self.is_sound && entries.iter().all(|inner| inner.key != "path") {
            let message = format!("the dependency `{}` needs a `path`", entry.key);
            self.diagnostics.push(Diagnostic::error(Code::Missing, entry.span, message).hint(hint()));
        }
        let (path, path_span) = found?;
        Some(Dependency { name: entry.key.clone(), name_span: entry.span, path, path_span })
    }

    /// The text of a string.
    fn text(&mut self, entry: &Entry) -> Option<String> {
        match &entry.value.kind {
            Kind::Text(text) => return Some(text.clone()),
            Kind::Lost => {}
            _ => self.diagnostics.push(entry.wrong_type("a string")),
        }
        None
    }

    fn edition(&mut self, entry: &Entry) -> Option<i64> {
        match entry.value.kind {
            Kind::Integer(EDITION) => return Some(EDITION),
            Kind::Lost => {}
            Kind::Integer(other) => {
                let message = format!("there is no edition {other}");
                let diagnostic = Diagnostic::error(Code::Edition, entry.value.span, message);
                self.diagnostics.push(diagnostic.hint("this program knows edition 1 of the language"));
            }
            _ => self.diagnostics.push(entry.wrong_type("a number").hint("write `edition = 1`")),
        }
        None
    }

    fn wrong(&mut self, span: Span, message: String, hint: impl Into<String>) {
        self.diagnostics.push(Diagnostic::error(Code::Manifest, span, message).hint(hint));
    }

    fn is_name(&mut self, name: &str, span: Span) -> bool {
        let is_good = is_name(name);
        if !is_good {
            let hint = "names have 2 to 64 plain letters, digits, `-` and `_`, and begin with a letter";
            self.wrong(span, format!("`{}` is no name of a library", name.escape_debug()), hint);
        }
        is_good
    }

    fn is_dependency_name(&mut self, name: &str, span: Span) -> bool {
        if name.eq_ignore_ascii_case("std") {
            let hint = "`std:` names the libraries that come with the program; choose another name";
            self.wrong(span, format!("a dependency cannot be called `{name}`"), hint);
            return false;
        }
        self.is_name(name, span)
    }

    fn is_version(&mut self, version: &str, value: &Value) -> bool {
        let (numbers, suffix) =
            version.split_once('-').map_or((version, None), |(numbers, rest)| (numbers, Some(rest)));
        let is_number = |part: &str| {
            (1..=9).contains(&part.len())
                && part.bytes().all(|byte| byte.is_ascii_digit())
                && (part == "0" || !part.starts_with('0'))
        };
        let is_word = |part: &str| !part.is_empty() && part.bytes().all(|byte| byte.is_ascii_alphanumeric());
        let is_good = numbers.split('.').count() == 3
            && numbers.split('.').all(is_number)
            && suffix.is_none_or(|suffix| suffix.split('.').all(is_word));
        if !is_good {
            let message = format!("`{}` is no version", version.escape_debug());
            self.wrong(value.span, message, "versions are three numbers, as in `0.1.0`, or `0.1.0-draft`");
        }
        is_good
    }

    /// The path of a dependency's folder.
    fn path(&mut self, path: String, value: &Value) -> Option<(String, Span)> {
        let shown = path.escape_debug();
        let is_drive = path.as_bytes().get(1) == Some(&b':');
        let (message, hint) = if path.is_empty() || path.contains('\0') {
            (format!("`{shown}` is no path"), "a dependency's path leads to its folder, as in `../ink`")
        } else if path.starts_with(['/', '\\', '~']) || is_drive {
            let hint = "paths start at the folder of this file, as in `../ink`, so that they hold on every machine";
            (format!("the path `{shown}` is absolute"), hint)
        } else if path.contains('\\') {
            (format!("the path `{shown}` holds a backslash"), "write forward slashes: they hold on every machine")
        } else if path.split('/').all(|part| matches!(part, "" | ".")) {
            ("a library cannot depend on itself".to_owned(), "imports within a library are paths without a name")
        } else {
            return Some((path, value.span));
        };
        self.wrong(value.span, message, hint);
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diag::{RenderConfig, render};
    use crate::span::{Sources, Syntax};

    fn parse(text: &str) -> (Manifest, String) {
        let mut sources = Sources::new();
        let source = sources.add("kake.toml", text, Syntax::Toml);
        let (manifest, diagnostics) = Manifest::parse(source, text);
        (manifest, render(&diagnostics, &sources, RenderConfig { width: 100, colour: false, unicode: true }))
    }

    #[test]
    fn an_empty_file_marks_a_root() {
        for text in ["", "# the root\n", "[dependencies]\n"] {
            assert_eq!(parse(text), (Manifest::default(), String::new()));
        }
    }

    #[test]
    fn all_of_it_is_read() {
        let (manifest, said) = parse(
            "[library]\nname = \"ink\"\nversion = \"1.20.3-draft.2\"\nedition = 1\ndescription = \"Night\"\n\
             [dependencies]\nwash = { path = \"../wash\" }\n[dependencies.base]\npath = \"vendor/base\"\n",
        );
        assert_eq!(said, "");
        let library = manifest.library.expect("it has a library");
        assert_eq!((library.name.as_str(), library.version.as_str()), ("ink", "1.20.3-draft.2"));
        assert_eq!((library.edition, library.description.as_deref()), (1, Some("Night")));
        let found: Vec<_> = manifest.dependencies.iter().map(|d| (d.name.as_str(), d.path.as_str())).collect();
        assert_eq!(found, [("wash", "../wash"), ("base", "vendor/base")]);
    }

    #[test]
    fn every_mistake_is_named() {
        let text = "[library]\nname = \"i\"\nversion = \"1.0\"\nedition = 2\nauthor = \"me\"\n\
                    [dependencies]\nstd = { path = \"../std\" }\nlone = \"../lone\"\nfar = { path = \"/etc\" }\n\
                    me = { path = \".\" }\nwin = { path = \"..\\\\win\" }\nold = { git = \"x\" }\n[depend]\n";
        insta::assert_snapshot!(parse(text).1);
    }

    #[test]
    fn versions_are_three_numbers() {
        for (version, is_good) in [
            ("0.1.0", true),
            ("10.20.30", true),
            ("1.0.0-rc.1", true),
            ("01.0.0", false),
            ("1.0.0.0", false),
            ("v1.0.0", false),
            ("1.0.0-", false),
            ("", false),
        ] {
            let (manifest, _) = parse(&format!("[library]\nname = \"ink\"\nedition = 1\nversion = \"{version}\"\n"));
            assert_eq!(manifest.library.is_some(), is_good, "{version}");
        }
    }

    #[test]
    fn nothing_nests_too_deeply() {
        let (_, said) = parse(&format!("x = {}{}", "[".repeat(5000), "]".repeat(5000)));
        assert!(said.contains("kake::nesting"), "{said}");
    }
}
