//! What became of the tiles of a paint.
//!
//! In: the tiles of two patterns. Out: how many stayed, moved, came and went, and of those that are in both, how many turned
//! or have other layers. A tile of one pattern is a tile of the other where it lies at the same place, or else where each
//! is the other's nearest and they are at most half a spacing apart: farther away the next tile's place begins. Pairs are
//! found round by round among those that are left, so that no order of the sites matters.

use rayon::prelude::*;
use serde::Serialize;

use crate::geom::tree::Tree;
use crate::geom::{Angle, Length, Point};
use crate::stage::{Angles, Layers, Sites, Standing, Tiles};

/// Tiles that are turned against each other by less look alike.
const ALIKE: f64 = 0.01;

/// Shares of a layer that differ by less look alike.
const SHARE: f64 = 1e-3;

/// How often pairs are sought among those that are left; few are after the second time.
const ROUNDS: usize = 8;

/// The tiles of a paint as far as they are compared.
#[derive(Debug, Clone, PartialEq)]
pub struct Pattern {
    /// The distance of neighbours that shapes are sized by.
    spacing: Length,
    places: Vec<Point>,
    angles: Vec<Angle>,
    layers: Vec<Layers>,
}

impl Pattern {
    /// The tiles that the region and the edge rule leave, those without a layer included.
    #[must_use]
    pub fn new(sites: &Sites, angles: &Angles, tiles: &Tiles) -> Self {
        let kept: Vec<usize> = (0..sites.own()).filter(|&tile| tiles.standing[tile] != Standing::Absent).collect();
        Self {
            spacing: Length::mm(sites.spacing),
            places: kept.iter().map(|&tile| sites.points[tile]).collect(),
            angles: kept.iter().map(|&tile| angles.0[tile]).collect(),
            layers: kept.iter().map(|&tile| tiles.layers[tile]).collect(),
        }
    }

    /// How many tiles there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.places.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.places.is_empty()
    }
}

/// What became of tiles.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Shift {
    /// Tiles at the same place, to a thousandth of a millimetre.
    pub stayed: usize,
    /// Tiles that moved.
    pub moved: usize,
    /// By how much they did, as a median, in millimetres.
    #[serde(rename = "moved_median_mm")]
    pub median: Length,
    /// The farthest of them, in millimetres.
    #[serde(rename = "moved_most_mm")]
    pub most: Length,
    /// Tiles that only the old pattern has.
    pub went: usize,
    /// Tiles that only the new pattern has.
    pub came: usize,
    /// Tiles that stayed or moved and are turned by more than a hundredth of a degree.
    pub turned: usize,
    /// Tiles that stayed or moved and have other layers.
    pub layers: usize,
}

impl Shift {
    /// Whether all tiles are as they were.
    #[must_use]
    pub fn is_nothing(&self) -> bool {
        self.moved == 0 && self.went == 0 && self.came == 0 && self.turned == 0 && self.layers == 0
    }

    /// Whether the pattern is another one: no tile stayed, and those that lie near one of the others do so by chance, for
    /// at least as many have none near them.
    #[must_use]
    pub fn is_anew(&self) -> bool {
        self.stayed == 0 && self.went + self.came >= self.moved && self.went > 0 && self.came > 0
    }
}

/// What became of the tiles of one pattern in another one.
#[must_use]
pub fn tiles(old: &Pattern, new: &Pattern) -> Shift {
    let mut pairs = Vec::new();
    let (mut left, mut right) = (grouped(old), grouped(new));
    same_places(&mut left, &mut right, &mut pairs);
    let stayed = pairs.len();
    near_places(&mut left, &mut right, old.spacing.min(new.spacing) * 0.5, &mut pairs);
    let moved = pairs.get(stayed..).unwrap_or_default();
    let mut ways: Vec<f64> =
        moved.iter().map(|&[a, b]| old.places[a as usize].distance(new.places[b as usize])).collect();
    ways.sort_unstable_by(f64::total_cmp);
    let middle = |i: usize| ways.get(i).copied().unwrap_or(0.0);
    let median = middle(ways.len() / 2).midpoint(middle(ways.len().saturating_sub(1) / 2));
    let (mut turned, mut layers) = (0, 0);
    for &[a, b] in &pairs {
        let (a, b) = (a as usize, b as usize);
        let [before, after] = [old.layers[a], new.layers[b]];
        layers += usize::from(!are_alike(before, after));
        let is_seen = !before.is_blank() && !after.is_blank();
        turned += usize::from(is_seen && old.angles[a].rp1_distance(new.angles[b]) > Angle::degrees(ALIKE));
    }
    Shift {
        stayed,
        moved: ways.len(),
        median: Length::mm(median),
        most: Length::mm(ways.last().copied().unwrap_or(0.0)),
        went: old.len() - pairs.len(),
        came: new.len() - pairs.len(),
        turned,
        layers,
    }
}

fn are_alike(a: Layers, b: Layers) -> bool {
    let near = |a: f64, b: f64| (a - b).abs() <= SHARE;
    a.full == b.full && a.is_solid == b.is_solid && near(a.part, b.part) && near(a.last, b.last)
}

/// Tiles at one place, in the order of their indices from the last to the first.
struct Group {
    place: Point,
    tiles: Vec<u32>,
}

/// A place in thousandths of a millimetre.
fn rounded(place: Point) -> [i64; 2] {
    [place.x, place.y].map(|at| (at * 1000.0).round() as i64)
}

/// The tiles of a pattern by their places, in the order of these.
fn grouped(pattern: &Pattern) -> Vec<Group> {
    let place = |tile: u32| pattern.places[tile as usize];
    let mut order: Vec<u32> = (0..pattern.len() as u32).collect();
    order.par_sort_unstable_by_key(|&tile| (rounded(place(tile)), tile));
    let groups = order.chunk_by(|&a, &b| rounded(place(a)) == rounded(place(b)));
    groups.map(|tiles| Group { place: place(tiles[0]), tiles: tiles.iter().rev().copied().collect() }).collect()
}

/// Pairs tiles of two groups, as many as there are in both.
fn pair(old: &mut Group, new: &mut Group, pairs: &mut Vec<[u32; 2]>) {
    for _ in 0..old.tiles.len().min(new.tiles.len()) {
        pairs.extend(old.tiles.pop().zip(new.tiles.pop()).map(|(a, b)| [a, b]));
    }
}

/// Pairs what lies at the same place; both lists are in the order of their places.
fn same_places(old: &mut Vec<Group>, new: &mut Vec<Group>, pairs: &mut Vec<[u32; 2]>) {
    let mut others = new.iter_mut().peekable();
    for group in old.iter_mut() {
        while others.next_if(|other| rounded(other.place) < rounded(group.place)).is_some() {}
        if let Some(other) = others.next_if(|other| rounded(other.place) == rounded(group.place)) {
            pair(group, other, pairs);
        }
    }
    drop(others);
    old.retain(|group| !group.tiles.is_empty());
    new.retain(|group| !group.tiles.is_empty());
}

/// Pairs what is each other's nearest, none farther apart than `reach`.
fn near_places(old: &mut Vec<Group>, new: &mut Vec<Group>, reach: Length, pairs: &mut Vec<[u32; 2]>) {
    for _ in 0..ROUNDS {
        let to_new = nearest(old, new, reach);
        let to_old = nearest(new, old, reach);
        let before = pairs.len();
        for (i, found) in to_new.iter().enumerate() {
            if let Some(j) = found.filter(|&j| to_old[j as usize] == Some(i as u32)) {
                pair(&mut old[i], &mut new[j as usize], pairs);
            }
        }
        if pairs.len() == before {
            return;
        }
        old.retain(|group| !group.tiles.is_empty());
        new.retain(|group| !group.tiles.is_empty());
    }
}

/// The nearest group of a list for every group of another; of groups equally near the first.
fn nearest(of: &[Group], among: &[Group], reach: Length) -> Vec<Option<u32>> {
    let places: Vec<Point> = among.iter().map(|group| group.place).collect();
    let tree = Tree::new(&places);
    let square = reach.to_mm() * reach.to_mm();
    let find = |found: &mut Vec<_>, group: &Group| {
        tree.nearest_few(group.place, 1, square, |_| true, found);
        found.first().map(|&(_, number)| number)
    };
    of.par_iter().map_init(Vec::new, find).collect()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn pattern(tiles: &[(f64, f64, f64, u8)]) -> Pattern {
        Pattern {
            spacing: Length::mm(4.0),
            places: tiles.iter().map(|&(x, y, ..)| Point::new(x, y)).collect(),
            angles: tiles.iter().map(|&(_, _, angle, _)| Angle::degrees(angle)).collect(),
            layers: tiles.iter().map(|&(.., layers)| Layers::new(layers, 0.0)).collect(),
        }
    }

    #[test]
    fn every_kind_of_change_is_told() {
        let old = pattern(&[(0.0, 0.0, 0.0, 1), (4.0, 0.0, 10.0, 1), (8.0, 0.0, 20.0, 2), (12.0, 0.0, 0.0, 1)]);
        let new = pattern(&[(8.0, 0.0, 20.0, 3), (0.0, 0.0, 179.5, 1), (4.5, 0.0, 10.0, 1), (20.0, 0.0, 0.0, 1)]);
        let (median, most) = (Length::mm(0.5), Length::mm(0.5));
        let wanted = Shift { stayed: 2, moved: 1, median, most, went: 1, came: 1, turned: 1, layers: 1 };
        assert_eq!(tiles(&old, &new), wanted);
        assert!(tiles(&old, &old).is_nothing());
        assert_eq!(tiles(&old, &pattern(&[])).went, 4);
    }

    #[test]
    fn tiles_on_one_place_are_paired_in_their_order() {
        let many: Vec<_> = (0..50_000).map(|_| (1.0, 1.0, 30.0, 1)).collect();
        let moved: Vec<_> = (0..50_001).map(|_| (1.5, 1.0, 30.0, 1)).collect();
        let found = tiles(&pattern(&many), &pattern(&moved));
        assert_eq!((found.moved, found.came, found.went, found.turned), (50_000, 1, 0, 0));
    }

    #[test]
    fn a_blank_tile_is_not_seen_to_turn() {
        let found = tiles(&pattern(&[(0.0, 0.0, 0.0, 0)]), &pattern(&[(0.0, 0.0, 90.0, 0)]));
        assert!(found.is_nothing());
    }

    proptest! {
        #[test]
        fn all_tiles_are_told_of_and_both_ways_agree(
            old in prop::collection::vec((0.0..30.0f64, 0.0..30.0f64, 0.0..180.0f64, 0..4u8), 0..60),
            new in prop::collection::vec((0.0..30.0f64, 0.0..30.0f64, 0.0..180.0f64, 0..4u8), 0..60),
        ) {
            let (old, new) = (pattern(&old), pattern(&new));
            let (there, back) = (tiles(&old, &new), tiles(&new, &old));
            prop_assert_eq!(there.stayed + there.moved + there.went, old.len());
            prop_assert_eq!(there.stayed + there.moved + there.came, new.len());
            prop_assert!(there.most <= Length::mm(2.0) && there.median <= there.most);
            prop_assert_eq!((there.went, there.came, there.moved), (back.came, back.went, back.moved));
        }

        #[test]
        fn the_order_of_sites_does_not_matter(
            old in prop::collection::vec((0.0..30.0f64, 0.0..30.0f64, 0.0..180.0f64, 0..4u8), 0..40),
            seed in any::<prop::sample::Index>(),
        ) {
            let mut turned = old.clone();
            turned.rotate_left(seed.index(old.len() + 1).min(old.len()));
            prop_assert!(tiles(&pattern(&old), &pattern(&turned)).is_nothing());
        }
    }
}
