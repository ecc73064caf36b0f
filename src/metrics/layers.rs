//! What the layers of tiles make of them: how dark neighbours are against each other, how many ways strokes run.

use serde::Serialize;

use super::{Measured, Scalars, mean};

/// Figures of layers.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LayerMeasures {
    /// The mean absolute difference of the inked shares of neighbours, in [0, 1]. A tile's share is what its layers cover
    /// of a large area, as wide as pens are: ink that spreads, tiles that hide it and lines cut off by edges do not count.
    /// None without links or fills.
    pub density_contrast: Option<f64>,
    /// The mean over all tiles that have strokes of 1 less the length of the mean of exp(2 i theta) over the strokes by
    /// length, in [0, 1]: 0 for one straight layer, 1 for two that cross at a right angle. None where no tile has strokes.
    pub tile_isotropy: Option<f64>,
}

impl LayerMeasures {
    /// The figures by their names.
    #[must_use]
    pub fn scalars(&self) -> Scalars {
        vec![("density_contrast".into(), self.density_contrast), ("tile_isotropy".into(), self.tile_isotropy)]
    }
}

/// Measures what layers make of tiles.
#[must_use]
pub fn measure(measured: &Measured) -> LayerMeasures {
    let ink = |tile: u32| measured.ink.get(tile as usize);
    let differences = measured.graph.edges().filter_map(|[a, b]| Some((ink(a)? - ink(b)?).abs()));
    let isotropies: Vec<f64> = measured.isotropy.iter().copied().flatten().collect();
    LayerMeasures { density_contrast: mean(&differences.collect::<Vec<f64>>()), tile_isotropy: mean(&isotropies) }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::field::{Field, Node};
    use crate::geom::Point;
    use crate::pass::draw::Stages;
    use crate::pass::fixture::{canvas, paint};
    use crate::pass::{cut, link, place, turn};
    use crate::scene::{AngleRule, Asked, GridSize, Limits, Placement};
    use crate::stage::Graph;
    use crate::stop::Stop;

    #[test]
    fn neighbours_differ_in_ink_and_tiles_in_their_ways() {
        let canvas = canvas(2.0, 1.0);
        let grid = Placement::Grid(GridSize::Cells { columns: 2, rows: 1 });
        let mut paint = paint(&canvas, grid, AngleRule::Checkerboard);
        // One layer on the left, two on the right; lines of 0.005 mm at 0.08 mm ink a sixteenth.
        let (from, to) = (Point::new(0.5, 0.0), Point::new(1.5, 0.0));
        paint.tone.asked = Asked::K(Field::new(Node::Linear { from, to, start: 1.0, end: 2.0 }));
        let sites = place::place(&paint, &canvas, &Limits::default()).unwrap();
        let graph = link::link(&sites, paint.tone.link);
        let angles = turn::turn(&paint, &sites, &graph, &Stop::default());
        let tiles = cut::cut(&paint, &canvas, &sites, &graph, &angles, &mut Vec::new());
        let stages = Stages { sites: &sites, graph: &graph, angles: &angles, tiles: &tiles };
        let found = measure(&Measured::new(&paint, &stages));
        assert!((found.density_contrast.unwrap() - 0.0625 * 0.9375).abs() < 1e-12);
        assert!((found.tile_isotropy.unwrap() - 0.5).abs() < 1e-12);

        paint.tone.asked = Asked::K(Field::constant(0.0));
        let tiles = cut::cut(&paint, &canvas, &sites, &graph, &angles, &mut Vec::new());
        let stages = Stages { tiles: &tiles, ..stages };
        let blank = measure(&Measured::new(&paint, &stages));
        assert_eq!(blank, LayerMeasures { density_contrast: Some(0.0), tile_isotropy: None });
    }

    #[test]
    fn what_is_not_known_is_not_said() {
        let found = measure(&Measured::nothing(Graph::new(2, &[[0, 1]], Vec::new())));
        assert_eq!(found, LayerMeasures { density_contrast: None, tile_isotropy: None });
    }
}
