//! Breadth-first turning: every tile as far as can be from the neighbours that were turned before it.
//!
//! Angles are whole steps of pi / candidates and distances whole numbers of steps, circular over the candidates: ties
//! are exact, and broken by the least step. The search starts from the site with the most neighbours, the first of
//! several, which takes step 0, and visits neighbours in the order of their indices; every other component starts from
//! its own such site. A site without neighbours takes a random step from its own stream.
//!
//! Where all layers are seen, a placed neighbour stands in the way with each of its layers' directions as each of the
//! tile's own layers sees it: at its step, turned by some of 45, 90 and 135 degrees. Should those be no whole steps,
//! distances are counted in quarters of one, so that they are exact all the same.

use std::collections::VecDeque;

use crate::random::Key;
use crate::stage::Graph;

use super::seen::Offsets;

/// A step below `candidates`, which is at least 2, for every site of a graph; `seen` says how many layers are seen of each.
pub(super) fn turn(graph: &Graph, candidates: u32, seen: &[u8], key: &Key<'_>) -> Vec<u32> {
    steps(graph, candidates, seen, |site| key.tile(site).below(u64::from(candidates)) as u32)
}

/// A step that no site has.
const UNPLACED: u32 = u32::MAX;

/// Steps in half a turn, and into how many parts each is divided so that eighths of a turn are whole.
#[derive(Debug, Clone, Copy)]
struct Circle {
    parts: u64,
    around: u64,
}

impl Circle {
    fn new(candidates: u32) -> Self {
        let parts = if candidates.is_multiple_of(4) { 1 } else { 4 };
        Self { parts, around: u64::from(candidates) * parts }
    }

    /// A step that is turned by so many eighths of a turn.
    fn turned(self, step: u32, eighths: u32) -> u64 {
        (u64::from(step) * self.parts + self.around / 4 * u64::from(eighths)) % self.around
    }
}

fn steps(graph: &Graph, candidates: u32, seen: &[u8], random: impl Fn(usize) -> u32) -> Vec<u32> {
    let circle = Circle::new(candidates);
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
                    let offsets = Offsets::between(seen[site as usize], seen[neighbour as usize]);
                    placed.extend(offsets.eighths().map(|eighths| circle.turned(step, eighths)));
                }
                if !queued[neighbour as usize] {
                    queued[neighbour as usize] = true;
                    queue.push_back(neighbour);
                }
            }
            steps[site as usize] = farthest(&mut placed, circle);
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
/// The farthest steps lie in the middles of the widest gaps. In a gap from a to a + g, what lies at a + t has the
/// distance min(t, g - t), which is greatest in the middle. So every gap offers the whole steps next to its middle, and
/// no scan over all steps is needed.
fn farthest(placed: &mut Vec<u64>, circle: Circle) -> u32 {
    placed.sort_unstable();
    placed.dedup();
    let Some((&first, &last)) = placed.first().zip(placed.last()) else { return 0 };
    // The gap across the end of the circle, then those between two places.
    let across = (last, circle.around - last + first);
    let gaps = placed.windows(2).map(|pair| (pair[0], pair[1] - pair[0]));
    let mut best = (0, circle.around);
    for (start, gap) in std::iter::once(across).chain(gaps) {
        let lower = (start + gap / 2) / circle.parts;
        let upper = (start + gap.div_ceil(2)).div_ceil(circle.parts);
        for middle in [lower, upper] {
            let place = middle * circle.parts;
            // A narrow gap may hold no whole step.
            let Some(along) = place.checked_sub(start).filter(|&along| along <= gap) else { continue };
            let distance = along.min(gap - along);
            let step = place % circle.around;
            if distance > best.0 || (distance == best.0 && step < best.1) {
                best = (distance, step);
            }
        }
    }
    (best.1 / circle.parts) as u32
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use proptest::prelude::*;

    use super::*;
    use crate::geom::Angle;

    fn alike(graph: &Graph) -> Vec<u8> {
        vec![1; graph.len()]
    }

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
            prop_assert_eq!(steps(&graph, candidates, &alike(&graph), lonely), scanned(&graph, candidates));
        }

        #[test]
        fn layers_are_kept_apart_as_far_as_can_be(
            (graph, seen) in graphs().prop_flat_map(|graph| {
                let seen = proptest::collection::vec(0u8..=4, graph.len());
                (Just(graph), seen)
            }),
            candidates in 2u32..60,
        ) {
            let steps = steps(&graph, candidates, &seen, lonely);
            let angle = |step: u32| Angle::degrees(180.0 * f64::from(step) / f64::from(candidates));
            // In the order of the search every site has the greatest distance from those before it; the last has it
            // from all.
            let last = |site: &usize| {
                graph.neighbours(*site).iter().all(|&j| graph.neighbours(j as usize).len() > graph.neighbours(*site).len())
                    && graph.neighbours(*site).len() == 1
            };
            for site in (0..graph.len()).filter(last) {
                let other = graph.neighbours(site)[0] as usize;
                let apart = |step: u32| {
                    angle(step).layered_distance(seen[site], angle(steps[other]), seen[other]).unwrap_or(Angle::ZERO)
                };
                let most = (0..candidates).map(|step| apart(step).to_radians()).fold(0.0, f64::max);
                prop_assert!((apart(steps[site]).to_radians() - most).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn a_star_s_centre_is_first() {
        let graph = Graph::new(5, &[[0, 3], [1, 3], [2, 3]], Vec::new());
        assert_eq!(steps(&graph, 360, &alike(&graph), |_| 77), [180, 180, 180, 0, 77]);
    }

    #[test]
    fn the_greatest_candidate_count_is_no_trouble() {
        let graph = Graph::new(3, &[[0, 1], [0, 2], [1, 2]], Vec::new());
        assert_eq!(steps(&graph, u32::MAX, &alike(&graph), |_| 0), [0, 2_147_483_647, 3_221_225_471]);
    }
}
