//! From expressions, names and docs to TOML values.
//!
//! A number, boolean, list or record is written as TOML's own where that reads back as the same; all else is a string
//! that holds the expression.

use std::collections::BTreeSet;

use crate::syntax::ast::{Binding, Doc, Expr, ExprKind, Parameter, Property, StringPart, UnaryOp};
use crate::syntax::format::{documented_expression, expression, parameters};

/// The greatest number of characters on a line that is not one long string.
const WIDTH: usize = 100;

/// A key, with quotes where it needs them.
pub(super) fn key(name: &str) -> String {
    let is_bare =
        !name.is_empty() && name.bytes().all(|byte| byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b'-'));
    if is_bare { name.to_owned() } else { basic(name) }
}

/// A name as a string.
pub(super) fn name(name: &str) -> String {
    basic(name)
}

/// Plain text as a string.
pub(super) fn plain(text: &str) -> String {
    let is_tall =
        text.contains('\n') && text.chars().all(|letter| letter == '\n' || letter == '\t' || !letter.is_control());
    if is_tall && !text.contains('\\') && !text.contains("\"\"\"") {
        // The line end before the closing quotes does not count.
        format!("\"\"\"\n{text}\n\"\"\"")
    } else if is_tall && !text.contains("'''") {
        format!("'''\n{text}\n'''")
    } else {
        string(text)
    }
}

/// An expression's text as a string.
pub(super) fn string(text: &str) -> String {
    let is_plain = |letter: char| letter == '\t' || !letter.is_control();
    if text.contains('\n') && text.chars().all(|letter| letter == '\n' || is_plain(letter)) && !text.contains("'''") {
        format!("'''\n{text}\n'''")
    } else if text.contains(['"', '\\']) && !text.contains('\'') && text.chars().all(is_plain) {
        format!("'{text}'")
    } else {
        basic(text)
    }
}

/// A string in double quotes.
fn basic(text: &str) -> String {
    let mut out = String::from("\"");
    for letter in text.chars() {
        match letter {
            '"' | '\\' => out.extend(['\\', letter]),
            '\n' => out.push_str("\\n"),
            '\t' => out.push_str("\\t"),
            control if control.is_control() => out.push_str(&format!("\\u{:04x}", u32::from(control))),
            other => out.push(other),
        }
    }
    out.push('"');
    out
}

/// An expression as a value that begins in `column`: over several lines if it is a list that is too long for one.
pub(super) fn value(expr: &Expr, column: usize) -> String {
    let line = flat(expr);
    match &expr.kind {
        ExprKind::List(members) if !members.is_empty() && column + line.chars().count() > WIDTH => {
            let members: String = members.iter().map(|member| format!("  {},\n", flat(member))).collect();
            format!("[\n{members}]")
        }
        _ => line,
    }
}

/// An expression as a value on one line, unless it holds doc comments.
fn flat(expr: &Expr) -> String {
    match &expr.kind {
        ExprKind::Bool(value) => value.to_string(),
        ExprKind::Number { text, unit: None, .. } if is_number(text) => text.clone(),
        ExprKind::Unary(operators, operand) => match (operators.as_slice(), &operand.kind) {
            ([UnaryOp::Minus], ExprKind::Number { text, unit: None, .. }) if is_number(text) => format!("-{text}"),
            _ => string(&documented_expression(expr)),
        },
        ExprKind::List(members) if members.iter().all(is_native) => {
            format!("[{}]", members.iter().map(flat).collect::<Vec<_>>().join(", "))
        }
        ExprKind::Record(properties) if is_table(properties) => {
            table(properties.iter().map(|member| (key(&member.name.name), property(member, 0))))
        }
        _ => string(&documented_expression(expr)),
    }
}

/// Whether a value is written as TOML's own, and its parts too.
fn is_native(expr: &Expr) -> bool {
    match &expr.kind {
        ExprKind::Bool(_) => true,
        ExprKind::Number { text, unit: None, .. } => is_number(text),
        ExprKind::Unary(operators, operand) => {
            matches!(operators.as_slice(), [UnaryOp::Minus])
                && matches!(&operand.kind, ExprKind::Number { text, unit: None, .. } if is_number(text))
        }
        ExprKind::List(members) => members.iter().all(is_native),
        ExprKind::Record(properties) => is_table(properties),
        _ => false,
    }
}

/// Whether a record can be a table: no two names are the same, and it is not one that means something else.
fn is_table(properties: &[Property]) -> bool {
    let is_called = |name: &str| properties.iter().any(|property| property.name.name == name);
    are_distinct(properties) && !(properties.len() == 2 && is_called("value") && is_called("doc"))
}

/// Whether no two properties are called the same.
pub(super) fn are_distinct(properties: &[Property]) -> bool {
    let mut names = BTreeSet::new();
    properties.iter().all(|property| names.insert(property.name.name.as_str()))
}

/// Whether a number of the language is one of TOML, with the same text.
fn is_number(text: &str) -> bool {
    let (mantissa, exponent) = text.split_at(text.find(['e', 'E']).unwrap_or(text.len()));
    let (whole, fraction) = mantissa.split_at(mantissa.find('.').unwrap_or(mantissa.len()));
    let is_digits = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    let exponent = exponent.get(1..).map(|digits| digits.strip_prefix(['+', '-']).unwrap_or(digits));
    is_digits(whole)
        && (whole == "0" || !whole.starts_with('0'))
        && (fraction.is_empty() || is_digits(&fraction[1..]))
        && exponent.is_none_or(is_digits)
        // Integers of TOML have 64 bits.
        && (fraction.len() + exponent.map_or(0, str::len) > 0 || whole.parse::<i64>().is_ok())
}

/// An inline table.
fn table(entries: impl Iterator<Item = (String, String)>) -> String {
    let entries: Vec<String> = entries.map(|(key, value)| format!("{key} = {value}")).collect();
    if entries.is_empty() { "{}".to_owned() } else { format!("{{ {} }}", entries.join(", ")) }
}

/// The value of a property, with its doc comment.
pub(super) fn property(property: &Property, column: usize) -> String {
    property_value(property.doc.as_ref(), &property.value, column)
}

/// A value with a doc comment if it has one.
pub(super) fn property_value(doc: Option<&Doc>, expr: &Expr, column: usize) -> String {
    match doc {
        Some(doc) => table([("value".to_owned(), flat(expr)), ("doc".to_owned(), plain(&doc.text))].into_iter()),
        None => value(expr, column),
    }
}

/// The value of a `let`, `field` or `region`, with its type and doc comment.
pub(super) fn bindable(doc: Option<&Doc>, binding: &Binding, column: usize) -> String {
    // A record with a `value` would be taken for what is written here.
    let is_mistaken = matches!(&binding.value.kind, ExprKind::Record(properties)
        if properties.iter().any(|property| property.name.name == "value"));
    if doc.is_none() && binding.ty.is_none() && !is_mistaken {
        return value(&binding.value, column);
    }
    let mut entries = Vec::new();
    entries.extend(binding.ty.as_ref().map(|ty| ("type".to_owned(), name(&ty.name))));
    entries.push(("value".to_owned(), flat(&binding.value)));
    entries.extend(doc.map(|doc| ("doc".to_owned(), plain(&doc.text))));
    table(entries.into_iter())
}

/// The name of a paint: its text, or a table where it is computed.
pub(super) fn paint_name(expr: &Expr, column: usize) -> String {
    let ExprKind::String(parts) = &expr.kind else {
        return table([("value".to_owned(), value(expr, column))].into_iter());
    };
    let mut text = String::new();
    for part in parts {
        match part {
            StringPart::Text(plain) => {
                for letter in plain.chars() {
                    if matches!(letter, '{' | '}' | '\\') {
                        text.push('\\');
                    }
                    text.push(letter);
                }
            }
            StringPart::Expr(expr) => {
                text.push('{');
                text.push_str(&documented_expression(expr));
                text.push('}');
            }
        }
    }
    // Not over several lines: a line end at the end of the name counts.
    if text.contains('\n') { basic(&text) } else { string(&text) }
}

/// A list of parameters: one string, or an array where some have doc comments.
pub(super) fn params(list: &[Parameter], column: usize) -> String {
    let holds_docs = |expr: &Expr| documented_expression(expr) != expression(expr);
    let documented =
        |parameter: &Parameter| parameter.doc.is_some() || parameter.default.as_ref().is_some_and(holds_docs);
    let line = parameters(list);
    if !list.iter().any(documented) && column + line.chars().count() <= WIDTH {
        return string(&line);
    }
    let mut members = String::new();
    for parameter in list {
        let member = if documented(parameter) {
            let mut entries = vec![("name".to_owned(), name(&parameter.name.name))];
            entries.extend(parameter.ty.as_ref().map(|ty| ("type".to_owned(), name(&ty.name))));
            entries.extend(parameter.default.as_ref().map(|default| ("default".to_owned(), flat(default))));
            entries.extend(parameter.doc.as_ref().map(|doc| ("doc".to_owned(), plain(&doc.text))));
            table(entries.into_iter())
        } else {
            string(&parameters(std::slice::from_ref(parameter)))
        };
        members.push_str(&format!("  {member},\n"));
    }
    format!("[\n{members}]")
}
