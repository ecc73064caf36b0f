//! Calls of the vocabulary: arguments are matched to a signature and brought into their kinds, then the call is built.

use crate::diag::{Code, Diagnostic, did_you_mean};
use crate::geom::{Angle, Length, Point, Rect};
use crate::region::Region;
use crate::span::Span;
use crate::syntax::ast;

use super::convert::{Slot, coerce, spelling};
use super::cx::Cx;
use super::value::{FieldUnit, Kind, TypedField, Value};
use crate::field::Field;

/// What the vocabulary knows of one name.
pub struct Signature {
    pub(super) name: &'static str,
    /// What it is, in a sentence for editors.
    pub(super) about: &'static str,
    /// The kind of the result, where it does not depend on the arguments.
    pub(super) result: Option<Kind>,
    pub(super) params: &'static [Param],
    /// Makes the value of arguments that are there and of the right kinds.
    pub(super) build: fn(&mut Call<'_, '_, '_>) -> Option<Value>,
}

/// A parameter of a signature.
pub struct Param {
    pub(super) name: &'static str,
    pub(super) slot: Slot,
    pub(super) need: Need,
    /// What it is, in a few words for editors.
    pub(super) about: &'static str,
}

/// Whether a parameter must be given.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Need {
    /// It must.
    Required,
    /// What it is where it is not given, in words of the language or about them.
    Optional(&'static str),
}

/// A parameter that must be given.
pub(super) const fn required(name: &'static str, slot: Slot, about: &'static str) -> Param {
    Param { name, slot, need: Need::Required, about }
}

/// A parameter that may be given, with what it is otherwise.
pub(super) const fn optional(name: &'static str, slot: Slot, default: &'static str, about: &'static str) -> Param {
    Param { name, slot, need: Need::Optional(default), about }
}

/// An argument that was evaluated.
#[derive(Debug, Clone)]
pub(super) struct Given {
    pub(super) value: Value,
    pub(super) span: Span,
}

/// Which parameter takes each argument, by its place among the names; `None` for those that none takes, which were
/// reported.
pub(super) fn assign(
    cx: &mut Cx<'_, '_>,
    what: &str,
    names: &[&str],
    arguments: &[ast::Argument],
) -> Vec<Option<usize>> {
    let mut taken: Vec<Option<Span>> = vec![None; names.len()];
    let mut next = 0;
    let mut places = Vec::with_capacity(arguments.len());
    for argument in arguments {
        let span = argument.name.as_ref().map_or(argument.value.span, |name| name.span);
        let place = match &argument.name {
            Some(name) => {
                let place = names.iter().position(|known| spelling(known) == spelling(&name.name));
                if place.is_none() {
                    let message = format!("{what} has no argument `{}`", name.name);
                    let hint = did_you_mean(&name.name, names.iter().copied()).or_else(|| takes(what, names));
                    cx.report(Diagnostic::error(Code::UnknownArgument, name.span, message).maybe_hint(hint));
                }
                place
            }
            None => {
                while taken.get(next).is_some_and(Option::is_some) {
                    next += 1;
                }
                if next >= names.len() {
                    let message = match names.len() {
                        0 => format!("{what} takes no arguments"),
                        1 => format!("{what} takes one argument"),
                        count => format!("{what} takes {count} arguments at most"),
                    };
                    cx.report(
                        Diagnostic::error(Code::TooMany, span, message)
                            .label("one too many")
                            .maybe_hint(takes(what, names)),
                    );
                    None
                } else {
                    Some(next)
                }
            }
        };
        places.push(match place {
            Some(place) => match taken[place] {
                Some(earlier) => {
                    let message = format!("{what} is given `{}` twice", names[place]);
                    cx.report(Diagnostic::error(Code::Duplicate, span, message).note(earlier, "first given here"));
                    None
                }
                None => {
                    taken[place] = Some(span);
                    Some(place)
                }
            },
            None => None,
        });
    }
    places
}

fn takes(what: &str, names: &[&str]) -> Option<String> {
    if names.is_empty() {
        return None;
    }
    let names = names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
    Some(format!("{what} takes {names}"))
}

/// Calls a name of the vocabulary.
pub(super) fn call<'a>(
    cx: &mut Cx<'a, '_>,
    signature: &'static Signature,
    arguments: &'a [ast::Argument],
    span: Span,
    mut eval: impl FnMut(&mut Cx<'a, '_>, &'a ast::Expr, Slot) -> Value,
) -> Value {
    let what = format!("`{}`", signature.name);
    let names: Vec<&str> = signature.params.iter().map(|param| param.name).collect();
    let places = assign(cx, &what, &names, arguments);
    let lost = places.contains(&None);
    let mut given: Vec<Option<Given>> = signature.params.iter().map(|_| None).collect();
    let mut whole = true;
    for (argument, place) in arguments.iter().zip(places.iter().copied()) {
        let slot = place.map_or(Slot::ANY, |place| signature.params[place].slot);
        let value = eval(cx, &argument.value, slot);
        let Some(place) = place else {
            whole = false;
            continue;
        };
        let value = coerce(cx, value, slot, argument.value.span);
        whole &= !value.is_unknown();
        given[place] = Some(Given { value, span: argument.value.span });
    }
    for (param, value) in signature.params.iter().zip(&given) {
        if param.need == Need::Required && value.is_none() {
            whole = false;
            // An argument that none of the parameters took may have been meant for this one.
            if lost {
                continue;
            }
            let message = format!("{what} needs `{}`", param.name);
            let hint = takes(&what, &names);
            cx.report(Diagnostic::error(Code::Missing, span, message).maybe_hint(hint));
        }
    }
    whole &= !lost;
    if !whole || cx.is_dead() {
        return Value::Unknown(signature.result);
    }
    let mut call = Call { cx, signature, given, span };
    (signature.build)(&mut call).unwrap_or(Value::Unknown(signature.result))
}

/// A call whose arguments are of the right kinds.
pub(super) struct Call<'k, 'a, 'c> {
    pub(super) cx: &'k mut Cx<'a, 'c>,
    pub(super) signature: &'static Signature,
    given: Vec<Option<Given>>,
    /// The whole call.
    pub(super) span: Span,
}

impl Call<'_, '_, '_> {
    /// The argument of a parameter of the signature, where it is given.
    pub(super) fn get(&self, name: &str) -> Option<&Given> {
        let place = self.signature.params.iter().position(|param| param.name == name)?;
        self.given.get(place)?.as_ref()
    }

    pub(super) fn value(&self, name: &str) -> Option<Value> {
        self.get(name).map(|given| given.value.clone())
    }

    /// Where an argument stands; the call where it is not given.
    pub(super) fn span_of(&self, name: &str) -> Span {
        self.get(name).map_or(self.span, |given| given.span)
    }

    pub(super) fn has(&self, name: &str) -> bool {
        self.get(name).is_some()
    }

    /// Reports what an argument's value is at fault for.
    pub(super) fn refuse<T>(&mut self, name: &str, message: String) -> Option<T> {
        let span = self.span_of(name);
        self.cx.report_value(Diagnostic::error(Code::Range, span, message));
        None
    }

    fn missing<T>(&mut self, name: &str) -> Option<T> {
        let message = format!("`{}` needs `{name}`", self.signature.name);
        self.cx.report(Diagnostic::error(Code::Missing, self.span, message));
        None
    }

    pub(super) fn number(&self, name: &str) -> Option<f64> {
        self.get(name)?.value.number()
    }

    /// A length that is greater than zero, or the default.
    pub(super) fn positive(&mut self, name: &str, default: Option<Length>) -> Option<Length> {
        match self.get(name).and_then(|given| given.value.as_length()) {
            Some(mm) if mm > 0.0 => Some(Length::mm(mm)),
            Some(_) => self.refuse(name, format!("`{name}` must be greater than zero")),
            None => match default {
                Some(default) => Some(default),
                None => self.missing(name),
            },
        }
    }

    /// A length that is given and greater than zero; `Some(None)` where it is not given.
    pub(super) fn maybe_positive(&mut self, name: &str) -> Option<Option<Length>> {
        if self.has(name) { self.positive(name, None).map(Some) } else { Some(None) }
    }

    /// A length that is not negative, or the default.
    pub(super) fn not_negative(&mut self, name: &str, default: Length) -> Option<Length> {
        match self.get(name).and_then(|given| given.value.as_length()) {
            Some(mm) if mm >= 0.0 => Some(Length::mm(mm)),
            Some(_) => self.refuse(name, format!("`{name}` must not be negative")),
            None => Some(default),
        }
    }

    /// A plain number within bounds, or the default.
    pub(super) fn within(&mut self, name: &str, low: f64, high: f64, default: f64) -> Option<f64> {
        match self.number(name) {
            Some(value) if (low..=high).contains(&value) => Some(value),
            Some(_) if high.is_infinite() => self.refuse(name, format!("`{name}` must be at least {low}")),
            Some(_) => self.refuse(name, format!("`{name}` must lie between {low} and {high}")),
            None => Some(default),
        }
    }

    /// A whole number within bounds, or the default.
    pub(super) fn whole(&mut self, name: &str, low: u32, high: u32, default: Option<u32>) -> Option<u32> {
        match self.number(name) {
            Some(value) if value.fract() != 0.0 => self.refuse(name, format!("`{name}` must be a whole number")),
            Some(value) if value >= f64::from(low) && value <= f64::from(high) => Some(value as u32),
            Some(_) => self.refuse(name, format!("`{name}` must lie between {low} and {high}")),
            None => match default {
                Some(default) => Some(default),
                None => self.missing(name),
            },
        }
    }

    pub(super) fn angle(&self, name: &str) -> Option<Angle> {
        match self.get(name)?.value {
            Value::Angle(radians) => Some(Angle::radians(radians)),
            _ => None,
        }
    }

    pub(super) fn flag(&self, name: &str) -> bool {
        matches!(self.get(name).map(|given| &given.value), Some(Value::Bool(true)))
    }

    pub(super) fn word(&self, name: &str) -> Option<&'static str> {
        match self.get(name)?.value {
            Value::Word(word) => Some(word),
            _ => None,
        }
    }

    pub(super) fn point(&self, name: &str) -> Option<Point> {
        self.get(name)?.value.as_point()
    }

    /// A box with an area.
    pub(super) fn area(&mut self, name: &str) -> Option<Rect> {
        let rect = self.get(name)?.value.as_box()?;
        if rect.is_empty() {
            return self.refuse(name, format!("the box `{name}` needs a width and a height greater than zero"));
        }
        Some(rect)
    }

    pub(super) fn region(&self, name: &str) -> Option<Region> {
        match &self.get(name)?.value {
            Value::Region(region) => Some(region.clone()),
            _ => None,
        }
    }

    /// A field of plain numbers.
    pub(super) fn number_field(&mut self, name: &str) -> Option<Field> {
        match self.value(name)? {
            Value::Field(TypedField { field, unit: FieldUnit::Number }) => Some(field),
            Value::Field(field) => {
                let message = format!("`{name}` takes a field of numbers, not {}", field.unit.noun());
                self.cx.report(Diagnostic::error(Code::Type, self.span_of(name), message));
                None
            }
            _ => None,
        }
    }
}
