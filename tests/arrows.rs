//! The arrows between the parts of the program: what each may name of the others, read from its `crate::` paths.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use crate::support::here;

/// What each part may know of.
const ARROWS: [(&str, &[&str]); 28] = [
    ("span", &[]),
    ("geom", &[]),
    ("random", &[]),
    ("loader", &[]),
    ("stop", &[]),
    ("diag", &["span"]),
    ("syntax", &["span", "diag"]),
    ("region", &["geom"]),
    ("field", &["geom", "region", "random"]),
    ("scene", &["geom", "region", "field", "span", "stop"]),
    ("stage", &["geom"]),
    ("drawing", &["geom", "scene"]),
    ("pass", &["scene", "stage", "geom", "region", "field", "random", "diag", "span", "drawing", "stop"]),
    ("metrics", &["pass", "stage", "scene", "region", "geom", "random", "stats"]),
    ("overlay", &["drawing", "geom", "metrics", "pass", "region", "scene"]),
    ("stats", &[]),
    ("chart", &["geom"]),
    ("illustrate", &["chart", "metrics"]),
    ("sheet", &["drawing", "geom", "scene"]),
    ("back", &["drawing", "geom", "scene", "sheet"]),
    ("compare", &["back", "drawing", "geom", "metrics", "scene", "stage"]),
    ("library", &["diag", "loader", "span", "syntax"]),
    ("lower", &["syntax", "scene", "region", "field", "loader", "diag", "span", "geom", "random"]),
    ("swatch", &["diag", "geom", "loader", "lower", "pass", "scene", "span", "syntax"]),
    (
        "wedge",
        &[
            "back", "diag", "drawing", "field", "geom", "loader", "lower", "pass", "region", "scene", "span", "swatch",
            "syntax",
        ],
    ),
    ("gallery", &["diag", "drawing", "geom", "loader", "lower", "scene", "sheet", "span", "swatch", "syntax"]),
    ("experiment", &["back", "chart", "diag", "loader", "lower", "metrics", "scene", "span", "stats"]),
    (
        "cli",
        &[
            "back",
            "chart",
            "compare",
            "diag",
            "drawing",
            "experiment",
            "field",
            "gallery",
            "geom",
            "illustrate",
            "library",
            "loader",
            "lower",
            "metrics",
            "overlay",
            "pass",
            "random",
            "region",
            "scene",
            "sheet",
            "span",
            "stage",
            "stats",
            "stop",
            "syntax",
            "wedge",
        ],
    ),
];

/// What the back ends may name of the scene: how marks and pages look, nothing of how they came about.
const SEEN_BY_BACK: [&str; 3] = ["Cap", "Colour", "Depth"];

/// Every Rust file of a part.
fn files(part: &str) -> Vec<PathBuf> {
    let mut files = Vec::new();
    let mut folders = vec![here("src").join(part)];
    let single = here("src").join(format!("{part}.rs"));
    files.extend(single.is_file().then_some(single));
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).into_iter().flatten() {
            let path = entry.expect("the folder can be read").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                files.push(path);
            }
        }
    }
    files.sort();
    files
}

/// The code of a file without comments, and without its tests: those may use anything.
fn code(path: &Path) -> String {
    let text = fs::read_to_string(path).expect("sources are UTF-8");
    let text = text.split("#[cfg(test)]\n").next().unwrap_or_default();
    text.lines().map(|line| line.split("//").next().unwrap_or_default()).collect::<Vec<_>>().join("\n")
}

/// Whether a file holds nothing but tests.
fn is_test(path: &Path) -> bool {
    let mut parts = path.components().map(|part| part.as_os_str().to_string_lossy());
    parts.any(|part| matches!(&*part, "tests" | "tests.rs" | "fixture.rs" | "arbitrary.rs"))
}

/// The names that follow `crate::` in a code, the groups of `crate::{…}` opened.
fn named(code: &str) -> BTreeSet<String> {
    let word = |text: &str| -> String { text.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect() };
    let mut names = BTreeSet::new();
    for (at, path) in code.match_indices("crate::") {
        if code[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_') {
            continue;
        }
        let rest = &code[at + path.len()..];
        match rest.strip_prefix('{') {
            None => {
                names.insert(word(rest));
            }
            Some(group) => {
                let mut depth = 0;
                let mut start = true;
                for (i, character) in group.char_indices() {
                    match character {
                        '{' => depth += 1,
                        '}' if depth == 0 => break,
                        '}' => depth -= 1,
                        ',' if depth == 0 => start = true,
                        c if depth == 0 && start && !c.is_whitespace() => {
                            names.insert(word(&group[i..]));
                            start = false;
                        }
                        _ => {}
                    }
                }
            }
        }
    }
    names
}

#[test]
fn every_part_knows_only_what_it_may() {
    let allowed: BTreeMap<&str, &[&str]> = ARROWS.into_iter().collect();
    let mut wrong = Vec::new();
    for (part, allowed) in &allowed {
        let files = files(part);
        assert!(!files.is_empty(), "there is no {part}");
        for path in files.iter().filter(|path| !is_test(path)) {
            for name in named(&code(path)) {
                let is_part = name.chars().next().is_some_and(char::is_lowercase);
                // What stands in lib.rs itself is the pipeline, which only the command line, wedges and swatches drive.
                let fits = if is_part {
                    name == **part || allowed.contains(&name.as_str())
                } else {
                    matches!(*part, "cli" | "experiment" | "gallery" | "swatch" | "wedge")
                };
                let pipeline = matches!(*part, "cli" | "experiment" | "gallery" | "swatch" | "wedge")
                    && matches!(name.as_str(), "compile" | "paints" | "no_such_paint");
                if !fits && !pipeline {
                    wrong.push(format!("{} names crate::{name}", path.display()));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

#[test]
fn every_part_has_its_arrows() {
    let listed: BTreeSet<String> = ARROWS.iter().map(|(part, _)| (*part).to_owned()).collect();
    let entries = fs::read_dir(here("src")).expect("src is there");
    let there: BTreeSet<String> = entries
        .map(|entry| entry.expect("src can be read").path())
        .map(|path| path.file_stem().unwrap_or_default().to_string_lossy().into_owned())
        .filter(|part| part != "lib" && part != "main")
        .collect();
    assert_eq!(there, listed);
}

#[test]
fn the_arrows_run_one_way() {
    let arrows: BTreeMap<&str, &[&str]> = ARROWS.into_iter().collect();
    // What is left when all that know nobody who is left are taken away, again and again.
    let mut left: BTreeSet<&str> = arrows.keys().copied().collect();
    loop {
        let free: Vec<&str> =
            left.iter().copied().filter(|part| !arrows[part].iter().any(|known| left.contains(known))).collect();
        if free.is_empty() {
            break;
        }
        left.retain(|part| !free.contains(part));
    }
    assert!(left.is_empty(), "these know each other: {left:?}");
}

#[test]
fn back_ends_see_only_how_marks_look() {
    for path in files("back").iter().filter(|path| !is_test(path)) {
        let code = code(path);
        for (at, found) in code.match_indices("crate::scene::") {
            let rest = &code[at + found.len()..];
            let list = match rest.strip_prefix('{') {
                Some(group) => group.split('}').next().unwrap_or_default(),
                None => rest.split(|c: char| !c.is_alphanumeric()).next().unwrap_or_default(),
            };
            for name in list.split(',').map(str::trim).filter(|name| !name.is_empty()) {
                assert!(SEEN_BY_BACK.contains(&name), "{} names {name}", path.display());
            }
        }
    }
}

#[test]
fn names_behind_crate_are_found() {
    let code = "use crate::geom::{Point, Rect};\nuse crate::{Config, diag::{self, Code}, paints};\nlet a = crate::lower::x; mycrate::y";
    let found: Vec<String> = named(code).into_iter().collect();
    assert_eq!(found, ["Config", "diag", "geom", "lower", "paints"]);
}
