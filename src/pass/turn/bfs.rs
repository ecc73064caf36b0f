//! Breadth-first turning: every tile as far as can be from the neighbours that were turned before it.
//!
//! Angles are whole steps of pi / candidates and distances whole numbers of steps, circular over the candidates: ties
//! are exact, and broken by the least step. The search starts from the site with the most neighbours, the first of
//! several, which takes step 0, and visits neighbours in the order of their indices; every other component starts from
//! its own such site. A site without neighbours takes a random step from its own stream.

use std::collections::VecDeque;
use std::f64::consts::PI;

use crate::geom::Angle;
use crate::random::Key;
use crate::stage::Graph;

/// A direction for every site of a graph; `candidates` is at least 2.
pub(super) fn turn(graph: &Graph, candidates: u32, key: &Key<'_>) -> Vec<Angle> {
    let random = |site| key.tile(site).below(u64::from(candidates)) as u32;
    let unit = PI / f64::from(candidates);
    steps(graph, candidates, random)
        .into_iter()
        .map(|step| Angle::radians(f64::from(step) * unit).direction())
        .collect()
}

/// A step that no site has.
const UNPLACED: u32 = u32::MAX;

/// A step below `candidates` for every site.
fn steps(graph: &Graph, candidates: u32, random: impl Fn(usize) -> u32) -> Vec<u32> {
    let mut steps = vec![UNPLACED; graph.len()];
    let mut queued = vec![false; graph.len()];
    let mut queue = VecDeque::new();
    let mut placed = Vec::new();
    for root in by_degree(graph) {
        if queued[root as usize] {
            continue;
        }
        if graph.neighbours(root as usize).is_empty() {
            steps[root as usize] = random(root as usize);
            continue;
        }
        queued[root as usize] = true;
        queue.push_back(root);
        while let Some(site) = queue.pop_front() {
            placed.clear();
            for &neighbour in graph.neighbours(site as usize) {
                let step = steps[neighbour as usize];
                if step != UNPLACED {
                    placed.push(step);
                }
                if !queued[neighbour as usize] {
                    queued[neighbour as usize] = true;
                    queue.push_back(neighbour);
                }
            }
            steps[site as usize] = farthest(&mut placed, candidates);
        }
    }
    steps
}

/// The sites from the most neighbours to the fewest, those with as many in the order of their indices.
fn by_degree(graph: &Graph) -> Vec<u32> {
    let degree = |site: usize| graph.neighbours(site).len();
    let most = (0..graph.len()).map(degree).max().unwrap_or(0);
    // How many sites have a greater degree, and so where those of each degree begin.
    let mut starts = vec![0usize; most + 2];
    for site in 0..graph.len() {
        starts[most - degree(site) + 1] += 1;
    }
    for i in 1..starts.len() {
        starts[i] += starts[i - 1];
    }
    let mut order = vec![0; graph.len()];
    for site in 0..graph.len() {
        let start = &mut starts[most - degree(site)];
        order[*start] = site as u32;
        *start += 1;
    }
    order
}

/// The step whose least circular distance to the placed ones is greatest, the least of several; 0 where none is placed.
///
/// The farthest steps lie in the middles of the widest gaps. In a gap from a to a + g, the step at a + t has the
/// distance min(t, g - t), which is greatest, g / 2 rounded down, at the lower and at the upper middle. So every gap
/// whose half, rounded down, is greatest offers its two middles, and no scan over all steps is needed.
fn farthest(placed: &mut Vec<u32>, candidates: u32) -> u32 {
    placed.sort_unstable();
    placed.dedup();
    let Some((&first, &last)) = placed.first().zip(placed.last()) else { return 0 };
    // The gap across the end of the circle, then those between two steps.
    let across = (last, candidates - last + first);
    let gaps = placed.windows(2).map(|pair| (pair[0], pair[1] - pair[0]));
    let mut best = (0, candidates);
    for (start, gap) in std::iter::once(across).chain(gaps) {
        let half = gap / 2;
        for middle in [half, gap - half] {
            let step = ((u64::from(start) + u64::from(middle)) % u64::from(candidates)) as u32;
            if half > best.0 || (half == best.0 && step < best.1) {
                best = (half, step);
            }
        }
    }
    best.1
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use proptest::prelude::*;

    use super::*;

    /// The same by definition: every step is tried.
    fn scanned(graph: &Graph, candidates: u32) -> Vec<u32> {
        let mut steps: Vec<Option<u32>> = vec![None; graph.len()];
        let distance = |a: u32, b: u32| a.abs_diff(b).min(candidates - a.abs_diff(b));
        loop {
            let root = (0..graph.len()).filter(|&site| steps[site].is_none());
            let Some(root) = root.max_by_key(|&site| (graph.neighbours(site).len(), graph.len() - site)) else {
                return steps.into_iter().flatten().collect();
            };
            let mut queue = vec![root as u32];
            let mut next = 0;
            while let Some(&site) = queue.get(next) {
                next += 1;
                let neighbours = graph.neighbours(site as usize);
                let placed: Vec<u32> = neighbours.iter().filter_map(|&j| steps[j as usize]).collect();
                let least = |step: u32| placed.iter().map(|&other| distance(step, other)).min().unwrap_or(0);
                steps[site as usize] = (0..candidates).rev().max_by_key(|&step| least(step));
                if placed.is_empty() {
                    steps[site as usize] = Some(if neighbours.is_empty() { lonely(site as usize) } else { 0 });
                }
                for &neighbour in neighbours {
                    if !queue.contains(&neighbour) && steps[neighbour as usize].is_none() {
                        queue.push(neighbour);
                    }
                }
            }
        }
    }

    fn lonely(site: usize) -> u32 {
        site as u32 % 2
    }

    fn graphs() -> impl Strategy<Value = Graph> {
        (1u32..40).prop_flat_map(|sites| {
            proptest::collection::vec((0..sites, 0..sites), 0..120).prop_map(move |pairs| {
                let edges: BTreeSet<[u32; 2]> =
                    pairs.into_iter().filter(|(a, b)| a != b).map(|(a, b)| [a.min(b), a.max(b)]).collect();
                Graph::new(sites as usize, &edges.into_iter().collect::<Vec<_>>(), Vec::new())
            })
        })
    }

    proptest! {
        #[test]
        fn middles_of_gaps_are_what_a_scan_finds(graph in graphs(), candidates in prop_oneof![2u32..12, 2u32..=720]) {
            prop_assert_eq!(steps(&graph, candidates, lonely), scanned(&graph, candidates));
        }

        #[test]
        fn angles_are_whole_steps(graph in graphs(), candidates in 2u32..=720, seed: u64) {
            let key = Key { seed, name: "paint", purpose: "angle" };
            for angle in turn(&graph, candidates, &key) {
                let step = angle.to_radians() / PI * f64::from(candidates);
                prop_assert!((0.0..PI).contains(&angle.to_radians()));
                prop_assert!((step - step.round()).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn a_star_s_centre_is_first() {
        let graph = Graph::new(5, &[[0, 3], [1, 3], [2, 3]], Vec::new());
        assert_eq!(steps(&graph, 360, |_| 77), [180, 180, 180, 0, 77]);
    }

    #[test]
    fn the_greatest_candidate_count_is_no_trouble() {
        let graph = Graph::new(3, &[[0, 1], [0, 2], [1, 2]], Vec::new());
        assert_eq!(steps(&graph, u32::MAX, |_| 0), [0, 2_147_483_647, 3_221_225_471]);
    }
}
