//! The scene's picture beside a reference.

use std::fs;
use std::io::Cursor;
use std::path::Path;

use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader};

use crate::back::raster::render;
use crate::cli::Ended;
use crate::cli::files::plain;
use crate::drawing::{Drawing, Page};
use crate::metrics::ssim::{Grey, WINDOW, ssim};
use crate::scene::Colour;

/// What a decoder may allocate besides eight bytes for every pixel.
const DECODER_MEMORY: u64 = 64 << 20;

/// Reads a reference picture.
pub(super) fn reference(path: &Path, megapixels: u64) -> Result<Grey, Ended> {
    let bytes = fs::read(path).map_err(|error| {
        eprintln!("kake: cannot read {}: {}", path.display(), plain(&error));
        Ended::Io
    })?;
    decoded(&bytes, megapixels.saturating_mul(1_000_000)).map_err(|words| {
        eprintln!("kake: {}: {words}", path.display());
        Ended::Io
    })
}

/// The grey of a PNG or JPEG file, the way up it was taken.
fn decoded(bytes: &[u8], most: u64) -> Result<Grey, String> {
    let damaged = |error: image::ImageError| format!("the picture cannot be read: {error}");
    let format = match image::guess_format(bytes) {
        Ok(format @ (ImageFormat::Png | ImageFormat::Jpeg)) => format,
        _ => return Err("this is neither a PNG nor a JPEG file".to_owned()),
    };
    let mut limits = image::Limits::no_limits();
    limits.max_alloc = Some(most.saturating_mul(8).saturating_add(DECODER_MEMORY));
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    reader.limits(limits);
    let mut decoder = reader.into_decoder().map_err(damaged)?;
    let (width, height) = decoder.dimensions();
    if u64::from(width) * u64::from(height) > most {
        return Err(format!("{width} x {height} pixels are more than the limit; `--limit megapixels=N` lifts it"));
    }
    let orientation = decoder.orientation().map_err(damaged)?;
    let mut decoded = DynamicImage::from_decoder(decoder).map_err(damaged)?;
    decoded.apply_orientation(orientation);
    let pixels = decoded.into_rgba8();
    let data = pixels.pixels().map(|&image::Rgba([r, g, b, a])| grey(Colour { r, g, b, a })).collect();
    Ok(Grey { width: pixels.width() as usize, data })
}

/// The luma of a colour over white paper, with the weights of ITU-R BT.709.
fn grey(colour: Colour) -> u8 {
    let over = |value: u8| {
        let alpha = u32::from(colour.a);
        (u32::from(value) * alpha + 255 * (255 - alpha) + 127) / 255
    };
    let luma = 2126 * over(colour.r) + 7152 * over(colour.g) + 722 * over(colour.b);
    ((luma + 5000) / 10_000) as u8
}

/// How alike a drawing, drawn as large as a reference, and the reference are.
pub(super) fn similarity(mut drawing: Drawing, reference: &Grey) -> Result<f64, String> {
    let size = [reference.width, reference.data.len() / reference.width.max(1)];
    let [across, down] = size;
    if size.iter().any(|&side| side < WINDOW) {
        return Err(format!(
            "the reference has {across} x {down} pixels: pictures are compared through windows of {WINDOW} x {WINDOW}"
        ));
    }
    if !is_of_shape(&drawing.page, size) {
        let (width, height) = (drawing.page.width.to_mm(), drawing.page.height.to_mm());
        return Err(format!(
            "the reference has {across} x {down} pixels, and no resolution makes that of a page of {} x {} mm",
            rounded(width),
            rounded(height)
        ));
    }
    drawing.page.pixels = size.map(|side| side as u32);
    let pixels = render(&drawing);
    let colours = (0..down).flat_map(|y| (0..across).map(move |x| (x, y)));
    let data = colours.map(|(x, y)| pixels.colour(x, y).map_or(u8::MAX, grey)).collect();
    ssim(&Grey { width: across, data }, reference).ok_or_else(|| "the pictures differ in size".to_owned())
}

/// Whether a page has so many pixels at some resolution, both sides rounded to whole pixels.
fn is_of_shape(page: &Page, [across, down]: [usize; 2]) -> bool {
    let range = |pixels: usize, length: f64| ((pixels as f64 - 0.5) / length, (pixels as f64 + 0.5) / length);
    let (low, high) = range(across, page.width.to_mm());
    let (other_low, other_high) = range(down, page.height.to_mm());
    low.max(other_low) <= high.min(other_high)
}

/// A length with two decimals at most.
fn rounded(length: f64) -> f64 {
    (length * 100.0).round() / 100.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::Length;
    use crate::scene::Depth;

    fn page(width: f64, height: f64) -> Page {
        let (width, height) = (Length::mm(width), Length::mm(height));
        Page { width, height, bleed: Length::ZERO, pixels: [1, 1], dpi: 1.0, paper: None, depth: Depth::Eight }
    }

    #[test]
    fn pages_have_their_shapes_at_every_resolution() {
        assert!(is_of_shape(&page(20.0, 20.0), [128, 128]));
        assert!(is_of_shape(&page(210.0, 297.0), [100, 141]) && is_of_shape(&page(210.0, 297.0), [4961, 7016]));
        assert!(!is_of_shape(&page(20.0, 20.0), [128, 130]) && !is_of_shape(&page(210.0, 297.0), [141, 100]));
    }

    #[test]
    fn colours_lie_on_white_paper() {
        assert_eq!(grey(Colour::BLACK), 0);
        assert_eq!(grey(Colour { a: 0, ..Colour::BLACK }), 255);
        assert_eq!(
            (0..=255).map(|v| grey(Colour { r: v, g: v, b: v, a: 255 })).collect::<Vec<u8>>(),
            (0..=255).collect::<Vec<u8>>()
        );
        assert_eq!(grey(Colour { r: 0, g: 255, b: 0, a: 255 }), 182);
    }
}
