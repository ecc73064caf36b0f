//! Smooth noise.
use serde::Serialize;
use crate::geom::Length;

/// Gradient noise in octaves.
#[derive(Debug, Serialize)]
pub struct Noise {
    /// The size of the largest features.
    pub scale: Length,
    /// How many octaves are added up.
    pub octaves: u32,
    /// The stream it is drawn from.
    pub seed: u64,
}
