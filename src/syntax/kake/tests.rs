//! Tests of the `.kake` front end.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stderr)]

use super::*;
use crate::span::{Sources, Syntax};

fn show(text: &str) {
    let mut sources = Sources::new();
    let id = sources.add("t", text, Syntax::Kake);
    let (document, diagnostics) = parse(id, text);
    eprintln!("--- {:?}\n    {} statements", text.chars().take(150).collect::<String>(), document.statements.len());
    for d in diagnostics.iter().take(12) {
        let s = d.span.unwrap();
        eprintln!(
            "    {} [{}..{} {:?}] {} | {} | {:?} {:?}",
            d.code,
            s.start,
            s.end,
            sources.text(s),
            d.message,
            d.label,
            d.hint,
            d.notes.iter().map(|(s, n)| (s.start, n.clone())).collect::<Vec<_>>()
        );
    }
}

#[test]
fn explore() {
    for t in [
        "let a =\nlet b = 3",
        "let a =\npaint canvas with plain",
        "let a = 3 +\nregion c = d",
        "let a = b c\nlet d = 4",
        "tone a {\n  k 2\n  shape: rect(\n  fill: lines(pitch 3mm)\n  angle: bfs()\n}\npaint canvas with a",
        "tone a {\n  k 2\n  shape: rect((\n  fill: lines(pitch 3mm)\n  angle: bfs(\n}\npaint canvas wiht a",
        "tone a {\n  k: 2\n\ntone b {\n k: 3 }\npaint canvas with a",
        "layer \"x\" {\n  paint a with b\n\nlayer \"y\" {\n  paint c wit d\n}\n",
        "layer \"x\" {\n  paint a with b\n  paint wrong\n }\n}\npaint a with b",
        "pant canvas with plain\noutlin body pen 1mm\nlayr \"x\" { paint a wth b }\nfoo = 3\n",
        "paint svg(\"abc) with x\nlet y = 3 $ 4",
        "let a = \"abc {x\nlet b = \"{}\"\nlet c = \"\\q \\u{zz} \\u{110000}\"",
        "let a = 6 mm + 50% 3\nlet b = 6mmm + #12 + #ggg + 1e999",
        "let a = 1 < 2 < 3\nlet b = 1 .. 2 .. 3\nlet c = .5\nlet d = 5.\nlet e = (1).x\nlet f = \"s\"(3)",
        "if a then b else c\nif a { paint b with c } else paint d with e",
        "let a = if b { c } else d\nlet x = if a then b\nlet y = match z { a => 3 -1 => 4 }",
        "let a = a && b\nlet b = a || b\nlet c = !a\nlet d = a == b == c;\nlet e = a = b",
        "let if = 3\nlet a: = 3\nlet = 3\nlet\nfn f = 3\nfn f(a b) = 3\nfn f(a, 3) = 2",
        "paint a with b seed 3 as \"x\"\npaint a with b as \"c\" as \"d\"\nimport x\nimport \"a{b}\" as c\nimport \"x\" as",
        "for x of a { }\nfor x in a\nlayer { }\nlayer \"x\" ink { paint q with r }\ncanvas size: 3\nexperiment { a: 3 }",
        "tone a = b { k: 3 }\ntone a(k) with { }\ntone { k: 3 }\ntone a = b(k: 1)\nlet c = 3",
        "} ) ]\nlet a = (1]\nlet b = [1)\nlet c = f(a))\nlet d = 3",
        "/* abc\nlet a = 3",
        "let a = f(\n  b,\n  c\nlet d = 4\nlet e = 5",
        "canvas { size: (1, 2) dpi 600; paper: #fff }",
        "let a = { b: 1 c 2 }",
        "let a = [1, 2",
        "let a = (1 + [2 * {a: 3)",
        "edition",
        "seed 4 5",
        "let a = 日本 + ？",
        "edition 1\nfoo bar\nbaz\n",
        "paint canvas with plain foo\nlet a = 3",
        "param a = 1 in\nparam b: number = 1 inn 1 .. 4",
        "outline body pn 3mm\noutline body",
        "let a = f(if: 3, match: 4, seed: 5)\nlet b = { if: 3, not: 4 }\nlet c = seed + region(field) - canvas",
        "let a = f(x = 3)\nlet b = [1 2]\nlet c = a[1\nlet d = a.\nlet e = -\nlet f = not",
    ] {
        show(t);
    }
    for (name, t) in [
        ("parens", format!("let a = {}1{}\nlet b = 3", "(".repeat(10_000), ")".repeat(10_000))),
        ("open", format!("let a = {}\nlet b = 3", "(".repeat(10_000))),
        ("minus", format!("let a = {}1\nlet b = 3", "-".repeat(10_000))),
        ("not", format!("let a = {}b\nlet b = 3", "not ".repeat(10_000))),
        ("index", format!("let a = b{}\nlet b = 3", "[0]".repeat(10_000))),
        ("call", format!("let a = b{}\nlet b = 3", "(0)".repeat(10_000))),
        ("if then", format!("let a = {} b\nlet b = 3", "if a then ".repeat(10_000))),
        ("if if", format!("let a = {} b\nlet b = 3", "if ".repeat(10_000))),
        ("else if", format!("let a = {} b\nlet b = 3", "if a then b else ".repeat(10_000))),
        ("match", format!("let a = {} b\nlet b = 3", "match ".repeat(10_000))),
        ("sum", format!("let a = b{}\nlet b = 3", " + 1".repeat(100_000))),
        ("power", format!("let a = b{}\nlet b = 3", " ^ -1".repeat(100_000))),
        ("layer", format!("{}{}\nlet b = 3", "layer \"x\" {\n".repeat(10_000), "}".repeat(10_000))),
        ("for", format!("{}{}\nlet b = 3", "for x in y { ".repeat(10_000), "}".repeat(10_000))),
        ("if", format!("{}{}\nlet b = 3", "if x { ".repeat(10_000), "}".repeat(10_000))),
        ("if open", format!("{}\nlet b = 3", "if x { ".repeat(10_000))),
        ("string", format!("let a = {}{}\nlet b = 3", "\"{".repeat(10_000), "}\"".repeat(10_000))),
        ("records", format!("let a = {}{}\nlet b = 3", "{a: ".repeat(10_000), "}".repeat(10_000))),
        ("elseif stmt", format!("if x {{ }} {}\nlet b = 3", "else if x { }".repeat(10_000))),
        ("128", format!("let a = {}1{}\nlet b = 3", "(".repeat(128), ")".repeat(128))),
        ("128+", format!("let a = {}1{}\nlet b = 3", "(1+".repeat(128), ")".repeat(128))),
        ("129", format!("let a = {}1{}\nlet b = 3", "(".repeat(129), ")".repeat(129))),
        ("128 call", format!("let a = {}1{}\nlet b = 3", "f(-1 * ".repeat(128), ")".repeat(128))),
        ("128 if", format!("let a = {} 1 {}\nlet b = 3", "if a then ".repeat(128), "else 0 ".repeat(128))),
        ("127 layers", format!("{}let a = (3){}\nlet b = 3", "layer \"x\" { ".repeat(127), "}".repeat(127))),
        ("closers", format!("{}\nlet b = 3", ")".repeat(100_000))),
        ("let let", "let ".repeat(250_000)),
        ("seed pen", "seed pen ".repeat(100_000)),
        ("quotes", "\"\n".repeat(500_000)),
        ("let +", "let +\n".repeat(100_000)),
        ("open/close", format!("{}{}", "(".repeat(500_000), "]".repeat(500_000))),
        ("x", "x ".repeat(500_000)),
        ("xl", "xlt\n".repeat(250_000)),
        ("uu", format!("let a = \"{}", "\\u{".repeat(300_000))),
        ("big", "let shade = linear(from: (20mm, 30mm), to: (75mm, 70mm), start: 1, end: 4 * reach)\n".repeat(12_000)),
        ("big tone", "/// Doc\ntone plate(k: field = 1) {\n  place: poisson(radius: 6mm)\n  shape: rect()\n  angle: bfs()\n  fill: lines(pitch: 0.8mm, pen: 0.2mm)\n  k: 2\n}\n".repeat(8_000)),
    ] {
        eprintln!("=== {name} {}", t.len());
        let start = std::time::Instant::now();
        show(&t.clone());
        eprintln!("    {:?}", start.elapsed());
    }
}

#[test]
fn tmp_scenes() {
    for entry in std::fs::read_dir("/work/shared/scenes").unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|e| e == "kake") {
            let text = std::fs::read_to_string(&path).unwrap();
            show(&text);
        }
    }
}

#[test]
fn stack() {
    for kb in [512usize, 768, 1024, 1536, 2048] {
        for (name, t) in [
            ("128", format!("let a = {}1{}\nlet b = 3", "(".repeat(128), ")".repeat(128))),
            ("128+", format!("let a = {}1{}\nlet b = 3", "(1+".repeat(128), ")".repeat(128))),
            ("128 if", format!("let a = {} 1 {}\nlet b = 3", "if a then ".repeat(128), "else 0 ".repeat(128))),
            ("128 match", format!("let a = {} 1 {}\nlet b = 3", "match a { 1 => ".repeat(64), "}".repeat(64))),
            ("128 str", format!("let a = {} 1 {}\nlet b = 3", "\"{".repeat(128), "}\"".repeat(128))),
            ("128 call", format!("let a = {} 1 {}\nlet b = 3", "f(a: ".repeat(128), ")".repeat(128))),
            ("128 rec", format!("let a = {} 1 {}\nlet b = 3", "{a: ".repeat(128), "}".repeat(128))),
            ("128 layers", format!("{}let a = 3{}\nlet b = 3", "layer \"x\" { ".repeat(128), "}".repeat(128))),
            ("128 if st", format!("{}let a = 3{}\nlet b = 3", "if x { ".repeat(128), "}".repeat(128))),
            (
                "64 if st",
                format!(
                    "{}let a = {}3{}{}\nlet b = 3",
                    "if x { ".repeat(64),
                    "(".repeat(64),
                    ")".repeat(64),
                    "}".repeat(64)
                ),
            ),
        ] {
            let r = std::thread::Builder::new().stack_size(kb * 1024).spawn(move || {
                let mut sources = Sources::new();
                let id = sources.add("t", "", Syntax::Kake);
                let (d, diagnostics) = parse(id, &t);
                drop(format!("{d:?}"));
                eprintln!("{kb} {name} {:?}", diagnostics.first().map(|d| d.code));
            });
            r.unwrap().join().unwrap();
        }
    }
}
