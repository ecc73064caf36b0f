//! The drawing as JSON: layers of strokes, dots and areas in millimetres at full precision.
//!
//! Every stroke has `points`, also a curved one, for which they are lines within 0.005 mm of it and `curve` has its
//! Béziers. A stroke that changes its width has `widths` at the joints of its `curve`, and its greatest as `pen`. All is written as it is walked, so that a large drawing is never held as text.

use std::borrow::Cow;
use std::io::{self, Write};

use serde::Serialize;
use serde::ser::{SerializeStruct, Serializer};

use crate::drawing::{Drawing, Layer};
use crate::geom::bezier::flatten;
use crate::geom::{Length, Point};
use crate::scene::Cap;

/// How far the points of a curved stroke may stray from it.
const FLATTENING: Length = Length::mm(0.005);

/// Writes `{"layers":[…]}` and a line end.
///
/// # Errors
/// What `out` answers.
pub fn write(drawing: &Drawing, out: &mut dyn Write) -> io::Result<()> {
    let mut out = io::BufWriter::new(out);
    let mut serializer = serde_json::Serializer::new(&mut out);
    let mut object = serializer.serialize_struct("Drawing", 1)?;
    object.serialize_field("layers", &Each(|| drawing.layers.iter().map(LayerJson)))?;
    SerializeStruct::end(object)?;
    out.write_all(b"\n")?;
    out.flush()
}

/// A list that is made while it is written.
struct Each<F>(F);

impl<F, I> Serialize for Each<F>
where
    F: Fn() -> I,
    I: Iterator,
    I::Item: Serialize,
{
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq((self.0)())
    }
}

struct LayerJson<'a>(&'a Layer);

impl Serialize for LayerJson<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let layer = self.0;
        let strokes = || {
            let strokes = layer.strokes.iter().flat_map(|strokes| {
                let (pen, cap) = (strokes.pen, strokes.cap);
                let stroke = move |points| Stroke { pen, cap, points, curve: None, widths: None };
                let lines = strokes.lines.iter().map(move |line| stroke(Cow::Borrowed(line.as_slice())));
                let polylines = strokes.polylines.iter().map(move |line| stroke(Cow::Borrowed(line.as_slice())));
                let curves = strokes.curves.iter();
                let curves =
                    curves.map(move |curve| Stroke { curve: Some(curve), ..stroke(flatten(curve, FLATTENING).into()) });
                lines.chain(polylines).chain(curves)
            });
            let tapers = layer.tapers.iter().map(|(spine, widths)| Stroke {
                pen: widths.iter().fold(Length::ZERO, |widest, &width| widest.max(Length::mm(width))),
                cap: Cap::Butt,
                points: flatten(spine, FLATTENING).into(),
                curve: Some(spine),
                widths: Some(widths),
            });
            strokes.chain(tapers)
        };
        let dots = || {
            layer.dots.iter().flat_map(|dots| dots.centres.iter().map(|&centre| Dot { radius: dots.radius, centre }))
        };
        let mut object = serializer.serialize_struct("Layer", 6)?;
        object.serialize_field("name", &layer.name)?;
        object.serialize_field("ink", &layer.ink)?;
        object.serialize_field("strokes", &Each(strokes))?;
        object.serialize_field("dots", &Each(dots))?;
        object.serialize_field("areas", &layer.areas)?;
        object.serialize_field("groups", &layer.groups)?;
        object.end()
    }
}

#[derive(Serialize)]
struct Stroke<'a> {
    pen: Length,
    cap: Cap,
    points: Cow<'a, [Point]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    curve: Option<&'a [Point]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    widths: Option<&'a [f64]>,
}

#[derive(Serialize)]
struct Dot {
    radius: Length,
    centre: Point,
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::super::samples::{layer, lines, page, ring, scattered};
    use super::*;
    use crate::drawing::Dots;
    use crate::scene::Colour;

    fn text_of(drawing: &Drawing) -> String {
        let mut out = Vec::new();
        write(drawing, &mut out).unwrap();
        String::from_utf8(out).unwrap()
    }

    #[test]
    fn every_kind_of_mark() {
        let mut sky = layer("sky", Colour { r: 1, g: 2, b: 3, a: 4 });
        sky.groups.push("back".to_owned());
        sky.strokes.push(lines(0.25, Cap::Butt, &[&[[(0.1, 1.0), (1.0 / 3.0, 1.0)]]]));
        sky.strokes[0].polylines.push(ring(&[(0.0, 0.0), (1.0, 0.5), (2.0, 0.0)]));
        let bow = ring(&[(0.0, 0.0), (1.0, 0.02), (2.0, 0.02), (3.0, 0.0)]);
        sky.strokes[0].curves.push(&bow);
        sky.tapers.push(&bow, &[0.5, 0.0]);
        sky.dots.push(Dots { radius: Length::mm(0.5), centres: ring(&[(3.0, 3.5)]), bundle_ends: vec![1] });
        sky.areas.push(vec![ring(&[(4.0, 4.0), (8.0, 4.0), (8.0, 8.0)])]);
        let text = text_of(&Drawing { page: page(10.0, 10.0), layers: vec![sky] });
        let wanted = concat!(
            r##"{"layers":[{"name":"sky","ink":"#01020304","strokes":["##,
            r##"{"pen":0.25,"cap":"butt","points":[[0.1,1.0],[0.3333333333333333,1.0]]},"##,
            r##"{"pen":0.25,"cap":"butt","points":[[0.0,0.0],[1.0,0.5],[2.0,0.0]]},"##,
            r##"{"pen":0.25,"cap":"butt","points":[[0.0,0.0],[1.5,0.015],[3.0,0.0]],"##,
            r##""curve":[[0.0,0.0],[1.0,0.02],[2.0,0.02],[3.0,0.0]]},"##,
            r##"{"pen":0.5,"cap":"butt","points":[[0.0,0.0],[1.5,0.015],[3.0,0.0]],"##,
            r##""curve":[[0.0,0.0],[1.0,0.02],[2.0,0.02],[3.0,0.0]],"widths":[0.5,0.0]}],"##,
            r##""dots":[{"radius":0.5,"centre":[3.0,3.5]}],"##,
            r##""areas":[[[[4.0,4.0],[8.0,4.0],[8.0,8.0]]]],"groups":["back"]}]}"##,
            "\n"
        );
        assert_eq!(text, wanted);
    }

    #[test]
    fn reads_back_in_full() {
        let drawing = scattered(50.0, 50.0, 100);
        let read: serde_json::Value = serde_json::from_str(&text_of(&drawing)).unwrap();
        for (layer, read) in drawing.layers.iter().zip(read["layers"].as_array().unwrap()) {
            let count = |key: &str| read[key].as_array().unwrap().len() as u64;
            assert_eq!(count("strokes") + count("dots") + count("areas"), layer.marks());
        }
    }
}
