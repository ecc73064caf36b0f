//! What went and what came, stroke by stroke.
//!
//! In: two drawings. Out: a drawing of both: marks that only the old one has in red, those that only the new one has in blue
//! and those of both in grey. Marks are the same that have one form, pen and ink to a thousandth of a millimetre; a straight
//! stroke may run either way, and of one that only became longer or shorter a part stayed.

use std::collections::BTreeMap;
use std::hash::Hasher;

use siphasher::sip128::{Hasher128, SipHasher13};

use super::overlap::{self, Fate, Line, Side};
use crate::drawing::{Dots, Drawing, Layer, Page, Strokes};
use crate::geom::chain;
use crate::geom::{Length, Point};
use crate::scene::{Cap, Colour};

/// What only the old drawing has.
pub const WENT: Colour = Colour { r: 215, g: 25, b: 28, a: 255 };
/// What only the new one has.
pub const CAME: Colour = Colour { r: 25, g: 85, b: 205, a: 255 };
/// What both have.
pub const STAYED: Colour = Colour { r: 165, g: 165, b: 165, a: 255 };
/// The same for what has the colour of the paper, which covers and is not seen itself.
const PALE_WENT: Colour = Colour { r: 250, g: 215, b: 212, a: 255 };
const PALE_CAME: Colour = Colour { r: 212, g: 224, b: 250, a: 255 };

/// The width of the sheet's border, where its size changed.
const BORDER: Length = Length::mm(0.3);

/// Straight strokes that lie in one path of an SVG.
const TOGETHER: usize = 64;

/// How long all strokes of a layer are together; dots and filled outlines have no length.
#[must_use]
pub fn drawn(layer: &Layer) -> Length {
    let mut sum = 0.0;
    for strokes in &layer.strokes {
        sum += strokes.lines.iter().map(|[a, b]| a.distance(*b)).sum::<f64>();
        let polylines = strokes.polylines.iter().flat_map(|line| line.windows(2));
        sum += polylines.map(|ends| ends[0].distance(ends[1])).sum::<f64>();
        sum += strokes.curves.iter().map(chain::length).sum::<f64>();
    }
    sum += layer.tapers.spines.iter().map(chain::length).sum::<f64>();
    Length::mm(sum)
}

/// What is known of a mark.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum State {
    /// The other drawing has it too.
    Both,
    /// The other drawing has no such mark.
    Only,
    /// It is a straight stroke, of which the other drawing may have a part.
    Parted,
}

/// A drawing of what went, what came and what stayed.
#[must_use]
pub fn marks(old: &Drawing, new: &Drawing) -> Drawing {
    let [mut before, mut after] = [old, new].map(keys);
    let mut states = unmatched(&mut before, &mut after);
    let parts = parted([old, new], &mut states);
    let [went, came] = &states;
    let papers = [old, new].map(|drawing| drawing.page.paper.unwrap_or(Colour::WHITE));
    let mut layers = Vec::new();
    let ink = |ink| if ink == papers[1] { Colour::WHITE } else { STAYED };
    picked(new, (came, State::Both), (&parts, Fate::Stayed, "stayed"), ink, &mut layers);
    let ink = |ink| if ink == papers[0] { PALE_WENT } else { WENT };
    picked(old, (went, State::Only), (&parts, Fate::Went, "went"), ink, &mut layers);
    let ink = |ink| if ink == papers[1] { PALE_CAME } else { CAME };
    picked(new, (came, State::Only), (&parts, Fate::Came, "came"), ink, &mut layers);
    let sizes = [old, new].map(|drawing| (drawing.page.width, drawing.page.height));
    if sizes[0] != sizes[1] {
        let sheets = [("went", WENT, sizes[0]), ("came", CAME, sizes[1])];
        layers.extend(sheets.map(|(group, ink, size)| sheet(group, ink, size)));
    }
    Drawing { page: common(&old.page, &new.page), layers }
}

/// Parts of straight strokes by what became of them and by their layers.
type Parts = BTreeMap<(Fate, usize), Vec<(Length, Cap, [Point; 2])>>;

/// Takes those straight strokes apart that only one drawing has as they are.
fn parted(drawings: [&Drawing; 2], states: &mut [Vec<State>; 2]) -> Parts {
    let mut lines = Vec::new();
    let mut looks: BTreeMap<u128, (Length, Cap)> = BTreeMap::new();
    for ((drawing, states), side) in drawings.into_iter().zip(states).zip([Side::Old, Side::New]) {
        let marks = drawing
            .layers
            .iter()
            .enumerate()
            .flat_map(|(number, layer)| each(layer).map(move |mark| (number, layer.ink, mark)));
        for ((layer, ink, mark), state) in marks.zip(states) {
            if let (Mark::Line(pen, cap, ends), State::Only) = (mark, *state) {
                // A stroke of no length has what is told of all strokes of its look and nothing else.
                let key = key(Mark::Line(pen, cap, [Point::new(0.0, 0.0); 2]), ink);
                looks.insert(key, (pen, cap));
                lines.push(Line { key, side, layer, ends });
                *state = State::Parted;
            }
        }
    }
    let mut found = Parts::new();
    for (fate, key, layer, ends) in overlap::parts(lines) {
        if let Some(&(pen, cap)) = looks.get(&key) {
            found.entry((fate, layer)).or_default().push((pen, cap, ends));
        }
    }
    found
}

/// A page that holds two, without a colour of its own but white.
#[must_use]
pub fn common(old: &Page, new: &Page) -> Page {
    Page {
        width: old.width.max(new.width),
        height: old.height.max(new.height),
        bleed: Length::ZERO,
        paper: Some(Colour::WHITE),
        ..new.clone()
    }
}

/// The border of a sheet.
fn sheet(group: &str, ink: Colour, (width, height): (Length, Length)) -> Layer {
    let [x, y] = [width, height].map(Length::to_mm);
    let ring = [(0.0, 0.0), (x, 0.0), (x, y), (0.0, y), (0.0, 0.0)].map(|(x, y)| Point::new(x, y)).to_vec();
    let mut layer = Layer::new(vec![group.to_owned()], "sheet".to_owned(), ink);
    layer.strokes.push(Strokes { polylines: vec![ring], ..Strokes::new(BORDER, Cap::Butt) });
    layer
}

/// A mark of a layer.
#[derive(Clone, Copy)]
enum Mark<'a> {
    Area(&'a [Vec<Point>]),
    Line(Length, Cap, [Point; 2]),
    Polyline(Length, Cap, &'a [Point]),
    Curve(Length, Cap, &'a [Point]),
    Taper(&'a [Point], &'a [f64]),
    Dot(Length, Point),
}

/// All marks of a layer, in one order.
fn each(layer: &Layer) -> impl Iterator<Item = Mark<'_>> {
    let areas = layer.areas.iter().map(|area| Mark::Area(area));
    let strokes = layer.strokes.iter().flat_map(|strokes| {
        let (pen, cap) = (strokes.pen, strokes.cap);
        let lines = strokes.lines.iter().map(move |&line| Mark::Line(pen, cap, line));
        let polylines = strokes.polylines.iter().map(move |line| Mark::Polyline(pen, cap, line));
        lines.chain(polylines).chain(strokes.curves.iter().map(move |curve| Mark::Curve(pen, cap, curve)))
    });
    let tapers = layer.tapers.iter().map(|(spine, widths)| Mark::Taper(spine, widths));
    let dots = layer.dots.iter().flat_map(|dots| dots.centres.iter().map(|&centre| Mark::Dot(dots.radius, centre)));
    areas.chain(strokes).chain(tapers).chain(dots)
}

/// The keys of all marks with their numbers.
fn keys(drawing: &Drawing) -> Vec<(u128, usize)> {
    let layers = drawing.layers.iter().flat_map(|layer| each(layer).map(|mark| key(mark, layer.ink)));
    layers.enumerate().map(|(number, key)| (key, number)).collect()
}

/// What tells marks apart.
fn key(mark: Mark<'_>, ink: Colour) -> u128 {
    let mut hash = SipHasher13::new();
    let thousandths = |value: f64| (value * 1000.0).round() as i64;
    hash.write(&[ink.r, ink.g, ink.b, ink.a]);
    let mut pen = |kind: u8, width: Length, cap: Option<Cap>| {
        hash.write_u8(kind);
        hash.write_i64(thousandths(width.to_mm()));
        hash.write_u8(match cap {
            None => 0,
            Some(Cap::Butt) => 1,
            Some(Cap::Round) => 2,
        });
    };
    match mark {
        Mark::Area(_) => pen(0, Length::ZERO, None),
        Mark::Line(width, cap, _) => pen(1, width, Some(cap)),
        Mark::Polyline(width, cap, _) => pen(2, width, Some(cap)),
        Mark::Curve(width, cap, _) => pen(3, width, Some(cap)),
        Mark::Taper(..) => pen(4, Length::ZERO, None),
        Mark::Dot(radius, _) => pen(5, radius, None),
    }
    let place = |p: Point| [thousandths(p.x), thousandths(p.y)];
    let points = |points: &[Point], hash: &mut SipHasher13| {
        hash.write_usize(points.len());
        points.iter().flat_map(|&p| place(p)).for_each(|at| hash.write_i64(at));
    };
    match mark {
        Mark::Area(rings) => rings.iter().for_each(|ring| points(ring, &mut hash)),
        Mark::Line(_, _, [a, b]) => {
            let mut ends = [place(a), place(b)];
            ends.sort_unstable();
            ends.iter().flatten().for_each(|&at| hash.write_i64(at));
        }
        Mark::Polyline(_, _, line) | Mark::Curve(_, _, line) => points(line, &mut hash),
        Mark::Taper(spine, widths) => {
            points(spine, &mut hash);
            widths.iter().for_each(|&width| hash.write_i64(thousandths(width)));
        }
        Mark::Dot(_, centre) => points(&[centre], &mut hash),
    }
    hash.finish128().as_u128()
}

/// For every mark of two drawings, whether the other has one left that is the same.
fn unmatched(old: &mut [(u128, usize)], new: &mut [(u128, usize)]) -> [Vec<State>; 2] {
    old.sort_unstable();
    new.sort_unstable();
    let [mut went, mut came] = [old.len(), new.len()].map(|count| vec![State::Only; count]);
    let mut others = new.iter().peekable();
    for &(key, number) in old.iter() {
        while others.next_if(|other| other.0 < key).is_some() {}
        if let Some(other) = others.next_if(|other| other.0 == key) {
            went[number] = State::Both;
            came[other.1] = State::Both;
        }
    }
    [went, came]
}

/// Adds those marks of a drawing that are in this state, and what parts of strokes share their fate, layer by layer in
/// another ink.
fn picked(
    drawing: &Drawing,
    (states, state): (&[State], State),
    (parts, fate, group): (&Parts, Fate, &str),
    ink: impl Fn(Colour) -> Colour,
    layers: &mut Vec<Layer>,
) {
    let mut states = states.iter();
    for (number, layer) in drawing.layers.iter().enumerate() {
        let mut picked = Layer::new(vec![group.to_owned()], layer.name.clone(), ink(layer.ink));
        for mark in each(layer) {
            if states.next() == Some(&state) {
                put(mark, &mut picked);
            }
        }
        for &(pen, cap, ends) in parts.get(&(fate, number)).into_iter().flatten() {
            put(Mark::Line(pen, cap, ends), &mut picked);
        }
        picked.strokes.iter_mut().for_each(|strokes| strokes.curves.end_bundle());
        picked.tapers.spines.end_bundle();
        if picked.marks() > 0 {
            layers.push(picked);
        }
    }
}

/// Adds a mark to a layer.
fn put(mark: Mark<'_>, layer: &mut Layer) {
    match mark {
        Mark::Area(rings) => layer.areas.push(rings.to_vec()),
        Mark::Line(pen, cap, line) => {
            let strokes = strokes(layer, pen, cap);
            strokes.lines.push(line);
            let all = strokes.lines.len();
            match strokes.bundle_ends.last_mut() {
                Some(end) if !(all - 1).is_multiple_of(TOGETHER) => *end = all,
                _ => strokes.bundle_ends.push(all),
            }
        }
        Mark::Polyline(pen, cap, line) => strokes(layer, pen, cap).polylines.push(line.to_vec()),
        Mark::Curve(pen, cap, curve) => strokes(layer, pen, cap).curves.push(curve),
        Mark::Taper(spine, widths) => layer.tapers.push(spine, widths),
        Mark::Dot(radius, centre) => {
            if layer.dots.last().is_none_or(|dots| dots.radius != radius) {
                layer.dots.push(Dots::new(radius));
            }
            if let Some(dots) = layer.dots.last_mut() {
                dots.centres.push(centre);
                dots.bundle_ends = vec![dots.centres.len()];
            }
        }
    }
}

/// The strokes of a pen; marks come pen by pen.
fn strokes(layer: &mut Layer, pen: Length, cap: Cap) -> &mut Strokes {
    let is_last = layer.strokes.last().is_some_and(|strokes| (strokes.pen, strokes.cap) == (pen, cap));
    if !is_last {
        layer.strokes.push(Strokes::new(pen, cap));
    }
    let last = layer.strokes.len() - 1;
    &mut layer.strokes[last]
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::back::samples::{layer, lines, page, scattered};

    fn count(drawing: &Drawing, group: &str) -> u64 {
        drawing.layers.iter().filter(|layer| layer.groups == [group]).map(Layer::marks).sum()
    }

    fn one(lines: Strokes) -> Drawing {
        Drawing { page: page(10.0, 10.0), layers: vec![Layer { strokes: vec![lines], ..layer("a", Colour::BLACK) }] }
    }

    #[test]
    fn every_kind_of_mark_is_found_again() {
        let old = scattered(40.0, 40.0, 200);
        let all: u64 = old.layers.iter().map(Layer::marks).sum();
        let same = marks(&old, &old);
        assert_eq!((count(&same, "stayed"), count(&same, "went"), count(&same, "came")), (all, 0, 0));
        let mut new = old.clone();
        new.layers[0].strokes[0].lines[3][0].x += 0.1;
        new.layers[0].strokes[1].polylines.pop();
        new.layers[0].dots[0].radius = Length::mm(0.4);
        let dots = old.layers[0].dots[0].centres.len() as u64;
        let found = marks(&old, &new);
        // The stroke that moved at one end lies on no straight line with the old one.
        assert_eq!(count(&found, "went"), 2 + dots);
        assert_eq!(count(&found, "came"), 1 + dots);
        assert_eq!(count(&found, "stayed"), all - 2 - dots);
        for strokes in found.layers.iter().flat_map(|layer| &layer.strokes) {
            assert_eq!(strokes.bundle_ends.last().copied().unwrap_or(0), strokes.lines.len());
            assert!(strokes.bundles().all(|bundle| (1..=TOGETHER).contains(&bundle.len())));
        }
    }

    #[test]
    fn a_stroke_may_run_either_way_but_counts_once() {
        let (there, back) = ([(1.0, 1.0), (5.0, 2.0)], [(5.0, 2.0), (1.0, 1.0)]);
        let old = one(lines(0.2, Cap::Butt, &[&[there, there]]));
        let found = marks(&old, &one(lines(0.2, Cap::Butt, &[&[back]])));
        assert_eq!((count(&found, "stayed"), count(&found, "went"), count(&found, "came")), (1, 1, 0));
    }

    #[test]
    fn of_a_shorter_stroke_a_part_stayed() {
        let old = one(lines(0.2, Cap::Butt, &[&[[(1.0, 1.0), (5.0, 4.0)]]]));
        let found = marks(&old, &one(lines(0.2, Cap::Butt, &[&[[(1.0, 1.0), (3.0, 2.5)]]])));
        assert_eq!((count(&found, "stayed"), count(&found, "went"), count(&found, "came")), (1, 1, 0));
        let thicker = marks(&old, &one(lines(0.3, Cap::Butt, &[&[[(1.0, 1.0), (3.0, 2.5)]]])));
        assert_eq!((count(&thicker, "stayed"), count(&thicker, "went"), count(&thicker, "came")), (0, 1, 1));
    }

    #[test]
    fn another_ink_or_sheet_is_a_change() {
        let old = one(lines(0.2, Cap::Butt, &[&[[(1.0, 1.0), (5.0, 2.0)]]]));
        let mut new = old.clone();
        new.layers[0].ink = WENT;
        new.page.width = Length::mm(12.0);
        let found = marks(&old, &new);
        assert_eq!(count(&found, "stayed"), 0);
        assert_eq!((count(&found, "went"), count(&found, "came")), (2, 2), "a stroke and a border each");
        assert_eq!((found.page.width, found.page.height), (Length::mm(12.0), Length::mm(10.0)));
    }

    #[test]
    fn lengths_add_up() {
        let mut strokes = lines(0.2, Cap::Butt, &[&[[(0.0, 0.0), (3.0, 4.0)]]]);
        strokes.polylines.push(vec![Point::new(0.0, 0.0), Point::new(2.0, 0.0), Point::new(2.0, 2.0)]);
        strokes.curves.push(&[0.0, 1.0, 2.0, 3.0].map(|x| Point::new(x, 0.0)));
        let drawing = one(strokes);
        assert!((drawn(&drawing.layers[0]).to_mm() - 12.0).abs() < 1e-9);
    }
}
