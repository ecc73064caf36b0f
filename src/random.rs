//! Streams of random numbers that are named by what they are for.
//!
//! A stream is keyed by the seed, the paint's name, the purpose and, where draws are per tile, an index: what one stream
//! yields never depends on how many draws another has made, so adding a paint or switching a wobble on leaves the rest
//! of a picture where it was. Keys are hashed with SipHash-2-4; the generator is PCG64 MCG (O'Neill 2014).

use std::hash::Hasher;

use rand_core::{Rng, SeedableRng};
use siphasher::sip128::{Hasher128, SipHasher24};

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

    fn with(&self, index: Option<u64>) -> Stream {
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
        let hash = hasher.finish128();
        let mut seed = [0; 16];
        seed[..8].copy_from_slice(&hash.h1.to_le_bytes());
        seed[8..].copy_from_slice(&hash.h2.to_le_bytes());
        Stream { generator: rand_pcg::Pcg64Mcg::from_seed(seed) }
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
