//! What the grammar did not find, in words.
//!
//! In: the rules that were tried where a text stopped fitting, and the words around that place. Out: a diagnostic.

use super::grammar::Rule;
use super::near_word;
use super::scan::Kind;
use crate::diag::{Code, Diagnostic};
use crate::span::Span;
use crate::syntax::ast::Unit;

/// A token, as the diagnostic sees it.
type Word<'t> = (Option<Kind>, &'t str);

/// The place where the text stopped fitting.
pub(super) struct Place<'t> {
    /// What stands there; nothing at the end of the statement.
    pub(super) found: Option<Word<'t>>,
    /// What stands before it.
    pub(super) before: Option<Word<'t>>,
    /// The first word of the statement.
    pub(super) first: &'t str,
    /// What may follow when the statement, property or expression is done.
    pub(super) next: &'static str,
}

/// Things that can be expected, in the order in which a message lists them.
const PHRASES: &[(&[Rule], &str)] = &[
    (
        &[
            Rule::expression,
            Rule::argument,
            Rule::number,
            Rule::string,
            Rule::boolean,
            Rule::tuple,
            Rule::list,
            Rule::record,
        ],
        "a value",
    ),
    (&[Rule::path], "a path in quotes"),
    (&[Rule::pattern, Rule::arm], "a pattern"),
    (&[Rule::property], "a property"),
    (&[Rule::parameter, Rule::parameters], "a parameter"),
    (&[Rule::type_name], "a type"),
    (&[Rule::label], "a property's name"),
    (&[Rule::name, Rule::binding], "a name"),
    (&[Rule::colon], "`:`"),
    (&[Rule::equals], "`=`"),
    (&[Rule::arrow], "`=>`"),
    (&[Rule::word_with], "`with`"),
    (&[Rule::word_in], "`in`"),
    (&[Rule::word_pen], "`pen`"),
    (&[Rule::word_ink], "`ink`"),
    (&[Rule::word_then], "`then`"),
    (&[Rule::word_else], "`else`"),
    (&[Rule::word_if], "`if`"),
    (&[Rule::word_as, Rule::paint_name], "`as`"),
    (&[Rule::word_seed, Rule::paint_seed], "`seed`"),
    (&[Rule::comma], "`,`"),
    (&[Rule::open_paren, Rule::parameter_list], "`(`"),
    (&[Rule::open_brace], "`{`"),
    (&[Rule::close_paren], "`)`"),
    (&[Rule::close_bracket], "`]`"),
    (&[Rule::close_brace], "`}`"),
];

/// The words that may be expected inside a statement.
const JOINING: &[&str] = &["with", "in", "pen", "ink", "then", "else", "as", "seed"];

/// A token in words.
pub(super) fn describe(kind: Option<Kind>, text: &str) -> String {
    const LONGEST: usize = 40;
    match kind {
        Some(Kind::Text | Kind::TextOpen | Kind::TextClose | Kind::BadText) => "a string".to_owned(),
        Some(Kind::Number) if text.len() <= LONGEST => format!("the number `{text}`"),
        Some(Kind::Number) => "a number".to_owned(),
        Some(_) if text == "`" => "a back quote".to_owned(),
        Some(_) if text.len() <= LONGEST => format!("`{text}`"),
        Some(_) => "a word".to_owned(),
        None => "the end".to_owned(),
    }
}

/// `a, b or c`
fn either(phrases: &[&str]) -> String {
    match phrases {
        [] => String::new(),
        [only] => (*only).to_owned(),
        [first @ .., last] => format!("{} or {last}", first.join(", ")),
    }
}

/// What to say where the text does not fit.
pub(super) fn message(tried: &[Rule], place: &Place, span: Span) -> Diagnostic {
    let tries = |rule: &Rule| tried.contains(rule);
    let mut phrases: Vec<&str> = Vec::new();
    for (rules, phrase) in PHRASES {
        if rules.iter().any(tries) {
            phrases.push(phrase);
        }
    }
    if place.first == "import" && phrases.first() == Some(&"a value") {
        phrases = vec!["a path in quotes"];
    }
    // What a value begins with is part of what a value is, and behind a value a call is always possible.
    if phrases.contains(&"a value") {
        phrases.retain(|phrase| !matches!(*phrase, "a name" | "`(`" | "`if`"));
    } else if tries(&Rule::infix) {
        phrases.retain(|phrase| *phrase != "`(`");
    }
    if phrases == ["`:`"] {
        phrases = vec!["`:` after the property's name"];
    }
    let has_tail = phrases.iter().any(|phrase| !matches!(*phrase, "`as`" | "`seed`" | "`in`" | "`,`"));
    let due = if tries(&Rule::EOI) && !has_tail {
        // Nothing but an operator or an optional part could follow: whatever stands here belongs to nothing.
        if tries(&Rule::infix) {
            phrases.insert(0, "an operator");
        }
        phrases.push(place.next);
        either(&phrases)
    } else if phrases.is_empty() {
        "something else".to_owned()
    } else {
        either(&phrases)
    };
    let diagnostic = match (place.found, place.before) {
        (Some((kind, text)), _) => {
            Diagnostic::error(Code::Syntax, span, format!("expected {due}, found {}", describe(kind, text)))
        }
        (None, Some((kind, text))) => {
            let message = format!("expected {due} after {}", describe(kind, text));
            Diagnostic::error(Code::Syntax, span, message).label("nothing follows this")
        }
        (None, None) => Diagnostic::error(Code::Syntax, span, format!("expected {due}")),
    };
    diagnostic.maybe_hint(hint(&phrases, place))
}

/// A way out, for the slips that are known.
fn hint(phrases: &[&str], place: &Place) -> Option<String> {
    let (kind, text) = place.found?;
    let (before_kind, before) = place.before.unwrap_or((None, ""));
    let wants = |phrase: &str| phrases.contains(&phrase);
    let ends_in_digit = before.ends_with(|letter: char| letter.is_ascii_digit());
    let after_number = before_kind == Some(Kind::Number);
    if after_number && ends_in_digit && Unit::ALL.iter().any(|unit| unit.symbol() == text) {
        return Some(format!("a unit touches its number: `{before}{text}`"));
    }
    if after_number && before.ends_with('%') {
        return Some(format!("`{before}` is a share; to divide and keep the rest, write ` % ` with spaces around it"));
    }
    match text {
        "." if after_number => return Some(format!("digits stand on both sides of a point: `{before}.0`")),
        "." if wants("a value") => return Some("digits stand on both sides of a point: `0.5`".to_owned()),
        "=" if wants("`,`") => return Some("an argument is named with a colon: `name: value`".to_owned()),
        "=" if phrases.iter().any(|phrase| phrase.starts_with("`:`")) => {
            return Some("a property is written `name: value`".to_owned());
        }
        "=" if wants("a value") && before == "=" => return Some("equality is written `==`".to_owned()),
        "=" if wants("an operator") || wants("`then`") || wants("`{`") => {
            return Some("equality is written `==`".to_owned());
        }
        ">" if before == "-" => return Some("an arm is written `pattern => value`".to_owned()),
        _ if place.first == "paint" && before == "with" && wants("`with`") => {
            return Some("the region comes first: `paint canvas with …`".to_owned());
        }
        "&" if before == "&" => return Some("conditions are joined with `and`".to_owned()),
        "|" => return Some("conditions are joined with `or`, regions with `+`".to_owned()),
        "!" => return Some("a condition is turned round with `not`".to_owned()),
        "*" if before == "*" => return Some("a power is written `a ^ b`".to_owned()),
        ";" => return Some("statements and properties end by themselves: leave the `;` out".to_owned()),
        "'" => return Some("strings stand in double quotes".to_owned()),
        "?" => return Some("a choice is written `if a then b else c`".to_owned()),
        "then" if place.first == "if" => return Some("a statement `if` is written `if … { … }`".to_owned()),
        "{" if wants("`then`") => return Some("inside an expression, `if` is written `if a then b else c`".to_owned()),
        _ => {}
    }
    if let Some(ascii) = half_width(text) {
        return Some(format!("this is a full-width sign: write `{ascii}`"));
    }
    if kind == Some(Kind::Word) {
        if super::RESERVED.contains(&text) && (wants("a name") || wants("a parameter")) {
            return Some(format!("`{text}` is a word of the language and cannot be a name"));
        }
        let wanted: Vec<&str> =
            JOINING.iter().copied().filter(|word| phrases.contains(&format!("`{word}`").as_str())).collect();
        return near_word(text, &wanted);
    }
    None
}

/// The ASCII form of a full-width sign, as Japanese keyboards give it.
fn half_width(text: &str) -> Option<char> {
    let mut letters = text.chars();
    let letter = letters.next().filter(|letter| ('\u{ff01}'..='\u{ff5e}').contains(letter))?;
    if letters.next().is_some() {
        return None;
    }
    char::from_u32(u32::from(letter) - 0xfee0)
}
