//! Pins: what a swatch looked like when it was last accepted, as text that is fit for review.
//!
//! ```toml
//! fingerprint = "sha256:9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08"
//! marks = 1204
//! page = "60 x 30 mm"
//! tiles = 131
//!
//! [paint.sheet]
//! c_cov = 0.981273
//!
//! [warnings]
//! clamped = 1
//! ```
//!
//! Keys are in order, one value a line. Figures have six significant digits. Of a warning only the code is kept: its words
//! may be bettered from one release to the next.

use std::collections::BTreeMap;
use std::fmt;

use crate::diag::{Code, Diagnostic, sort};
use crate::span::SourceId;
use crate::syntax::toml::data::{Entry, Kind, Value, data};

use super::lock::quoted;

/// What is pinned of a swatch.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Pin {
    /// Tells its drawing from every other.
    pub fingerprint: String,
    /// How many strokes, dots and filled outlines it has.
    pub marks: u64,
    /// The size of its page, in words.
    pub page: String,
    /// How many tiles it has.
    pub tiles: u64,
    /// What its paints measure, by their names and the measures'.
    pub paints: BTreeMap<String, BTreeMap<String, Figure>>,
    /// How many warnings there are of each code.
    pub warnings: BTreeMap<String, u64>,
}

/// A figure of six significant digits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Figure(f64);

impl Figure {
    /// A value, rounded; none where it is not finite.
    #[must_use]
    pub fn new(value: f64) -> Option<Self> {
        let rounded: f64 = format!("{value:.5e}").parse().ok()?;
        // Minus zero is no other figure than zero.
        rounded.is_finite().then_some(Self(rounded + 0.0))
    }

    /// Its value.
    #[must_use]
    pub fn value(self) -> f64 {
        self.0
    }
}

/// As TOML has it; counts without a point.
impl fmt::Display for Figure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const SIX_DIGITS: f64 = 1e6;
        if self.0.fract() == 0.0 && self.0.abs() < SIX_DIGITS {
            write!(f, "{}", self.0)
        } else {
            write!(f, "{:?}", self.0)
        }
    }
}

/// One value that is not what was pinned.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Change {
    /// What it is a value of: `tiles`, or `sheet: c_cov`.
    pub what: String,
    /// What was pinned, if it was.
    pub old: Option<String>,
    /// What it is now, if it is there.
    pub new: Option<String>,
}

impl Pin {
    /// Reads a pin.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn parse(source: SourceId, text: &str) -> Result<Self, Vec<Diagnostic>> {
        let (entries, diagnostics) = data(source, text);
        let mut reader = Reader { diagnostics };
        let mut pin = Self::default();
        for entry in &entries {
            match entry.key.as_str() {
                "fingerprint" => pin.fingerprint = reader.text(entry),
                "page" => pin.page = reader.text(entry),
                "marks" => pin.marks = reader.count(entry),
                "tiles" => pin.tiles = reader.count(entry),
                "paint" => {
                    for paint in reader.table(entry) {
                        let figures = reader.table(paint);
                        let figures = figures.iter().map(|entry| (entry.key.clone(), reader.figure(entry))).collect();
                        pin.paints.insert(paint.key.clone(), figures);
                    }
                }
                "warnings" => {
                    let counts = reader.table(entry);
                    pin.warnings = counts.iter().map(|entry| (entry.key.clone(), reader.count(entry))).collect();
                }
                _ => {
                    let known = ["fingerprint", "marks", "page", "tiles", "paint", "warnings"];
                    reader.diagnostics.push(entry.unknown("a pin", &known));
                }
            }
        }
        if reader.diagnostics.is_empty() && pin.fingerprint.is_empty() {
            let diagnostic = Diagnostic::without_span(Code::Pin, "a pin has no fingerprint");
            reader.diagnostics.push(diagnostic);
        }
        sort(&mut reader.diagnostics);
        if reader.diagnostics.is_empty() { Ok(pin) } else { Err(reader.diagnostics) }
    }

    /// Every value by its name, in order, the fingerprint excepted.
    fn values(&self) -> BTreeMap<(u8, String, String), String> {
        let mut values = BTreeMap::new();
        let whole = [("marks", self.marks.to_string()), ("page", self.page.clone()), ("tiles", self.tiles.to_string())];
        for (name, value) in whole {
            values.insert((0, String::new(), name.to_owned()), value);
        }
        for (paint, figures) in &self.paints {
            for (name, figure) in figures {
                values.insert((1, paint.clone(), name.clone()), figure.to_string());
            }
        }
        for (code, count) in &self.warnings {
            values.insert((2, "warnings".to_owned(), code.clone()), count.to_string());
        }
        values
    }

    /// Every value that is another one now, the fingerprint excepted.
    #[must_use]
    pub fn changes(&self, now: &Self) -> Vec<Change> {
        let (old, new) = (self.values(), now.values());
        let mut keys: Vec<_> = old.keys().chain(new.keys()).collect();
        keys.sort();
        keys.dedup();
        let changed = keys.into_iter().filter(|key| old.get(*key) != new.get(*key));
        let change = |key: &(u8, String, String)| Change {
            what: if key.1.is_empty() { key.2.clone() } else { format!("{}: {}", key.1, key.2) },
            old: old.get(key).cloned(),
            new: new.get(key).cloned(),
        };
        changed.map(change).collect()
    }
}

/// As the text of the file.
impl fmt::Display for Pin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "# What this swatch was when it was last accepted, written by `kake test --accept`.")?;
        writeln!(f, "fingerprint = {}", quoted(&self.fingerprint))?;
        writeln!(f, "marks = {}", self.marks)?;
        writeln!(f, "page = {}", quoted(&self.page))?;
        writeln!(f, "tiles = {}", self.tiles)?;
        for (paint, figures) in &self.paints {
            writeln!(f, "\n[paint.{}]", key(paint))?;
            for (name, figure) in figures {
                writeln!(f, "{} = {figure}", key(name))?;
            }
        }
        if !self.warnings.is_empty() {
            writeln!(f, "\n[warnings]")?;
            for (code, count) in &self.warnings {
                writeln!(f, "{} = {count}", key(code))?;
            }
        }
        Ok(())
    }
}

/// A key of TOML, in quotes where it needs them.
fn key(name: &str) -> String {
    let is_bare = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
    if !name.is_empty() && name.chars().all(is_bare) { name.to_owned() } else { quoted(name) }
}

struct Reader {
    diagnostics: Vec<Diagnostic>,
}

impl Reader {
    fn wrong(&mut self, entry: &Entry, wanted: &str) {
        if entry.value.kind != Kind::Lost {
            self.diagnostics.push(entry.wrong_type(wanted));
        }
    }

    fn text(&mut self, entry: &Entry) -> String {
        if let Kind::Text(text) = &entry.value.kind {
            return text.clone();
        }
        self.wrong(entry, "a string");
        String::new()
    }

    fn count(&mut self, entry: &Entry) -> u64 {
        if let Kind::Integer(count) = entry.value.kind
            && let Ok(count) = u64::try_from(count)
        {
            return count;
        }
        self.wrong(entry, "a whole number");
        0
    }

    fn figure(&mut self, entry: &Entry) -> Figure {
        let value = match entry.value.kind {
            Kind::Integer(whole) => Some(whole as f64),
            Kind::Float(value) => Some(value),
            _ => None,
        };
        value.and_then(Figure::new).unwrap_or_else(|| {
            self.wrong(entry, "a finite number");
            Figure(0.0)
        })
    }

    fn table<'e>(&mut self, entry: &'e Entry) -> &'e [Entry] {
        if let Value { kind: Kind::Table(entries), .. } = &entry.value {
            return entries;
        }
        self.wrong(entry, "a table");
        &[]
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::span::{Sources, Syntax};

    fn parse(text: &str) -> Result<Pin, Vec<Diagnostic>> {
        let mut sources = Sources::new();
        let source = sources.add("pins/night.toml", text, Syntax::Toml);
        Pin::parse(source, text)
    }

    fn sample() -> Pin {
        let figures = [("c_cov", 0.987_654_321), ("density", -0.0), ("xi", 1e-9)];
        let figures = figures.map(|(name, value)| (name.to_owned(), Figure::new(value).expect("it is finite")));
        Pin {
            fingerprint: "sha256:12".to_owned(),
            marks: 7,
            page: "60 x 30 mm".to_owned(),
            tiles: 3,
            paints: BTreeMap::from([("the \"night\"\n夜".to_owned(), BTreeMap::from(figures))]),
            warnings: BTreeMap::from([("clamped".to_owned(), 2)]),
        }
    }

    #[test]
    fn what_is_written_is_read() {
        let pin = sample();
        insta::assert_snapshot!(pin, @r#"
        # What this swatch was when it was last accepted, written by `kake test --accept`.
        fingerprint = "sha256:12"
        marks = 7
        page = "60 x 30 mm"
        tiles = 3

        [paint."the \"night\"\n夜"]
        c_cov = 0.987654
        density = 0
        xi = 1e-9

        [warnings]
        clamped = 2
        "#);
        assert_eq!(parse(&pin.to_string()), Ok(pin));
    }

    #[test]
    fn changes_are_named() {
        let old = sample();
        let mut new = Pin { tiles: 4, warnings: BTreeMap::new(), ..sample() };
        new.paints.insert("fog".to_owned(), BTreeMap::from([("xi".to_owned(), Figure(1.5))]));
        let shown = |change: &Change| {
            let or_none = |value: &Option<String>| value.clone().unwrap_or("-".to_owned());
            format!("{} {} {}", change.what, or_none(&change.old), or_none(&change.new))
        };
        let words: Vec<String> = old.changes(&new).iter().map(shown).collect();
        assert_eq!(words, ["tiles 3 4", "fog: xi - 1.5", "warnings: clamped 2 -"]);
        assert_eq!(old.changes(&Pin { fingerprint: "sha256:34".to_owned(), ..sample() }), []);
    }

    #[test]
    fn broken_pins_are_refused() {
        for text in ["", "marks = -1", "fingerprint = 1", "<<<<<<< HEAD\n", "[paint.a]\nx = nan", "paint = 1", "x = 1"]
        {
            assert!(parse(text).is_err(), "{text}");
        }
    }

    proptest! {
        #[test]
        fn figures_come_back(value in any::<f64>()) {
            let Some(figure) = Figure::new(value) else { return Ok(()) };
            prop_assert_eq!(Figure::new(figure.value()), Some(figure));
            let pin = Pin {
                paints: BTreeMap::from([("a".to_owned(), BTreeMap::from([("x".to_owned(), figure)]))]),
                ..sample()
            };
            prop_assert_eq!(parse(&pin.to_string()), Ok(pin));
        }
    }
}
