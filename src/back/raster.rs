//! A drawing as pixels: layers of marks go in, anti-aliased or two-tone rows come out.
//!
//! The sheet is cut into tiles of a fixed size and every mark is filed under the tiles that it touches. Each tile
//! gathers the coverage of a layer in a mask, through tiny-skia, and lays the ink on what is below; layers of one opaque
//! ink that follow each other share the mask. Coordinates are rounded to 1/256 of a pixel on the whole sheet, which is
//! what the scan converter resolves, so that neighbouring tiles agree about a mark that both of them hold. Bands of
//! tiles are drawn by several threads; what they draw does not depend on how many there are.

mod cover;
mod window;

use rayon::prelude::*;
use tiny_skia::{FillRule, Mask, PathBuilder, Transform};

pub use super::inking::Format;
use super::inking::Inking;
use super::outline::{Marks, Outliner, Scale, Tile};
use crate::drawing::{Curves, Drawing, Layer};
use crate::scene::Colour;
use cover::Cover;
pub use window::{Index, Window, fitting, render as render_window};

/// Width of a tile in pixels; the scan converter works on up to 8191.
const TILE_WIDTH: usize = 2_048;
/// Height of a tile in pixels.
const TILE_HEIGHT: usize = 256;
/// The width in pixels below which strokes and dots are filled by exact areas, where that is wished: the parts that wider
/// ones are made of overlap by too much.
const THIN: f64 = 2.0;
/// Strokes, curves or dots that are filled as one path. Few enough that a path's box stays small.
const TOGETHER: usize = 32;

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
        for range in together(&strokes.curves) {
            push(Marks::Curves { pen, cap, curves: &strokes.curves, range });
        }
    }
    for range in together(&layer.tapers.spines) {
        push(Marks::Tapers { tapers: &layer.tapers, range });
    }
    for dots in &layer.dots {
        for centres in dots.bundles().flat_map(|bundle| bundle.chunks(TOGETHER)) {
            push(Marks::Dots { radius: dots.radius, centres });
        }
    }
}

/// Chains of one bundle by the [`TOGETHER`]; those of no bundle one by one.
fn together(curves: &Curves) -> impl Iterator<Item = [usize; 2]> {
    let ends = curves.bundle_ends();
    let single = ends.last().copied().unwrap_or(0);
    let starts = std::iter::once(0).chain(ends.iter().copied());
    let bundles = starts
        .zip(ends)
        .flat_map(|(start, &end)| (start..end).step_by(TOGETHER).map(move |from| [from, end.min(from + TOGETHER)]));
    bundles.chain((single..curves.len()).map(|i| [i, i + 1]))
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
    /// What thin strokes and dots are filled with, where it is not tiny-skia.
    cover: Option<Cover>,
}

impl Brush {
    /// One that covers exactly what thin strokes and dots cover, where others count samples.
    fn exact() -> Self {
        Self { cover: Some(Cover::default()), ..Self::default() }
    }

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
        let is_exact = self.cover.is_some();
        let groups = of_tile.chunk_by(|&a, &b| items[a as usize].group == items[b as usize].group);
        for group in groups {
            let Some(&first) = group.first() else { continue };
            let mut dirty: Option<[usize; 4]> = None;
            let mut fill = |marks: Marks<'_>| {
                let mut builder = std::mem::take(&mut self.builder);
                let rule = self.outliner.outline(marks, tile, &mut builder);
                let Some(path) = builder.finish() else { return };
                match (&mut self.cover, rule) {
                    (Some(cover), FillRule::Winding) if marks.width(tile.scale) < THIN => {
                        cover.fill(&path, size, mask.data_mut())
                    }
                    _ => mask.fill_path(&path, rule, true, Transform::identity()),
                }
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
            };
            for &item in group {
                let marks = items[item as usize].marks;
                if is_exact && marks.width(tile.scale) < THIN {
                    marks.parts(&mut fill);
                } else {
                    fill(marks);
                }
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

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::super::samples::{layer, lines, on_threads, page, ring, scattered};
    use super::*;
    use crate::drawing::{Dots, Strokes};
    use crate::geom::{Cubic, Length, Point, Vec2};
    use crate::scene::{Cap, Depth};

    const RED: Colour = Colour { r: 255, g: 0, b: 0, a: 255 };
    const NONE: Colour = Colour { r: 0, g: 0, b: 0, a: 0 };

    /// A drawing of one layer with ten pixels a millimetre.
    fn one(width: f64, height: f64, layer: Layer) -> Drawing {
        Drawing { page: page(width, height), layers: vec![layer] }
    }

    fn stroked(ink: Colour, strokes: Strokes) -> Layer {
        Layer { strokes: vec![strokes], ..layer("one", ink) }
    }

    /// How much of a grey picture is inked, in pixels.
    fn inked(pixels: &Pixels) -> f64 {
        assert_eq!(pixels.format, Format::Grey);
        pixels.data.iter().map(|&v| f64::from(255 - v) / 255.0).sum()
    }

    fn grey(v: u8) -> Option<Colour> {
        Some(Colour { r: v, g: v, b: v, a: 255 })
    }

    #[test]
    fn marks_cover_their_area() {
        let pi = std::f64::consts::PI;
        let horizontal = [(2.0, 5.0), (8.0, 5.0)];
        let slanted = [(2.0, 2.0), (8.0, 7.0)];
        let length = (6.0f64 * 6.0 + 5.0 * 5.0).sqrt();
        let corner = [(2.0, 2.0), (8.0, 2.0), (8.0, 8.0)];
        let polyline = |cap, points: &[(f64, f64)]| {
            let mut strokes = Strokes::new(Length::mm(1.0), cap);
            strokes.polylines.push(ring(points));
            stroked(Colour::BLACK, strokes)
        };
        let straight = |cap, line| stroked(Colour::BLACK, lines(1.0, cap, &[&[line]]));
        let mut dot = layer("dot", Colour::BLACK);
        dot.dots.push(Dots { radius: Length::mm(2.0), centres: ring(&[(5.0, 5.0)]), bundle_ends: vec![1] });
        let square = |at: f64, side: f64| ring(&[(at, at), (at + side, at), (at + side, at + side), (at, at + side)]);
        let mut area = layer("area", Colour::BLACK);
        area.areas.push(vec![square(1.0, 8.0), square(2.0, 3.0)]);
        let closed = [(2.0, 2.0), (8.0, 2.0), (8.0, 8.0), (2.0, 8.0), (2.0, 2.0)];
        for (what, layer, wanted) in [
            ("butt", straight(Cap::Butt, horizontal), 6.0),
            ("round", straight(Cap::Round, horizontal), 6.0 + pi / 4.0),
            ("slanted", straight(Cap::Butt, slanted), length),
            ("slanted, round", straight(Cap::Round, slanted), length + pi / 4.0),
            ("point, butt", straight(Cap::Butt, [(5.0, 5.0); 2]), 0.0),
            ("point, round", straight(Cap::Round, [(5.0, 5.0); 2]), pi / 4.0),
            // At a right turn the bars overlap in a quarter of a pen's square and the join adds a quarter of a disc.
            ("corner", polyline(Cap::Butt, &corner), 12.0 - 0.25 + pi / 16.0),
            ("corner, round", polyline(Cap::Round, &corner), 12.0 - 0.25 + pi / 16.0 + pi / 4.0),
            ("closed", polyline(Cap::Butt, &closed), 24.0 + 4.0 * (pi / 16.0 - 0.25)),
            ("there and back", polyline(Cap::Butt, &[(2.0, 2.0), (8.0, 2.0), (3.0, 2.0)]), 6.0 + pi / 8.0),
            ("dot", dot, 4.0 * pi),
            ("area", area, 64.0 - 9.0),
        ] {
            let found = inked(&render(&one(10.0, 10.0, layer))) / 100.0;
            assert!((found - wanted).abs() < 0.01 * wanted + 1e-9, "{what}: {found} instead of {wanted}");
        }
    }

    #[test]
    fn bends_of_a_curve_leave_no_notches() {
        // An arc in small steps, as wide as 40 pixels, has the area of its sector.
        let mut strokes = Strokes::new(Length::mm(4.0), Cap::Butt);
        let at = |i: i32| {
            let (sin, cos) = libm::sincos(f64::from(i) / 100.0);
            Point::new(8.0 * cos, 8.0 * sin) + Vec2::new(1.0, 1.0)
        };
        strokes.polylines.push((0..=150).map(at).collect());
        let found = inked(&render(&one(13.0, 13.0, stroked(Colour::BLACK, strokes)))) / 100.0;
        assert!((found - 1.5 * 8.0 * 4.0).abs() < 0.2, "{found}");
    }

    /// An arc of a quarter round (1, 1) as one cubic, for the radius 8.
    fn quarter() -> Vec<Point> {
        const K: f64 = 8.0 * 0.552_284_749_830_793_4;
        ring(&[(9.0, 1.0), (9.0, 1.0 + K), (1.0 + K, 9.0), (1.0, 9.0)])
    }

    #[test]
    fn curves_and_tapers_cover_their_area() {
        let pi = std::f64::consts::PI;
        let quarter = quarter();
        let curve = |cap| {
            let mut strokes = Strokes::new(Length::mm(1.0), cap);
            strokes.curves.push(&quarter);
            stroked(Colour::BLACK, strokes)
        };
        let taper = |spine: &[Point], widths: &[f64]| {
            let mut layer = layer("taper", Colour::BLACK);
            layer.tapers.push(spine, widths);
            layer
        };
        let line = Cubic::line(Point::new(1.0, 5.0), Point::new(9.0, 5.0)).0;
        let corner = [&line[..], &Cubic::line(line[3], Point::new(9.0, 1.0)).0[1..]].concat();
        for (what, layer, wanted) in [
            ("butt", curve(Cap::Butt), 4.0 * pi),
            ("round", curve(Cap::Round), 4.0 * pi + pi / 4.0),
            ("even", taper(&quarter, &[1.0, 1.0]), 4.0 * pi),
            ("to a point", taper(&quarter, &[1.0, 0.0]), 2.0 * pi),
            ("straight", taper(&line, &[2.0, 1.0]), 12.0),
            ("corner", taper(&corner, &[1.0, 1.0, 0.0]), 8.0 + 2.0 - 0.25 + pi / 16.0 + 0.03),
        ] {
            let found = inked(&render(&one(11.0, 11.0, layer))) / 100.0;
            assert!((found - wanted).abs() < 0.01 * wanted, "{what}: {found} instead of {wanted}");
        }
    }

    #[test]
    fn crossing_strokes_of_any_sense_are_one_ink() {
        let there = [(1.0, 3.0), (9.0, 5.0)];
        let back = [(9.0, 3.0), (1.0, 5.0)];
        let strokes = lines(1.0, Cap::Butt, &[&[there, back]]);
        let pixels = render(&one(10.0, 10.0, stroked(Colour::BLACK, strokes)));
        assert_eq!(pixels.colour(50, 40), grey(0));
    }

    #[test]
    fn tiles_show_no_seam() {
        // The same marks, moved by what is no multiple of a tile, look the same but for the rounding of edges that are
        // cut at a tile's border.
        let drawing = scattered(60.0, 60.0, 400);
        let moved = |dx: u32, dy: u32| {
            let by = |p: &mut Point| *p = *p + Vec2::new(f64::from(dx) / 8.0, f64::from(dy) / 8.0);
            let mut moved = drawing.clone();
            moved.page = page(600.0, 80.0);
            moved.page.pixels = [4800, 640];
            for layer in &mut moved.layers {
                layer.tapers.spines.points_mut().for_each(by);
                layer.areas.iter_mut().flatten().flatten().for_each(by);
                for strokes in &mut layer.strokes {
                    strokes.lines.iter_mut().flatten().for_each(by);
                    strokes.polylines.iter_mut().flatten().for_each(by);
                    strokes.curves.points_mut().for_each(by);
                }
                layer.dots.iter_mut().flat_map(|dots| &mut dots.centres).for_each(by);
            }
            render(&moved)
        };
        let still = moved(30, 30);
        // Across the border of two columns and of several bands.
        let other = moved(1800, 101);
        let (mut differing, mut balance) = (0, 0);
        for y in 0..480 {
            for x in 0..480 {
                let (a, b) = (still.colour(x + 30, y + 30).unwrap(), other.colour(x + 1800, y + 101).unwrap());
                let off = i32::from(a.g) - i32::from(b.g);
                assert!(off.abs() <= 32, "{a:?} and {b:?} at {x}, {y}");
                differing += i32::from(off != 0);
                balance += off;
            }
        }
        assert!(differing < 480, "{differing}");
        assert!(balance.abs() < differing, "{balance}");
    }

    #[test]
    fn formats_follow_the_colours() {
        let format = |paper, ink, depth| {
            let mut drawing = one(1.0, 1.0, stroked(ink, lines(0.2, Cap::Butt, &[&[[(0.0, 0.5), (1.0, 0.5)]]])));
            drawing.page.paper = paper;
            drawing.page.depth = depth;
            render(&drawing).format
        };
        let white = Some(Colour::WHITE);
        let glass = Some(Colour { a: 100, ..Colour::WHITE });
        assert_eq!(format(white, Colour::BLACK, Depth::Eight), Format::Grey);
        assert_eq!(format(white, RED, Depth::Eight), Format::Rgb);
        assert_eq!(format(None, Colour::BLACK, Depth::Eight), Format::GreyAlpha);
        assert_eq!(format(glass, Colour::BLACK, Depth::Eight), Format::GreyAlpha);
        assert_eq!(format(None, RED, Depth::Eight), Format::Rgba);
        assert_eq!(format(white, RED, Depth::One), Format::Indexed(vec![Colour::WHITE, RED]));
        assert_eq!(format(None, RED, Depth::One), Format::Indexed(vec![NONE, RED]));
    }

    #[test]
    fn two_tones_are_decided_at_half_coverage() {
        // Strokes along a row of pixels that cover a fifth and four fifths of it.
        for (pen, wanted) in [(0.02, Colour::WHITE), (0.08, RED)] {
            let mut drawing = one(1.0, 1.0, stroked(RED, lines(pen, Cap::Butt, &[&[[(0.0, 0.55), (1.0, 0.55)]]])));
            drawing.page.depth = Depth::One;
            let pixels = render(&drawing);
            assert_eq!(pixels.colour(5, 5), Some(wanted));
            assert_eq!(pixels.colour(5, 4), Some(Colour::WHITE));
        }
    }

    #[test]
    fn translucent_ink_is_even_within_a_layer_and_adds_between_layers() {
        let ink = Colour { a: 128, ..Colour::BLACK };
        let cross = lines(1.0, Cap::Butt, &[&[[(0.0, 5.0), (10.0, 5.0)]], &[[(5.0, 0.0), (5.0, 10.0)]]]);
        let mut drawing = one(10.0, 10.0, stroked(ink, cross));
        let pixels = render(&drawing);
        assert_eq!((pixels.colour(50, 50), pixels.colour(20, 50)), (grey(127), grey(127)));
        drawing.layers.push(drawing.layers[0].clone());
        assert_eq!(render(&drawing).colour(50, 50), grey(63));
        drawing.page.paper = None;
        let found = render(&drawing).colour(50, 50).unwrap();
        assert_eq!(found, Colour { a: 192, ..Colour::BLACK });
        drawing.page.depth = Depth::One;
        drawing.page.paper = Some(Colour::WHITE);
        let palette = [255, 127, 63].map(|v| Colour { r: v, g: v, b: v, a: 255 });
        assert_eq!(render(&drawing).format, Format::Indexed(palette.to_vec()));
        assert_eq!(render(&drawing).colour(50, 50), grey(63));
    }

    #[test]
    fn too_many_colours_for_a_palette_are_still_two_tone() {
        let bar = |i: u8| {
            let y = f64::from(i) / 10.0;
            stroked(
                Colour { r: i * 24, g: 255 - i * 19, b: i * i * 2, a: 128 },
                lines(0.06, Cap::Butt, &[&[[(0.0, y), (2.0, y)]]]),
            )
        };
        let mut drawing = Drawing { page: page(2.0, 2.0), layers: (1..=10).map(bar).collect() };
        drawing.page.depth = Depth::One;
        let pixels = render(&drawing);
        assert_eq!(pixels.format, Format::Rgb);
        drawing.page.depth = Depth::Eight;
        assert_ne!(render(&drawing), pixels);
    }

    #[test]
    fn unusual_numbers_and_sizes_are_survived() {
        let far = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300, -1e300, 1e6, -1e6, 0.0];
        let mut odd = Strokes::new(Length::mm(0.5), Cap::Round);
        let mut area = Vec::new();
        for &x in &far {
            for &y in &far {
                odd.lines.push([Point::new(x, y), Point::new(5.0, 5.0)]);
                odd.curves.push(&[Point::new(5.0, 5.0), Point::new(x, y), Point::new(y, x), Point::new(1.0, y)]);
                odd.polylines.push(vec![Point::new(5.0, 5.0), Point::new(x, y), Point::new(y, x)]);
                area.push(Point::new(x, y));
            }
        }
        odd.bundle_ends.push(odd.lines.len());
        for pen in [0.5, 0.0, 1e-12, 1e4] {
            odd.pen = Length::mm(pen);
            let mut layer = stroked(Colour::BLACK, odd.clone());
            layer.areas = area.iter().map(|&p| vec![vec![p, Point::new(1.0, 2.0), Point::new(2.0, 1.0)]]).collect();
            for spine in odd.curves.iter() {
                layer.tapers.push(spine, &[pen, 1.0]);
            }
            let mut drawing = one(10.0, 10.0, layer);
            assert_eq!(render(&drawing).data.len(), 100 * 100);
            for pixels in [[1, 1], [0, 5], [5, 0], [9000, 2], [2, 9000]] {
                drawing.page.pixels = pixels;
                assert_eq!(render(&drawing).data.len(), (pixels[0] * pixels[1]) as usize);
            }
        }
    }

    #[test]
    fn oblong_pixels_stretch_strokes_with_the_page() {
        let mut drawing =
            one(10.0, 10.0, stroked(Colour::BLACK, lines(1.0, Cap::Butt, &[&[[(2.0, 5.0), (8.0, 5.0)]]])));
        drawing.page.pixels = [50, 200];
        assert!((inked(&render(&drawing)) - 6.0 * 100.0).abs() < 1.0);
    }

    #[test]
    fn threads_do_not_matter() {
        let drawing = scattered(90.0, 90.0, 1000);
        let [one, four] = on_threads(|| render(&drawing));
        assert!(one == four);
    }
}
