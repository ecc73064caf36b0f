//! Texts with mistakes: what is said, where, and that the rest is still read.

use super::*;
use crate::diag::Code;

/// The mistakes of a text and how many statements are read.
fn check(text: &str, statements: usize, expected: &[&str]) {
    let (document, _) = parse(source(), text);
    assert_eq!(mistakes(text), expected, "in {text}");
    assert_eq!(document.statements.len(), statements, "statements of {text}");
}

#[test]
fn what_was_expected_is_named() {
    for (text, expected) in [
        ("let a =", "=: expected a value after `=`"),
        ("let a = 3 +", "+: expected a value after `+`"),
        ("let a", "a: expected `:` or `=` after `a`"),
        ("let = 3", "=: expected a name, found `=`"),
        ("let a: = 3", "=: expected a type, found `=`"),
        ("edition", "edition: expected a value after `edition`"),
        ("import tones", "tones: expected a path in quotes, found `tones`"),
        ("import \"x\" as", "as: expected a name after `as`"),
        ("import \"{x}\"", "x: the path of an import cannot be computed (for a brace in a file's name write `\\{`)"),
        ("seed 4 5", "5: expected an operator or the next statement, found the number `5`"),
        ("paint a with", "with: expected a value after `with`"),
        ("paint a wiht b", "wiht: expected `with`, found `wiht` (did you mean `with`?)"),
        ("paint a with b seed 3 as \"x\"", "as \"x\": the name stands before the seed (write `as \"…\" seed …`)"),
        ("outline a pen", "pen: expected a value after `pen`"),
        ("outline", "outline: expected a value after `outline`"),
        ("ink", "ink: expected a value after `ink`"),
        ("for x of a { }", "of: expected `in`, found `of`"),
        ("canvas size: 3", "size: expected `{`, found `size`"),
        ("tone t = a { }", "{: expected `with`, found `{`"),
        ("fn f = 3", "=: expected `(`, found `=`"),
        ("fn f(a, 3) = a", "3: expected a name or `)`, found the number `3`"),
        ("if a then b else c", "then: expected `{`, found `then` (a statement `if` is written `if … { … }`)"),
        ("let a = if b then c", "c: expected `else` after `c`"),
        (
            "let a = if b { c } else d",
            "{: expected `then`, found `{` (inside an expression, `if` is written `if a then b else c`)",
        ),
        ("let a = f(b c)", "c: expected `,` or `)`, found `c`"),
        ("let a = f(b = 3)", "=: expected `,` or `)`, found `=` (an argument is named with a colon: `name: value`)"),
        ("let a = [1 2]", "2: expected `,` or `]`, found the number `2`"),
        ("let a = (1, )", ""),
        ("let a = ()", "): expected a value, found `)`"),
        ("let a = \"{b c}\"", "c: expected `}`, found `c`"),
        ("let a = m.", ".: expected a name after `.`"),
        ("canvas { size 3 }", "3: expected `:` after the property's name, found the number `3`"),
        (
            "canvas { size = 3 }",
            "=: expected `:` after the property's name, found `=` (a property is written `name: value`)",
        ),
        ("canvas { a: 1 2 }", "2: expected an operator or the next property, found the number `2`"),
        ("let if = 3", "if: expected a name, found `if` (`if` is a word of the language and cannot be a name)"),
        ("else { }", "else: expected a statement, found `else` (`else` follows the `}` of an `if { … }`)"),
        ("a = 3", "a: expected a statement, found `a` (a name is declared with `let name = …`)"),
        ("\"a\"", "\"a\": expected a statement, found a string"),
    ] {
        let expected = if expected.is_empty() { vec![] } else { vec![expected] };
        assert_eq!(mistakes(text), expected, "in {text}");
    }
}

#[test]
fn known_slips_have_hints() {
    for (text, hint) in [
        (
            "let a = 6 mm",
            "mm: expected an operator or the next statement, found `mm` (a unit touches its number: `6mm`)",
        ),
        (
            "let a = 10% 3",
            "3: expected an operator or the next statement, found the number `3` (`10%` is a share; to divide and keep \
             the rest, write ` % ` with spaces around it)",
        ),
        ("let a = .5", ".: expected a value, found `.` (digits stand on both sides of a point: `0.5`)"),
        ("let a = a = b", "=: expected an operator or the next statement, found `=` (equality is written `==`)"),
        ("let a = a && b", "&: expected a value, found `&` (conditions are joined with `and`)"),
        ("let a = !b", "!: expected a value, found `!` (a condition is turned round with `not`)"),
        (
            "let a = b;",
            ";: expected an operator or the next statement, found `;` (statements and properties end by themselves: \
             leave the `;` out)",
        ),
        ("paint with b", "b: expected `with`, found `b` (the region comes first: `paint canvas with …`)"),
        ("let a = match b { 1 -> 2 }", ">: expected a value, found `>` (an arm is written `pattern => value`)"),
        ("let a = 'b'", "': expected a value, found `'` (strings stand in double quotes)"),
        ("let a ＝ b", "＝: expected `:` or `=`, found `＝` (this is a full-width sign: write `=`)"),
    ] {
        assert_eq!(mistakes(text), [hint], "in {text}");
    }
}

#[test]
fn values_are_judged() {
    for (text, expected) in [
        ("6mmm", "mmm: unknown unit `mmm` (did you mean `mm`?)"),
        ("6MM", "MM: unknown unit `MM` (did you mean `mm`?)"),
        ("0x10", "x10: unknown unit `x10` (units are `mm cm in pt px`, `deg rad turn` and `%`)"),
        ("#12", "#12: a colour has 3, 4, 6 or 8 hexadecimal digits (write `#rgb`, `#rrggbb` or `#rrggbbaa`)"),
        ("#ggg", "#ggg: a colour has 3, 4, 6 or 8 hexadecimal digits (write `#rgb`, `#rrggbb` or `#rrggbbaa`)"),
        ("1e999", "1e999: this number is too large"),
        ("a < b <= c", "<=: comparisons do not chain (join two comparisons with `and`: `a < b and b < c`)"),
        ("1 .. 2 .. 3", "..: a range has two ends"),
        ("a[0](1)(2)", "(1): only a name can be called"),
        ("f(1).b", ".b: a member is written `module.name`"),
        (
            "\"\\q\"",
            "\\q: unknown escape `\\q` (the escapes are `\\\"`, `\\\\`, `\\n`, `\\t`, `\\{`, `\\}` and `\\u{3042}`)",
        ),
        (
            "\"\\u{d800}\"",
            "\\u{d800}: `\\u{d800}` is no character (between the braces stand one to six hexadecimal digits of a \
             Unicode scalar value)",
        ),
        ("match a { b => 1 }", "b: a pattern is a string, a number without sign or unit, `true`, `false` or `_`"),
        ("match a { 1mm => 1 }", "1mm: a pattern is a string, a number without sign or unit, `true`, `false` or `_`"),
    ] {
        let text = format!("let v = {text}\nlet w = 1");
        check(&text, 2, &[expected]);
    }
    let (_, diagnostics) = parse(source(), "let a = 3mmm");
    assert_eq!(diagnostics[0].code, Code::UnknownUnit);
}

#[test]
fn one_mistake_does_not_hide_the_next() {
    check(
        "let a =\nlet b = )\npaint canvas wth plain\nlet c = 3\nregion = x\nlet d = 4",
        2,
        &[
            "=: expected a value after `=`",
            "): `)` closes nothing (leave it out)",
            "wth: expected `with`, found `wth` (did you mean `with`?)",
            "=: expected a name, found `=`",
        ],
    );
    check(
        "let a =\npaint canvas with plain\nlet b = 3 +\ncanvas { size: 1 }\nlet c = -\nseed 3",
        3,
        &["=: expected a value after `=`", "+: expected a value after `+`", "-: expected a value after `-`"],
    );
}

#[test]
fn properties_are_read_one_by_one() {
    check(
        "tone a {\n  k 2\n  place: poisson(radius: 6mm)\n  shape:\n  fill: lines(pitch 3mm)\n  angle: bfs()\n}\nlet b = 1",
        2,
        &[
            "2: expected `:` after the property's name, found the number `2`",
            ":: expected a value after `:`",
            "3mm: expected `,` or `)`, found the number `3mm`",
        ],
    );
    let (document, _) = parse(source(), "tone a {\n  k 2\n  place: hex\n  shape:\n  angle: bfs()\n}");
    let StatementKind::Tone { body: crate::syntax::ast::ToneBody::Properties(properties), .. } =
        &document.statements[0].kind
    else {
        panic!("a tone")
    };
    assert_eq!(properties.iter().map(|property| property.name.name.as_str()).collect::<Vec<_>>(), ["place", "angle"]);
}

#[test]
fn blocks_are_read_statement_by_statement() {
    check(
        "layer \"a\" {\n  paint a wth b\n  for i in 0 .. {\n    outline a pn 1mm\n  }\n  if x { paint c } else { let d }\n}\npaint a with b",
        2,
        &[
            "wth: expected `with`, found `wth` (did you mean `with`?)",
            "{: expected a value, found `{`",
            "pn: expected `pen`, found `pn` (did you mean `pen`?)",
            "c: expected `with` after `c`",
            "d: expected `:` or `=` after `d`",
        ],
    );
    check(
        "layr \"a\" {\n  paint a wth b\n}\ntonne t { k 1 }\nfoo\nbar\npaint a with b",
        1,
        &[
            "layr: expected a statement, found `layr` (did you mean `layer`?)",
            "wth: expected `with`, found `wth` (did you mean `with`?)",
            "tonne: expected a statement, found `tonne` (did you mean `tone`?)",
            "1: expected `:` after the property's name, found the number `1`",
            "foo: expected a statement, found `foo` (did you mean `for`?)",
            "bar: expected a statement, found `bar`",
        ],
    );
}

#[test]
fn an_open_bracket_is_one_mistake() {
    check("let a = f(\n  b,\n  c\nlet d = 4", 1, &["let: unclosed `(`"]);
    check("tone a {\n  k: f((1, [2\n  angle: bfs()\n}\nlet d = 4", 2, &["angle: unclosed `[`"]);
    check("tone a {\n  k: 2\n\ntone b {\n  k: 3\n}\nlet d = 4", 3, &["tone: unclosed `{`"]);
    check("layer \"a\" {\n  paint a with b\n\nlayer \"b\" {\n  paint c with d\n}\n", 2, &["layer: unclosed `{`"]);
    check("layer \"a\" {\nlayer \"b\" {\npaint c with d\n}\n", 1, &[": unclosed `{`"]);
    check(
        "tone t {\n  place: hex(spacing: 3mm\n  k: 2\n  fill: lines(pitch: 1mm\n}\npaint canvas with t",
        2,
        &["k: unclosed `(`", "}: unclosed `(`"],
    );
    check(
        "tone t {\n  fill: lines(\n    pitch: 1mm\n    pen: 2mm\n  )\n}",
        1,
        &["pen: expected `,` or `)`, found `pen`"],
    );
    check("let a = [1, 2", 0, &[": unclosed `[`"]);
    check("let a = (1]\nlet b = 2", 1, &["]: expected `)`, found `]`"]);
    check("let a = f(1))\nlet b = 2", 1, &["): `)` closes nothing (leave it out)"]);
    check("}}\nlet b = 2", 1, &["}: `}` closes nothing (leave it out)"]);
    let (_, diagnostics) = parse(source(), "let a = f(\nlet b = 2");
    assert_eq!(diagnostics[0].notes.iter().map(|(span, _)| span.start).collect::<Vec<_>>(), [9]);
}

#[test]
fn an_open_string_ends_with_its_line() {
    let hint = "(a string ends with `\"` on the line where it begins; `\\n` stands for a line end)";
    let inside = "(a string ends with `\"` on the line where it begins, and `{` opens a value inside it: for the brace \
                  itself write `\\{`)";
    check("paint svg(\"abc) with x\nlet b = 2", 1, &[&format!("\": unclosed string {hint}")]);
    check("let a = \"abc {b\nlet c = \"{d}\"", 1, &[&format!("\": unclosed string {inside}")]);
    check("let a = \"abc {b} \\\"\nlet c = 1", 1, &[&format!("\": unclosed string {inside}")]);
    check("let a = 1 /* b\nlet c = 2", 1, &["/*: unclosed comment (close it with `*/`)"]);
}

#[test]
fn a_hopeless_text_is_given_up() {
    let lines = mistakes(&"let 3\n".repeat(5_000));
    assert_eq!(lines.len(), MOST_ERRORS + 1);
    assert_eq!(lines[MOST_ERRORS], "let: there are 100 mistakes or more: from here on the text was not read");
}
