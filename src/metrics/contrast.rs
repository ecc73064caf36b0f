//! How far neighbours are turned against each other.

use serde::Serialize;

use super::{Measured, Scalars};

/// Contrasts over the links.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Contrast {
    /// The mean contrast of the links, in [0, 1]; 0 without links.
    pub e_contrast: f64,
}

impl Contrast {
    /// The figures by their names.
    #[must_use]
    pub fn scalars(&self) -> Scalars {
        vec![("e_contrast".into(), Some(self.e_contrast))]
    }
}

/// Measures the contrasts.
#[must_use]
pub fn measure(measured: &Measured) -> Contrast {
    let (sum, count) =
        measured.graph.edges().fold((0.0, 0u32), |(sum, n), edge| (sum + measured.contrast(edge), n + 1));
    Contrast { e_contrast: if count == 0 { 0.0 } else { sum / f64::from(count) } }
}
