//! What lowering finds out about names, for editors.
//!
//! In: what the evaluator looks up and what values come of it, told as it goes. Out: a [`Survey`]: for every name where
//! it is declared, for every declaration what it is worth, and where colours stand. A lowering that nobody surveys
//! keeps none of this.

use std::collections::BTreeMap;

use crate::geom::{Point, Rect};
use crate::scene::Colour;
use crate::span::{SourceId, Span};
use crate::syntax::ast::{Document, StatementKind};

use super::cx::Cx;
use super::modules::Module;
use super::value::{FieldUnit, Kind, TypedField, Value};

/// What the names of a scene and its imports mean. Spans are those of the sources that were lowered with it.
#[derive(Debug, Clone, Default)]
pub struct Survey {
    /// Every file that could be read, the scene's own first.
    pub documents: Vec<Document>,
    /// Places where a name is used, with the place where it is declared.
    pub uses: BTreeMap<Span, Span>,
    /// The paths of imports, with the text that each names.
    pub imports: BTreeMap<Span, SourceId>,
    /// What declarations are worth, by the place of their names.
    pub values: BTreeMap<Span, Worth>,
    /// Places where a colour is written, as digits or as a name.
    pub colours: BTreeMap<Span, Colour>,
}

/// What a declaration is worth.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Worth {
    /// The kind of its value, where it is known.
    pub kind: Option<Kind>,
    /// The value in the language, or what it is in words; empty where it is not known.
    pub text: String,
    /// Whether it has further values: in a loop, or with other arguments.
    pub is_first: bool,
}

/// The most members that a value is written out with.
const MOST_MEMBERS: u64 = 60;
/// The most characters of a value that are shown.
const MOST_CHARACTERS: usize = 300;
/// Fields are looked at in so many places across and down the page.
const SAMPLES: u32 = 9;
/// Fields of more parts than this are not looked at.
const MOST_PARTS: u64 = 1000;

impl<'a> Cx<'a, '_> {
    /// Tells that a name is used which is declared elsewhere.
    pub(super) fn note_use(&mut self, used: Span, declared: Span) {
        if let Some(survey) = &mut self.survey {
            survey.uses.insert(used, declared);
        }
    }

    /// Tells that a module is named.
    pub(super) fn note_module(&mut self, used: Span, module: &Module<'a>, name: &str) {
        let Some(survey) = &mut self.survey else { return };
        let aliases = module.document.statements.iter().filter_map(|statement| match &statement.kind {
            StatementKind::Import { alias, .. } => alias.as_ref(),
            _ => None,
        });
        if let Some(alias) = aliases.into_iter().find(|alias| alias.name == name) {
            survey.uses.insert(used, alias.span);
        }
    }

    /// Tells what a declaration is worth.
    pub(super) fn note_value(&mut self, declared: Span, value: &Value) {
        let Some(survey) = &self.survey else { return };
        let known = survey.values.get(&declared);
        let worth = match known {
            Some(known) if value.is_unknown() || !known.text.is_empty() => {
                Worth { is_first: known.is_first || !value.is_unknown(), ..known.clone() }
            }
            _ => Worth { kind: value.kind(), text: self.described(value), is_first: false },
        };
        if let Some(survey) = &mut self.survey {
            survey.values.insert(declared, worth);
        }
    }

    /// Tells where a colour is written.
    pub(super) fn note_colour(&mut self, span: Span, value: &Value) {
        if let (Some(survey), Value::Colour(colour)) = (&mut self.survey, value) {
            survey.colours.insert(span, *colour);
        }
    }

    /// A value in the language, or in words where it cannot be written down.
    fn described(&self, value: &Value) -> String {
        let text = match value {
            value if value.is_unknown() => String::new(),
            Value::Region(region) => format!("a region, {}", extent(region.bounds())),
            Value::Field(field) => self.described_field(field),
            Value::List(members) if !value.has_at_most(MOST_MEMBERS) => format!("a list of {}", members.len()),
            Value::Tone(tone) => format!("the tone `{}`", tone.name),
            value => at_a_glance(value).text(),
        };
        match text.char_indices().nth(MOST_CHARACTERS) {
            Some((cut, _)) => format!("{}…", text.get(..cut).unwrap_or_default()),
            None => text,
        }
    }

    fn described_field(&self, field: &TypedField) -> String {
        let noun = field.unit.noun();
        let unit = match field.unit {
            FieldUnit::Number => "",
            FieldUnit::Length => "mm",
            FieldUnit::Angle | FieldUnit::Bool => return noun.to_owned(),
        };
        let Some(page) = self.page.as_ref().filter(|_| field.field.cost() <= MOST_PARTS) else {
            return noun.to_owned();
        };
        let bounds = page.bounds();
        let place = |i: u32, from: f64, size: f64| from + size * (f64::from(i) + 0.5) / f64::from(SAMPLES);
        let mut range: Option<(f64, f64)> = None;
        for i in 0..SAMPLES * SAMPLES {
            let x = place(i % SAMPLES, bounds.min.x, bounds.width());
            let y = place(i / SAMPLES, bounds.min.y, bounds.height());
            let value = field.field.at(Point::new(x, y));
            range = Some(range.map_or((value, value), |(low, high)| (low.min(value), high.max(value))));
        }
        match range.map(|(low, high)| (rounded(low), rounded(high))) {
            Some((low, high)) if low == high => format!("{noun}, {low}{unit} on the page"),
            Some((low, high)) => format!("{noun}, about {low}{unit} to {high}{unit} on the page"),
            None => noun.to_owned(),
        }
    }
}

/// A number without digits that nobody reads.
fn at_a_glance(value: &Value) -> Value {
    let rounded = |number: f64| (number * 1e6).round() / 1e6 + 0.0;
    match value {
        Value::Number(number) => Value::Number(rounded(*number)),
        Value::Length(mm) => Value::Length(rounded(*mm)),
        Value::Angle(radians) => Value::Angle(rounded(radians.to_degrees()).to_radians()),
        Value::Percent(share) => Value::Percent(rounded(*share)),
        other => other.clone(),
    }
}

/// A box in words.
fn extent(bounds: Rect) -> String {
    let [width, height, x, y] = [bounds.width(), bounds.height(), bounds.min.x, bounds.min.y].map(rounded);
    format!("{width}mm wide and {height}mm high, its box at ({x}mm, {y}mm)")
}

/// To hundredths: what is read at a glance.
fn rounded(value: f64) -> f64 {
    // The sum turns a negative zero into zero.
    (value * 100.0).round() / 100.0 + 0.0
}
