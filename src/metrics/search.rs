//! Breadth-first searches that add up what they meet at every distance.
//!
//! In: the links, and for every tile the unit vector at twice its angle. Out: [`Sums`]. Searches from all tiles are done 64
//! at once, a bit of a word each, from tiles that lie near each other (Then et al., The More the Merrier, VLDB 2014):
//! they meet the same tiles, so that a link is looked along once for many of them. Searches from a few tiles are done one
//! by one, since their spread over the sources is asked for as well. Sums are made in chunks of fixed size and added up in
//! order, so that they do not depend on threads.

use rayon::prelude::*;

use crate::geom::{Point, hilbert};
use crate::stage::Graph;

/// The greatest distance looked at.
pub const REACH: usize = 15;

/// Searches done at once.
const BATCH: usize = 64;

/// Batches whose sums are added up in sequence.
const BATCHES: usize = 8;

/// Single searches whose sums are added up in sequence.
const SINGLES: usize = 128;

/// Tiles below which one thread does it all: small patterns are measured among many others that keep the cores busy.
const SMALL: usize = 2048;

/// Sums over searches.
#[derive(Debug, Clone, Default)]
pub(super) struct Sums {
    /// How many searches there were.
    pub(super) sources: usize,
    /// Along how many links single searches looked.
    pub(super) looked: u64,
    /// What they found at the distances 1, 2, …
    pub(super) at: [AtDistance; REACH],
}

/// Sums over searches of what they found at one distance: a is the sum of the cosines between source and tile, n their
/// number. Sums of squares are those of single searches only.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct AtDistance {
    pub(super) a: f64,
    pub(super) n: u64,
    pub(super) aa: f64,
    pub(super) an: f64,
    pub(super) nn: f64,
}

impl Sums {
    /// The sum of sums, in their order.
    fn all(sums: &[Self]) -> Self {
        sums.iter().fold(Self::default(), |mut sum, other| {
            sum.sources += other.sources;
            sum.looked += other.looked;
            for (sum, other) in sum.at.iter_mut().zip(&other.at) {
                sum.a += other.a;
                sum.n += other.n;
                sum.aa += other.aa;
                sum.an += other.an;
                sum.nn += other.nn;
            }
            sum
        })
    }
}

/// What is searched: links and vectors, numbered along Hilbert's curve, so that what lies near on the page does in memory.
pub(super) struct Field {
    /// Where the neighbours of every tile start in `neighbours`; one more than there are tiles.
    offsets: Vec<u32>,
    neighbours: Vec<u32>,
    vectors: Vec<[f64; 2]>,
    /// The number of every tile here.
    numbers: Vec<u32>,
}

impl Field {
    /// From the tiles' places, links and vectors.
    pub(super) fn new(sites: &[Point], graph: &Graph, vectors: &[[f64; 2]]) -> Self {
        let order = hilbert::order(sites);
        let mut numbers = vec![0; order.len()];
        for (number, &tile) in (0u32..).zip(&order) {
            numbers[tile as usize] = number;
        }
        let mut offsets = Vec::with_capacity(order.len() + 1);
        let mut neighbours = Vec::new();
        offsets.push(0);
        for &tile in &order {
            neighbours.extend(graph.neighbours(tile as usize).iter().map(|&other| numbers[other as usize]));
            offsets.push(neighbours.len() as u32);
        }
        let vectors = order.iter().map(|&tile| vectors[tile as usize]).collect();
        Self { offsets, neighbours, vectors, numbers }
    }

    /// How many tiles there are.
    pub(super) fn len(&self) -> usize {
        self.vectors.len()
    }

    /// How many links there are, each counted from both its ends.
    pub(super) fn links(&self) -> u64 {
        self.neighbours.len() as u64
    }

    fn neighbours(&self, tile: u32) -> &[u32] {
        &self.neighbours[self.offsets[tile as usize] as usize..self.offsets[tile as usize + 1] as usize]
    }

    /// The sums over the searches from all tiles, without those of squares and without the links looked along.
    pub(super) fn search_all(&self) -> Sums {
        let batches: Vec<u32> = (0..self.len().div_ceil(BATCH) as u32).collect();
        let new = || Batch { met: vec![0; self.len()], next: vec![0; self.len()], ..Batch::default() };
        let search = |batch: &mut Batch, numbers: &[u32]| {
            let mut sums = Sums::default();
            for &number in numbers {
                batch.search(self, number as usize * BATCH, &mut sums);
            }
            sums
        };
        if self.len() < SMALL {
            let mut batch = new();
            let sums: Vec<Sums> = batches.chunks(BATCHES).map(|numbers| search(&mut batch, numbers)).collect();
            return Sums::all(&sums);
        }
        let sums: Vec<Sums> =
            batches.par_chunks(BATCHES).map_init(new, |batch, numbers| search(batch, numbers)).collect();
        Sums::all(&sums)
    }

    /// The sums over the searches from these tiles, one by one. Sources are visited in the order in which they lie.
    pub(super) fn search_each(&self, tiles: &[u32]) -> Sums {
        let mut sources: Vec<u32> = tiles.iter().map(|&tile| self.numbers[tile as usize]).collect();
        sources.sort_unstable();
        let new = || Single { stamps: vec![0; self.len()], ..Single::default() };
        let sums: Vec<Sums> = sources
            .par_chunks(SINGLES)
            .map_init(new, |single, sources| {
                let mut sums = Sums::default();
                for &source in sources {
                    single.search(self, source, &mut sums);
                }
                sums
            })
            .collect();
        Sums::all(&sums)
    }
}

/// Searches from up to 64 tiles at once.
#[derive(Default)]
struct Batch {
    /// For every tile the searches that have met it.
    met: Vec<u64>,
    /// For every tile those that look at it now.
    next: Vec<u64>,
    /// Tiles that any search looks at now.
    looked_at: Vec<u32>,
    /// Tiles met for the first time at the last distance, and by which searches.
    front: Vec<(u32, u64)>,
    /// Tiles that any search has met.
    all: Vec<u32>,
}

impl Batch {
    /// Searches from the 64 tiles after a first one, or what is left of them, and adds what is found.
    fn search(&mut self, field: &Field, first: usize, sums: &mut Sums) {
        let sources = &field.vectors[first..field.len().min(first + BATCH)];
        sums.sources += sources.len();
        self.front.clear();
        for bit in 0..sources.len() {
            let tile = first + bit;
            self.met[tile] = 1 << bit;
            self.all.push(tile as u32);
            self.front.push((tile as u32, 1 << bit));
        }
        for at in &mut sums.at {
            for &(tile, searches) in &self.front {
                for &other in field.neighbours(tile) {
                    let next = &mut self.next[other as usize];
                    if *next == 0 {
                        self.looked_at.push(other);
                    }
                    *next |= searches;
                }
            }
            self.front.clear();
            for tile in self.looked_at.drain(..) {
                let met = &mut self.met[tile as usize];
                let new = std::mem::take(&mut self.next[tile as usize]) & !*met;
                if new == 0 {
                    continue;
                }
                if *met == 0 {
                    self.all.push(tile);
                }
                *met |= new;
                self.front.push((tile, new));
                // Pairs with tiles of earlier batches were met from there, and stand for both their ends.
                let ends = match (tile as usize).checked_sub(first) {
                    None => continue,
                    Some(after) if after < BATCH => 1,
                    Some(_) => 2,
                };
                let mut sum = [0.0; 2];
                let mut left = new;
                while left != 0 {
                    let [x, y] = sources[left.trailing_zeros() as usize];
                    sum[0] += x;
                    sum[1] += y;
                    left &= left - 1;
                }
                let [x, y] = field.vectors[tile as usize];
                at.a += f64::from(ends) * (x * sum[0] + y * sum[1]);
                at.n += u64::from(ends * new.count_ones());
            }
            if self.front.is_empty() {
                break;
            }
        }
        for tile in self.all.drain(..) {
            self.met[tile as usize] = 0;
        }
    }
}

/// Searches from one tile after the other.
#[derive(Default)]
struct Single {
    /// The number of the search that met a tile last.
    stamps: Vec<u32>,
    /// The number of this search.
    stamp: u32,
    /// What this search has met, by distance.
    met: Vec<u32>,
}

impl Single {
    /// Searches from a tile and adds what it finds.
    fn search(&mut self, field: &Field, source: u32, sums: &mut Sums) {
        self.stamp += 1;
        self.stamps[source as usize] = self.stamp;
        self.met.clear();
        self.met.push(source);
        sums.sources += 1;
        let [x, y] = field.vectors[source as usize];
        let mut start = 0;
        for at in &mut sums.at {
            let end = self.met.len();
            let mut sum = [0.0; 2];
            for tile in start..end {
                let neighbours = field.neighbours(self.met[tile]);
                sums.looked += neighbours.len() as u64;
                for &other in neighbours {
                    if self.stamps[other as usize] != self.stamp {
                        self.stamps[other as usize] = self.stamp;
                        self.met.push(other);
                        let [x, y] = field.vectors[other as usize];
                        sum[0] += x;
                        sum[1] += y;
                    }
                }
            }
            if self.met.len() == end {
                break;
            }
            let (a, n) = (x * sum[0] + y * sum[1], (self.met.len() - end) as f64);
            at.a += a;
            at.n += n as u64;
            at.aa += a * a;
            at.an += a * n;
            at.nn += n * n;
            start = end;
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Places, links and vectors.
    type Pattern = (Vec<Point>, Graph, Vec<[f64; 2]>);

    /// Tiles strewn on a page, and links among them, few enough that some tiles are reached from nowhere.
    fn patterns() -> impl Strategy<Value = Pattern> {
        let tiles = proptest::collection::vec((0.0..10.0, 0.0..10.0, 0.0..6.0f64), 1..150);
        let links = proptest::collection::vec((any::<prop::sample::Index>(), any::<prop::sample::Index>()), 0..250);
        (tiles, links).prop_map(|(tiles, links)| {
            let mut edges: Vec<[u32; 2]> = links
                .into_iter()
                .map(|(a, b)| [a, b].map(|end| end.index(tiles.len()) as u32))
                .filter(|[a, b]| a != b)
                .map(|[a, b]| [a.min(b), a.max(b)])
                .collect();
            edges.sort_unstable();
            edges.dedup();
            let sites = tiles.iter().map(|&(x, y, _)| Point::new(x, y)).collect();
            let vectors = tiles.iter().map(|&(_, _, turn)| [libm::cos(turn), libm::sin(turn)]).collect();
            (sites, Graph::new(tiles.len(), &edges, Vec::new()), vectors)
        })
    }

    /// The same by the distances between all pairs (Floyd and Warshall).
    fn by_pairs((_, graph, vectors): &Pattern) -> [(f64, u64); REACH] {
        let tiles = vectors.len();
        let mut distances = vec![vec![usize::MAX / 2; tiles]; tiles];
        for [a, b] in graph.edges().map(|edge| edge.map(|end| end as usize)) {
            (distances[a][b], distances[b][a]) = (1, 1);
        }
        for through in 0..tiles {
            for a in 0..tiles {
                for b in 0..tiles {
                    distances[a][b] = distances[a][b].min(distances[a][through] + distances[through][b]);
                }
            }
        }
        let mut sums = [(0.0, 0); REACH];
        for a in 0..tiles {
            for b in (0..tiles).filter(|&b| a != b) {
                if let Some(sum) = sums.get_mut(distances[a][b] - 1) {
                    sum.0 += vectors[a][0] * vectors[b][0] + vectors[a][1] * vectors[b][1];
                    sum.1 += 1;
                }
            }
        }
        sums
    }

    proptest! {
        #[test]
        fn searches_meet_what_lies_at_each_distance(pattern in patterns()) {
            let (sites, graph, vectors) = &pattern;
            let field = Field::new(sites, graph, vectors);
            let tiles: Vec<u32> = (0..vectors.len() as u32).collect();
            for sums in [field.search_all(), field.search_each(&tiles)] {
                prop_assert_eq!(sums.sources, tiles.len());
                for (at, (a, n)) in sums.at.iter().zip(by_pairs(&pattern)) {
                    prop_assert_eq!(at.n, n);
                    prop_assert!((at.a - a).abs() < 1e-9, "{} {}", at.a, a);
                }
            }
        }
    }
}
