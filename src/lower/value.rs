//! Values of the language while a scene is lowered, and the kinds they are of.

use std::rc::Rc;

use crate::field::Field;
use crate::region::Region;
use crate::scene::{AngleRule, Colour, Fill, Hand, InkMark, Placement, Shape};
use crate::span::{SourceId, Span};

use super::tone::ToneValue;

/// A value.
#[derive(Debug, Clone)]
pub(super) enum Value {
    /// A plain number.
    Number(f64),
    /// Millimetres.
    Length(f64),
    /// Radians.
    Angle(f64),
    /// A share of one, written in per cent.
    Percent(f64),
    Colour(Colour),
    String(Text),
    Bool(bool),
    /// A point, a box, or any other tuple.
    Tuple(Rc<[Value]>),
    List(Rc<[Value]>),
    Range(Rc<(Value, Value)>),
    Record(Rc<[Member]>),
    Region(Region),
    Field(TypedField),
    Placement(Rc<Placement>),
    Shape(Rc<Shape>),
    Angles(Rc<AngleRule>),
    Fill(Rc<Fill>),
    Hand(Hand),
    Tone(Rc<ToneValue>),
    /// Strokes and fills of a file.
    Drawing(Rc<[InkMark]>),
    /// A word of the vocabulary of its place: `knockout`, `a4`, `none`.
    Word(&'static str),
    /// What cannot be known: it was reported already, or belongs to code that is only checked.
    Unknown(Option<Kind>),
}

/// A string with the text it was written in: paths are found from there.
#[derive(Debug, Clone)]
pub(super) struct Text {
    pub(super) value: Rc<str>,
    pub(super) source: SourceId,
}

/// A member of a record.
#[derive(Debug, Clone)]
pub(super) struct Member {
    pub(super) name: String,
    pub(super) name_span: Span,
    pub(super) value: Value,
    pub(super) span: Span,
}

/// A field with the kind of value it yields.
#[derive(Debug, Clone)]
pub(super) struct TypedField {
    pub(super) field: Field,
    pub(super) unit: FieldUnit,
}

/// What a field yields.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum FieldUnit {
    Number,
    /// Millimetres.
    Length,
    /// Radians.
    Angle,
    /// 0 or 1.
    Bool,
}

impl FieldUnit {
    pub(super) fn noun(self) -> &'static str {
        match self {
            Self::Number => "a field of numbers",
            Self::Length => "a field of lengths",
            Self::Angle => "a field of angles",
            Self::Bool => "a condition that varies over the page",
        }
    }
}

/// The kinds of value, as they are named in `name: type`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A plain number.
    Number,
    /// A length.
    Length,
    /// An angle.
    Angle,
    /// A share of one.
    Percentage,
    /// A colour.
    Colour,
    /// A text.
    String,
    /// A pair of lengths.
    Point,
    /// A place and a size.
    Box,
    /// Values in order.
    List,
    /// From one value to another.
    Range,
    /// Named values.
    Record,
    /// True or false.
    Bool,
    /// A part of the page.
    Region,
    /// A value at every point.
    Field,
    /// Where tiles lie.
    Placement,
    /// What tiles look like.
    Shape,
    /// How tiles are turned.
    Angles,
    /// What is drawn in tiles.
    Fill,
    /// How unevenly strokes are drawn.
    Hand,
    /// A recipe for tiles.
    Tone,
    /// Not a type that can be named: what `ink` takes.
    Drawing,
    /// Not a type that can be named: a word of some vocabulary.
    Word,
}

impl Kind {
    /// The kinds that have a name.
    pub const NAMED: [Self; 20] = [
        Self::Number,
        Self::Length,
        Self::Angle,
        Self::Percentage,
        Self::Colour,
        Self::String,
        Self::Point,
        Self::Box,
        Self::List,
        Self::Range,
        Self::Record,
        Self::Bool,
        Self::Region,
        Self::Field,
        Self::Placement,
        Self::Shape,
        Self::Angles,
        Self::Fill,
        Self::Hand,
        Self::Tone,
    ];

    /// Its name in the language.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Number => "number",
            Self::Length => "length",
            Self::Angle => "angle",
            Self::Percentage => "percentage",
            Self::Colour => "colour",
            Self::String => "string",
            Self::Point => "point",
            Self::Box => "box",
            Self::List => "list",
            Self::Range => "range",
            Self::Record => "record",
            Self::Bool => "bool",
            Self::Region => "region",
            Self::Field => "field",
            Self::Placement => "placement",
            Self::Shape => "shape",
            Self::Angles => "angles",
            Self::Fill => "fill",
            Self::Hand => "hand",
            Self::Tone => "tone",
            Self::Drawing => "drawing",
            Self::Word => "word",
        }
    }

    /// The kind of a name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::NAMED.into_iter().find(|kind| kind.name() == name)
    }

    /// With its article.
    #[must_use]
    pub fn noun(self) -> &'static str {
        match self {
            Self::Number => "a number",
            Self::Length => "a length",
            Self::Angle => "an angle",
            Self::Percentage => "a percentage",
            Self::Colour => "a colour",
            Self::String => "a string",
            Self::Point => "a point",
            Self::Box => "a box",
            Self::List => "a list",
            Self::Range => "a range",
            Self::Record => "a record",
            Self::Bool => "a bool",
            Self::Region => "a region",
            Self::Field => "a field",
            Self::Placement => "a placement",
            Self::Shape => "a shape",
            Self::Angles => "an angle rule",
            Self::Fill => "a fill",
            Self::Hand => "a hand",
            Self::Tone => "a tone",
            Self::Drawing => "a drawing",
            Self::Word => "a word",
        }
    }
}

impl Value {
    pub(super) const UNKNOWN: Self = Self::Unknown(None);

    pub(super) fn string(text: &str, source: SourceId) -> Self {
        Self::String(Text { value: Rc::from(text), source })
    }

    /// The kind, where it is known.
    pub(super) fn kind(&self) -> Option<Kind> {
        Some(match self {
            Self::Number(_) => Kind::Number,
            Self::Length(_) => Kind::Length,
            Self::Angle(_) => Kind::Angle,
            Self::Percent(_) => Kind::Percentage,
            Self::Colour(_) => Kind::Colour,
            Self::String(_) => Kind::String,
            Self::Bool(_) => Kind::Bool,
            Self::Tuple(members) if members.len() == 4 => Kind::Box,
            Self::Tuple(_) => Kind::Point,
            Self::List(_) => Kind::List,
            Self::Range(_) => Kind::Range,
            Self::Record(_) => Kind::Record,
            Self::Region(_) => Kind::Region,
            Self::Field(_) => Kind::Field,
            Self::Placement(_) => Kind::Placement,
            Self::Shape(_) => Kind::Shape,
            Self::Angles(_) => Kind::Angles,
            Self::Fill(_) => Kind::Fill,
            Self::Hand(_) => Kind::Hand,
            Self::Tone(_) => Kind::Tone,
            Self::Drawing(_) => Kind::Drawing,
            Self::Word(_) => Kind::Word,
            Self::Unknown(kind) => return *kind,
        })
    }

    /// What it is, in words: "a length", "the word `clip`".
    pub(super) fn describe(&self) -> String {
        match self {
            Self::Word(word) => format!("the word `{word}`"),
            Self::Field(field) => field.unit.noun().to_owned(),
            Self::Tuple(members) if members.len() != 2 && members.len() != 4 => {
                format!("a tuple of {} values", members.len())
            }
            _ => self.kind().map_or("an unknown value", Kind::noun).to_owned(),
        }
    }

    /// Whether any part of it is unknown.
    pub(super) fn is_unknown(&self) -> bool {
        match self {
            Self::Unknown(_) => true,
            Self::Tuple(members) | Self::List(members) => members.iter().any(Self::is_unknown),
            Self::Range(ends) => ends.0.is_unknown() || ends.1.is_unknown(),
            Self::Record(members) => members.iter().any(|member| member.value.is_unknown()),
            _ => false,
        }
    }

    /// Whether it has at most so many members, those of its members counted too.
    pub(super) fn has_at_most(&self, parts: u64) -> bool {
        let mut left = parts;
        let mut open: Vec<&Self> = vec![self];
        while let Some(value) = open.pop() {
            let before = open.len();
            match value {
                Self::Tuple(members) | Self::List(members) => open.extend(members.iter()),
                Self::Record(members) => open.extend(members.iter().map(|member| &member.value)),
                _ => {}
            }
            let Some(rest) = left.checked_sub((open.len() - before) as u64) else { return false };
            left = rest;
        }
        true
    }

    /// The number behind a number, length (mm), angle (rad) or percentage (share).
    pub(super) fn number(&self) -> Option<f64> {
        match self {
            Self::Number(value) | Self::Length(value) | Self::Angle(value) | Self::Percent(value) => Some(*value),
            _ => None,
        }
    }

    /// Whether its text is an expression that gives it.
    pub(super) fn is_literal(&self) -> bool {
        match self {
            Self::Number(_) | Self::Length(_) | Self::Angle(_) | Self::Percent(_) | Self::Colour(_) => true,
            Self::String(_) | Self::Bool(_) | Self::Range(_) | Self::Word(_) => true,
            Self::Tuple(members) | Self::List(members) => members.iter().all(Self::is_literal),
            Self::Record(members) => members.iter().all(|member| member.value.is_literal()),
            Self::Region(_) | Self::Field(_) | Self::Placement(_) | Self::Shape(_) | Self::Angles(_) => false,
            Self::Fill(_) | Self::Hand(_) | Self::Tone(_) | Self::Drawing(_) | Self::Unknown(_) => false,
        }
    }

    /// As an expression of the language, or in words where no expression gives it.
    pub(super) fn text(&self) -> String {
        match self {
            Self::Number(value) => format!("{value}"),
            Self::Length(value) => format!("{}mm", tidy(*value)),
            Self::Angle(value) => format!("{}deg", tidy(value.to_degrees())),
            Self::Percent(value) => format!("{}%", tidy(value * 100.0)),
            Self::Colour(colour) if colour.a == 255 => colour.hex(),
            Self::Colour(colour) => format!("{}{:02x}", colour.hex(), colour.a),
            Self::String(text) => quoted(&text.value),
            Self::Bool(value) => value.to_string(),
            Self::Tuple(members) => format!("({})", joined(members)),
            Self::List(members) => format!("[{}]", joined(members)),
            Self::Range(ends) => format!("{} .. {}", ends.0.text(), ends.1.text()),
            Self::Record(members) => {
                let inner: Vec<String> = members.iter().map(|m| format!("{}: {}", m.name, m.value.text())).collect();
                format!("{{ {} }}", inner.join(", "))
            }
            Self::Word(word) => (*word).to_owned(),
            _ => self.describe(),
        }
    }
}

/// A string as it is written in a scene.
fn quoted(text: &str) -> String {
    let mut out = String::with_capacity(text.len() + 2);
    out.push('"');
    for character in text.chars() {
        match character {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            '\n' => out.push_str("\\n"),
            '\t' => out.push_str("\\t"),
            control if control.is_control() => out.push_str(&format!("\\u{{{:x}}}", u32::from(control))),
            '{' => out.push_str("\\{"),
            '}' => out.push_str("\\}"),
            other => out.push(other),
        }
    }
    out.push('"');
    out
}

fn joined(values: &[Value]) -> String {
    values.iter().map(Value::text).collect::<Vec<_>>().join(", ")
}

/// Rounds away the last bits that a conversion of units leaves (3 in becomes 76.2mm, not 76.19999999999999mm).
fn tidy(value: f64) -> f64 {
    let rounded = (value * 1e9).round() / 1e9;
    if (rounded - value).abs() <= 1e-12 * value.abs().max(1.0) { rounded } else { value }
}
