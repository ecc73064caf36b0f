//! Files dropped into `tests/cases/build` compile, and their SVG is pinned; files dropped into `tests/cases/fail` do
//! not, and what is said of them is pinned.

use std::collections::BTreeSet;
use std::fs;

use crate::support::{compile_case, each, here, name, pin, scenes, shown, svg};

#[test]
fn scenes_that_compile() {
    each(&scenes("tests/cases/build"), |path| {
        let compiled = compile_case(path);
        let said = shown(&compiled.lowered.diagnostics, &compiled.lowered.sources);
        let Some(drawing) = compiled.drawing else { panic!("{} does not compile:\n{said}", path.display()) };
        let svg = svg(&drawing);
        assert!(svg.len() < 24_000, "{}: {} bytes are too many to pin", path.display(), svg.len());
        let marks: u64 = drawing.layers.iter().map(kakeami::drawing::Layer::marks).sum();
        assert!(marks > 0, "{} draws nothing", path.display());
        let text = if said.is_empty() { svg } else { format!("{said}\n{svg}") };
        pin("build", name(path), &text);
    });
}

#[test]
fn scenes_that_fail() {
    each(&scenes("tests/cases/fail"), |path| {
        let compiled = compile_case(path);
        let said = shown(&compiled.lowered.diagnostics, &compiled.lowered.sources);
        assert!(compiled.drawing.is_none(), "{} compiles", path.display());
        assert!(compiled.lowered.diagnostics.iter().any(kakeami::diag::Diagnostic::is_error));
        pin("fail", name(path), &said);
    });
}

/// What is pinned of cases that are no more is stale.
#[test]
fn every_snapshot_has_its_case() {
    for folder in ["build", "fail"] {
        let cases: BTreeSet<String> =
            scenes(&format!("tests/cases/{folder}")).iter().map(|path| format!("{}.snap", name(path))).collect();
        let files = fs::read_dir(here("tests/snapshots").join(folder)).expect("the snapshots are there");
        let pinned = files.map(|file| file.expect("the folder can be read").file_name().to_string_lossy().into_owned());
        assert_eq!(pinned.filter(|file| !file.ends_with(".snap.new")).collect::<BTreeSet<_>>(), cases, "{folder}");
    }
}
