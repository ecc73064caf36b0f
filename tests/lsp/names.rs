//! What names mean: hovers, definitions, references, new names and outlines.

use serde_json::{Value, json};

use super::client::{Client, find};
use super::{BASE, LIBRARY, OTHER, SHEET};

/// A session with the sheet open.
fn opened() -> Client {
    let mut client = Client::greeted(&LIBRARY, json!({}));
    client.open("sheet.kake", SHEET);
    client.faultless("sheet.kake");
    client
}

fn hovered(client: &mut Client, path: &str, text: &str, piece: &str, nth: usize) -> String {
    let params = client.at(path, &find(text, piece, nth));
    let hover = client.ask("textDocument/hover", params);
    hover["contents"]["value"].as_str().unwrap_or_default().to_owned()
}

#[test]
fn hovers_say_what_names_are_and_are_worth() {
    let mut client = opened();
    let mut says = |piece: &str, nth: usize, words: &[&str]| {
        let found = hovered(&mut client, "sheet.kake", SHEET, piece, nth);
        for words in words {
            assert!(found.contains(words), "`{piece}`: {words} is not in\n{found}");
        }
    };
    says("gap", 1, &["let gap = 1mm + 1pt", "`1.352778mm`"]);
    says("inner", 1, &["region inner", "57.29mm wide and 27.29mm high"]);
    says("shade", 1, &["field shade", "a field of numbers, about 1.17 to 3.83 on the page"]);
    says("squares", 0, &["tone squares(k: field = 1, tile: length = 6mm)", "Squares, as by hand.", "base.kake"]);
    says("tile:", 0, &["tile: length = 6mm", "A parameter of `squares`", "a length"]);
    says("base", 2, &["import \"tones/base.kake\" as base", "`squares`", "`double`"]);
    says("tones/base.kake", 0, &["`squares`"]);
    // Words of the language.
    says("inset", 0, &["inset(region: region, distance: length)", "drawn in"]);
    says("across", 0, &["**across** of `linear`", "a region"]);
    says("size", 0, &["**size**", "Must be given."]);
    says("navy", 0, &["#000080"]);
    says("canvas,", 0, &["The region of the page"]);
    says("layer", 0, &["named group"]);
    says("with", 0, &["names the tone"]);
    let words = "tone t {\n  place: hex(spacing: 3mm)\n  fill: lines(pitch: 1mm, cap: round)\n  blend: dither\n  shape: rect()\n}\nlet a: length = 1mm\nregion r = rect(at: (0, 0), size: (1, 1))\n";
    client.open("words.kake", words);
    for (piece, nth, said) in [
        ("fill", 0, "What is drawn in tiles"),
        ("dither", 0, "passed to neighbours"),
        ("round", 0, "strokes end round"),
        ("rect", 0, "Rectangular stamps"),
        ("rect", 1, "An upright rectangle"),
        ("pitch", 0, "from line to line"),
        ("length", 0, "A length"),
        ("tone", 0, "A recipe for tiles"),
    ] {
        let found = hovered(&mut client, "words.kake", words, piece, nth);
        assert!(found.contains(said), "`{piece}`: {said} is not in\n{found}");
    }
}

#[test]
fn hovers_reach_into_toml() {
    let text = "edition = 1\n\n[let]\ngap = \"1mm + 1mm\"\n\n[canvas]\nsize = \"(60mm, 3 * gap)\"\n";
    let mut client = Client::greeted(&[], json!({}));
    client.open("a.toml", text);
    let found = hovered(&mut client, "a.toml", text, "gap", 1);
    assert!(found.contains("`2mm`"), "{found}");
    let params = client.at("a.toml", &find(text, "gap", 1));
    assert_eq!(client.ask("textDocument/definition", params)["range"]["start"], find(text, "gap", 0));
}

#[test]
fn definitions_lead_across_imports() {
    let mut client = opened();
    let mut leads = |piece: &str, nth: usize| {
        let params = client.at("sheet.kake", &find(SHEET, piece, nth));
        let place = client.ask("textDocument/definition", params);
        (place["uri"].as_str().unwrap_or_default().to_owned(), place["range"]["start"].clone())
    };
    let found = [leads("gap", 1), leads("squares", 0), leads("tile", 0), leads("tones/base", 0), leads("base.sq", 0)];
    let (sheet, base) = (client.uri("sheet.kake"), client.uri("tones/base.kake"));
    assert_eq!(found[0], (sheet.clone(), find(SHEET, "gap", 0)));
    assert_eq!(found[1], (base.clone(), find(BASE, "squares", 0)));
    assert_eq!(found[2], (base.clone(), find(BASE, "tile", 0)));
    assert_eq!(found[3], (base, json!({ "line": 0, "character": 0 })));
    assert_eq!(found[4], (sheet, find(SHEET, "base", 1)));
    let params = client.at("sheet.kake", &find(SHEET, "linear", 0));
    assert_eq!(client.ask("textDocument/definition", params), Value::Null);
}

#[test]
fn standard_libraries_open_as_files_that_only_read() {
    let text = SHEET.replace("base.squares(k: shade, tile: base.double(3mm))", "kakeami(k: 2)");
    let mut client = Client::greeted(&LIBRARY, json!({}));
    client.open("sheet.kake", &text);
    let params = client.at("sheet.kake", &find(&text, "kakeami", 0));
    let place = client.ask("textDocument/definition", params.clone());
    let path = place["uri"].as_str().unwrap().strip_prefix("file://").unwrap().to_owned();
    let library = std::fs::read_to_string(&path).unwrap();
    let line = library.lines().nth(place["range"]["start"]["line"].as_u64().unwrap() as usize).unwrap();
    assert!(line.starts_with("tone kakeami("), "{line}");
    assert!(std::fs::metadata(&path).unwrap().permissions().readonly());
    let (_, words) = client.refused("textDocument/rename", {
        let mut params = params;
        params["newName"] = json!("other");
        params
    });
    assert!(words.contains("comes with the program"), "{words}");
    client.ask("shutdown", Value::Null);
    client.tell("exit", Value::Null);
    assert_eq!(client.ended(), Some(0));
    assert!(!std::path::Path::new(&path).exists());
}

#[test]
fn references_are_found_in_all_scenes_that_import() {
    let mut client = opened();
    let mut ask = |with_declaration: bool| {
        let mut params = client.at("sheet.kake", &find(SHEET, "double", 0));
        params["context"] = json!({ "includeDeclaration": with_declaration });
        let list = client.ask("textDocument/references", params);
        list.as_array()
            .unwrap()
            .iter()
            .map(|place| (place["uri"].clone(), place["range"]["start"].clone()))
            .collect::<Vec<_>>()
    };
    let (all, uses) = (ask(true), ask(false));
    let expected = [
        (json!(client.uri("other.kake")), find(OTHER, "double", 0)),
        (json!(client.uri("sheet.kake")), find(SHEET, "double", 0)),
        (json!(client.uri("tones/base.kake")), find(BASE, "double", 0)),
    ];
    assert_eq!(all, expected);
    assert_eq!(uses, expected[..2]);
    let params = client.at("sheet.kake", &find(SHEET, "gap", 0));
    let places = client.ask("textDocument/documentHighlight", params);
    assert_eq!(places.as_array().unwrap().len(), 3);
}

#[test]
fn names_are_changed_in_all_scenes_that_import() {
    let mut client = opened();
    // An edit that is not saved counts.
    let other = OTHER.replace("k: 2", "k: 2 + 0");
    client.open("other.kake", &other);
    let mut params = client.at("sheet.kake", &find(SHEET, "tile", 0));
    assert_eq!(client.ask("textDocument/prepareRename", params.clone())["placeholder"], "tile");
    params["newName"] = json!("side");
    let changes = client.ask("textDocument/rename", params)["changes"].clone();
    let starts = |path: &str| {
        let edits = changes[client.uri(path)].as_array().unwrap().clone();
        edits.iter().map(|edit| (edit["newText"].clone(), edit["range"]["start"].clone())).collect::<Vec<_>>()
    };
    assert_eq!(starts("sheet.kake"), [(json!("side"), find(SHEET, "tile", 0))]);
    assert_eq!(starts("other.kake"), [(json!("side"), find(&other, "tile", 0))]);
    assert_eq!(starts("tones/base.kake").len(), 2);
}

#[test]
fn names_that_would_mean_something_else_are_refused() {
    let mut client = opened();
    let mut refused = |piece: &str, new: &str| {
        let mut params = client.at("sheet.kake", &find(SHEET, piece, 0));
        params["newName"] = json!(new);
        client.refused("textDocument/rename", params).1
    };
    assert!(refused("gap", "inner").contains("declared twice"));
    assert!(refused("gap", "canvas").contains("begins a statement"));
    assert!(refused("gap", "not").contains("word of the language"));
    assert!(refused("gap", "a b").contains("is no name"));
    assert!(refused("gap", "").contains("is no name"));
    assert!(refused("linear", "other").contains("only names that a scene declares"));
    // In the tone `k` is the number of layers, and the tile's side would be it too.
    assert!(refused("tile:", "k").contains("twice"));
}

#[test]
fn a_new_name_may_not_catch_others() {
    let text = "let outer = 1mm\ntone t(width: length = 2mm) {\n  place: hex(spacing: outer)\n  fill: lines(pitch: width)\n}\nregion c = inset(canvas, navy)\nlet navy = 1mm\ncanvas { size: a6, ink: red }\npaint c with t\n";
    let mut client = Client::greeted(&[], json!({}));
    client.open("a.kake", text);
    let mut rename = |piece: &str, new: &str| {
        let mut params = client.at("a.kake", &find(text, piece, 0));
        params["newName"] = json!(new);
        let id = client.post("textDocument/rename", params);
        client.response(id)["error"]["message"].as_str().unwrap_or_default().to_owned()
    };
    // The parameter would hide the value that the tone takes from around it.
    assert!(rename("width", "outer").contains("would then mean something else"));
    // The name of the ink would be a length.
    assert!(!rename("navy", "red").is_empty());
    assert_eq!(rename("navy", "blue"), "");
}

#[test]
fn random_numbers_that_follow_a_name_are_told_of() {
    let text = "canvas { size: a6 }\nfield cloud = noise(scale: 9mm)\ntone t {\n  place: hex(spacing: 4mm)\n  fill: lines(pitch: 1mm)\n  k: cloud\n}\npaint canvas with t\n";
    let mut client = Client::greeted(&[], json!({}));
    client.open("a.kake", text);
    for (piece, words) in [("cloud", "noise"), ("t {", "called after its tone")] {
        let mut params = client.at("a.kake", &find(text, piece, 0));
        params["newName"] = json!("other");
        client.ask("textDocument/rename", params);
        let told = client.told("window/showMessage");
        assert!(told["message"].as_str().unwrap().contains(words), "{told}");
    }
}

#[test]
fn outlines_show_what_a_scene_holds() {
    let mut client = opened();
    let uri = client.uri("sheet.kake");
    let symbols = client.ask("textDocument/documentSymbol", json!({ "textDocument": { "uri": uri } }));
    let names: Vec<&str> = symbols.as_array().unwrap().iter().map(|symbol| symbol["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["base", "std:manga", "canvas", "gap", "inner", "shade", "paint sheet", "layer front"]);
    assert_eq!(symbols[7]["children"][0]["name"], "outline");
    let folds = client.ask("textDocument/foldingRange", json!({ "textDocument": { "uri": uri } }));
    let lines: Vec<_> =
        folds.as_array().unwrap().iter().map(|fold| (fold["startLine"].clone(), fold["endLine"].clone())).collect();
    assert!(lines.contains(&(json!(5), json!(7))), "{lines:?}");
    assert!(lines.contains(&(json!(2), json!(3))), "{lines:?}");
}
