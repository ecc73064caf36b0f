//! How a session goes: greetings, edits, diagnostics, nonsense, and its end.

use serde_json::{Value, json};

use super::client::{Client, find};
use super::{BASE, LIBRARY, SHEET};

#[test]
fn mistakes_are_told_as_they_are_typed_and_taken_back() {
    let mut client = Client::greeted(&LIBRARY, json!({}));
    client.open("sheet.kake", SHEET);
    client.faultless("sheet.kake");
    client.change("sheet.kake", 2, &SHEET.replace("inset(canvas", "inste(canvas"));
    let problem = client.problem("sheet.kake", "nothing called `inste`");
    assert_eq!(problem["code"], "kake::unknown-function");
    assert_eq!(problem["severity"], 1);
    assert_eq!(problem["range"]["start"], find(SHEET, "inset", 0));
    client.change("sheet.kake", 3, SHEET);
    client.faultless("sheet.kake");
}

#[test]
fn hints_are_related_where_the_editor_shows_them() {
    let capabilities = json!({ "textDocument": { "publishDiagnostics": { "relatedInformation": true } } });
    let mut client = Client::greeted(&LIBRARY, capabilities);
    client.open("sheet.kake", &SHEET.replace("inset(canvas", "inste(canvas"));
    let problem = client.problem("sheet.kake", "nothing called `inste`");
    assert_eq!(problem["relatedInformation"][0]["message"], "did you mean `inset`?");
    assert!(!problem["message"].as_str().unwrap().contains("did you mean"));
    let mut plain = Client::greeted(&LIBRARY, json!({}));
    plain.open("sheet.kake", &SHEET.replace("inset(canvas", "inste(canvas"));
    plain.problem("sheet.kake", "did you mean `inset`?");
}

#[test]
fn imports_see_texts_that_are_not_saved() {
    let mut client = Client::greeted(&LIBRARY, json!({}));
    client.open("sheet.kake", SHEET);
    client.faultless("sheet.kake");
    client.open("tones/base.kake", BASE);
    client.faultless("tones/base.kake");
    // The tone goes, in the open text only: the sheet that imports it is at fault.
    client.change("tones/base.kake", 2, &BASE.replace("tone squares", "tone boxes"));
    client.problem("sheet.kake", "declares no");
    // Closed without saving, the file counts again.
    client.close("tones/base.kake");
    client.faultless("sheet.kake");
}

#[test]
fn mistakes_of_imported_files_are_told_and_taken_back() {
    let broken = BASE.replace("pitch: 0.8mm", "pitch: 0.8deg");
    let mut client = Client::greeted(&[LIBRARY[0], ("tones/base.kake", &broken), LIBRARY[2]], json!({}));
    client.open("sheet.kake", SHEET);
    client.problem("tones/base.kake", "expected a length, found an angle");
    client.close("sheet.kake");
    client.faultless("tones/base.kake");
}

#[test]
fn places_count_as_was_agreed_on() {
    let text = "let か🖌 = 1\nlet x = missing // 🖌 か\nlet y = \"🖌{nothing}\"\n".replace("か🖌", "か");
    let line = text.lines().nth(2).unwrap();
    for (kind, width) in [("utf-8", 4), ("utf-16", 2)] {
        let mut client = Client::start(&[]);
        let capabilities = json!({ "general": { "positionEncodings": [kind] } });
        let answer = client.ask("initialize", json!({ "capabilities": capabilities }));
        assert_eq!(answer["capabilities"]["positionEncoding"], kind);
        client.open("a.kake", &text.replace('\n', "\r\n"));
        let problem = client.problem("a.kake", "`nothing` is not known");
        let column = line.find("🖌").unwrap() + width + 1;
        assert_eq!(problem["range"]["start"], json!({ "line": 2, "character": column }));
    }
    let mut client = Client::start(&[]);
    let answer = client.ask("initialize", json!({ "capabilities": {} }));
    assert_eq!(answer["capabilities"]["positionEncoding"], "utf-16");
}

#[test]
fn edits_change_the_text_where_they_say() {
    let mut client = Client::greeted(&LIBRARY, json!({}));
    client.open("sheet.kake", SHEET);
    client.faultless("sheet.kake");
    let uri = client.uri("sheet.kake");
    // Behind the brush, which takes two columns; then away with it, in one message.
    let start = find(SHEET, "// 🖌", 0);
    let line = start["line"].as_u64().unwrap();
    let behind = start["character"].as_u64().unwrap() + 5;
    let at = |from: u64, to: u64| json!({ "start": { "line": line, "character": from }, "end": { "line": line, "character": to } });
    client.tell(
        "textDocument/didChange",
        json!({ "textDocument": { "uri": uri, "version": 2 }, "contentChanges": [
            { "range": at(behind, behind), "text": "\nlet bad = missing" },
            { "range": at(behind - 2, behind), "text": "" },
        ] }),
    );
    let problem = client.problem("sheet.kake", "`missing` is not known");
    assert_eq!(problem["range"]["start"], json!({ "line": line + 1, "character": 10 }));
}

#[test]
fn scenes_in_toml_are_looked_at_and_other_settings_are_not() {
    let mut client = Client::greeted(&[], json!({}));
    let scene = "edition = 1\n\n[canvas]\nsize = \"(60mm, 30mmm)\"\n";
    client.open("scene.toml", scene);
    let problem = client.problem("scene.toml", "mmm");
    assert_eq!(problem["range"]["start"]["line"], 3);
    client.open("Cargo.toml", "[package]\nedition = \"2024\"\n");
    client.open("kake.toml", "[library]\nname = \"lib\"\nversion = 1\n");
    assert!(!client.problems("kake.toml").is_empty());
    // The settings of the other program were passed over in between.
    client.change("scene.toml", 2, &scene.replace("mmm", "mm"));
    loop {
        let told = client.told("textDocument/publishDiagnostics");
        assert_ne!(told["uri"], json!(client.uri("Cargo.toml")));
        if told["uri"] == json!(client.uri("scene.toml")) && told["diagnostics"] == json!([]) {
            break;
        }
    }
}

#[test]
fn what_waits_for_a_text_that_changes_is_told_so() {
    let mut client = Client::greeted(&LIBRARY, json!({}));
    client.open("sheet.kake", SHEET);
    client.faultless("sheet.kake");
    let place = find(SHEET, "gap", 1);
    let at = client.at("sheet.kake", &place);
    // Both in one write, so that the question still waits when the second edit comes.
    client.change("sheet.kake", 2, &format!("{SHEET}\n"));
    let id = client.post("textDocument/hover", at.clone());
    client.change("sheet.kake", 3, SHEET);
    let answer = client.response(id);
    let code = answer["error"]["code"].as_i64();
    assert!(code == Some(-32801) || answer["result"].is_object(), "{answer}");
    assert!(client.ask("textDocument/hover", at)["contents"].is_object());
}

#[test]
fn questions_can_be_taken_back() {
    let mut client = Client::greeted(&LIBRARY, json!({}));
    client.open("sheet.kake", SHEET);
    client.faultless("sheet.kake");
    // A loop that takes long: the question waits for its end, or for being taken back.
    let slow = format!("{SHEET}\nfn f(n) = if n < 1 then 0 else f(n - 1) + f(n - 1)\nlet never = f(60)\n");
    client.change("sheet.kake", 2, &slow);
    let at = client.at("sheet.kake", &find(SHEET, "gap", 1));
    let id = client.post("textDocument/hover", at.clone());
    client.tell("$/cancelRequest", json!({ "id": id }));
    client.tell("$/cancelRequest", json!({ "id": "never asked" }));
    client.tell("$/cancelRequest", json!(null));
    assert_eq!(client.response(id)["error"]["code"], -32800);
    // The look at the slow text is given up for the next one.
    client.change("sheet.kake", 3, SHEET);
    assert!(client.ask("textDocument/hover", at)["contents"].is_object());
}

#[test]
fn nonsense_is_answered_and_survived() {
    let mut client = Client::start(&LIBRARY);
    assert_eq!(client.refused("textDocument/hover", json!({})).0, -32002);
    client.ask("initialize", json!({ "capabilities": { "general": { "positionEncodings": 7 } } }));
    assert_eq!(client.refused("initialize", json!({})).0, -32600);
    for body in ["{", "[]", "7", "{\"jsonrpc\":\"2.0\"}", "{\"id\":{},\"method\":\"shutdown\"}"] {
        client.raw(format!("Content-Length: {}\r\n\r\n{body}", body.len()).as_bytes());
        let answer = client.next();
        assert_eq!((&answer["id"], &answer["error"]["code"]), (&Value::Null, &json!(-32700)), "{body}");
    }
    client.raw(b"Content-Length: x\r\n\r\n");
    assert_eq!(client.next()["error"]["code"], -32700);
    assert_eq!(client.refused("textDocument/telepathy", json!({})).0, -32601);
    assert_eq!(client.refused("textDocument/hover", json!({ "textDocument": 7 })).0, -32602);
    assert_eq!(client.refused("workspace/executeCommand", json!({ "command": "rm" })).0, -32602);
    client.tell("textDocument/telepathy", json!({}));
    client.tell("textDocument/didOpen", json!(null));
    client.tell("textDocument/didChange", json!({ "textDocument": { "uri": "file:///never.kake", "version": 1 } }));
    client.close("never.kake");
    client.change("never.kake", 1, "let a = 1");
    client.send(&json!({ "jsonrpc": "2.0", "id": 99, "result": null }));
    let nowhere = json!({ "line": 4_000_000_000_u32, "character": 4_000_000_000_u32 });
    let at = client.at("never.kake", &nowhere);
    assert_eq!(client.ask("textDocument/hover", at), Value::Null);

    client.open("sheet.kake", SHEET);
    client.faultless("sheet.kake");
    let at = client.at("sheet.kake", &nowhere);
    for method in ["hover", "definition", "completion", "signatureHelp", "prepareRename", "documentHighlight"] {
        let id = client.post(&format!("textDocument/{method}"), at.clone());
        client.response(id);
    }
    // Numbers of versions that go backwards, and ranges that do.
    client.change("sheet.kake", -5, SHEET);
    let uri = client.uri("sheet.kake");
    let range = json!({ "start": nowhere, "end": { "line": 0, "character": 0 } });
    let changes = json!([{ "range": range, "text": "\nlet more = missing" }]);
    client.tell(
        "textDocument/didChange",
        json!({ "textDocument": { "uri": uri, "version": 1 }, "contentChanges": changes }),
    );
    client.problem("sheet.kake", "`missing` is not known");
    client.open("sheet.kake", "\u{feff}edition 1\n");
    client.faultless("sheet.kake");
}

#[test]
fn a_session_ends_as_it_should() {
    let mut client = Client::greeted(&[], json!({}));
    assert_eq!(client.ask("shutdown", Value::Null), Value::Null);
    assert_eq!(client.refused("textDocument/hover", json!({})).0, -32600);
    client.tell("exit", Value::Null);
    assert_eq!(client.ended(), Some(0));

    let mut client = Client::greeted(&[], json!({}));
    client.tell("exit", Value::Null);
    assert_eq!(client.ended(), Some(1));

    let mut client = Client::start(&[]);
    client.tell("exit", Value::Null);
    assert_eq!(client.ended(), Some(1));

    // An editor that is gone; while a scene is looked at, too.
    let mut client = Client::greeted(&[], json!({}));
    client.open("a.kake", "fn f(n) = if n < 1 then 0 else f(n - 1) + f(n - 1)\nlet never = f(60)\n");
    assert_eq!(client.hang_up(), Some(1));

    let mut client = Client::start(&[]);
    client.raw(b"Content-Length: 99999999999999999999\r\n\r\n{}");
    assert_eq!(client.next()["error"]["code"], -32700);
    client.raw(b"Content-Length: 9999999999\r\n\r\n{}");
    assert_eq!(client.hang_up(), Some(1));
}
