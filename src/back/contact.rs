//! Contact sheets as pixels: pictures are drawn at the size that they have on the sheet, in any order, and put in place.
//!
//! A picture on a sheet is as sharp as the sheet: its marks are drawn anew, not its pixels made smaller. Only the sheet itself
//! is held in memory, so that whoever has many pictures needs to hold none of them.

use std::io::Write;

use crate::drawing::{Drawing, Page};
use crate::scene::{Colour, Depth};
use crate::sheet::{Place, Sheet};

use super::png::{self, PngError};
use super::raster::{Format, Pixels, render};

/// A sheet while pictures are put on it.
#[derive(Debug, Clone)]
pub struct Contact {
    page: Page,
    /// Grey for as long as all that was put on it is.
    pixels: Pixels,
}

impl Contact {
    /// A sheet with all that is written on it.
    #[must_use]
    pub fn new(sheet: &Sheet) -> Self {
        // Letters and frames are grey on white, and so are their pixels.
        let layers = std::iter::once(sheet.frame_layer()).chain(sheet.text_layers()).collect();
        let pixels = render(&Drawing { page: sheet.page.clone(), layers });
        Self { page: sheet.page.clone(), pixels }
    }

    /// Draws a picture as it is seen in a place. Nothing needs to be known of the sheet's other pictures.
    #[must_use]
    pub fn draw(sheet: &Sheet, place: &Place, mut picture: Drawing) -> Pixels {
        let [left, top, right, bottom] = corners(&sheet.page, place);
        picture.page.pixels = [right - left, bottom - top].map(|side| u32::try_from(side.max(1)).unwrap_or(1));
        // Made smaller, a picture of ink and paper alone is grey.
        picture.page.depth = Depth::Eight;
        render(&picture)
    }

    /// Puts a picture that was drawn for a place there.
    pub fn put(&mut self, place: &Place, picture: &Pixels) {
        let [left, top, ..] = corners(&self.page, place);
        let is_grey = matches!(picture.format, Format::Grey | Format::GreyAlpha);
        if !is_grey && self.pixels.format == Format::Grey {
            let data = self.pixels.data.iter().flat_map(|&grey| [grey; 3]).collect();
            self.pixels = Pixels { format: Format::Rgb, data, ..self.pixels };
        }
        let (width, channels) = (self.pixels.width, self.pixels.format.channels());
        let wide = picture.width.min(width.saturating_sub(left));
        let rows = picture.data.chunks_exact((picture.width * picture.format.channels()).max(1));
        for (y, row) in rows.enumerate() {
            let start = ((top + y) * width + left) * channels;
            let Some(target) = self.pixels.data.get_mut(start..start + wide * channels) else { break };
            let pixels = row.chunks_exact(picture.format.channels());
            for (target, pixel) in target.chunks_exact_mut(channels).zip(pixels) {
                let [r, g, b] = on_white(&picture.format, pixel);
                match target {
                    [grey] => *grey = r,
                    _ => target.copy_from_slice(&[r, g, b]),
                }
            }
        }
    }

    /// Writes the sheet.
    ///
    /// # Errors
    /// What `out` answers, and sizes that the format does not know.
    pub fn write(&self, out: &mut dyn Write) -> Result<(), PngError> {
        png::write_page(&self.pixels, &self.page, None, out)
    }
}

/// Left, top, right and bottom of a place in pixels.
fn corners(page: &Page, place: &Place) -> [usize; 4] {
    let [across, down] =
        [f64::from(page.pixels[0]) / page.width.to_mm(), f64::from(page.pixels[1]) / page.height.to_mm()];
    let at = |mm: f64, scale: f64| (mm * scale).round().max(0.0) as usize;
    let area = &place.area;
    [at(area.min.x, across), at(area.min.y, down), at(area.max.x, across), at(area.max.y, down)]
}

/// A pixel's colour where white shows through it.
fn on_white(format: &Format, pixel: &[u8]) -> [u8; 3] {
    let colour = match (format, pixel) {
        (Format::Indexed(palette), &[i]) => palette.get(usize::from(i)).copied().unwrap_or(Colour::WHITE),
        (_, &[v]) => Colour { r: v, g: v, b: v, a: 255 },
        (_, &[v, a]) => Colour { r: v, g: v, b: v, a },
        (_, &[r, g, b]) => Colour { r, g, b, a: 255 },
        (_, &[r, g, b, a]) => Colour { r, g, b, a },
        _ => Colour::WHITE,
    };
    let alpha = u32::from(colour.a);
    [colour.r, colour.g, colour.b].map(|ink| ((u32::from(ink) * alpha + 255 * (255 - alpha) + 127) / 255) as u8)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use std::io::Cursor;

    use super::super::samples::{page, scattered};
    use super::*;
    use crate::geom::Length;
    use crate::sheet::{Grid, Holds, Row, Slot};

    fn sheet(pictures: &[Drawing]) -> Sheet {
        let slot = |picture: &Drawing| Slot {
            name: "a".to_owned(),
            caption: vec!["seed 1".to_owned()],
            holds: Holds::Picture([picture.page.width, picture.page.height]),
        };
        let row = Row { slots: pictures.iter().map(slot).collect(), ..Row::default() };
        Sheet::new(&Grid { rows: vec![row], side: Length::mm(20.0), ..Grid::default() })
    }

    fn written(pictures: &[Drawing]) -> image::RgbImage {
        let sheet = sheet(pictures);
        let mut contact = Contact::new(&sheet);
        // The order does not matter.
        for (place, picture) in sheet.places.iter().zip(pictures).rev() {
            contact.put(place, &Contact::draw(&sheet, place, picture.clone()));
        }
        let mut bytes = Vec::new();
        contact.write(&mut bytes).unwrap();
        image::load(Cursor::new(bytes), image::ImageFormat::Png).unwrap().into_rgb8()
    }

    #[test]
    fn pictures_are_put_in_their_places_and_captions_under_them() {
        let empty = Drawing { page: page(20.0, 10.0), layers: Vec::new() };
        let mut red = empty.clone();
        red.page.paper = Some(Colour { r: 200, g: 0, b: 0, a: 255 });
        let sheet = sheet(&[red.clone(), empty.clone()]);
        let pixels = written(&[red, empty]);
        assert_eq!([pixels.width(), pixels.height()], sheet.page.pixels);
        let at = |place: &Place| {
            let [left, top, right, bottom] = corners(&sheet.page, place);
            *pixels.get_pixel(((left + right) / 2) as u32, ((top + bottom) / 2) as u32)
        };
        assert_eq!(at(&sheet.places[0]).0, [200, 0, 0]);
        assert_eq!(at(&sheet.places[1]).0, [255; 3]);
        let below = corners(&sheet.page, &sheet.places[0])[3] as u32 + 4;
        let dark = pixels.rows().skip(below as usize).flatten().filter(|pixel| pixel.0[0] < 128).count();
        assert!(dark > 100, "{dark} dark pixels under the pictures");
    }

    #[test]
    fn marks_end_at_the_edge_of_their_picture() {
        // Half of what is scattered lies beyond a page that is cut to half.
        let mut cut = scattered(40.0, 30.0, 200);
        cut.page.width = Length::mm(20.0);
        let blank = Drawing { page: cut.page.clone(), layers: Vec::new() };
        let sheet = sheet(&[cut.clone(), blank.clone()]);
        let (with, without) = (written(&[cut, blank.clone()]), written(&[blank.clone(), blank]));
        let [left, top, right, bottom] = corners(&sheet.page, &sheet.places[0]).map(|side| side as u32);
        let differs = with.enumerate_pixels().filter(|(x, y, pixel)| *pixel != without.get_pixel(*x, *y));
        let mut inside = 0;
        for (x, y, _) in differs {
            assert!((left..right).contains(&x) && (top..bottom).contains(&y), "{x} {y}");
            inside += 1;
        }
        assert!(inside > 1000);
    }
}
