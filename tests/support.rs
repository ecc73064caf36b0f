//! What several tests need: files below a folder, compilations of case files, and their diagnostics as text.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use kakeami::diag::{Diagnostic, RenderConfig, render};
use kakeami::drawing::Drawing;
use kakeami::loader::{LoadError, Loader, MemoryLoader, UnknownDependency};
use kakeami::span::Sources;
use kakeami::syntax::kake;
use kakeami::{Compiled, Config, compile};

/// A path from the root of the repository.
pub(crate) fn here(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// Reads files below a folder.
pub(crate) struct Folder(pub(crate) PathBuf);

impl Loader for Folder {
    fn load(&self, path: &str) -> Result<Arc<[u8]>, LoadError> {
        let full = self.0.join(path);
        if full.is_dir() {
            return Err(LoadError::Unreadable("it is not a file".to_owned()));
        }
        fs::read(full).map(Arc::from).map_err(|error| match error.kind() {
            io::ErrorKind::NotFound => LoadError::Missing,
            _ => LoadError::Unreadable(error.to_string()),
        })
    }

    fn dependency(&self, _of: &str, _name: &str) -> Result<String, UnknownDependency> {
        Err(UnknownDependency::default())
    }
}

/// Every scene in a folder below the root of the repository, in order.
pub(crate) fn scenes(folder: &str) -> Vec<PathBuf> {
    let files = fs::read_dir(here(folder)).expect("the folder is there");
    let mut scenes: Vec<PathBuf> = files
        .map(|file| file.expect("the folder can be read").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "kake" || extension == "toml"))
        .collect();
    scenes.sort();
    assert!(!scenes.is_empty(), "{folder} holds no scenes");
    scenes
}

/// The name of a file.
pub(crate) fn name(path: &Path) -> &str {
    path.file_name().and_then(|name| name.to_str()).expect("names are UTF-8")
}

/// Compiles a case: a file in a folder of `tests/cases`. A first line `// kake --set name=value --limit strokes=9` does
/// what it says.
pub(crate) fn compile_case(path: &Path) -> Compiled {
    let bytes = fs::read(path).expect("the case can be read");
    let first = bytes.split(|byte| *byte == b'\n').next().unwrap_or_default();
    let first = std::str::from_utf8(first).unwrap_or_default();
    let mut config = Config::default();
    for argument in first.strip_prefix("// kake ").unwrap_or_default().split("--").skip(1) {
        let (option, given) = argument.trim_end().split_once(' ').expect("an option has a value");
        let (name, value) = given.split_once('=').expect("what is set has a value");
        match (option, name) {
            ("set", _) => config.lower.sets.push((name.to_owned(), value.to_owned())),
            ("limit", "strokes") => config.lower.limits.strokes = value.parse().expect("limits are numbers"),
            _ => panic!("the cases know no --{option} {name}"),
        }
    }
    let root = here("tests/cases");
    let inside = path.strip_prefix(&root).expect("cases lie in the folder of the cases");
    let inside = inside.to_str().expect("names are UTF-8").replace('\\', "/");
    compile(&inside, &Folder(root), &config, &mut ())
}

/// Compiles a text on its own.
pub(crate) fn compile_text(text: &str) -> Compiled {
    compile_named("scene.kake", text, &Config::default())
}

/// Compiles a text of a name on its own.
pub(crate) fn compile_named(name: &str, text: &str, config: &Config) -> Compiled {
    let mut loader = MemoryLoader::default();
    loader.files.insert(name.to_owned(), text.as_bytes().into());
    compile(name, &loader, config, &mut ())
}

/// The drawing of a text that is without fault.
pub(crate) fn drawing(text: &str) -> Drawing {
    let compiled = compile_text(text);
    let said = shown(&compiled.lowered.diagnostics, &compiled.lowered.sources);
    compiled.drawing.unwrap_or_else(|| panic!("{said}"))
}

/// A drawing as SVG, without metadata.
pub(crate) fn svg(drawing: &Drawing) -> String {
    let mut out = Vec::new();
    kakeami::back::svg::write(drawing, None, &mut out).expect("memory takes all that is written");
    String::from_utf8(out).expect("SVG is UTF-8")
}

/// Diagnostics as they are pinned: a hundred columns, no colours.
pub(crate) fn shown(diagnostics: &[Diagnostic], sources: &Sources) -> String {
    render(diagnostics, sources, RenderConfig { width: 100, colour: false, unicode: true })
}

/// The canonical form of a text without syntax errors.
pub(crate) fn formatted(text: &str) -> String {
    let mut sources = Sources::new();
    let source = sources.add("scene.kake", text, kakeami::span::Syntax::Kake);
    let (document, diagnostics) = kake::parse(source, text);
    assert!(diagnostics.is_empty(), "{}", shown(&diagnostics, &sources));
    kakeami::syntax::format::format(&document, text)
}

/// Asserts what a text is pinned to, in a snapshot of this name.
pub(crate) fn pin(folder: &str, name: &str, text: &str) {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(here("tests/snapshots").join(folder));
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| insta::assert_snapshot!(name, text));
}

/// Runs a check on every file and fails with the names of those that failed.
pub(crate) fn each(files: &[PathBuf], check: impl Fn(&Path) + std::panic::RefUnwindSafe) {
    let failed: Vec<&str> =
        files.iter().filter(|file| std::panic::catch_unwind(|| check(file)).is_err()).map(|file| name(file)).collect();
    assert!(failed.is_empty(), "{} of {} failed: {}", failed.len(), files.len(), failed.join(", "));
}
