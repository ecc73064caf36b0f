//! Images as fields: the bytes of a PNG or JPEG file come in, brightness in linear light goes out.
//!
//! Colours are read as sRGB whatever profile or gamma the file names. Transparent pixels lie on white, mixed in linear
//! light. A photograph that says which way up it was taken is turned so.

use std::fmt;
use std::io::Cursor;

use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};
use serde::Serialize;

use crate::geom::{Point, Rect};

/// What a decoder may allocate besides eight bytes for every pixel: its tables and rows.
const DECODER_MEMORY: u64 = 64 << 20;

/// A decoded image.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Image {
    /// Samples across, at least 1.
    pub width: u32,
    /// Samples down, at least 1.
    pub height: u32,
    /// Row by row from the top left, 0 black to 1 white, linear light.
    #[serde(skip)]
    pub samples: Vec<f32>,
}

/// What of an image is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Channel {
    /// The luminance of linear light, with the weights of ITU-R BT.709.
    Luminance,
    /// Red, in linear light.
    Red,
    /// Green, in linear light.
    Green,
    /// Blue, in linear light.
    Blue,
    /// Opacity, as it is stored; 1 where there is none.
    Alpha,
}

/// Why an image cannot be read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ImageError {
    /// Neither a PNG nor a JPEG file.
    UnknownFormat,
    /// It has more pixels than are allowed.
    TooLarge {
        /// Pixels across.
        width: u32,
        /// Pixels down.
        height: u32,
        /// How many are allowed.
        most: u64,
    },
    /// It has no pixels.
    Empty,
    /// The file is damaged, or uses something that cannot be read; in the decoder's words.
    Damaged(String),
}

impl fmt::Display for ImageError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnknownFormat => f.write_str("this is neither a PNG nor a JPEG file"),
            Self::TooLarge { width, height, most } => {
                write!(f, "the image has {width} x {height} pixels, and {most} are allowed")
            }
            Self::Empty => f.write_str("the image has no pixels"),
            Self::Damaged(why) => write!(f, "the image cannot be read: {why}"),
        }
    }
}

impl std::error::Error for ImageError {}

impl Image {
    /// The luminance of a PNG or JPEG file.
    ///
    /// # Errors
    /// Where the bytes are no such file, or one of more than `max_pixels` pixels: the size in the file's head is looked
    /// at before memory is taken for it.
    pub fn decode(bytes: &[u8], max_pixels: u64) -> Result<Self, ImageError> {
        Self::decode_channel(bytes, Channel::Luminance, max_pixels)
    }

    /// One channel of a PNG or JPEG file.
    ///
    /// # Errors
    /// As [`Image::decode`].
    pub fn decode_channel(bytes: &[u8], channel: Channel, max_pixels: u64) -> Result<Self, ImageError> {
        let damaged = |error: image::ImageError| ImageError::Damaged(error.to_string());
        let format = match image::guess_format(bytes) {
            Ok(format @ (ImageFormat::Png | ImageFormat::Jpeg)) => format,
            _ => return Err(ImageError::UnknownFormat),
        };
        let mut limits = Limits::no_limits();
        limits.max_alloc = Some(max_pixels.saturating_mul(8).saturating_add(DECODER_MEMORY));
        let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
        reader.limits(limits);
        let mut decoder = reader.into_decoder().map_err(damaged)?;
        let (width, height) = decoder.dimensions();
        if width == 0 || height == 0 {
            return Err(ImageError::Empty);
        }
        if u64::from(width) * u64::from(height) > max_pixels {
            return Err(ImageError::TooLarge { width, height, most: max_pixels });
        }
        let orientation = decoder.orientation().map_err(damaged)?;
        let mut decoded = DynamicImage::from_decoder(decoder).map_err(damaged)?;
        decoded.apply_orientation(orientation);
        Ok(Self { width: decoded.width(), height: decoded.height(), samples: samples(decoded, channel) })
    }

    /// The brightness at a point of the page where the image fills `place`: bilinear between the samples' middles, and
    /// at the image's edge beyond it.
    #[must_use]
    pub fn at(&self, place: &Rect, p: Point) -> f64 {
        let along = |v: f64, start: f64, extent: f64, count: u32| {
            let last = f64::from(count.saturating_sub(1));
            let v = ((v - start) / extent * f64::from(count) - 0.5).clamp(0.0, last);
            // A cast of what is no number gives 0.
            let before = v as usize;
            (before, (before + 1).min(last as usize), v - before as f64)
        };
        let (left, right, u) = along(p.x, place.min.x, place.width(), self.width);
        let (top, bottom, v) = along(p.y, place.min.y, place.height(), self.height);
        let upper = self.sample(left, top) * (1.0 - u) + self.sample(right, top) * u;
        let lower = self.sample(left, bottom) * (1.0 - u) + self.sample(right, bottom) * u;
        upper * (1.0 - v) + lower * v
    }

    /// A sample by column and row; 0 beyond the image.
    pub(super) fn sample(&self, column: usize, row: usize) -> f64 {
        self.samples.get(row * self.width as usize + column).copied().map_or(0.0, f64::from)
    }
}

/// One channel of all pixels.
fn samples(decoded: DynamicImage, channel: Channel) -> Vec<f32> {
    match decoded {
        DynamicImage::ImageLuma8(pixels) => of_pixels::<1, u8>(&pixels, channel),
        DynamicImage::ImageLumaA8(pixels) => of_pixels::<2, u8>(&pixels, channel),
        DynamicImage::ImageRgb8(pixels) => of_pixels::<3, u8>(&pixels, channel),
        DynamicImage::ImageRgba8(pixels) => of_pixels::<4, u8>(&pixels, channel),
        DynamicImage::ImageLuma16(pixels) => of_pixels::<1, u16>(&pixels, channel),
        DynamicImage::ImageLumaA16(pixels) => of_pixels::<2, u16>(&pixels, channel),
        DynamicImage::ImageRgb16(pixels) => of_pixels::<3, u16>(&pixels, channel),
        // What is left are formats of floating-point numbers, which no PNG or JPEG file holds.
        other => of_pixels::<4, u16>(&other.into_rgba16(), channel),
    }
}

/// A stored value: a share of the greatest that its type holds.
trait Stored: Copy + Into<u32> {
    const MOST: u32;
}

impl Stored for u8 {
    const MOST: u32 = 255;
}

impl Stored for u16 {
    const MOST: u32 = 65_535;
}

/// One channel of pixels of `N` values: grey, grey and alpha, red green blue, or these and alpha.
fn of_pixels<const N: usize, T: Stored>(values: &[T], channel: Channel) -> Vec<f32> {
    let light: Vec<f32> = (0..=T::MOST).map(|v| linear(f64::from(v) / f64::from(T::MOST)) as f32).collect();
    let lit = |value: T| light[value.into() as usize];
    let (pixels, _) = values.as_chunks::<N>();
    pixels
        .iter()
        .map(|pixel| {
            let alpha = if N.is_multiple_of(2) { pixel[N - 1].into() as f32 / T::MOST as f32 } else { 1.0 };
            let [red, green, blue] = if N > 2 { [pixel[0], pixel[1], pixel[2]] } else { [pixel[0]; 3] };
            let colour = match channel {
                Channel::Luminance if N > 2 => 0.2126 * lit(red) + 0.7152 * lit(green) + 0.0722 * lit(blue),
                Channel::Luminance | Channel::Red => lit(red),
                Channel::Green => lit(green),
                Channel::Blue => lit(blue),
                Channel::Alpha => return alpha,
            };
            (colour * alpha + (1.0 - alpha)).clamp(0.0, 1.0)
        })
        .collect()
}

/// The light that a value of sRGB stands for (IEC 61966-2-1).
fn linear(value: f64) -> f64 {
    if value <= 0.04045 { value / 12.92 } else { libm::pow((value + 0.055) / 1.055, 2.4) }
}
