//! Fills: what is drawn in a layer of a tile.

use std::sync::Arc;

use serde::Serialize;

use super::Colour;
use crate::geom::bezier::cubics;
use crate::geom::course::{half_loop, half_wave};
use crate::geom::{Cubic, Length, Point};

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
    /// Whether the marks of all layers stand on one lattice, those of one between those of another, and none is turned.
    #[must_use]
    pub fn stands_on_one_lattice(&self) -> bool {
        match self {
            Self::Dots { .. } | Self::Crosses { .. } | Self::Motif { .. } => true,
            Self::Lines(_)
            | Self::Dashes { .. }
            | Self::Arcs(_)
            | Self::Waves { .. }
            | Self::Scribble { .. }
            | Self::Nawaami { .. }
            | Self::Solid => false,
        }
    }

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
