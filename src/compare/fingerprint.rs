//! A short text that tells drawings apart.
//!
//! In: a drawing. Out: the SHA-256 of its page and of its marks in drawing order, every length rounded to a thousandth of a
//! millimetre. How marks are put together in bundles and lists does not matter, for no picture shows it; nor do the names of
//! paints, nor layers without a mark. What is hashed is written down here and nowhere else, so that no format of another part can change it.

use std::fmt;

use sha2::{Digest, Sha256};

use crate::drawing::{Dots, Drawing, Layer, Page, Strokes};
use crate::geom::{Length, Point};
use crate::scene::{Cap, Colour, Depth};

/// What every text that is hashed starts with. Whoever changes what follows changes this too, so that old fingerprints are
/// seen to be of another kind.
const KIND: &[u8] = b"kakeami drawing 1\n";

/// Bytes that are gathered before they are hashed.
const BUFFER: usize = 1 << 16;

/// Tells drawings apart; shown as `sha256:` and 64 hexadecimal digits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Fingerprint([u8; 32]);

impl fmt::Display for Fingerprint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("sha256:")?;
        self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

/// The fingerprint of a drawing.
#[must_use]
pub fn fingerprint(drawing: &Drawing) -> Fingerprint {
    let mut writer = Writer::new();
    writer.page(&drawing.page);
    for layer in drawing.layers.iter().filter(|layer| layer.marks() > 0) {
        writer.layer(layer);
    }
    writer.finish()
}

/// What follows, so that no two drawings give the same bytes.
#[derive(Debug, Clone, Copy)]
#[repr(u8)]
enum Tag {
    Page = 1,
    Layer,
    Pen,
    Radius,
    Line,
    Polyline,
    Curve,
    Taper,
    Dot,
    Area,
}

/// Gathers bytes and hashes them.
struct Writer {
    hash: Sha256,
    bytes: Vec<u8>,
    /// The pen that was told last in this layer: marks of one pen that lie in two lists are as in one.
    pen: Option<(i64, Cap)>,
    /// The same for dots.
    radius: Option<i64>,
}

impl Writer {
    fn new() -> Self {
        let bytes = Vec::with_capacity(BUFFER + 256);
        Self { hash: Sha256::new_with_prefix(KIND), bytes, pen: None, radius: None }
    }

    fn finish(mut self) -> Fingerprint {
        self.hash.update(&self.bytes);
        Fingerprint(self.hash.finalize().into())
    }

    fn tag(&mut self, tag: Tag) {
        if self.bytes.len() >= BUFFER {
            self.hash.update(&self.bytes);
            self.bytes.clear();
        }
        self.bytes.push(tag as u8);
    }

    /// A whole number; both zeros of a coordinate are one.
    fn number(&mut self, number: i64) {
        self.bytes.extend_from_slice(&number.to_le_bytes());
    }

    fn count(&mut self, count: usize) {
        self.bytes.extend_from_slice(&(count as u64).to_le_bytes());
    }

    fn text(&mut self, text: &str) {
        self.count(text.len());
        self.bytes.extend_from_slice(text.as_bytes());
    }

    fn colour(&mut self, colour: Colour) {
        self.bytes.extend_from_slice(&[colour.r, colour.g, colour.b, colour.a]);
    }

    fn point(&mut self, point: Point) {
        self.number(thousandths(point.x));
        self.number(thousandths(point.y));
    }

    fn points(&mut self, points: &[Point]) {
        self.count(points.len());
        points.iter().for_each(|&point| self.point(point));
    }

    fn page(&mut self, page: &Page) {
        let Page { width, height, bleed, pixels, dpi, paper, depth } = page;
        self.tag(Tag::Page);
        for length in [width, height, bleed] {
            self.number(rounded(*length));
        }
        for side in pixels {
            self.number(i64::from(*side));
        }
        self.number(thousandths(*dpi));
        self.bytes.push(u8::from(paper.is_some()));
        paper.iter().for_each(|&paper| self.colour(paper));
        self.bytes.push(match depth {
            Depth::One => 1,
            Depth::Eight => 8,
        });
    }

    fn layer(&mut self, layer: &Layer) {
        let Layer { groups, name: _, ink, areas, strokes, tapers, dots } = layer;
        self.tag(Tag::Layer);
        (self.pen, self.radius) = (None, None);
        self.count(groups.len());
        groups.iter().for_each(|group| self.text(group));
        self.colour(*ink);
        for area in areas {
            self.tag(Tag::Area);
            self.count(area.len());
            area.iter().for_each(|ring| self.points(ring));
        }
        strokes.iter().for_each(|strokes| self.strokes(strokes));
        for (spine, widths) in tapers.iter() {
            self.tag(Tag::Taper);
            self.points(spine);
            widths.iter().for_each(|&width| self.number(thousandths(width)));
        }
        dots.iter().for_each(|dots| self.dots(dots));
    }

    fn strokes(&mut self, strokes: &Strokes) {
        let Strokes { pen, cap, lines, bundle_ends: _, polylines, curves } = strokes;
        if lines.is_empty() && polylines.is_empty() && curves.is_empty() {
            return;
        }
        let pen = (rounded(*pen), *cap);
        if self.pen.replace(pen) != Some(pen) {
            self.tag(Tag::Pen);
            self.number(pen.0);
            self.bytes.push(match pen.1 {
                Cap::Butt => 0,
                Cap::Round => 1,
            });
        }
        for &[from, to] in lines {
            self.tag(Tag::Line);
            self.point(from);
            self.point(to);
        }
        for polyline in polylines {
            self.tag(Tag::Polyline);
            self.points(polyline);
        }
        for curve in curves.iter() {
            self.tag(Tag::Curve);
            self.points(curve);
        }
    }

    fn dots(&mut self, dots: &Dots) {
        let Dots { radius, centres, bundle_ends: _ } = dots;
        if centres.is_empty() {
            return;
        }
        let radius = rounded(*radius);
        if self.radius.replace(radius) != Some(radius) {
            self.tag(Tag::Radius);
            self.number(radius);
        }
        for &centre in centres {
            self.tag(Tag::Dot);
            self.point(centre);
        }
    }
}

fn rounded(length: Length) -> i64 {
    thousandths(length.to_mm())
}

/// A whole number of thousandths, halves away from zero. What is beyond all paper is as far away as can be said.
fn thousandths(value: f64) -> i64 {
    (value * 1000.0).round() as i64
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::back::samples::{layer, lines, page, ring, scattered};
    use crate::loader::MemoryLoader;
    use crate::{Config, compile};

    fn one(layer: Layer) -> Drawing {
        Drawing { page: page(20.0, 20.0), layers: vec![layer] }
    }

    fn of(text: &str) -> Fingerprint {
        let mut loader = MemoryLoader::default();
        loader.files.insert("scene.kake".to_owned(), text.as_bytes().into());
        fingerprint(&compile("scene.kake", &loader, &Config::default(), &mut ()).drawing.unwrap())
    }

    #[test]
    fn comments_order_and_layout_change_nothing() {
        let plain = "canvas { size: (20mm, 20mm) } seed 3
            tone a(tile: length = 4mm) { place: poisson(radius: tile) fill: lines(pitch: 0.8mm) k: 2 }
            fn twice(x) = 2 * x
            paint canvas with a(tile: twice(2mm))";
        let dressed = "// A swatch.
            fn twice(x) = 2
                * x /* as it says */
            canvas { size: (2cm, 20mm), paper: #ffffff }
            seed 3
            /// With a comment.
            tone a(tile: length = 4mm) { k: 2, fill: lines(pitch: 0.8mm), place: poisson(radius: tile) }
            paint canvas with a(tile: twice(2mm))";
        assert_eq!(of(plain), of(dressed));
        assert_ne!(of(plain), of(&plain.replace("seed 3", "seed 4")));
        assert_ne!(of(plain), of(&plain.replace("0.8mm", "0.5mm")));
        assert_ne!(of(plain), of(&plain.replace("canvas {", "canvas { ink: #000001 ")));
        assert_ne!(of(plain), of(&plain.replace("(20mm, 20mm)", "(20mm, 20.1mm)")));
    }

    #[test]
    fn a_known_drawing_keeps_its_fingerprint() {
        // Pins of libraries hold these texts: this may change only together with KIND.
        let found = fingerprint(&scattered(20.0, 20.0, 30)).to_string();
        assert_eq!(found, "sha256:2ba291461f2b906000083c3b3536a2d7041fc4a75a2507e712d3846a60b4a13f");
    }

    #[test]
    fn both_zeros_are_one() {
        let line = |x: f64| {
            one(Layer { strokes: vec![lines(0.2, Cap::Butt, &[&[[(x, 1.0), (2.0, x)]]])], ..layer("a", Colour::BLACK) })
        };
        assert_eq!(fingerprint(&line(0.0)), fingerprint(&line(-0.0)));
        assert_eq!(fingerprint(&line(0.0)), fingerprint(&line(-0.0004)));
    }

    #[test]
    fn names_are_no_part_of_it_but_groups_are() {
        let with = |groups: &[&str], name: &str| {
            let strokes = vec![lines(0.2, Cap::Butt, &[&[[(0.0, 1.0), (2.0, 1.0)]]])];
            let mut layer = Layer { strokes, ..layer(name, Colour::BLACK) };
            layer.groups = groups.iter().map(|&group| group.to_owned()).collect();
            fingerprint(&one(layer))
        };
        assert_eq!(with(&[], "sky"), with(&[], "sea"));
        assert_ne!(with(&["ab", "c"], "sky"), with(&["a", "bc"], "sky"));
    }

    #[test]
    fn a_layer_without_marks_is_nothing() {
        let drawing = scattered(20.0, 20.0, 30);
        let mut more = drawing.clone();
        more.layers.insert(1, layer("empty", Colour::WHITE));
        assert_eq!(fingerprint(&drawing), fingerprint(&more));
    }

    #[test]
    fn lists_of_one_pen_are_as_one() {
        let (a, b) = ([(0.0, 0.0), (1.0, 1.0)], [(2.0, 0.0), (3.0, 1.0)]);
        let with = |strokes| fingerprint(&one(Layer { strokes, ..layer("a", Colour::BLACK) }));
        let whole = with(vec![lines(0.2, Cap::Butt, &[&[a, b]])]);
        assert_eq!(whole, with(vec![lines(0.2, Cap::Butt, &[&[a], &[b]])]));
        assert_eq!(whole, with(vec![lines(0.2, Cap::Butt, &[&[a]]), lines(0.2, Cap::Butt, &[&[b]])]));
        assert_ne!(whole, with(vec![lines(0.2, Cap::Butt, &[&[a]]), lines(0.2, Cap::Round, &[&[b]])]));
        assert_ne!(whole, with(vec![lines(0.2, Cap::Butt, &[&[b, a]])]));
        let dots = |lists: &[&[(f64, f64)]]| {
            let dots = lists.iter().map(|&centres| {
                let centres = ring(centres);
                Dots { radius: Length::mm(0.3), bundle_ends: vec![centres.len()], centres }
            });
            fingerprint(&one(Layer { dots: dots.collect(), ..layer("a", Colour::BLACK) }))
        };
        assert_eq!(dots(&[&a, &b]), dots(&[&[a[0], a[1], b[0], b[1]]]));
    }

    proptest! {
        #[test]
        fn any_mark_that_moves_is_seen(bundle in 0usize..400, far in prop_oneof![Just(0.01), Just(-0.01), 0.002..5.0f64]) {
            let drawing = scattered(40.0, 40.0, 400);
            let mut moved = drawing.clone();
            let [black, red] = &mut moved.layers[..] else { unreachable!() };
            let x = match bundle % 7 {
                at @ 0..=1 => { let i = bundle % black.strokes[at].lines.len(); &mut black.strokes[at].lines[i][1].x }
                2 => { let i = bundle % black.dots[0].centres.len(); &mut black.dots[0].centres[i].x }
                3 => { let i = bundle % black.strokes[1].polylines.len(); &mut black.strokes[1].polylines[i][4].x }
                4 => { let i = bundle % red.areas.len(); &mut red.areas[i][0][2].x }
                5 => &mut black.strokes[0].curves.points_mut().nth(bundle).unwrap().x,
                _ => &mut red.tapers.spines.points_mut().nth(bundle).unwrap().x,
            };
            *x += far;
            prop_assert_ne!(fingerprint(&drawing), fingerprint(&moved));
        }

        #[test]
        fn bundles_do_not_matter(ends in prop::collection::vec(1usize..100, 0..9)) {
            let drawing = scattered(40.0, 40.0, 100);
            let mut other = drawing.clone();
            for strokes in &mut other.layers[0].strokes {
                let all = strokes.lines.len();
                strokes.bundle_ends = ends.iter().map(|&end| end.min(all)).chain([all]).collect();
                strokes.bundle_ends.sort_unstable();
                strokes.bundle_ends.dedup();
            }
            prop_assert_eq!(fingerprint(&drawing), fingerprint(&other));
        }
    }
}
