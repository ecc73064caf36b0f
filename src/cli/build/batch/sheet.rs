//! The contact sheet of a batch: what varies decides rows and columns, and pictures are put on it as they are made.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use crate::back::contact::Contact;
use crate::back::png::PngError;
use crate::back::{pdf, svg};
use crate::cli::Ended;
use crate::cli::build::output::cannot_write;
use crate::cli::build::vary::{Cell, Vary, label};
use crate::cli::build::{Kind, kind_of};
use crate::cli::files::{Pending, write_beside};
use crate::diag::grouped;
use crate::drawing::{Drawing, Layer};
use crate::geom::Length;
use crate::sheet::{Grid, Holds, Place, Row, Scale, Sheet, Slot};

use super::{Batch, Expected, lock};

/// All pictures of a row together are about so wide, in millimetres, but none is smaller or larger than these.
const WIDTH: f64 = 360.0;
const SIDES: [f64; 2] = [24.0, 90.0];

/// So many values of one parameter stand in one row; more of them are laid out as a square.
const IN_A_ROW: usize = 5;

/// What a place says whose picture could not be made.
const NO_PICTURE: &str = "no picture";

/// A sheet while pictures are put on it.
pub(super) struct Sheeted {
    file: PathBuf,
    sheet: Sheet,
    held: Held,
    /// The most marks that are held.
    most: u64,
}

/// What is kept of the pictures.
enum Held {
    /// What they look like.
    Pixels(Mutex<(Contact, usize)>),
    /// Themselves, with how many marks they have together.
    Drawings(Mutex<(Vec<Option<Drawing>>, u64)>, Write),
}

/// Writes a sheet with its pictures.
type Write = fn(&Sheet, &[Option<Drawing>], &mut dyn io::Write) -> io::Result<()>;

impl Sheeted {
    /// Lays out the sheet of a batch.
    pub(super) fn new(batch: &Batch<'_>, file: &Path, expected: &[Expected]) -> Result<Self, String> {
        let limits = batch.arguments.scene.limits();
        let sheet = Sheet::new(&grid(batch, expected));
        let drawings = |write: Write| Held::Drawings(Mutex::new((vec![None; sheet.places.len()], 0)), write);
        let held = match kind_of(file)? {
            Kind::Svg => drawings(svg::write_sheet),
            Kind::Pdf => drawings(pdf::write_sheet),
            // Of a kind that is no sheet there is none: the command line was refused.
            Kind::Png | Kind::Json => {
                let [width, height] = sheet.page.pixels.map(u64::from);
                let pixels = width.saturating_mul(height);
                if pixels > limits.megapixels.saturating_mul(1_000_000) {
                    let needed = pixels.div_ceil(1_000_000);
                    return Err(format!(
                        "the sheet would have {width} x {height} pixels; fewer pictures make it smaller, and `--limit \
                         megapixels={needed}` lifts the limit"
                    ));
                }
                // Pictures cover what stands in their places.
                let mut empty = sheet.clone();
                empty.texts.extend(sheet.places.iter().map(|place| place.says(NO_PICTURE)));
                Held::Pixels(Mutex::new((Contact::new(&empty), 0)))
            }
        };
        Ok(Self { file: file.to_owned(), sheet, held, most: limits.strokes })
    }

    /// Puts the picture of a cell in its place.
    pub(super) fn put(&self, cell: usize, drawing: Drawing) {
        let Some(index) = self.sheet.places.iter().position(|place| place.slot == cell) else { return };
        let place: &Place = &self.sheet.places[index];
        match &self.held {
            Held::Pixels(held) => {
                let picture = Contact::draw(&self.sheet, place, drawing);
                let mut held = lock(held);
                held.0.put(place, &picture);
                held.1 += 1;
            }
            Held::Drawings(held, _) => {
                let mut held = lock(held);
                held.1 = held.1.saturating_add(drawing.layers.iter().map(Layer::marks).sum());
                // Beyond the limit nothing is written, so that nothing need be kept.
                held.0[index] = (held.1 <= self.most).then_some(drawing);
            }
        }
    }

    /// Writes the sheet, unless there is no picture at all.
    pub(super) fn write(self) -> Ended {
        let Self { file, mut sheet, held, most } = self;
        let written = match held {
            Held::Pixels(held) => {
                let (contact, pictures) = held.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
                if pictures == 0 {
                    return Ended::Done;
                }
                write_beside(&file, |out| {
                    contact.write(out).map_err(|error| match error {
                        PngError::Io(error) => error,
                        PngError::Format(words) => io::Error::other(words),
                    })
                })
            }
            Held::Drawings(held, write) => {
                let (pictures, marks) = held.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
                if marks > most {
                    let (file, marks, most) = (file.display(), grouped(marks), grouped(most));
                    eprintln!("kake: {file} would hold {marks} strokes and dots; the limit is {most}");
                    eprintln!("kake: a sheet in .png takes any number; `--limit strokes=N` lifts the limit");
                    return Ended::Fault;
                }
                if pictures.iter().all(Option::is_none) {
                    return Ended::Done;
                }
                let mut missing = Vec::new();
                for (place, _) in sheet.places.iter().zip(&pictures).filter(|(_, picture)| picture.is_none()) {
                    missing.push(place.says(NO_PICTURE));
                }
                sheet.texts.extend(missing);
                write_beside(&file, |out| write(&sheet, &pictures, out))
            }
        };
        match written.and_then(Pending::keep) {
            Ok(()) => Ended::Done,
            Err(error) => cannot_write(&file, &error),
        }
    }
}

/// Rows and columns of a batch: of two things that vary the last runs across and the other down; of more, the last runs
/// across. One alone fills a square.
fn grid(batch: &Batch<'_>, expected: &[Expected]) -> Grid {
    let varying: Vec<&Vary> = batch.axes.iter().filter(|axis| axis.values.len() > 1).collect();
    let is_matrix = varying.len() > 1;
    let count = batch.cells.len();
    let columns = match varying.as_slice() {
        [] => 1,
        [one] if batch.arguments.seeds.is_none() && one.values.len() <= IN_A_ROW => count,
        [_] => (1..=count).find(|side| side * side >= count).unwrap_or(1),
        [.., last] => last.values.len(),
    };
    let slot = |(i, cell): (usize, &Cell)| {
        let caption = cell.values.iter().filter(|(name, _)| varying.iter().any(|axis| axis.name == *name));
        Slot {
            name: cell.name(),
            // In a matrix rows and columns say what varies.
            caption: caption.filter(|_| !is_matrix).map(|(name, value)| label(name, value)).collect(),
            holds: match &expected[i] {
                Expected::Page(size, _) => Holds::Picture(*size),
                Expected::Unknown => Holds::Words(NO_PICTURE.to_owned()),
            },
        }
    };
    let slots: Vec<Slot> = batch.cells.iter().enumerate().map(slot).collect();
    let rows = slots.chunks(columns.max(1)).enumerate().map(|(i, slots)| {
        let first = &batch.cells[i * columns];
        let across = varying.last().map(|axis| axis.name.as_str());
        let down = first.values.iter().filter(|(name, _)| {
            is_matrix && Some(name.as_str()) != across && varying.iter().any(|axis| axis.name == *name)
        });
        Row { heading: None, label: down.map(|(name, value)| label(name, value)).collect(), slots: slots.to_vec() }
    });
    let heads = varying.last().filter(|_| is_matrix);
    let side = (WIDTH / columns as f64).clamp(SIDES[0], SIDES[1]);
    Grid {
        title: batch.arguments.scene.scene.file_name().unwrap_or_default().to_string_lossy().into_owned(),
        subtitle: subtitle(batch),
        heads: heads.iter().flat_map(|axis| axis.values.iter().map(|value| label(&axis.name, value))).collect(),
        rows: rows.collect(),
        scale: Scale::Common,
        side: Length::mm(side),
    }
}

/// What the command line gives all pictures alike.
fn subtitle(batch: &Batch<'_>) -> Vec<String> {
    let single = batch.axes.iter().filter(|axis| axis.values.len() == 1);
    let single = single.flat_map(|axis| axis.values.iter().map(|value| label(&axis.name, value)));
    let set = batch.arguments.scene.set.iter().map(|(name, value)| label(name, value));
    let seed = batch.arguments.seed.map(|seed| format!("seed {seed}"));
    let only = batch.arguments.only.as_ref().map(|only| format!("only {only}"));
    let all: Vec<String> = single.chain(set).chain(seed).chain(only).collect();
    if all.is_empty() { Vec::new() } else { vec![all.join(", ")] }
}
