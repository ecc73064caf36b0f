//! Straight strokes that lie on each other in part.
//!
//! In: lines of two drawings, each with a key that only lines of one look share. Out: the parts that both have, that only
//! the old one has and that only the new one has. A stroke that is cut elsewhere than before lies on the same straight line
//! to the last digits, for both come from one longer stroke; lines are put together by direction and by how far they pass
//! the origin, and then looked along from one end to the other (a sweep over the ends).

use std::collections::BTreeSet;

use crate::geom::Point;

/// Directions of one straight line differ by less than this many radians: rounding makes 1e-13 of it.
const DIRECTION: f64 = 1e-9;

/// How far apart lines of one direction pass the origin when they are one, in millimetres.
const ASIDE: f64 = 1e-5;

/// Parts that are shorter are no parts, in millimetres.
const SHORTEST: f64 = 1e-3;

/// A line of one of the two drawings.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line {
    /// Lines of different keys have nothing in common.
    pub(super) key: u128,
    /// Whose it is.
    pub(super) side: Side,
    /// The layer that it lies in.
    pub(super) layer: usize,
    pub(super) ends: [Point; 2],
}

/// Which of the two drawings.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Side {
    Old,
    New,
}

/// What became of a part of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Fate {
    Stayed,
    Went,
    Came,
}

/// A part of a line: what became of it, the line's key, its layer (of the old drawing if it went, of the new one otherwise)
/// and its ends.
pub(super) type Part = (Fate, u128, usize, [Point; 2]);

/// A line as it lies on its straight line.
struct Lying {
    line: Line,
    /// Its direction in [0, pi).
    direction: f64,
    /// How far its straight line passes the origin.
    aside: f64,
    /// Its ends along the direction, the lesser first.
    along: [f64; 2],
    /// Its ends in this order.
    ends: [Point; 2],
}

impl Lying {
    /// None of what has no direction.
    fn new(line: Line) -> Option<Self> {
        let [a, b] = line.ends;
        let (mut dx, mut dy) = (b.x - a.x, b.y - a.y);
        let length = libm::hypot(dx, dy);
        if !(length.is_finite() && length > 0.0) {
            return None;
        }
        if dy < 0.0 || (dy == 0.0 && dx < 0.0) {
            (dx, dy) = (-dx, -dy);
        }
        let mut direction = libm::atan2(dy, dx);
        if direction > std::f64::consts::PI - DIRECTION {
            // Almost all the way round is almost no turn.
            (direction, dx, dy) = (0.0, -dx, -dy);
        }
        let (ux, uy) = (dx / length, dy / length);
        let along = |p: Point| p.x * ux + p.y * uy;
        let ends = if along(a) <= along(b) { [a, b] } else { [b, a] };
        Some(Self { line, direction, aside: a.y * ux - a.x * uy, along: ends.map(along), ends })
    }
}

/// The parts of lines, in an order that depends on the lines alone.
pub(super) fn parts(lines: Vec<Line>) -> Vec<Part> {
    let mut lying: Vec<Lying> = lines.into_iter().filter_map(Lying::new).collect();
    lying.sort_by(|a, b| a.line.key.cmp(&b.line.key).then(a.direction.total_cmp(&b.direction)));
    let mut parts = Vec::new();
    let alike = |a: &Lying, b: &Lying| a.line.key == b.line.key && b.direction - a.direction < DIRECTION;
    for group in lying.chunk_by_mut(alike) {
        group.sort_by(|a, b| a.aside.total_cmp(&b.aside));
        for one in group.chunk_by_mut(|a, b| b.aside - a.aside < ASIDE) {
            sweep(one, &mut parts);
        }
    }
    parts
}

/// Looks along the lines that lie on one straight line.
fn sweep(lines: &[Lying], parts: &mut Vec<Part>) {
    // Where lines begin and end, in order; at one place they begin first, so that nothing falls between them.
    let ends = lines.iter().enumerate().flat_map(|(number, line)| [0, 1].map(|end| (line.along[end], end, number)));
    let mut ends: Vec<(f64, usize, usize)> = ends.collect();
    ends.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2)));
    // The lines that are begun, of each side.
    let mut begun: [BTreeSet<usize>; 2] = Default::default();
    // The part that is begun: what becomes of it, its line, and where it begins.
    let mut part: Option<(Fate, usize, f64, Point)> = None;
    for (at, end, number) in ends {
        let side = lines[number].line.side as usize;
        if end == 0 {
            begun[side].insert(number);
        } else {
            begun[side].remove(&number);
        }
        let now = match (begun[0].len(), begun[1].len()) {
            (0, 0) => None,
            (old, new) if old == new => begun[1].first().map(|&line| (Fate::Stayed, line)),
            (old, new) if old > new => begun[0].first().map(|&line| (Fate::Went, line)),
            _ => begun[1].first().map(|&line| (Fate::Came, line)),
        };
        let here = lines[number].ends[end];
        if part.map(|(fate, ..)| fate) != now.map(|(fate, _)| fate) {
            if let Some((fate, line, from, start)) = part
                && at - from > SHORTEST
            {
                parts.push((fate, lines[line].line.key, lines[line].line.layer, [start, here]));
            }
            part = now.map(|(fate, line)| (fate, line, at, here));
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn line(side: Side, from: f64, to: f64) -> Line {
        // Along a slanted line.
        let at = |t: f64| Point::new(3.0 + t * 0.6, 1.0 + t * 0.8);
        Line { key: 7, side, layer: side as usize, ends: [at(from), at(to)] }
    }

    fn lengths(parts: &[Part], fate: Fate) -> f64 {
        parts.iter().filter(|part| part.0 == fate).map(|part| part.3[0].distance(part.3[1])).sum()
    }

    #[test]
    fn a_stroke_that_is_cut_elsewhere_stays_in_part() {
        let parts = parts(vec![line(Side::Old, 0.0, 5.0), line(Side::New, 8.0, 2.0)]);
        let found: Vec<(Fate, usize)> = parts.iter().map(|part| (part.0, part.2)).collect();
        assert_eq!(found, [(Fate::Went, 0), (Fate::Stayed, 1), (Fate::Came, 1)]);
        for (fate, length) in [(Fate::Went, 2.0), (Fate::Stayed, 3.0), (Fate::Came, 3.0)] {
            assert!((lengths(&parts, fate) - length).abs() < 1e-9, "{parts:?}");
        }
    }

    #[test]
    fn other_lines_have_nothing_in_common() {
        let beside = |side, by: f64| Line {
            ends: line(side, 0.0, 5.0).ends.map(|p| Point::new(p.x + by, p.y)),
            ..line(side, 0.0, 5.0)
        };
        let other = Line { key: 8, ..line(Side::New, 0.0, 5.0) };
        for new in [beside(Side::New, 0.001), other] {
            let parts = parts(vec![line(Side::Old, 0.0, 5.0), new]);
            assert!(
                (lengths(&parts, Fate::Went) - 5.0).abs() < 1e-9 && (lengths(&parts, Fate::Came) - 5.0).abs() < 1e-9
            );
        }
    }

    #[test]
    fn level_lines_are_one_whichever_way_they_run() {
        let level =
            |side, ends: [(f64, f64); 2]| Line { ends: ends.map(|(x, y)| Point::new(x, y)), ..line(side, 0.0, 1.0) };
        let parts =
            parts(vec![level(Side::Old, [(0.0, 2.0), (4.0, 2.0 - 1e-12)]), level(Side::New, [(4.0, 2.0), (1.0, 2.0)])]);
        assert!((lengths(&parts, Fate::Stayed) - 3.0).abs() < 1e-6 && (lengths(&parts, Fate::Went) - 1.0).abs() < 1e-6);
    }

    proptest! {
        #[test]
        fn lengths_add_up(
            old in prop::collection::vec((0.0..9.0f64, 0.01..1.0f64), 0..12),
            new in prop::collection::vec((0.0..9.0f64, 0.01..1.0f64), 0..12),
        ) {
            // Strokes of one drawing that lie side by side, a gap after each.
            let side = |side, list: &[(f64, f64)]| {
                let mut at = 0.0;
                list.iter().map(|&(length, gap)| { at += length + 0.01; let l = line(side, at - length, at); at += gap; l }).collect::<Vec<_>>()
            };
            let (old, new) = (side(Side::Old, &old), side(Side::New, &new));
            let all = |lines: &[Line]| lines.iter().map(|line| line.ends[0].distance(line.ends[1])).sum::<f64>();
            let (before, after) = (all(&old), all(&new));
            let parts = parts(old.into_iter().chain(new).collect());
            let stayed = lengths(&parts, Fate::Stayed);
            prop_assert!((stayed + lengths(&parts, Fate::Went) - before).abs() < 0.05);
            prop_assert!((stayed + lengths(&parts, Fate::Came) - after).abs() < 0.05);
        }
    }
}
