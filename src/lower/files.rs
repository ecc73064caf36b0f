//! Pictures and drawings that a scene reads: found below the root, read once, decoded once.

use std::rc::Rc;
use std::sync::Arc;

use crate::diag::{Code, Diagnostic, did_you_mean, grouped};
use crate::field::{Channel, Field, Image, ImageError};
use crate::geom::{Length, Rect};
use crate::loader;
use crate::region::Region;
use crate::region::svg::{Selection, SvgError, outlines};

use super::call::Call;
use super::modules::{self, ROOT_HINT};
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
    let Some(path) = loader::resolve(from, &text.value) else {
        let message = modules::outside(&text.value);
        call.cx.report_value(Diagnostic::error(Code::Outside, span, message).hint(ROOT_HINT));
        return None;
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

/// What the SVG file that the argument `file` names fills, or its element `id`.
pub(super) fn svg(call: &mut Call<'_, '_, '_>, fit: Option<Rect>) -> Option<Region> {
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
    let mut chosen: Vec<(&str, Rc<str>)> = Vec::new();
    for name in ["id", "layer", "class"] {
        if let Some(Value::String(text)) = call.value(name) {
            chosen.push((name, text.value));
        }
    }
    let selection = match &chosen[..] {
        [] => Selection::Whole,
        [("id", id)] => Selection::Id(id),
        [("layer", layer)] => Selection::Layer(layer),
        [(_, class)] => Selection::Class(class),
        [_, (second, _), ..] => {
            let message = "`svg` takes one of `id`, `layer` and `class`";
            call.cx.report(Diagnostic::error(Code::Duplicate, call.span_of(second), message));
            return None;
        }
    };
    match drawing.region(selection, fit) {
        Ok(region) => Some(region),
        Err(error) => {
            refuse(call, &path, &error);
            None
        }
    }
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
        SvgError::NotFilled => {
            let argument = ["id", "layer", "class"].into_iter().find(|name| call.has(name)).unwrap_or("file");
            let message = format!("nothing is filled in what is asked for of `{path}`");
            Diagnostic::error(Code::SvgId, call.span_of(argument), message)
                .hint("regions are outlines of what is filled")
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
