//! What is drawn in tiles.

use std::rc::Rc;

use crate::geom::bezier::flatten;
use crate::geom::{Length, Point, ring_bounds};
use crate::region::{PathError, PathProblem, path};
use crate::scene::{Cap, Fill, FillKind, Hatch, MotifPath, Swing};

use super::super::call::{Call, Param, Signature, optional, required};
use super::super::convert::Slot;
use super::super::value::{Kind, Value};
use super::regions::path_error;

const LENGTH: Slot = Slot::of(Kind::Length);
const PITCH: Param = required("pitch", LENGTH, "from line to line, above 0");
const PEN: Param = optional("pen", LENGTH, "0.2mm", "width of a stroke, above 0");
const INK: Param = optional("ink", Slot::of(Kind::Colour), "the layer's", "colour of the marks");
const INSET: Param = optional(
    "inset",
    Slot::of(Kind::Number),
    "0.5",
    "where the outermost lines of a stamp lie, in steps from its edge",
);
const SHORTEST: Param = optional("shortest", LENGTH, "two pens", "pieces of strokes below it are dropped");
const CAP: Param = optional("cap", Slot::words(&["butt", "round"]), "butt", "how strokes end");
const SPACING: Param = optional("spacing", LENGTH, "the pitch", "from mark to mark along a line, above 0");
const WAVELENGTH: Param = optional("wavelength", LENGTH, "5 pitches", "length of a wave, above 0");
const AMPLITUDE: Param = optional("amplitude", LENGTH, "0.6 pitches", "swing to either side, above 0");

/// The width of a stroke where none is given: that of a fine nib.
pub(in super::super) const DEFAULT_PEN: Length = Length::mm(0.2);

/// How closely the size of a figure is measured, as a share of it.
const FIGURE: f64 = 1e-4;

pub(super) const SIGNATURES: &[Signature] = &[
    Signature {
        name: "lines",
        about: "Parallel strokes.",
        result: Some(Kind::Fill),
        params: &[PITCH, PEN, INSET, SHORTEST, CAP, INK],
        build: |call| {
            let hatch = hatch(call, DEFAULT_PEN)?;
            fill(call, FillKind::Lines(hatch))
        },
    },
    Signature {
        name: "dashes",
        about: "Strokes with gaps, set like bricks.",
        result: Some(Kind::Fill),
        params: &[
            PITCH,
            PEN,
            required("dash", LENGTH, "length of a dash, above 0"),
            optional("gap", LENGTH, "the dash", "from dash to dash, above 0"),
            INSET,
            SHORTEST,
            CAP,
            INK,
        ],
        build: |call| {
            let hatch = hatch(call, DEFAULT_PEN);
            let dash = call.positive("dash", None);
            let gap = call.positive("gap", dash.or(Some(DEFAULT_PEN)));
            fill(call, FillKind::Dashes { hatch: hatch?, dash: dash?, gap: gap? })
        },
    },
    Signature {
        name: "dots",
        about: "Dots along the lines of a hatch.",
        result: Some(Kind::Fill),
        params: &[
            PITCH,
            SPACING,
            optional("radius", LENGTH, "half the pen", "radius of a dot, above 0"),
            PEN,
            INSET,
            INK,
        ],
        build: |call| {
            // A dot without a radius is the touch of the pen.
            let pen = if call.has("radius") { DEFAULT_PEN } else { call.positive("pen", Some(DEFAULT_PEN))? };
            let radius = call.positive("radius", Some(pen / 2.0));
            let hatch = hatch(call, radius.map_or(pen, |radius| radius * 2.0));
            let pitch = hatch.map_or(pen, |hatch| hatch.pitch);
            let spacing = call.positive("spacing", Some(pitch));
            fill(call, FillKind::Dots { hatch: hatch?, spacing: spacing?, radius: radius? })
        },
    },
    Signature {
        name: "crosses",
        about: "Crosses along the lines of a hatch.",
        result: Some(Kind::Fill),
        params: &[
            PITCH,
            PEN,
            SPACING,
            optional("size", LENGTH, "2/3 of pitch or spacing", "length of an arm from tip to tip, above 0"),
            INSET,
            SHORTEST,
            CAP,
            INK,
        ],
        build: |call| {
            let hatch = hatch(call, DEFAULT_PEN);
            let pitch = hatch.map_or(DEFAULT_PEN, |hatch| hatch.pitch);
            let spacing = call.positive("spacing", Some(pitch));
            // Apart from each other, so that they do not close to a net.
            let size = call.positive("size", Some(pitch.min(spacing.unwrap_or(pitch)) * (2.0 / 3.0)));
            fill(call, FillKind::Crosses { hatch: hatch?, spacing: spacing?, size: size? })
        },
    },
    Signature {
        name: "arcs",
        about: "Arcs about a place on the tile's edge, like scales.",
        result: Some(Kind::Fill),
        params: &[PITCH, PEN, INSET, SHORTEST, CAP, INK],
        build: |call| {
            let hatch = hatch(call, DEFAULT_PEN)?;
            fill(call, FillKind::Arcs(hatch))
        },
    },
    Signature {
        name: "waves",
        about: "Sine waves about the lines of a hatch.",
        result: Some(Kind::Fill),
        params: &[PITCH, PEN, WAVELENGTH, AMPLITUDE, INSET, SHORTEST, CAP, INK],
        build: |call| {
            let hatch = hatch(call, DEFAULT_PEN);
            let swing = swing(call, hatch, 5.0, 0.6);
            fill(call, FillKind::Waves { hatch: hatch?, swing: swing? })
        },
    },
    Signature {
        name: "scribble",
        about: "Rows of loops, as a loose hand draws them.",
        result: Some(Kind::Fill),
        params: &[
            PITCH,
            PEN,
            optional("loop", LENGTH, "1.25 pitches", "height of the loops, above 0"),
            optional("spacing", LENGTH, "0.9 loops", "from loop to loop along a line, above 0"),
            INSET,
            SHORTEST,
            CAP,
            INK,
        ],
        build: |call| {
            let hatch = hatch(call, DEFAULT_PEN);
            let pitch = hatch.map_or(DEFAULT_PEN, |hatch| hatch.pitch);
            // Rows of loops reach into each other.
            let loops = call.positive("loop", Some(pitch * 1.25));
            let spacing = call.positive("spacing", Some(loops.unwrap_or(pitch) * 0.9));
            fill(call, FillKind::Scribble { hatch: hatch?, loops: loops?, spacing: spacing? })
        },
    },
    Signature {
        name: "nawaami",
        about: "Strands of rope: strokes that swing together and draw together as the tile does.",
        result: Some(Kind::Fill),
        params: &[
            PITCH,
            PEN,
            optional("wavelength", LENGTH, "16 pitches", "length of a wave, above 0"),
            optional("amplitude", LENGTH, "0.8 pitches", "swing to either side, above 0"),
            INSET,
            SHORTEST,
            CAP,
            INK,
        ],
        build: |call| {
            let hatch = hatch(call, DEFAULT_PEN);
            let swing = swing(call, hatch, 16.0, 0.8);
            fill(call, FillKind::Nawaami { hatch: hatch?, swing: swing? })
        },
    },
    Signature {
        name: "motif",
        about: "A figure along the lines, drawn by SVG path data.",
        result: Some(Kind::Fill),
        params: &[
            required("data", Slot::of(Kind::String), "SVG path data; its x runs along the lines"),
            required("size", LENGTH, "longer side of the figure's box, above 0"),
            optional("spacing", LENGTH, "1.25 sizes", "from figure to figure along a line, above 0"),
            optional("pitch", LENGTH, "the spacing", "from row to row, above 0"),
            PEN,
            INSET,
            SHORTEST,
            CAP,
            INK,
        ],
        build: |call| {
            let size = call.positive("size", None);
            // A little apart from each other, in rows as far apart as they are in a row.
            let spacing = call.positive("spacing", Some(size.unwrap_or(DEFAULT_PEN) * 1.25));
            let hatch = hatch_of(call, Some(spacing.unwrap_or(DEFAULT_PEN)), DEFAULT_PEN);
            let figure = figure(call, size.unwrap_or(DEFAULT_PEN));
            fill(call, FillKind::Motif { hatch: hatch?, spacing: spacing?, figure: figure? }).filter(|_| size.is_some())
        },
    },
    Signature {
        name: "solid",
        about: "The whole tile, inked all over.",
        result: Some(Kind::Fill),
        params: &[INK, PEN],
        build: |call| {
            call.positive("pen", Some(DEFAULT_PEN))?;
            fill(call, FillKind::Solid)
        },
    },
];

fn fill(call: &Call<'_, '_, '_>, kind: FillKind) -> Option<Value> {
    let ink = match call.value("ink") {
        Some(Value::Colour(ink)) => Some(ink),
        _ => None,
    };
    Some(Value::Fill(Rc::new(Fill { kind, ink })))
}

fn hatch(call: &mut Call<'_, '_, '_>, pen: Length) -> Option<Hatch> {
    hatch_of(call, None, pen)
}

/// The lines of a fill; `pitch` and `pen` are taken where none is given.
fn hatch_of(call: &mut Call<'_, '_, '_>, pitch: Option<Length>, pen: Length) -> Option<Hatch> {
    // Arguments are all looked at before any is given up, so that each one's mistake is told.
    let pitch = call.positive("pitch", pitch);
    let pen = call.positive("pen", Some(pen));
    let inset = call.within("inset", 0.0, f64::INFINITY, 0.5);
    // Shorter than two pens a stroke is a crumb rather than a line.
    let shortest = call.not_negative("shortest", pen.unwrap_or(DEFAULT_PEN) * 2.0);
    let cap = match call.word("cap") {
        Some("round") => Cap::Round,
        _ => Cap::Butt,
    };
    Some(Hatch { pitch: pitch?, pen: pen?, inset: inset?, shortest: shortest?, cap })
}

/// How waves swing: as given, or in so many pitches.
fn swing(call: &mut Call<'_, '_, '_>, hatch: Option<Hatch>, wavelength: f64, amplitude: f64) -> Option<Swing> {
    let pitch = hatch.map_or(DEFAULT_PEN, |hatch| hatch.pitch);
    let wavelength = call.positive("wavelength", Some(pitch * wavelength));
    let amplitude = call.positive("amplitude", Some(pitch * amplitude));
    Some(Swing { wavelength: wavelength?, amplitude: amplitude? })
}

/// The figure of a motif, its longer side so long and its middle at zero.
fn figure(call: &mut Call<'_, '_, '_>, size: Length) -> Option<MotifPath> {
    let Some(Value::String(data)) = call.value("data") else { return None };
    let chains = match path::chains(&data.value, Length::mm(1.0)) {
        Ok(chains) => chains,
        Err(error) => return path_error(call, &data.value, &error),
    };
    let points: Vec<Point> = chains.iter().flatten().copied().collect();
    let extent = |points: &[Point]| {
        let bounds = ring_bounds(points);
        (bounds.width().max(bounds.height()), bounds.centre())
    };
    // Curves keep within their control points, but seldom reach them.
    let (outer, _) = extent(&points);
    let lines: Vec<Point> = chains.iter().flat_map(|chain| flatten(chain, Length::mm(outer * FIGURE))).collect();
    let (side, centre) = extent(&lines);
    if !(side.is_finite() && centre.x.is_finite() && centre.y.is_finite()) {
        return path_error(call, &data.value, &PathError { offset: 0, problem: PathProblem::TooLarge });
    }
    let scale = size.to_mm() / side;
    let place = |p: Point| Point::default() + (p - centre) * scale;
    Some(MotifPath(chains.into_iter().map(|chain| chain.into_iter().map(place).collect()).collect()))
}
