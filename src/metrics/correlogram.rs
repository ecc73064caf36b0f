//! How alike tiles are turned, by their distance along the links.
//!
//! R_k is the mean of cos 2(phi_i - phi_j) over the pairs of tiles that are k links apart, for k from 1 to 15 or to the
//! greatest distance there is, if that is less. Tiles that no links join count for no k. The cosine is the product of
//! the unit vectors at twice the tiles' angles, so a breadth-first search from every tile adds up the vectors it meets at
//! each distance and multiplies once.
//!
//! All tiles are searched from while that is cheap. Where all searches would look along more than 2^32 links, a
//! sample of the tiles is searched from instead, drawn without replacement by the seed and the paint's name, and the
//! error that comes of it is given beside each R_k.

use serde::Serialize;

pub use super::search::REACH;
use super::search::{AtDistance, Field, Sums};
use super::{Measured, Scalars};
use crate::random::Key;

/// Links that searches from all tiles may look along. A search of [`REACH`] links on a triangulation looks along some 5,000, so
/// that nearly a million tiles are searched from one and all.
const LINKS: u64 = 1 << 32;

/// Links that searches from a sample may look along: some 12,000 searches on a triangulation.
const LINKS_OF_SAMPLE: u64 = 1 << 26;

/// Searches that tell how far a search looks on the whole, and the least that a sample has.
const PILOTS: usize = 64;

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
    within(measured, LINKS, LINKS_OF_SAMPLE)
}

/// Measures the correlogram, looking along so many links from all tiles or from a sample.
fn within(measured: &Measured, all: u64, sample: u64) -> Correlogram {
    let vectors: Vec<[f64; 2]> = measured
        .angles
        .iter()
        .map(|&angle| {
            let (sin, cos) = (angle * 2.0).sin_cos();
            [cos, sin]
        })
        .collect();
    let field = Field::new(&measured.sites, &measured.graph, &vectors);
    let tiles = field.len();
    if field.links() * tiles as u64 <= all {
        return correlogram(&field.search_all(), tiles);
    }
    let key = Key { seed: measured.seed, name: &measured.name, purpose: "correlogram" };
    let mut sources = shuffled(tiles, key);
    let pilots = PILOTS.min(tiles);
    let looked = field.search_each(&sources[..pilots]).looked.div_ceil(pilots as u64).max(1);
    if looked * tiles as u64 <= all {
        return correlogram(&field.search_all(), tiles);
    }
    sources.truncate((sample / looked).max(PILOTS as u64) as usize);
    correlogram(&field.search_each(&sources), tiles)
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

/// What follows for a pattern of so many tiles.
fn correlogram(sums: &Sums, tiles: usize) -> Correlogram {
    // A distance is reached through all lesser ones, so that the first without pairs ends the list.
    let at = || sums.at.iter().take_while(|at| at.n > 0);
    // Every pair is met from both its ends.
    let r = at().map(|at| (at.a / at.n as f64).clamp(-1.0, 1.0)).collect();
    if sums.sources == tiles {
        return Correlogram { r, pairs: at().map(|at| at.n / 2).collect(), r_se: None, sampled: None };
    }
    let (m, all) = (sums.sources as f64, tiles as f64);
    Correlogram {
        r,
        pairs: at().map(|at| (at.n as f64 * all / m / 2.0).round() as u64).collect(),
        r_se: Some(at().map(|at| error(at, m, all)).collect()),
        sampled: Some(sums.sources),
    }
}

/// The standard error of the ratio of two sums over m sources drawn from all without replacement (Cochran 1977, Sampling
/// Techniques, section 6.3).
fn error(at: &AtDistance, m: f64, all: f64) -> f64 {
    let n = at.n as f64;
    let ratio = at.a / n;
    let residuals = (at.aa - 2.0 * ratio * at.an + ratio * ratio * at.nn).max(0.0);
    ((1.0 - m / all) * residuals / (m - 1.0) / m).sqrt() / (n / m)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::{Angle, Point};

    /// Rows and columns of tiles, linked to those beside and below, and turned by what a function makes of column and row.
    fn grid(columns: u32, rows: u32, angle: impl Fn(u32, u32) -> f64) -> Measured {
        let cells = || (0..rows).flat_map(|y| (0..columns).map(move |x| (x, y)));
        let edges: Vec<[u32; 2]> = cells()
            .flat_map(|(x, y)| {
                let tile = y * columns + x;
                let beside = (x + 1 < columns).then_some([tile, tile + 1]);
                let below = (y + 1 < rows).then_some([tile, tile + columns]);
                beside.into_iter().chain(below)
            })
            .collect();
        Measured::of_squares(
            [f64::from(columns), f64::from(rows)],
            cells().map(|(x, y)| Point::new(f64::from(x) + 0.5, f64::from(y) + 0.5)).collect(),
            &edges,
            cells().map(|(x, y)| Angle::degrees(angle(x, y))).collect(),
            0.9,
        )
    }

    fn waves(x: u32, y: u32) -> f64 {
        f64::from((x * x + 3 * y * x + 7 * y) % 180)
    }

    #[test]
    fn a_board_of_two_directions_alternates() {
        let correlogram = measure(&grid(5, 3, |x, y| f64::from((x + y) % 2) * 90.0));
        assert_eq!(correlogram.r.len(), 6);
        for (r, k) in correlogram.r.iter().zip(1..) {
            let expected = if k % 2 == 0 { 1.0 } else { -1.0 };
            assert!((r - expected).abs() < 1e-12, "{k}: {r}");
        }
        // So many pairs are one step apart, and the corners six.
        assert_eq!((correlogram.pairs[0], correlogram.pairs[5]), (22, 2));
        assert_eq!(correlogram.pairs.iter().sum::<u64>(), 15 * 14 / 2);
    }

    #[test]
    fn columns_are_the_same_for_every_pattern() {
        let [few, many] = [grid(2, 1, waves), grid(20, 20, waves)].map(|measured| measure(&measured).scalars());
        let names = |scalars: &Scalars| scalars.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>();
        assert_eq!(names(&few), names(&many));
        assert_eq!(few.iter().filter(|(_, value)| value.is_some()).count(), 1);
        assert_eq!(many.iter().filter(|(_, value)| value.is_some()).count(), REACH);
    }

    #[test]
    fn nothing_is_said_of_tiles_without_links() {
        assert_eq!(measure(&grid(1, 1, waves)), Correlogram::default());
        assert_eq!(measure(&grid(0, 0, waves)), Correlogram::default());
    }

    #[test]
    fn threads_change_no_bit() {
        let measured = grid(60, 60, waves);
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| (within(&measured, u64::MAX, u64::MAX), within(&measured, 0, 1 << 18)))
        };
        assert_eq!(on(1), on(4));
    }

    #[test]
    fn a_sample_says_how_far_it_is_off() {
        let mut measured = grid(50, 50, waves);
        let exact = measure(&measured);
        let mut squares = 0.0;
        for seed in 0..20 {
            measured.seed = seed;
            let sample = within(&measured, 0, 1 << 19);
            let (errors, sampled) = (sample.r_se.unwrap(), sample.sampled.unwrap());
            assert!((200..2500).contains(&sampled), "{sampled}");
            for (k, error) in errors.iter().enumerate() {
                let off = (sample.r[k] - exact.r[k]) / error;
                assert!(off.abs() < 5.0, "seed {seed}, r{}: {} instead of {}", k + 1, sample.r[k], exact.r[k]);
                squares += off * off / (20.0 * REACH as f64);
                // The number of pairs is estimated too.
                let [ours, all] = [sample.pairs[k], exact.pairs[k]].map(|pairs| pairs as f64);
                assert!((ours / all - 1.0).abs() < 0.1, "{ours} {all}");
            }
        }
        // Errors are of the size that is said.
        assert!((0.5..1.5).contains(&squares), "{squares}");
    }
}
