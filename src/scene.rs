//! The scene: what lowering makes of a document, and all that later passes know.
//!
//! Everything here is resolved and valid: lengths are millimetres, names are gone, regions are polygons, fields can be
//! evaluated, and every number lies in its range. Spans are kept only to say where a limit was met. A new placement,
//! shape, angle rule or fill is one more line in its enum and one file in its pass.

mod hand;

pub use hand::Hand;

use std::sync::Arc;

use serde::{Serialize, Serializer};

use crate::field::Field;
use crate::geom::bezier::cubics;
use crate::geom::course::{half_loop, half_wave};
use crate::geom::{Angle, Cubic, Length, Period, Point, Rect};
use crate::region::Region;
use crate::span::Span;

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

/// How sites are found.
#[derive(Debug, Clone, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Placement {
    /// Bridson's Poisson-disk sampling.
    Poisson {
        /// No two sites are closer; greater than zero.
        radius: Length,
        /// Candidates round a site before it is given up; at least 1.
        tries: u32,
        /// From 0 to 1: where it is d the radius is `radius / sqrt(d)`; below 1/64 no site is placed.
        density: Option<Field>,
    },
    /// Independent points.
    Uniform {
        /// How many.
        amount: Amount,
    },
    /// A square lattice, or one of equal oblong cells.
    Grid(GridSize),
    /// Rows of sites at `spacing`, each row moved by half of it.
    Hex {
        /// The distance of neighbours, greater than zero.
        spacing: Length,
    },
    /// Equilateral triangles.
    Triangles {
        /// The side, greater than zero.
        edge: Length,
    },
    /// Penrose's thick and thin rhombs.
    Penrose {
        /// The side of all rhombs, greater than zero.
        edge: Length,
    },
    /// The pinwheel tiling.
    Pinwheel {
        /// The short leg of a triangle, greater than zero; the long one is twice as long.
        edge: Length,
    },
    /// Sites that are given; bleed and domain do not move them.
    Points(Vec<Point>),
    /// Another placement whose sites have moved to the middles of their Voronoi cells.
    Relaxed {
        /// Where they come from.
        placement: Box<Placement>,
        /// How often they have moved, at most 1000 times.
        rounds: u32,
    },
}

impl Placement {
    /// Whether it has cells of its own.
    #[must_use]
    pub fn is_tiling(&self) -> bool {
        match self {
            Self::Grid(_)
            | Self::Hex { .. }
            | Self::Triangles { .. }
            | Self::Penrose { .. }
            | Self::Pinwheel { .. } => true,
            Self::Poisson { .. } | Self::Uniform { .. } | Self::Points(_) | Self::Relaxed { .. } => false,
        }
    }
}

/// How far stamps without a size are enlarged where sites lie irregularly: at 1.4 squares on Poisson-disk sites leave
/// 7 % of the paper open, at 1.6 under 2 %.
pub const IRREGULAR_OVERLAP: f64 = 1.6;

/// The same for stamps with sharp corners: triangles and trapezoids leave 3 % at 1.6, under 2 % at 1.7.
pub const POINTED_OVERLAP: f64 = 1.7;

impl Placement {
    /// Whether sites lie so evenly that stamps need not overlap.
    #[must_use]
    pub fn is_lattice(&self) -> bool {
        match self {
            Self::Poisson { .. }
            | Self::Uniform { .. }
            | Self::Penrose { .. }
            | Self::Pinwheel { .. }
            | Self::Points(_)
            | Self::Relaxed { .. } => false,
            Self::Grid(_) | Self::Hex { .. } | Self::Triangles { .. } => true,
        }
    }
}

/// How many uniform points there are.
#[derive(Debug, Clone, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Amount {
    /// So many in the domain, spread evenly or in proportion to a density.
    Count {
        /// At least 1.
        count: u32,
        /// A weight, not negative.
        density: Option<Field>,
    },
    /// As many in the domain as another placement finds there.
    AsMany(Box<Placement>),
    /// So many a square canvas unit.
    Density {
        /// Not negative; points a square canvas unit.
        density: Field,
        /// The canvas unit.
        unit: Length,
    },
}

/// The size of a grid.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum GridSize {
    /// The side of a cell, greater than zero.
    Spacing(Length),
    /// So many cells over the domain, at least one each way.
    Cells {
        /// Across.
        columns: u32,
        /// Down.
        rows: u32,
    },
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

/// How tiles are turned.
#[derive(Debug, Clone, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum AngleRule {
    /// Breadth first, each as far as can be from its placed neighbours.
    Bfs {
        /// Steps in half a turn, at least 2.
        candidates: u32,
    },
    /// Independently uniform.
    Random,
    /// 0 and a quarter turn by turns along the rows and columns of a grid.
    Checkerboard,
    /// All alike.
    Fixed(Angle),
    /// The value of a field of angles at the site.
    Along(Field),
}

/// What is drawn in a layer of a tile.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Fill {
    /// What is drawn.
    #[serde(flatten)]
    pub kind: FillKind,
    /// With which ink, where not that of the paint's layer or the canvas.
    pub ink: Option<Colour>,
}

/// The kinds of fill.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum FillKind {
    /// Parallel strokes.
    Lines(Hatch),
    /// Parallel strokes with gaps.
    Dashes {
        /// The strokes.
        hatch: Hatch,
        /// The length of a dash, greater than zero.
        dash: Length,
        /// The gap between two, greater than zero.
        gap: Length,
    },
    /// Dots along the hatch lines; the hatch's pen is not used.
    Dots {
        /// The lines.
        hatch: Hatch,
        /// From dot to dot along a line, greater than zero.
        spacing: Length,
        /// Greater than zero.
        radius: Length,
    },
    /// Crosses along the hatch lines, one arm along them and one across.
    Crosses {
        /// The lines.
        hatch: Hatch,
        /// From cross to cross along a line, greater than zero.
        spacing: Length,
        /// The length of an arm from end to end, greater than zero.
        size: Length,
    },
    /// Arcs about a place on the tile's edge, one pitch apart; every layer has its centre at another side.
    Arcs(Hatch),
    /// Strokes that swing evenly about the hatch lines.
    Waves {
        /// The lines.
        hatch: Hatch,
        /// How they swing.
        swing: Swing,
    },
    /// Loops along the hatch lines, as of a pen that is not lifted.
    Scribble {
        /// The lines.
        hatch: Hatch,
        /// The height of a loop, greater than zero.
        loops: Length,
        /// From loop to loop along a line, greater than zero.
        spacing: Length,
    },
    /// Sinuous strokes bundled in a trapezoid, a strand of rope.
    Nawaami {
        /// The strokes, their pitch measured in the middle of the strand.
        hatch: Hatch,
        /// How they swing. Half waves are stretched so that a whole number of them fills the strand.
        swing: Swing,
    },
    /// A figure along the hatch lines.
    Motif {
        /// The lines.
        hatch: Hatch,
        /// From figure to figure along a line, greater than zero.
        spacing: Length,
        /// The figure in millimetres about its middle, its x along the lines.
        figure: MotifPath,
    },
    /// The whole tile inked.
    Solid,
}

/// A sine wave about a line.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Swing {
    /// Greater than zero.
    pub wavelength: Length,
    /// How far it swings to either side, greater than zero.
    pub amplitude: Length,
}

impl Swing {
    /// How much longer than its line the wave is.
    #[must_use]
    pub fn stretch(&self) -> f64 {
        let half = self.wavelength / 2.0;
        half_wave(half, self.amplitude).length() / half
    }
}

/// Strokes of a motif: chains of cubic Béziers, each its first point and then two control points and an end for every
/// Bézier. One that ends at its first point is closed. Cheap to clone.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(transparent)]
pub struct MotifPath(pub Arc<[Vec<Point>]>);

impl MotifPath {
    /// How long all strokes are.
    #[must_use]
    pub fn length(&self) -> Length {
        let lengths = self.0.iter().flat_map(|chain| cubics(chain)).map(Cubic::length);
        lengths.fold(Length::ZERO, |sum, length| sum + length)
    }
}

impl FillKind {
    /// The hatch lines, where there are any.
    #[must_use]
    pub fn hatch(&self) -> Option<&Hatch> {
        match self {
            Self::Lines(hatch) | Self::Arcs(hatch) => Some(hatch),
            Self::Dashes { hatch, .. }
            | Self::Dots { hatch, .. }
            | Self::Crosses { hatch, .. }
            | Self::Waves { hatch, .. }
            | Self::Scribble { hatch, .. }
            | Self::Nawaami { hatch, .. }
            | Self::Motif { hatch, .. } => Some(hatch),
            Self::Solid => None,
        }
    }

    /// The ink of one layer on a large area: the length of its strokes times their width, or the dots' area, over the area
    /// they are spread on. Ink that lies on ink counts twice, so that dense fills exceed 1; what tiles' edges cut off or leave
    /// out is not reckoned.
    #[must_use]
    pub fn coverage(&self) -> f64 {
        let along = |hatch: &Hatch| hatch.pen / hatch.pitch;
        match self {
            Self::Lines(hatch) | Self::Arcs(hatch) => along(hatch),
            Self::Dashes { hatch, dash, gap } => along(hatch) * (*dash / (*dash + *gap)),
            Self::Dots { hatch, spacing, radius } => {
                std::f64::consts::PI * (*radius / hatch.pitch) * (*radius / *spacing)
            }
            Self::Crosses { hatch, spacing, size } => {
                // Where the arms cross there is ink only once.
                let arms = (*size * 2.0).to_mm() - hatch.pen.min(*size).to_mm();
                along(hatch) * arms / spacing.to_mm()
            }
            Self::Waves { hatch, swing } | Self::Nawaami { hatch, swing } => along(hatch) * swing.stretch(),
            Self::Scribble { hatch, loops, spacing } => {
                along(hatch) * (half_loop(*loops, *spacing).length() * 2.0 / *spacing)
            }
            Self::Motif { hatch, spacing, figure } => along(hatch) * (figure.length() / *spacing),
            Self::Solid => 1.0,
        }
    }
}

/// Parallel lines.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Hatch {
    /// From line to line, greater than zero.
    pub pitch: Length,
    /// The strokes' width, greater than zero.
    pub pen: Length,
    /// Where the outermost lines of a stamp lie, in steps from its edge; not negative.
    pub inset: f64,
    /// Pieces below it are dropped; not negative.
    pub shortest: Length,
    /// How strokes end.
    pub cap: Cap,
}

/// How strokes end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Cap {
    /// At their last point.
    Butt,
    /// With half a disc beyond it.
    Round,
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
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
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
}

impl Default for Limits {
    fn default() -> Self {
        Self { tiles: 2_000_000, strokes: 50_000_000, iterations: 1_000_000, megapixels: 400, nesting: 128 }
    }
}
