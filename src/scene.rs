//! The scene: what lowering makes of a document, and all that later passes know.
//!
//! Everything here is resolved and valid: lengths are millimetres, names are gone, regions are polygons, fields can be
//! evaluated, and every number lies in its range. Spans are kept only to say where a limit was met. A new placement,
//! shape, angle rule or fill is one more line in its enum and one file in its pass.

mod angle;
mod fill;
mod hand;
mod place;

pub use angle::{AngleRule, Bfs, See, Start, Tuned};
pub use fill::{Cap, Fill, FillKind, Hatch, MotifPath, Swing};
pub use hand::Hand;
pub use place::{Amount, GridSize, IRREGULAR_OVERLAP, POINTED_OVERLAP, Placement};

use serde::{Serialize, Serializer};

use crate::field::Field;
use crate::geom::{Angle, Length, Period, Point, Rect};
use crate::region::Region;
use crate::span::Span;
use crate::stop::Stop;

/// A whole scene.
#[derive(Debug, Clone, Serialize)]
pub struct Scene {
    /// The page.
    pub canvas: Canvas,
    /// The scene's seed.
    pub seed: u64,
    /// The parameters that can be set, with the values they have.
    pub params: Vec<Param>,
    /// What is drawn, from the bottom up.
    pub draws: Vec<Draw>,
    /// The experiments that are declared.
    pub experiments: Vec<Experiment>,
}

/// The page.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Canvas {
    /// Greater than zero.
    pub width: Length,
    /// Greater than zero.
    pub height: Length,
    /// How far the picture goes on beyond the page on every side, to be trimmed off; not negative.
    #[serde(skip_serializing_if = "is_zero")]
    pub bleed: Length,
    /// Width and height of a PNG, which shows the trimmed page.
    pub pixels: [u32; 2],
    /// Pixels per inch, greater than zero.
    pub dpi: f64,
    /// The paper's colour; none is transparent.
    pub paper: Option<Colour>,
    /// What strokes are drawn with where neither fill nor layer says otherwise.
    pub ink: Colour,
    /// Bits of a PNG's grey.
    pub depth: Depth,
    /// The length of one canvas unit.
    pub unit: Length,
    /// Whether it goes on beyond its borders.
    #[serde(skip_serializing_if = "Repeat::is_off")]
    pub repeat: Repeat,
    /// How far ink spreads beyond each edge of a mark; not negative. Darkness reckons with it, drawn widths do not change.
    #[serde(skip_serializing_if = "is_zero")]
    pub gain: Length,
}

impl Canvas {
    /// After which width and height it repeats, if it does.
    #[must_use]
    pub fn period(&self) -> Option<Period> {
        match self.repeat {
            Repeat::Off => None,
            Repeat::Both => Some(Period::new(self.width, self.height)),
        }
    }

    /// The area that is drawn on: the page and its bleed. The page itself has its corner at the origin.
    #[must_use]
    pub fn bounds(&self) -> Rect {
        Rect::new(Point::default(), Point::new(self.width.to_mm(), self.height.to_mm())).grown(self.bleed.to_mm())
    }
}

fn is_zero(length: &Length) -> bool {
    *length == Length::ZERO
}

/// Whether a canvas goes on beyond its borders.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Repeat {
    /// It ends there.
    #[default]
    Off,
    /// The left border continues on the right and the upper one below: the page is a torus.
    Both,
}

impl Repeat {
    /// Whether it ends at its borders.
    #[must_use]
    pub fn is_off(&self) -> bool {
        *self == Self::Off
    }
}

/// How many greys a PNG has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Depth {
    /// Ink or paper, decided at half coverage.
    One,
    /// 256 levels.
    Eight,
}

/// A colour in sRGB with straight alpha.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Colour {
    /// Red.
    pub r: u8,
    /// Green.
    pub g: u8,
    /// Blue.
    pub b: u8,
    /// 255 is opaque.
    pub a: u8,
}

impl Colour {
    /// Opaque black.
    pub const BLACK: Self = Self { r: 0, g: 0, b: 0, a: 255 };
    /// Opaque white.
    pub const WHITE: Self = Self { r: 255, g: 255, b: 255, a: 255 };

    /// `#rrggbb`, the alpha left out.
    #[must_use]
    pub fn hex(self) -> String {
        format!("#{:02x}{:02x}{:02x}", self.r, self.g, self.b)
    }

    /// Whether it is a grey.
    #[must_use]
    pub fn is_grey(self) -> bool {
        self.r == self.g && self.g == self.b
    }
}

impl Serialize for Colour {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if self.a == 255 {
            serializer.serialize_str(&self.hex())
        } else {
            serializer.serialize_str(&format!("{}{:02x}", self.hex(), self.a))
        }
    }
}

/// A parameter that `--set` can set.
#[derive(Debug, Clone, Serialize)]
pub struct Param {
    /// Its name; `module.name` where the import has a name.
    pub name: String,
    /// Its doc comment.
    pub doc: Option<String>,
    /// Its type's name.
    #[serde(rename = "type")]
    pub ty: String,
    /// What it may be.
    pub domain: Option<ParamDomain>,
    /// The value it is declared with.
    pub default: ParamValue,
    /// The value it has.
    pub value: ParamValue,
}

/// A value as it is written in a scene, with the number behind it where there is one.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ParamValue {
    /// As an expression of the language.
    pub text: String,
    /// The number: millimetres, radians, shares of one, plain.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub number: Option<f64>,
    /// The characters of a string.
    #[serde(skip)]
    pub string: Option<String>,
}

/// What a parameter may be.
#[derive(Debug, Clone, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ParamDomain {
    /// From one value to another, both included.
    Range(ParamValue, ParamValue),
    /// One of these.
    Choices(Vec<ParamValue>),
}

/// An experiment: which parameters it varies over which seeds.
#[derive(Debug, Clone, Serialize)]
pub struct Experiment {
    /// Its name.
    pub name: String,
    /// First and last seed.
    pub seeds: [u64; 2],
    /// Parameters with their levels.
    pub factors: Vec<Factor>,
    /// Conditions outside the design: a value for each of some parameters.
    pub reference: Vec<Vec<(String, ParamValue)>>,
    /// Parameters with the values to make pictures of.
    pub images: Vec<Factor>,
    /// Where it is declared.
    #[serde(skip)]
    pub span: Span,
}

/// A parameter with several values.
#[derive(Debug, Clone, Serialize)]
pub struct Factor {
    /// The parameter's name.
    pub param: String,
    /// Its values.
    pub levels: Vec<ParamValue>,
}

/// Something that is drawn.
#[derive(Debug, Clone, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Draw {
    /// A region filled with a tone.
    Paint(Box<Paint>),
    /// A region's outline.
    Outline(Outline),
    /// Strokes and fills of a file.
    Ink(Ink),
    /// Some of these under one name.
    Layer(LayerGroup),
}

/// A named group.
#[derive(Debug, Clone, Serialize)]
pub struct LayerGroup {
    /// Its name.
    pub name: String,
    /// The ink of what it holds.
    pub ink: Option<Colour>,
    /// What it holds, from the bottom up.
    pub draws: Vec<Draw>,
}

/// A region's outline as a stroke.
#[derive(Debug, Clone, Serialize)]
pub struct Outline {
    /// Whose outline.
    pub region: Region,
    /// The stroke's width, greater than zero. The stroke is centred on the outline.
    pub pen: Length,
    /// Where the statement stands.
    #[serde(skip)]
    pub span: Span,
}

/// Strokes and fills of a file, in their own colours.
#[derive(Debug, Clone, Serialize)]
pub struct Ink {
    /// From the bottom up.
    pub marks: Vec<InkMark>,
    /// Where the statement stands.
    #[serde(skip)]
    pub span: Span,
}

/// A fill or stroke of a file.
#[derive(Debug, Clone, Serialize)]
pub struct InkMark {
    /// Its colour.
    pub colour: Colour,
    /// What has it.
    pub shape: InkShape,
}

/// What a mark of a file covers.
#[derive(Debug, Clone, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum InkShape {
    /// An area.
    Area(Region),
    /// Lines of one width.
    Strokes {
        /// Greater than zero.
        pen: Length,
        /// How they end.
        cap: Cap,
        /// Chains of cubic Béziers, of 3n + 1 points each; one that ends at its first point is closed.
        chains: Vec<Vec<Point>>,
    },
}

/// A region filled with a tone.
#[derive(Debug, Clone, Serialize)]
pub struct Paint {
    /// Unique in the scene; part of the key of every random draw.
    pub name: String,
    /// What the tone is called.
    pub tone_name: String,
    /// The scene's seed or its own.
    pub seed: u64,
    /// What is filled.
    pub region: Region,
    /// With what.
    pub tone: Tone,
    /// Where the statement stands.
    #[serde(skip)]
    pub span: Span,
}

/// A tone with every property decided.
#[derive(Debug, Clone, Serialize)]
pub struct Tone {
    /// Where the tiles lie.
    pub place: Placement,
    /// Where `place` stands, for limits.
    #[serde(skip)]
    pub place_span: Span,
    /// Over what area sites are found.
    pub domain: Domain,
    /// How far beyond the domain sites are placed; not negative. By default one spacing, none where tiles are counted.
    pub bleed: Option<Length>,
    /// What the tiles look like.
    pub shape: Shape,
    /// Which tiles are neighbours.
    pub link: Link,
    /// How the tiles are turned.
    pub angle: AngleRule,
    /// Where `angle` stands, for warnings.
    #[serde(skip)]
    pub angle_span: Span,
    /// What is drawn in them: an item a layer, the last for all further ones; never empty.
    pub fill: Vec<Fill>,
    /// How much is drawn.
    #[serde(flatten)]
    pub asked: Asked,
    /// Where `k` or `darkness` stands, for warnings.
    #[serde(skip)]
    pub asked_span: Span,
    /// What a fraction of k means.
    pub blend: Blend,
    /// What overlapping tiles of this paint do.
    pub stack: Stack,
    /// What the paint does to earlier ones.
    pub over: Over,
    /// What is drawn where no tile is.
    pub ground: Option<Ground>,
    /// What happens at the region's outline.
    pub edge: Edge,
    /// How unevenly strokes are drawn.
    #[serde(skip_serializing_if = "Hand::is_ruled")]
    pub hand: Hand,
    /// Where `hand` stands, for warnings.
    #[serde(skip)]
    pub hand_span: Span,
}

/// How much is drawn in the tiles.
#[derive(Debug, Clone, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Asked {
    /// So many layers a tile, 0 to 4.
    K(Field),
    /// A share of the paper, from which layers and spacing follow.
    Darkness(Darkness),
}

impl Asked {
    /// What is asked for at a place: layers or a share of the paper.
    #[must_use]
    pub fn field(&self) -> &Field {
        match self {
            Self::K(field) | Self::Darkness(Darkness { field, .. }) => field,
        }
    }
}

/// The share of the paper that a tone is to cover with ink.
#[derive(Debug, Clone, Serialize)]
pub struct Darkness {
    /// The share, 0 to 1.
    pub field: Field,
    /// What becomes of what the tone cannot print.
    pub range: Range,
    /// Tiles that ask for at least so much are inked all over; above 0, at most 1.
    pub solid: Option<f64>,
}

/// How the darkness that is asked for is brought into what a tone can print.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Range {
    /// What is too dark is printed as dark as can be.
    Clip,
    /// The range that the field has in the region is stretched or pressed into that of the tone.
    Fit,
}

/// Over what area sites are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Domain {
    /// The whole canvas; the region then selects.
    Canvas,
    /// The region's bounding box.
    Region,
}

/// What a tile looks like.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Shape {
    /// An oblong.
    Rect {
        /// Along the strokes of the first layer; the placement's spacing where it is not given.
        width: Option<Length>,
        /// Across them; the width where it is not given.
        height: Option<Length>,
        /// Scales both.
        overlap: Option<f64>,
        /// Does not turn with the tile's angle.
        upright: bool,
    },
    /// A regular hexagon; at angle 0 two of its sides are vertical.
    Hexagon {
        /// Across flats; the placement's spacing where it is not given.
        size: Option<Length>,
        /// Scales it.
        overlap: Option<f64>,
        /// Does not turn with the tile's angle.
        upright: bool,
    },
    /// An equilateral triangle round the site; at angle 0 it stands on a side.
    Triangle {
        /// The side; where it is not given, that of a triangle as large as a square of the placement's spacing.
        size: Option<Length>,
        /// Scales it.
        overlap: Option<f64>,
        /// Does not turn with the tile's angle.
        upright: bool,
    },
    /// A trapezoid round the site that narrows along the strokes of the first layer, alike on both sides.
    Trapezoid {
        /// By which share the narrow end is shorter than the wide one, from 0 to 1.
        taper: f64,
        /// The distance of both ends and their mean length, so that it is as large as a square of this side; the
        /// placement's spacing where it is not given.
        size: Option<Length>,
        /// Scales it.
        overlap: Option<f64>,
        /// Does not turn with the tile's angle.
        upright: bool,
    },
    /// Any outline.
    Stamp {
        /// Corners as seen from the site, clockwise on the page; their sides do not cross.
        outline: Vec<Point>,
        /// The longer side of the box round it, where it is not that of the corners.
        size: Option<Length>,
        /// Scales it.
        overlap: Option<f64>,
        /// Does not turn with the tile's angle.
        upright: bool,
    },
    /// The cell of the site in a tiling.
    Cell {
        /// How far the cell is drawn in, not negative.
        inset: Length,
    },
    /// The Voronoi cell of the site.
    Voronoi {
        /// How far the cell is drawn in, not negative.
        inset: Length,
        /// The radius of its corners, not negative.
        round: Length,
    },
}

impl Shape {
    /// Whether tiles are cells, which lie side by side, rather than stamps, which overlap.
    #[must_use]
    pub fn is_cell(&self) -> bool {
        match self {
            Self::Rect { .. }
            | Self::Hexagon { .. }
            | Self::Triangle { .. }
            | Self::Trapezoid { .. }
            | Self::Stamp { .. } => false,
            Self::Voronoi { .. } | Self::Cell { .. } => true,
        }
    }
}

/// Which tiles are neighbours.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Link {
    /// Those joined by the Delaunay triangulation of the sites.
    Delaunay,
    /// Cells of a tiling that share an edge, or a part of one.
    Edges,
}

/// What a fraction of k means.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Blend {
    /// The nearest whole number, halves up.
    Step,
    /// An even share of the next layer's lines.
    Partial,
    /// A whole number, the error passed on to later neighbours.
    Dither,
    /// Layer n ends where the field is n - 0.5.
    Contour,
}

/// What overlapping tiles of one paint do.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Stack {
    /// A later tile hides what lies under it.
    Cover,
    /// All are seen.
    Through,
}

/// What a paint does to earlier ones.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Over {
    /// Adds its ink.
    Print,
    /// Removes what lies under its tiles.
    Knockout,
}

/// What is drawn where no tile is.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Ground {
    /// A fill over all of it.
    Fill {
        /// What is drawn.
        fill: Fill,
        /// How it is turned.
        angle: Angle,
    },
    /// As the nearest tile would hatch it.
    Nearest,
}

/// What happens at a region's outline.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Edge {
    /// Strokes end there.
    Clip,
    /// Only tiles wholly inside are drawn.
    Whole,
    /// Tiles whose site is inside are drawn whole.
    Centre,
}

/// What keeps a scene from exhausting the machine.
#[derive(Debug, Clone)]
pub struct Limits {
    /// Tiles of a paint, those beyond the region included.
    pub tiles: u64,
    /// Pieces of stroke, dots and filled outlines of a drawing.
    pub strokes: u64,
    /// Rounds of loops and calls of functions.
    pub iterations: u64,
    /// Pixels of a picture, in millions, read or written.
    pub megapixels: u64,
    /// Depth of brackets, blocks and calls.
    pub nesting: u64,
    /// Runs of an experiment, and pictures of it.
    pub runs: u64,
    /// Where it is asked, passes end early and what they return is of no use; [`crate::compile`] drops it.
    pub stop: Stop,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            tiles: 2_000_000,
            strokes: 50_000_000,
            iterations: 1_000_000,
            megapixels: 400,
            nesting: 128,
            runs: 1_000_000,
            stop: Stop::default(),
        }
    }
}
