//! Deep texts: none exhausts the two megabytes of stack that a test has.

use super::*;
use crate::diag::Code;

fn nested(open: &str, inner: &str, close: &str, depth: usize) -> String {
    format!("let a = {}{inner}{}\nlet b = 3", open.repeat(depth), close.repeat(depth))
}

fn codes(text: &str) -> Vec<Code> {
    parse(source(), text).1.iter().map(|diagnostic| diagnostic.code).collect()
}

/// Brackets and words that nest, with what they hold.
const NESTS: [(&str, &str, &str); 9] = [
    ("(", "1", ")"),
    ("[", "1", "]"),
    ("f(a: -", "1", ")"),
    ("{ a: ", "1", "}"),
    ("\"{", "1", "}\""),
    ("(1 + ", "1", ")"),
    ("if a then ", "1", " else 2"),
    ("1 + if a then b else ", "1", ""),
    ("match ", "a", "{ _ => 1 }"),
];

#[test]
fn nesting_is_allowed_up_to_the_limit() {
    for (open, inner, close) in NESTS {
        // The tree of operators may be a little less deep than the brackets, which is all that most texts nest.
        let depth = if open.contains('-') || open.starts_with("1 +") { NESTING * 2 / 3 } else { NESTING };
        let text = nested(open, inner, close, depth);
        assert_eq!(codes(&text), [], "{open}");
        assert_eq!(parse(source(), &text).0.statements.len(), 2, "{open}");
    }
}

#[test]
fn nesting_beyond_the_limit_is_one_mistake() {
    for (open, inner, close) in NESTS {
        for depth in [NESTING + 1, 10_000] {
            let text = nested(open, inner, close, depth);
            assert_eq!(codes(&text), [Code::Nesting], "{open}");
            // A string that is not closed is no nesting, but must not be followed into its depth either.
            let expected = if open.starts_with('"') { Code::Syntax } else { Code::Nesting };
            assert_eq!(codes(&nested(open, "", "", depth)), [expected], "{open}");
        }
    }
    let text = nested("(", "1", ")", NESTING + 1);
    let (document, diagnostics) = parse(source(), &text);
    assert_eq!(document.statements.len(), 1);
    assert_eq!(diagnostics[0].span.map(|span| span.start as usize), Some("let a = ".len() + NESTING));
}

#[test]
fn long_chains_are_flat() {
    for (text, code) in [
        (format!("let a = {}1", "- ".repeat(10_000)), None),
        (format!("let a = {}b", "not ".repeat(10_000)), None),
        (format!("let a = b{}", " + 1".repeat(100_000)), None),
        (format!("let a = b{}", " ^ 2".repeat(10_000)), None),
        (format!("let a = {}c", "if a then b else ".repeat(10_000)), None),
        (format!("let a = {}d", "if a then if b then c else d else ".repeat(10_000)), None),
        (format!("if a {{ }} {}", "else if b { } ".repeat(10_000)), None),
        (format!("let a = [{}]", "match a { _ => if b then c else d }, ".repeat(10_000)), None),
        (format!("tone t {{ {} }}", "k: if a then b else match c { 1 => 2 } ".repeat(1_000)), None),
        ("if a { } ".repeat(10_000), None),
        (format!("let a = b{}", "[0]".repeat(10_000)), Some(Code::Nesting)),
        (format!("let a = b{}", " ^ -2".repeat(10_000)), Some(Code::Nesting)),
        (format!("let a = b{}", "(0)".repeat(10_000)), Some(Code::Syntax)),
        (format!("let a = b{}", ".c".repeat(10_000)), Some(Code::Syntax)),
        (format!("let a = {}b", "if ".repeat(10_000)), Some(Code::Nesting)),
    ] {
        let shown = text.get(..60).unwrap_or(&text);
        assert_eq!(codes(&text), code.into_iter().collect::<Vec<_>>(), "in {shown}");
    }
}

#[test]
fn blocks_nest_up_to_the_limit() {
    for block in ["layer \"a\" { ", "for i in 0 .. 2 { ", "if a { ", "if a { } else { "] {
        let allowed = format!("{}paint a with b{}", block.repeat(NESTING), "}".repeat(NESTING));
        assert_eq!(codes(&allowed), [], "{block}");
        for depth in [NESTING + 1, 10_000] {
            let text = format!("{}paint a with b{}\nlet b = 3", block.repeat(depth), "}".repeat(depth));
            assert_eq!(codes(&text), [Code::Nesting], "{block}");
            assert_eq!(codes(&block.repeat(depth)), [Code::Nesting], "{block}");
        }
    }
}

#[test]
fn absurd_texts_are_met_calmly() {
    for (text, least) in [
        ("let ".repeat(100_000), 1),
        ("(".repeat(100_000), 1),
        (format!("{}{}", "(".repeat(50_000), "]".repeat(50_000)), 1),
        (")".repeat(100_000), 1),
        ("\"\n".repeat(100_000), 1),
        ("let +\n".repeat(50_000), 1),
        ("x\n".repeat(50_000), 1),
        (format!("let a = \"{}", "\\u{".repeat(50_000)), 1),
        (format!("let a = {}", "\"{ /*\n*/".repeat(20_000)), 1),
        (format!("let a = {}{}", "(x\n".repeat(20_000), "y: x\n".repeat(20_000)), 1),
        ("seed pen ".repeat(20_000), 0),
    ] {
        let shown = text.get(..30).unwrap_or(&text);
        let found = codes(&text).len();
        assert!((least..=MOST_ERRORS * 2 + 1).contains(&found), "{found} mistakes in {shown}");
    }
}
