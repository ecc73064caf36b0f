//! Placements: how the sites of tiles are found.

use serde::Serialize;

use crate::field::Field;
use crate::geom::{Length, Point};

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
