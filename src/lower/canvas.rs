//! `edition`, `canvas` and `seed`.

use std::rc::Rc;

use crate::diag::{Code, Diagnostic, did_you_mean};
use crate::geom::{Length, Period, Point, Rect};
use crate::region::Region;
use crate::scene::{Canvas, Colour, Depth, Repeat};
use crate::span::Span;
use crate::syntax::ast::{Expr, Property, StatementKind};

use super::convert::Slot;
use super::cx::Cx;
use super::eval;
use super::properties::CANVAS as PROPERTIES;
use super::scope::Scope;
use super::value::{Kind, Value};

/// Sheets with a name, upright, in millimetres (ISO 216, JIS P 0138, ANSI).
const SHEETS: [(&str, f64, f64); 14] = [
    ("a0", 841.0, 1189.0),
    ("a1", 594.0, 841.0),
    ("a2", 420.0, 594.0),
    ("a3", 297.0, 420.0),
    ("a4", 210.0, 297.0),
    ("a5", 148.0, 210.0),
    ("a6", 105.0, 148.0),
    ("b4", 250.0, 353.0),
    ("b5", 176.0, 250.0),
    ("jis_b4", 257.0, 364.0),
    ("jis_b5", 182.0, 257.0),
    ("legal", 215.9, 355.6),
    ("letter", 215.9, 279.4),
    ("tabloid", 279.4, 431.8),
];
pub(super) const SHEET_NAMES: &[&str] =
    &["a0", "a1", "a2", "a3", "a4", "a5", "a6", "b4", "b5", "jis_b4", "jis_b5", "legal", "letter", "tabloid"];

/// The names of the properties.
fn names() -> impl Iterator<Item = &'static str> + Clone {
    PROPERTIES.iter().map(|known| known.name)
}

/// What a property takes.
fn slot(property: &Property) -> Slot {
    PROPERTIES.iter().find(|known| known.name == property.name.name).map_or(Slot::ANY, |known| known.slot)
}

/// Pixels per inch where neither `dpi` nor `pixels` says otherwise: the least that print shops take for line art.
const DEFAULT_DPI: f64 = 600.0;
/// The smallest sheet, in millimetres a side: less than a pixel of the finest printers.
const SMALLEST: f64 = 0.01;
/// The largest sheet, in millimetres a side.
const LARGEST: f64 = 100_000.0;
/// The finest resolution.
const FINEST: f64 = 100_000.0;

/// The canvas of a file that has none and draws nothing.
pub(super) fn default() -> Canvas {
    let (width, height) = (Length::mm(210.0), Length::mm(297.0));
    Canvas {
        width,
        height,
        bleed: Length::ZERO,
        pixels: pixels_of([width, height], DEFAULT_DPI),
        dpi: DEFAULT_DPI,
        paper: Some(Colour::WHITE),
        ink: Colour::BLACK,
        depth: Depth::Eight,
        unit: Length::mm(1.0),
        repeat: Repeat::Off,
        gain: Length::ZERO,
    }
}

/// Width and height in whole pixels, at least one each.
fn pixels_of(size: [Length; 2], dpi: f64) -> [u32; 2] {
    size.map(|length| (length.to_mm() / Length::MM_PER_INCH * dpi).round().clamp(1.0, f64::from(u32::MAX)) as u32)
}

/// Reads the canvas of the first module. What its numbers mean is known from its `unit` on.
pub(super) fn lower(cx: &mut Cx<'_, '_>) -> Option<Canvas> {
    let modules = cx.modules;
    let module = modules.first()?;
    let (properties, span) = module.document.statements.iter().find_map(|statement| match &statement.kind {
        StatementKind::Canvas(properties) => Some((properties, statement.span)),
        _ => None,
    })?;
    let mut given: Vec<&Property> = Vec::new();
    for property in properties {
        check_property(cx, property, &given);
        given.push(property);
    }
    let find = |name: &str| given.iter().find(|property| property.name.name == name).copied();
    let scope = &module.scope;
    let mut reader = Reader { cx, scope };
    let unit = reader.positive(find("unit"), Length::mm(1.0).to_mm());
    if let Some(unit) = unit {
        reader.cx.unit = unit;
    }
    let dpi = reader.number(find("dpi"), 1.0, FINEST);
    // Pixels are known while the size is read unless they follow from it.
    let assumed = (find("dpi").is_none() && find("pixels").is_none()).then_some(DEFAULT_DPI);
    reader.cx.dpi = dpi.or(assumed);
    let size = find("size").and_then(|property| reader.size(property));
    let pixels = find("pixels").and_then(|property| reader.pixels(property));
    let bleed = reader.bleed(find("bleed"));
    let paper = reader.colour(find("paper"), Some(Colour::WHITE));
    let ink = reader.colour(find("ink"), Some(Colour::BLACK));
    let depth = reader.depth(find("depth"));
    let repeat = reader.repeat(find("repeat"));
    let gain = reader.gain(find("gain"));
    // A property that is not known may have been meant for it.
    let is_known = |property: &&Property| names().any(|name| name == property.name.name);
    if find("size").is_none() && given.iter().all(is_known) {
        cx.report(
            Diagnostic::error(Code::Missing, span, "the canvas has no `size`")
                .hint("`size: a4`, or width and height: `size: (60mm, 60mm)`"),
        );
    }
    let [width, height] = size?;
    let dpi = resolution(cx, [width, height], (dpi, find("dpi")), (pixels, find("pixels")))?;
    let pixels = match (pixels, cx.config.dpi) {
        (Some(pixels), None) => pixels,
        _ => pixels_of([width, height], dpi),
    };
    cx.dpi = Some(dpi);
    // A bleed that is refused is none, so that what lies on the page is still checked.
    let grown = bleed.unwrap_or(Length::ZERO).to_mm();
    let bounds = Rect::new(Point::default(), Point::new(width.to_mm(), height.to_mm())).grown(grown);
    cx.page = Some(Region::rect(bounds));
    let (paper, ink, depth, unit, gain) = (paper?, ink??, depth?, Length::mm(unit?), gain?);
    let (repeat, bleed) = (repeat?, bleed?);
    if repeat == Repeat::Both && bleed > Length::ZERO {
        let message = "a canvas that repeats goes on beyond its borders: it has no bleed";
        cx.report(Diagnostic::error(Code::Repeat, find("bleed").map_or(span, |bleed| bleed.value.span), message));
        return None;
    }
    cx.period = match repeat {
        Repeat::Off => None,
        Repeat::Both => Some(Period::new(width, height)),
    };
    Some(Canvas { width, height, bleed, pixels, dpi, paper, ink, depth, unit, gain, repeat })
}

fn check_property(cx: &mut Cx<'_, '_>, property: &Property, earlier: &[&Property]) {
    let name = &property.name;
    if let Some(earlier) = earlier.iter().find(|earlier| earlier.name.name == name.name) {
        let message = format!("the property `{}` is given twice", name.name);
        let note = earlier.name.span;
        cx.report(Diagnostic::error(Code::Duplicate, name.span, message).note(note, "first given here"));
    } else if !names().any(|known| known == name.name) {
        let hint = did_you_mean(&name.name, names()).unwrap_or_else(|| {
            let names: Vec<String> = names().map(|name| format!("`{name}`")).collect();
            format!("a canvas has {}", names.join(", "))
        });
        let message = format!("a canvas has no property `{}`", name.name);
        cx.report(Diagnostic::error(Code::UnknownProperty, name.span, message).hint(hint));
    }
}

/// Pixels per inch: the command line's, else from `pixels`, else `dpi`.
fn resolution(
    cx: &mut Cx<'_, '_>,
    [width, height]: [Length; 2],
    (dpi, dpi_property): (Option<f64>, Option<&Property>),
    (pixels, pixels_property): (Option<[u32; 2]>, Option<&Property>),
) -> Option<f64> {
    if let (Some(_), Some(property)) = (dpi_property, pixels_property) {
        let message = "`pixels` and `dpi` say the same thing: give one of them";
        cx.report(Diagnostic::error(Code::Duplicate, property.name.span, message));
        return None;
    }
    let from_pixels = match (pixels, pixels_property) {
        (Some([across, down]), Some(property)) => {
            let dpi = f64::from(across) / (width.to_mm() / Length::MM_PER_INCH);
            let expected = height.to_mm() / Length::MM_PER_INCH * dpi;
            if (expected - f64::from(down)).abs() > 1.0 {
                let message = format!("{across} by {down} pixels do not have the canvas's proportions");
                let hint = format!("for this size they would be ({across}, {})", expected.round());
                cx.report(Diagnostic::error(Code::Range, property.value.span, message).hint(hint));
                return None;
            }
            Some(dpi)
        }
        _ => None,
    };
    let declared_wrong = (dpi_property.is_some() && dpi.is_none()) || (pixels_property.is_some() && pixels.is_none());
    let declared = from_pixels.or(dpi).or((!declared_wrong).then_some(DEFAULT_DPI));
    cx.config.dpi.or(declared)
}

struct Reader<'r, 'a, 'c> {
    cx: &'r mut Cx<'a, 'c>,
    scope: &'r Rc<Scope<'a>>,
}

impl<'a> Reader<'_, 'a, '_> {
    fn refuse<T>(&mut self, span: Span, message: impl Into<String>) -> Option<T> {
        self.cx.report(Diagnostic::error(Code::Range, span, message));
        None
    }

    /// Millimetres greater than zero.
    fn positive(&mut self, property: Option<&'a Property>, default: f64) -> Option<f64> {
        let Some(property) = property else { return Some(default) };
        let mm = eval::expect(self.cx, self.scope, &property.value, slot(property)).as_length()?;
        if mm > 0.0 && mm <= LARGEST {
            return Some(mm);
        }
        self.refuse(property.value.span, format!("`{}` must be greater than zero", property.name.name))
    }

    /// How far ink spreads. Tones whose pens are no wider are refused where they are painted.
    fn gain(&mut self, property: Option<&'a Property>) -> Option<Length> {
        let Some(property) = property else { return Some(Length::ZERO) };
        let mm = eval::expect(self.cx, self.scope, &property.value, slot(property)).as_length()?;
        if !(0.0..=LARGEST).contains(&mm) {
            let wrong = if mm < 0.0 { "must not be negative" } else { "is at most 100 metres" };
            return self.refuse(property.value.span, format!("`gain` {wrong}"));
        }
        self.cx.gain = Some((Length::mm(mm), property.value.span));
        Some(Length::mm(mm))
    }

    /// How far the picture goes on beyond the page.
    fn bleed(&mut self, property: Option<&'a Property>) -> Option<Length> {
        let Some(property) = property else { return Some(Length::ZERO) };
        let mm = eval::expect(self.cx, self.scope, &property.value, slot(property)).as_length()?;
        if (0.0..=LARGEST).contains(&mm) {
            return Some(Length::mm(mm));
        }
        let wrong = if mm < 0.0 { "must not be negative" } else { "is at most 100 metres" };
        self.refuse(property.value.span, format!("`bleed` {wrong}"))
    }

    /// A number in a range; `None` where it is not given.
    fn number(&mut self, property: Option<&'a Property>, low: f64, high: f64) -> Option<f64> {
        let property = property?;
        let value = eval::expect(self.cx, self.scope, &property.value, slot(property)).number()?;
        if (low..=high).contains(&value) {
            return Some(value);
        }
        self.refuse(property.value.span, format!("`{}` must lie between {low} and {high}", property.name.name))
    }

    fn size(&mut self, property: &'a Property) -> Option<[Length; 2]> {
        let value = eval::expect(self.cx, self.scope, &property.value, slot(property));
        if let Value::Word(word) = value {
            let sheet = SHEETS.iter().find(|(name, ..)| *name == word);
            return sheet.map(|(_, width, height)| [Length::mm(*width), Length::mm(*height)]);
        }
        let size = value.as_point()?;
        if !(size.x >= SMALLEST && size.y >= SMALLEST) {
            return self.refuse(property.value.span, format!("a canvas is at least {SMALLEST}mm wide and high"));
        }
        if size.x > LARGEST || size.y > LARGEST {
            return self.refuse(property.value.span, "a canvas is at most 100 metres wide and high");
        }
        Some([Length::mm(size.x), Length::mm(size.y)])
    }

    fn pixels(&mut self, property: &'a Property) -> Option<[u32; 2]> {
        let value = eval::eval(self.cx, self.scope, &property.value, Slot::ANY);
        let numbers: Option<Vec<f64>> = match &value {
            Value::Unknown(_) => return None,
            Value::Tuple(members) if members.len() == 2 => members
                .iter()
                .map(|member| match member {
                    Value::Number(number) => Some(*number),
                    _ => None,
                })
                .collect(),
            _ => None,
        };
        let Some(numbers) = numbers else {
            let message = format!("expected two whole numbers, found {}", value.describe());
            let diagnostic = Diagnostic::error(Code::Type, property.value.span, message);
            self.cx.report(diagnostic.hint("width and height: `pixels: (512, 512)`"));
            return None;
        };
        let fits = |number: &f64| number.fract() == 0.0 && (1.0..=1e6).contains(number);
        if !numbers.iter().all(fits) {
            return self.refuse(property.value.span, "`pixels` are two whole numbers from 1 to 1,000,000");
        }
        Some([numbers[0] as u32, numbers[1] as u32])
    }

    /// A colour; the inner `None` is the word `none`.
    fn colour(&mut self, property: Option<&'a Property>, default: Option<Colour>) -> Option<Option<Colour>> {
        let Some(property) = property else { return Some(default) };
        match eval::expect(self.cx, self.scope, &property.value, slot(property)) {
            Value::Colour(colour) => Some(Some(colour)),
            Value::Word(_) => Some(None),
            _ => None,
        }
    }

    fn depth(&mut self, property: Option<&'a Property>) -> Option<Depth> {
        let Some(property) = property else { return Some(Depth::Eight) };
        match eval::expect(self.cx, self.scope, &property.value, slot(property)) {
            Value::Number(8.0) => Some(Depth::Eight),
            Value::Number(1.0) => Some(Depth::One),
            Value::Number(_) => self.refuse(property.value.span, "`depth` is 8 (grey) or 1 (ink or paper)"),
            _ => None,
        }
    }

    fn repeat(&mut self, property: Option<&'a Property>) -> Option<Repeat> {
        let Some(property) = property else { return Some(Repeat::Off) };
        match eval::expect(self.cx, self.scope, &property.value, slot(property)) {
            Value::Bool(true) => Some(Repeat::Both),
            Value::Bool(false) => Some(Repeat::Off),
            _ => None,
        }
    }
}

/// The seed of the first module.
pub(super) fn seed(cx: &mut Cx<'_, '_>) -> Option<u64> {
    let modules = cx.modules;
    let module = modules.first()?;
    let seed = module.document.statements.iter().find_map(|statement| match &statement.kind {
        StatementKind::Seed(seed) => Some(seed),
        _ => None,
    })?;
    seed_value(cx, &module.scope, seed)
}

/// A seed: a whole number that is not negative.
pub(super) fn seed_value<'a>(cx: &mut Cx<'a, '_>, scope: &Rc<Scope<'a>>, expr: &'a Expr) -> Option<u64> {
    let Value::Number(number) = eval::expect(cx, scope, expr, Slot::of(Kind::Number)) else { return None };
    // Above 2^53 neighbouring whole numbers are no longer told apart.
    if number.fract() == 0.0 && (0.0..=9_007_199_254_740_992.0).contains(&number) {
        return Some(number as u64);
    }
    let message = "a seed is a whole number from 0 to 2^53";
    cx.report_value(Diagnostic::error(Code::Range, expr.span, message));
    None
}

/// Reports an edition that this program does not know.
pub(super) fn check_edition<'a>(cx: &mut Cx<'a, '_>, edition: &'a Expr) {
    let Some(module) = cx.modules.first() else { return };
    let scope = Rc::clone(&module.scope);
    // An edition is a plain number; names would make it depend on what it governs.
    match eval::expect(cx, &scope, edition, Slot::of(Kind::Number)) {
        Value::Number(1.0) | Value::Unknown(_) => {}
        other => {
            let message = format!("edition {} is not known", other.text());
            cx.report(Diagnostic::error(Code::Edition, edition.span, message).hint("this program knows edition 1"));
        }
    }
}
