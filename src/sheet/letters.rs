//! Letters as filled outlines: a line of text goes in, one area for each letter comes out.
//!
//! The font is Ubuntu Light (Ubuntu Font Licence 1.0), which has the Latin, Greek and Cyrillic alphabets. A character that it
//! does not have is shown as a box, as typesetters do.

use std::sync::LazyLock;

use ttf_parser::{Face, GlyphId, OutlineBuilder};

use crate::geom::{Cubic, Length, Point};

/// How far the outlines may stray from the font's curves, as a part of the letters' size.
const FLATTENING: f64 = 0.002;

/// The advance of a box as a part of the size, and the thickness of its sides.
const BOX: [f64; 2] = [0.62, 0.05];

/// How high a box is.
const BOX_HEIGHT: f64 = 0.68;

/// The font, unless the program was built with a damaged one: then every character is a box.
static FACE: LazyLock<Option<Face<'static>>> =
    LazyLock::new(|| Face::parse(epaint_default_fonts::UBUNTU_LIGHT, 0).ok());

/// The rings of one letter: filled by the even-odd rule.
type Area = Vec<Vec<Point>>;

/// A character in the font.
fn glyph(character: char) -> Option<(&'static Face<'static>, GlyphId)> {
    let face = FACE.as_ref()?;
    Some((face, face.glyph_index(character)?))
}

/// How far a character pushes the next one on, as a part of the size.
fn advance(character: char) -> f64 {
    let Some((face, id)) = glyph(character) else { return BOX[0] };
    let units = f64::from(face.units_per_em().max(1));
    face.glyph_hor_advance(id).map_or(BOX[0], |advance| f64::from(advance) / units)
}

/// How wide a line of text is.
#[must_use]
pub fn width(text: &str, size: Length) -> Length {
    Length::mm(text.chars().map(advance).sum::<f64>() * size.to_mm())
}

/// The letters of a line of text that starts at `start`, a point on its baseline.
#[must_use]
pub fn areas(text: &str, start: Point, size: Length) -> Vec<Area> {
    let size = size.to_mm();
    let mut areas = Vec::new();
    let mut x = start.x;
    for character in text.chars() {
        let at = Point::new(x, start.y);
        let area = match glyph(character) {
            Some((face, id)) => {
                let scale = size / f64::from(face.units_per_em().max(1));
                let mut pen = Pen { at, scale, tolerance: Length::mm(FLATTENING * size), rings: Vec::new() };
                face.outline_glyph(id, &mut pen);
                pen.rings
            }
            None if character.is_whitespace() => Vec::new(),
            None => missing(at, size),
        };
        areas.extend((!area.is_empty()).then_some(area));
        x += advance(character) * size;
    }
    areas
}

/// The box that stands for a character that the font does not have.
fn missing(at: Point, size: f64) -> Area {
    let [advance, side] = BOX;
    let ring = |inset: f64| {
        let (left, right) = (at.x + (0.06 + inset) * size, at.x + (advance - 0.06 - inset) * size);
        let (top, bottom) = (at.y - (BOX_HEIGHT - inset) * size, at.y - inset * size);
        vec![Point::new(left, top), Point::new(right, top), Point::new(right, bottom), Point::new(left, bottom)]
    };
    vec![ring(0.0), ring(side)]
}

/// Takes a letter's outline from the font, which has its origin on the baseline and y upwards.
struct Pen {
    at: Point,
    /// Millimetres in a unit of the font.
    scale: f64,
    tolerance: Length,
    rings: Area,
}

impl Pen {
    fn place(&self, x: f32, y: f32) -> Point {
        Point::new(self.at.x + f64::from(x) * self.scale, self.at.y - f64::from(y) * self.scale)
    }

    fn last(&self) -> Option<Point> {
        self.rings.last()?.last().copied()
    }

    fn push(&mut self, points: impl IntoIterator<Item = Point>) {
        if let Some(ring) = self.rings.last_mut() {
            ring.extend(points);
        }
    }

    fn curve(&mut self, curve: Cubic) {
        let points: Vec<Point> = curve.flatten(self.tolerance).collect();
        self.push(points);
    }
}

impl OutlineBuilder for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.rings.push(vec![self.place(x, y)]);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        let to = self.place(x, y);
        self.push([to]);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        if let Some(from) = self.last() {
            self.curve(Cubic::quadratic(from, self.place(x1, y1), self.place(x, y)));
        }
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        if let Some(from) = self.last() {
            self.curve(Cubic([from, self.place(x1, y1), self.place(x2, y2), self.place(x, y)]));
        }
    }

    fn close(&mut self) {
        // A ring ends where it starts; the point is not said twice.
        if let Some(ring) = self.rings.last_mut()
            && ring.len() > 1
            && ring.first() == ring.last()
        {
            ring.pop();
        }
    }
}

/// A line of text that is no wider than so much; what is cut off is marked.
#[must_use]
pub fn shortened(text: &str, size: Length, most: Length) -> String {
    if width(text, size).to_mm() <= most.to_mm() {
        return text.to_owned();
    }
    let room = most.to_mm() - width("\u{2026}", size).to_mm();
    let (mut short, mut x) = (String::new(), 0.0);
    for character in text.chars() {
        x += advance(character) * size.to_mm();
        if x > room {
            break;
        }
        short.push(character);
    }
    short.truncate(short.trim_end().len());
    short + "\u{2026}"
}

/// A text in lines that are no wider than so much, at most so many of them. Lines break at white space where they can.
#[must_use]
pub fn wrapped(text: &str, size: Length, most: Length, lines: usize) -> Vec<String> {
    let mut words = text.split_whitespace().peekable();
    let mut wrapped = Vec::new();
    while words.peek().is_some() && wrapped.len() < lines {
        let is_last = wrapped.len() + 1 == lines;
        let mut line = String::new();
        while let Some(word) = words.peek() {
            let longer = if line.is_empty() { (*word).to_owned() } else { format!("{line} {word}") };
            // The last line takes all that is left, and is cut.
            if !line.is_empty() && !is_last && width(&longer, size).to_mm() > most.to_mm() {
                break;
            }
            line = longer;
            words.next();
        }
        wrapped.push(shortened(&line, size, most));
    }
    wrapped
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: Length = Length::mm(10.0);

    fn bounds(areas: &[Area]) -> [f64; 4] {
        let points = || areas.iter().flatten().flatten();
        let least = |of: fn(&Point) -> f64| points().map(of).fold(f64::INFINITY, f64::min);
        let most = |of: fn(&Point) -> f64| points().map(of).fold(f64::NEG_INFINITY, f64::max);
        [least(|p| p.x), least(|p| p.y), most(|p| p.x), most(|p| p.y)]
    }

    #[test]
    fn letters_stand_on_their_baseline() {
        let areas = areas("H\u{e9}o x", Point::new(5.0, 20.0), SIZE);
        assert_eq!(areas.len(), 4);
        // An o has a hole.
        assert_eq!(areas[2].len(), 2);
        let [left, top, right, bottom] = bounds(&areas);
        assert!(left > 5.0 && left < 6.5, "{left}");
        assert!(top > 10.0 && top < 13.5, "{top}");
        assert!((20.0..20.3).contains(&bottom), "{bottom}");
        assert!(right < 5.0 + width("H\u{e9}o x", SIZE).to_mm());
    }

    #[test]
    fn a_missing_letter_is_a_box() {
        let areas = areas("\u{5f71}", Point::new(0.0, 0.0), SIZE);
        assert_eq!(areas.iter().map(Vec::len).collect::<Vec<_>>(), [2]);
        assert!(areas[0].iter().all(|ring| ring.len() == 4));
    }

    #[test]
    fn lines_are_no_wider_than_they_may_be() {
        let most = Length::mm(40.0);
        let lines = wrapped("the distance of strokes in a tile, Donaudampfschifffahrt", SIZE, most, 3);
        assert_eq!(lines.len(), 3);
        assert!(lines.iter().all(|line| width(line, SIZE).to_mm() <= 40.0), "{lines:?}");
        assert!(lines[2].ends_with('\u{2026}'));
        assert_eq!(wrapped("two", SIZE, most, 3), ["two"]);
        assert_eq!(shortened("two", SIZE, most), "two");
        assert!(wrapped("", SIZE, most, 2).is_empty());
    }
}
