//! What editors are given besides: grammars whose words are the language's.

use std::collections::BTreeSet;
use std::fs;

use kakeami::lower::reference::Kind;
use kakeami::syntax::ast::Unit;
use kakeami::syntax::kake::{KEYWORDS, RESERVED};
use serde_json::Value;

use crate::support::here;

/// The words of a text: runs of letters.
fn words(text: &str) -> BTreeSet<&str> {
    text.split(|c: char| !c.is_ascii_lowercase()).filter(|word| !word.is_empty()).collect()
}

/// The words that the grammar of the language itself knows: `word_paint`, and those of `reserved`.
fn pest() -> (BTreeSet<String>, BTreeSet<String>) {
    let grammar = fs::read_to_string(here("grammar/kake.pest")).expect("the grammar is there");
    let rules = grammar.lines().filter_map(|line| line.strip_prefix("word_")?.split_once(" = "));
    let words = rules.map(|(word, _)| word.to_owned()).collect();
    let reserved = grammar.lines().find_map(|line| line.strip_prefix("reserved = ")).expect("the rule is there");
    let reserved = reserved.split('"').skip(1).step_by(2).map(ToOwned::to_owned).collect();
    (words, reserved)
}

#[test]
fn the_grammar_for_editors_has_the_words_of_the_language() {
    let text = fs::read_to_string(here("editors/vscode/syntaxes/kake.tmLanguage.json")).expect("it is there");
    let grammar: Value = serde_json::from_str(&text).expect("it is JSON");
    let part = |name: &str| grammar["repository"][name].to_string();
    let (known, reserved) = pest();
    assert_eq!(reserved, RESERVED.iter().map(|word| (*word).to_owned()).collect());
    let marked = part("statement") + &part("reserved") + &part("clause");
    let marked = words(&marked);
    for word in known.iter().chain(&reserved) {
        assert!(marked.contains(word.as_str()), "`{word}` is not marked");
    }
    let statements = part("statement") + &part("reserved");
    for word in KEYWORDS {
        assert!(words(&statements).contains(word), "`{word}` begins no statement");
    }
    // And none that the language does not have.
    for (name, rule) in [("reserved", 1), ("clause", 0)] {
        let rules = &grammar["repository"][name];
        let pattern = if rule == 1 { rules["patterns"].to_string() } else { rules["match"].to_string() };
        for group in pattern.split("b(").skip(1).filter_map(|rest| rest.split_once(')')) {
            // What only looks ahead is no group of words.
            for word in group.0.split('|').filter(|_| !group.0.starts_with('?')) {
                assert!(known.contains(word) || reserved.contains(word), "`{word}` is no word of the language");
            }
        }
    }
    let units: BTreeSet<&str> = Unit::ALL.iter().map(|unit| unit.symbol()).filter(|unit| *unit != "%").collect();
    let pattern = grammar["repository"]["number"]["match"].as_str().expect("it is a pattern").to_owned();
    let listed = pattern.split("(mm").nth(1).and_then(|rest| rest.split(')').next()).expect("units are listed");
    assert_eq!(format!("mm{listed}").split('|').collect::<BTreeSet<_>>(), units);
    let kinds: BTreeSet<&str> = Kind::NAMED.iter().map(|kind| kind.name()).collect();
    let pattern = grammar["repository"]["type"]["match"].as_str().expect("it is a pattern").to_owned();
    let listed = pattern.split("(number").nth(1).and_then(|rest| rest.split(')').next()).expect("types are listed");
    assert_eq!(format!("number{listed}").split('|').collect::<BTreeSet<_>>(), kinds);
}

#[test]
fn the_syntax_file_for_vim_has_the_words_of_the_language() {
    let text = fs::read_to_string(here("editors/vim/syntax/kake.vim")).expect("it is there");
    let (known, reserved) = pest();
    let marked = words(&text);
    for word in known.iter().chain(&reserved) {
        assert!(marked.contains(word.as_str()), "`{word}` is not marked");
    }
}

#[test]
fn the_extension_names_files_that_are_there() {
    let folder = here("editors/vscode");
    let read = |name: &str| -> Value {
        serde_json::from_str(&fs::read_to_string(folder.join(name)).expect("it is there")).expect("it is JSON")
    };
    let package = read("package.json");
    assert_eq!(package["version"], env!("CARGO_PKG_VERSION"));
    let contributes = &package["contributes"];
    read(contributes["languages"][0]["configuration"].as_str().expect("it is a path"));
    read(contributes["grammars"][0]["path"].as_str().expect("it is a path"));
    assert!(folder.join(package["main"].as_str().expect("it is a path")).is_file());
    assert_eq!(contributes["grammars"][0]["scopeName"], read("syntaxes/kake.tmLanguage.json")["scopeName"]);
}
