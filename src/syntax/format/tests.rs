//! Laws of the canonical form, and cases that show it.
#![allow(clippy::unwrap_used)]

use proptest::prelude::*;

use super::{expression, format, shape};
use crate::syntax::arbitrary::{self, Sample};
use crate::syntax::ast::Document;
use crate::syntax::kake::{parse, parse_expression};

fn read(text: &str) -> Document {
    let (document, diagnostics) = parse(arbitrary::source(), text);
    assert!(diagnostics.is_empty(), "{diagnostics:#?}\nin:\n{text}");
    document
}

/// Formats a text and holds the laws: it says the same, keeps its comments and is formatted already.
fn tidy(text: &str) -> String {
    let document = read(text);
    let out = format(&document, text);
    let again = read(&out);
    assert_eq!(shape(&document), shape(&again), "from:\n{text}\nto:\n{out}");
    let words = |document: &Document| {
        let mut words: Vec<String> = document
            .comments
            .iter()
            .map(|comment| comment.text.trim_start_matches('/').split_whitespace().collect::<Vec<_>>().join(" "))
            .collect();
        words.sort();
        words
    };
    assert_eq!(words(&document), words(&again), "from:\n{text}\nto:\n{out}");
    assert_eq!(format(&again, &out), out, "from:\n{text}");
    out
}

#[track_caller]
fn check(text: &str, wanted: &str) {
    assert_eq!(tidy(text), wanted);
}

const SCENE: &str = r##"// A scene with a bit of everything.
edition 1

import "manga.kake"
import "hand.kake" as hand

canvas { size: (60mm, 60mm), dpi: 600 }
seed 42

/// Width of every stroke
param pen: length = 0.2mm in 0.1mm .. 0.6mm
param mode = "grid" in ["grid", "hex"] // how sites lie

let gap = -(1 + 2) ^ 2 * 50%
let disk = if pen > 0.3mm and not false then 1 else if mode == "grid" then 2 else 3
field shade = linear(from: (0mm, 0mm), to: (9mm, 9mm), start: 1, end: 4)
region body = rect(at: (0, 0), size: (9, 9)) - circle(center: (1, 1), radius: 1) & canvas

fn square(a, b: number = 2) = a * a % b

/// A tone.
tone plate(k: field = 1, tile: length) {
  /// Where.
  place: match mode {
    "grid" => grid(spacing: tile) // rows
    _ => hex(spacing: tile)
  }
  fill: [lines(pitch: 1mm), dots(pitch: 2mm)]
  hand: hand({ angle: 3deg, spacing: 12% })
}

tone dense = hand.plate(k: 3) with {
  blend: dither
}

layer "back" ink #336699 {
  paint body with plate(tile: 3mm) as "sheet {1 + 1}" seed 7
  outline body pen 0.3mm
}

for i in 0 .. 2 {
  // nothing at odd ones
  if i % 2 == 0 {
    paint canvas with dense
  } else if i == 1 {
  } else {
    outline canvas pen [0.1mm, 0.2mm][i]
  }
}

experiment pairs {
  seeds: 0 .. 9
  factors: { mode: ["grid", "hex"] }
}
"##;

#[test]
fn a_tidy_scene_stays_as_it_is() {
    let (document, _) = parse(arbitrary::source(), SCENE);
    assert_eq!(format(&document, SCENE), tidy(SCENE));
    check(&tidy(SCENE), &tidy(SCENE));
    let empty_block = SCENE.replace("i == 1 {\n  }", "i == 1 {}");
    check(&empty_block, &empty_block);
}

#[test]
fn white_space_is_made_canonical() {
    check(
        "\u{feff}edition   1\r\n\r\n\r\n\r\ncanvas{size:(60mm,60mm) dpi:600}seed 42 tone a{k:1,place:hex(spacing:5mm,)}",
        "edition 1\n\ncanvas { size: (60mm, 60mm), dpi: 600 }\nseed 42\ntone a {\n  k: 1\n  place: hex(spacing: 5mm)\n}\n",
    );
    check("", "");
    check("\n\n// only this  \n\n", "// only this\n");
    check("canvas {\n\n  dpi: 600\n\n\n  ink: black }", "canvas {\n  dpi: 600\n\n  ink: black\n}\n");
}

#[test]
fn long_lines_break_at_the_outermost_brackets() {
    let name = "n".repeat(40);
    check(
        &format!("let a = f({name}(1, 2), [{name}, 3], (4, 5))"),
        &format!("let a = f(\n  {name}(1, 2),\n  [{name}, 3],\n  (4, 5),\n)\n"),
    );
    check(
        &format!("let a = polygon([({name}, 1), ({name}, 2), (3, 4)])"),
        &format!("let a = polygon([\n  ({name}, 1),\n  ({name}, 2),\n  (3, 4),\n])\n"),
    );
    check(
        &format!("paint {name} with {name} as \"{name}\" seed 3"),
        &format!("paint {name}\n  with {name}\n  as \"{name}\"\n  seed 3\n"),
    );
    check(&format!("let a = {name} + {name} - {name} * 2"), &format!("let a = {name}\n  + {name}\n  - {name} * 2\n"));
    check(
        &format!("let a = if {name} then {name} else {name}"),
        &format!("let a = if {name} then {name}\n  else {name}\n"),
    );
    check(
        &format!("fn f(a: length = {name}, b: length = {name}, c) = 1"),
        &format!("fn f(\n  a: length = {name},\n  b: length = {name},\n  c,\n) = 1\n"),
    );
}

#[test]
fn a_trailing_comma_over_several_lines_keeps_a_list_broken() {
    check("let a = [\n1, 2,\n]", "let a = [\n  1,\n  2,\n]\n");
    check("let a = [\n1, 2]", "let a = [1, 2]\n");
    check("let a = [1, 2,]", "let a = [1, 2]\n");
    check("let a = f(1,\n/* , */ 2)", "let a = f(1, /* , */ 2)\n");
    check("let a = match b {\n1 => 2, _ => 3 }", "let a = match b {\n  1 => 2\n  _ => 3\n}\n");
    check("let a = match b { 1 => 2\n _ => 3 }", "let a = match b { 1 => 2, _ => 3 }\n");
}

#[test]
fn comments_stay_by_what_they_stand_by() {
    check("let a = [1, // one\n 2]// all\nlet b = 1", "let a = [\n  1, // one\n  2,\n] // all\nlet b = 1\n");
    check("let a = 1 + // why\n 2", "// why\nlet a = 1 + 2\n");
    check("let a = (1 /* x */, /* y */ 2 /* z */)", "let a = (1, /* x */ /* y */ 2 /* z */)\n");
    check("let /* a */ b /* c */ = /* d */ 1 /* e */", "let /* a */ b = /* c */ /* d */ 1 /* e */\n");
    check("layer \"a\" { // in\n}", "layer \"a\" {\n  // in\n}\n");
    check("if a { // in\n paint b with c // of b\n // end\n } // then\n else { }", {
        "if a {\n  // in\n  paint b with c // of b\n  // end\n} else {\n  // then\n}\n"
    });
    check(
        "paint a // where\n with b // how\n as \"c\" // who",
        "paint a // where\n  with b // how\n  as \"c\" // who\n",
    );
    check("tone a(k /* n */, // first\n l) {}", "tone a(\n  k, /* n */ // first\n  l,\n) {}\n");
    check("f".replace('f', "let a = f(/* none */)").as_str(), "let a = f( /* none */ )\n");
    check("/* two\n   lines  \n*/ let a = 1", "/* two\n   lines\n*/\nlet a = 1\n");
}

#[test]
fn doc_comments_stay_above_and_stray_ones_document_nothing() {
    check("///   a\n///\n/// b  \nlet a = { /// c\n d: 1 }", "///   a\n///\n/// b\nlet a = {\n  /// c\n  d: 1,\n}\n");
    check("tone a(/// k\nk) {}", "tone a(\n  /// k\n  k,\n) {}\n");
    check("let a = 1 + /// stray\n 2\n/// last", "// stray\nlet a = 1 + 2\n// last\n");
}

#[test]
fn strings_are_escaped_where_they_must_be() {
    check(r#"let a = "\u{41}\u{0}\t\n \"\\ \{x\} {b}""#, "let a = \"A\\u{0}\\t\\n \\\"\\\\ \\{x\\} {b}\"\n");
}

#[test]
fn expressions_stand_on_one_line() {
    for text in ["f(a: 1, b: [2, { c: 3 }])", "match a { 1 => 2, _ => 3 }", "-a ^ 2 + not b .. (c)", "{}", "f()"] {
        let (expr, _) = parse_expression(arbitrary::source(), text, &|offset| offset);
        assert_eq!(expression(&expr), text);
    }
}

/// Where a comment may be put into a text: at white space outside of strings and comments.
fn seams(text: &str) -> Vec<usize> {
    let mut seams = Vec::new();
    let mut in_string = false;
    let mut in_comment = false;
    for (at, letter) in text.char_indices() {
        match letter {
            '"' if !in_comment => in_string = !in_string,
            '/' if !in_string && text[at..].starts_with("//") => in_comment = true,
            '\n' => {
                // Behind a comment, on the next line.
                seams.push(at + usize::from(in_comment));
                in_comment = false;
            }
            ' ' if !in_string && !in_comment => seams.push(at),
            _ => {}
        }
    }
    seams
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 128, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_documents_read_back_as_they_were(Sample(document) in arbitrary::document()) {
        let text = format(&document, "");
        let (again, diagnostics) = parse(arbitrary::source(), &text);
        let first = diagnostics.first().and_then(|diagnostic| Some((diagnostic.span?, &diagnostic.message)));
        let first = first.map(|(span, message)| (message, &text[span.start as usize..]));
        prop_assert!(diagnostics.is_empty(), "{:?} in:\n{}", first, text);
        prop_assert_eq!(shape(&document), shape(&again), "{}", &text);
        prop_assert_eq!(format(&again, &text), &text[..]);
    }

    #[test]
    fn comments_are_kept_wherever_they_stand(
        places in proptest::collection::vec((any::<prop::sample::Index>(), 0..5usize), 1..8),
    ) {
        let seams = seams(SCENE);
        let mut places: Vec<(usize, usize)> = places.iter().map(|(at, kind)| (*at.get(&seams), *kind)).collect();
        places.sort_unstable();
        let mut text = SCENE.to_owned();
        for (i, (at, kind)) in places.into_iter().enumerate().rev() {
            let comment = match kind {
                0 => format!(" /* c{i} */"),
                1 => format!(" // c{i}\n"),
                2 => format!("\n\n// c{i}\n\n"),
                3 => format!(" /* c{i}\n  d */"),
                _ => format!("/* c{i} */\n"),
            };
            text.insert_str(at, &comment);
        }
        tidy(&text);
    }
}
