//! Streams of random numbers that are named by what they are for.
//!
//! A stream is keyed by the seed, the paint's name, the purpose and, where draws are per tile, an index: what one stream
//! yields never depends on how many draws another has made, so adding a paint or switching a wobble on leaves the rest
//! of a picture where it was. Keys are hashed with SipHash-2-4; the generator is PCG64 MCG (O'Neill 2014).

use std::hash::Hasher;

use rand_core::{Rng, SeedableRng};
use siphasher::sip128::{Hash128, Hasher128, SipHasher24};

/// One stream.
#[derive(Debug, Clone)]
pub struct Stream {
    generator: rand_pcg::Pcg64Mcg,
}

/// What a family of streams is keyed by.
#[derive(Debug, Clone, Copy)]
pub struct Key<'a> {
    /// The seed of the scene, or of the paint where it has its own.
    pub seed: u64,
    /// The paint's name, or the field's.
    pub name: &'a str,
    /// What the numbers are for.
    pub purpose: &'a str,
}

impl Key<'_> {
    /// The stream that is read in sequence.
    #[must_use]
    pub fn stream(&self) -> Stream {
        self.with(None)
    }

    /// The stream of one tile.
    #[must_use]
    pub fn tile(&self, index: usize) -> Stream {
        self.with(Some(index as u64))
    }

    /// The table of one tile.
    #[must_use]
    pub fn table(&self, index: usize) -> Table {
        Table { start: self.hash(Some(index as u64)).h1 }
    }

    fn with(&self, index: Option<u64>) -> Stream {
        let hash = self.hash(index);
        let mut seed = [0; 16];
        seed[..8].copy_from_slice(&hash.h1.to_le_bytes());
        seed[8..].copy_from_slice(&hash.h2.to_le_bytes());
        Stream { generator: rand_pcg::Pcg64Mcg::from_seed(seed) }
    }

    fn hash(&self, index: Option<u64>) -> Hash128 {
        let mut hasher = SipHasher24::new();
        hasher.write(&self.seed.to_le_bytes());
        // Lengths first, so that no two pairs of texts run together into the same bytes.
        for text in [self.name, self.purpose] {
            hasher.write(&(text.len() as u64).to_le_bytes());
            hasher.write(text.as_bytes());
        }
        if let Some(index) = index {
            hasher.write(&index.to_le_bytes());
        }
        hasher.finish128()
    }
}

/// Random numbers by their places, of which any can be had without those before it: what a line draws does not depend on
/// which other lines are seen. The numbers are those of SplitMix64 (Steele, Lea and Flood 2014), each a mixture of its
/// place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Table {
    start: u64,
}

impl Table {
    /// The table of nothing in particular, for what is not read.
    pub const ZERO: Self = Self { start: 0 };

    /// The table of a row of this table.
    #[must_use]
    pub fn row(self, row: i64) -> Self {
        Self { start: self.bits(row) }
    }

    /// A number in [0, 1), of 53 random bits.
    #[must_use]
    pub fn unit(self, place: i64) -> f64 {
        (self.bits(place) >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
    }

    /// A number in (-1, 1), the more seldom the farther it lies from 0: half the sum of two even ones.
    #[must_use]
    pub fn stray(self, place: i64) -> f64 {
        let bits = self.bits(place);
        let [a, b] = [(bits >> 32) as u32, bits as u32].map(|half| f64::from(half.cast_signed()));
        (a + b + 1.0) * (0.5 / (1u64 << 31) as f64)
    }

    fn bits(self, place: i64) -> u64 {
        let mut z = self.start.wrapping_add(place.cast_unsigned().wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15));
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }
}

impl Stream {
    /// A number in [0, 1), of 53 random bits.
    pub fn unit(&mut self) -> f64 {
        (self.generator.next_u64() >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
    }

    /// Two numbers in [-1, 1), of 32 random bits each, for the price of one draw.
    pub fn signed_pair(&mut self) -> [f64; 2] {
        let bits = self.generator.next_u64();
        [(bits >> 32) as u32, bits as u32].map(|half| f64::from(half.cast_signed()) * (1.0 / (1u64 << 31) as f64))
    }

    /// A whole number below `bound`, which is at least 1; without bias (Lemire 2019).
    pub fn below(&mut self, bound: u64) -> u64 {
        let bound = bound.max(1);
        let threshold = bound.wrapping_neg() % bound;
        loop {
            let wide = u128::from(self.generator.next_u64()) * u128::from(bound);
            if wide as u64 >= threshold {
                return (wide >> 64) as u64;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_splitmix() {
        // The first numbers of SplitMix64 with the seed 1234567.
        let table = Table { start: 1_234_567 };
        assert_eq!([0, 1].map(|place| table.bits(place)), [6_457_827_717_110_365_317, 3_203_168_211_198_807_973]);
        assert_ne!(table.row(0), table.row(-1));
    }

    #[test]
    fn strays_are_bounded_and_centred() {
        let table = Key { seed: 1, name: "paint", purpose: "test" }.table(7);
        let strays: Vec<f64> = (-5000..5000).map(|place| table.stray(place)).collect();
        assert!(strays.iter().all(|stray| stray.abs() < 1.0));
        let mean = strays.iter().sum::<f64>() / 1e4;
        let square = strays.iter().map(|stray| stray * stray).sum::<f64>() / 1e4;
        // Half the sum of two even numbers has a variance of a sixth.
        assert!(mean.abs() < 0.02 && (square - 1.0 / 6.0).abs() < 0.01, "{mean} {square}");
        assert!((0..1000).map(|place| table.unit(place)).all(|unit| (0.0..1.0).contains(&unit)));
    }
}
