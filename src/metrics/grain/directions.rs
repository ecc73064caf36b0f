//! How many directions there are wherever one looks.

use std::f64::consts::PI;

use rayon::prelude::*;

use crate::metrics::Measured;

/// Two tiles are seen as turned alike where they are turned alike, less and less so until they differ by this: half a bin
/// of the report's entropy, 7.5 degrees.
const ALIKE: f64 = PI / 24.0;

/// Of a hub with more neighbours than this each neighbour sees as many of those after it: pairs round a hub of the whole
/// page would grow with the square of the tiles.
const HUB: usize = 64;

/// Tiles that one thread looks at in one go: sums are added up in the same order however many threads there are.
const CHUNK: usize = 2048;

/// The effective number of directions among tiles within two links of each other: one over how often two such tiles are
/// turned alike, as in L. Jost, "Entropy and diversity" (Oikos 113, 2006), of order 2. It has no bins that could shift. A
/// few directions over and over count as few, though they were others elsewhere on the page. None without links; no more
/// than two for each pair where no two tiles are alike.
pub(super) fn effective(measured: &Measured) -> Option<f64> {
    let tiles = measured.sites.len();
    let chunks: Vec<(f64, u64)> = (0..tiles.div_ceil(CHUNK))
        .into_par_iter()
        .map(|chunk| alike(measured, chunk * CHUNK..((chunk + 1) * CHUNK).min(tiles)))
        .collect();
    let (sum, pairs) = chunks.into_iter().fold((0.0, 0), |(a, n), (b, m)| (a + b, n + m));
    // Half a pair more, so that a handful of tiles that all differ have a number.
    (pairs > 0).then(|| pairs as f64 / f64::max(sum, 0.5))
}

/// How alike each tile of a range is turned to those after it within two links, added up, and how many pairs these are.
fn alike(measured: &Measured, range: std::ops::Range<usize>) -> (f64, u64) {
    let graph = &measured.graph;
    let (mut sum, mut pairs) = (0.0, 0);
    let mut near: Vec<u32> = Vec::new();
    for tile in range {
        near.clear();
        for &neighbour in graph.neighbours(tile) {
            near.push(neighbour);
            let around = graph.neighbours(neighbour as usize);
            // Those before the tile have seen it already.
            let after = &around[around.partition_point(|&other| other as usize <= tile)..];
            near.extend_from_slice(if around.len() > HUB { &after[..after.len().min(HUB)] } else { after });
        }
        near.retain(|&other| other as usize > tile);
        near.sort_unstable();
        near.dedup();
        pairs += near.len() as u64;
        for &other in &near {
            let distance = measured.angles[tile].rp1_distance(measured.angles[other as usize]);
            sum += (1.0 - distance.to_radians() / ALIKE).max(0.0);
        }
    }
    (sum, pairs)
}
