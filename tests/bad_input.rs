//! Input that no scene should be: every kind of it meets a coded diagnostic at a place, never a panic. What can be
//! written down is a file in `tests/cases/fail`; what has to be made is made here.

use std::fs;

use kakeami::diag::{Code, Diagnostic};
use kakeami::loader::MemoryLoader;
use kakeami::{Compiled, Config, compile};
use proptest::prelude::*;

use crate::support::{compile_named, compile_text, here, scenes, shown};

const HEAD: &str = "canvas { size: (20mm, 20mm) }
tone plain { place: grid(spacing: 5mm) fill: lines(pitch: 1mm) }
paint canvas with plain
";

/// The codes of the errors, each with whether it has a place.
fn errors(compiled: &Compiled) -> Vec<(Code, bool)> {
    assert!(compiled.drawing.is_none());
    let errors = compiled.lowered.diagnostics.iter().filter(|diagnostic| diagnostic.is_error());
    errors.map(|diagnostic| (diagnostic.code, diagnostic.span.is_some())).collect()
}

/// Asserts that a text is met by one error of this code, at its place.
#[track_caller]
fn refused(text: &str, code: Code) {
    let compiled = compile_text(text);
    let found = errors(&compiled);
    let said = shown(&compiled.lowered.diagnostics, &compiled.lowered.sources);
    assert_eq!(found, [(code, true)], "{said}");
}

/// Something repeated around a middle.
fn around(before: &str, middle: &str, after: &str, times: usize) -> String {
    format!("{}{middle}{}", before.repeat(times), after.repeat(times))
}

#[test]
fn ten_thousand_brackets_are_too_many() {
    for (before, middle, after) in [("(", "1", ")"), ("[", "1", "]"), ("{ a: ", "1", " }"), ("sin(", "1", ")")] {
        refused(&format!("{HEAD}let a = {}\n", around(before, middle, after, 10_000)), Code::Nesting);
    }
}

#[test]
fn other_deep_nesting_is_refused() {
    let deep = [
        around("if true then ", "1", " else 0", 10_000),
        around("match 1 { _ => ", "1", " }", 10_000),
        around("\"{", "1", "}\"", 10_000),
        around("not ", "true", "", 10_000),
        around("-", "1", "", 10_000),
    ];
    for text in deep {
        let compiled = compile_text(&format!("{HEAD}let a = {text}\n"));
        // Operators in a row are no nesting, and may be fine.
        if compiled.drawing.is_none() {
            assert!(errors(&compiled).iter().any(|(code, place)| *code == Code::Nesting && *place));
        }
    }
    refused(&format!("{HEAD}{}\n", around("if true { ", "", "}", 10_000)), Code::Nesting);
}

#[test]
fn long_chains_are_no_nesting() {
    let sum = vec!["1"; 20_000].join(" + ");
    let power = vec!["1"; 20_000].join(" ^ ");
    let branches = "if false then 1 else ".repeat(100);
    for text in [sum, power, format!("{branches}2")] {
        let compiled = compile_text(&format!("{HEAD}let a = {text}\n"));
        assert!(compiled.drawing.is_some(), "{:?}", compiled.lowered.diagnostics);
    }
}

#[test]
fn long_ways_from_name_to_name_are_refused_or_followed() {
    let mut text = HEAD.to_owned();
    for i in 0..5_000 {
        text.push_str(&format!("let a{i} = a{} + 1\n", i + 1));
    }
    text.push_str("let a5000 = 1\n");
    let compiled = compile_text(&text);
    assert!(errors(&compiled).iter().all(|(code, place)| *code == Code::Recursion && *place));
    // The other way round every name is known when it is asked for.
    let backwards: Vec<String> = (1..5_000).map(|i| format!("let a{i} = a{} + 1\n", i - 1)).collect();
    assert!(compile_text(&format!("{HEAD}let a0 = 1\n{}", backwards.concat())).drawing.is_some());
}

#[test]
fn imports_that_lead_ever_deeper_are_refused() {
    let mut loader = MemoryLoader::default();
    for i in 0..200 {
        let text = format!("import \"{}.kake\"\n", i + 1);
        loader.files.insert(format!("{i}.kake"), text.as_bytes().into());
    }
    loader.files.insert("200.kake".to_owned(), HEAD.as_bytes().into());
    let compiled = compile("0.kake", &loader, &Config::default(), &mut ());
    assert_eq!(errors(&compiled), [(Code::Nesting, true)]);
}

#[test]
fn loops_end() {
    refused(&format!("{HEAD}for i in 0 .. 1e15 {{ }}\n"), Code::Limit);
    let nested = around("for i in 0 .. 1000 { ", "", "}", 6);
    refused(&format!("{HEAD}{nested}\n"), Code::Limit);
    // A call for each, twice over: two to the power of the depth.
    let doubling = "fn f(n: number) = if n <= 0 then 1 else f(n - 1) + f(n - 1)\nlet a = f(60)\n";
    refused(&format!("{HEAD}{doubling}"), Code::Limit);
    // Numbers beyond which adding one changes nothing.
    refused(&format!("{HEAD}for i in 1e17 .. 2e17 {{ }}\n"), Code::Limit);
}

#[test]
fn values_that_grow_without_bounds_are_refused() {
    let mut text = format!("{HEAD}let s0 = \"0123456789\"\nlet l0 = [1, 2, 3, 4]\n");
    for i in 1..40 {
        let last = i - 1;
        text.push_str(&format!("let s{i} = \"{{s{last}}}{{s{last}}}\"\nlet l{i} = [l{last}, l{last}]\n"));
    }
    text.push_str("let shown = \"{l39}\"\n");
    let compiled = compile_text(&text);
    assert!(errors(&compiled).iter().all(|(code, place)| *code == Code::Limit && *place), "{:?}", errors(&compiled));
}

/// Each blurred image takes memory of its own, so all of them together are counted.
#[test]
fn images_are_not_blurred_without_end() {
    let text = "canvas { size: (20mm, 20mm) }
tone t(k: field) { place: grid(spacing: 5mm) fill: lines(pitch: 1mm) k: k }
for i in 1 .. 200 {
  paint canvas with t(image(\"tiny.png\", fit: canvas, blur: 5mm + i * 0.05mm)) as \"blurred {i}\"
}
";
    let mut loader = MemoryLoader::default();
    loader.files.insert("scene.kake".to_owned(), text.as_bytes().into());
    let tiny = fs::read(here("tests/cases/data/tiny.png")).expect("it can be read");
    loader.files.insert("tiny.png".to_owned(), tiny.into());
    let mut config = Config::default();
    config.lower.limits.megapixels = 1;
    let compiled = compile("scene.kake", &loader, &config, &mut ());
    assert_eq!(errors(&compiled), [(Code::Limit, true)]);
}

#[test]
fn too_many_tiles_and_strokes_are_refused_before_they_are_made() {
    let head = "canvas { size: a4 }\n";
    for place in [
        "poisson(radius: 1e-9mm)",
        "grid(spacing: 1e-9mm)",
        "hex(spacing: 1e-6mm)",
        "uniform(count: 4294967295)",
        "uniform(density: 1e12)",
        "grid(columns: 1000000, rows: 1000000)",
        "uniform(count: poisson(radius: 0.0001mm))",
    ] {
        let text = format!("{head}tone t {{ place: {place} fill: lines(pitch: 1mm) }}\npaint canvas with t\n");
        refused(&text, Code::Limit);
    }
    // What is drawn is counted as it is drawn: the limit is lowered so that the test need not draw fifty million.
    let mut config = Config::default();
    config.lower.limits.strokes = 10_000;
    for fill in [
        "lines(pitch: 1e-9mm, pen: 0.1mm)",
        "dots(pitch: 1e-6mm, radius: 0.1mm)",
        "dashes(pitch: 1mm, dash: 1e-9mm)",
        "dots(pitch: 1mm, spacing: 1e-9mm, radius: 0.1mm)",
    ] {
        let text = format!("{head}tone t {{ place: grid(spacing: 9mm) fill: {fill} }}\npaint canvas with t\n");
        assert_eq!(errors(&compile_named("scene.kake", &text, &config)), [(Code::Limit, true)], "{fill}");
    }
}

#[test]
fn tangled_outlines_are_refused_before_they_are_resolved() {
    // Corners all over a square of 20 m, each far from the one before.
    let corners: Vec<_> = (1..8_000_u64).map(|i| (i * i * 7919 % 20_011, i * i * i * 1_049 % 20_021)).collect();
    let joined =
        |corner: fn(&(u64, u64)) -> String, between: &str| corners.iter().map(corner).collect::<Vec<_>>().join(between);
    let path = joined(|(x, y)| format!("{x} {y}"), " L ");
    let list = joined(|(x, y)| format!("({x}mm, {y}mm)"), ", ");
    refused(&format!("{HEAD}let a = path(\"M {path} Z\")\n"), Code::Limit);
    refused(&format!("{HEAD}let a = polygon([{list}])\n"), Code::Limit);
    // Two combs, each of which crosses nothing by itself.
    let teeth = |is_upright: bool| {
        let tooth = |i: u32| match (i % 2 * 20, f64::from(i) / 250.0) {
            (end, at) if is_upright => format!("{at} {end}"),
            (end, at) => format!("{end} {at}"),
        };
        (0..5_000).map(tooth).collect::<Vec<_>>().join(" L ")
    };
    let (upright, level) = (teeth(true), teeth(false));
    let combs = format!("{HEAD}let a = path(\"M {upright} L 21 -1 Z\")\nlet b = path(\"M {level} L -1 21 Z\")\n");
    for operator in ["+", "-", "&"] {
        refused(&format!("{combs}let c = a {operator} b\n"), Code::Limit);
    }
    refused(&format!("{combs}let c = inset(a, -5mm)\n"), Code::Limit);
}

#[test]
fn extreme_canvases_are_met() {
    for size in ["(1e-300mm, 1e-300mm)", "(1e9mm, 1e9mm)", "(0.001mm, 90000mm)", "(1e300mm, 1mm)"] {
        let text = format!(
            "canvas {{ size: {size} }}\ntone t {{ place: poisson(radius: 5mm) fill: lines(pitch: 1mm) }}\npaint canvas with t\n"
        );
        let compiled = compile_text(&text);
        if compiled.drawing.is_none() {
            assert!(errors(&compiled).iter().all(|(_, place)| *place), "{size}");
        }
    }
}

#[test]
fn nothing_at_all_is_no_scene() {
    for text in ["", "\n\n", "// only a comment", "/* and */ // more", "edition 1", "\u{feff}"] {
        let compiled = compile_text(text);
        assert_eq!(errors(&compiled), [(Code::Empty, true)], "{text:?}");
    }
    assert_eq!(errors(&compile_named("scene.toml", "", &Config::default())), [(Code::Empty, true)]);
}

/// Every case as bytes.
fn cases() -> Vec<(String, Vec<u8>)> {
    let folders = ["tests/cases/build", "tests/cases/fail", "examples"];
    let paths = folders.into_iter().flat_map(scenes);
    let extension = |path: &std::path::Path| path.extension().unwrap_or_default().to_string_lossy().into_owned();
    paths.map(|path| (format!("scene.{}", extension(&path)), fs::read(path).expect("it can be read"))).collect()
}

/// Compiles bytes under limits that keep it quick, with the files of the cases at hand.
fn survive(name: &str, bytes: &[u8]) {
    let mut loader = MemoryLoader::default();
    loader.files.insert(format!("fail/{name}"), bytes.into());
    for file in ["library/tones.kake", "data/shapes.svg", "data/tiny.png"] {
        let bytes = fs::read(here("tests/cases").join(file)).expect("it can be read");
        loader.files.insert(file.to_owned(), bytes.into());
    }
    let mut config = Config::default();
    config.lower.limits.tiles = 300;
    config.lower.limits.strokes = 2_000;
    config.lower.limits.iterations = 2_000;
    config.lower.limits.megapixels = 1;
    let compiled = compile(&format!("fail/{name}"), &loader, &config, &mut ());
    let any = compiled.lowered.diagnostics.iter().any(Diagnostic::is_error);
    assert_eq!(compiled.drawing.is_none(), any, "a drawing or errors, never neither or both");
    shown(&compiled.lowered.diagnostics, &compiled.lowered.sources);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 192, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn damaged_scenes_are_met_by_no_panic(
        which in any::<prop::sample::Index>(),
        other in any::<prop::sample::Index>(),
        cut in any::<prop::sample::Index>(),
        length in 0usize..40,
        insert in prop_oneof![
            Just(String::new()),
            "[-+*/(){}\\[\\],:.\"#]{1,3}",
            "(mm|deg|1e9|-1|0|x|canvas|with|if|match|in|as|import|\\.\\.|%|é)",
        ],
        splice in any::<bool>(),
    ) {
        let cases = cases();
        let (name, bytes) = &cases[which.index(cases.len())];
        let at = cut.index(bytes.len().max(1)).min(bytes.len());
        let mut damaged = bytes[..at].to_vec();
        damaged.extend(insert.as_bytes());
        let rest = if splice { &cases[other.index(cases.len())].1 } else { bytes };
        damaged.extend(&rest[(at + length).min(rest.len())..]);
        survive(name, &damaged);
    }

    #[test]
    fn any_bytes_are_met_by_no_panic(bytes in prop::collection::vec(any::<u8>(), 0..200), toml in any::<bool>()) {
        survive(if toml { "scene.toml" } else { "scene.kake" }, &bytes);
    }
}
