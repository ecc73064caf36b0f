//! A drawing as pixels: layers of marks go in, anti-aliased or two-tone rows come out.
//!
//! The sheet is cut into tiles of a fixed size and every mark is filed under the tiles that it touches. Each tile
//! gathers the coverage of a layer in a mask, through tiny-skia, and lays the ink on what is below; layers of one opaque
//! ink that follow each other share the mask. Coordinates are rounded to 1/256 of a pixel on the whole sheet, which is
//! what the scan converter resolves, so that neighbouring tiles agree about a mark that both of them hold. Bands of
//! tiles are drawn by several threads; what they draw does not depend on how many there are.

use rayon::prelude::*;
use tiny_skia::{Mask, PathBuilder, Transform};

use super::outline::{Marks, Outliner, Scale, Tile};
use crate::drawing::{Drawing, Layer};
use crate::scene::{Colour, Depth};

/// Width of a tile in pixels; the scan converter works on up to 8191.
const TILE_WIDTH: usize = 2_048;
/// Height of a tile in pixels.
const TILE_HEIGHT: usize = 256;
/// Strokes or dots that are filled as one path. Few enough that a path's box stays small.
const TOGETHER: usize = 32;
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

/// A picture, row by row from the top left.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Pixels {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// What a pixel is made of.
    pub format: Format,
    /// `width * height` pixels.
    pub data: Vec<u8>,
}

impl Pixels {
    /// The colour at a place, if it lies in the picture.
    #[must_use]
    pub fn colour(&self, x: usize, y: usize) -> Option<Colour> {
        if x >= self.width {
            return None;
        }
        let channels = self.format.channels();
        let pixel = self.data.chunks_exact(channels).nth(y.checked_mul(self.width)?.checked_add(x)?)?;
        match (&self.format, pixel) {
            (Format::Indexed(palette), &[i]) => palette.get(usize::from(i)).copied(),
            (_, &[v]) => Some(Colour { r: v, g: v, b: v, a: 255 }),
            (_, &[v, a]) => Some(Colour { r: v, g: v, b: v, a }),
            (_, &[r, g, b]) => Some(Colour { r, g, b, a: 255 }),
            (_, &[r, g, b, a]) => Some(Colour { r, g, b, a }),
            _ => None,
        }
    }
}

/// Draws a drawing at the size that its page gives. Whether that size is bearable is the caller's concern.
#[must_use]
pub fn render(drawing: &Drawing) -> Pixels {
    let [width, height] = drawing.page.pixels.map(|n| n as usize);
    let inking = Inking::new(drawing);
    let format = inking.format();
    let channels = format.channels();
    let mut data = inking.blank().repeat(width * height);
    let scale = Scale::new(drawing.page.pixels, drawing.page.width, drawing.page.height);
    let items = file_items(drawing, &inking, scale);
    let columns = width.div_ceil(TILE_WIDTH);
    let tiles = Tiles::new(&items, columns, height.div_ceil(TILE_HEIGHT));
    if width > 0 {
        data.par_chunks_mut(width * channels * TILE_HEIGHT).enumerate().for_each_init(
            Brush::default,
            |brush, (band, rows)| {
                for column in 0..columns {
                    let left = column * TILE_WIDTH;
                    let size = [TILE_WIDTH.min(width - left), rows.len() / (width * channels)];
                    let tile = Tile { origin: [left, band * TILE_HEIGHT], size, scale };
                    brush.paint(&items, tiles.of(band * columns + column), tile, |group, row, x, coverage| {
                        let start = (row * width + left + x) * channels;
                        if let Some(pixels) = rows.get_mut(start..start + coverage.len() * channels) {
                            inking.lay(group, coverage, pixels);
                        }
                    });
                }
            },
        );
    }
    Pixels { width, height, format, data }
}

/// How ink and paper mix, decided for the whole drawing.
struct Inking {
    /// Which group each layer belongs to: layers of one group are one coverage.
    group_of: Vec<usize>,
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
    fn new(drawing: &Drawing) -> Self {
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
        let depth = drawing.page.depth;
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

    fn format(&self) -> Format {
        match &self.mode {
            Mode::Grey => Format::Grey,
            Mode::GreyAlpha => Format::GreyAlpha,
            Mode::Rgb => Format::Rgb,
            Mode::Rgba => Format::Rgba,
            Mode::Indexed { palette, .. } => Format::Indexed(palette.clone()),
        }
    }

    /// A pixel of bare paper.
    fn blank(&self) -> Vec<u8> {
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
    fn lay(&self, group: usize, coverage: &[u8], pixels: &mut [u8]) {
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

/// Marks that are filled as one path.
struct Item<'a> {
    group: u32,
    marks: Marks<'a>,
    /// The first and last tile that it touches, across and down; none where it lies off the sheet.
    touches: Option<[[u32; 2]; 2]>,
}

/// All marks in drawing order, with the tiles that they touch.
fn file_items<'a>(drawing: &'a Drawing, inking: &Inking, scale: Scale) -> Vec<Item<'a>> {
    let mut items = Vec::new();
    for (layer, &group) in drawing.layers.iter().zip(&inking.group_of) {
        let mut push = |marks| items.push(Item { group: group as u32, marks, touches: None });
        push_marks(layer, &mut push);
    }
    let [width, height] = drawing.page.pixels.map(f64::from);
    items.par_iter_mut().for_each(|item| {
        let bounds = scale.bounds(item.marks.bounds());
        // Not a number is no box: such marks are nowhere.
        let on_sheet = bounds.min.x < width && bounds.min.y < height && bounds.max.x > 0.0 && bounds.max.y > 0.0;
        item.touches = on_sheet.then(|| {
            let tile = |at: f64, end: f64, size: usize| (at.clamp(0.0, end - 1.0) as usize / size) as u32;
            let [min, max] = [bounds.min, bounds.max];
            [
                [tile(min.x, width, TILE_WIDTH), tile(max.x, width, TILE_WIDTH)],
                [tile(min.y, height, TILE_HEIGHT), tile(max.y, height, TILE_HEIGHT)],
            ]
        });
    });
    items
}

fn push_marks<'a>(layer: &'a Layer, push: &mut impl FnMut(Marks<'a>)) {
    for area in &layer.areas {
        push(Marks::Area(area));
    }
    for strokes in &layer.strokes {
        let (pen, cap) = (strokes.pen, strokes.cap);
        for lines in strokes.bundles().flat_map(|bundle| bundle.chunks(TOGETHER)) {
            push(Marks::Lines { pen, cap, lines });
        }
        for points in &strokes.polylines {
            push(Marks::Polyline { pen, cap, points });
        }
    }
    for dots in &layer.dots {
        for centres in dots.bundles().flat_map(|bundle| bundle.chunks(TOGETHER)) {
            push(Marks::Dots { radius: dots.radius, centres });
        }
    }
}

/// Which items touch each tile, in drawing order.
struct Tiles {
    /// Where the items of each tile start; one more than there are tiles.
    starts: Vec<usize>,
    items: Vec<u32>,
}

impl Tiles {
    fn new(items: &[Item<'_>], columns: usize, rows: usize) -> Self {
        let touched = |item: &Item<'_>| {
            let [[left, right], [top, bottom]] = item.touches.unwrap_or([[1, 0]; 2]);
            (top..=bottom).flat_map(move |y| (left..=right).map(move |x| y as usize * columns + x as usize))
        };
        let mut starts = vec![0; columns * rows + 1];
        for tile in items.iter().flat_map(touched) {
            starts[tile + 1] += 1;
        }
        for tile in 0..columns * rows {
            starts[tile + 1] += starts[tile];
        }
        let mut next = starts.clone();
        let mut list = vec![0; starts.last().copied().unwrap_or(0)];
        for (i, item) in items.iter().enumerate() {
            for tile in touched(item) {
                list[next[tile]] = i as u32;
                next[tile] += 1;
            }
        }
        Self { starts, items: list }
    }

    fn of(&self, tile: usize) -> &[u32] {
        &self.items[self.starts[tile]..self.starts[tile + 1]]
    }
}

/// What one thread draws with.
#[derive(Default)]
struct Brush {
    mask: Option<Mask>,
    builder: PathBuilder,
    outliner: Outliner,
}

impl Brush {
    /// Draws the items of one tile; `lay` is given the coverage of one group on a run of a row at a time.
    fn paint(
        &mut self,
        items: &[Item<'_>],
        of_tile: &[u32],
        tile: Tile,
        mut lay: impl FnMut(usize, usize, usize, &[u8]),
    ) {
        let size = tile.size;
        let [width, height] = size.map(|n| n as u32);
        if of_tile.is_empty() {
            return;
        }
        if self.mask.as_ref().is_none_or(|mask| mask.width() != width || mask.height() != height) {
            self.mask = Mask::new(width, height);
        }
        let Some(mask) = &mut self.mask else { return };
        let groups = of_tile.chunk_by(|&a, &b| items[a as usize].group == items[b as usize].group);
        for group in groups {
            let Some(&first) = group.first() else { continue };
            let mut dirty: Option<[usize; 4]> = None;
            for &item in group {
                let mut builder = std::mem::take(&mut self.builder);
                let rule = self.outliner.outline(items[item as usize].marks, tile, &mut builder);
                let Some(path) = builder.finish() else { continue };
                mask.fill_path(&path, rule, true, Transform::identity());
                let bounds = path.bounds();
                let clamp = |at: f32, end: usize| (at.max(0.0) as usize).min(end);
                let [left, top] = [clamp(bounds.left().floor(), size[0]), clamp(bounds.top().floor(), size[1])];
                let right = clamp(bounds.right().ceil(), size[0]);
                let bottom = clamp(bounds.bottom().ceil(), size[1]);
                dirty = Some(match dirty {
                    None => [left, top, right, bottom],
                    Some([l, t, r, b]) => [l.min(left), t.min(top), r.max(right), b.max(bottom)],
                });
                self.builder = path.clear();
            }
            let Some([left, top, right, bottom]) = dirty else { continue };
            let group = items[first as usize].group as usize;
            let rows = mask.data_mut().chunks_exact_mut(size[0]).enumerate().take(bottom).skip(top);
            for (row, coverage) in rows {
                let coverage = &mut coverage[left.min(right)..right];
                lay(group, row, left, coverage);
                coverage.fill(0);
            }
        }
    }
}
