//! Regions.

use crate::geom::{Angle, Length, Point, Vec2};
use crate::region::{PathError, PathProblem, Region, Tangled};

use super::super::call::{Call, Param, Signature, optional, required};
use super::super::convert::{Slot, coerce};
use super::super::files;
use super::super::value::{Kind, Value};
use crate::diag::{Code, Diagnostic};

const REGION: Slot = Slot::of(Kind::Region);
const POINT: Slot = Slot::of(Kind::Point);
const LENGTH: Slot = Slot::of(Kind::Length);
const STRING: Slot = Slot::of(Kind::String);
const BOX: Slot = Slot::of(Kind::Box);
const COLOUR: Slot = Slot::of(Kind::Colour);
const BORDER: Slot = Slot::words(&["open", "wall"]);

/// What can be inked.
pub(super) const DRAWINGS: &[Signature] = &[Signature {
    name: "svg",
    about: "The strokes and fills of an SVG file, in their own widths and colours.",
    result: Some(Kind::Drawing),
    params: SVG,
    build: |call| Some(Value::Drawing(files::ink(call)?.into())),
}];

/// A file and the part of it that is meant.
const SVG: &[Param] = &[
    required("file", STRING, "path from the folder of this file"),
    optional("id", STRING, "the whole file", "the element with this id"),
    optional("fit", BOX, "the file's own place", "the box that the file's page is fitted into"),
    optional("layer", STRING, "all layers", "only the Inkscape layer of this label"),
    optional("class", STRING, "all classes", "only elements of this class"),
    optional("colour", COLOUR, "all colours", "only what is filled with this colour"),
];

pub(super) const SIGNATURES: &[Signature] = &[
    Signature {
        name: "rect",
        about: "An upright rectangle.",
        result: Some(Kind::Region),
        params: &[required("at", POINT, "the top left corner"), required("size", POINT, "width and height, above 0")],
        build: |call| {
            let at = call.point("at")?;
            let size = extent(call, "size")?;
            region(Region::rect(crate::geom::Rect::new(at, at + size)))
        },
    },
    Signature {
        name: "circle",
        about: "A disc.",
        result: Some(Kind::Region),
        params: &[required("center", POINT, "the middle"), required("radius", LENGTH, "above 0")],
        build: |call| {
            let centre = call.point("center")?;
            let radius = call.positive("radius", None)?;
            region(Region::circle(centre, radius))
        },
    },
    Signature {
        name: "ellipse",
        about: "An upright ellipse.",
        result: Some(Kind::Region),
        params: &[
            required("center", POINT, "the middle"),
            required("radius", POINT, "half the width and half the height, above 0"),
        ],
        build: |call| {
            let centre = call.point("center")?;
            let radius = extent(call, "radius")?;
            region(Region::ellipse(centre, Length::mm(radius.x), Length::mm(radius.y)))
        },
    },
    Signature {
        name: "polygon",
        about: "A polygon of at least three corners.",
        result: Some(Kind::Region),
        params: &[required("corners", Slot::of(Kind::List), "the corners in order, at least three")],
        build: polygon,
    },
    Signature {
        name: "path",
        about: "What SVG path data encloses, in canvas units.",
        result: Some(Kind::Region),
        params: &[required("data", STRING, "SVG path data: `M 0 0 L 10 0 L 10 10 Z`")],
        build: path,
    },
    Signature {
        name: "svg",
        about: "Outlines of what an SVG file fills.",
        result: Some(Kind::Region),
        params: SVG,
        build: |call| not_empty(call, "the SVG file's filled shapes hold nothing", files::svg),
    },
    Signature {
        name: "flood",
        about: "What a paint bucket would fill between the lines of an SVG file.",
        result: Some(Kind::Region),
        params: &[
            required("file", STRING, "path from the folder of this file"),
            required("at", POINT, "where the paint is poured"),
            optional("close", LENGTH, "0.5mm", "gaps up to this are bridged, not negative"),
            optional("border", BORDER, "open", "whether the page's border is a line"),
            optional("fit", BOX, "the file's own place", "the box that the file's page is fitted into"),
            optional("id", STRING, "the whole file", "only lines of the element with this id"),
            optional("layer", STRING, "all layers", "only the Inkscape layer of this label"),
            optional("class", STRING, "all classes", "only elements of this class"),
            optional("colour", COLOUR, "all colours", "only what is filled with this colour"),
        ],
        build: |call| not_empty(call, "the flood fills nothing", files::flood),
    },
    Signature {
        name: "mask",
        about: "The dark part of an image, traced.",
        result: Some(Kind::Region),
        params: &[
            required("file", STRING, "path from the folder of this file"),
            optional("threshold", Slot::of(Kind::Number), "0.5", "what is darker is inside, 0 to 1 in linear light"),
            optional("fit", BOX, "the canvas", "the box that the image is fitted into"),
        ],
        build: mask,
    },
    Signature {
        name: "inset",
        about: "A region drawn in; a negative distance draws it out.",
        result: Some(Kind::Region),
        params: &[
            required("region", REGION, "the region"),
            required("distance", LENGTH, "how far, negative to draw it out"),
        ],
        build: |call| {
            let distance = Length::mm(call.get("distance")?.value.as_length()?);
            let inset = match call.region("region")?.try_inset(distance) {
                Ok(inset) => inset,
                Err(Tangled) => {
                    let message = "the outline has too many corners to be moved so far";
                    let diagnostic = Diagnostic::error(Code::Limit, call.span_of("region"), message);
                    call.cx.report_value(diagnostic.hint("simplify the outline, or move it less far"));
                    return None;
                }
            };
            if inset.is_empty() {
                let message = format!("nothing is left of the region {}mm inside its outline", distance.to_mm());
                let span = call.span;
                call.cx.report_value(Diagnostic::error(Code::EmptyRegion, span, message));
                return None;
            }
            region(inset)
        },
    },
    Signature {
        name: "translate",
        about: "A region moved.",
        result: Some(Kind::Region),
        params: &[required("region", REGION, "the region"), required("by", POINT, "the way, across and down")],
        build: |call| {
            let by = call.point("by")?;
            region(call.region("region")?.translated(Vec2::new(by.x, by.y)))
        },
    },
    Signature {
        name: "rotate",
        about: "A region turned clockwise.",
        result: Some(Kind::Region),
        params: &[
            required("region", REGION, "the region"),
            required("angle", Slot::of(Kind::Angle), "how far, clockwise on the page"),
            optional("about", POINT, "its middle", "the point that stays"),
        ],
        build: |call| {
            let base = call.region("region")?;
            let about = about(call, &base);
            let angle: Angle = call.angle("angle")?;
            region(base.rotated(angle, about))
        },
    },
    Signature {
        name: "scale",
        about: "A region made larger or smaller.",
        result: Some(Kind::Region),
        params: &[
            required("region", REGION, "the region"),
            required("factor", Slot::of(Kind::Number), "above 0"),
            optional("about", POINT, "its middle", "the point that stays"),
        ],
        build: |call| {
            let base = call.region("region")?;
            let about = about(call, &base);
            let factor = call.number("factor")?;
            if factor <= 0.0 {
                return call.refuse("factor", "`factor` must be greater than zero".to_owned());
            }
            region(base.scaled([factor, factor], about))
        },
    },
    Signature {
        name: "bounds",
        about: "The box of a region.",
        result: Some(Kind::Region),
        params: &[required("region", REGION, "the region")],
        build: |call| region(Region::rect(call.region("region")?.bounds())),
    },
];

fn region(region: Region) -> Option<Value> {
    Some(Value::Region(region))
}

/// Where a region turns or grows from: a point that is given, else the middle of its box.
fn about(call: &Call<'_, '_, '_>, base: &Region) -> Point {
    call.point("about").unwrap_or_else(|| base.bounds().centre())
}

/// A pair of lengths, both greater than zero.
fn extent(call: &mut Call<'_, '_, '_>, name: &str) -> Option<Vec2> {
    let size = call.point(name)?;
    if size.x > 0.0 && size.y > 0.0 {
        return Some(Vec2::new(size.x, size.y));
    }
    call.refuse(name, format!("both members of `{name}` must be greater than zero"))
}

fn not_empty(
    call: &mut Call<'_, '_, '_>,
    message: &str,
    make: impl FnOnce(&mut Call<'_, '_, '_>) -> Option<Region>,
) -> Option<Value> {
    let made = make(call)?;
    if made.is_empty() {
        let span = call.span;
        call.cx.report_value(Diagnostic::error(Code::EmptyRegion, span, message));
        return None;
    }
    region(made)
}

fn polygon(call: &mut Call<'_, '_, '_>) -> Option<Value> {
    let Some(Value::List(members)) = call.value("corners") else { return None };
    let span = call.span_of("corners");
    if members.len() < 3 {
        return call.refuse("corners", format!("a polygon needs at least three corners, not {}", members.len()));
    }
    let mut corners = Vec::with_capacity(members.len());
    for member in members.iter() {
        corners.push(coerce(call.cx, member.clone(), Slot::of(Kind::Point), span).as_point()?);
    }
    not_empty(call, "the polygon has no area", |call| match Region::polygon(&corners) {
        Ok(region) => Some(region),
        Err(tangled) => {
            let diagnostic = Diagnostic::error(Code::Limit, span, tangled.to_string());
            call.cx.report_value(diagnostic.hint(files::SIMPLIFY));
            None
        }
    })
}

fn path(call: &mut Call<'_, '_, '_>) -> Option<Value> {
    let Some(Value::String(data)) = call.value("data") else { return None };
    let unit = call.cx.unit_length();
    not_empty(call, "the path encloses nothing", |call| match Region::path(&data.value, unit) {
        Ok(region) => Some(region),
        Err(error) if error.problem == PathProblem::TooTangled => {
            let diagnostic = Diagnostic::error(Code::Limit, call.span_of("data"), error.to_string());
            call.cx.report_value(diagnostic.hint(files::SIMPLIFY));
            None
        }
        Err(error) => path_error(call, &data.value, &error),
    })
}

/// Says what is wrong with the path data of the argument `data`.
pub(super) fn path_error<T>(call: &mut Call<'_, '_, '_>, data: &str, error: &PathError) -> Option<T> {
    let whole = call.span_of("data");
    let mut span = whole;
    // Where the string is written without escapes its characters stand where the path's do.
    let length = u32::try_from(data.len()).unwrap_or(u32::MAX);
    if let Ok(offset) = u32::try_from(error.offset)
        && offset < length
        && whole.end - whole.start == length.saturating_add(2)
    {
        span.start = whole.start + 1 + offset;
        span.end = span.start + 1;
    }
    let diagnostic = Diagnostic::error(Code::Path, span, error.to_string());
    call.cx.report_value(diagnostic.hint("path data looks like `M 0 0 L 10 0 L 10 10 Z`"));
    None
}

fn mask(call: &mut Call<'_, '_, '_>) -> Option<Value> {
    let threshold = call.within("threshold", 0.0, 1.0, 0.5)?;
    let fit = match (call.has("fit"), call.cx.page.as_ref()) {
        (true, _) => call.area("fit")?,
        (false, Some(page)) => page.bounds(),
        (false, None) => return None,
    };
    let image = files::image(call, "luminance")?;
    not_empty(call, "no part of the image is darker than the threshold", |call| {
        match crate::field::mask(&image, threshold, fit) {
            Ok(region) => Some(region),
            Err(error) => {
                let diagnostic = Diagnostic::error(Code::Limit, call.span_of("file"), error.to_string());
                call.cx.report_value(diagnostic.hint("blur the picture or scale it down before it is traced"));
                None
            }
        }
    })
}
