//! Coloured turning: a few directions, equal steps apart, of which no two neighbours have the same.
//!
//! Sites are coloured in the order of saturation (Brélaz, CACM 1979): next comes the one whose neighbours have the most
//! colours already, so that what is forced comes first; graphs that two colours suffice for, and triangulations that three
//! suffice for, are coloured without a mistake. Where all colours are taken, the site is left over. Afterwards every
//! left-over site is repaired: two colours are exchanged along a Kempe chain (Kempe, 1879) so that one of them becomes free
//! around the site; where no short chain does it, the site takes the colour that fewest of its neighbours have and those
//! are left over in its stead, a walk that soon comes to a place where a colour is free. Every planar graph has a
//! colouring in four colours (Appel and Haken, 1977), and in practice the walk finds one; on a torus up to seven may be
//! needed, and with two or three colours most graphs have none: what is left when the effort is spent takes the colour that
//! fewest neighbours have.

use std::collections::VecDeque;

use crate::random::{Key, Stream};
use crate::stage::Graph;

/// A site that has no colour yet.
const NONE: u8 = u8::MAX;

/// The most sites of a chain that is exchanged.
const LONGEST_CHAIN: usize = 512;

/// Steps of repair for every site of the graph, and at least.
const STEPS_A_SITE: usize = 40;
const STEPS: usize = 100_000;

/// Of so many steps of a walk one goes astray, so that none goes round in a circle.
const ASTRAY: u64 = 16;

/// A colour below `colours`, 2 to 12, for every site. Random draws are of the key's stream.
pub(super) fn colours(graph: &Graph, colours: u32, key: &Key<'_>) -> Vec<u32> {
    let mut palette = Palette::new(graph, colours as u8);
    let left = palette.saturate();
    let left = palette.repair(left, &mut key.stream());
    for site in left {
        palette.of[site as usize] = palette.rarest(site);
    }
    palette.balance();
    palette.of.into_iter().map(u32::from).collect()
}

/// Colours while they are found.
struct Palette<'a> {
    graph: &'a Graph,
    colours: u8,
    of: Vec<u8>,
    /// How many sites have each colour.
    counts: Vec<usize>,
    /// For walks through chains: the number of the last walk that saw a site.
    seen: Vec<u32>,
    walk: u32,
}

impl<'a> Palette<'a> {
    fn new(graph: &'a Graph, colours: u8) -> Self {
        let (of, seen) = (vec![NONE; graph.len()], vec![0; graph.len()]);
        Self { graph, colours, of, counts: vec![0; usize::from(colours)], seen, walk: 0 }
    }

    /// How many neighbours of a site have each colour.
    fn around(&self, site: u32) -> [u32; 16] {
        let mut around = [0; 16];
        for &other in self.graph.neighbours(site as usize) {
            let colour = self.of[other as usize];
            if colour != NONE {
                around[usize::from(colour)] += 1;
            }
        }
        around
    }

    fn give(&mut self, site: u32, colour: u8) {
        self.of[site as usize] = colour;
        self.counts[usize::from(colour)] += 1;
    }

    /// Of the colours that no neighbour has, one that lies as far as can be from theirs, of those the one that fewest sites
    /// have.
    fn free(&self, around: &[u32; 16]) -> Option<u8> {
        let n = self.colours;
        let apart = |a: u8, b: u8| a.abs_diff(b).min(n - a.abs_diff(b));
        let taken = || (0..n).filter(|&colour| around[usize::from(colour)] > 0);
        let least = |colour: u8| taken().map(|other| apart(colour, other)).min().unwrap_or(0);
        let free = (0..n).filter(|&colour| around[usize::from(colour)] == 0);
        // Four directions lie equally well in all their proper arrangements; they are only to be used evenly.
        let spread = |colour: u8| if n > 4 { least(colour) } else { 0 };
        free.min_by_key(|&colour| (n - spread(colour), self.counts[usize::from(colour)], colour))
    }

    /// The colour that fewest neighbours of a site have.
    fn rarest(&self, site: u32) -> u8 {
        let around = self.around(site);
        (0..self.colours).min_by_key(|&colour| (around[usize::from(colour)], colour)).unwrap_or(0)
    }

    /// Colours sites in the order of saturation. Returns those for which no colour was left.
    fn saturate(&mut self) -> Vec<u32> {
        let colours = usize::from(self.colours);
        let mut saturation = vec![0u16; self.graph.len()];
        let mut waiting: Vec<VecDeque<u32>> = vec![VecDeque::new(); colours];
        let mut left = Vec::new();
        // Parts that are not joined begin in order.
        for root in 0..self.graph.len() as u32 {
            if self.of[root as usize] != NONE || saturation[root as usize] != 0 {
                continue;
            }
            waiting[0].push_back(root);
            while let Some(level) = (0..colours).rev().find(|&level| !waiting[level].is_empty()) {
                let Some(site) = waiting[level].pop_front() else { continue };
                // Sites wait on every level that they come through.
                let is_there = saturation[site as usize].count_ones() as usize == level;
                if self.of[site as usize] != NONE || !is_there {
                    continue;
                }
                let Some(colour) = self.free(&self.around(site)) else { continue };
                self.give(site, colour);
                for &other in self.graph.neighbours(site as usize) {
                    let there = &mut saturation[other as usize];
                    let before = there.count_ones();
                    *there |= 1 << colour;
                    if self.of[other as usize] != NONE || there.count_ones() == before {
                        continue;
                    }
                    match waiting.get_mut(before as usize + 1) {
                        Some(level) => level.push_back(other),
                        None => left.push(other),
                    }
                }
            }
        }
        left
    }

    /// Finds colours for sites that have none. Returns those for which the effort did not suffice.
    fn repair(&mut self, mut left: Vec<u32>, stream: &mut Stream) -> Vec<u32> {
        let mut effort = self.graph.len() * STEPS_A_SITE + STEPS;
        while let Some(site) = left.pop() {
            if self.of[site as usize] != NONE {
                continue;
            }
            let around = self.around(site);
            if let Some(colour) = self.free(&around) {
                self.give(site, colour);
                continue;
            }
            if effort == 0 {
                left.push(site);
                return left;
            }
            effort = effort.saturating_sub(1 + self.graph.neighbours(site as usize).len() / 16);
            if let Some(colour) = self.exchange(site, &around, &mut effort) {
                self.give(site, colour);
                continue;
            }
            // The site pushes out the fewest neighbours, now and then any.
            let any = stream.below(u64::from(self.colours) * ASTRAY);
            let colour = match u8::try_from(any).ok().filter(|&any| any < self.colours) {
                Some(any) => any,
                None => {
                    let fewest = (0..usize::from(self.colours)).map(|colour| around[colour]).min().unwrap_or(0);
                    let rare: Vec<u8> = (0..self.colours).filter(|&c| around[usize::from(c)] == fewest).collect();
                    rare[stream.below(rare.len() as u64) as usize]
                }
            };
            for &other in self.graph.neighbours(site as usize) {
                if self.of[other as usize] == colour {
                    self.of[other as usize] = NONE;
                    self.counts[usize::from(colour)] -= 1;
                    left.push(other);
                }
            }
            self.give(site, colour);
        }
        left
    }

    /// Frees a colour around a site by exchanging it for another along short chains, if that can be done. `effort` pays
    /// for the sites that are looked at.
    fn exchange(&mut self, site: u32, around: &[u32; 16], effort: &mut usize) -> Option<u8> {
        for a in 0..self.colours {
            for b in (0..self.colours).filter(|&b| b != a) {
                // What is to be exchanged grows with the neighbours of that colour; others get their chance as `b`.
                if around[usize::from(a)] > around[usize::from(b)] {
                    continue;
                }
                let ends = self.graph.neighbours(site as usize).iter().copied();
                let starts: Vec<u32> = ends.filter(|&other| self.of[other as usize] == a).collect();
                let chain = self.chain(&starts, b, site);
                *effort = effort.saturating_sub(chain.as_ref().map_or(LONGEST_CHAIN, Vec::len) / 16);
                if let Some(chain) = chain {
                    for member in chain {
                        let before = self.of[member as usize];
                        self.counts[usize::from(before)] -= 1;
                        self.give(member, if before == a { b } else { a });
                    }
                    return Some(a);
                }
            }
        }
        None
    }

    /// The chains of the starts' colour and another, unless they are long or come to a neighbour of the site in the other
    /// colour.
    fn chain(&mut self, starts: &[u32], other: u8, site: u32) -> Option<Vec<u32>> {
        self.walk += 1;
        let mut chain: Vec<u32> = starts.to_vec();
        let colour = self.of[*chain.first()? as usize];
        for &start in starts {
            self.seen[start as usize] = self.walk;
        }
        let mut next = 0;
        while let Some(&member) = chain.get(next) {
            next += 1;
            for &neighbour in self.graph.neighbours(member as usize) {
                let there = self.of[neighbour as usize];
                if (there == colour || there == other) && self.seen[neighbour as usize] != self.walk {
                    let is_round =
                        there == other && self.graph.neighbours(neighbour as usize).binary_search(&site).is_ok();
                    if is_round || chain.len() >= LONGEST_CHAIN {
                        return None;
                    }
                    self.seen[neighbour as usize] = self.walk;
                    chain.push(neighbour);
                }
            }
        }
        Some(chain)
    }

    /// Exchanges colours along whole chains where that makes two colours more alike in number.
    fn balance(&mut self) {
        self.counts.fill(0);
        for &colour in &self.of {
            self.counts[usize::from(colour)] += 1;
        }
        for a in 0..self.colours {
            for b in a + 1..self.colours {
                self.walk += 1;
                for root in 0..self.graph.len() as u32 {
                    self.even_out(root, [a, b]);
                }
            }
        }
    }

    /// Exchanges two colours along the chain of a site that was not seen in this walk, if it brings their numbers nearer.
    fn even_out(&mut self, root: u32, [a, b]: [u8; 2]) {
        let is_in = |colour: u8| colour == a || colour == b;
        if self.seen[root as usize] == self.walk || !is_in(self.of[root as usize]) {
            return;
        }
        self.seen[root as usize] = self.walk;
        let mut chain = vec![root];
        let mut next = 0;
        while let Some(&member) = chain.get(next) {
            next += 1;
            for &neighbour in self.graph.neighbours(member as usize) {
                if is_in(self.of[neighbour as usize]) && self.seen[neighbour as usize] != self.walk {
                    self.seen[neighbour as usize] = self.walk;
                    chain.push(neighbour);
                }
            }
        }
        let of_a = chain.iter().filter(|&&member| self.of[member as usize] == a).count();
        let [has_a, has_b] = [a, b].map(|colour| self.counts[usize::from(colour)]);
        let [then_a, then_b] = [has_a - of_a + (chain.len() - of_a), has_b - (chain.len() - of_a) + of_a];
        if then_a.abs_diff(then_b) < has_a.abs_diff(has_b) {
            for &member in &chain {
                self.of[member as usize] = if self.of[member as usize] == a { b } else { a };
            }
            self.counts[usize::from(a)] = then_a;
            self.counts[usize::from(b)] = then_b;
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::geom::{Length, Period, Point};
    use crate::pass::fixture::{canvas, paint};
    use crate::pass::link::link;
    use crate::pass::place::place;
    use crate::scene::{AngleRule, Canvas, GridSize, Limits, Link, Placement, Repeat, Shape};

    const KEY: Key<'_> = Key { seed: 3, name: "paint", purpose: "angle" };

    fn linked(canvas: &Canvas, placement: Placement, links: Link) -> Graph {
        let mut paint = paint(canvas, placement, AngleRule::Random);
        paint.tone.link = links;
        if links == Link::Edges {
            paint.tone.shape = Shape::Cell { inset: Length::ZERO };
        }
        link(&place(&paint, canvas, &Limits::default()).unwrap(), links)
    }

    fn alike(graph: &Graph, colours: &[u32]) -> usize {
        graph.edges().filter(|&[a, b]| colours[a as usize] == colours[b as usize]).count()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(48))]

        #[test]
        fn four_colours_suffice_for_points_anywhere(
            points in proptest::collection::vec((0u16..1000, 0u16..1000), 0..400),
            lattice in 1u16..40,
            most in 4u32..=12,
        ) {
            // Coarse lattices make many ties and hubs.
            let point = |(x, y): (u16, u16)| {
                Point::new(f64::from(x - x % lattice) / 20.0, f64::from(y - y % lattice) / 20.0)
            };
            let points = points.into_iter().map(point).collect();
            let graph = linked(&canvas(50.0, 50.0), Placement::Points(points), Link::Delaunay);
            for count in [4, most] {
                let colours = colours(&graph, count, &KEY);
                prop_assert!(colours.iter().all(|&colour| colour < count));
                prop_assert_eq!(alike(&graph, &colours), 0);
            }
        }
    }

    #[test]
    fn lattices_take_as_few_as_they_can() {
        let canvas = canvas(60.0, 50.0);
        let edge = Length::mm(1.3);
        let cells = || Placement::Grid(GridSize::Cells { columns: 31, rows: 24 });
        let cases = [
            (cells(), Link::Edges, 2),
            (Placement::Triangles { edge }, Link::Edges, 2),
            (Placement::Penrose { edge }, Link::Edges, 3),
            (Placement::Pinwheel { edge }, Link::Edges, 4),
            (cells(), Link::Delaunay, 4),
        ];
        for (placement, links, enough) in cases {
            let graph = linked(&canvas, placement, links);
            let colours = colours(&graph, enough, &KEY);
            assert_eq!(alike(&graph, &colours), 0, "{enough} colours");
        }
    }

    #[test]
    fn hexagons_take_three_but_where_rows_end() {
        let spacing = Length::mm(1.3);
        let paint = paint(&canvas(60.0, 50.0), Placement::Hex { spacing }, AngleRule::Random);
        let sites = place(&paint, &canvas(60.0, 50.0), &Limits::default()).unwrap();
        let graph = link(&sites, Link::Delaunay);
        let colours = colours(&graph, 3, &KEY);
        // Slivers along the outline join every second row, whose ends would be of one colour: those give way, and nothing
        // further in does.
        let alike: Vec<_> = graph.edges().filter(|&[a, b]| colours[a as usize] == colours[b as usize]).collect();
        let is_inside = |site: u32| {
            let (p, margin) = (sites.points[site as usize], 2.0 * spacing.to_mm());
            (margin..60.0 - margin).contains(&p.x) && (margin..50.0 - margin).contains(&p.y)
        };
        assert!(!alike.is_empty());
        assert!(!alike.into_iter().flatten().any(is_inside));
    }

    #[test]
    fn colours_are_used_evenly() {
        let uniform = Placement::Poisson { radius: Length::mm(0.5), tries: 30, density: None };
        let graph = linked(&canvas(40.0, 40.0), uniform, Link::Delaunay);
        let colours = colours(&graph, 4, &KEY);
        assert_eq!(alike(&graph, &colours), 0);
        for colour in 0..4 {
            let share = colours.iter().filter(|&&c| c == colour).count() as f64 / graph.len() as f64;
            assert!((share - 0.25).abs() < 0.01, "{share}");
        }
    }

    #[test]
    fn a_torus_is_coloured_too() {
        let canvas = Canvas { repeat: Repeat::Both, ..canvas(30.0, 20.0) };
        let placement = Placement::Poisson { radius: Length::mm(0.8), tries: 30, density: None };
        let graph = linked(&canvas, placement, Link::Delaunay);
        assert_eq!(canvas.period(), Some(Period::new(canvas.width, canvas.height)));
        assert_eq!(alike(&graph, &colours(&graph, 4, &KEY)), 0);
    }

    #[test]
    fn what_cannot_be_coloured_stays_alike_in_few_places() {
        // Seven sites of which every two are neighbours, as they can be on a torus.
        let edges: Vec<[u32; 2]> = (0..7).flat_map(|a| (a + 1..7).map(move |b| [a, b])).collect();
        let graph = Graph::new(7, &edges, Vec::new());
        assert_eq!(alike(&graph, &colours(&graph, 7, &KEY)), 0);
        assert_eq!(alike(&graph, &colours(&graph, 6, &KEY)), 1);
        let poisson = Placement::Poisson { radius: Length::mm(1.0), tries: 30, density: None };
        let graph = linked(&canvas(20.0, 20.0), poisson, Link::Delaunay);
        let alike = alike(&graph, &colours(&graph, 3, &KEY)) as f64;
        assert!(alike < graph.edges().count() as f64 * 0.12);
    }
}
