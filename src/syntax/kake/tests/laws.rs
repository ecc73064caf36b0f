//! What holds for every text.

use super::*;
use crate::diag::Code;
use crate::syntax::kake::grammar::{Grammar, Rule};
use pest::Parser;
use proptest::prelude::*;

/// Every span in the debug form of a tree: the only spans there are, for the tree's types print all they hold.
fn spans(tree: &str) -> Vec<(usize, usize)> {
    let numbers = |text: &str| text.split(|letter: char| !letter.is_ascii_digit()).next().unwrap().parse().unwrap();
    let after_source = tree.split("source: SourceId(").skip(1);
    after_source
        .filter_map(|rest| {
            let start = rest.split_once("), start: ")?.1;
            let end = start.split_once(", end: ")?.1;
            Some((numbers(start), numbers(end)))
        })
        .collect()
}

/// Reads a text and holds its spans to it.
fn check(text: &str) -> (Document, Vec<Diagnostic>) {
    let (document, diagnostics) = parse(source(), text);
    let trees = spans(&format!("{:?} {:?}", document.statements, document.comments));
    if diagnostics.is_empty() {
        for &(start, end) in &trees {
            let stretch = text.get(start..end).unwrap_or_default();
            assert_eq!(stretch, stretch.trim(), "a span is wider than what it holds in {text:?}");
        }
    }
    for (start, end) in trees.into_iter().chain(spans(&format!("{diagnostics:?}"))) {
        assert!(text.get(start..end).is_some(), "{start}..{end} is no stretch of {text:?}");
    }
    let starts: Vec<_> = diagnostics.iter().map(|diagnostic| diagnostic.span).collect();
    assert!(starts.is_sorted(), "out of order in {text:?}");
    (document, diagnostics)
}

/// Holds the reader to the grammar: it reads without a word what the grammar reads, but for a line end inside a string,
/// which the grammar cannot rule out between an interpolation's braces.
fn agrees(text: &str) -> Result<(), TestCaseError> {
    let (_, diagnostics) = check(text);
    let whole = Grammar::parse(Rule::file, text);
    if diagnostics.is_empty() {
        prop_assert!(whole.is_ok(), "only the reader reads {text:?}: {whole:?}");
    }
    if whole.is_ok() {
        let refused = diagnostics.iter().find(|diagnostic| {
            let words = ["expected", "unclosed", "closes nothing"];
            diagnostic.code == Code::Syntax && words.iter().any(|word| diagnostic.message.contains(word))
        });
        let refused = refused.filter(|_| !diagnostics.iter().any(|other| other.message == "unclosed string"));
        prop_assert!(refused.is_none(), "only the grammar reads {text:?}: {refused:?}");
    }
    Ok(())
}

/// The words, signs and spaces of the scene, which it is taken apart into.
fn pieces() -> Vec<&'static str> {
    let mut pieces = Vec::new();
    let mut start = 0;
    let mut last = ' ';
    for (at, letter) in SCENE.char_indices() {
        let joins = letter.is_alphanumeric() && last.is_alphanumeric();
        if !joins && at > start {
            pieces.push(&SCENE[start..at]);
            start = at;
        }
        last = letter;
    }
    pieces.push(&SCENE[start..]);
    pieces
}

/// What is done to a piece: left out, doubled, exchanged for another or put before another.
fn change(pieces: &mut Vec<&'static str>, at: usize, other: usize, how: u8) {
    let (at, other) = (at % pieces.len(), other % pieces.len());
    match how {
        0 => {
            pieces.remove(at);
        }
        1 => pieces.insert(at, pieces[at]),
        2 => pieces.swap(at, other),
        _ => pieces.insert(at, pieces[other]),
    }
}

/// What nests, each by one.
const NESTS: [(&str, &str); 11] = [
    ("(", ")"),
    ("[1, ", "]"),
    ("f(x: ", ")"),
    ("{ a: ", "}"),
    ("b[", "]"),
    ("\"{", "}\""),
    ("if ", " then a else b"),
    ("if a then ", " else b"),
    ("if a then b else if c then ", " else d"),
    ("if a then b else 1 + ", ""),
    ("match ", " { _ => a }"),
];

#[test]
fn the_grammar_reads_the_scene() {
    agrees(SCENE).unwrap();
    assert!(Grammar::parse(Rule::file, SCENE).is_ok());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn any_text_is_met(text in any::<String>()) {
        check(&text);
        let place = |offset: usize| offset;
        let _ = parse_expression(source(), &text, &place);
        let _ = parse_parameters(source(), &text, &place);
    }

    #[test]
    fn any_text_of_signs_is_met(text in r#"([a-c ]|let |tone |paint |if |match |then |else |layer |[0-9]|mm|%|[(){}\[\]"]|[-+*/^.,:=<>\\]|//|/\*|\n|あ){0,80}"#) {
        agrees(&text)?;
    }

    #[test]
    fn changed_scenes_are_met(changes in prop::collection::vec((any::<usize>(), any::<usize>(), 0..4u8), 1..4)) {
        let mut pieces = pieces();
        for (at, other, how) in changes {
            change(&mut pieces, at, other, how);
        }
        agrees(&pieces.concat())?;
    }

    #[test]
    fn scenes_with_changed_bytes_are_met(changes in prop::collection::vec((any::<usize>(), any::<bool>()), 1..6)) {
        let mut bytes = SCENE.as_bytes().to_vec();
        for (at, doubles) in changes {
            let at = at % bytes.len();
            if doubles {
                bytes.insert(at, bytes[at]);
            } else {
                bytes.remove(at);
            }
        }
        agrees(&String::from_utf8_lossy(&bytes))?;
    }

    #[test]
    fn nesting_is_counted_as_the_grammar_recurses(nests in prop::collection::vec(0..NESTS.len(), 100..160)) {
        let open: String = nests.iter().map(|&nest| NESTS[nest].0).collect();
        let close: String = nests.iter().rev().map(|&nest| NESTS[nest].1).collect();
        let (_, diagnostics) = check(&format!("let v = {open}1{close}\nlet w = 1"));
        let codes: Vec<Code> = diagnostics.iter().map(|diagnostic| diagnostic.code).collect();
        let expected: &[Code] = if nests.len() > NESTING { &[Code::Nesting] } else { &[] };
        prop_assert_eq!(codes, expected);
    }

    #[test]
    fn what_stands_behind_a_mistake_is_read(at in any::<usize>(), how in 0..2u8) {
        // A change to the first half leaves the last statements as they are.
        let mut pieces = pieces();
        let half = pieces.iter().position(|piece| *piece == "inks").unwrap();
        change(&mut pieces, at % half, 0, how);
        let (document, _) = check(&pieces.concat());
        let last = document.statements.last().map(|statement| &statement.kind);
        let is_whole = matches!(last, Some(StatementKind::Experiment { properties, .. }) if properties.len() == 2);
        prop_assert!(is_whole, "the experiment is lost: {last:?}");
    }
}
