//! PNG: a drawing goes in, a file with its resolution, its colour space and its metadata comes out.
//!
//! Grey pictures are grey, pictures of ink or paper alone have as few bits a pixel as their colours need.

use std::borrow::Cow;
use std::fmt;
use std::io::{self, Write};

use ::png::text_metadata::ITXtChunk;
use ::png::{
    BitDepth, ColorType, Compression, Encoder, EncodingError, Filter, PixelDimensions, SrgbRenderingIntent, Unit,
};

use super::metadata::{KEYWORD, Metadata};
use super::raster::{Format, Pixels, render};
use crate::drawing::Drawing;
use crate::geom::Length;
use crate::scene::Colour;

/// Why a PNG cannot be written.
#[derive(Debug)]
pub enum PngError {
    /// What the file answered.
    Io(io::Error),
    /// The format has no such picture: a side of no pixels, or of more than 2^31.
    Format(String),
}

impl fmt::Display for PngError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io(error) => error.fmt(f),
            Self::Format(message) => f.write_str(message),
        }
    }
}

impl std::error::Error for PngError {}

impl From<io::Error> for PngError {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

impl From<EncodingError> for PngError {
    fn from(error: EncodingError) -> Self {
        match error {
            EncodingError::IoError(error) => Self::Io(error),
            other => Self::Format(other.to_string()),
        }
    }
}

/// Draws a drawing and writes it. The pixels are held in memory once, and the compressed bytes.
///
/// # Errors
/// What `out` answers, and sizes that the format does not know.
pub fn write(drawing: &Drawing, metadata: Option<&Metadata>, out: &mut dyn Write) -> Result<(), PngError> {
    let [width, height] = drawing.page.pixels;
    let mut encoder = Encoder::new(&mut *out, width, height);
    encoder.set_source_srgb(SrgbRenderingIntent::RelativeColorimetric);
    // Pixels per metre; the format has no other unit.
    let per_metre = (drawing.page.dpi * (1000.0 / Length::MM_PER_INCH)).round() as u32;
    encoder.set_pixel_dims(Some(PixelDimensions { xppu: per_metre, yppu: per_metre, unit: Unit::Meter }));
    encoder.set_compression(Compression::Fast);
    let pixels = render(drawing);
    let data = match &pixels.format {
        Format::Grey => plain(&mut encoder, ColorType::Grayscale, &pixels),
        Format::GreyAlpha => plain(&mut encoder, ColorType::GrayscaleAlpha, &pixels),
        Format::Rgb => plain(&mut encoder, ColorType::Rgb, &pixels),
        Format::Rgba => plain(&mut encoder, ColorType::Rgba, &pixels),
        Format::Indexed(palette) => indexed(&mut encoder, palette, &pixels),
    };
    let mut writer = encoder.write_header()?;
    if let Some(metadata) = metadata {
        let mut chunk = ITXtChunk::new(KEYWORD, metadata.to_json()?);
        chunk.compressed = true;
        writer.write_text_chunk(&chunk)?;
    }
    writer.write_image_data(&data)?;
    writer.finish()?;
    out.flush()?;
    Ok(())
}

/// Sets up a picture of whole bytes.
fn plain<'a, W: Write>(encoder: &mut Encoder<'_, W>, colour: ColorType, pixels: &'a Pixels) -> Cow<'a, [u8]> {
    encoder.set_color(colour);
    encoder.set_depth(BitDepth::Eight);
    Cow::Borrowed(&pixels.data)
}

/// Sets up a picture of few colours: one bit a pixel for black and white, otherwise a palette.
fn indexed<'a, W: Write>(encoder: &mut Encoder<'_, W>, palette: &[Colour], pixels: &'a Pixels) -> Cow<'a, [u8]> {
    if palette.iter().all(|&colour| colour == Colour::BLACK || colour == Colour::WHITE) {
        encoder.set_color(ColorType::Grayscale);
        encoder.set_depth(BitDepth::One);
        encoder.set_filter(Filter::NoFilter);
        let values: Vec<u8> = palette.iter().map(|&colour| u8::from(colour == Colour::WHITE)).collect();
        return Cow::Owned(pack(pixels, 1, |index| values.get(usize::from(index)).copied().unwrap_or(0)));
    }
    encoder.set_color(ColorType::Indexed);
    encoder.set_palette(palette.iter().flat_map(|colour| [colour.r, colour.g, colour.b]).collect::<Vec<_>>());
    if palette.iter().any(|colour| colour.a < 255) {
        encoder.set_trns(palette.iter().map(|colour| colour.a).collect::<Vec<_>>());
    }
    let (depth, bits) = match palette.len() {
        0..=2 => (BitDepth::One, 1),
        3..=4 => (BitDepth::Two, 2),
        5..=16 => (BitDepth::Four, 4),
        _ => (BitDepth::Eight, 8),
    };
    encoder.set_depth(depth);
    encoder.set_filter(Filter::NoFilter);
    if bits == 8 { Cow::Borrowed(&pixels.data) } else { Cow::Owned(pack(pixels, bits, |index| index)) }
}

/// Rows of `bits` a pixel, the first pixel in the highest bits; each row starts a byte.
fn pack(pixels: &Pixels, bits: usize, value: impl Fn(u8) -> u8) -> Vec<u8> {
    let per_byte = 8 / bits;
    let mut packed = Vec::with_capacity(pixels.width.div_ceil(per_byte) * pixels.height);
    for row in pixels.data.chunks_exact(pixels.width.max(1)) {
        packed.extend(row.chunks(per_byte).map(|group| {
            let byte = group.iter().fold(0, |byte: u8, &index| byte << bits | value(index));
            byte << (bits * (per_byte - group.len()))
        }));
    }
    packed
}
