//! Bringing a value into the kind that its place takes.

use std::rc::Rc;

use crate::diag::{Code, Diagnostic};
use crate::field::Field;
use crate::geom::{Point, Rect};
use crate::span::Span;

use super::cx::Cx;
use super::value::{FieldUnit, Kind, TypedField, Value};

/// What a place takes, and so which bare names it knows.
#[derive(Debug, Clone, Copy)]
pub struct Slot {
    /// The kind, where only one will do.
    pub kind: Option<Kind>,
    /// Words that stand here as well.
    pub words: &'static [&'static str],
}

impl Slot {
    /// Anything.
    pub const ANY: Self = Self { kind: None, words: &[] };

    /// Values of one kind.
    #[must_use]
    pub const fn of(kind: Kind) -> Self {
        Self { kind: Some(kind), words: &[] }
    }

    /// Nothing but these words.
    #[must_use]
    pub const fn words(words: &'static [&'static str]) -> Self {
        Self { kind: Some(Kind::Word), words }
    }

    /// Values of one kind, or these words.
    #[must_use]
    pub const fn or_words(kind: Kind, words: &'static [&'static str]) -> Self {
        Self { kind: Some(kind), words }
    }

    /// What it takes, in words.
    #[must_use]
    pub fn expectation(self) -> String {
        let words = self.words.iter().map(|word| format!("`{word}`")).collect::<Vec<_>>().join(", ");
        match (self.kind, self.words.is_empty()) {
            (None, _) => "any value".to_owned(),
            (Some(Kind::Word), _) => format!("one of {words}"),
            (Some(kind), true) => kind.noun().to_owned(),
            (Some(kind), false) => format!("{} or {words}", kind.noun()),
        }
    }
}

/// The British spelling of a word that has two.
pub(super) fn spelling(word: &str) -> &str {
    if word == "center" { "centre" } else { word }
}

/// Brings a value into what a slot takes; unknown, with a diagnostic, where that cannot be.
pub(super) fn coerce(cx: &mut Cx<'_, '_>, value: Value, slot: Slot, span: Span) -> Value {
    let Some(kind) = slot.kind else { return value };
    if let Value::Word(word) = value
        && slot.words.contains(&word)
    {
        return value;
    }
    // A string that names one of the words: `match` and parameters yield strings.
    if let Value::String(text) = &value
        && let Some(word) = slot.words.iter().find(|word| **word == spelling(&text.value))
    {
        return Value::Word(word);
    }
    // What is wrong inside it was reported.
    if value.kind() == Some(kind) && value.is_unknown() {
        return Value::Unknown(Some(kind));
    }
    if let Value::Unknown(from) = value {
        if let Some(from) = from
            && !may_become(from, kind)
            && (from != Kind::String || slot.words.is_empty())
        {
            mismatch(cx, from.noun(), slot, span, None);
        }
        return Value::Unknown(Some(kind));
    }
    // A list gives each layer its fill; a ground has but one.
    let fills = if slot.words.is_empty() { fill_list(&value, kind) } else { None };
    match fills.or_else(|| convert(cx.unit, &value, kind)) {
        Some(converted) => converted,
        None => {
            let hint = hint(&value, kind, slot);
            mismatch(cx, &value.describe(), slot, span, hint);
            Value::Unknown(Some(kind))
        }
    }
}

fn mismatch(cx: &mut Cx<'_, '_>, found: &str, slot: Slot, span: Span, hint: Option<String>) {
    let expectation = slot.expectation();
    let diagnostic = Diagnostic::error(Code::Type, span, format!("expected {expectation}, found {found}"));
    cx.report(diagnostic.label(found.to_owned()).maybe_hint(hint));
}

/// A list of fills, which stands wherever a fill does.
fn fill_list(value: &Value, kind: Kind) -> Option<Value> {
    let Value::List(members) = value else { return None };
    let fills = kind == Kind::Fill && !members.is_empty();
    (fills && members.iter().all(|member| matches!(member, Value::Fill(_)))).then(|| value.clone())
}

/// Whether a value of one kind can stand for another.
fn may_become(from: Kind, to: Kind) -> bool {
    from == to
        || matches!(
            (from, to),
            (Kind::Number, Kind::Length | Kind::Percentage | Kind::Field)
                | (Kind::Percentage, Kind::Number | Kind::Field)
                | (Kind::Length | Kind::Angle, Kind::Field)
                | (Kind::Region, Kind::Box)
                | (Kind::List, Kind::Fill)
        )
}

fn convert(unit: f64, value: &Value, kind: Kind) -> Option<Value> {
    if kind != Kind::Point && kind != Kind::Box && value.kind() == Some(kind) {
        return Some(value.clone());
    }
    Some(match (value, kind) {
        (Value::Number(n), Kind::Length) => Value::Length(n * unit),
        (Value::Number(n), Kind::Percentage) => Value::Percent(*n),
        // Nothing is nothing in every unit.
        (Value::Number(0.0), Kind::Angle) => Value::Angle(0.0),
        (Value::Percent(share), Kind::Number) => Value::Number(*share),
        (Value::Number(n) | Value::Percent(n), Kind::Field) => constant(*n, FieldUnit::Number),
        (Value::Length(mm), Kind::Field) => constant(*mm, FieldUnit::Length),
        (Value::Angle(radians), Kind::Field) => constant(*radians, FieldUnit::Angle),
        (Value::Tuple(members), Kind::Point) if members.len() == 2 => lengths(unit, members)?,
        (Value::Tuple(members), Kind::Box) if members.len() == 4 => lengths(unit, members)?,
        (Value::Region(region), Kind::Box) => {
            let bounds = region.bounds();
            let members = [bounds.min.x, bounds.min.y, bounds.width(), bounds.height()];
            Value::Tuple(members.into_iter().map(Value::Length).collect())
        }
        _ => return None,
    })
}

fn lengths(unit: f64, members: &[Value]) -> Option<Value> {
    let members: Option<Rc<[Value]>> = members.iter().map(|member| convert(unit, member, Kind::Length)).collect();
    members.map(Value::Tuple)
}

fn constant(value: f64, unit: FieldUnit) -> Value {
    Value::Field(TypedField { field: Field::constant(value), unit })
}

fn hint(value: &Value, kind: Kind, slot: Slot) -> Option<String> {
    Some(match (value, kind) {
        (Value::Number(n), Kind::Angle) => format!("angles need a unit: `{n}deg`"),
        (Value::Length(_), Kind::Percentage) => "a share is written in per cent: `30%`".to_owned(),
        (Value::Percent(_), Kind::Length) => "lengths need a unit or a canvas unit: `6mm`".to_owned(),
        (Value::String(text), Kind::Length | Kind::Number | Kind::Angle | Kind::Colour) => {
            format!("write it without the quotes: `{}`", text.value)
        }
        (Value::String(text), _) if !slot.words.is_empty() => {
            crate::diag::did_you_mean(&text.value, slot.words.iter().copied())?
        }
        (Value::Field(_), Kind::Number | Kind::Length | Kind::Angle) => {
            "this takes one value for the whole page, not a field".to_owned()
        }
        (Value::Number(_) | Value::Angle(_), Kind::Angles) => "an angle for every tile: `fixed(45deg)`".to_owned(),
        (Value::Number(_) | Value::Length(_), Kind::Point) => "a point is written `(10mm, 20mm)`".to_owned(),
        (Value::Tuple(members), Kind::Box) if members.len() == 2 => {
            "a box is written `(x, y, width, height)`".to_owned()
        }
        (Value::Tuple(_), Kind::Box | Kind::Point) => "its members are lengths".to_owned(),
        (Value::Word(word), _) => format!("`{word}` belongs elsewhere"),
        (Value::Field(_), Kind::Angles) => "`along(field)` turns tiles along a field of angles".to_owned(),
        (Value::Region(_), Kind::Drawing) => {
            "what is inked is named at its place: `ink svg(\"figure.svg\")`".to_owned()
        }
        (Value::Tone(_), _) => "tones stand behind `with`".to_owned(),
        _ => return None,
    })
}

impl Value {
    /// The millimetres of a value that was brought to a length.
    pub(super) fn as_length(&self) -> Option<f64> {
        match self {
            Self::Length(mm) => Some(*mm),
            _ => None,
        }
    }

    /// The place of a value that was brought to a point.
    pub(super) fn as_point(&self) -> Option<Point> {
        match self {
            Self::Tuple(members) => match &**members {
                [Self::Length(x), Self::Length(y)] => Some(Point::new(*x, *y)),
                _ => None,
            },
            _ => None,
        }
    }

    /// The box of a value that was brought to one.
    pub(super) fn as_box(&self) -> Option<Rect> {
        match self {
            Self::Tuple(members) => match &**members {
                [Self::Length(x), Self::Length(y), Self::Length(width), Self::Length(height)] => {
                    Some(Rect::new(Point::new(*x, *y), Point::new(x + width, y + height)))
                }
                _ => None,
            },
            _ => None,
        }
    }
}
