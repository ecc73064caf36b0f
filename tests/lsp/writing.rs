//! What helps while a scene is written: completion, signatures, form, colours and quick fixes.

use serde_json::{Value, json};

use super::client::{Client, find, marked, position};
use super::{BASE, LIBRARY, SHEET};

/// The names that are offered at the mark of a text, which stands in place of the sheet.
fn offered(client: &mut Client, text: &str) -> Vec<String> {
    items(client, text).iter().map(|item| item["label"].as_str().unwrap().to_owned()).collect()
}

fn items(client: &mut Client, text: &str) -> Vec<Value> {
    let (text, at) = marked(text);
    client.open("sheet.kake", SHEET);
    client.faultless("sheet.kake");
    client.change("sheet.kake", 2, &text);
    let params = client.at("sheet.kake", &position(&text, at));
    let list = client.ask("textDocument/completion", params)["items"].as_array().unwrap().clone();
    client.close("sheet.kake");
    list
}

/// What is offered holds these names, and none of those.
#[track_caller]
fn offers(client: &mut Client, text: &str, these: &[&str], not_those: &[&str]) {
    let names = offered(client, text);
    for name in these {
        assert!(names.iter().any(|found| found == name), "`{name}` is not among {names:?}");
    }
    for name in not_those {
        assert!(!names.iter().any(|found| found == name), "`{name}` is among {names:?}");
    }
}

#[test]
fn statements_are_offered_where_one_may_stand() {
    let mut client = Client::greeted(&LIBRARY, json!({}));
    offers(&mut client, "edition 1\n‸", &["canvas", "tone", "paint", "experiment"], &["lines", "place"]);
    offers(&mut client, "edition 1\npa‸", &["paint", "param"], &["lines"]);
    offers(&mut client, "layer \"a\" {\n  ‸\n}\n", &["paint", "let"], &["tone", "canvas"]);
    offers(&mut client, "paint canvas ‸", &["with"], &["lines"]);
    offers(&mut client, "paint canvas with t\n  ‸", &["as", "seed", "paint"], &[]);
}

#[test]
fn slots_offer_what_they_take() {
    let mut client = Client::greeted(&LIBRARY, json!({}));
    offers(&mut client, "tone t {\n  ‸\n}\n", &["place", "fill", "blend"], &["size", "lines"]);
    offers(&mut client, "tone t {\n  fill: lines(pitch: 1mm)\n  ‸\n}\n", &["place"], &["fill"]);
    offers(&mut client, "canvas {\n  si‸", &["size", "dpi"], &["place"]);
    offers(&mut client, "tone t {\n  fill: ‸\n}\n", &["lines", "nawaami"], &["poisson", "sin", "voronoi"]);
    offers(&mut client, "tone t {\n  place: ‸", &["poisson", "hex"], &["lines"]);
    offers(&mut client, "tone t {\n  place: relaxed(‸", &["poisson", "placement", "rounds"], &["lines"]);
    offers(&mut client, "tone t {\n  blend: ‸\n}\n", &["dither", "contour"], &["lines", "gap"]);
    offers(&mut client, "tone t {\n  blend: \"di‸\"\n}\n", &["dither"], &["lines"]);
    offers(&mut client, "tone t {\n  fill: [lines(pitch: 1mm), ‸]\n}\n", &["dots"], &["hex"]);
    offers(&mut client, "tone t {\n  fill: if true then ‸", &["dots"], &["hex"]);
    offers(&mut client, "canvas { size: ‸ }\n", &["a4", "jis_b4"], &["lines"]);
    offers(&mut client, "canvas { ink: ‸ }\n", &["navy", "rebeccapurple"], &["lines"]);
    offers(&mut client, "let a: ‸\n", &["length", "placement"], &["lines"]);
    offers(&mut client, "field f = 2 * ‸\n", &["x", "noise", "shade"], &["lines"]);
    offers(&mut client, "fill: lines(pitch: 1mm, cap: ‸", &[], &[]);
    offers(&mut client, "tone t {\n  fill: lines(pitch: 1mm, cap: ‸", &["round"], &["gap"]);
    assert!(offered(&mut client, "// pa‸\n").is_empty());
    assert!(offered(&mut client, "let na‸ = 1\n").is_empty());
}

#[test]
fn names_in_scope_are_offered() {
    let mut client = Client::greeted(&LIBRARY, json!({}));
    let imports = "import \"tones/base.kake\" as base\nimport \"std:manga\"\n";
    let sheet = SHEET.replace("paint inner with base.squares", "paint ‸ with base.squares");
    offers(&mut client, &sheet, &["inner", "gap", "canvas", "circle", "base"], &["lines", "squares"]);
    let sheet = SHEET.replace("base.squares(k: shade,", "base.‸(k: shade,");
    offers(&mut client, &sheet, &["squares"], &["gap", "kakeami"]);
    let sheet = SHEET.replace("with base.squares", "with ‸base.squares");
    offers(&mut client, &sheet, &["kakeami", "base"], &["gap", "sin", "squares"]);
    let text = format!("{imports}tone t(thick: length, k: field = 1) {{\n  fill: lines(pitch: ‸)\n}}\n");
    offers(&mut client, &text, &["thick", "k", "gap"], &["squares"]);
    let text = format!("{imports}fn f(apart, by) = apart * ‸");
    offers(&mut client, &text, &["apart", "by"], &[]);
    let text = "for row in 0 .. 2 {\n  let left = row * 2mm\n  paint inset(canvas, ‸";
    offers(&mut client, text, &["row", "left"], &[]);
}

#[test]
fn arguments_are_offered_with_kinds_and_defaults() {
    let mut client = Client::greeted(&LIBRARY, json!({}));
    let list = items(&mut client, "tone t {\n  fill: lines(pitch: 1mm, ‸)\n}\n");
    let pen = list.iter().find(|item| item["label"] == "pen").unwrap();
    assert_eq!(pen["detail"], "a length; default: 0.2mm");
    assert!(!list.iter().any(|item| item["label"] == "pitch"));
    let sheet = SHEET.replace("base.squares(k: shade, tile: base.double(3mm))", "base.squares(k: shade, ‸)");
    offers(&mut client, &sheet, &["tile"], &["k"]);
    let list = items(&mut client, &SHEET.replace("tile: base", "ti‸le: base"));
    let tile = list.iter().find(|item| item["label"] == "tile").unwrap();
    assert_eq!(tile["detail"], "tile: length = 6mm");
    assert_eq!(tile["textEdit"]["range"]["start"], find(SHEET, "tile", 0));
}

#[test]
fn units_are_offered_behind_numbers() {
    let mut client = Client::greeted(&LIBRARY, json!({}));
    let texts = offered(&mut client, "tone t {\n  fill: lines(pitch: 6‸)\n}\n");
    assert_eq!(texts, ["6mm", "6cm", "6in", "6pt", "6px"]);
    let texts = offered(&mut client, "tone t {\n  angle: fixed(45d‸)\n}\n");
    assert_eq!(texts, ["45deg", "45rad", "45turn"]);
    let texts = offered(&mut client, "tone t {\n  hand: hand(pen: 8‸)\n}\n");
    assert_eq!(texts, ["8%"]);
}

#[test]
fn paths_are_offered_inside_strings() {
    let mut files = LIBRARY.to_vec();
    files.extend([("data/pear.svg", "<svg/>"), ("data/face.png", ""), ("data/notes.txt", "")]);
    let mut client = Client::greeted(&files, json!({}));
    offers(&mut client, "import \"‸\"\n", &["std:manga", "tones/", "other.kake"], &["kake.toml", "data/pear.svg"]);
    offers(&mut client, "import \"tones/‸", &["tones/base.kake"], &["std:manga"]);
    let text = "region r = svg(\"data/‸\")\n";
    offers(&mut client, text, &["data/pear.svg", "data/face.png"], &["data/notes.txt"]);
    offers(&mut client, "import \"../‸\"\n", &[], &["../sheet.kake"]);
    assert!(!offered(&mut client, "import \"../‸\"\n").iter().any(|name| name.starts_with("..")));
}

#[test]
fn forms_are_filled_in_only_where_the_editor_can() {
    let item = |client: &mut Client| {
        let list = items(client, "tone t {\n  place: ‸\n}\n");
        list.iter().find(|item| item["label"] == "poisson").unwrap().clone()
    };
    let plain = item(&mut Client::greeted(&LIBRARY, json!({})));
    assert_eq!(plain["textEdit"]["newText"], "poisson");
    let snippets = json!({ "textDocument": { "completion": { "completionItem": { "snippetSupport": true } } } });
    let filled = item(&mut Client::greeted(&LIBRARY, snippets));
    assert_eq!(
        (&filled["textEdit"]["newText"], &filled["insertTextFormat"]),
        (&json!("poisson(radius: ${1})"), &json!(2))
    );
}

#[test]
fn signatures_show_the_argument_at_hand() {
    let mut client = Client::greeted(&LIBRARY, json!({}));
    let mut help = |text: &str| {
        let (text, at) = marked(text);
        client.open("sheet.kake", SHEET);
        client.faultless("sheet.kake");
        client.change("sheet.kake", 2, &text);
        let params = client.at("sheet.kake", &position(&text, at));
        let help = client.ask("textDocument/signatureHelp", params);
        client.close("sheet.kake");
        help
    };
    let found = help("tone t {\n  fill: lines(1mm, ‸\n}\n");
    let label = found["signatures"][0]["label"].as_str().unwrap();
    assert!(label.starts_with("lines(pitch: length, pen?: length"), "{label}");
    assert_eq!(found["activeParameter"], 1);
    assert_eq!(help("tone t {\n  fill: lines(cap: ‸")["activeParameter"], 4);
    let found = help(&SHEET.replace("tile: base.double(3mm)", "tile: base.double(‸"));
    assert_eq!(found["signatures"][0]["label"], "double(a)");
    let found = help(&SHEET.replace("tile: base", "tile: ‸base"));
    assert_eq!(found["signatures"][0]["documentation"]["value"], "Squares, as by hand.");
    assert_eq!(found["activeParameter"], 1);
    assert_eq!(help("let a = 1‸\n"), Value::Null);
}

#[test]
fn texts_are_formatted_and_line_ends_kept() {
    let mut client = Client::greeted(&LIBRARY, json!({}));
    let format = |client: &mut Client, text: &str| {
        client.open("a.kake", text);
        let params = json!({ "textDocument": { "uri": client.uri("a.kake") }, "options": { "tabSize": 2, "insertSpaces": true } });
        client.ask("textDocument/formatting", params)
    };
    let edits = format(&mut client, "let a = 1\r\nlet   b = 2\r\nlet c = 3\r\n");
    assert_eq!(
        edits,
        json!([{
            "range": { "start": { "line": 1, "character": 0 }, "end": { "line": 2, "character": 0 } },
            "newText": "let b = 2\r\n",
        }])
    );
    assert_eq!(format(&mut client, "let a = 1\n"), json!([]));
    assert_eq!(format(&mut client, "let = \n"), Value::Null);
}

#[test]
fn colours_are_shown_and_picked() {
    let mut client = Client::greeted(&LIBRARY, json!({}));
    client.open("sheet.kake", SHEET);
    let document = json!({ "textDocument": { "uri": client.uri("sheet.kake") } });
    let colours = client.ask("textDocument/documentColor", document);
    assert_eq!(colours[0]["range"]["start"], find(SHEET, "navy", 0));
    assert_eq!(colours[1]["range"]["start"], find(SHEET, "#c02030", 0));
    assert_eq!(colours.as_array().unwrap().len(), 2);
    let mut pick = |red: f64, alpha: f64| {
        let color = json!({ "red": red, "green": 0.0, "blue": 0.0, "alpha": alpha });
        let uri = client.uri("sheet.kake");
        let params = json!({ "textDocument": { "uri": uri }, "color": color, "range": colours[0]["range"] });
        let list = client.ask("textDocument/colorPresentation", params);
        list.as_array().unwrap().iter().map(|one| one["label"].as_str().unwrap().to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(pick(1.0, 1.0), ["#ff0000", "red"]);
    assert_eq!(pick(0.5, 0.5), ["#80000080"]);
    assert_eq!(pick(1e30, 1.0), ["#ff0000", "red"]);
}

#[test]
fn hints_mend_and_codes_are_explained() {
    let broken = SHEET.replace("inset(canvas", "inste(canvas");
    let mut client = Client::greeted(&LIBRARY, json!({}));
    client.open("sheet.kake", &broken);
    let problem = client.problem("sheet.kake", "nothing called `inste`");
    let params = json!({
        "textDocument": { "uri": client.uri("sheet.kake") },
        "range": problem["range"],
        "context": { "diagnostics": [problem] },
    });
    let actions = client.ask("textDocument/codeAction", params);
    let uri = client.uri("sheet.kake");
    assert_eq!(actions[0]["title"], "Write `inset`");
    assert_eq!(actions[0]["edit"]["changes"][&uri][0]["newText"], "inset");
    assert_eq!(actions[0]["diagnostics"][0]["message"], problem["message"]);
    assert_eq!(actions[1]["title"], "Explain kake::unknown-function");
    let text = client.ask("workspace/executeCommand", actions[1]["command"].clone());
    assert!(text.as_str().unwrap().starts_with("kake::unknown-function: "), "{text}");
    assert_eq!(client.told("window/showMessage")["message"], text);
}

#[test]
fn typing_goes_on_in_a_large_scene() {
    // A thousand tones, and an edit after each of them was asked about: every answer is of the text as it is.
    let many: String = (0..1000)
        .map(|i| {
            BASE[10..]
                .replace("squares", &format!("s{i}"))
                .replace("double", &format!("d{i}"))
                .replace("pen", &format!("p{i}"))
        })
        .collect();
    let mut client = Client::greeted(&[], json!({}));
    client.open("many.kake", &many);
    for i in 1..20 {
        let text = format!("{many}\nlet last{i} = 1mm * {i}\nlet z = las");
        client.change("many.kake", i + 1, &text);
    }
    let text = format!("{many}\nlet last = 1mm * 7\n");
    client.change("many.kake", 30, &text);
    let params = client.at("many.kake", &find(&text, "last", 0));
    let hover = client.ask("textDocument/hover", params);
    assert!(hover["contents"]["value"].as_str().unwrap().contains("`7mm`"), "{hover}");
}
