//! Laying out a sheet: the places of pictures, their frames and what is written around them.

use crate::drawing::{Layer, Page, Strokes};
use crate::geom::{Length, Point, Rect};
use crate::scene::{Cap, Colour, Depth};

use super::{Anchor, FAINT, GREY, Grid, Holds, INK, Place, Row, Scale, Sheet, Slot, Text, letters};

/// White around everything, in millimetres like all that follows.
const MARGIN: f64 = 10.0;
/// White between two pictures.
const GAP: f64 = 5.0;
/// White between a row and the next.
const ROW_GAP: f64 = 6.0;
/// White between what is written beside or under a picture and the picture.
const NEAR: f64 = 1.6;
/// White over and under the heading of rows.
const HEADING: [f64; 2] = [4.0, 3.0];

/// Sizes of letters: the title, the headings of rows, labels, and all else.
const TITLE: f64 = 6.0;
const HEAD: f64 = 4.4;
const LABEL: f64 = 3.4;
const SMALL: f64 = 2.8;
/// From one line to the next, as a part of the size.
const LEADING: f64 = 1.35;

/// What stands left of rows is wrapped beyond this width, in so many lines each.
const LABEL_WIDTH: f64 = 44.0;
const LABEL_LINES: usize = 4;
/// Captions under pictures are wrapped into so many lines each.
const CAPTION_LINES: usize = 2;

/// The height of a place without a picture as a part of its width, at most.
const WORDS: f64 = 0.75;

/// Pictures that are as wide have larger captions.
const WIDE: f64 = 60.0;

/// The width of frames.
const FRAME: f64 = 0.15;

/// The resolution of a sheet's raster, in pixels per inch.
const DPI: f64 = 300.0;

/// What a picture's place needs besides the picture.
struct Measures {
    /// The space that every picture has, width and height.
    cell: [f64; 2],
    /// How wide what stands left of the rows is, with its white.
    label: f64,
    columns: usize,
    /// Millimetres on the sheet for one of a picture, where all have one scale.
    scale: f64,
}

pub(super) fn lay_out(grid: &Grid) -> Sheet {
    let measures = measure(grid);
    let columns = measures.columns.max(1) as f64;
    let inner = (measures.label + columns * (measures.cell[0] + GAP) - GAP).max(longest_title(grid));
    let mut writer = Writer { texts: Vec::new(), frames: Vec::new(), places: Vec::new(), y: MARGIN };
    writer.title(grid, inner);
    writer.heads(grid, &measures);
    let mut slot = 0;
    for (i, row) in grid.rows.iter().enumerate() {
        if i > 0 {
            writer.y += ROW_GAP;
        }
        writer.heading(row, inner);
        writer.row(grid, row, &measures, slot);
        slot += row.slots.len();
    }
    let Writer { texts, frames, places, y } = writer;
    Sheet { page: page(inner + 2.0 * MARGIN, y + MARGIN), places, texts, frames }
}

/// A white page of whole tenths of millimetres.
fn page(width: f64, height: f64) -> Page {
    let [width, height] = [width, height].map(|side| (side * 10.0).ceil() / 10.0);
    let pixels = |mm: f64| (mm * (DPI / Length::MM_PER_INCH)).round().clamp(1.0, f64::from(u32::MAX)) as u32;
    Page {
        width: Length::mm(width),
        height: Length::mm(height),
        bleed: Length::ZERO,
        pixels: [pixels(width), pixels(height)],
        dpi: DPI,
        paper: Some(Colour::WHITE),
        depth: Depth::Eight,
    }
}

fn sizes(grid: &Grid) -> impl Iterator<Item = [f64; 2]> {
    grid.rows.iter().flat_map(|row| &row.slots).filter_map(|slot| match slot.holds {
        Holds::Picture(size) => Some(size.map(Length::to_mm)),
        Holds::Words(_) => None,
    })
}

fn measure(grid: &Grid) -> Measures {
    let side = grid.side.to_mm();
    let widest = sizes(grid).fold([0.0, 0.0], |most: [f64; 2], size| [most[0].max(size[0]), most[1].max(size[1])]);
    let longest = widest[0].max(widest[1]);
    let cell = match longest > 0.0 {
        true => widest.map(|of| of * side / longest),
        false => [side, side * WORDS],
    };
    let labels = grid.rows.iter().flat_map(label_lines).map(|(line, size)| width(&line, size));
    let label = labels.fold(0.0, f64::max);
    let label = if label > 0.0 { label + GAP } else { 0.0 };
    let columns = grid.rows.iter().map(|row| row.slots.len()).max().unwrap_or(0);
    let scale = side / longest.max(f64::MIN_POSITIVE);
    Measures { cell, label, columns, scale }
}

fn width(text: &str, size: f64) -> f64 {
    letters::width(text, Length::mm(size)).to_mm()
}

/// A title alone makes a sheet wider, as far as a page is wide.
fn longest_title(grid: &Grid) -> f64 {
    let lines = grid.subtitle.iter().map(|line| width(line, SMALL));
    lines.fold(width(&grid.title, TITLE), f64::max).min(120.0)
}

/// The lines left of a row with their sizes.
fn label_lines(row: &Row) -> Vec<(String, f64)> {
    let wrapped = |(i, text): (usize, &String)| {
        let size = if i == 0 { LABEL } else { SMALL };
        let lines = letters::wrapped(text, Length::mm(size), Length::mm(LABEL_WIDTH), LABEL_LINES);
        lines.into_iter().map(move |line| (line, size)).collect::<Vec<_>>()
    };
    row.label.iter().enumerate().flat_map(wrapped).collect()
}

/// The size of captions: larger under large pictures.
fn caption_size(measures: &Measures) -> f64 {
    if measures.cell[0] >= WIDE { LABEL } else { SMALL }
}

/// The lines under a picture.
fn caption_lines(slot: &Slot, size: f64, most: f64) -> Vec<String> {
    let wrapped = |text: &String| letters::wrapped(text, Length::mm(size), Length::mm(most), CAPTION_LINES);
    slot.caption.iter().flat_map(wrapped).collect()
}

/// Writes from the top down.
struct Writer {
    texts: Vec<Text>,
    frames: Vec<Rect>,
    places: Vec<Place>,
    /// How far down it has come.
    y: f64,
}

impl Writer {
    fn text(&mut self, text: String, at: Point, anchor: Anchor, (size, ink): (f64, Colour)) {
        self.texts.push(Text { text, at, anchor, size: Length::mm(size), ink });
    }

    fn title(&mut self, grid: &Grid, inner: f64) {
        let lines = std::iter::once((&grid.title, TITLE, INK)).filter(|(text, ..)| !text.is_empty());
        let lines: Vec<_> = lines.chain(grid.subtitle.iter().map(|line| (line, SMALL, GREY))).collect();
        for (text, size, ink) in &lines {
            let line = letters::shortened(text, Length::mm(*size), Length::mm(inner));
            self.text(line, Point::new(MARGIN, self.y + size * 0.8), Anchor::Start, (*size, *ink));
            self.y += size * LEADING;
        }
        if !lines.is_empty() {
            self.y += ROW_GAP / 2.0;
        }
    }

    fn heads(&mut self, grid: &Grid, measures: &Measures) {
        if grid.heads.is_empty() {
            return;
        }
        for (i, head) in grid.heads.iter().enumerate() {
            let centre = left(measures, i) + measures.cell[0] / 2.0;
            let head = letters::shortened(head, Length::mm(LABEL), Length::mm(measures.cell[0] + GAP / 2.0));
            self.text(head, Point::new(centre, self.y + LABEL * 0.8), Anchor::Middle, (LABEL, INK));
        }
        self.y += LABEL + NEAR;
    }

    fn heading(&mut self, row: &Row, inner: f64) {
        let Some(heading) = &row.heading else { return };
        self.y += HEADING[0];
        let line = letters::shortened(heading, Length::mm(HEAD), Length::mm(inner));
        self.text(line, Point::new(MARGIN, self.y + HEAD * 0.8), Anchor::Start, (HEAD, INK));
        self.y += HEAD + HEADING[1];
    }

    /// A row whose first slot has this number.
    fn row(&mut self, grid: &Grid, row: &Row, measures: &Measures, first: usize) {
        let top = self.y;
        let mut y = top;
        for (line, size) in label_lines(row) {
            let ink = if size > SMALL { INK } else { GREY };
            self.text(line, Point::new(MARGIN, y + size * 0.85), Anchor::Start, (size, ink));
            y += size * LEADING;
        }
        let mut lowest = y;
        // A row has the height of its tallest picture, so that captions follow closely.
        let height = row.slots.iter().map(|slot| size(grid, slot, measures)[1]).fold(0.0, f64::max);
        for (i, slot) in row.slots.iter().enumerate() {
            let left = left(measures, i);
            let [width, tall] = size(grid, slot, measures);
            let corner = Point::new(left + (measures.cell[0] - width) / 2.0, top + (height - tall) / 2.0);
            let area = Rect::new(corner, Point::new(corner.x + width, corner.y + tall));
            self.frames.push(area);
            match &slot.holds {
                Holds::Picture(_) => self.places.push(Place { slot: first + i, name: slot.name.clone(), area }),
                Holds::Words(words) => self.words(words, &area),
            }
            let centre = left + measures.cell[0] / 2.0;
            let mut y = top + height + NEAR;
            let size = caption_size(measures);
            for line in caption_lines(slot, size, measures.cell[0] + GAP / 2.0) {
                self.text(line, Point::new(centre, y + size * 0.85), Anchor::Middle, (size, INK));
                y += size * LEADING;
            }
            lowest = lowest.max(y);
        }
        self.y = lowest.max(top + height);
    }

    /// Words in the middle of a place.
    fn words(&mut self, words: &str, area: &Rect) {
        let room = Length::mm((area.width() - 2.0 * NEAR).max(1.0));
        let most = ((area.height() - 2.0 * NEAR) / (SMALL * LEADING)).floor().max(1.0) as usize;
        let lines = letters::wrapped(words, Length::mm(SMALL), room, most);
        let tall = SMALL * LEADING * lines.len() as f64;
        let mut y = area.centre().y - tall / 2.0;
        for line in lines {
            self.text(line, Point::new(area.centre().x, y + SMALL), Anchor::Middle, (SMALL, GREY));
            y += SMALL * LEADING;
        }
    }
}

/// A line in the middle of an area.
pub(super) fn in_the_middle(area: &Rect, words: &str) -> Text {
    let size = Length::mm(SMALL);
    let text = letters::shortened(words, size, Length::mm((area.width() - 2.0 * NEAR).max(1.0)));
    let at = Point::new(area.centre().x, area.centre().y + SMALL * 0.35);
    Text { text, at, anchor: Anchor::Middle, size, ink: GREY }
}

/// The left end of a column.
fn left(measures: &Measures, column: usize) -> f64 {
    MARGIN + measures.label + column as f64 * (measures.cell[0] + GAP)
}

/// How large a picture is on the sheet.
fn size(grid: &Grid, slot: &Slot, measures: &Measures) -> [f64; 2] {
    let Holds::Picture(size) = slot.holds else {
        let [width, height] = measures.cell;
        return [width, height.min(width * WORDS)];
    };
    let size = size.map(Length::to_mm);
    let scale = match grid.scale {
        Scale::Common => measures.scale,
        Scale::Each => (measures.cell[0] / size[0]).min(measures.cell[1] / size[1]),
    };
    size.map(|side| side * scale)
}

/// Frames as hairlines.
pub(super) fn frames(areas: &[Rect]) -> Layer {
    let mut layer = Layer::new(Vec::new(), "frames".to_owned(), FAINT);
    let mut strokes = Strokes::new(Length::mm(FRAME), Cap::Butt);
    for area in areas {
        // Pictures lie within their frames, and cover nothing of them.
        let corners = area.grown(FRAME / 2.0).corners();
        strokes.polylines.push(corners.into_iter().chain(corners.first().copied()).collect());
    }
    layer.strokes.push(strokes);
    layer
}
