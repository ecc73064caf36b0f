//! Strokes whose ends touch become one: paths go in, as few or fewer come out.
//!
//! Each end is joined to at most one other, the nearest pairs first, so that nothing is drawn that is not within the reach
//! of an end. Of pairs equally near the ones drawn first count as nearer.

use super::path::Path;
use crate::geom::tree::Tree;
use crate::geom::{Length, Point};

/// How many ends near an end are looked at.
const CANDIDATES: usize = 8;
/// How often those that are left are looked at again. Only where very many meet some are left then.
const ROUNDS: usize = 16;

/// Joins paths whose ends are within a reach of each other. Dots stay by themselves.
pub(super) fn merge(paths: Vec<Path>, reach: Length) -> Vec<Path> {
    let partners = pair_ends(&paths, reach);
    let mut paths: Vec<Option<Path>> = paths.into_iter().map(Some).collect();
    let mut merged = Vec::new();
    // Those that have an end to start at, then rings.
    let has_start = |i: &usize| partners[2 * i].is_none() || partners[2 * i + 1].is_none();
    let all = 0..paths.len();
    for i in all.clone().filter(has_start).chain(all) {
        let start = if partners[2 * i].is_none() { 2 * i } else { 2 * i + usize::from(has_start(&i)) };
        merged.extend(walk(start, &partners, &mut paths));
    }
    merged
}

/// The chain that starts at an end, unless it is taken.
fn walk(start: usize, partners: &[Option<u32>], paths: &mut [Option<Path>]) -> Option<Path> {
    let mut chain: Option<Path> = None;
    let mut entry = start;
    while let Some(mut path) = paths[entry / 2].take() {
        if entry % 2 == 1 {
            path.reverse();
        }
        match &mut chain {
            Some(chain) => chain.append(&path),
            None => chain = Some(path),
        }
        let Some(next) = partners[entry ^ 1] else { return chain };
        entry = next as usize;
    }
    // Back at a path that is taken: a ring, if it is the first.
    if let Some(chain) = chain.as_mut().filter(|_| entry == start) {
        let [first, _] = chain.ends();
        if chain.points().len() > 2 {
            chain.append(&Path::Straight(vec![first]));
        }
    }
    chain
}

/// The partner of every end: end 0 of path i is 2i, its other end 2i + 1.
fn pair_ends(paths: &[Path], reach: Length) -> Vec<Option<u32>> {
    let ends: Vec<Point> = paths.iter().flat_map(Path::ends).collect();
    let mut tree = Tree::new(&ends);
    for (i, path) in paths.iter().enumerate() {
        // What is closed already, and what is shorter than the reach, has no end.
        let [start, end] = path.ends();
        if path.is_closed() || start.distance(end) <= reach.to_mm() {
            tree.remove(2 * i as u32);
            tree.remove(2 * i as u32 + 1);
        }
    }
    let reach = reach.to_mm() * reach.to_mm();
    let mut partners = vec![None; ends.len()];
    let (mut pairs, mut found) = (Vec::new(), Vec::new());
    let mut single: Vec<u32> = (0..ends.len() as u32).filter(|&end| tree.is_there(end)).collect();
    for _ in 0..ROUNDS {
        pairs.clear();
        for &a in &single {
            tree.nearest_few(ends[a as usize], CANDIDATES, reach, |b| b / 2 != a / 2, &mut found);
            pairs.extend(found.iter().map(|&(off, b)| (off, a.min(b), a.max(b))));
        }
        if pairs.is_empty() {
            break;
        }
        pairs.sort_unstable_by(|p, q| p.0.total_cmp(&q.0).then((p.1, p.2).cmp(&(q.1, q.2))));
        for &(_, a, b) in &pairs {
            if tree.is_there(a) && tree.is_there(b) {
                partners[a as usize] = Some(b);
                partners[b as usize] = Some(a);
                tree.remove(a);
                tree.remove(b);
            }
        }
        single.retain(|&end| tree.is_there(end));
    }
    partners
}

#[cfg(test)]
mod tests {
    use proptest::collection::vec;
    use proptest::prelude::*;

    use super::super::super::samples::ring;
    use super::*;

    fn line(points: &[(f64, f64)]) -> Path {
        Path::Straight(ring(points))
    }

    #[test]
    fn touching_ends_become_one_whatever_their_sense() {
        let paths = vec![
            line(&[(0.0, 0.0), (1.0, 0.0)]),
            line(&[(2.0, 0.02), (1.0, 0.01)]),
            line(&[(5.0, 0.0), (5.0, 3.0)]),
            line(&[(2.0, 0.0), (2.0, 4.0)]),
        ];
        let merged = merge(paths, Length::mm(0.05));
        let wanted = [(0.0, 0.0), (1.0, 0.0), (1.0, 0.01), (2.0, 0.02), (2.0, 0.0), (2.0, 4.0)];
        assert_eq!(merged, [line(&wanted), line(&[(5.0, 0.0), (5.0, 3.0)])]);
    }

    #[test]
    fn a_ring_is_closed() {
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
        let sides = (0..4).map(|i| line(&[corners[i], corners[(i + 1) % 4]])).collect();
        let merged = merge(sides, Length::mm(0.05));
        assert_eq!(merged, [line(&[corners[0], corners[1], corners[2], corners[3], corners[0]])]);
    }

    #[test]
    fn dots_and_short_strokes_stay() {
        let paths = vec![line(&[(0.0, 0.0)]), line(&[(0.0, 0.0), (0.01, 0.0)]), line(&[(0.0, 0.0), (1.0, 0.0)])];
        assert_eq!(merge(paths.clone(), Length::mm(0.05)).len(), 3);
    }

    proptest! {
        #[test]
        fn nothing_is_lost_and_little_is_added(
            corners in vec(((0..6i32, 0..6i32), (0..6i32, 0..6i32)), 0..60),
        ) {
            let point = |(x, y): (i32, i32)| (f64::from(x), f64::from(y));
            let paths: Vec<Path> =
                corners.into_iter().filter(|(a, b)| a != b).map(|(a, b)| line(&[point(a), point(b)])).collect();
            let length = |paths: &[Path]| paths.iter().map(Path::length).sum::<f64>();
            let (count, whole) = (paths.len(), length(&paths));
            let merged = merge(paths, Length::mm(0.1));
            // Ends that meet lie on the same place here, so nothing is added at all.
            prop_assert!((length(&merged) - whole).abs() < 1e-9);
            let points: usize = merged.iter().map(|path| path.points().len()).sum();
            prop_assert_eq!(points, count + merged.len());
            // No two open paths are left that could be joined.
            let ends: Vec<_> = merged.iter().filter(|path| !path.is_closed()).collect();
            for (i, a) in ends.iter().enumerate() {
                for b in &ends[..i] {
                    prop_assert!(a.ends().iter().all(|p| !b.ends().contains(p)));
                }
            }
        }
    }
}
