//! Inks on paper: which colours a raster needs, and what coverage makes of a pixel.
//!
//! A drawing goes in, and coverage layer by layer; values of pixels come out. They are computed in whole numbers and
//! rounded once for each layer. Layers of one opaque ink that follow each other form a group with one coverage: no
//! ink is laid twice where they overlap.

use crate::drawing::Drawing;
use crate::scene::{Colour, Depth};

/// The least coverage that counts as ink where there are no levels between.
const HALF: u8 = 128;

/// What a pixel is made of.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Format {
    /// A byte: black 0 to white 255.
    Grey,
    /// Grey and alpha.
    GreyAlpha,
    /// Red, green and blue.
    Rgb,
    /// Red, green, blue and alpha, not premultiplied.
    Rgba,
    /// A byte: which of at most 256 colours.
    Indexed(Vec<Colour>),
}

impl Format {
    /// Bytes of a pixel.
    #[must_use]
    pub fn channels(&self) -> usize {
        match self {
            Self::Grey | Self::Indexed(_) => 1,
            Self::GreyAlpha => 2,
            Self::Rgb => 3,
            Self::Rgba => 4,
        }
    }
}

/// How ink and paper mix, decided for the whole drawing.
pub(super) struct Inking {
    /// Which group each layer belongs to: layers of one group are one coverage.
    pub(super) group_of: Vec<usize>,
    /// The ink of each group.
    inks: Vec<Colour>,
    paper: Colour,
    depth: Depth,
    mode: Mode,
}

enum Mode {
    Grey,
    GreyAlpha,
    Rgb,
    Rgba,
    /// All colours that can come about, and for each group what it makes of each of those before it.
    Indexed {
        palette: Vec<Colour>,
        steps: Vec<Vec<u8>>,
    },
}

impl Inking {
    /// Sees what inks there are.
    pub(super) fn new(drawing: &Drawing) -> Self {
        Self::with_depth(drawing, drawing.page.depth)
    }

    /// The same with other levels than the page has.
    pub(super) fn with_depth(drawing: &Drawing, depth: Depth) -> Self {
        let mut inks: Vec<Colour> = Vec::new();
        let mut group_of = Vec::with_capacity(drawing.layers.len());
        for layer in &drawing.layers {
            // Two translucent layers show where they overlap; opaque ones of one ink do not.
            let joins = layer.marks() == 0 || (layer.ink.a == 255 && inks.last() == Some(&layer.ink));
            if !joins || inks.is_empty() {
                inks.push(layer.ink);
            }
            group_of.push(inks.len() - 1);
        }
        let paper = drawing.page.paper.unwrap_or(Colour { r: 0, g: 0, b: 0, a: 0 });
        let indexed = match depth {
            Depth::One => index_colours(paper, &inks),
            Depth::Eight => None,
        };
        let grey = inks.iter().all(|ink| ink.is_grey()) && paper.is_grey();
        let mode = match (indexed, grey, paper.a == 255) {
            (Some(indexed), _, _) => indexed,
            (None, true, true) => Mode::Grey,
            (None, true, false) => Mode::GreyAlpha,
            (None, false, true) => Mode::Rgb,
            (None, false, false) => Mode::Rgba,
        };
        Self { group_of, inks, paper, depth, mode }
    }

    /// What its pixels are made of.
    pub(super) fn format(&self) -> Format {
        match &self.mode {
            Mode::Grey => Format::Grey,
            Mode::GreyAlpha => Format::GreyAlpha,
            Mode::Rgb => Format::Rgb,
            Mode::Rgba => Format::Rgba,
            Mode::Indexed { palette, .. } => Format::Indexed(palette.clone()),
        }
    }

    /// A pixel of bare paper.
    pub(super) fn blank(&self) -> Vec<u8> {
        let Colour { r, g, b, a } = self.paper;
        match self.mode {
            Mode::Grey => vec![r],
            Mode::GreyAlpha => vec![r, a],
            Mode::Rgb => vec![r, g, b],
            Mode::Rgba => vec![r, g, b, a],
            Mode::Indexed { .. } => vec![0],
        }
    }

    /// Lays the ink of a group on pixels of a row.
    pub(super) fn lay(&self, group: usize, coverage: &[u8], pixels: &mut [u8]) {
        let ink = self.inks[group];
        let weigh = |covered: u8| match self.depth {
            Depth::Eight => u32::from(covered) * u32::from(ink.a),
            Depth::One if covered >= HALF => 255 * u32::from(ink.a),
            Depth::One => 0,
        };
        match &self.mode {
            Mode::Grey => {
                for (&covered, pixel) in coverage.iter().zip(pixels) {
                    if covered > 0 {
                        *pixel = mix(*pixel, ink.r, weigh(covered));
                    }
                }
            }
            Mode::Rgb => {
                for (&covered, pixel) in coverage.iter().zip(pixels.chunks_exact_mut(3)) {
                    if covered > 0 {
                        let weight = weigh(covered);
                        for (value, ink) in pixel.iter_mut().zip([ink.r, ink.g, ink.b]) {
                            *value = mix(*value, ink, weight);
                        }
                    }
                }
            }
            Mode::GreyAlpha => {
                for (&covered, pixel) in coverage.iter().zip(pixels.chunks_exact_mut(2)) {
                    if covered > 0 {
                        over(pixel, &[ink.r], weigh(covered));
                    }
                }
            }
            Mode::Rgba => {
                for (&covered, pixel) in coverage.iter().zip(pixels.chunks_exact_mut(4)) {
                    if covered > 0 {
                        over(pixel, &[ink.r, ink.g, ink.b], weigh(covered));
                    }
                }
            }
            Mode::Indexed { steps, .. } => {
                for (&covered, pixel) in coverage.iter().zip(pixels) {
                    if covered >= HALF {
                        *pixel = steps[group].get(usize::from(*pixel)).copied().unwrap_or(*pixel);
                    }
                }
            }
        }
    }
}

/// The weight of a fully covered pixel under opaque ink.
const FULL: u32 = 255 * 255;

/// A value of opaque paper under ink of a weight from 0 to [`FULL`], rounded.
fn mix(below: u8, ink: u8, weight: u32) -> u8 {
    ((u32::from(below) * (FULL - weight) + u32::from(ink) * weight + FULL / 2) / FULL) as u8
}

/// Lays ink of a weight from 0 to [`FULL`] on a pixel whose last value is its alpha, rounded. Values are not
/// premultiplied.
fn over(pixel: &mut [u8], ink: &[u8], weight: u32) {
    let Some((alpha, values)) = pixel.split_last_mut() else { return };
    let above = u64::from(weight) * 255;
    let below = u64::from(*alpha) * u64::from(FULL - weight);
    let both = above + below;
    if both == 0 {
        return;
    }
    for (value, &ink) in values.iter_mut().zip(ink) {
        *value = ((u64::from(*value) * below + u64::from(ink) * above + both / 2) / both) as u8;
    }
    let full = u64::from(FULL);
    *alpha = ((both + full / 2) / full) as u8;
}

/// The colours that inks can make of the paper where each covers a pixel or not, unless they are more than 256.
fn index_colours(paper: Colour, inks: &[Colour]) -> Option<Mode> {
    let mut palette = vec![paper];
    let mut steps = Vec::with_capacity(inks.len());
    for ink in inks {
        let mut step = Vec::with_capacity(palette.len());
        for i in 0..palette.len() {
            let below = palette[i];
            let mut pixel = [below.r, below.g, below.b, below.a];
            over(&mut pixel, &[ink.r, ink.g, ink.b], u32::from(ink.a) * 255);
            let [r, g, b, a] = pixel;
            let mixed = Colour { r, g, b, a };
            let found = palette.iter().position(|&known| known == mixed).unwrap_or_else(|| {
                palette.push(mixed);
                palette.len() - 1
            });
            step.push(u8::try_from(found).ok()?);
        }
        steps.push(step);
    }
    Some(Mode::Indexed { palette, steps })
}
