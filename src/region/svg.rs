//! SVG files: bytes come in; the outlines of what is filled go out, the marks as they are drawn ([`ink`]), or the lines
//! that a flood runs up against (`lines`).
//!
//! All stand where the file shows them: after transforms, units, `use` and clip paths, by each path's fill rule. Text,
//! images, masks and filters play no part, and what is hidden is left out. Nothing but the bytes is read: no pictures,
//! fonts or files that they name. The parser works in `f32`, whose last bits differ between machines, so points are
//! snapped to 1/1024 mm.

mod document;
pub mod ink;
mod lines;
mod read;
#[cfg(test)]
mod tests;

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::ops::Range;

use super::curve::{Draw, Pen};
use super::{FillRule, Operation, Region, Subpath, Tangled, contained, overlay};
use crate::geom::{Length, Point, Rect};

/// Points lie on multiples of this many millimetres.
const SNAP: f64 = 1.0 / 1024.0;

/// Pixels in an inch, by definition of CSS.
const PIXELS_PER_INCH: f64 = 96.0;

/// The stack for reading a file: deep `use` chains are read by functions that call themselves.
const STACK: usize = 64 << 20;

/// A file that has been read.
#[derive(Debug, Clone)]
pub struct SvgFile {
    /// The page's size in pixels.
    size: [f64; 2],
    /// What is filled and stroked, in the order of drawing.
    marks: Vec<Mark>,
    clips: Vec<Clip>,
    /// What of the whole file is not read at all.
    unread: BTreeSet<Lack>,
    /// Runs of `marks` under each element that has the name.
    ids: BTreeMap<String, Vec<Range<usize>>>,
    layers: BTreeMap<String, Vec<Range<usize>>>,
    classes: BTreeMap<String, Vec<Range<usize>>>,
}

/// Something filled or stroked.
#[derive(Debug, Clone)]
struct Mark {
    /// In pixels of the page.
    steps: Vec<Step>,
    kind: MarkKind,
    /// Of gradients the mean; patterns have none.
    colour: Option<Rgba>,
    /// The clip path it is seen through.
    clip: Option<usize>,
    /// What of its look cannot be drawn.
    lacks: BTreeSet<Lack>,
}

/// How a path is drawn.
#[derive(Debug, Clone, Copy)]
enum MarkKind {
    Fill(FillRule),
    Stroke {
        /// In pixels of the page.
        width: f64,
        ends: Ends,
    },
}

/// Red, green, blue and alpha in sRGB, the alpha straight.
pub type Rgba = [u8; 4];

/// How strokes end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ends {
    /// At their last point.
    Butt,
    /// With half a disc beyond it.
    Round,
    /// With half a square beyond it.
    Square,
}

/// Something of a file's look that is drawn otherwise than the file says, or not at all.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Lack {
    /// Drawn in its mean colour.
    Gradient,
    /// Left out.
    Pattern,
    /// Ignored.
    Mask,
    /// Ignored.
    Filter,
    /// Drawn as if there were none.
    Blend,
    /// Left out.
    Picture,
    /// Left out.
    Text,
}

/// A clip path in one of the places where it is used.
#[derive(Debug, Clone)]
struct Clip {
    shapes: Vec<Mark>,
    /// Another one, which what is seen through this one is seen through too. It stands earlier in the list.
    outer: Option<usize>,
}

/// A piece of an outline.
#[derive(Debug, Clone, Copy)]
enum Step {
    Move(Point),
    Line(Point),
    Quadratic(Point, Point),
    Cubic(Point, Point, Point),
    Close,
}

/// Which part of a file is meant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Selection<'a> {
    /// All of it.
    Whole,
    /// The element with this id, and what it holds.
    Id(&'a str),
    /// The layers of Inkscape with this label.
    Layer(&'a str),
    /// All elements of this class.
    Class(&'a str),
    /// What is filled or stroked with this colour, whatever its alpha.
    Colour([u8; 3]),
}

/// Why a file gives no region.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum SvgError {
    /// It is no SVG file, or a damaged one; in the reader's words, with line and column.
    Unreadable(String),
    /// It is compressed.
    Compressed,
    /// Elements are nested too deeply.
    TooDeep {
        /// How deep they may be.
        most: usize,
    },
    /// It has more elements than are read.
    TooLarge,
    /// Its page has no size.
    NoSize,
    /// No element has the id.
    NoSuchId {
        /// The id that was asked for.
        id: String,
        /// The ids that there are, in order.
        known: Vec<String>,
    },
    /// No layer has the label.
    NoSuchLayer {
        /// The label that was asked for.
        layer: String,
        /// The labels that there are, in order.
        known: Vec<String>,
    },
    /// No element has the class.
    NoSuchClass {
        /// The class that was asked for.
        class: String,
        /// The classes that there are, in order.
        known: Vec<String>,
    },
    /// Nothing has the colour.
    NoSuchColour {
        /// The colour that was asked for.
        colour: [u8; 3],
        /// The colours that there are, in order.
        known: Vec<[u8; 3]>,
    },
    /// The outlines cross too often.
    TooTangled,
    /// What was asked for is there, but nothing in it is filled.
    NotFilled,
    /// What was asked for is there, but nothing in it is drawn.
    NotDrawn,
    /// What was asked for is there, but it has neither strokes nor dark fills.
    NoLines,
}

impl fmt::Display for SvgError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unreadable(why) => write!(f, "the SVG file cannot be read: {why}"),
            Self::Compressed => f.write_str("the SVG file is compressed; save it as plain SVG"),
            Self::TooDeep { most } => write!(f, "the SVG file nests elements more than {most} deep"),
            Self::TooLarge => f.write_str("the SVG file has too many elements, or its `use` elements repeat too much"),
            Self::NoSize => f.write_str("the page of the SVG file has no size"),
            Self::TooTangled => f.write_str("the outlines in the SVG file cross more than a million times"),
            Self::NoSuchId { id, .. } => write!(f, "no element of the SVG file has the id `{id}`"),
            Self::NoSuchLayer { layer, .. } => write!(f, "no layer of the SVG file is called `{layer}`"),
            Self::NoSuchClass { class, .. } => write!(f, "no element of the SVG file has the class `{class}`"),
            Self::NoSuchColour { colour, .. } => {
                write!(f, "nothing in the SVG file has the colour `{}`", hex(*colour))
            }
            Self::NotDrawn => f.write_str("nothing is drawn here: it has neither fills nor strokes"),
            Self::NoLines => f.write_str("there are no lines here: it has neither strokes nor dark fills"),
            Self::NotFilled => f.write_str("nothing is filled here: outlines are those of filled paths"),
        }
    }
}

impl std::error::Error for SvgError {}

/// A colour as it is written in a scene.
#[must_use]
pub fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

impl From<Tangled> for SvgError {
    fn from(_: Tangled) -> Self {
        Self::TooTangled
    }
}

/// Reads an SVG file.
///
/// # Errors
/// Where the bytes are no SVG file, or one whose elements are too many or nested too deeply.
pub fn outlines(bytes: &[u8]) -> Result<SvgFile, SvgError> {
    if bytes.starts_with(&[0x1f, 0x8b]) {
        return Err(SvgError::Compressed);
    }
    let text = std::str::from_utf8(bytes).map_err(|_| SvgError::Unreadable("it is not written in UTF-8".into()))?;
    // A thread of its own, for its stack.
    std::thread::scope(|scope| {
        let reading = std::thread::Builder::new().stack_size(STACK).spawn_scoped(scope, || read::read(text));
        let reading = reading.map_err(|error| SvgError::Unreadable(error.to_string()))?;
        reading.join().unwrap_or_else(|_| Err(SvgError::Unreadable("the reader gave up on it".into())))
    })
}

impl SvgFile {
    /// The outlines of a part of the file. Without a box to fit, the page keeps its size and its top left corner lies at
    /// the origin; with one the whole page, whatever was selected, is made as large as the box allows and lies in its
    /// middle, so that several parts of one file stay in register.
    ///
    /// # Errors
    /// Where there is no such part, nothing in it is filled, or outlines cross too often.
    pub fn region(&self, selection: Selection<'_>, fit: Option<Rect>) -> Result<Region, SvgError> {
        let place = self.place(fit);
        let marks = self.selected(selection)?.into_iter().filter_map(|i| self.marks.get(i));
        let region = self.union(marks, &place)?;
        if region.is_empty() { Err(SvgError::NotFilled) } else { Ok(region) }
    }

    /// Where the page lies.
    fn place(&self, fit: Option<Rect>) -> Placement {
        let to_mm = Length::MM_PER_INCH / PIXELS_PER_INCH;
        let page = Rect::new(Point::new(0.0, 0.0), Point::new(self.size[0] * to_mm, self.size[1] * to_mm));
        let page = fit.map_or(page, |fit| contained(self.size[0], self.size[1], fit));
        Placement { page, scale: page.width() / self.size[0] }
    }

    /// What those of the marks that are fills hold, as far as their clip paths show it.
    fn union<'a>(&'a self, marks: impl Iterator<Item = &'a Mark>, place: &Placement) -> Result<Region, Tangled> {
        let mut rings: BTreeMap<Option<usize>, Vec<Vec<Point>>> = BTreeMap::new();
        for mark in marks {
            // Each by its own rule; of what comes out, outlines run one way and holes the other, so that all of them
            // together are their union.
            rings.entry(mark.clip).or_default().extend(mark.rings(place)?);
        }
        let mut clips = BTreeMap::new();
        let mut seen = Vec::new();
        for (clip, rings) in rings {
            let region = Region::try_from_rings(rings, FillRule::NonZero)?;
            seen.push(match clip {
                Some(clip) => region.try_combined(&self.clip(clip, place, &mut clips)?, Operation::Intersection)?,
                None => region,
            });
        }
        match seen.as_slice() {
            [region] => Ok(region.clone()),
            regions => {
                let rings = regions.iter().flat_map(Region::polygons).flat_map(|polygon| polygon.rings().cloned());
                Region::try_from_rings(rings.collect(), FillRule::NonZero)
            }
        }
    }

    /// The numbers of the marks, in order and each once.
    fn selected(&self, selection: Selection<'_>) -> Result<BTreeSet<usize>, SvgError> {
        let known = |names: &BTreeMap<String, Vec<Range<usize>>>| names.keys().cloned().collect();
        let ranges = match selection {
            Selection::Whole => return Ok((0..self.marks.len()).collect()),
            Selection::Id(id) => {
                self.ids.get(id).ok_or_else(|| SvgError::NoSuchId { id: id.into(), known: known(&self.ids) })?
            }
            Selection::Layer(layer) => self
                .layers
                .get(layer)
                .ok_or_else(|| SvgError::NoSuchLayer { layer: layer.into(), known: known(&self.layers) })?,
            Selection::Class(class) => self
                .classes
                .get(class)
                .ok_or_else(|| SvgError::NoSuchClass { class: class.into(), known: known(&self.classes) })?,
            Selection::Colour(colour) => return self.coloured(colour),
        };
        // An element may lie within another of the same class.
        Ok(ranges.iter().cloned().flatten().collect())
    }

    /// The numbers of the marks of a colour, in order.
    fn coloured(&self, colour: [u8; 3]) -> Result<BTreeSet<usize>, SvgError> {
        let own = |mark: &Mark| mark.colour.map(|[r, g, b, _]| [r, g, b]);
        let found: BTreeSet<usize> =
            self.marks.iter().enumerate().filter(|(_, mark)| own(mark) == Some(colour)).map(|(i, _)| i).collect();
        if found.is_empty() {
            let known: BTreeSet<[u8; 3]> = self.marks.iter().filter_map(own).collect();
            return Err(SvgError::NoSuchColour { colour, known: known.into_iter().collect() });
        }
        Ok(found)
    }

    /// The area of a clip path and all those outside it. The ones found are kept in `found`.
    fn clip(&self, clip: usize, place: &Placement, found: &mut BTreeMap<usize, Region>) -> Result<Region, Tangled> {
        // From this one outwards as far as is not known yet, and then back.
        let mut chain = Vec::new();
        let mut next = Some(clip);
        while let Some(at) = next.filter(|at| !found.contains_key(at)) {
            chain.push(at);
            next = self.clips.get(at).and_then(|clip| clip.outer);
        }
        let mut outer = next.and_then(|at| found.get(&at).cloned());
        while let Some(at) = chain.pop() {
            let shapes = self.clips.get(at).map_or(&[][..], |clip| &clip.shapes);
            let mut rings = Vec::new();
            for shape in shapes {
                rings.extend(shape.rings(place)?);
            }
            let own = Region::try_from_rings(rings, FillRule::NonZero)?;
            let region = match outer {
                Some(outer) => own.try_combined(&outer, Operation::Intersection)?,
                None => own,
            };
            found.insert(at, region.clone());
            outer = Some(region);
        }
        Ok(outer.unwrap_or_else(Region::empty))
    }
}

/// Where the page of a file lies.
struct Placement {
    page: Rect,
    /// Millimetres for a pixel.
    scale: f64,
}

impl Placement {
    fn point(&self, p: Point) -> Point {
        self.page.min + (p - Point::new(0.0, 0.0)) * self.scale
    }
}

/// On the grid of points that are read.
fn snapped(p: Point) -> Point {
    let snap = |v: f64| (v / SNAP).round() * SNAP;
    Point::new(snap(p.x), snap(p.y))
}

impl Mark {
    /// Its area on the page as rings that do not cross; none if it is a stroke.
    fn rings(&self, place: &Placement) -> Result<Vec<Vec<Point>>, Tangled> {
        let MarkKind::Fill(rule) = self.kind else { return Ok(Vec::new()) };
        let rings: Vec<Vec<Point>> = self.flattened(place).into_iter().map(|subpath| subpath.points).collect();
        overlay::check(&rings)?;
        Ok(overlay::resolve(&rings, rule)
            .into_iter()
            .flat_map(|polygon| std::iter::once(polygon.outer).chain(polygon.holes))
            .collect())
    }

    /// Its path on the page as straight pieces.
    fn flattened(&self, place: &Placement) -> Vec<Subpath> {
        let at = |p: Point| place.point(p);
        let mut pen = Pen::default();
        for step in &self.steps {
            match *step {
                Step::Move(p) => pen.move_to(at(p)),
                Step::Line(p) => pen.line_to(at(p)),
                Step::Quadratic(b, c) => pen.quadratic_to(at(b), at(c)),
                Step::Cubic(b, c, d) => pen.cubic_to(at(b), at(c), at(d)),
                Step::Close => pen.close(),
            }
        }
        let mut subpaths = pen.finish();
        for subpath in &mut subpaths {
            subpath.points.iter_mut().for_each(|p| *p = snapped(*p));
        }
        subpaths
    }
}
