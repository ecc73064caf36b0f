//! Pictures of a difference: a raster for the count of pixels, and what `-o` asks for.

use std::io;
use std::path::{Path, PathBuf};

use crate::back::raster::{Pixels, render};
use crate::back::{png, svg};
use crate::cli::files::{Pending, write_beside};
use crate::compare::{Difference, common, marks, pictures_on};
use crate::drawing::{Drawing, Layer, Page};
use crate::geom::Length;
use crate::scene::{Colour, Depth};

use super::findings::{Findings, PixelChange};
use super::page;

/// Pixels of a raster that is compared, at most.
const MOST_PIXELS: f64 = 16e6;

/// Pixels along the longer side of the pictures in a page, at most.
const PAGE_SIDE: f64 = 2400.0;

/// Marks that an SVG shows at most: more of them no reader opens.
const MOST_MARKS: u64 = 5_000_000;

/// What a difference is written as.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Form {
    Png,
    Svg,
    Html,
}

impl Form {
    /// What the ending of a file says.
    pub(super) fn of(output: &Path) -> Result<Self, String> {
        let extension = output.extension().unwrap_or_default().to_ascii_lowercase();
        match extension.to_str() {
            Some("png") => Ok(Self::Png),
            Some("svg") => Ok(Self::Svg),
            Some("html" | "htm") => Ok(Self::Html),
            _ => Err(format!("{}: differences end in .png, .svg or .html", output.display())),
        }
    }
}

/// Both sides as drawings: a side that is not there is an empty sheet as large as the other.
pub(super) struct Sheets {
    pub(super) old: Drawing,
    pub(super) new: Drawing,
}

impl Sheets {
    /// Of two sides; none where there is nothing to be seen.
    pub(super) fn new(old: Option<Drawing>, new: Option<Drawing>) -> Option<Self> {
        let empty = |page: &Page| Drawing { page: page.clone(), layers: Vec::new() };
        match (old, new) {
            (Some(old), Some(new)) => Some(Self { old, new }),
            (Some(old), None) => Some(Self { new: empty(&old.page), old }),
            (None, Some(new)) => Some(Self { old: empty(&new.page), new }),
            (None, None) => None,
        }
    }

    /// Pixels per millimetre at which they are compared: the finer one's, unless there would be too many pixels.
    fn scale(&self) -> f64 {
        let own = |page: &Page| f64::from(page.pixels[0]) / page.width.to_mm();
        let own = own(&self.old.page).max(own(&self.new.page));
        let sheet = common(&self.old.page, &self.new.page);
        let most = (MOST_PIXELS / (sheet.width.to_mm() * sheet.height.to_mm())).sqrt();
        own.min(most)
    }

    /// What differs in pixels.
    pub(super) fn pixels(&mut self) -> (Difference, PixelChange) {
        let scale = self.scale();
        let papers = [&self.old, &self.new]
            .map(|drawing| drawing.page.paper.map_or(Colour::WHITE, |paper| Colour { a: 255, ..paper }));
        let old = at(&mut self.old, scale);
        let new = at(&mut self.new, scale);
        let difference = pictures_on(&old, &new, papers);
        let Difference { changed, share, .. } = difference;
        let (width, height) = (difference.picture.width, difference.picture.height);
        let change = PixelChange { changed, share, width, height, dpi: scale * Length::MM_PER_INCH };
        (difference, change)
    }

    /// Both as PNGs to be looked at on a screen.
    pub(super) fn previews(&mut self) -> io::Result<[Vec<u8>; 2]> {
        let sheet = common(&self.old.page, &self.new.page);
        let scale = self.scale().min(PAGE_SIDE / sheet.width.max(sheet.height).to_mm());
        let [old, new] =
            [&mut self.old, &mut self.new].map(|drawing| png::encode(&at(drawing, scale)).map_err(io::Error::other));
        Ok([old?, new?])
    }
}

/// Draws a drawing at a scale, for a while.
fn at(drawing: &mut Drawing, scale: f64) -> Pixels {
    let side = |length: Length| ((length.to_mm() * scale).round() as u32).max(1);
    let pixels = [side(drawing.page.width), side(drawing.page.height)];
    // Ink or paper is decided at the canvas's own resolution alone.
    let is_own = pixels == drawing.page.pixels;
    let kept = drawing.page.clone();
    drawing.page.pixels = pixels;
    if !is_own {
        drawing.page.depth = Depth::Eight;
    }
    let drawn = render(drawing);
    drawing.page = kept;
    drawn
}

/// Where outputs go: `{name}` in them is the scene's name without its ending.
pub(super) fn target(output: &Path, name: &str) -> PathBuf {
    let stem = Path::new(name).file_stem().unwrap_or_default().to_string_lossy();
    PathBuf::from(output.to_string_lossy().replace("{name}", &stem))
}

/// Writes a difference beside its place.
pub(super) fn write(
    form: Form,
    target: &Path,
    sheets: &mut Sheets,
    difference: &Difference,
    findings: &Findings,
) -> io::Result<Pending> {
    let bytes = match form {
        Form::Png => png::encode(&difference.picture).map_err(io::Error::other)?,
        Form::Svg => {
            let all = |drawing: &Drawing| drawing.layers.iter().map(Layer::marks).sum::<u64>();
            if all(&sheets.old) + all(&sheets.new) > MOST_MARKS {
                return Err(io::Error::other("there are too many strokes for an SVG; a .png shows the same"));
            }
            let mut bytes = Vec::new();
            svg::write(&marks(&sheets.old, &sheets.new), None, &mut bytes)?;
            bytes
        }
        Form::Html => page::page(findings, sheets, difference)?.into_bytes(),
    };
    write_beside(target, |out| out.write_all(&bytes))
}
