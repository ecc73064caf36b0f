//! Round trips, and cases that show the form and its mistakes.
#![allow(clippy::unwrap_used, clippy::panic)]

use proptest::prelude::*;

use super::read::SECTIONS;
use super::write::section;
use super::{read, write};
use crate::diag::{Code, Diagnostic};
use crate::syntax::arbitrary::{self, Sample};
use crate::syntax::ast::{Document, ExprKind, StatementKind};
use crate::syntax::format::{format, shape};
use crate::syntax::kake::parse;

/// Statements in the order in which the reader of TOML gives them.
fn grouped(document: &Document) -> Document {
    let mut document = document.clone();
    let place = |kind: &StatementKind| SECTIONS.iter().position(|name| *name == section(kind));
    document.statements.sort_by_key(|statement| place(&statement.kind));
    document
}

fn good(text: &str) -> Document {
    let (document, diagnostics) = read(arbitrary::source(), text);
    assert!(diagnostics.is_empty(), "{diagnostics:#?}\nin:\n{text}");
    document
}

/// The scene that a TOML text says, as the language writes it.
fn as_kake(text: &str) -> String {
    format(&good(text), "")
}

/// The diagnostics of a text: code, what the span covers, message and hint.
fn mistakes(text: &str) -> Vec<(Code, String, String, String)> {
    let show = |diagnostic: Diagnostic| {
        let span = diagnostic.span.unwrap();
        let under = text[span.start as usize..span.end as usize].to_owned();
        (diagnostic.code, under, diagnostic.message, diagnostic.hint.unwrap_or_default())
    };
    read(arbitrary::source(), text).1.into_iter().map(show).collect()
}

#[track_caller]
fn mistake(text: &str, code: Code, under: &str) {
    let found = mistakes(text);
    let short: Vec<_> = found.iter().map(|(code, under, ..)| (*code, under.as_str())).collect();
    assert_eq!(short, [(code, under)], "{found:#?}");
}

const EXAMPLE: &str = include_str!("mod.rs");

/// The example in the module's documentation.
fn example() -> String {
    let lines = EXAMPLE.lines().map(|line| line.strip_prefix("//!").unwrap_or(line));
    let code = lines.skip_while(|line| *line != " ```toml").skip(1).take_while(|line| *line != " ```");
    code.map(|line| format!("{}\n", line.strip_prefix(' ').unwrap_or(line))).collect()
}

#[test]
fn the_documented_form_is_read() {
    let wanted = r#"edition 1

import "manga.kake" as manga

canvas { size: (60mm, 60mm) }
seed 42

/// Width of every stroke
param pen: length = 0.2mm in 0.1mm .. 0.6mm

let gap = 0.3mm
/// From one row to the next
let step: length = gap * 2

fn square(a) = a * a

tone plain(k: field = 1, tile: length = 6mm) {
  place: poisson(radius: tile)
  k: k
}

tone dense = plain(k: 3) with {
  blend: dither
}

paint canvas with plain(k: 2) as "sheet {1 + 1}" seed 7
outline canvas pen 0.3mm

layer "front" ink #333333 {
  paint canvas with plain
}

for i in 0 .. 4 {
  if i < 2 {
    paint canvas with plain
  } else if i < 3 {} else {
    paint canvas with dense
  }
}

experiment factorial {
  seeds: 0 .. 99
  factors: { mode: ["grid", "hex"] }
}
"#;
    assert_eq!(as_kake(&example()), wanted);
}

#[test]
fn a_scene_is_written_as_a_person_would() {
    let scene = r##"edition 1
import "manga.kake" as manga
canvas { size: (60mm, 60mm), dpi: 600, paper: #fffef8, repeat: true }
seed 42
/// Width of every stroke
param mode: string = "a" in ["a", "b"]
let gap = 0.3mm
/// How far.
let step: length = -2
/// Two
/// lines.
tone plain(k: field = 1, /// The side.
  tile: length = 6mm) {
  place: poisson(radius: tile)
  /// Why.
  k: k
}
tone dense = manga.plain(k: 3) with { fill: [lines(pitch: 1mm), dots(pitch: 2mm)] }
for i in 0 .. 2 {
  let w = i * 2
  if i == 1 { paint canvas with plain as "p {i}" seed 3 } else if i == 2 {} else { outline canvas pen 1 }
}
experiment e { seeds: 0 .. 9, factors: { mode: ["a", "b"] }, images: { kake: [1, 2] } }
"##;
    let wanted = r##"edition = 1
seed = 42

[[import]]
import = "manga.kake"
as = "manga"

[canvas]
size = "(60mm, 60mm)"
dpi = 600
paper = "#fffef8"
repeat = true

[param.mode]
type = "string"
default = '"a"'
in = '["a", "b"]'
doc = "Width of every stroke"

[let]
gap = "0.3mm"
step = { type = "length", value = -2, doc = "How far." }

[tone.plain]
doc = """
Two
lines.
"""
params = [
  "k: field = 1",
  { name = "tile", type = "length", default = "6mm", doc = "The side." },
]
place = "poisson(radius: tile)"
k = { value = "k", doc = "Why." }

[tone.dense]
from = "manga.plain(k: 3)"
fill = "[lines(pitch: 1mm), dots(pitch: 2mm)]"

[[draw]]
for = "i"
in = "0 .. 2"

[[draw.draw]]
let.w = "i * 2"

[[draw.draw]]
if = "i == 1"

[[draw.draw.draw]]
paint = "canvas"
with = "plain"
as = "p {i}"
seed = 3

[[draw.draw.else-if]]
if = "i == 2"
draw = []

[[draw.draw.else]]
outline = "canvas"
pen = 1

[experiment.e]
seeds = "0 .. 9"
factors = { mode = '["a", "b"]' }
images = { kake = [1, 2] }
"##;
    let (document, diagnostics) = parse(arbitrary::source(), scene);
    assert!(diagnostics.is_empty(), "{diagnostics:#?}");
    let text = write(&document);
    assert_eq!(text, wanted);
    assert_eq!(shape(&good(&text)), shape(&document));
}

#[test]
fn parameters_keep_their_order_in_every_form() {
    let wanted = "tone t(\n  z: field = 1,\n  /// D\n  b: length = 2mm,\n  a,\n) {}\n";
    for params in [
        "params = ['z: field = 1', { name = 'b', type = 'length', default = '2mm', doc = 'D' }, 'a']\n",
        "[tone.t.params]\nz = { type = 'field', default = 1 }\nb = { doc = 'D', type = 'length', default = '2mm' }\na = {}\n",
        "params.z = { type = 'field', default = 1 }\nparams.b = { doc = 'D', type = 'length', default = '2mm' }\nparams.a = {}\n",
    ] {
        assert_eq!(as_kake(&format!("[tone.t]\n{params}")), wanted);
    }
}

#[test]
fn values_stand_for_themselves() {
    let text = "[let]\na = [1, -2.50, 1_000, 0x10, +3e2, true]\nb = { c = '1mm', d = [{ e = 'f' }] }\nc = { value = { value = 1 } }\n";
    assert_eq!(
        as_kake(text),
        "let a = [1, -2.50, 1000, 16, 3e2, true]\nlet b = { c: 1mm, d: [{ e: f }] }\nlet c = { value: 1 }\n"
    );
}

#[test]
fn spans_lead_to_the_place_within_a_string() {
    let text = "[let]\nabc = \"\"\"\n  \\\"é\\u00e9\\\" + \\\n   (dé)\"\"\"\n";
    let document = good(text);
    let StatementKind::Let(binding) = &document.statements[0].kind else { panic!("no let") };
    let at = |span: crate::span::Span| &text[span.start as usize..span.end as usize];
    assert_eq!(at(binding.name.span), "abc");
    let ExprKind::Binary(first, rest) = &binding.value.kind else { panic!("no sum") };
    assert_eq!(at(first.span), r#"\"é\u00e9\""#);
    assert_eq!(at(rest[0].1.span), "(dé)");
    assert!(at(document.statements[0].span).starts_with("abc = "));
}

#[test]
fn mistakes_are_shown_where_they_were_made() {
    mistake("edition = 1\npaints = 2", Code::UnknownProperty, "paints");
    mistake("[param.a]\ndefualt = 1\ndefault = 2", Code::UnknownProperty, "defualt");
    mistake("[param.a]\ndoc = 3\ndefault = 2", Code::Type, "3");
    mistake("[param.a]\ntype = 'length'", Code::Missing, "[param.a]");
    mistake("canvas = 3", Code::Toml, "canvas");
    mistake("tone.a = 3", Code::Toml, "a");
    mistake("[draw]\npaint = 'a'", Code::Toml, "draw");
    mistake("draw = [1]", Code::Toml, "1");
    mistake("[[draw]]\npaint = 'a'", Code::Missing, "paint = 'a'");
    mistake("[[draw]]\npaint = 'a'\nwith = 'b'\nlayer = 'c'", Code::UnknownProperty, "layer");
    mistake("[[draw]]\npiant = 'a'", Code::UnknownProperty, "piant");
    mistake("[[draw]]\n", Code::Missing, "[[draw]]");
    mistake("[let]\na = 1979-05-27", Code::Type, "1979-05-27");
    mistake("[let]\na = -inf", Code::Range, "-inf");
    mistake("[let]\n'a b' = 1", Code::Syntax, "'a b'");
    mistake("[let]\nif = 1", Code::Syntax, "if");
    mistake("[canvas]\n'a b' = 1", Code::Syntax, "'a b'");
    mistake("[[draw]]\nfor = 'a b'\nin = 'c'\ndraw = []", Code::Syntax, "a b");
    mistake("[[draw]]\npaint = 'a'\nwith = 'b'\nas = 'c {d'", Code::Syntax, "{d");
    mistake("[let]\na = 1\na = 2", Code::Duplicate, "a");
    assert_eq!(mistakes("[param.a]\ndefualt = 1\ndefault = 2")[0].3, "did you mean `default`?");
}

#[test]
fn several_mistakes_are_reported_at_once() {
    let text = "seed = \n[let]\na = '1 +'\nb = [1, 2\n[tone.t]\nk = canvas\n[param.p]\nfoo = 1\ndefault = { a = [\n[fn.f]\nvlue = 1\n";
    let found: Vec<(Code, String)> = mistakes(text).into_iter().map(|(code, under, ..)| (code, under)).collect();
    let wanted = [
        (Code::Syntax, ""),
        (Code::Syntax, "+"),
        (Code::Syntax, "["),
        (Code::Syntax, "canvas"),
        (Code::UnknownProperty, "foo"),
        (Code::Syntax, "{"),
        (Code::UnknownProperty, "vlue"),
    ];
    assert_eq!(found, wanted.map(|(code, under)| (code, under.to_owned())));
}

#[test]
fn nesting_is_bounded() {
    for text in [
        format!("a = {}", "[".repeat(100_000)),
        format!("a = {}", "{a=".repeat(100_000)),
        format!("[{}]", vec!["a"; 100_000].join(".")),
        format!("[let]\na = {}1{}", "[".repeat(200), "]".repeat(200)),
        format!("[let]\na = '{}1{}'", "(".repeat(100_000), ")".repeat(100_000)),
        format!("[let]\na = {}'{}1{}'{}", "[".repeat(100), "[".repeat(100), "]".repeat(100), "]".repeat(100)),
        (1..200).map(|depth| format!("[[{}]]\nlayer = '1'\n", vec!["draw"; depth].join("."))).collect(),
    ] {
        let (_, diagnostics) = read(arbitrary::source(), &text);
        assert!(diagnostics.iter().any(|diagnostic| diagnostic.code == Code::Nesting), "{:.60}", text);
    }
}

#[test]
fn spans_hold_whole_characters() {
    let text = "[tone.a]\n=\"\\é[";
    let (_, diagnostics) = read(arbitrary::source(), text);
    assert!(!diagnostics.is_empty());
    for span in diagnostics.iter().filter_map(|diagnostic| diagnostic.span) {
        assert!(text.get(span.start as usize..span.end as usize).is_some(), "{span:?}");
    }
}

#[test]
fn a_scene_may_be_nested_as_deeply_as_in_the_language() {
    let text = format!("[let]\na = {}1{}\n", "[".repeat(128), "]".repeat(128));
    assert_eq!(shape(&good(&write(&good(&text)))), shape(&good(&text)));
    let (document, diagnostics) = parse(arbitrary::source(), &as_kake(&text));
    assert!(diagnostics.is_empty(), "{diagnostics:#?}");
    assert_eq!(shape(&good(&text)), shape(&document));
    let scene = format!("{}paint a with b{}", "if a {} else if b { ".repeat(100), "}".repeat(100));
    let (document, diagnostics) = parse(arbitrary::source(), &scene);
    assert!(diagnostics.is_empty(), "{diagnostics:#?}");
    assert_eq!(shape(&good(&write(&document))), shape(&document));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 128, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_documents_come_back_from_toml(Sample(document) in arbitrary::document()) {
        let text = write(&document);
        let (again, diagnostics) = read(arbitrary::source(), &text);
        prop_assert!(diagnostics.is_empty(), "{:#?}\nin:\n{}", diagnostics, text);
        prop_assert_eq!(shape(&grouped(&document)), shape(&again), "{}", &text);
    }

    #[test]
    fn no_text_is_met_by_a_panic(
        pieces in proptest::collection::vec(prop::sample::select(vec![
            "[", "]", "{", "}", "[[draw]]\n", "[tone.a]\n", "a", "=", "paint", "draw", ".", "'", "\"", "\"\"\"", "\\",
            "\n", " ", "1", "1979-05-27", "'x +'", "let", "é", "params", "as = '{'", "[[draw.draw]]\n", "\r", ",", "#",
        ]), 0..30),
    ) {
        let text = pieces.concat();
        let (document, diagnostics) = read(arbitrary::source(), &text);
        for diagnostic in diagnostics {
            let span = diagnostic.span.unwrap();
            prop_assert!(text.get(span.start as usize..span.end as usize).is_some(), "{:?} {:?}", span, text);
        }
        let _ = write(&document);
    }
}
