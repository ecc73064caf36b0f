//! How alike tiles are turned, by their distance along the links.
//!
//! R_k is the mean of cos 2(phi_i - phi_j) over the pairs of tiles that are k links apart, for k from 1 to 15 or to the
//! greatest distance there is, if that is less. Tiles that no links join count for no k. The cosine is the product of
//! the unit vectors at twice the tiles' angles, so a breadth-first search from every tile adds up the vectors it meets at
//! each distance and multiplies once.
//!
//! From every tile is what is done while it is cheap. Where the links that all searches would look along are more than
//! [`LINKS_LOOKED_ALONG`], a sample of the tiles is searched from instead, drawn without replacement by the seed and the
//! paint's name; the error that comes of it is given beside each R_k. Neither the choice nor any sum depends on threads:
//! sources are taken in chunks of fixed size whose sums are added in order.

use std::cmp::Ordering;

use rayon::prelude::*;
use serde::Serialize;

use super::{Measured, Scalars};
use crate::random::Key;
use crate::stage::Graph;

/// The greatest distance looked at.
pub const REACH: usize = 15;

/// Links that all searches together may look along. Searches of [`REACH`] links on a triangulation look along 4,400, so
/// that some 240,000 tiles are searched from one and all; it takes about a second on one core.
const LINKS_LOOKED_ALONG: u64 = 1 << 30;

/// Searches that tell how far a search looks on the whole.
const PILOTS: usize = 64;

/// Sources whose sums are added up in sequence.
const CHUNK: usize = 256;

/// The names of R_1, R_2, … as single figures.
const NAMES: [&str; REACH] =
    ["r1", "r2", "r3", "r4", "r5", "r6", "r7", "r8", "r9", "r10", "r11", "r12", "r13", "r14", "r15"];

/// The correlation of angles at each distance along the links.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Correlogram {
    /// R_1, R_2, …, in [-1, 1], as far as there are pairs, and 15 at most.
    pub r: Vec<f64>,
    /// How many pairs of tiles stand behind each; their estimated number where sources are a sample.
    pub pairs: Vec<u64>,
    /// The standard error of each R_k against the one over all pairs, where sources are a sample.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub r_se: Option<Vec<f64>>,
    /// How many tiles were searched from, where those are a sample and not all.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sampled: Option<usize>,
}

impl Correlogram {
    /// The figures by their names: `r1` to `r15` whatever the greatest distance is, none beyond it, so that columns are
    /// the same for every pattern.
    #[must_use]
    pub fn scalars(&self) -> Scalars {
        let r = NAMES.iter().enumerate().map(|(k, &name)| (name.into(), self.r.get(k).copied()));
        r.chain([("sampled".into(), self.sampled.map(|sampled| sampled as f64))]).collect()
    }
}

/// Measures the correlogram.
#[must_use]
pub fn measure(measured: &Measured) -> Correlogram {
    within(measured, LINKS_LOOKED_ALONG)
}

/// Measures the correlogram, looking along so many links at most.
fn within(measured: &Measured, links: u64) -> Correlogram {
    let vectors: Vec<[f64; 2]> = measured
        .angles
        .iter()
        .map(|&angle| {
            let (sin, cos) = (angle * 2.0).sin_cos();
            [cos, sin]
        })
        .collect();
    let field = Field { graph: &measured.graph, vectors: &vectors };
    let tiles = vectors.len();
    let at_most = 2 * measured.graph.edges().count() as u64 * tiles as u64;
    let all = || (0..tiles as u32).collect::<Vec<u32>>();
    if at_most <= links {
        return field.sums(&all()).correlogram(tiles);
    }
    let key = Key { seed: measured.seed, name: &measured.name, purpose: "correlogram" };
    let mut sources = shuffled(tiles, key);
    let pilots = PILOTS.min(tiles);
    let looked = field.sums(&sources[..pilots]).looked.div_ceil(pilots as u64).max(1);
    let affordable = (links / looked).max(PILOTS as u64);
    if affordable >= tiles as u64 {
        return field.sums(&all()).correlogram(tiles);
    }
    sources.truncate(affordable as usize);
    // In their own order they lie closer together in memory.
    sources.sort_unstable();
    field.sums(&sources).correlogram(tiles)
}

/// All tiles in an order that the key draws (Fisher and Yates).
fn shuffled(tiles: usize, key: Key<'_>) -> Vec<u32> {
    let mut order: Vec<u32> = (0..tiles as u32).collect();
    let mut stream = key.stream();
    for i in 0..tiles {
        let j = i + stream.below((tiles - i) as u64) as usize;
        order.swap(i, j);
    }
    order
}

/// What is searched: the links, and the unit vector at twice the angle of each tile.
#[derive(Clone, Copy)]
struct Field<'a> {
    graph: &'a Graph,
    vectors: &'a [[f64; 2]],
}

impl Field<'_> {
    /// The sums over the searches from these tiles.
    fn sums(self, sources: &[u32]) -> Sums {
        let search = || Search { stamps: vec![0; self.vectors.len()], stamp: 0, met: Vec::new() };
        let chunk = |search: &mut Search, chunk: &[u32]| {
            let mut sums = Sums::default();
            for &source in chunk {
                search.from(self, source, &mut sums);
            }
            sums
        };
        // A small pattern is measured among many others that keep the cores busy.
        let chunks: Vec<Sums> = if sources.len() <= 4 * CHUNK {
            let mut search = search();
            sources.chunks(CHUNK).map(|sources| chunk(&mut search, sources)).collect()
        } else {
            sources.par_chunks(CHUNK).map_init(search, |search, sources| chunk(search, sources)).collect()
        };
        chunks.iter().fold(Sums::default(), |sum, chunk| sum.with(chunk))
    }
}

/// Breadth-first searches one after the other.
struct Search {
    /// The number of the search that met a tile last.
    stamps: Vec<u32>,
    /// The number of this search.
    stamp: u32,
    /// What this search has met, by distance.
    met: Vec<u32>,
}

impl Search {
    /// Searches from a tile and adds what it finds.
    fn from(&mut self, field: Field<'_>, source: u32, sums: &mut Sums) {
        self.stamp += 1;
        self.stamps[source as usize] = self.stamp;
        self.met.clear();
        self.met.push(source);
        sums.sources += 1;
        let [x, y] = field.vectors[source as usize];
        let mut start = 0;
        for at in &mut sums.at {
            let end = self.met.len();
            let [mut sum_x, mut sum_y] = [0.0; 2];
            for tile in start..end {
                let neighbours = field.graph.neighbours(self.met[tile] as usize);
                sums.looked += neighbours.len() as u64;
                for &other in neighbours {
                    if self.stamps[other as usize] != self.stamp {
                        self.stamps[other as usize] = self.stamp;
                        self.met.push(other);
                        let [other_x, other_y] = field.vectors[other as usize];
                        sum_x += other_x;
                        sum_y += other_y;
                    }
                }
            }
            if self.met.len() == end {
                break;
            }
            at.add(x * sum_x + y * sum_y, (self.met.len() - end) as u64);
            start = end;
        }
    }
}

/// Sums over searches.
#[derive(Debug, Clone, Default)]
struct Sums {
    /// How many searches there were.
    sources: usize,
    /// Along how many links they looked.
    looked: u64,
    at: [AtDistance; REACH],
}

/// Sums over searches of what they found at one distance: a is the sum of the cosines, n their number.
#[derive(Debug, Clone, Copy, Default)]
struct AtDistance {
    a: f64,
    n: u64,
    aa: f64,
    an: f64,
    nn: f64,
}

impl AtDistance {
    fn add(&mut self, a: f64, count: u64) {
        let n = count as f64;
        self.a += a;
        self.n += count;
        self.aa += a * a;
        self.an += a * n;
        self.nn += n * n;
    }
}

impl Sums {
    fn with(mut self, other: &Self) -> Self {
        self.sources += other.sources;
        self.looked += other.looked;
        for (sum, other) in self.at.iter_mut().zip(&other.at) {
            sum.a += other.a;
            sum.n += other.n;
            sum.aa += other.aa;
            sum.an += other.an;
            sum.nn += other.nn;
        }
        self
    }

    /// What follows for a pattern of so many tiles.
    fn correlogram(&self, tiles: usize) -> Correlogram {
        // A distance is reached through all lesser ones, so that the first without pairs ends the list.
        let at = || self.at.iter().take_while(|at| at.n > 0);
        // Every pair is met from both its ends.
        let r = at().map(|at| (at.a / at.n as f64).clamp(-1.0, 1.0)).collect();
        match self.sources.cmp(&tiles) {
            Ordering::Less => {
                let (m, all) = (self.sources as f64, tiles as f64);
                Correlogram {
                    r,
                    pairs: at().map(|at| (at.n as f64 * all / m / 2.0).round() as u64).collect(),
                    r_se: Some(at().map(|at| at.error(m, all)).collect()),
                    sampled: Some(self.sources),
                }
            }
            Ordering::Equal | Ordering::Greater => {
                Correlogram { r, pairs: at().map(|at| at.n / 2).collect(), r_se: None, sampled: None }
            }
        }
    }
}

impl AtDistance {
    /// The standard error of the ratio of two sums over m sources drawn from all without replacement (Cochran 1977,
    /// Sampling Techniques, section 6.3).
    fn error(&self, m: f64, all: f64) -> f64 {
        let n = self.n as f64;
        let ratio = self.a / n;
        let residuals = (self.aa - 2.0 * ratio * self.an + ratio * ratio * self.nn).max(0.0);
        let mean = n / m;
        ((1.0 - m / all) * residuals / (m - 1.0) / m).sqrt() / mean
    }
}
