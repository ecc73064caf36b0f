//! Grain: what tells hatching by hand from a machine's pattern and from noise.
//!
//! In: a pattern. Out: [`Grain`], the geometric mean of five shares that must all be there: neighbours that part, many
//! directions, even places, no rows, and no cells cut to one measure. Each is 1 from where more of it would not be seen,
//! so that none makes up for another; `docs/grain.md` has the reason and a picture for each. Nothing here knows how a
//! pattern came about, and all of it stays when every tile is turned by one angle or when the scene is moved or scaled.

mod directions;
mod lie;
mod waves;

use serde::Serialize;

use super::{Measured, Scalars};
use crate::stats::{percentile, summary};

/// Tiles below which a pattern is too small to have grain.
const FEWEST: usize = 10;

/// Of a hundred links so many may part by less.
const FIFTH: f64 = 5.0;

/// Three tiles that touch can part by at most two thirds each; neighbours that part by half of that, 30 degrees, are
/// told from each other at a glance.
const PARTED: f64 = 1.0 / 3.0;

/// As many directions as the bins of the report's entropy: a dozen is many.
const MANY: f64 = 12.0;

/// How much the areas of Delaunay's triangles vary, as SD over mean, where sites lie wholly at random (a Poisson
/// process): the mean square is 35 / (8 pi^2) over the density's square, the mean 1/2 over the density (R. E. Miles, "On the
/// homogeneous planar Poisson point process", Math. Biosciences 6, 1970).
const SCATTERED: f64 = 0.879_3;

/// Cells whose areas vary by less, as SD over mean, were set out with instruments: each site of a lattice need only stray
/// by a twentieth of the spacing for as much.
const LOOSE: f64 = 0.04;

/// How much of a grain a pattern has. None where it has too few tiles, links or triangles.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Grain {
    /// The geometric mean of the five shares below, in [0, 1].
    pub grain: Option<f64>,
    /// Neighbours part everywhere: three times the 5th percentile of the links' contrasts, at most 1.
    pub grain_contrast: Option<f64>,
    /// There are many directions wherever one looks: the effective number of those within two links, over 12, at most 1.
    pub grain_directions: Option<f64>,
    /// Tiles lie evenly: 1 less the variation of the triangles between them as a share of that of random sites.
    pub grain_evenness: Option<f64>,
    /// Tiles stand in no rows: the amplitude that the strongest wave of the sites leaves.
    pub grain_disorder: Option<f64>,
    /// No instrument set them: the variation of the cells' areas over 0.04, at most 1.
    pub grain_looseness: Option<f64>,
}

impl Grain {
    /// The figures by their names.
    #[must_use]
    pub fn scalars(&self) -> Scalars {
        vec![
            ("grain".into(), self.grain),
            ("grain_contrast".into(), self.grain_contrast),
            ("grain_directions".into(), self.grain_directions),
            ("grain_evenness".into(), self.grain_evenness),
            ("grain_disorder".into(), self.grain_disorder),
            ("grain_looseness".into(), self.grain_looseness),
        ]
    }
}

/// Measures the grain.
#[must_use]
pub fn measure(measured: &Measured) -> Grain {
    if measured.sites.len() < FEWEST {
        return Grain::default();
    }
    let contrasts: Vec<f64> = measured.graph.edges().map(|edge| measured.contrast(edge)).collect();
    let contrast = percentile(&contrasts, FIFTH).map(|p5| (p5 / PARTED).min(1.0));
    let directions = directions::effective(measured).map(|number| (number / MANY).min(1.0));
    let lie = lie::Lie::new(measured);
    let evenness = lie.as_ref().map(|lie| (1.0 - lie.triangles / SCATTERED).max(0.0));
    let disorder = lie.as_ref().map(|lie| (1.0 - waves::strongest(&measured.sites, lie.cell)).max(0.0).sqrt());
    // Where no cell is whole there is nothing to say against it.
    let looseness = lie.as_ref().map(|lie| lie.cells.map_or(1.0, |cells| (cells / LOOSE).min(1.0)));
    let factors = [contrast, directions, evenness, disorder, looseness];
    let product: Option<f64> = factors.into_iter().product();
    Grain {
        grain: product.map(|product| libm::pow(product, 1.0 / factors.len() as f64)),
        grain_contrast: contrast,
        grain_directions: directions,
        grain_evenness: evenness,
        grain_disorder: disorder,
        grain_looseness: looseness,
    }
}

/// Standard deviation (n - 1) over mean; none of fewer than two numbers or where the mean is not above zero.
fn variation(values: &[f64]) -> Option<f64> {
    let summary = summary(values).filter(|summary| summary.mean > 0.0)?;
    Some(summary.sd? / summary.mean)
}

#[cfg(test)]
mod tests;
