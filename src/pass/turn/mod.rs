//! Turning: the direction of every tile.
//!
//! In: a paint, its sites and their links. Out: [`Angles`], one direction in [0, pi) for every site. An angle rule is
//! one file here and one line in [`turn`].

mod along;
mod bfs;
mod checkerboard;
mod fixed;
mod random;

use crate::random::Key;
use crate::scene::{AngleRule, Paint};
use crate::stage::{Angles, Graph, Sites};

/// Turns the tiles of a paint by the rule of its tone.
#[must_use]
pub fn turn(paint: &Paint, sites: &Sites, graph: &Graph) -> Angles {
    let key = Key { seed: paint.seed, name: &paint.name, purpose: "angle" };
    Angles(match &paint.tone.angle {
        AngleRule::Bfs { candidates } => bfs::turn(graph, *candidates, &key),
        AngleRule::Random => random::turn(sites, &key),
        AngleRule::Checkerboard => checkerboard::turn(sites),
        AngleRule::Fixed(angle) => fixed::turn(sites, *angle),
        AngleRule::Along(field) => along::turn(sites, field),
    })
}
