//! Colours in a text, and how else they may be written.

use lsp_types::{Color, ColorInformation, ColorPresentation};

use crate::lower::reference;
use crate::scene::Colour;
use crate::span::SourceId;

use super::analysis::Analysis;
use super::text::Text;

/// Every colour of a text, written in digits or by name.
#[must_use]
pub fn colours(analysis: &Analysis, source: SourceId, text: &Text) -> Vec<ColorInformation> {
    let here = analysis.survey.colours.iter().filter(|(span, _)| span.source == source);
    let list = here.map(|(span, colour)| ColorInformation {
        range: text.range(span.start as usize..span.end as usize),
        color: shown(*colour),
    });
    list.collect()
}

fn shown(colour: Colour) -> Color {
    let [red, green, blue, alpha] = [colour.r, colour.g, colour.b, colour.a].map(|byte| f32::from(byte) / 255.0);
    Color { red, green, blue, alpha }
}

/// How a colour that was picked may be written: in digits, and by its name where it has one.
#[must_use]
pub fn presentations(colour: &Color) -> Vec<ColorPresentation> {
    // A client's numbers may be anything.
    let byte = |share: f32| (share.clamp(0.0, 1.0) * 255.0).round() as u8;
    let [r, g, b, a] = [colour.red, colour.green, colour.blue, colour.alpha].map(byte);
    let colour = Colour { r, g, b, a };
    let digits = if a == 255 { colour.hex() } else { format!("{}{a:02x}", colour.hex()) };
    let names = reference::colours().filter(|(_, known)| *known == colour).map(|(name, _)| name.to_owned());
    let labels = std::iter::once(digits).chain(names);
    labels.map(|label| ColorPresentation { label, ..ColorPresentation::default() }).collect()
}
