//! Texts without mistakes.

use super::*;
use crate::syntax::ast::ToneBody;

#[test]
fn operators_bind_as_the_grammar_says() {
    for (text, tree) in [
        ("a + b * c", "<a + <b * c>>"),
        ("a * b + c", "<<a * b> + c>"),
        ("a - b + c - d", "<a - b + c - d>"),
        ("a / b % c * d & e", "<a / b % c * d & e>"),
        ("a + b & c", "<a + <b & c>>"),
        ("-a ^ 2", "<-<a ^ 2>>"),
        ("2 ^ -1", "<2 ^ <-1>>"),
        ("2 ^ -3 ^ -4", "<2 ^ <-<3 ^ <-4>>>>"),
        ("a ^ b ^ c", "<a ^ b ^ c>"),
        ("-a * b", "<<-a> * b>"),
        ("a * -b", "<a * <-b>>"),
        ("- - a", "<--a>"),
        ("not a and b", "<<not a> and b>"),
        ("not not a", "<not not a>"),
        ("a or b and c or d", "<a or <b and c> or d>"),
        ("a < b and c >= d", "<<a < b> and <c >= d>>"),
        ("a + 1 == b", "<<a + 1> == b>"),
        ("a != b", "<a != b>"),
        ("a .. b + 1", "<a .. <b + 1>>"),
        ("a or b .. c", "<<a or b> .. c>"),
        ("(a + b) * c", "<group(<a + b>) * c>"),
        ("m.f(1)[2]", "m.f(1)[2]"),
        ("-f(1)[2] ^ 2", "<-<f(1)[2] ^ 2>>"),
    ] {
        assert_eq!(show(&value(text)), tree, "in {text}");
    }
}

#[test]
fn values_are_read() {
    for (text, tree) in [
        ("12", "12"),
        ("1.50", "1.50"),
        ("1e-3mm", "1e-3mm"),
        ("2E+2", "2E+2"),
        ("6mm + 7cm + 1in + 2pt + 3px", "<6mm + 7cm + 1in + 2pt + 3px>"),
        ("1deg + 2rad + 3turn", "<1deg + 2rad + 3turn>"),
        ("50%", "50%"),
        ("10 % 3", "<10 % 3>"),
        ("10%3", "<10 % 3>"),
        ("10%x", "<10 % x>"),
        ("(10%)", "group(10%)"),
        ("x%3", "<x % 3>"),
        ("0..2", "<0 .. 2>"),
        ("0.5..1.5", "<0.5 .. 1.5>"),
        ("#abc", "#abc"),
        ("#ABCDEF01", "#ABCDEF01"),
        ("true", "true"),
        ("trueish", "trueish"),
        ("(1, 2)", "tuple(1, 2)"),
        ("(1, 2, 3, 4,)", "tuple(1, 2, 3, 4)"),
        ("[]", "[]"),
        ("[1, 2,]", "[1, 2]"),
        ("{}", "{}"),
        ("{ a: 1 b: 2, if: 3 }", "{a: 1, b: 2, if: 3}"),
        ("f()", "f()"),
        ("f(a, b: 2, match: 3,)", "f(a, b: 2, match: 3)"),
        ("\"\"", "''"),
        ("\"a{b}c\"", "'a{b}c'"),
        ("\"a{ f(\"x{y}\", {z: 1}) } \"", "'a{f('x{y}', {z: 1})} '"),
        (r#""\"\\\n\t\{\}\u{41}}""#, "'\"\\\n\t{}A}'"),
        ("\"// no comment /*\"", "'// no comment /*'"),
        ("if a then b else c", "<if a then b else c>"),
        ("if a then b else if c then d else e + 1", "<if a then b else if c then d else <e + 1>>"),
        ("if a then if b then c else d else e", "<if a then <if b then c else d> else e>"),
        ("1 + if a then b else c", "<1 + <if a then b else c>>"),
        ("match m { \"a\" => 1, 2 => 3 true => 4 _ => 5 }", "match m {'a' => 1, 2 => 3, true => 4, _ => 5}"),
        ("region + canvas - let * seed", "<region + canvas - <let * seed>>"),
        ("tone.with + pen", "<tone.with + pen>"),
        ("幅 * ñandú_2", "<幅 * ñandú_2>"),
    ] {
        assert_eq!(show(&value(text)), tree, "in {text}");
    }
}

#[test]
fn units_end_at_a_word_boundary() {
    let document = read("param kake: number = 1 in 1 .. 4");
    let StatementKind::Param { binding, domain } = &document.statements[0].kind else { panic!("a param") };
    assert_eq!((show(&binding.value), domain.as_ref().map(show)), ("1".to_owned(), Some("<1 .. 4>".to_owned())));
    assert_eq!(binding.ty.as_ref().unwrap().name, "number");
}

#[test]
fn a_scene_with_everything_is_read() {
    let document = read(SCENE);
    let kinds: Vec<String> = document
        .statements
        .iter()
        .map(|statement| format!("{:?}", statement.kind).split(['(', ' ']).next().unwrap().to_owned())
        .collect();
    let expected =
        "Edition Import Import Canvas Seed Param Param Let Let Let Region Field Fn Tone Tone Layer If Experiment";
    assert_eq!(kinds.join(" "), expected);
    let comments: Vec<&str> = document.comments.iter().map(|comment| comment.text.as_str()).collect();
    assert_eq!(comments, ["// A scene that uses all of the language.", "/* the default */"]);
}

#[test]
fn statements_know_where_they_stand() {
    let document = read(SCENE);
    let texts: Vec<&str> = document
        .statements
        .iter()
        .map(|statement| &SCENE[statement.span.start as usize..statement.span.end as usize])
        .collect();
    assert_eq!(texts[0], "edition 1");
    assert_eq!(texts[2], "import \"hand.kake\" as hand");
    assert_eq!(texts[4], "seed 7");
    assert!(texts[13].starts_with("tone plain(\n") && texts[13].ends_with("  k: k\n}"));
    assert!(texts[15].starts_with("layer") && texts[15].ends_with("pen 0.3mm }\n}"));
    assert!(texts[16].starts_with("if mode") && texts[16].ends_with("ink svg(\"figure.svg\", layer: \"hair\")\n}"));
}

#[test]
fn doc_comments_document_what_stands_below() {
    let text = "/// Nothing stands below this.\n// plain\n/// One\n///   two\r\ntone t(\n  /// A\n  a, b) {\n  /// K\n  k: 1\n}\n//// no doc\nlet x = [\n  /// lost\n  1]\n/// last";
    let document = read(text);
    let tone = &document.statements[0];
    let doc = tone.doc.as_ref().unwrap();
    assert_eq!(doc.text, "One\n  two");
    assert_eq!(&text[doc.span.start as usize..doc.span.end as usize], "/// One\n///   two");
    let StatementKind::Tone { params, body: ToneBody::Properties(properties), .. } = &tone.kind else {
        panic!("a tone")
    };
    assert_eq!(params[0].doc.as_ref().unwrap().text, "A");
    assert!(params[1].doc.is_none() && document.statements[1].doc.is_none());
    assert_eq!(properties[0].doc.as_ref().unwrap().text, "K");
    let comments: Vec<&str> = document.comments.iter().map(|comment| comment.text.as_str()).collect();
    assert_eq!(comments, ["/// Nothing stands below this.", "// plain", "//// no doc", "/// lost", "/// last"]);
}

#[test]
fn line_ends_and_commas_mean_nothing() {
    let spread = read("paint\n  a\n  with\n  b\n  as\n  \"c\"\n  seed\n  3\nlet x = 1 let y = x let z = y seed 4");
    assert_eq!(spread.statements.len(), 5);
    let tone = read("tone t { a: 1 b: if x then y else z c: match m { 1 => 2 3 => 4 } d: seed e: f\n (g), h: 1, }");
    let StatementKind::Tone { body: ToneBody::Properties(properties), .. } = &tone.statements[0].kind else {
        panic!("a tone")
    };
    let names: Vec<&str> = properties.iter().map(|property| property.name.name.as_str()).collect();
    assert_eq!(names, ["a", "b", "c", "d", "e", "h"]);
}

#[test]
fn keywords_are_words_elsewhere() {
    for text in [
        "let seed = 3\nlet a = seed\nlet b =\n  region\n  + canvas\n",
        "paint region with field as tone seed seed\noutline paint pen pen\nlayer layer ink ink { }",
        "ink ink\nlet ink = ink\noutline ink\nink f(ink: ink)\nlayer \"a\" ink ink { ink ink }",
        "for for in in { }\nlet if_ = if seed == let then param else import",
        "paint seed with with seed seed seed 4",
        "param a = in in in",
        "let a =\n  canvas\nregion b = a",
        "if x ==\n  canvas { paint a with b }",
        "tone tone(tone: tone = tone) = tone.tone(tone: tone) with { tone: tone }",
        "canvas { seed: 1 let: 2 if: 3\n else: 4\n then: 5 }",
        "tone t {\n  domain:\n  region\n  angle: bfs()\n  a:\n  paint\n  b: 3\n}",
        "fn fn(a) = a\nlet x = fn(match: { })",
    ] {
        let (_, diagnostics) = parse(source(), text);
        assert_eq!(diagnostics, [], "in {text}");
    }
}

#[test]
fn names_are_normalised() {
    let document = read("let cafe\u{301} = 1");
    let StatementKind::Let(binding) = &document.statements[0].kind else { panic!("a let") };
    assert_eq!(binding.name.name, "caf\u{e9}");
    assert_eq!((binding.name.span.start, binding.name.span.end), (4, 10));
    assert!(is_identifier("caf\u{e9}") && !is_identifier("cafe\u{301}"));
    assert!(is_identifier("_a") && is_identifier("seed") && is_identifier("網"));
    for other in ["", "_", "1a", "a-b", "a b", "if", "true", "-"] {
        assert!(!is_identifier(other), "{other}");
    }
}

#[test]
fn an_empty_file_is_an_empty_document() {
    for text in ["", " \n", "// only a comment", "\u{feff}", "/* a */ /* b */"] {
        assert!(read(text).statements.is_empty());
    }
    assert_eq!(read("\u{feff}edition 1").statements[0].span.start, 3);
}

#[test]
fn spans_of_a_value_go_through_its_place() {
    // As in a TOML string whose first two characters are written as escapes of six bytes.
    let place = |offset: usize| if offset < 2 { 100 + 6 * offset } else { 110 + offset };
    let (value, diagnostics) = parse_expression(source(), "ab + cd", &place);
    assert!(diagnostics.is_empty());
    assert_eq!((value.span.start, value.span.end), (100, 117));
    let (value, diagnostics) = parse_expression(source(), "ab + )", &place);
    assert!(matches!(value.kind, ExprKind::Error));
    assert_eq!(diagnostics.len(), 1);
    assert_eq!(diagnostics[0].span.map(|span| (span.start, span.end)), Some((115, 116)));
}

#[test]
fn parameters_are_read() {
    let (parameters, diagnostics) = parse_parameters(source(), "a: length = 1mm, /// B\n b,", &|offset| offset);
    assert!(diagnostics.is_empty());
    assert_eq!(parameters.len(), 2);
    assert_eq!(parameters[0].default.as_ref().map(show), Some("1mm".to_owned()));
    assert!(parse_parameters(source(), " ", &|offset| offset).0.is_empty());
    let (_, diagnostics) = parse_parameters(source(), "a b", &|offset| offset);
    assert_eq!(diagnostics.len(), 1);
}

#[test]
fn bytes_are_decoded() {
    assert_eq!(decode_utf8("あ".as_bytes()), Ok("あ"));
    assert_eq!(decode_utf8(b"\xef\xbb\xbfedition 1"), Ok("edition 1"));
    assert_eq!(decode_utf8(b"ab\xff"), Err(2));
    assert_eq!(decode_utf8(b"\xef\xbb\xbfab\xc3"), Err(5));
}
