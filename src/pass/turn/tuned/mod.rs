//! Tuned turning: from breadth-first turning on, tiles are turned one at a time to what lowers the pattern's cost.
//!
//! Simulated annealing (Kirkpatrick, Gelatt and Vecchi, Science 1983) over single tiles: a tile is offered other whole
//! steps, near ones and any, and takes one that costs less, or seldom one that costs more, the more seldom the cooler it
//! has become. Tiles are visited patch by patch. Patches whose tiles lie within three links of each other share costs; so
//! patches are coloured, those of one colour share nothing, and are worked on in parallel. What comes out depends on no
//! thread, and each tile draws its chances from a stream of its own.
//!
//! Costs are looked up by whole steps, and what lies two and three links away is summed once for all offers, so that a
//! visit takes a bounded time; memory is about 300 bytes a tile.

mod energy;
mod links;
mod patches;

use std::ops::Range;

use rayon::prelude::*;

use crate::geom::Point;
use crate::random::{Key, Table};
use crate::scene::Tuned;
use crate::stage::Graph;
use crate::stop::Stop;

use energy::{Costs, Crowd, LinkCosts};
use links::{Links, Lists};
use patches::Patches;

/// Rounds that a patch is visited for before the next one has its turn.
const ROUNDS_A_VISIT: u32 = 10;

/// Offers that a tile gets a round.
const OFFERS: u32 = 3;

/// How hot it is at the start and before the end, per unit of weight, and the share of rounds after which nothing that
/// costs more is taken any more.
const HEAT: [f64; 2] = [0.3, 0.01];
const COLD: f64 = 0.95;

/// What costs more heats than this is never taken: the chance is one in three thousand.
const PATIENCE: f64 = 8.0;

/// How far near offers lie at most at the start and at the end, as shares of half a turn.
const REACH: [f64; 2] = [0.5, 0.02];

/// Tunes the steps of a graph's sites, which lie at `points`; `seen` says how many layers are seen of each.
pub(super) fn tune(
    graph: &Graph,
    points: &[Point],
    seen: &[u8],
    rule: &Tuned,
    start: &[u32],
    key: &Key<'_>,
    stop: &Stop,
) -> Vec<u32> {
    if [rule.contrast, rule.diversity, rule.grain].iter().all(|&weight| weight == 0.0) {
        // Where nothing has a weight every change would be as good as none.
        return start.to_vec();
    }
    let patches = Patches::new(points);
    let links = Links::new(graph, &patches, seen);
    let costs = Costs::new(rule, &links.offsets);
    let mut steps: Vec<u16> = patches.order.iter().map(|&site| start[site as usize] as u16).collect();
    let stir = Stir { rule, patches: &patches, links: &links, costs: &costs, key };
    let classes = classes(&links.around(&patches));
    let mut round = 0;
    while round < rule.rounds && !stop.is_asked() {
        let rounds = round..(round + ROUNDS_A_VISIT).min(rule.rounds);
        let link_costs = costs.links(f64::from(rounds.end) / f64::from(rule.rounds));
        for class in classes.iter().take_while(|_| !stop.is_asked()) {
            let visit = |&patch: &u32| stir.visit(patch as usize, &steps, &link_costs, rounds.clone());
            let turned: Vec<Vec<u16>> = class.par_iter().map(visit).collect();
            for (&patch, turned) in class.iter().zip(turned) {
                let first = patches.starts[patch as usize] as usize;
                steps[first..first + turned.len()].copy_from_slice(&turned);
            }
        }
        round = rounds.end;
    }
    // Too few rounds end while it is still hot.
    let first: Vec<u16> = patches.order.iter().map(|&site| start[site as usize] as u16).collect();
    let link_costs = costs.links(1.0);
    if stir.cost(&first, &link_costs) < stir.cost(&steps, &link_costs) {
        steps = first;
    }
    let mut out = vec![0; steps.len()];
    for (&site, &step) in patches.order.iter().zip(&steps) {
        out[site as usize] = u32::from(step);
    }
    out
}

/// Patches in classes of which none holds two that lie around each other: each takes the first class that none of its
/// earlier neighbours has.
fn classes(around: &[Vec<u32>]) -> Vec<Vec<u32>> {
    let mut class_of: Vec<usize> = Vec::with_capacity(around.len());
    let mut classes: Vec<Vec<u32>> = Vec::new();
    let mut taken = Vec::new();
    for (patch, around) in (0u32..).zip(around) {
        taken.clear();
        taken.extend(around.iter().filter(|&&other| other < patch).map(|&other| class_of[other as usize]));
        taken.sort_unstable();
        taken.dedup();
        let free =
            taken.iter().enumerate().find(|(place, class)| place != *class).map_or(taken.len(), |(place, _)| place);
        class_of.push(free);
        if free == classes.len() {
            classes.push(Vec::new());
        }
        classes[free].push(patch);
    }
    classes
}

/// What visits need.
struct Stir<'a> {
    rule: &'a Tuned,
    patches: &'a Patches,
    links: &'a Links,
    costs: &'a Costs,
    key: &'a Key<'a>,
}

impl Stir<'_> {
    /// Offers the tiles of a patch other steps for some rounds, while all others stay. Returns the steps of the patch.
    fn visit(&self, patch: usize, all: &[u16], links: &LinkCosts, rounds: Range<u32>) -> Vec<u16> {
        let sites = self.patches.starts[patch] as usize..self.patches.starts[patch + 1] as usize;
        let (costs, tiles) = (self.costs, sites.len() as f64);
        let mut own = Own { first: sites.start, steps: all[sites.clone()].to_vec() };
        let mut crowd = Crowd::NONE;
        for &step in &own.steps {
            crowd.add(costs.bins[usize::from(step)]);
        }
        let mut away = [&self.links.second, &self.links.third].map(|lists| Away::new(lists, all, &sites, costs));
        let diversity = costs.diversity * 12.0 / tiles;
        let grain = costs.grain * tiles;
        let candidates = costs.candidates as usize;
        let tables: Vec<Table> = sites.clone().map(|site| self.key.table(self.patches.order[site] as usize)).collect();
        let mut near: Vec<(usize, &[f32])> = Vec::new();
        for round in rounds {
            let (heat, reach) = self.schedule(round);
            let patience = heat * PATIENCE;
            for (place, site) in sites.clone().enumerate() {
                near.clear();
                let offsets = &self.links.offsets[self.links.near.range(site)];
                near.extend(
                    self.links
                        .near
                        .of(site)
                        .iter()
                        .zip(offsets)
                        .map(|(&other, &offsets)| (candidates - usize::from(own.step(other, all)), links.of(offsets))),
                );
                let link_costs = |step: usize| near.iter().map(|(against, table)| table[step + against]).sum::<f32>();
                let before = usize::from(own.steps[place]);
                let mut step = before;
                let mut cost = link_costs(step);
                for offer in 0..OFFERS {
                    let draw = (i64::from(round) * i64::from(OFFERS) + i64::from(offer)) * 2;
                    let chance = tables[place].unit(draw);
                    // Every other offer may lie anywhere.
                    let way = if offer % 2 == 0 { (chance * 2.0 - 1.0) * reach } else { chance };
                    let other = (step as f64 + (way + 1.0) * candidates as f64) as usize % candidates;
                    let other_cost = link_costs(other);
                    let (from, to) = (costs.bins[step], costs.bins[other]);
                    let turn = costs.turn(step, other);
                    let changes = [0, 1].map(|k: usize| away[k].changes(place, turn));
                    let grown = f64::from(other_cost - cost)
                        + diversity * f64::from(crowd.grows(from, to))
                        + grain * (away[0].grows(changes[0]) + away[1].grows(changes[1]));
                    let is_taken =
                        grown <= 0.0 || (grown < patience && is_less(tables[place].unit(draw + 1), grown / heat));
                    if is_taken && step != other {
                        crowd.turn(from, to);
                        for (away, change) in away.iter_mut().zip(changes) {
                            away.sum += change;
                        }
                        (step, cost) = (other, other_cost);
                    }
                }
                if step != before {
                    own.steps[place] = step as u16;
                    let turn = costs.turn(before, step);
                    for (away, lists) in away.iter_mut().zip([&self.links.second, &self.links.third]) {
                        away.turned(lists.of(site), sites.start, turn);
                    }
                }
            }
        }
        own.steps
    }

    /// What a pattern costs when all is cold: the sum over patches.
    fn cost(&self, steps: &[u16], links: &LinkCosts) -> f64 {
        let costs = self.costs;
        let candidates = costs.candidates as usize;
        let patch = |bounds: &[u32]| {
            let sites = bounds[0] as usize..bounds[1] as usize;
            let tiles = sites.len() as f64;
            let mut crowd = Crowd::NONE;
            let mut linked = 0.0;
            for site in sites.clone() {
                crowd.add(costs.bins[usize::from(steps[site])]);
                let offsets = &self.links.offsets[self.links.near.range(site)];
                for (&other, &offsets) in self.links.near.of(site).iter().zip(offsets) {
                    let apart = usize::from(steps[site]) + candidates - usize::from(steps[other as usize]);
                    // Each link is met from both ends.
                    linked += f64::from(links.of(offsets)[apart]) / 2.0;
                }
            }
            let pairs: f64 =
                sites.clone().map(|site| f64::from(crowd.near(costs.bins[usize::from(steps[site])]))).sum();
            let away = [&self.links.second, &self.links.third].map(|lists| Away::new(lists, steps, &sites, costs));
            let repeated: f64 = away.iter().map(|away| away.mean() * away.mean()).sum();
            linked + costs.diversity * 12.0 * pairs / tiles + costs.grain * tiles * repeated
        };
        // Collected first, so that the order of the sum does not depend on threads.
        let patches: Vec<f64> = self.patches.starts.par_windows(2).map(patch).collect();
        patches.iter().sum()
    }

    /// How hot it is in a round, and how far near offers lie.
    fn schedule(&self, round: u32) -> (f64, f64) {
        let part = f64::from(round) / f64::from(self.rule.rounds);
        let between = |[from, to]: [f64; 2], part: f64| from * libm::pow(to / from, part);
        let heat = if part < COLD { between(HEAT, part / COLD) } else { 0.0 };
        (heat, between(REACH, part))
    }
}

/// Whether a number in [0, 1) is less than exp(-x) of an x that is not negative. Bounds that are quickly had decide
/// most cases.
fn is_less(number: f64, x: f64) -> bool {
    number < 1.0 - x || (number * (1.0 + x) < 1.0 && number < libm::exp(-x))
}

/// The steps of a patch's own sites.
struct Own {
    first: usize,
    steps: Vec<u16>,
}

impl Own {
    /// The step of a site, which may be another patch's.
    fn step(&self, site: u32, all: &[u16]) -> u16 {
        let own = self.steps.get((site as usize).wrapping_sub(self.first));
        own.copied().unwrap_or_else(|| all[site as usize])
    }
}

/// What lies so many links away from the tiles of a patch.
struct Away {
    /// For each tile the sum of the unit vectors there.
    vectors: Vec<[f32; 2]>,
    /// The sum of cosines over all pairs.
    sum: f64,
    /// How many pairs there are, each counted from both ends.
    pairs: f64,
}

impl Away {
    fn new(lists: &Lists, all: &[u16], sites: &Range<usize>, costs: &Costs) -> Self {
        let mut away = Self { vectors: Vec::with_capacity(sites.len()), sum: 0.0, pairs: 0.0 };
        for site in sites.clone() {
            let mut vector = [0.0f32; 2];
            for &other in lists.of(site) {
                let [x, y] = costs.units[usize::from(all[other as usize])];
                vector[0] += x;
                vector[1] += y;
            }
            let [x, y] = costs.units[usize::from(all[site])];
            away.sum += f64::from(x * vector[0] + y * vector[1]);
            away.pairs += lists.of(site).len() as f64;
            away.vectors.push(vector);
        }
        away
    }

    /// The mean cosine.
    fn mean(&self) -> f64 {
        if self.pairs == 0.0 { 0.0 } else { self.sum / self.pairs }
    }

    /// By how much the sum changes when a tile's unit vector does. Pairs count from both ends, though one of them may
    /// lie in another patch: so does its own sum change.
    fn changes(&self, place: usize, [dx, dy]: [f32; 2]) -> f64 {
        let [x, y] = self.vectors[place];
        2.0 * f64::from(dx * x + dy * y)
    }

    /// By how much the square of the mean cosine grows when the sum does.
    fn grows(&self, by: f64) -> f64 {
        if self.pairs == 0.0 { 0.0 } else { by * (2.0 * self.sum + by) / (self.pairs * self.pairs) }
    }

    /// Takes note that the unit vector of a tile changed, around which these lie.
    fn turned(&mut self, around: &[u32], first: usize, [dx, dy]: [f32; 2]) {
        for &other in around {
            if let Some([x, y]) = self.vectors.get_mut((other as usize).wrapping_sub(first)) {
                *x += dx;
                *y += dy;
            }
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use proptest::prelude::*;

    use super::super::{bfs, directions};
    use super::*;
    use crate::pass::fixture::{canvas, paint};
    use crate::pass::link::link;
    use crate::pass::place::place;
    use crate::scene::{AngleRule, Limits, Link, Placement};
    use crate::stage::Sites;

    const KEY: Key<'_> = Key { seed: 3, name: "paint", purpose: "tune" };

    fn linked(count: usize, seed: u64) -> (Sites, Graph) {
        let canvas = canvas(50.0, 40.0);
        let key = Key { seed, name: "points", purpose: "test" };
        let mut stream = key.stream();
        let points = (0..count).map(|_| Point::new(stream.unit() * 50.0, stream.unit() * 40.0)).collect();
        let paint = paint(&canvas, Placement::Points(points), AngleRule::Random);
        let sites = place(&paint, &canvas, &Limits::default()).unwrap();
        let graph = link(&sites, Link::Delaunay);
        (sites, graph)
    }

    fn cost(graph: &Graph, sites: &Sites, seen: &[u8], rule: &Tuned, steps: &[u32]) -> f64 {
        let patches = Patches::new(&sites.points);
        let links = Links::new(graph, &patches, seen);
        let costs = Costs::new(rule, &links.offsets);
        let steps: Vec<u16> = patches.order.iter().map(|&site| steps[site as usize] as u16).collect();
        Stir { rule, patches: &patches, links: &links, costs: &costs, key: &KEY }.cost(&steps, &costs.links(1.0))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]

        #[test]
        fn tuning_never_costs_more_and_knows_no_threads(
            count in 0usize..600,
            seed: u64,
            weights in [0.0..3.0f64, 0.0..3.0, 0.0..3.0],
            rounds in 0u32..25,
            candidates in 2u32..400,
            layers in 0u8..=4,
        ) {
            let (sites, graph) = linked(count, seed);
            let seen: Vec<u8> = (0..count).map(|site| if site % 3 == 0 { layers } else { 1 }).collect();
            let [contrast, diversity, grain] = weights;
            let rule = Tuned { contrast, diversity, grain, rounds, candidates, ..Tuned::default() };
            let start = bfs::turn(&graph, candidates, &seen, &KEY);
            let on = |threads| {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                pool.install(|| tune(&graph, &sites.points, &seen, &rule, &start, &KEY, &Stop::default()))
            };
            let steps = on(1);
            prop_assert_eq!(&steps, &on(2));
            prop_assert!(steps.iter().all(|&step| step < candidates));
            let [before, after] = [&start, &steps].map(|steps| cost(&graph, &sites, &seen, &rule, steps));
            prop_assert!(after <= before, "{} {}", after, before);
            for angle in directions(steps, candidates, candidates - 1) {
                let step = angle.to_radians() / std::f64::consts::PI * f64::from(candidates);
                prop_assert!((step - step.round()).abs() < 1e-9 && (0.0..f64::from(candidates)).contains(&step));
            }
        }
    }

    #[test]
    fn patches_of_one_class_share_nothing() {
        let (sites, graph) = linked(3000, 1);
        let patches = Patches::new(&sites.points);
        let links = Links::new(&graph, &patches, &vec![1; 3000]);
        let around = links.around(&patches);
        let sizes: Vec<u32> = patches.starts.windows(2).map(|bounds| bounds[1] - bounds[0]).collect();
        assert!(sizes.iter().all(|size| (100..=128).contains(size)), "{sizes:?}");
        let mut order = patches.order.clone();
        order.sort_unstable();
        assert!(order.into_iter().eq(0..3000));
        for class in classes(&around) {
            for &a in &class {
                assert!(class.iter().all(|b| *b == a || !around[a as usize].contains(b)));
            }
        }
    }

    #[test]
    fn a_hub_takes_no_longer() {
        // Everything is two links away from everything.
        let edges: Vec<[u32; 2]> = (1..20_000).map(|site| [0, site]).collect();
        let graph = Graph::new(20_000, &edges, Vec::new());
        let points: Vec<Point> = (0..20_000).map(|i| Point::new(f64::from(i % 7), f64::from(i / 7))).collect();
        let rule = Tuned { rounds: 10, ..Tuned::default() };
        let seen = vec![1; 20_000];
        let start = bfs::turn(&graph, 360, &seen, &KEY);
        let steps = tune(&graph, &points, &seen, &rule, &start, &KEY, &Stop::default());
        assert!(steps[1..].iter().all(|&step| step != steps[0]));
    }
}
