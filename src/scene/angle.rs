//! Angle rules: how the tiles of a tone are turned.

use serde::Serialize;

use crate::field::Field;
use crate::geom::Angle;

/// How tiles are turned.
#[derive(Debug, Clone, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum AngleRule {
    /// Breadth first, each as far as can be from its placed neighbours.
    Bfs(Bfs),
    /// Breadth first, and from there by local moves to what several wishes make of it together.
    Tuned(Tuned),
    /// So many directions, no two neighbours alike.
    Coloured {
        /// Directions, equal steps apart in half a turn: 2 to [`AngleRule::MOST_COLOURS`].
        colours: u32,
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

impl AngleRule {
    /// The most directions that neighbours can be coloured with. Seven are enough for every graph on a torus, so that more
    /// only bring directions closer together.
    pub const MOST_COLOURS: u32 = 12;
}

/// What turning breadth first takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Bfs {
    /// Steps in half a turn, at least 2.
    pub candidates: u32,
    /// Between which directions of two tiles a distance is taken.
    #[serde(skip_serializing_if = "See::is_primary")]
    pub see: See,
    /// How the first tile is turned.
    #[serde(skip_serializing_if = "Start::is_first")]
    pub start: Start,
}

impl Default for Bfs {
    fn default() -> Self {
        Self { candidates: 360, see: See::default(), start: Start::default() }
    }
}

/// What tuning takes. Weights are at least 0, and only their ratios matter but for how hot the moves begin.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Tuned {
    /// The weight of contrast between neighbours: of its mean, and of none lying below `least`.
    pub contrast: f64,
    /// The weight of directions that are used evenly.
    pub diversity: f64,
    /// The weight of angles not repeating themselves two and three links away.
    pub grain: f64,
    /// The contrast below which no two neighbours should lie, 0 to 1; more than a half cannot be had everywhere.
    pub least: f64,
    /// How often every tile is looked at.
    pub rounds: u32,
    /// Steps in half a turn, 2 to [`Tuned::MOST_CANDIDATES`].
    pub candidates: u32,
    /// Between which directions of two tiles a distance is taken.
    #[serde(skip_serializing_if = "See::is_primary")]
    pub see: See,
    /// How the first tile is turned before any is moved.
    #[serde(skip_serializing_if = "Start::is_first")]
    pub start: Start,
}

impl Tuned {
    /// The most steps in half a turn.
    pub const MOST_CANDIDATES: u32 = 3600;
}

impl Default for Tuned {
    fn default() -> Self {
        Self {
            contrast: 1.0,
            diversity: 1.0,
            grain: 1.0,
            least: 0.39,
            rounds: 300,
            candidates: 360,
            see: See::default(),
            start: Start::default(),
        }
    }
}

/// Between which directions of two tiles a distance is taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum See {
    /// Between those of their first layers.
    #[default]
    Primary,
    /// Between the two nearest of all their layers.
    Layers,
}

impl See {
    /// Whether only first layers are seen.
    #[must_use]
    pub fn is_primary(&self) -> bool {
        *self == Self::Primary
    }
}

/// How the tile that is turned first lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Start {
    /// Along x.
    #[default]
    First,
    /// As the seed says, and all others with it.
    Random,
}

impl Start {
    /// Whether it lies along x.
    #[must_use]
    pub fn is_first(&self) -> bool {
        *self == Self::First
    }
}
