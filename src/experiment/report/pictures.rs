//! The pictures that stand for the conditions, in the page itself.

use std::io::Cursor;

use base64::Engine;
use base64::engine::general_purpose::STANDARD as BASE64;
use image::imageops::FilterType;
use image::{ImageFormat, ImageReader};
use maud::{Markup, html};

use crate::experiment::{Outcome, Picture};

/// The greatest side of a picture on the page in pixels: larger ones are shown smaller, and lie in full beside the page.
const GREATEST: u32 = 800;

/// Pictures above so many bytes are not opened to make them smaller.
const MOST_PIXELS: u64 = 400_000_000;

/// Every picture by its condition.
pub(super) fn section(outcome: &Outcome, pictures: &[Picture]) -> Markup {
    let plan = &outcome.plan;
    html! {
        h2 id="pictures" { "Pictures" }
        p.soft {
            "For each condition the run whose " code { "e_contrast" }
            " is nearest to the median of its seeds. The files carry their scene: "
            code { "kake build" } " makes them again."
        }
        @for (number, condition) in plan.conditions.iter().enumerate() {
            @let of: Vec<&Picture> = pictures.iter().filter(|picture| picture.condition == number).collect();
            @if !of.is_empty() {
                h3 { (condition.name) @if condition.levels.is_none() { " *" } }
                div.pictures {
                    @for picture in of { (shown(outcome, picture)) }
                }
            }
        }
    }
}

fn shown(outcome: &Outcome, picture: &Picture) -> Markup {
    let set = outcome.plan.pictures[picture.variant].iter().map(|set| format!("{} = {}", set.param, set.label));
    let set: Vec<String> = set.chain([format!("seed {}", picture.seed)]).collect();
    let condition = &outcome.plan.conditions[picture.condition].name;
    html! {
        figure {
            @match &picture.png {
                Ok(png) => {
                    a href={ "images/" (picture.file) } {
                        img src=(data(png)) alt={ (condition) ", " (set.join(", ")) };
                    }
                    figcaption { (set.join(", ")) }
                }
                Err(words) => {
                    pre { (words) }
                    figcaption { (set.join(", ")) ", could not be drawn" }
                }
            }
        }
    }
}

/// A PNG as an address.
fn data(png: &[u8]) -> String {
    let small = smaller(png);
    format!("data:image/png;base64,{}", BASE64.encode(small.as_deref().unwrap_or(png)))
}

/// A PNG that is not larger than pages show; none where it is not anyway, or cannot be read.
fn smaller(png: &[u8]) -> Option<Vec<u8>> {
    let size = ImageReader::with_format(Cursor::new(png), ImageFormat::Png).into_dimensions().ok()?;
    let pixels = u64::from(size.0) * u64::from(size.1);
    if size.0.max(size.1) <= GREATEST || pixels > MOST_PIXELS {
        return None;
    }
    let mut reader = ImageReader::with_format(Cursor::new(png), ImageFormat::Png);
    // The picture was drawn under a limit of its own.
    reader.no_limits();
    let image = reader.decode().ok()?;
    // Triangles need no functions that differ between machines.
    let small = image.resize(GREATEST, GREATEST, FilterType::Triangle);
    let mut bytes = Cursor::new(Vec::new());
    small.write_to(&mut bytes, ImageFormat::Png).ok()?;
    Some(bytes.into_inner())
}
