//! The vocabulary: every name that the language brings with it, and the places where each is known.

mod directions;
mod fields;
mod fills;
mod gradients;
mod hands;
mod images;
mod mathematics;
mod placements;
mod regions;
mod shapes;

pub(super) use fills::DEFAULT_PEN;

use crate::scene::Colour;
use crate::span::Span;
use crate::syntax::ast::Argument;

use super::call::{self, Signature};
use super::convert::Slot;
use super::cx::Cx;
use super::value::{FieldUnit, Kind, TypedField, Value};
use crate::field::{Field, Node};

/// Every table of signatures with the kind of place that it belongs to.
const TABLES: [(Option<Kind>, &[Signature]); 9] = [
    (Some(Kind::Region), regions::SIGNATURES),
    (Some(Kind::Field), fields::SIGNATURES),
    (Some(Kind::Placement), placements::SIGNATURES),
    (Some(Kind::Angles), placements::ANGLES),
    (Some(Kind::Shape), shapes::SIGNATURES),
    (Some(Kind::Fill), fills::SIGNATURES),
    (Some(Kind::Hand), hands::SIGNATURES),
    (Some(Kind::Drawing), regions::DRAWINGS),
    (None, mathematics::SIGNATURES),
];

/// The signature of a name where it is called. Of names with two meanings the place decides, then the arguments.
pub(super) fn find(name: &str, slot: Slot, arguments: &[Argument]) -> Option<&'static Signature> {
    let placed = arguments.iter().any(|a| a.name.as_ref().is_some_and(|name| name.name == "at"));
    find_named(name, slot, placed)
}

/// The same where it is only known whether an argument `at` is given.
pub(super) fn find_named(name: &str, slot: Slot, placed: bool) -> Option<&'static Signature> {
    // `rect` with `at` is a region, otherwise a stamp.
    let wanted = if name == "rect" && placed { Some(Kind::Region) } else { slot.kind };
    let in_table = |(_, table): &(Option<Kind>, &'static [Signature])| table.iter().find(|s| s.name == name);
    let fitting = TABLES.iter().filter(|(kind, _)| kind.is_some() && *kind == wanted).find_map(in_table);
    // A region's rectangle stands only where a region is asked for.
    let others = || TABLES.iter().filter(|(kind, _)| name != "rect" || *kind == Some(Kind::Shape)).find_map(in_table);
    fitting.or_else(others)
}

/// Every signature.
pub(super) fn all() -> impl Iterator<Item = &'static Signature> {
    TABLES.into_iter().flat_map(|(_, table)| table)
}

/// What may be called in a slot: what gives its kind, then mathematics where it may yield that.
pub(super) fn offered(slot: Slot) -> Vec<&'static Signature> {
    let yields = |kind: Option<Kind>| match (kind, slot.kind) {
        (Some(_), None) => kind != Some(Kind::Drawing),
        (Some(_), _) => kind == slot.kind,
        (None, wanted) => {
            matches!(
                wanted,
                None | Some(Kind::Number | Kind::Length | Kind::Angle | Kind::Percentage | Kind::Field | Kind::Point)
            )
        }
    };
    TABLES.iter().filter(|(kind, _)| yields(*kind)).flat_map(|(_, table)| table.iter()).collect()
}

/// Every name that can be called.
pub(super) fn callables() -> impl Iterator<Item = &'static str> {
    all().map(|signature| signature.name)
}

/// The names that can be called where values of one kind of the scene's own are asked for.
pub(super) fn fitting(slot: Slot) -> Vec<&'static str> {
    let fits = |kind: Option<Kind>| match kind {
        Some(_) => kind == slot.kind,
        // Mathematics yields fields of fields.
        None => slot.kind == Some(Kind::Field),
    };
    let tables = TABLES.iter().filter(|(kind, _)| fits(*kind));
    tables.flat_map(|(_, table)| table.iter().map(|signature| signature.name)).collect()
}

/// The names that a place knows besides its own words.
pub(super) fn names(slot: Slot) -> Vec<&'static str> {
    let mut names = vec!["pi", "tau", "canvas"];
    if slot.kind == Some(Kind::Field) {
        names.extend(["x", "y"]);
    }
    let fitting = TABLES.iter().filter(|(kind, _)| kind.is_some() && *kind == slot.kind);
    names.extend(fitting.flat_map(|(_, table)| table.iter().map(|signature| signature.name)));
    names
}

/// What a bare name means in its place.
pub(super) fn name(cx: &mut Cx<'_, '_>, name: &str, span: Span, slot: Slot) -> Option<Value> {
    match (name, slot.kind) {
        ("pi", None | Some(Kind::Number | Kind::Field)) => return Some(Value::Number(std::f64::consts::PI)),
        ("tau", None | Some(Kind::Number | Kind::Field)) => return Some(Value::Number(std::f64::consts::TAU)),
        // Among operands of fields too: some take the page, and others can say that it is a region.
        ("canvas", None | Some(Kind::Region | Kind::Box | Kind::Field)) => {
            let page = cx.page.clone();
            return Some(page.map_or(Value::Unknown(Some(Kind::Region)), Value::Region));
        }
        ("x", Some(Kind::Field)) => return Some(place(Node::X(cx.unit_length()))),
        ("y", Some(Kind::Field)) => return Some(place(Node::Y(cx.unit_length()))),
        (_, Some(Kind::Colour)) => return named_colour(name).map(Value::Colour),
        _ => {}
    }
    // A bare name stands for a call without arguments where its place leaves no doubt: `angle: random`.
    let (_, table) = TABLES.iter().find(|(kind, _)| kind.is_some() && *kind == slot.kind)?;
    let signature = table.iter().find(|signature| signature.name == name)?;
    if matches!(slot.kind, Some(Kind::Region | Kind::Field)) {
        return None;
    }
    Some(call::call(cx, signature, &[], span, |_, _, _| Value::UNKNOWN))
}

fn place(node: Node) -> Value {
    Value::Field(TypedField { field: Field::new(node), unit: FieldUnit::Number })
}

fn named_colour(name: &str) -> Option<Colour> {
    // The crate reads every notation of CSS; only its names are part of the language.
    if !name.chars().all(|character| character.is_ascii_lowercase()) {
        return None;
    }
    let [r, g, b, a] = csscolorparser::parse(name).ok()?.to_rgba8();
    Some(Colour { r, g, b, a })
}

/// A field of a kind that was made of others.
fn field(field: Field, unit: FieldUnit) -> Option<Value> {
    Some(Value::Field(TypedField { field, unit }))
}
