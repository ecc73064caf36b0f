//! What differs between two scenes, as data: what words, JSON and the page are made of.

use std::collections::{BTreeMap, BTreeSet};

use rayon::prelude::*;
use serde::Serialize;
use serde_json::Value;

use crate::compare::{Fingerprint, Shift, drawn, fingerprint, layers, tiles};
use crate::diag::to_json;
use crate::drawing::{Drawing, Layer, Page};
use crate::geom::Length;
use crate::scene::{Colour, Depth};

use super::side::{MOST_MEASURED, Made, Painted};
use super::tones::{Declared, declared};

/// Measures below it are zero: rounding differs where nothing else does.
const NOTHING: f64 = 1e-9;

/// The measures that the preview shows first too.
const CHIEF: [&str; 8] = ["e_contrast", "e_share", "h_angle", "xi", "c_cov", "u_vor", "density_contrast", "grain"];

/// All that differs.
#[derive(Debug, Serialize)]
pub(super) struct Findings {
    /// Whether both sides have a picture, and it is the same; of files that draw nothing by themselves, whether no picture
    /// of a scene that imports them can differ.
    pub(super) same: bool,
    /// Whether the texts of the scenes, their imports or the files they read differ.
    pub(super) text_changed: bool,
    pub(super) old: Summary,
    pub(super) new: Summary,
    /// Parameters and the seed.
    pub(super) params: Vec<Change>,
    pub(super) canvas: Vec<Change>,
    /// Of files that draw nothing by themselves, what they declare that is not what it was.
    pub(super) declared: Vec<Declared>,
    /// Whether paints that are in both lie on each other in another order.
    pub(super) order_changed: bool,
    /// Paints and what else is drawn, from the bottom up.
    pub(super) paints: Vec<PaintChange>,
    /// What is seen of it.
    pub(super) pixels: Option<PixelChange>,
    /// What is to be known besides.
    pub(super) notes: Vec<String>,
}

impl Findings {
    /// Whether all there is draws nothing by itself.
    pub(super) fn draws_nothing(&self) -> bool {
        let sides = || [&self.old, &self.new].into_iter().filter(|side| side.exists);
        sides().next().is_some() && sides().all(|side| side.draws_nothing)
    }
}

/// One side by itself.
#[derive(Debug, Serialize)]
pub(super) struct Summary {
    pub(super) name: String,
    /// Whether there is a scene at all.
    pub(super) exists: bool,
    /// Whether it is without fault and draws nothing by itself, as libraries of tones do not.
    pub(super) draws_nothing: bool,
    /// What tells its picture from others; none without a picture.
    pub(super) fingerprint: Option<String>,
    pub(super) paints: usize,
    pub(super) tiles: usize,
    pub(super) marks: u64,
    #[serde(rename = "drawn_mm")]
    pub(super) drawn: Length,
    /// What is wrong with it.
    pub(super) diagnostics: Value,
}

/// Something with a name and a value.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub(super) struct Change {
    pub(super) name: String,
    pub(super) old: Option<String>,
    pub(super) new: Option<String>,
}

/// What became of a paint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Fate {
    Same,
    Changed,
    Renamed,
    Came,
    Went,
}

#[derive(Debug, Serialize)]
pub(super) struct PaintChange {
    pub(super) paint: String,
    pub(super) change: Fate,
    /// The name it had before.
    pub(super) was: Option<String>,
    /// What became of its tiles; none of what has no tiles.
    pub(super) tiles: Option<Shift>,
    pub(super) marks: [u64; 2],
    #[serde(rename = "drawn_mm")]
    pub(super) drawn: [Length; 2],
    /// Its pens and inks where they changed.
    pub(super) look: Vec<Change>,
    /// The measures that changed, to six digits.
    pub(super) metrics: Vec<Measure>,
}

impl PaintChange {
    /// The measures that are asked for first, and the others.
    pub(super) fn measures(&self) -> (Vec<&Measure>, Vec<&Measure>) {
        self.metrics.iter().partition(|measure| CHIEF.contains(&measure.name.as_str()))
    }
}

#[derive(Debug, Serialize)]
pub(super) struct Measure {
    pub(super) name: String,
    pub(super) old: Option<f64>,
    pub(super) new: Option<f64>,
}

#[derive(Debug, Clone, Copy, Serialize)]
pub(super) struct PixelChange {
    /// Pixels that differ visibly.
    pub(super) changed: u64,
    /// Their share, from 0 to 1.
    pub(super) share: f64,
    pub(super) width: usize,
    pub(super) height: usize,
    /// Pixels per inch.
    pub(super) dpi: f64,
}

/// Compares all but pixels.
pub(super) fn compare(names: [&str; 2], made: [Option<&Made>; 2]) -> Findings {
    let [old, new] = made;
    let drawings = made.map(|made| made.and_then(|made| made.drawing.as_ref()));
    let prints: Vec<Option<Fingerprint>> = drawings.par_iter().map(|drawing| drawing.map(fingerprint)).collect();
    let [before, after] = [prints[0], prints[1]];
    let texts = made.map(|made| made.map(Made::texts));
    let is_library = old.or(new).is_some() && made.iter().flatten().all(|made| made.draws_nothing());
    let declared = if is_library { declared(made.map(|made| made.map(|made| &made.lowered))) } else { Vec::new() };
    let is_same = if is_library {
        old.is_some() && new.is_some() && declared.is_empty()
    } else {
        before.is_some() && before == after
    };
    let [old_summary, new_summary] = [0, 1].map(|i| summary(names[i], made[i], prints[i].as_ref()));
    let mut notes = Vec::new();
    for (which, made) in ["old", "new"].into_iter().zip(made) {
        let Some(made) = made else { continue };
        notes.extend(made.unknown.iter().map(|name| format!("the {which} scene has no parameter `{name}`")));
        notes.extend(
            made.stood.iter().map(|state| format!("imports and images of the {which} scene are those of {state}")),
        );
    }
    let paints = match (drawings, old, new) {
        ([None, None], ..) => Vec::new(),
        // A side that is at fault says nothing of what came or went.
        _ if made.iter().flatten().any(|made| made.is_faulty()) => Vec::new(),
        _ => paints(made, drawings, &mut notes),
    };
    Findings {
        same: is_same,
        text_changed: texts[0] != texts[1],
        old: old_summary,
        new: new_summary,
        // A library's parameters are told of with all else that it declares.
        params: if is_library { Vec::new() } else { params(made) },
        canvas: canvas(made),
        declared,
        order_changed: order_changed(made),
        paints,
        pixels: None,
        notes,
    }
}

fn summary(name: &str, made: Option<&Made>, print: Option<&Fingerprint>) -> Summary {
    let drawing = made.and_then(|made| made.drawing.as_ref());
    let layers = || drawing.into_iter().flat_map(|drawing| &drawing.layers);
    let diagnostics = made.map_or(Value::Array(Vec::new()), |made| to_json(&made.diagnostics(), &made.lowered.sources));
    let painted = made.map_or([].as_slice(), |made| &made.painted);
    Summary {
        name: name.to_owned(),
        exists: made.is_some(),
        draws_nothing: made.is_some_and(Made::draws_nothing),
        fingerprint: print.map(Fingerprint::to_string),
        paints: painted.len(),
        tiles: painted.iter().map(|paint| paint.pattern.len()).sum(),
        marks: layers().map(Layer::marks).sum(),
        drawn: layers().map(drawn).fold(Length::ZERO, |sum, length| sum + length),
        diagnostics,
    }
}

/// What differs between two lists of names and values: in the order of the new one, what went at the end.
fn changes(old: &[(String, String)], new: &[(String, String)]) -> Vec<Change> {
    let find = |list: &[(String, String)], name: &str| {
        list.iter().find(|(known, _)| known == name).map(|(_, value)| value.clone())
    };
    let names = new
        .iter()
        .map(|(name, _)| name)
        .chain(old.iter().map(|(name, _)| name).filter(|name| find(new, name).is_none()));
    let all = names.map(|name| Change { name: name.clone(), old: find(old, name), new: find(new, name) });
    all.filter(|change| change.old != change.new).collect()
}

fn params(made: [Option<&Made>; 2]) -> Vec<Change> {
    let [Some(old), Some(new)] = made.map(|made| made.and_then(|made| made.lowered.scene.as_ref())) else {
        return Vec::new();
    };
    let [old, new] = [old, new].map(|scene| {
        let params = scene.params.iter().map(|param| (param.name.clone(), param.value.text.clone()));
        params.chain([("seed".to_owned(), scene.seed.to_string())]).collect::<Vec<_>>()
    });
    changes(&old, &new)
}

fn canvas(made: [Option<&Made>; 2]) -> Vec<Change> {
    let [Some(old), Some(new)] = made.map(|made| made.and_then(|made| made.drawing.as_ref())) else {
        return Vec::new();
    };
    let [old, new] = [old, new].map(|drawing| {
        let Page { width, height, bleed, pixels, dpi, paper, depth } = &drawing.page;
        let paper = paper.map_or_else(|| "none".to_owned(), colour);
        let depth = match depth {
            Depth::One => "1",
            Depth::Eight => "8",
        };
        [
            ("size", format!("{} x {}", millimetres(*width), millimetres(*height))),
            ("bleed", millimetres(*bleed)),
            ("pixels", format!("{} x {}", pixels[0], pixels[1])),
            ("dpi", number(*dpi)),
            ("paper", paper),
            ("depth", depth.to_owned()),
        ]
        .map(|(name, value)| (name.to_owned(), value))
    });
    let mut found = changes(&old, &new);
    // With another size or resolution the number of pixels follows.
    if found.iter().any(|change| matches!(change.name.as_str(), "size" | "dpi")) {
        found.retain(|change| change.name != "pixels");
    }
    found
}

fn order_changed(made: [Option<&Made>; 2]) -> bool {
    let [Some(old), Some(new)] = made else { return false };
    let [before, after] =
        [old, new].map(|made| made.painted.iter().map(|paint| paint.name.as_str()).collect::<Vec<_>>());
    let [in_old, in_new] = [&before, &after].map(|names| names.iter().copied().collect::<BTreeSet<_>>());
    !before.iter().filter(|name| in_new.contains(*name)).eq(after.iter().filter(|name| in_old.contains(*name)))
}

/// What one side has of a name.
#[derive(Default)]
struct Part<'a> {
    painted: Option<&'a Painted>,
    layers: Vec<&'a Layer>,
}

impl Part<'_> {
    fn marks(&self) -> u64 {
        self.layers.iter().map(|layer| layer.marks()).sum()
    }

    fn drawn(&self) -> Length {
        self.layers.iter().map(|layer| drawn(layer)).fold(Length::ZERO, |sum, length| sum + length)
    }

    /// Inks and pens, in the order of their values.
    fn look(&self) -> Vec<(String, String)> {
        let inks: BTreeSet<Colour> = self.layers.iter().map(|layer| layer.ink).collect();
        let thousandths = |length: Length| (length.to_mm() * 1000.0).round() as i64;
        let strokes = self.layers.iter().flat_map(|layer| &layer.strokes);
        let pens: BTreeSet<i64> = strokes.map(|strokes| thousandths(strokes.pen)).collect();
        let dots = self.layers.iter().flat_map(|layer| &layer.dots);
        let dots: BTreeSet<i64> = dots.map(|dots| thousandths(dots.radius * 2.0)).collect();
        let list = |values: &BTreeSet<i64>| {
            let texts: Vec<String> =
                values.iter().map(|&value| millimetres(Length::mm(value as f64 / 1000.0))).collect();
            shortened(&texts)
        };
        let inks: Vec<String> = inks.into_iter().map(colour).collect();
        vec![("ink".to_owned(), shortened(&inks)), ("pen".to_owned(), list(&pens)), ("dots".to_owned(), list(&dots))]
    }
}

/// The first of a list and how many more there are.
fn shortened(texts: &[String]) -> String {
    match texts {
        [] => "none".to_owned(),
        [a] => a.clone(),
        [a, b] => format!("{a}, {b}"),
        [a, .., z] => format!("{a} to {z} ({} of them)", texts.len()),
    }
}

/// Everything that one side draws, by name, in the order in which it is drawn first.
fn parts<'a>(made: Option<&'a Made>, drawing: Option<&'a Drawing>) -> Vec<(&'a str, Part<'a>)> {
    let mut places: BTreeMap<&str, usize> = BTreeMap::new();
    let mut list: Vec<(&str, Part<'_>)> = Vec::new();
    let painted = made.map_or([].as_slice(), |made| &made.painted);
    for paint in painted {
        places.insert(&paint.name, list.len());
        list.push((&paint.name, Part { painted: Some(paint), layers: Vec::new() }));
    }
    for layer in drawing.into_iter().flat_map(|drawing| &drawing.layers) {
        let place = *places.entry(&layer.name).or_insert_with(|| {
            list.push((&layer.name, Part::default()));
            list.len() - 1
        });
        list[place].1.layers.push(layer);
    }
    list
}

fn paints(made: [Option<&Made>; 2], drawings: [Option<&Drawing>; 2], notes: &mut Vec<String>) -> Vec<PaintChange> {
    let [old, new] = [0, 1].map(|i| parts(made[i], drawings[i]));
    let in_new: BTreeMap<&str, usize> = new.iter().enumerate().map(|(place, (name, _))| (*name, place)).collect();
    let in_old: BTreeMap<&str, usize> = old.iter().enumerate().map(|(place, (name, _))| (*name, place)).collect();
    // New names for old paints: first what is painted alike in all, then what is painted on the same region.
    let mut was: BTreeMap<usize, usize> = BTreeMap::new();
    let mut taken = BTreeSet::new();
    for parts in [2, 1] {
        let mut gone: BTreeMap<&[String], Vec<usize>> = BTreeMap::new();
        for (place, (name, part)) in old.iter().enumerate().rev() {
            if let Some(painted) = part.painted
                && !in_new.contains_key(name)
                && !taken.contains(&place)
            {
                gone.entry(&painted.likeness[..parts]).or_default().push(place);
            }
        }
        for (place, (name, part)) in new.iter().enumerate() {
            if let Some(painted) = part.painted
                && !in_old.contains_key(name)
                && !was.contains_key(&place)
                && let Some(before) = gone.get_mut(&painted.likeness[..parts]).and_then(Vec::pop)
            {
                was.insert(place, before);
                taken.insert(before);
            }
        }
    }
    let came = new.iter().enumerate().map(|(place, (name, after))| {
        let before = in_old.get(name).or_else(|| was.get(&place)).and_then(|&place| old.get(place));
        (before, Some((*name, after)))
    });
    let went = old.iter().enumerate().filter(|(place, (name, _))| !in_new.contains_key(name) && !taken.contains(place));
    let pairs: Vec<_> = came.chain(went.map(|(_, before)| (Some(before), None))).collect();
    let found: Vec<PaintChange> =
        pairs.par_iter().map(|(before, after)| paint(before.map(|(name, part)| (*name, part)), *after)).collect();
    let is_large = |part: &Part<'_>| part.painted.is_some_and(|painted| painted.pattern.len() > MOST_MEASURED);
    if pairs.iter().any(|(before, after)| {
        before.is_some_and(|(_, part)| is_large(part)) || after.is_some_and(|(_, part)| is_large(part))
    }) {
        notes.push("paints of more than 200,000 tiles are not measured".to_owned());
    }
    found
}

fn paint(before: Option<(&str, &Part<'_>)>, after: Option<(&str, &Part<'_>)>) -> PaintChange {
    let none = Part::default();
    let [old, new] = [before, after].map(|side| side.map_or(&none, |(_, part)| part));
    let name = after.or(before).map_or("", |(name, _)| name);
    let was = before.map(|(name, _)| name).filter(|was| after.is_some() && *was != name);
    let (both, any) = (old.painted.zip(new.painted), old.painted.or(new.painted));
    let shift = match (both, any) {
        (Some((old, new)), _) => Some(tiles(&old.pattern, &new.pattern)),
        (None, Some(one)) => {
            let count = one.pattern.len();
            let (went, came) = if new.painted.is_some() { (0, count) } else { (count, 0) };
            Some(Shift { went, came, ..Shift::default() })
        }
        (None, None) => None,
    };
    let is_same = before.is_some()
        && after.is_some()
        && layers(old.layers.iter().copied()) == layers(new.layers.iter().copied())
        && shift.is_none_or(|shift| shift.is_nothing());
    // The same marks of the same tiles measure the same, unless the outline of what is painted moved beside them.
    let metrics = match both {
        Some((old, new)) => measures(old, new),
        None => Vec::new(),
    };
    let change = match (before, after, was) {
        (None, ..) => Fate::Came,
        (_, None, _) => Fate::Went,
        (.., Some(_)) => Fate::Renamed,
        _ if is_same && metrics.is_empty() => Fate::Same,
        _ => Fate::Changed,
    };
    let look = if before.is_some() && after.is_some() { changes(&old.look(), &new.look()) } else { Vec::new() };
    PaintChange {
        paint: name.to_owned(),
        change,
        was: was.map(str::to_owned),
        tiles: shift,
        marks: [old.marks(), new.marks()],
        drawn: [old.drawn(), new.drawn()],
        look,
        metrics,
    }
}

fn measures(old: &Painted, new: &Painted) -> Vec<Measure> {
    let (before, after) = rayon::join(|| old.scalars(), || new.scalars());
    let (Some(before), Some(after)) = (before, after) else { return Vec::new() };
    let mut left: BTreeMap<&str, Option<f64>> = before.iter().map(|(name, value)| (name.as_ref(), *value)).collect();
    let mut found = Vec::new();
    for (name, value) in &after {
        found.push(Measure { name: name.to_string(), old: left.remove(name.as_ref()).flatten(), new: *value });
    }
    let gone = before.iter().filter(|(name, _)| left.contains_key(name.as_ref()));
    found.extend(gone.map(|(name, value)| Measure { name: name.to_string(), old: *value, new: None }));
    for measure in &mut found {
        // What rounding leaves of nothing is nothing.
        for value in [&mut measure.old, &mut measure.new].into_iter().flatten() {
            *value = if value.abs() < NOTHING { 0.0 } else { *value };
        }
    }
    found.retain(|measure| measure.old.map(digits) != measure.new.map(digits));
    found
}

/// A number to six digits.
pub(super) fn digits(value: f64) -> String {
    significant(value, 6)
}

/// A number to so many digits, without zeros at its end.
pub(super) fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return if value == 0.0 { "0".to_owned() } else { value.to_string() };
    }
    let exponent = format!("{:.*e}", digits.saturating_sub(1), value);
    let rounded: f64 = exponent.parse().unwrap_or(value);
    // The shortest text that reads back as the rounded number.
    if rounded.abs() >= 1e-4 && rounded.abs() < 1e9 { rounded.to_string() } else { format!("{rounded:e}") }
}

/// A length as it is written in a scene.
pub(super) fn millimetres(length: Length) -> String {
    format!("{}mm", number((length.to_mm() * 1000.0).round() / 1000.0))
}

fn number(value: f64) -> String {
    significant(value, 9)
}

/// A colour as it is written in a scene.
fn colour(colour: Colour) -> String {
    if colour.a == 255 { colour.hex() } else { format!("{}{:02x}", colour.hex(), colour.a) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        for (value, text) in [
            (0.0, "0"),
            (0.1 + 0.2, "0.3"),
            (1234.5678, "1234.57"),
            (-2.0, "-2"),
            (1e-7 / 3.0, "3.33333e-8"),
            (1e12, "1e12"),
        ] {
            assert_eq!(digits(value), text);
        }
        assert_eq!(millimetres(Length::mm(59.999_999_9)), "60mm");
    }

    #[test]
    fn lists_are_compared_by_name() {
        let list =
            |pairs: &[(&str, &str)]| pairs.iter().map(|(a, b)| ((*a).to_owned(), (*b).to_owned())).collect::<Vec<_>>();
        let found = changes(&list(&[("a", "1"), ("b", "2"), ("c", "3")]), &list(&[("c", "4"), ("d", "5"), ("a", "1")]));
        let shown: Vec<_> = found.iter().map(|c| (c.name.as_str(), c.old.as_deref(), c.new.as_deref())).collect();
        assert_eq!(shown, [("c", Some("3"), Some("4")), ("d", None, Some("5")), ("b", Some("2"), None)]);
    }
}
