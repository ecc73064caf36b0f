//! Measures of a pattern.
//!
//! In: what the passes found for a paint, as [`Measured`], the tiles whose sites lie in the region and the links among
//! them. Out: [`Measures`]. A family of measures is one file here, one struct of named figures, and one line in
//! [`Measures`]; the names are those that tables, JSON and experiments print.

pub mod contrast;
pub mod correlogram;
pub mod decay;
pub mod diversity;
pub mod grain;
#[cfg(test)]
mod known;
pub mod layers;
mod measured;
pub mod read;
mod runs;
mod search;
pub mod space;
pub mod spectrum;
pub mod ssim;
mod strokes;
mod trust;

use std::borrow::Cow;

use serde::Serialize;

pub use measured::Measured;
pub use runs::Run;

/// The single figures of a family by their names, in the order in which tables show them. What cannot be said of a
/// pattern, such as the contrast of a pattern without links where it is a share of something, is `None`.
pub type Scalars = Vec<(Cow<'static, str>, Option<f64>)>;

/// All that is measured of one paint.
#[derive(Debug, Clone, Serialize)]
pub struct Measures {
    /// How many tiles are measured.
    pub tiles: usize,
    /// How many links there are among them.
    pub edges: usize,
    /// How far neighbours are turned against each other.
    #[serde(flatten)]
    pub contrast: contrast::Contrast,
    /// How many directions there are.
    #[serde(flatten)]
    pub diversity: diversity::Diversity,
    /// Contrast and diversity in one: `e_contrast` times `h_angle`, in [0, 1].
    pub joint: f64,
    /// How alike tiles are turned, by their distance.
    #[serde(flatten)]
    pub correlogram: correlogram::Correlogram,
    /// How fast that fades.
    #[serde(flatten)]
    pub decay: decay::Decay,
    /// With which period it repeats.
    #[serde(flatten)]
    pub spectrum: spectrum::Spectrum,
    /// How evenly tiles lie, and how much of the region they cover.
    #[serde(flatten)]
    pub space: space::Space,
    /// What the layers of tiles make of them.
    #[serde(flatten)]
    pub layers: layers::LayerMeasures,
    /// How much of a grain the pattern has.
    #[serde(flatten)]
    pub grain: grain::Grain,
}

impl Measures {
    /// Measures a pattern.
    #[must_use]
    pub fn new(measured: &Measured) -> Self {
        let contrast = contrast::measure(measured);
        let diversity = diversity::measure(measured);
        let correlogram = correlogram::measure(measured);
        Self {
            tiles: measured.sites.len(),
            edges: measured.graph.edges().count(),
            joint: contrast.e_contrast * diversity.h_angle,
            contrast,
            diversity,
            decay: decay::measure(&correlogram),
            spectrum: spectrum::measure(&correlogram),
            correlogram,
            space: space::measure(measured),
            layers: layers::measure(measured),
            grain: grain::measure(measured),
        }
    }

    /// Every single figure by its name.
    #[must_use]
    pub fn scalars(&self) -> Scalars {
        let mut scalars: Scalars =
            vec![("tiles".into(), Some(self.tiles as f64)), ("edges".into(), Some(self.edges as f64))];
        scalars.extend(self.contrast.scalars());
        scalars.extend(self.diversity.scalars());
        scalars.push(("joint".into(), Some(self.joint)));
        scalars.extend(self.correlogram.scalars());
        scalars.extend(self.decay.scalars());
        scalars.extend(self.spectrum.scalars());
        scalars.extend(self.space.scalars());
        scalars.extend(self.layers.scalars());
        scalars.extend(self.grain.scalars());
        scalars
    }
}

/// The mean, summed in order; none of no numbers.
fn mean(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::geom::Angle;
    use crate::pass::draw::Stages;
    use crate::pass::fixture::{canvas, paint};
    use crate::pass::{cut, link, place, turn};
    use crate::scene::{AngleRule, GridSize, Limits, Placement};
    use crate::stop::Stop;

    #[test]
    fn a_checkerboard_measures_as_reported() {
        let canvas = canvas(6.0, 6.0);
        let grid = Placement::Grid(GridSize::Cells { columns: 8, rows: 8 });
        let paint = paint(&canvas, grid, AngleRule::Checkerboard);
        let sites = place::place(&paint, &canvas, &Limits::default()).unwrap();
        let graph = link::link(&sites, paint.tone.link);
        let angles = turn::turn(&paint, &sites, &graph, &Stop::default());
        let tiles = cut::cut(&paint, &canvas, &sites, &graph, &angles, &mut Vec::new());
        let stages = Stages { sites: &sites, graph: &graph, angles: &angles, tiles: &tiles };
        let measures = Measures::new(&Measured::new(&paint, &stages));
        assert_eq!((measures.tiles, measures.edges), (64, 161));
        assert!((measures.contrast.e_contrast - 112.0 / 161.0).abs() < 1e-12);
        assert!((measures.diversity.h_angle - libm::log(2.0) / libm::log(12.0)).abs() < 1e-12);
    }

    #[test]
    fn the_nearest_layers_count() {
        let [a, b] = [0.0, 80.0].map(Angle::degrees);
        let distance = |m, n| a.layered_distance(m, b, n).map(|d| d.to_radians().to_degrees().round());
        assert_eq!(distance(1, 1), Some(80.0));
        assert_eq!(distance(2, 1), Some(10.0));
        assert_eq!(distance(3, 1), Some(10.0));
        assert_eq!(distance(4, 4), Some(10.0));
        assert_eq!(distance(3, 3), Some(10.0));
        assert_eq!(distance(0, 4), None);
    }
}
