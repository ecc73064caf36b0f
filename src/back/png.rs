//! PNG: a drawing goes in, a file with its resolution, its colour space and its metadata comes out; or pixels go in, and
//! come back.
//!
//! Grey pictures are grey, pictures of ink or paper alone have as few bits a pixel as their colours need.

use std::borrow::Cow;
use std::fmt;
use std::io::{self, Cursor, Write};

use ::png::text_metadata::ITXtChunk;
use ::png::{
    BitDepth, ColorType, Compression, Decoder, DecodingError, DeflateCompression, Encoder, EncodingError, Filter,
    Limits, PixelDimensions, SrgbRenderingIntent, Transformations, Unit,
};

use super::metadata::{KEYWORD, Metadata};
use super::raster::{Format, Pixels, render};
use crate::drawing::{Drawing, Page};
use crate::geom::Length;
use crate::scene::Colour;

/// Why a PNG cannot be written or read.
#[derive(Debug)]
pub enum PngError {
    /// What the file answered.
    Io(io::Error),
    /// The format has no such picture: a side of no pixels, or of more than 2^31; or what is read is no PNG.
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

impl From<DecodingError> for PngError {
    fn from(error: DecodingError) -> Self {
        match error {
            DecodingError::IoError(error) => Self::Io(error),
            other => Self::Format(other.to_string()),
        }
    }
}

/// Pictures of so many pixels are packed tightly; larger ones quickly, or packing would take longer than drawing.
const SMALL: u64 = 16 << 20;

/// How pixels are packed.
#[derive(Debug, Clone, Copy)]
enum Packing {
    /// For small files.
    Tight,
    /// For large pictures.
    Fast,
    /// For what is shown at once.
    Quick,
}

/// Draws a drawing and writes it. The pixels are held in memory once, and the compressed bytes.
///
/// # Errors
/// What `out` answers, and sizes that the format does not know.
pub fn write(drawing: &Drawing, metadata: Option<&Metadata>, out: &mut dyn Write) -> Result<(), PngError> {
    let text = metadata.map(Metadata::to_json).transpose()?;
    write_page(&render(drawing), &drawing.page, text, out)
}

/// Writes the pixels of a page, and the metadata's text where there is one.
pub(super) fn write_page(
    pixels: &Pixels,
    page: &Page,
    text: Option<String>,
    out: &mut dyn Write,
) -> Result<(), PngError> {
    // Pixels per metre; the format has no other unit.
    let per_metre = (page.dpi * (1000.0 / Length::MM_PER_INCH)).round() as u32;
    let resolution = PixelDimensions { xppu: per_metre, yppu: per_metre, unit: Unit::Meter };
    let [width, height] = page.pixels.map(u64::from);
    let packing = if width * height <= SMALL { Packing::Tight } else { Packing::Fast };
    write_pixels(pixels, page.pixels, packing, Some(resolution), text, out)
}

/// The bytes of a PNG of these pixels, without a resolution and without metadata.
///
/// # Errors
/// If the format does not know such a size.
pub fn encode(pixels: &Pixels) -> Result<Vec<u8>, PngError> {
    let is_small = pixels.width as u64 * pixels.height as u64 <= SMALL;
    encode_as(pixels, if is_small { Packing::Tight } else { Packing::Fast })
}

/// The same in a sixth of the time, for pictures that are looked at at once and not kept.
///
/// # Errors
/// If the format does not know such a size.
pub fn encode_quickly(pixels: &Pixels) -> Result<Vec<u8>, PngError> {
    encode_as(pixels, Packing::Quick)
}

fn encode_as(pixels: &Pixels, packing: Packing) -> Result<Vec<u8>, PngError> {
    let side = |n: usize| u32::try_from(n).map_err(|_| PngError::Format("the picture is too large".to_owned()));
    let mut bytes = Vec::new();
    write_pixels(pixels, [side(pixels.width)?, side(pixels.height)?], packing, None, None, &mut bytes)?;
    Ok(bytes)
}

/// The pixels of a PNG, eight bits a channel; palettes are resolved, so that none comes back indexed.
///
/// # Errors
/// If the bytes are no PNG, end too early or hold more than `most` pixels.
pub fn decode(bytes: &[u8], most: u64) -> Result<Pixels, PngError> {
    let bound = usize::try_from(most.saturating_mul(8).saturating_add(1 << 20)).unwrap_or(usize::MAX);
    let mut decoder = Decoder::new_with_limits(Cursor::new(bytes), Limits { bytes: bound });
    decoder.set_transformations(Transformations::normalize_to_color8());
    let mut reader = decoder.read_info()?;
    let (width, height) = (reader.info().width, reader.info().height);
    if u64::from(width) * u64::from(height) > most {
        return Err(PngError::Format(format!("the picture has {width} x {height} pixels, more than {most}")));
    }
    let format = match reader.output_color_type().0 {
        ColorType::Grayscale => Format::Grey,
        ColorType::GrayscaleAlpha => Format::GreyAlpha,
        ColorType::Rgb => Format::Rgb,
        ColorType::Rgba => Format::Rgba,
        ColorType::Indexed => return Err(PngError::Format("the picture has no palette".to_owned())),
    };
    let size = reader.output_buffer_size().ok_or_else(|| PngError::Format("the picture is too large".to_owned()))?;
    let mut data = vec![0; size];
    reader.next_frame(&mut data)?;
    Ok(Pixels { width: width as usize, height: height as usize, format, data })
}

/// Writes pixels, and the metadata's text where there is one.
fn write_pixels(
    pixels: &Pixels,
    [width, height]: [u32; 2],
    packing: Packing,
    resolution: Option<PixelDimensions>,
    text: Option<String>,
    out: &mut dyn Write,
) -> Result<(), PngError> {
    let mut encoder = Encoder::new(&mut *out, width, height);
    encoder.set_source_srgb(SrgbRenderingIntent::RelativeColorimetric);
    encoder.set_pixel_dims(resolution);
    // Line art is long runs of paper and ink, which filters only break up.
    match packing {
        Packing::Tight => {
            encoder.set_filter(Filter::NoFilter);
            encoder.set_deflate_compression(DeflateCompression::Level(4));
        }
        Packing::Fast => encoder.set_compression(Compression::Fast),
        Packing::Quick => {
            encoder.set_filter(Filter::NoFilter);
            encoder.set_deflate_compression(DeflateCompression::Level(1));
        }
    }
    let data = match &pixels.format {
        Format::Grey => plain(&mut encoder, ColorType::Grayscale, pixels),
        Format::GreyAlpha => plain(&mut encoder, ColorType::GrayscaleAlpha, pixels),
        Format::Rgb => plain(&mut encoder, ColorType::Rgb, pixels),
        Format::Rgba => plain(&mut encoder, ColorType::Rgba, pixels),
        Format::Indexed(palette) => indexed(&mut encoder, palette, pixels),
    };
    let mut writer = encoder.write_header()?;
    if let Some(text) = text {
        let mut chunk = ITXtChunk::new(KEYWORD, text);
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
    // Packed rows are few bytes, and neither filters nor the fast compression can make anything of them.
    encoder.set_compression(Compression::Balanced);
    encoder.set_filter(Filter::NoFilter);
    if palette.iter().all(|&colour| colour == Colour::BLACK || colour == Colour::WHITE) {
        encoder.set_color(ColorType::Grayscale);
        encoder.set_depth(BitDepth::One);
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

#[cfg(test)]
#[allow(clippy::unwrap_used, clippy::panic)]
mod tests {
    use super::super::samples::{layer, lines, on_threads, page, scattered};
    use super::*;
    use crate::scene::{Cap, Depth};

    const RED: Colour = Colour { r: 255, g: 0, b: 0, a: 255 };

    fn bytes_of(drawing: &Drawing) -> Vec<u8> {
        let mut out = Vec::new();
        write(drawing, None, &mut out).unwrap();
        out
    }

    /// What a reader makes of a drawing: colour type, depth, and the pixels as red, green, blue and alpha.
    fn decoded(drawing: &Drawing) -> (ColorType, BitDepth, Vec<[u8; 4]>) {
        let bytes = bytes_of(drawing);
        let decoder = ::png::Decoder::new(Cursor::new(&bytes));
        let mut reader = decoder.read_info().unwrap();
        let info = reader.info();
        let header = (info.color_type, info.bit_depth);
        assert_eq!([info.width, info.height], drawing.page.pixels);
        assert_eq!(info.srgb, Some(SrgbRenderingIntent::RelativeColorimetric));
        let dims = info.pixel_dims.unwrap();
        assert_eq!((dims.xppu, dims.yppu, dims.unit), (10_000, 10_000, Unit::Meter));
        let mut decoder = ::png::Decoder::new(Cursor::new(&bytes));
        decoder.set_transformations(::png::Transformations::normalize_to_color8());
        reader = decoder.read_info().unwrap();
        let mut data = vec![0; reader.output_buffer_size().unwrap()];
        let frame = reader.next_frame(&mut data).unwrap();
        let pixels = data
            .chunks_exact(frame.color_type.samples())
            .map(|pixel| match *pixel {
                [v] => [v, v, v, 255],
                [v, a] => [v, v, v, a],
                [r, g, b] => [r, g, b, 255],
                [r, g, b, a] => [r, g, b, a],
                _ => panic!("no pixel"),
            })
            .collect();
        (header.0, header.1, pixels)
    }

    /// Strokes of some inks, one below the other; 13 pixels wide, which is no whole number of bytes.
    fn bars(inks: &[Colour], paper: Option<Colour>, depth: Depth) -> Drawing {
        let bar = |(i, &ink): (usize, &Colour)| {
            let y = 0.37 + 0.5 * i as f64;
            let mut bar = layer(&format!("bar {i}"), ink);
            bar.strokes.push(lines(0.25, Cap::Butt, &[&[[(0.2, y), (1.1, y + 0.1)]]]));
            bar
        };
        let mut page = page(1.3, 0.5 * inks.len() as f64 + 0.5);
        page.pixels = [13, (5 * inks.len() + 5) as u32];
        page.paper = paper;
        page.depth = depth;
        Drawing { page, layers: inks.iter().enumerate().map(bar).collect() }
    }

    #[test]
    fn pixels_come_back_in_every_form() {
        let (black, white) = (Colour::BLACK, Some(Colour::WHITE));
        let grey = Colour { r: 90, g: 90, b: 90, a: 255 };
        let inks: Vec<Colour> = (0..20).map(|i| Colour { r: i, g: 200, b: 255 - i, a: 255 }).collect();
        for (inks, paper, depth, colour_type, bit_depth) in [
            (&[black][..], white, Depth::Eight, ColorType::Grayscale, BitDepth::Eight),
            (&[grey], white, Depth::Eight, ColorType::Grayscale, BitDepth::Eight),
            (&[black, RED], white, Depth::Eight, ColorType::Rgb, BitDepth::Eight),
            (&[black], None, Depth::Eight, ColorType::GrayscaleAlpha, BitDepth::Eight),
            (&[RED], None, Depth::Eight, ColorType::Rgba, BitDepth::Eight),
            (&[black], white, Depth::One, ColorType::Grayscale, BitDepth::One),
            (&[Colour::WHITE], Some(black), Depth::One, ColorType::Grayscale, BitDepth::One),
            (&[RED], white, Depth::One, ColorType::Indexed, BitDepth::One),
            (&[black], None, Depth::One, ColorType::Indexed, BitDepth::One),
            (&[black, RED], white, Depth::One, ColorType::Indexed, BitDepth::Two),
            (&inks[..5], white, Depth::One, ColorType::Indexed, BitDepth::Four),
            (&inks[..], None, Depth::One, ColorType::Indexed, BitDepth::Eight),
            (&[], None, Depth::Eight, ColorType::GrayscaleAlpha, BitDepth::Eight),
        ] {
            let drawing = bars(inks, paper, depth);
            let (found_type, found_depth, found) = decoded(&drawing);
            assert_eq!((found_type, found_depth), (colour_type, bit_depth), "{inks:?} {paper:?} {depth:?}");
            let pixels = render(&drawing);
            let wanted: Vec<[u8; 4]> = (0..pixels.height)
                .flat_map(|y| (0..pixels.width).map(move |x| (x, y)))
                .map(|(x, y)| {
                    let Colour { r, g, b, a } = pixels.colour(x, y).unwrap();
                    [r, g, b, a]
                })
                .collect();
            assert_eq!(found, wanted, "{inks:?} {paper:?} {depth:?}");
            assert!(inks.is_empty() || wanted.iter().any(|pixel| pixel != &wanted[0]));
        }
    }

    #[test]
    fn pixels_come_back_as_they_were() {
        for (inks, paper) in
            [(&[Colour::BLACK][..], Some(Colour::WHITE)), (&[RED], None), (&[RED], Some(Colour::WHITE))]
        {
            let pixels = render(&bars(inks, paper, Depth::Eight));
            let read = decode(&encode(&pixels).unwrap(), 10_000).unwrap();
            assert_eq!(read, pixels);
        }
        let indexed = render(&bars(&[RED, Colour::BLACK], None, Depth::One));
        let bytes = encode(&indexed).unwrap();
        let read = decode(&bytes, 10_000).unwrap();
        for (x, y) in (0..13).flat_map(|x| (0..15).map(move |y| (x, y))) {
            assert_eq!(read.colour(x, y), indexed.colour(x, y));
        }
        assert!(decode(&bytes, 13 * 15 - 1).is_err_and(|error| error.to_string().contains("13 x 15")));
        assert!(decode(&bytes[..bytes.len() / 2], 10_000).is_err());
        assert!(decode(b"<svg/>", 10_000).is_err());
    }

    #[test]
    fn a_size_of_nothing_is_an_error() {
        let mut drawing = bars(&[], None, Depth::Eight);
        drawing.page.pixels = [0, 4];
        let error = write(&drawing, None, &mut Vec::new()).unwrap_err();
        assert!(matches!(error, PngError::Format(_)), "{error}");
    }

    #[test]
    fn what_the_file_answers_is_reported() {
        struct Full;
        impl Write for Full {
            fn write(&mut self, _: &[u8]) -> io::Result<usize> {
                Err(io::Error::other("disk full"))
            }
            fn flush(&mut self) -> io::Result<()> {
                Ok(())
            }
        }
        let error = write(&bars(&[], None, Depth::Eight), None, &mut Full).unwrap_err();
        assert!(matches!(&error, PngError::Io(_)) && error.to_string() == "disk full", "{error:?}");
    }

    #[test]
    fn threads_do_not_matter() {
        let drawing = scattered(60.0, 60.0, 500);
        let [one, four] = on_threads(|| bytes_of(&drawing));
        assert!(one == four);
    }
}
