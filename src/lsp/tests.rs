//! What holds for any text, however it is cut off.

use std::sync::Arc;

use proptest::prelude::*;

use super::*;
use crate::loader::MemoryLoader;
use crate::lower::reference::Slot;
use crate::stop::Stop;

/// A text with about everything in it that brackets and statements do.
const ALL: &str = "\
import \"std:manga\" as manga
canvas { size: (60mm, 30mm), ink: navy }
param mode = \"poisson\" in [\"poisson\", \"uniform\"]
let gap: length = 1mm + 2 * (3mm - 1mm) ^ 1
field f = if x < 3 then noise(scale: 3mm) else match mode { \"poisson\" => 1, _ => 2 }
tone t(k: field = 1, at: placement = hex(spacing: 3mm)) = manga.kakeami(k: k) with {
  place: at
  fill: [lines(pitch: gap), dots(pitch: gap, ink: #123)]
  blend: \"dither\"
}
fn double(a, b: length = 1mm) = a * 2 + b
for i in 0 .. 2 {
  region r = rect(at: (i, 0), size: (1, 1)) - inset(canvas, gap)
  if i == 1 { paint r with t(k: 2) as \"row {i} of {mode}\" seed i } else { outline r pen 1mm }
}
layer \"a\" ink red { ink svg(\"a.svg\", fit: (0, 0, 1, 1)) }
experiment e { seeds: 0 .. 9, factors: { mode: [\"poisson\"] } }
";

struct Nothing;

impl Known for Nothing {
    fn parameters(&self, _called: &Called<'_>, _slot: Slot) -> Option<Vec<(String, Slot)>> {
        None
    }
}

impl Folder for Nothing {
    fn list(&self, _folder: &str) -> Vec<String> {
        Vec::new()
    }
}

fn looked(text: &str) -> Analysis {
    let mut loader = MemoryLoader::default();
    loader.files.insert("a.kake".to_owned(), text.as_bytes().into());
    Analysis::new("a.kake", &loader, Stop::default())
}

#[test]
fn every_place_of_a_text_has_its_answers() {
    let analysis = looked(ALL);
    let (source, _) = analysis.sources.iter().next().unwrap();
    let text = Text::new(ALL.into(), Encoding::Utf16);
    let seen = Seen { analysis: &analysis, source };
    for offset in 0..=ALL.len() {
        let _ = complete(&text, offset, seen, Snippets::Filled, &Nothing);
        let _ = help(&text, offset, seen);
        let _ = hover(&analysis, Spot { source, offset }, false);
        // The same with all behind the place cut off.
        let _ = context(&ALL[..offset], offset, &Nothing);
    }
}

#[test]
fn a_look_that_is_stopped_ends_without_a_scene() {
    let stop = Stop::new();
    stop.ask();
    let mut loader = MemoryLoader::default();
    loader.files.insert("a.kake".to_owned(), ALL.as_bytes().into());
    let analysis = Analysis::new("a.kake", &loader, stop);
    assert!(analysis.diagnostics.iter().any(|found| found.message.contains("was stopped")));
}

#[test]
fn lowering_is_the_same_whether_it_is_surveyed_or_not() {
    let loader = MemoryLoader { files: [("a.kake".to_owned(), Arc::from(ALL.as_bytes()))].into() };
    let plain = crate::lower::lower("a.kake", &loader, &crate::lower::LowerConfig::default());
    assert_eq!(plain.diagnostics, looked(ALL).diagnostics);
}

proptest! {
    #[test]
    fn any_text_at_all_has_a_context(text in "[a-z(){}\\[\\]:,.=\"\\\\/* \n0-9#é🖌]{0,80}", at in 0usize..200) {
        let mut at = at.min(text.len());
        while !text.is_char_boundary(at) {
            at -= 1;
        }
        let found = context(&text, at, &Nothing);
        prop_assert!(found.context.word.start <= at && at <= found.context.word.end);
        let lines = Text::new(text.as_str().into(), Encoding::Utf8);
        let _ = foldings(&lines);
    }

    #[test]
    fn statements_that_are_cut_and_glued_have_a_context(cuts in prop::collection::vec(0..ALL.len(), 2..6)) {
        let text: String = cuts.chunks(2).map(|pair| match pair {
            [from, to] => &ALL[*from.min(to)..*from.max(to)],
            _ => "",
        }).collect();
        for at in 0..=text.len() {
            let _ = context(&text, at, &Nothing);
        }
    }
}
