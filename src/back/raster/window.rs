//! Parts of a drawing as pixels, at any scale: which marks lie there is looked up, so that the rest costs next to
//! nothing.
//!
//! The page is a sheet of pixels of one size, counted from its top left corner, and a window is a rectangle of them.
//! Windows agree with each other at their borders, whatever they are: the sheet is drawn in cells that do not depend on
//! them. What strokes cover of a pixel is computed exactly, or hatching would turn into bands where pens are thin; where
//! they are so thin that many strokes share a pixel, several finer pixels are drawn for each and averaged.

use rayon::prelude::*;

use super::{Brush, Format, Item, Pixels, TILE_HEIGHT, TILE_WIDTH, push_marks};
use crate::back::inking::Inking;
use crate::back::outline::{Marks, Scale, Tile};
use crate::drawing::Drawing;
use crate::geom::{Point, Rect};
use crate::scene::Depth;

/// At most so many finer pixels are drawn along each side of a pixel.
const FINEST: u32 = 8;

/// Width in pixels of the cells that a sheet is drawn in; narrower where pixels are finer.
const CELL: usize = 512;

/// The width in finer pixels that the thinnest pen should have at least. Strokes cover exactly what they cover however thin
/// they are, but how several of them share a pixel is only guessed.
const WIDTH: f64 = 0.25;

/// Where the marks of a drawing lie.
#[derive(Debug)]
pub struct Index {
    /// The box around each run of marks, in drawing order.
    boxes: Vec<Rect>,
    /// The least width of a stroke or dot; infinite where there is none.
    thinnest: f64,
}

impl Index {
    /// Looks through all marks of a drawing.
    #[must_use]
    pub fn new(drawing: &Drawing) -> Self {
        let mut marks = Vec::new();
        for layer in &drawing.layers {
            push_marks(layer, &mut |item| marks.push(item));
        }
        let pens = drawing.layers.iter().flat_map(|layer| {
            let strokes = layer.strokes.iter().map(|strokes| strokes.pen.to_mm());
            let dots = layer.dots.iter().map(|dots| dots.radius.to_mm() * 2.0);
            // Where a stroke runs out it is thin whatever its width is.
            let tapers = layer.tapers.widths.iter().copied().reduce(f64::max);
            strokes.chain(dots).chain(tapers)
        });
        let thinnest = pens.filter(|pen| *pen > 0.0).fold(f64::INFINITY, f64::min);
        Self { boxes: marks.par_iter().map(Marks::bounds).collect(), thinnest }
    }

    /// How many finer pixels are drawn along each side of a pixel of a window, a power of two.
    fn fineness(&self, window: &Window) -> u32 {
        let mut finer = 1;
        while finer < FINEST && self.thinnest * window.per_mm * f64::from(finer) < WIDTH {
            finer *= 2;
        }
        if self.thinnest.is_finite() { finer } else { 1 }
    }
}

/// A rectangle of a sheet's pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    /// Pixels in a millimetre.
    pub per_mm: f64,
    /// The pixel at its top left, across and down.
    pub corner: [u32; 2],
    /// Its width and height in pixels.
    pub size: [u32; 2],
}

/// Draws a window of a drawing with all levels, whatever depth its page has. `is_shown` says of every layer, by its
/// number, whether it is. What lies beyond the page is drawn like what lies on it.
#[must_use]
pub fn render(drawing: &Drawing, index: &Index, window: &Window, is_shown: impl Fn(usize) -> bool) -> Pixels {
    let [width, height] = window.size.map(|n| n as usize);
    let finer = index.fineness(window) as usize;
    let scale = Scale::even(window.per_mm * finer as f64);
    let inking = Inking::with_depth(drawing, Depth::Eight);
    let format = inking.format();
    let channels = format.channels();
    let (items, boxes) = seen(drawing, index, window, &inking, is_shown);
    let corner = window.corner.map(|n| n as usize);
    // Cells of the whole sheet are drawn, whatever of them the window shows: where a mark is cut changes its last level.
    let cell = [CELL.min(TILE_WIDTH / finer), TILE_HEIGHT / finer];
    let mut data = inking.blank().repeat(width * height);
    let mut bands = Vec::new();
    let mut rest = data.as_mut_slice();
    let (mut top, bottom) = (corner[1], corner[1] + height);
    while top < bottom && width > 0 {
        let down = (cell[1] - top % cell[1]).min(bottom - top);
        let (band, after) = rest.split_at_mut(down * width * channels);
        bands.push((top, band));
        rest = after;
        top += down;
    }
    bands.into_par_iter().for_each_init(Brush::exact, |brush, (top, out)| {
        let size = cell.map(|side| side * finer);
        let mut fine = Vec::new();
        for left in (corner[0] / cell[0] * cell[0]..corner[0] + width).step_by(cell[0]) {
            let origin = [left * finer, top / cell[1] * size[1]];
            let tile = Tile { origin, size, scale };
            let sight = tile.reach(0.0);
            let touched = boxes.iter().zip(0..).filter(|(bounds, _)| bounds.touches(&sight));
            let here: Vec<u32> = touched.map(|(_, item)| item).collect();
            if here.is_empty() {
                continue;
            }
            fine.clear();
            fine.extend(inking.blank().repeat(size[0] * size[1]));
            brush.paint(&items, &here, tile, |group, row, x, coverage| {
                let start = (row * size[0] + x) * channels;
                if let Some(pixels) = fine.get_mut(start..start + coverage.len() * channels) {
                    inking.lay(group, coverage, pixels);
                }
            });
            let from = corner[0].max(left);
            let to = (corner[0] + width).min(left + cell[0]);
            for (row, out) in out.chunks_exact_mut(width * channels).enumerate() {
                let out = &mut out[(from - corner[0]) * channels..(to - corner[0]) * channels];
                let first = ((top % cell[1] + row) * finer * size[0] + (from - left) * finer) * channels;
                average(fine.get(first..).unwrap_or_default(), size[0] * channels, finer, &format, out);
            }
        }
    });
    Pixels { width, height, format, data }
}

/// The marks that a window shows, in drawing order, and the boxes around them.
fn seen<'a>(
    drawing: &'a Drawing,
    index: &Index,
    window: &Window,
    inking: &Inking,
    is_shown: impl Fn(usize) -> bool,
) -> (Vec<Item<'a>>, Vec<Rect>) {
    // A pixel more than is seen on each side: rounding moves marks by less.
    let at = |pixels: [u32; 2], more: f64| {
        Point::new((f64::from(pixels[0]) + more) / window.per_mm, (f64::from(pixels[1]) + more) / window.per_mm)
    };
    let end = [0, 1].map(|i| window.corner[i].saturating_add(window.size[i]));
    let sight = Rect::new(at(window.corner, -1.0), at(end, 1.0));
    let mut boxes = index.boxes.iter();
    let (mut items, mut touching) = (Vec::new(), Vec::new());
    for (i, (layer, &group)) in drawing.layers.iter().zip(&inking.group_of).enumerate() {
        let shown = is_shown(i);
        push_marks(layer, &mut |marks| {
            if let Some(&bounds) = boxes.next()
                && shown
                && bounds.touches(&sight)
            {
                items.push(Item { group: group as u32, marks, touches: None });
                touching.push(bounds);
            }
        });
    }
    (items, touching)
}

/// Averages squares of `finer * finer` pixels to a row of pixels. `fine` begins with the first square, and has `stride` bytes
/// in a row.
fn average(fine: &[u8], stride: usize, finer: usize, format: &Format, out: &mut [u8]) {
    if finer == 1 {
        out.copy_from_slice(&fine[..out.len()]);
        return;
    }
    let channels = format.channels();
    let alpha = matches!(format, Format::GreyAlpha | Format::Rgba).then(|| channels - 1);
    let colours = alpha.unwrap_or(channels);
    let count = (finer * finer) as u32;
    for (i, pixel) in out.chunks_exact_mut(channels).enumerate() {
        let mut sums = [0u32; 4];
        for y in 0..finer {
            let start = y * stride + i * finer * channels;
            for fine in fine[start..start + finer * channels].chunks_exact(channels) {
                // Colours weigh as much as they cover.
                let weight = alpha.map_or(1, |at| u32::from(fine[at]));
                for (sum, &value) in sums.iter_mut().zip(&fine[..colours]) {
                    *sum += u32::from(value) * weight;
                }
                sums[3] += if alpha.is_some() { weight } else { 0 };
            }
        }
        let weight = if alpha.is_some() { sums[3] } else { count };
        for (value, sum) in pixel[..colours].iter_mut().zip(sums) {
            *value = (sum + weight / 2).checked_div(weight).unwrap_or(0) as u8;
        }
        if let Some(at) = alpha {
            pixel[at] = ((weight + count / 2) / count) as u8;
        }
    }
}

/// The scale at which a drawing fits into a square of so many pixels, in pixels a millimetre.
#[must_use]
pub fn fitting(drawing: &Drawing, side: u32) -> f64 {
    f64::from(side) / drawing.page.width.to_mm().max(drawing.page.height.to_mm())
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::render as render_whole;
    use super::*;
    use crate::back::samples::{layer, lines, on_threads, page, scattered};
    use crate::scene::{Cap, Colour};

    fn window(per_mm: f64, corner: [u32; 2], size: [u32; 2]) -> Window {
        Window { per_mm, corner, size }
    }

    /// A window made of windows of a side.
    fn put_together(drawing: &Drawing, per_mm: f64, size: [u32; 2], side: u32) -> Vec<u8> {
        let index = Index::new(drawing);
        let channels = Inking::with_depth(drawing, Depth::Eight).format().channels();
        let mut data = vec![0; (size[0] * size[1]) as usize * channels];
        for top in (0..size[1]).step_by(side as usize) {
            for left in (0..size[0]).step_by(side as usize) {
                let part = [side.min(size[0] - left), side.min(size[1] - top)];
                let pixels = render(drawing, &index, &window(per_mm, [left, top], part), |_| true);
                for (row, bytes) in pixels.data.chunks_exact(pixels.width * channels).enumerate() {
                    let start = ((top as usize + row) * size[0] as usize + left as usize) * channels;
                    data[start..start + bytes.len()].copy_from_slice(bytes);
                }
            }
        }
        data
    }

    #[test]
    fn a_window_of_the_whole_page_is_the_picture() {
        let drawing = scattered(70.0, 60.0, 700);
        let whole = render_whole(&drawing);
        let found = render(&drawing, &Index::new(&drawing), &window(10.0, [0, 0], drawing.page.pixels), |_| true);
        assert_eq!((found.width, found.height, &found.format), (whole.width, whole.height, &whole.format));
        // The picture is cut into other cells, and what is cut off changes a level here and there.
        let far = found.data.iter().zip(&whole.data).filter(|(a, b)| a.abs_diff(**b) > 3).count();
        assert!(far * 10_000 < whole.data.len(), "{far} of {}", whole.data.len());
    }

    #[test]
    fn layers_may_be_left_out() {
        let drawing = scattered(30.0, 30.0, 100);
        let without = Drawing { layers: drawing.layers[1..].to_vec(), ..drawing.clone() };
        let [found, wanted] = [(&drawing, 1), (&without, 0)].map(|(drawing, first)| {
            render(drawing, &Index::new(drawing), &window(10.0, [0, 0], [300, 300]), |layer| layer >= first)
        });
        assert_eq!(found, wanted);
    }

    #[test]
    fn thin_hatching_is_even_from_afar() {
        // Lines of 0.2 mm every millimetre cover a fifth; a pixel is four millimetres wide.
        let all: Vec<[(f64, f64); 2]> = (0..400).map(|i| f64::from(i) + 0.37).map(|y| [(0.0, y), (400.0, y)]).collect();
        let mut hatched = layer("hatched", Colour::BLACK);
        hatched.strokes.push(lines(0.2, Cap::Butt, &[&all]));
        let drawing = Drawing { page: page(400.0, 400.0), layers: vec![hatched] };
        let pixels = render(&drawing, &Index::new(&drawing), &window(0.25, [0, 0], [100, 100]), |_| true);
        let inside = pixels.data.chunks_exact(100).take(99).skip(1).flat_map(|row| &row[1..99]);
        assert!(inside.clone().all(|&v| (190..=220).contains(&v)), "{:?}", inside.collect::<Vec<_>>());
    }

    #[test]
    fn transparent_paper_is_averaged_by_what_covers_it() {
        let mut drawing = scattered(40.0, 40.0, 60);
        drawing.page.paper = None;
        let pixels = render(&drawing, &Index::new(&drawing), &window(1.0, [0, 0], [40, 40]), |layer| layer == 1);
        assert_eq!(pixels.format, Format::Rgba);
        let covered: Vec<&[u8]> = pixels.data.chunks_exact(4).filter(|pixel| pixel[3] > 0).collect();
        // The red layer's colour is the same wherever anything of it is seen.
        let near = |pixel: &[u8]| [200, 30, 40].iter().zip(pixel).all(|(a, b)| b.abs_diff(*a) <= 2);
        assert!(!covered.is_empty() && covered.iter().filter(|pixel| pixel[3] > 8).all(|pixel| near(pixel)));
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(12))]
        #[test]
        fn windows_agree_at_their_borders(per_mm in 0.4..20.0f64, side in 90..700u32, clear: bool) {
            let mut drawing = scattered(50.0, 40.0, 300);
            if clear {
                drawing.page.paper = None;
            }
            let size = [50.0, 40.0].map(|length: f64| (length * per_mm) as u32 + 3);
            let whole = render(&drawing, &Index::new(&drawing), &window(per_mm, [0, 0], size), |_| true);
            prop_assert!(put_together(&drawing, per_mm, size, side) == whole.data);
        }
    }

    #[test]
    fn threads_do_not_matter() {
        let drawing = scattered(60.0, 60.0, 300);
        let index = Index::new(&drawing);
        let [one, four] = on_threads(|| render(&drawing, &index, &window(3.0, [20, 10], [150, 170]), |_| true));
        assert_eq!(one, four);
    }
}
