//! The drawing as JSON: layers of strokes, dots and areas in millimetres at full precision.
//!
//! It is written as it is walked, so that a large drawing is never held as text.

use std::io::{self, Write};

use serde::Serialize;
use serde::ser::{SerializeStruct, Serializer};

use crate::drawing::{Drawing, Layer};
use crate::geom::{Length, Point};
use crate::scene::Cap;

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
            layer.strokes.iter().flat_map(|strokes| {
                let stroke = |points| Stroke { pen: strokes.pen, cap: strokes.cap, points };
                let lines = strokes.lines.iter().map(move |line| stroke(line.as_slice()));
                lines.chain(strokes.polylines.iter().map(move |line| stroke(line.as_slice())))
            })
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
    points: &'a [Point],
}

#[derive(Serialize)]
struct Dot {
    radius: Length,
    centre: Point,
}
