//! Placements and angle rules.

use std::rc::Rc;

use crate::geom::Length;
use crate::scene::{Amount, AngleRule, Bfs, GridSize, Placement, See, Start, Tuned};

use super::super::call::{Call, Signature, optional, required};
use super::super::convert::{Slot, coerce};
use super::super::value::{FieldUnit, Kind, TypedField, Value};
use crate::diag::{Code, Diagnostic};
use crate::field::Field;

const LENGTH: Slot = Slot::of(Kind::Length);
const NUMBER: Slot = Slot::of(Kind::Number);
const FIELD: Slot = Slot::of(Kind::Field);
const SEE: Slot = Slot::words(&["primary", "layers"]);
const START: Slot = Slot::words(&["first", "random"]);

/// The most rows, columns, candidates and tries that are sensible; tiles have a limit of their own.
const MANY: u32 = 1_000_000;

/// The most rounds of relaxation: long before, sites have all but come to rest.
const MOST_ROUNDS: u32 = 1000;

/// The greatest weight of what angles are tuned to: more leaves nothing of the others.
const GREATEST_WEIGHT: f64 = 100.0;

/// The most rounds of tuning.
const MOST_TUNING: u32 = 10_000;

/// Rounds of relaxation after which sites look even.
const DEFAULT_ROUNDS: u32 = 5;

pub(super) const SIGNATURES: &[Signature] = &[
    Signature {
        name: "poisson",
        about: "Poisson-disk sampling: evenly random sites, no two closer than the radius.",
        result: Some(Kind::Placement),
        params: &[
            required("radius", LENGTH, "least distance of two sites, above 0"),
            optional("tries", NUMBER, "30", "candidates for every site, 1 to 10,000"),
            optional("density", FIELD, "1", "from 0 to 1: where it is d the radius is `radius / sqrt(d)`"),
        ],
        build: poisson,
    },
    Signature {
        name: "uniform",
        about: "Independent random sites: a count, as many as another placement finds, or a density.",
        result: Some(Kind::Placement),
        params: &[
            optional("count", Slot::ANY, "from density", "how many sites, or a placement that finds as many"),
            optional("density", FIELD, "even", "a weight, or without a count points per square canvas unit"),
        ],
        build: uniform,
    },
    Signature {
        name: "grid",
        about: "A square lattice: a spacing, or so many columns and rows over the region's box.",
        result: Some(Kind::Placement),
        params: &[
            optional("spacing", LENGTH, "from columns and rows", "from site to site, above 0"),
            optional("columns", NUMBER, "from spacing", "cells across the region's box, a whole number"),
            optional("rows", NUMBER, "from spacing", "cells down the region's box, a whole number"),
        ],
        build: grid,
    },
    Signature {
        name: "hex",
        about: "Rows of sites, every other one moved by half a spacing.",
        result: Some(Kind::Placement),
        params: &[required("spacing", LENGTH, "from site to site, above 0")],
        build: |call| {
            let spacing = call.positive("spacing", None)?;
            placement(Placement::Hex { spacing })
        },
    },
    Signature {
        name: "triangles",
        about: "Equilateral triangles in strips.",
        result: Some(Kind::Placement),
        params: &[required("edge", LENGTH, "length of a tile's edge, above 0")],
        build: |call| {
            let edge = call.positive("edge", None)?;
            placement(Placement::Triangles { edge })
        },
    },
    Signature {
        name: "penrose",
        about: "Penrose's thick and thin rhombs (P3).",
        result: Some(Kind::Placement),
        params: &[required("edge", LENGTH, "length of a tile's edge, above 0")],
        build: |call| {
            let edge = call.positive("edge", None)?;
            placement(Placement::Penrose { edge })
        },
    },
    Signature {
        name: "pinwheel",
        about: "The pinwheel tiling of Conway and Radin, with edges in ever more directions.",
        result: Some(Kind::Placement),
        params: &[required("edge", LENGTH, "shorter leg of a triangle, above 0")],
        build: |call| {
            let edge = call.positive("edge", None)?;
            placement(Placement::Pinwheel { edge })
        },
    },
    Signature {
        name: "relaxed",
        about: "The sites of another placement, moved towards the middles of their cells (Lloyd).",
        result: Some(Kind::Placement),
        params: &[
            required("placement", Slot::of(Kind::Placement), "the placement whose sites are moved"),
            optional("rounds", NUMBER, "5", "how often sites are moved, 0 to 1000"),
        ],
        build: |call| {
            let rounds = call.whole("rounds", 0, MOST_ROUNDS, Some(DEFAULT_ROUNDS))?;
            let Some(Value::Placement(inner)) = call.value("placement") else { return None };
            placement(Placement::Relaxed { placement: Box::new((*inner).clone()), rounds })
        },
    },
    Signature {
        name: "points",
        about: "Sites that are given, in their order.",
        result: Some(Kind::Placement),
        params: &[required("at", Slot::of(Kind::List), "the sites, in their order")],
        build: points,
    },
];

pub(super) const ANGLES: &[Signature] = &[
    Signature {
        name: "bfs",
        about: "Breadth first: every tile takes the angle farthest from those of its placed neighbours.",
        result: Some(Kind::Angles),
        params: &[
            optional("candidates", NUMBER, "360", "into how many steps half a turn is divided, 2 or more"),
            optional("see", SEE, "primary", "what is looked at: the first layer of every tile, or all of them"),
            optional("start", START, "first", "whether the first tile lies along x or anywhere"),
        ],
        build: |call| {
            let candidates = call.whole("candidates", 2, MANY, Some(Bfs::default().candidates))?;
            angles(AngleRule::Bfs(Bfs { candidates, see: see(call), start: start(call) }))
        },
    },
    Signature {
        name: "tuned",
        about: "From `bfs` on by small moves to contrast, many directions and no repetition together.",
        result: Some(Kind::Angles),
        params: &[
            optional("contrast", NUMBER, "1", "weight of the contrast between neighbours, 0 to 100"),
            optional("diversity", NUMBER, "1", "weight of using all directions evenly, 0 to 100"),
            optional("grain", NUMBER, "1", "weight of angles not coming again two and three tiles away, 0 to 100"),
            optional("rounds", NUMBER, "300", "how often every tile is looked at, 0 to 10,000"),
            optional("least", NUMBER, "0.39", "contrast that no two neighbours should lie below, 0 to 1"),
            optional("candidates", NUMBER, "360", "into how many steps half a turn is divided, 2 or more"),
            optional("see", SEE, "primary", "what is looked at: the first layer of every tile, or all of them"),
            optional("start", START, "first", "whether the first tile lies along x or anywhere"),
        ],
        build: tuned,
    },
    Signature {
        name: "coloured",
        about: "A few directions, equal steps apart, no two neighbours alike.",
        result: Some(Kind::Angles),
        params: &[optional("colours", NUMBER, "4", "how many directions, 2 to 12")],
        build: |call| {
            let colours = call.whole("colours", 2, AngleRule::MOST_COLOURS, Some(4))?;
            angles(AngleRule::Coloured { colours })
        },
    },
    Signature {
        name: "random",
        about: "Angles that are independent and uniform.",
        result: Some(Kind::Angles),
        params: &[],
        build: |_| angles(AngleRule::Random),
    },
    Signature {
        name: "checkerboard",
        about: "0 and 90 degrees by turns, on a `grid` only.",
        result: Some(Kind::Angles),
        params: &[],
        build: |_| angles(AngleRule::Checkerboard),
    },
    Signature {
        name: "fixed",
        about: "All tiles at one angle.",
        result: Some(Kind::Angles),
        params: &[required("angle", Slot::of(Kind::Angle), "the angle, from +x towards +y")],
        build: |call| angles(AngleRule::Fixed(call.angle("angle")?)),
    },
    Signature {
        name: "along",
        about: "The angle that a field has at the tile.",
        result: Some(Kind::Angles),
        params: &[required("field", FIELD, "a field of angles")],
        build: |call| match call.value("field")? {
            Value::Field(TypedField { field, unit: FieldUnit::Angle }) => angles(AngleRule::Along(field)),
            Value::Field(field) => {
                let message = format!("`along` takes a field of angles, not {}", field.unit.noun());
                let span = call.span_of("field");
                let hint = "multiply by an angle: `f * 180deg`";
                call.cx.report(Diagnostic::error(Code::Type, span, message).hint(hint));
                None
            }
            _ => None,
        },
    },
];

fn placement(placement: Placement) -> Option<Value> {
    Some(Value::Placement(Rc::new(placement)))
}

fn angles(rule: AngleRule) -> Option<Value> {
    Some(Value::Angles(Rc::new(rule)))
}

fn see(call: &Call<'_, '_, '_>) -> See {
    match call.word("see") {
        Some("layers") => See::Layers,
        _ => See::Primary,
    }
}

fn start(call: &Call<'_, '_, '_>) -> Start {
    match call.word("start") {
        Some("random") => Start::Random,
        _ => Start::First,
    }
}

fn tuned(call: &mut Call<'_, '_, '_>) -> Option<Value> {
    let usual = Tuned::default();
    let mut weight = |name, usual| call.within(name, 0.0, GREATEST_WEIGHT, usual);
    let contrast = weight("contrast", usual.contrast);
    let diversity = weight("diversity", usual.diversity);
    let grain = weight("grain", usual.grain);
    let least = call.within("least", 0.0, 1.0, usual.least);
    let rounds = call.whole("rounds", 0, MOST_TUNING, Some(usual.rounds));
    let candidates = call.whole("candidates", 2, Tuned::MOST_CANDIDATES, Some(usual.candidates));
    angles(AngleRule::Tuned(Tuned {
        contrast: contrast?,
        diversity: diversity?,
        grain: grain?,
        least: least?,
        rounds: rounds?,
        candidates: candidates?,
        see: see(call),
        start: start(call),
    }))
}

fn poisson(call: &mut Call<'_, '_, '_>) -> Option<Value> {
    // Arguments are all looked at before any is given up, so that each one's mistake is told.
    let radius = call.positive("radius", None);
    let tries = call.whole("tries", 1, 10_000, Some(30));
    let density = if call.has("density") { Some(call.number_field("density")?) } else { None };
    placement(Placement::Poisson { radius: radius?, tries: tries?, density })
}

fn uniform(call: &mut Call<'_, '_, '_>) -> Option<Value> {
    let density: Option<Field> = if call.has("density") { Some(call.number_field("density")?) } else { None };
    let amount = match (call.get("count").cloned(), density) {
        (None, None) => {
            let message = "`uniform` needs `count` or `density`";
            call.cx.report(Diagnostic::error(Code::Missing, call.span, message));
            return None;
        }
        (None, Some(density)) => Amount::Density { density, unit: Length::mm(call.cx.unit) },
        (Some(given), density) => match given.value {
            Value::Placement(placement) if density.is_none() => Amount::AsMany(Box::new((*placement).clone())),
            Value::Placement(_) => {
                let message = "`density` does not go with the count of another placement";
                call.cx.report(Diagnostic::error(Code::Type, call.span_of("density"), message));
                return None;
            }
            value => {
                // Anything but a placement is held to a number, which says what is wrong with the rest.
                coerce(call.cx, value, Slot::of(Kind::Number), given.span).number()?;
                let count = call.whole("count", 1, u32::MAX, None)?;
                Amount::Count { count, density }
            }
        },
    };
    placement(Placement::Uniform { amount })
}

fn grid(call: &mut Call<'_, '_, '_>) -> Option<Value> {
    let cells = (call.has("columns"), call.has("rows"));
    let size = match (call.has("spacing"), cells) {
        (true, (false, false)) => GridSize::Spacing(call.positive("spacing", None)?),
        (false, (true, true)) => {
            let columns = call.whole("columns", 1, MANY, None);
            let rows = call.whole("rows", 1, MANY, None);
            GridSize::Cells { columns: columns?, rows: rows? }
        }
        (true, _) => {
            let message = "`grid` takes `spacing`, or `columns` and `rows`, not both";
            call.cx.report(Diagnostic::error(Code::Duplicate, call.span, message));
            return None;
        }
        (false, _) => {
            let message = "`grid` needs `spacing`, or both `columns` and `rows`";
            call.cx.report(Diagnostic::error(Code::Missing, call.span, message));
            return None;
        }
    };
    placement(Placement::Grid(size))
}

fn points(call: &mut Call<'_, '_, '_>) -> Option<Value> {
    let Some(Value::List(members)) = call.value("at") else { return None };
    let span = call.span_of("at");
    if members.is_empty() {
        return call.refuse("at", "`points` needs at least one point".to_owned());
    }
    let mut points = Vec::with_capacity(members.len());
    for member in members.iter() {
        points.push(coerce(call.cx, member.clone(), Slot::of(Kind::Point), span).as_point()?);
    }
    placement(Placement::Points(points))
}
