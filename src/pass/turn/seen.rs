//! What two tiles show of each other: the directions of their layers, as seen from the first ones.
//!
//! Layers are turned against their tile by whole eighths of a turn, so that what lies between the layers of two tiles is
//! the angle between their first layers turned by some of 0, 45, 90 and 135 degrees: four bits say by which.

use crate::geom::Angle;

/// How the layers of a tile are turned against it, in eighths of a turn.
const TURNS: [u32; 4] = [0, 2, 1, 3];

/// The turns by which the direction of a tile's first layer is to be looked at from another tile: bit n stands for n times
/// 45 degrees.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Offsets(u8);

impl Offsets {
    /// How many sets there are.
    pub(super) const COUNT: usize = 16;

    /// Between a tile of so many layers and another. Empty where one of them has none and so no direction.
    pub(super) fn between(layers: u8, other_layers: u8) -> Self {
        let turns = |layers: u8| TURNS.into_iter().take(usize::from(layers));
        let offsets = turns(layers).flat_map(|a| turns(other_layers).map(move |b| (4 + b - a) % 4));
        Self(offsets.fold(0, |bits, offset| bits | 1 << offset))
    }

    /// Its number, below [`Offsets::COUNT`].
    pub(super) fn number(self) -> usize {
        usize::from(self.0)
    }

    /// Its turns, in eighths of a turn.
    pub(super) fn eighths(self) -> impl Iterator<Item = u32> {
        (0..4).filter(move |offset| self.0 >> offset & 1 == 1)
    }

    /// The greatest that such a distance can be: half the widest gap between the directions of one of the tiles.
    pub(super) fn greatest(self) -> Angle {
        let eighths: Vec<u32> = self.eighths().collect();
        let across = eighths.first().zip(eighths.last()).map_or(4, |(first, last)| 4 - last + first);
        let widest = eighths.windows(2).map(|pair| pair[1] - pair[0]).fold(across, u32::max);
        Angle::RIGHT * (f64::from(widest) / 4.0)
    }

    /// The least RP1 distance between any layers of two tiles whose first layers lie so far apart; a right angle where
    /// there are none.
    pub(super) fn distance(self, apart: Angle) -> Angle {
        self.eighths()
            .map(|eighths| apart.rp1_distance(Angle::RIGHT * (f64::from(eighths) / 2.0)))
            .fold(Angle::RIGHT, |least, angle| if angle < least { angle } else { least })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn offsets_are_what_lies_between_layers() {
        for (m, n) in (0..=4).flat_map(|m| (0..=4).map(move |n| (m, n))) {
            let offsets = Offsets::between(m, n);
            assert_eq!(offsets.number() == 0, m == 0 || n == 0);
            let distances = (0..180).map(|degrees| offsets.distance(Angle::degrees(f64::from(degrees))));
            // 22.5 degrees lie between two whole ones.
            let most = distances.map(Angle::to_radians).fold(0.0, f64::max);
            assert!((offsets.greatest().to_radians() - most).abs() < Angle::degrees(0.51).to_radians());
            for degrees in 0..180 {
                let [a, b] = [Angle::degrees(f64::from(degrees)), Angle::degrees(17.0)];
                let Some(least) = a.layered_distance(m, b, n) else { continue };
                let found = offsets.distance(a - b);
                assert!((found - least).to_radians().abs() < 1e-12, "{m} {n} {degrees}: {found:?} {least:?}");
            }
        }
    }
}
