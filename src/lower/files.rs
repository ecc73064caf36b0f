//! Pictures and drawings that a scene reads: found below the root, read once, decoded once.

use std::rc::Rc;
use std::sync::Arc;

use crate::diag::{Code, Diagnostic, did_you_mean};
use crate::field::{Channel, Image};
use crate::geom::Rect;
use crate::loader;
use crate::region::{Region, Selection, SvgError, SvgFile};

use super::call::Call;
use super::modules::{self, ROOT_HINT};
use super::value::Value;

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
    let image = match Image::decode(&bytes, chosen, most) {
        Ok(image) => Some(Arc::new(image)),
        Err(error) => {
            let span = call.span_of("file");
            let message = format!("`{}` is not a picture that can be read: {error}", key.0);
            call.cx.report_value(Diagnostic::error(Code::Image, span, message).hint("pictures are PNG or JPEG"));
            None
        }
    };
    call.cx.images.insert(key, image.clone());
    image
}

/// What the SVG file that the argument `file` names fills, or its element `id`.
pub(super) fn svg(call: &mut Call<'_, '_, '_>, fit: Option<Rect>) -> Option<Region> {
    let (path, bytes) = read(call)?;
    let drawing = match call.cx.drawings.get(&path) {
        Some(known) => known.clone(),
        None => {
            let drawing = match SvgFile::parse(&bytes) {
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
    let id = match call.value("id") {
        Some(Value::String(text)) => Some(text.value),
        _ => None,
    };
    let selection = id.as_deref().map_or(Selection::Whole, Selection::Id);
    match drawing.region(selection, fit) {
        Ok(region) => Some(region),
        Err(error) => {
            refuse(call, &path, &error);
            None
        }
    }
}

fn refuse(call: &mut Call<'_, '_, '_>, path: &str, error: &SvgError) {
    let diagnostic = match error {
        SvgError::NoSuchId { id, known } => {
            let message = format!("`{path}` has no element `{id}`");
            let hint = did_you_mean(id, known.iter().map(String::as_str)).unwrap_or_else(|| some_ids(known));
            Diagnostic::error(Code::SvgId, call.span_of("id"), message).hint(hint)
        }
        SvgError::NotFilled { id } => {
            let message = format!("the element `{id}` of `{path}` fills no area");
            Diagnostic::error(Code::SvgId, call.span_of("id"), message).hint("regions are outlines of what is filled")
        }
        other => {
            let message = format!("`{path}` is not an SVG that can be read: {other}");
            Diagnostic::error(Code::Svg, call.span_of("file"), message)
        }
    };
    call.cx.report_value(diagnostic);
}

fn some_ids(known: &[String]) -> String {
    let shown: Vec<_> = known.iter().take(8).map(|id| format!("`{id}`")).collect();
    match (shown.is_empty(), known.len() > shown.len()) {
        (true, _) => "no element of the file has an id".to_owned(),
        (false, false) => format!("the file's ids are {}", shown.join(", ")),
        (false, true) => format!("the file's ids begin with {}", shown.join(", ")),
    }
}
