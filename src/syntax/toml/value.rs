//! From TOML values to expressions, properties and parameters.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::guard::NESTING;
use super::read::{Key, Reader, Value, is_documented, lost};
use crate::diag::{Code, Diagnostic};
use crate::span::Span;
use crate::syntax::ast::{Expr, ExprKind, Parameter, Property, UnaryOp};
use crate::syntax::kake::{parse_expression, parse_parameters};

impl Reader<'_> {
    /// A value as an expression: strings are read as the language, all others stand for themselves.
    pub(super) fn value(&mut self, value: Value<'_>) -> Expr {
        let span = self.span(value.span());
        if self.is_lost(value) {
            return lost(span);
        }
        let kind = match value.get_ref() {
            DeValue::String(text) => return self.expression(text, value),
            DeValue::Integer(number) => self.integer(number.as_str(), number.radix(), span),
            DeValue::Float(number) => self.float(number.as_str(), span),
            DeValue::Boolean(value) => ExprKind::Bool(*value),
            DeValue::Datetime(_) => {
                let message = "a date or time is no value of the language";
                self.report(Diagnostic::error(Code::Type, span, message).hint("put quotes around an expression"));
                ExprKind::Error
            }
            DeValue::Array(array) => {
                match self.deeper(span, |reader| array.iter().map(|member| reader.value(member)).collect()) {
                    Some(members) => ExprKind::List(members),
                    None => ExprKind::Error,
                }
            }
            DeValue::Table(table) => match self.deeper(span, |reader| {
                reader.entries(table).iter().map(|(key, value)| reader.property(key, value)).collect()
            }) {
                Some(properties) => ExprKind::Record(properties),
                None => ExprKind::Error,
            },
        };
        Expr { kind, span }
    }

    /// Reads what stands one level deeper, unless that is too deep.
    pub(super) fn deeper<T>(&mut self, span: Span, read: impl FnOnce(&mut Self) -> T) -> Option<T> {
        if self.depth >= NESTING {
            self.too_deep(span);
            return None;
        }
        self.depth += 1;
        let result = read(self);
        self.depth -= 1;
        Some(result)
    }

    /// The text of a string as an expression of the language.
    fn expression(&mut self, text: &str, value: Value<'_>) -> Expr {
        let (_, places) = self.places(value);
        let (expr, diagnostics) = parse_expression(self.source, text, &|offset| places.place(offset));
        self.diagnostics.extend(diagnostics);
        if self.depth + nesting(&expr) > NESTING {
            self.too_deep(expr.span);
            return lost(expr.span);
        }
        expr
    }

    /// `key = value`, and `key = { value = …, doc = … }`.
    pub(super) fn property(&mut self, key: &Key, value: Value<'_>) -> Property {
        let name = self.label(key);
        match value.get_ref().as_table().filter(|table| table.len() == 2 && is_documented(table, &["value", "doc"])) {
            Some(table) => {
                let mut property = Property { doc: None, name, value: lost(key.span) };
                for (key, value) in self.entries(table) {
                    match key.name.as_str() {
                        "doc" => property.doc = self.doc(&key, value),
                        _ => property.value = self.value(value),
                    }
                }
                property
            }
            None => Property { doc: None, name, value: self.value(value) },
        }
    }

    /// Parameters in one of their three forms.
    pub(super) fn parameters(&mut self, key: &Key, value: Value<'_>) -> Vec<Parameter> {
        match value.get_ref() {
            _ if self.is_lost(value) => Vec::new(),
            DeValue::String(text) => self.parameter_list(text, value),
            DeValue::Array(array) => {
                let mut parameters = Vec::new();
                for member in array.iter() {
                    self.parameter_member(key, member, &mut parameters);
                }
                parameters
            }
            DeValue::Table(table) => {
                self.entries(table).into_iter().filter_map(|(key, value)| self.parameter_entry(&key, value)).collect()
            }
            other => {
                self.wrong_type(self.span(value.span()), &key.name, "a list of parameters", other);
                Vec::new()
            }
        }
    }

    fn parameter_list(&mut self, text: &str, value: Value<'_>) -> Vec<Parameter> {
        let (_, places) = self.places(value);
        let (parameters, diagnostics) = parse_parameters(self.source, text, &|offset| places.place(offset));
        self.diagnostics.extend(diagnostics);
        parameters
    }

    /// A member of `params = […]`.
    fn parameter_member(&mut self, key: &Key, member: &Spanned<DeValue<'_>>, out: &mut Vec<Parameter>) {
        let span = self.span(member.span());
        match member.get_ref() {
            _ if self.is_lost(member) => {}
            DeValue::String(text) => out.extend(self.parameter_list(text, member)),
            DeValue::Table(table) => {
                let mut name = None;
                for (key, value) in self.entries(table) {
                    if key.name == "name" {
                        name = self.ident_value(&key, value);
                    }
                }
                match name {
                    Some(name) => {
                        let mut parameter = Parameter { doc: None, name, ty: None, default: None };
                        self.parameter_keys(&mut parameter, table, &["name", "type", "default", "doc"]);
                        out.push(parameter);
                    }
                    None if table.contains_key("name") => {}
                    None => self.missing(span, "a parameter needs a `name`".into()),
                }
            }
            other => self.wrong_type(span, &key.name, "an array of strings and tables", other),
        }
    }

    /// An entry of `[….params]`.
    fn parameter_entry(&mut self, key: &Key, value: Value<'_>) -> Option<Parameter> {
        let name = self.ident(key)?;
        let mut parameter = Parameter { doc: None, name, ty: None, default: None };
        match value.get_ref() {
            DeValue::Table(table) => self.parameter_keys(&mut parameter, table, &["type", "default", "doc"]),
            _ => parameter.default = Some(self.value(value)),
        }
        Some(parameter)
    }

    fn parameter_keys(&mut self, parameter: &mut Parameter, table: &DeTable<'_>, known: &[&str]) {
        for (key, value) in self.entries(table) {
            match key.name.as_str() {
                "type" => parameter.ty = self.type_value(&key, value),
                "default" => parameter.default = Some(self.value(value)),
                "doc" => parameter.doc = self.doc(&key, value),
                name if known.contains(&name) => {}
                _ => self.unknown(&key, "a parameter", known),
            }
        }
    }

    fn integer(&mut self, digits: &str, radix: u32, span: Span) -> ExprKind {
        let (sign, digits) = split_sign(digits);
        let text = if radix == 10 {
            digits.to_owned()
        } else {
            match u128::from_str_radix(digits, radix) {
                Ok(number) => number.to_string(),
                Err(_) => return self.not_finite(span),
            }
        };
        self.number(sign, text, span)
    }

    fn float(&mut self, text: &str, span: Span) -> ExprKind {
        let (sign, text) = split_sign(text);
        self.number(sign, text.to_owned(), span)
    }

    /// A number as the language has it, without a sign of its own.
    fn number(&mut self, is_negative: bool, text: String, span: Span) -> ExprKind {
        let value = match text.parse::<f64>() {
            Ok(value) if value.is_finite() => value,
            _ => return self.not_finite(span),
        };
        let number = ExprKind::Number { value, text, unit: None };
        if is_negative {
            let operand = Span { start: (span.start + 1).min(span.end), ..span };
            ExprKind::Unary(vec![UnaryOp::Minus], Box::new(Expr { kind: number, span: operand }))
        } else {
            number
        }
    }

    fn not_finite(&mut self, span: Span) -> ExprKind {
        self.report(Diagnostic::error(Code::Range, span, "a number is finite and not beyond all bounds"));
        ExprKind::Error
    }
}

/// Whether a number is negative, and what stands behind its sign.
fn split_sign(text: &str) -> (bool, &str) {
    match text.strip_prefix('-') {
        Some(rest) => (true, rest),
        None => (false, text.strip_prefix('+').unwrap_or(text)),
    }
}

/// How many brackets, conditions and matches are around the innermost part of an expression.
fn nesting(expr: &Expr) -> usize {
    fn most<'e>(parts: impl IntoIterator<Item = &'e Expr>) -> usize {
        parts.into_iter().map(nesting).max().unwrap_or(0)
    }
    match &expr.kind {
        ExprKind::Number { .. }
        | ExprKind::Colour(_)
        | ExprKind::Bool(_)
        | ExprKind::Name(_)
        | ExprKind::String(_)
        | ExprKind::Error => 0,
        ExprKind::Member(base, _) => nesting(base),
        ExprKind::Call(callee, arguments) => {
            nesting(callee).max(1 + most(arguments.iter().map(|argument| &argument.value)))
        }
        ExprKind::Index(base, index) => nesting(base).max(1 + nesting(index)),
        ExprKind::Group(inner) => 1 + nesting(inner),
        ExprKind::Tuple(members) | ExprKind::List(members) => 1 + most(members),
        ExprKind::Range(from, to) => nesting(from).max(nesting(to)),
        ExprKind::Record(properties) => 1 + most(properties.iter().map(|property| &property.value)),
        ExprKind::Unary(_, operand) => nesting(operand),
        ExprKind::Binary(first, rest) => nesting(first).max(most(rest.iter().map(|(_, operand)| operand))),
        ExprKind::If { branches, otherwise } => {
            1 + most(branches.iter().flat_map(|(condition, value)| [condition, value])).max(nesting(otherwise))
        }
        ExprKind::Match { subject, arms } => nesting(subject).max(1 + most(arms.iter().map(|arm| &arm.value))),
    }
}
