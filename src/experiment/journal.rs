//! Runs as lines of text, so that what is finished outlives the program.
//!
//! A journal is a file that only grows: its first line holds the recipe, every other a run. Each line opens with a
//! checksum of the rest. A line that was cut short by a kill or a full disk does not match its own and is left out when the
//! journal is read, so that its run is done again. A journal that is complete is written anew with its runs in the order
//! of the plan: then its bytes, too, are the same however often the work was interrupted. Figures are written with as many
//! digits as bring the same bits back.

use std::collections::BTreeMap;
use std::hash::Hasher;

use serde::{Deserialize, Serialize};
use siphasher::sip::SipHasher24;

use super::runner::{Done, PaintFigures};
use super::{Recipe, Shard};

/// What a journal holds.
#[derive(Debug, Clone, PartialEq)]
pub struct Journal {
    /// What its runs depend on.
    pub recipe: Recipe,
    /// Which share of the runs it is for.
    pub shard: Shard,
    /// The runs that are over, by number.
    pub done: BTreeMap<usize, Done>,
    /// How many bytes of the text are whole lines; what follows is half of one.
    pub whole: usize,
    /// How many lines were left out because they are damaged.
    pub damaged: usize,
}

#[derive(Serialize, Deserialize)]
struct Head<R> {
    shard: Shard,
    recipe: R,
}

#[derive(Serialize, Deserialize)]
struct Line {
    run: usize,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    failed: Option<String>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    paints: Vec<Paint>,
}

#[derive(Serialize, Deserialize)]
struct Paint {
    paint: String,
    /// Numbers as texts, which every reader takes to the same bits.
    figures: Vec<(String, Option<String>)>,
}

/// A line with its checksum.
fn line(json: &str) -> String {
    format!("{:016x} {json}\n", checksum(json))
}

fn checksum(text: &str) -> u64 {
    let mut hasher = SipHasher24::new();
    hasher.write(text.as_bytes());
    hasher.finish()
}

/// What a line says, if it is as it was written.
fn checked(line: &str) -> Option<&str> {
    let (sum, json) = line.split_once(' ')?;
    (sum.len() == 16 && u64::from_str_radix(sum, 16).ok()? == checksum(json)).then_some(json)
}

/// The first line of a journal.
///
/// # Errors
/// If the recipe cannot be serialised.
pub fn head(recipe: &Recipe, shard: Shard) -> serde_json::Result<String> {
    serde_json::to_string(&Head { shard, recipe }).map(|json| line(&json))
}

/// The line of a run.
///
/// # Errors
/// If it cannot be serialised.
pub fn entry(done: &Done) -> serde_json::Result<String> {
    let (failed, paints) = match &done.found {
        Err(words) => (Some(words.clone()), Vec::new()),
        Ok(paints) => {
            let figures = |paint: &PaintFigures| {
                paint
                    .figures
                    .iter()
                    .map(|(name, value)| (name.clone(), value.map(|value| format!("{value:?}"))))
                    .collect()
            };
            (None, paints.iter().map(|paint| Paint { paint: paint.paint.clone(), figures: figures(paint) }).collect())
        }
    };
    serde_json::to_string(&Line { run: done.run, failed, paints }).map(|json| line(&json))
}

impl Journal {
    /// Reads a journal; none where the text does not begin as one.
    #[must_use]
    pub fn read(bytes: &[u8]) -> Option<Self> {
        let mut lines = bytes.split_inclusive(|&byte| byte == b'\n');
        let first = lines.next()?;
        let head: Head<Recipe> = serde_json::from_str(checked(text(first)?)?).ok()?;
        let Shard { index, of } = head.shard;
        if index == 0 || index > of || head.recipe.seeds.is_some_and(|[first, last]| first > last) {
            return None;
        }
        let mut journal =
            Self { recipe: head.recipe, shard: head.shard, done: BTreeMap::new(), whole: first.len(), damaged: 0 };
        for line in lines {
            match text(line).and_then(checked).and_then(parse) {
                Some(done) => {
                    journal.done.entry(done.run).or_insert(done);
                }
                None => journal.damaged += 1,
            }
            if line.ends_with(b"\n") {
                journal.whole += line.len();
            }
        }
        Some(journal)
    }
}

/// A whole line without its end.
fn text(line: &[u8]) -> Option<&str> {
    std::str::from_utf8(line.strip_suffix(b"\n")?).ok()
}

fn parse(json: &str) -> Option<Done> {
    let line: Line = serde_json::from_str(json).ok()?;
    if let Some(words) = line.failed {
        return Some(Done { run: line.run, found: Err(words) });
    }
    let value = |text: Option<String>| match text {
        None => Some(None),
        Some(text) => text.parse().ok().map(Some),
    };
    let figures = |figures: Vec<(String, Option<String>)>| -> Option<Vec<(String, Option<f64>)>> {
        figures.into_iter().map(|(name, text)| Some((name, value(text)?))).collect()
    };
    let paint = |paint: Paint| Some(PaintFigures { paint: paint.paint, figures: figures(paint.figures)? });
    Some(Done { run: line.run, found: Ok(line.paints.into_iter().map(paint).collect::<Option<_>>()?) })
}
