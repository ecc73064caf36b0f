//! The limit on crossings: segments come in, and whether they cross so often that resolving them would exhaust memory.
//!
//! Resolving takes time and memory for every crossing, of which n segments may have n²/2. Crossings are not counted but
//! estimated from pairs that are picked as if at random, always the same ones: about [`HITS`] of them cross where the
//! limit is just reached, so that what stays below two thirds of it passes and what exceeds it by half does not.

use std::fmt;

use i_overlay::i_float::int::point::IntPoint;

use super::overlay::Ring;

/// Crossings that any outline may have.
const MOST: f64 = 1e6;

/// Further crossings for every segment.
const MOST_PER_SEGMENT: f64 = 4.0;

/// Picked pairs that cross where there are as many crossings as there may be.
const HITS: f64 = 256.0;

/// Most pairs that are picked. It is reached from 200,000 segments on, beyond which the estimate grows less exact.
const MOST_PAIRS: f64 = 4e6;

/// Outlines cross themselves or each other too often to be resolved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Tangled;

impl fmt::Display for Tangled {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the outline crosses itself, or the one it meets, more than a million times")
    }
}

impl std::error::Error for Tangled {}

/// # Errors
/// Where the rings, each closed, have more crossings than the limit.
pub(super) fn check(rings: &[Ring]) -> Result<(), Tangled> {
    let count: usize = rings.iter().map(Vec::len).sum();
    let pairs = count as f64 * count as f64 / 2.0;
    let most = MOST + MOST_PER_SEGMENT * count as f64;
    if pairs <= most {
        return Ok(());
    }
    let segments: Vec<Segment> = rings
        .iter()
        .flat_map(|ring| ring.iter().zip(ring.iter().cycle().skip(1)))
        .map(|(&a, &b)| Segment { a, b })
        .collect();
    let picks = (HITS * pairs / most).min(MOST_PAIRS);
    let most_hits = most / pairs * picks;
    let mut hits = 0.0;
    for i in 0..picks as u64 {
        let mixed = mix(i);
        // The high product of a number below 2^32 with the count lies below the count, evenly.
        let pick = |bits: u64| segments.get(((bits * segments.len() as u64) >> 32) as usize);
        if let (Some(a), Some(b)) = (pick(mixed & 0xffff_ffff), pick(mixed >> 32))
            && a.crosses(b)
        {
            hits += 1.0;
            if hits > most_hits {
                return Err(Tangled);
            }
        }
    }
    Ok(())
}

/// The finaliser of SplitMix64 (Steele, Lea and Flood 2014) over a Weyl sequence.
fn mix(i: u64) -> u64 {
    let z = (i + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

struct Segment {
    a: IntPoint<i64>,
    b: IntPoint<i64>,
}

impl Segment {
    /// Whether one of them would be split by the other: they meet, and not only with their ends.
    fn crosses(&self, other: &Self) -> bool {
        let apart = |a: i64, b: i64, c: i64, d: i64| a.max(b) < c.min(d) || c.max(d) < a.min(b);
        if apart(self.a.x, self.b.x, other.a.x, other.b.x) || apart(self.a.y, self.b.y, other.a.y, other.b.y) {
            return false;
        }
        let shares_end = [self.a, self.b].iter().any(|&p| p == other.a || p == other.b);
        let (c, d) = (self.side(other.a), self.side(other.b));
        let (a, b) = (other.side(self.a), other.side(self.b));
        let is_one_line = c == 0 && d == 0;
        let is_same = shares_end && [self.a, self.b].iter().all(|&p| p == other.a || p == other.b);
        if is_one_line { !is_same } else { !shares_end && c * d <= 0 && a * b <= 0 }
    }

    /// On which side of it a point lies: -1, 0 or 1.
    fn side(&self, p: IntPoint<i64>) -> i128 {
        let difference = |a: i64, b: i64| i128::from(a) - i128::from(b);
        let cross = difference(self.b.x, self.a.x) * difference(p.y, self.a.y)
            - difference(self.b.y, self.a.y) * difference(p.x, self.a.x);
        cross.signum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(points: impl IntoIterator<Item = (i64, i64)>) -> Ring {
        points.into_iter().map(|(x, y)| IntPoint::new(x, y)).collect()
    }

    #[test]
    fn only_pairs_that_split_each_other_cross() {
        let segment = |a: (i64, i64), b: (i64, i64)| Segment { a: IntPoint::new(a.0, a.1), b: IntPoint::new(b.0, b.1) };
        let level = segment((0, 0), (10, 0));
        for (other, crosses) in [
            (segment((5, -5), (5, 5)), true),
            (segment((5, 0), (5, 5)), true),
            (segment((5, 0), (15, 0)), true),
            (segment((0, 0), (5, 0)), true),
            (segment((10, 0), (0, 0)), false),
            (segment((10, 0), (10, 5)), false),
            (segment((5, 1), (5, 5)), false),
            (segment((11, -5), (11, 5)), false),
        ] {
            assert_eq!(level.crosses(&other), crosses);
            assert_eq!(other.crosses(&level), crosses);
        }
    }

    #[test]
    fn random_corners_are_tangled_and_combs_are_not() {
        let random = |count: u64| ring((0..count).map(|i| ((mix(i) >> 40) as i64, (mix(i ^ 1 << 40) >> 40) as i64)));
        // Of n random segments in a square about 0.23 n²/2 cross.
        assert_eq!(check(&[random(1_000)]), Ok(()));
        assert_eq!(check(&[random(2_000)]), Ok(()));
        assert_eq!(check(&[random(5_000)]), Err(Tangled));
        assert_eq!(check(&[random(16_000)]), Err(Tangled));
        // Teeth that touch nobody, however many.
        let comb = ring((0..100_000).map(|i| (i, if i % 2 == 0 { 0 } else { 1_000_000 })));
        assert_eq!(check(std::slice::from_ref(&comb)), Ok(()));
        let across: Ring = comb.iter().map(|p| IntPoint::new(p.y / 10, p.x * 10)).collect();
        assert_eq!(check(&[comb, across]), Err(Tangled));
    }
}
