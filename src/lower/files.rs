//! Pictures and drawings that a scene reads: found below the root, read once, decoded once.

use std::rc::Rc;
use std::sync::Arc;

use crate::diag::{Code, Diagnostic, did_you_mean, grouped};
use crate::field::{Channel, Field, Image, ImageError};
use crate::geom::{Length, Rect};
use crate::loader;
use crate::region::Region;
use crate::region::flood::{Border, FloodConfig, FloodError};
use crate::region::svg::{Lack, Selection, SvgError, SvgFile, hex, ink, outlines};
use crate::scene::{Cap, Colour, InkMark, InkShape};

use super::call::Call;
use super::modules;
use super::value::Value;

/// Standard deviations below so many samples change nothing that is seen.
const LEAST_BLUR: f64 = 0.1;

/// What the blurring of an image counts at least, in pixels: the smallest ones take memory too.
const LEAST_CHARGE: u64 = 10_000;

/// What helps where outlines cross too often.
pub(super) const SIMPLIFY: &str = "simplify the outline, or split it into parts";

/// The bytes of the file that the argument `file` names, with its path from the root.
fn read(call: &mut Call<'_, '_, '_>) -> Option<(String, Arc<[u8]>)> {
    let Some(Value::String(text)) = call.value("file") else { return None };
    let span = call.span_of("file");
    let from = call.cx.path_of(text.source);
    let path = match loader::find(call.cx.loader, from, &text.value) {
        Ok(path) => path,
        Err(unfound) => {
            let (code, message, hint) = modules::not_found(from, &text.value, &unfound);
            call.cx.report_value(Diagnostic::error(code, span, message).hint(hint));
            return None;
        }
    };
    if let Some(bytes) = call.cx.file(&path) {
        return Some((path, bytes));
    }
    match call.cx.loader.load(&path) {
        Ok(bytes) => {
            call.cx.remember_file(&path, &bytes);
            Some((path, bytes))
        }
        Err(error) => {
            let (code, message, hint) = modules::load_error(&path, &error);
            call.cx.report_value(Diagnostic::error(code, span, message).maybe_hint(hint));
            None
        }
    }
}

/// One channel of the picture that the argument `file` names.
pub(super) fn image(call: &mut Call<'_, '_, '_>, channel: &'static str) -> Option<Arc<Image>> {
    let (path, bytes) = read(call)?;
    let key = (path, channel);
    if let Some(known) = call.cx.images.get(&key) {
        return known.clone();
    }
    let chosen = match channel {
        "red" => Channel::Red,
        "green" => Channel::Green,
        "blue" => Channel::Blue,
        "alpha" => Channel::Alpha,
        _ => Channel::Luminance,
    };
    let most = call.cx.config.limits.megapixels.saturating_mul(1_000_000);
    let image = match Image::decode_channel(&bytes, chosen, most) {
        Ok(image) => Some(Arc::new(image)),
        Err(error) => {
            let span = call.span_of("file");
            let message = format!("`{}`: {error}", key.0);
            call.cx.report_value(match error {
                ImageError::TooLarge { width, height, .. } => {
                    let needed = (u64::from(width) * u64::from(height)).div_ceil(1_000_000);
                    let hint = format!("`--limit megapixels={needed}` lifts the limit, or make the picture smaller");
                    Diagnostic::error(Code::Limit, span, message).hint(hint)
                }
                ImageError::UnknownFormat => {
                    Diagnostic::error(Code::Image, span, message).hint("save it as PNG or JPEG")
                }
                ImageError::Empty | ImageError::Damaged(_) => Diagnostic::error(Code::Image, span, message),
            });
            None
        }
    };
    call.cx.images.insert(key, image.clone());
    image
}

/// An image blurred by a Gaussian of a standard deviation on the page, where it fills `place`; `argument` is what asks
/// for it.
pub(super) fn blurred(
    call: &mut Call<'_, '_, '_>,
    argument: &str,
    image: &Arc<Image>,
    place: &Rect,
    deviation: Length,
) -> Option<Arc<Image>> {
    let samples = deviation.to_mm() / place.width() * f64::from(image.width);
    if samples < LEAST_BLUR {
        return Some(Arc::clone(image));
    }
    // Two images at one address are one image: those that are known are kept.
    let key = (Arc::as_ptr(image).addr(), samples.to_bits());
    if let Some((_, known)) = call.cx.blurred.get(&key) {
        return Some(Arc::clone(known));
    }
    let most = call.cx.config.limits.megapixels.saturating_mul(1_000_000);
    let pixels = (u64::from(image.width) * u64::from(image.height)).max(LEAST_CHARGE);
    let all = call.cx.blurred_pixels.saturating_add(pixels);
    if all > most {
        let needed = all.div_ceil(1_000_000);
        let message = format!("images of more than {} pixels in all would be blurred", grouped(most));
        let hint = format!("`--limit megapixels={needed}` lifts the limit, or make the pictures smaller");
        call.cx.report_value(Diagnostic::error(Code::Limit, call.span_of(argument), message).hint(hint));
        return None;
    }
    call.cx.blurred_pixels = all;
    let result = Arc::new(image.blurred(samples));
    call.cx.blurred.insert(key, (Arc::clone(image), Arc::clone(&result)));
    Some(result)
}

/// A field whose images are blurred by a Gaussian of a standard deviation on the page.
pub(super) fn smoothed(call: &mut Call<'_, '_, '_>, argument: &str, of: &Field, deviation: Length) -> Option<Field> {
    of.with_images(&mut |image, place| blurred(call, argument, image, place, deviation))
}

/// Reads the SVG file that the argument `file` names, once.
fn drawing(call: &mut Call<'_, '_, '_>) -> Option<(String, Rc<SvgFile>)> {
    let (path, bytes) = read(call)?;
    let drawing = match call.cx.drawings.get(&path) {
        Some(known) => known.clone(),
        None => {
            let drawing = match outlines(&bytes) {
                Ok(drawing) => Some(Rc::new(drawing)),
                Err(error) => {
                    refuse(call, &path, &error);
                    None
                }
            };
            call.cx.drawings.insert(path.clone(), drawing.clone());
            drawing
        }
    }?;
    Some((path, drawing))
}

/// The arguments that choose a part of an SVG file.
const CHOOSING: [&str; 4] = ["id", "layer", "class", "colour"];

/// The part of an SVG file that the arguments choose.
enum Chosen {
    Whole,
    Id(Rc<str>),
    Layer(Rc<str>),
    Class(Rc<str>),
    Colour([u8; 3]),
}

impl Chosen {
    fn of(call: &mut Call<'_, '_, '_>) -> Option<Self> {
        let given: Vec<&str> = CHOOSING.into_iter().filter(|name| call.has(name)).collect();
        let (name, more) = match given.split_first() {
            None => return Some(Self::Whole),
            Some((&name, more)) => (name, more.first()),
        };
        if let Some(second) = more {
            let message = format!("`{}` takes one of `id`, `layer`, `class` and `colour`", call.signature.name);
            call.cx.report(Diagnostic::error(Code::Duplicate, call.span_of(second), message));
            return None;
        }
        match (name, call.value(name)?) {
            ("id", Value::String(text)) => Some(Self::Id(text.value)),
            ("layer", Value::String(text)) => Some(Self::Layer(text.value)),
            ("class", Value::String(text)) => Some(Self::Class(text.value)),
            (_, Value::Colour(colour)) => Some(Self::Colour([colour.r, colour.g, colour.b])),
            _ => None,
        }
    }

    fn selection(&self) -> Selection<'_> {
        match self {
            Self::Whole => Selection::Whole,
            Self::Id(id) => Selection::Id(id),
            Self::Layer(layer) => Selection::Layer(layer),
            Self::Class(class) => Selection::Class(class),
            Self::Colour(colour) => Selection::Colour(*colour),
        }
    }
}

/// Makes something of the part of an SVG file that the arguments choose, on the page or in the box `fit`.
fn part<T>(
    call: &mut Call<'_, '_, '_>,
    make: impl FnOnce(&SvgFile, Selection<'_>, Option<Rect>) -> Result<T, SvgError>,
) -> Option<T> {
    let fit = if call.has("fit") { Some(call.area("fit")?) } else { None };
    let (path, drawing) = drawing(call)?;
    let chosen = Chosen::of(call)?;
    match make(&drawing, chosen.selection(), fit) {
        Ok(made) => Some(made),
        Err(error) => {
            refuse(call, &path, &error);
            None
        }
    }
}

/// What is filled.
pub(super) fn svg(call: &mut Call<'_, '_, '_>) -> Option<Region> {
    part(call, SvgFile::region)
}

/// What is drawn, with a warning where that is not all, or not as the file has it.
pub(super) fn ink(call: &mut Call<'_, '_, '_>) -> Option<Vec<InkMark>> {
    let inked = part(call, SvgFile::ink)?;
    if !inked.lacks.is_empty() {
        let lacks: Vec<&str> = inked.lacks.iter().map(|lack| described(*lack)).collect();
        let message = format!("not all is drawn as the SVG file has it: {}", lacks.join(", "));
        let diagnostic = Diagnostic::warning(Code::SvgLook, call.span_of("file"), message);
        call.cx.report_value(diagnostic.hint("ink is strokes and fills in plain colours"));
    }
    let marks = inked.marks.into_iter().map(|mark| {
        let [r, g, b, a] = mark.colour;
        let shape = match mark.shape {
            ink::InkShape::Area(area) => InkShape::Area(area),
            ink::InkShape::Lines { width, is_round, chains } => {
                InkShape::Strokes { pen: width, cap: if is_round { Cap::Round } else { Cap::Butt }, chains }
            }
        };
        InkMark { colour: Colour { r, g, b, a }, shape }
    });
    Some(marks.collect())
}

/// Something of a file's look that ink does not have.
fn described(lack: Lack) -> &'static str {
    match lack {
        Lack::Gradient => "gradients are drawn in their mean colour",
        Lack::Pattern => "what is filled with a pattern is left out",
        Lack::Mask => "masks are ignored",
        Lack::Filter => "filters are ignored",
        Lack::Blend => "colours are not blended",
        Lack::Picture => "pictures are left out",
        Lack::Text => "text is left out",
    }
}

/// What paint poured out at a point fills.
pub(super) fn flood(call: &mut Call<'_, '_, '_>) -> Option<Region> {
    const CLOSE: Length = Length::mm(0.5);
    let at = call.point("at")?;
    let close = call.not_negative("close", CLOSE)?;
    let border = if call.word("border") == Some("wall") { Border::Wall } else { Border::Open };
    let lines = part(call, SvgFile::lines)?;
    let error = match lines.flood(&FloodConfig { at, close, border }) {
        Ok(region) => return Some(region),
        Err(error) => error,
    };
    let place = call.span_of("at");
    let message = error.to_string();
    let diagnostic = match error {
        FloodError::OffPage(_) => Diagnostic::error(Code::Flood, place, message)
            .hint("`at` is a point of the canvas; `fit` says where the drawing lies on it"),
        FloodError::OnLine => {
            Diagnostic::error(Code::Flood, place, message).hint("start in the white between the lines")
        }
        FloodError::TooLarge { .. } | FloodError::TooTangled => {
            Diagnostic::error(Code::Limit, call.span_of("file"), message)
                .hint("`layer`, `class`, `id` or `colour` takes fewer lines into account")
        }
        FloodError::Leak(gap) => {
            let wall = "`border: wall` lets it end at the border of the page";
            let hint = match gap {
                Some(gap) => {
                    // A tenth of a millimetre more than the gap, rounded down to tenths, is wider than the gap.
                    let close = ((gap.width.to_mm() * 10.0).floor() + 1.0) / 10.0;
                    format!("`close: {close}mm` would bridge it, or close the line in the drawing; {wall}")
                }
                None => wall.to_owned(),
            };
            Diagnostic::error(Code::Leak, place, message).hint(hint)
        }
    };
    call.cx.report_value(diagnostic);
    None
}

fn refuse(call: &mut Call<'_, '_, '_>, path: &str, error: &SvgError) {
    let unknown = |argument: &str, asked: &str, known: &[String]| {
        let message = format!("`{path}` has no {argument} `{asked}`");
        let hint = did_you_mean(asked, known.iter().map(String::as_str)).unwrap_or_else(|| some(argument, known));
        Diagnostic::error(Code::SvgId, call.span_of(argument), message).hint(hint)
    };
    let diagnostic = match error {
        SvgError::NoSuchId { id, known } => unknown("id", id, known),
        SvgError::NoSuchLayer { layer, known } => unknown("layer", layer, known),
        SvgError::NoSuchClass { class, known } => unknown("class", class, known),
        SvgError::NoSuchColour { colour, known } => {
            let known: Vec<String> = known.iter().copied().map(hex).collect();
            let message = format!("`{path}` has nothing in the colour `{}`", hex(*colour));
            Diagnostic::error(Code::SvgId, call.span_of("colour"), message).hint(some("colour", &known))
        }
        SvgError::NotFilled | SvgError::NotDrawn | SvgError::NoLines => {
            let argument = CHOOSING.into_iter().find(|name| call.has(name)).unwrap_or("file");
            let (what, hint) = match error {
                SvgError::NoLines => {
                    ("there are no lines", "a flood runs up against strokes and dark fills; white ones are no lines")
                }
                SvgError::NotDrawn => ("nothing is drawn", "ink is what is stroked and filled, and can be seen"),
                _ => ("nothing is filled", "regions are outlines of what is filled"),
            };
            let message = format!("{what} in what is asked for of `{path}`");
            Diagnostic::error(Code::SvgId, call.span_of(argument), message).hint(hint)
        }
        SvgError::TooTangled => {
            Diagnostic::error(Code::Limit, call.span_of("file"), format!("`{path}`: {error}")).hint(SIMPLIFY)
        }
        SvgError::Unreadable(_)
        | SvgError::Compressed
        | SvgError::TooDeep { .. }
        | SvgError::TooLarge
        | SvgError::NoSize => Diagnostic::error(Code::Svg, call.span_of("file"), format!("`{path}`: {error}")),
    };
    call.cx.report_value(diagnostic);
}

/// A few of the names that there are.
fn some(argument: &str, known: &[String]) -> String {
    let shown: Vec<_> = known.iter().take(8).map(|name| format!("`{name}`")).collect();
    match (shown.is_empty(), known.len() > shown.len()) {
        (true, _) => format!("the file has no {argument} at all"),
        (false, false) => format!("it has {}", shown.join(", ")),
        (false, true) => format!("it has {} and others", shown.join(", ")),
    }
}
