//! The order in which a pen draws its strokes, and which way round: paths go in, the same paths come out in an order with
//! little way between them.
//!
//! From the page's corner the nearest end comes next. Then that tour is bettered until nothing helps: a part of it is run
//! through the other way round (2-opt), or up to three strokes are put elsewhere (Or-opt), tried only among near ends and
//! for strokes whose surroundings changed (Bentley, "Fast algorithms for geometric traveling salesman problems", 1992). How
//! much is tried is bounded by a count, not by a clock.

use std::collections::VecDeque;

use rayon::prelude::*;

use super::path::Path;
use crate::geom::Point;
use crate::geom::tree::Tree;

/// How many ends near an end are tried.
const NEIGHBOURS: usize = 8;
/// The longest part of a tour that is run through the other way round.
const LONGEST: usize = 30_000;
/// The most strokes that are put elsewhere together.
const MOVED: usize = 3;
/// How many strokes may be turned in all, for each stroke there is.
const EFFORT: usize = 4_000;
/// What a change must save, in millimetres: below it rounding decides.
const LEAST: f64 = 1e-7;

/// Orders paths and turns them round.
pub(super) fn order(mut paths: Vec<Path>) -> Vec<Path> {
    let ends: Vec<Point> = paths.iter().flat_map(Path::ends).collect();
    let mut tour = Tour::nearest_first(&ends);
    tour.better(&near_ends(&ends));
    let entries = tour.entries;
    let mut ordered = Vec::with_capacity(paths.len());
    let mut here = Point::default();
    for (i, &entry) in entries.iter().enumerate() {
        let mut path = std::mem::replace(&mut paths[entry as usize / 2], Path::Straight(Vec::new()));
        if entry % 2 == 1 {
            path.reverse();
        }
        path.turn(Some(here), entries.get(i + 1).map(|&next| ends[next as usize]));
        here = path.ends()[1];
        ordered.push(path);
    }
    ordered
}

/// The ends near each end, those of its own stroke left out.
fn near_ends(ends: &[Point]) -> Vec<Vec<u32>> {
    let tree = Tree::new(ends);
    let near = |a: u32| {
        let mut found = Vec::with_capacity(NEIGHBOURS + 1);
        tree.nearest_few(ends[a as usize], NEIGHBOURS, f64::INFINITY, |b| b / 2 != a / 2, &mut found);
        found.into_iter().map(|(_, b)| b).collect()
    };
    (0..ends.len() as u32).into_par_iter().map(near).collect()
}

/// An order of strokes. Stroke i has the ends 2i and 2i + 1; it is entered at one and left at the other.
struct Tour<'a> {
    ends: &'a [Point],
    /// Where each stroke is entered, in order.
    entries: Vec<u32>,
    /// The place of each stroke in the order.
    place: Vec<u32>,
    /// How many strokes may still be turned.
    effort: usize,
}

impl<'a> Tour<'a> {
    /// From the corner always on to the nearest end that is left.
    fn nearest_first(ends: &'a [Point]) -> Self {
        let mut tree = Tree::new(ends);
        let mut entries = Vec::with_capacity(ends.len() / 2);
        let mut place = vec![0; ends.len() / 2];
        let mut here = Point::default();
        while let Some(entry) = tree.nearest(here) {
            tree.remove(entry);
            tree.remove(entry ^ 1);
            place[entry as usize / 2] = entries.len() as u32;
            entries.push(entry);
            here = ends[entry as usize ^ 1];
        }
        let effort = entries.len().saturating_mul(EFFORT);
        Self { ends, entries, place, effort }
    }

    fn place(&self, end: u32) -> usize {
        self.place[end as usize / 2] as usize
    }

    fn distance(&self, a: Option<u32>, b: Option<u32>) -> f64 {
        // Before the first stroke the pen is at the corner; after the last one it may stay.
        let at = |end: Option<u32>| end.map(|end| self.ends[end as usize]);
        match (at(a), at(b)) {
            (Some(a), Some(b)) => a.distance(b),
            (None, Some(b)) => b.distance(Point::default()),
            (_, None) => 0.0,
        }
    }

    /// Where the stroke at a place is entered.
    fn entry(&self, place: usize) -> Option<u32> {
        self.entries.get(place).copied()
    }

    /// Where the stroke before a place is left.
    fn exit_before(&self, place: usize) -> Option<u32> {
        place.checked_sub(1).and_then(|before| self.entry(before)).map(|entry| entry ^ 1)
    }

    /// Runs through the strokes of some places the other way round.
    fn reverse(&mut self, first: usize, end: usize) {
        self.entries[first..end].reverse();
        for place in first..end {
            self.entries[place] ^= 1;
            self.place[self.entries[place] as usize / 2] = place as u32;
        }
        self.effort = self.effort.saturating_sub(end - first);
    }

    /// Betters the tour until nothing helps or the effort is spent.
    fn better(&mut self, near: &[Vec<u32>]) {
        let count = self.place.len();
        // Strokes to be tried, in the order of the tour.
        let mut waiting: VecDeque<u32> = self.entries.iter().map(|entry| entry / 2).collect();
        let mut is_waiting = vec![true; count];
        while let Some(stroke) = waiting.pop_front() {
            is_waiting[stroke as usize] = false;
            while self.effort > 0 {
                let changed = [2 * stroke, 2 * stroke + 1].into_iter().find_map(|end| self.try_end(end, near));
                let Some(changed) = changed else { break };
                for end in changed.into_iter().flatten() {
                    let other = end / 2;
                    if other != stroke && !std::mem::replace(&mut is_waiting[other as usize], true) {
                        waiting.push_back(other);
                    }
                }
            }
        }
    }

    /// Makes the first change that brings an end next to one of those near it and saves way, and says at which ends.
    fn try_end(&mut self, a: u32, near: &[Vec<u32>]) -> Option<[Option<u32>; 6]> {
        let is_exit = self.entries[self.place(a)] != a;
        let place = self.place(a);
        // The link of this end: from an exit to the entry after it.
        let link = if is_exit { place + 1 } else { place };
        let (p, n) = (self.exit_before(link), self.entry(link));
        let now = self.distance(p, n);
        for &c in &near[a as usize] {
            let reach = self.distance(Some(a), Some(c));
            // A change makes one new link at this end. It must be shorter than the old one, unless there is none.
            if n.is_some() && reach >= now - LEAST {
                break;
            }
            let saved = self.try_two_opt(a, is_exit, link, c).or_else(|| self.try_or_opt(is_exit, link, c));
            if saved.is_some() {
                return saved;
            }
        }
        None
    }

    /// Runs through what lies between two links the other way round, if that saves way.
    fn try_two_opt(&mut self, a: u32, is_exit: bool, link: usize, c: u32) -> Option<[Option<u32>; 6]> {
        let place = self.place(c);
        let c_is_exit = self.entries[place] != c;
        if c_is_exit != is_exit {
            return None;
        }
        let other = if c_is_exit { place + 1 } else { place };
        let (first, end) = (link.min(other), link.max(other));
        if first == end || end - first > LONGEST {
            return None;
        }
        let (p, q, r, s) = (self.exit_before(first), self.entry(first), self.exit_before(end), self.entry(end));
        let before = self.distance(p, q) + self.distance(r, s);
        let after = self.distance(p, r) + self.distance(q, s);
        if after >= before - LEAST {
            return None;
        }
        self.reverse(first, end);
        Some([Some(a), Some(c), p, q, r, s])
    }

    /// Puts a few strokes, of which the outermost has the end `c`, into a link, if that saves way.
    fn try_or_opt(&mut self, is_exit: bool, link: usize, c: u32) -> Option<[Option<u32>; 6]> {
        let place = self.place(c);
        let c_is_exit = self.entries[place] != c;
        let (p, n) = (self.exit_before(link), self.entry(link));
        let now = self.distance(p, n);
        for length in 1..=MOVED {
            // From the stroke with the end `c` on, away from that end.
            let (first, end) = if c_is_exit {
                let Some(first) = (place + 1).checked_sub(length) else { break };
                (first, place + 1)
            } else {
                (place, place + length)
            };
            if end > self.entries.len() || (first..=end).contains(&link) {
                break;
            }
            let (from, to) = (self.entry(first), self.exit_before(end));
            let (u, v) = (self.exit_before(first), self.entry(end));
            let taken = self.distance(u, from) + self.distance(to, v) - self.distance(u, v);
            // The end `c` comes next to the end that is tried: to its exit as an entry, to its entry as an exit.
            let is_turned = c_is_exit == is_exit;
            let put = if is_turned {
                self.distance(p, to) + self.distance(from, n) - now
            } else {
                self.distance(p, from) + self.distance(to, n) - now
            };
            if put >= taken - LEAST {
                continue;
            }
            let (low, high) = (first.min(link), end.max(link));
            if high - low > LONGEST {
                break;
            }
            // Two neighbouring parts change places when all is reversed and then each part by itself.
            self.reverse(low, high);
            let (moved, others) = if link < first {
                ((low, low + length), (low + length, high))
            } else {
                ((high - length, high), (low, high - length))
            };
            self.reverse(others.0, others.1);
            if !is_turned {
                self.reverse(moved.0, moved.1);
            }
            return Some([p, n, from, to, u, v]);
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use proptest::collection::vec;
    use proptest::prelude::*;

    use super::super::super::samples::ring;
    use super::*;

    fn way_between(paths: &[Path]) -> f64 {
        let mut here = Point::default();
        let mut way = 0.0;
        for path in paths {
            let [start, end] = path.ends();
            way += here.distance(start);
            here = end;
        }
        way
    }

    #[test]
    fn a_shuffled_row_is_run_through_from_the_corner() {
        let row: Vec<Path> = [7, 2, 9, 0, 4, 1, 8, 3, 6, 5]
            .into_iter()
            .map(|i| {
                let (x, turned) = (f64::from(i) * 2.0, i % 3 == 0);
                let (from, to) = if turned { (x + 1.0, x) } else { (x, x + 1.0) };
                Path::Straight(ring(&[(from, 0.0), (to, 0.0)]))
            })
            .collect();
        let ordered = order(row);
        let starts: Vec<f64> = ordered.iter().map(|path| path.ends()[0].x).collect();
        assert_eq!(starts, [0.0, 2.0, 4.0, 6.0, 8.0, 10.0, 12.0, 14.0, 16.0, 18.0]);
        assert!((way_between(&ordered) - 9.0).abs() < 1e-9);
    }

    proptest! {
        #[test]
        fn every_stroke_is_drawn_once(
            corners in vec(((0.0..50.0f64, 0.0..50.0f64), (0.0..50.0f64, 0.0..50.0f64)), 0..80),
        ) {
            let paths: Vec<Path> = corners.iter().map(|&(a, b)| Path::Straight(ring(&[a, b]))).collect();
            let ordered = order(paths.clone());
            let key = |path: &Path| {
                let mut ends = path.ends().map(|p| (p.x.to_bits(), p.y.to_bits()));
                ends.sort_unstable();
                ends
            };
            let sorted = |paths: &[Path]| {
                let mut keys: Vec<_> = paths.iter().map(key).collect();
                keys.sort_unstable();
                keys
            };
            prop_assert_eq!(sorted(&ordered), sorted(&paths));
            // Never farther than from one nearest end to the next.
            let ends: Vec<Point> = paths.iter().flat_map(Path::ends).collect();
            let greedy = Tour::nearest_first(&ends);
            let greedy: Vec<Path> = greedy
                .entries
                .iter()
                .map(|&entry| Path::Straight(vec![ends[entry as usize], ends[entry as usize ^ 1]]))
                .collect();
            prop_assert!(way_between(&ordered) <= way_between(&greedy) + 1e-9);
        }

        #[test]
        fn changes_save_what_they_say(
            corners in vec(((0.0..9.0f64, 0.0..9.0f64), (0.0..9.0f64, 0.0..9.0f64)), 2..30),
        ) {
            let ends: Vec<Point> = corners.iter().flat_map(|&(a, b)| ring(&[a, b])).collect();
            let near = near_ends(&ends);
            let mut tour = Tour::nearest_first(&ends);
            let way = |tour: &Tour<'_>| (0..tour.entries.len()).map(|i| tour.distance(tour.exit_before(i), tour.entry(i))).sum::<f64>();
            for end in 0..ends.len() as u32 {
                let before = way(&tour);
                let changed = tour.try_end(end, &near).is_some();
                let after = way(&tour);
                prop_assert_eq!(changed, after < before);
                prop_assert!(changed || after == before);
                for (place, entry) in tour.entries.iter().enumerate() {
                    prop_assert_eq!(tour.place[*entry as usize / 2] as usize, place);
                }
            }
        }
    }
}
