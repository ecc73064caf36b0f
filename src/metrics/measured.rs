//! What metrics read of a pattern: the tiles whose sites lie in the region, numbered anew, and the links among them.

use crate::geom::{Angle, Period, Point};
use crate::pass::cut::inked;
use crate::pass::draw::Stages;
use crate::region::Region;
use crate::scene::{Link, Paint};
use crate::stage::{Graph, Layers};

use super::runs::Run;
use super::strokes::Strokes;

/// A pattern as it is measured. All lists have one entry a tile, but those of which nothing is known are empty: a pattern
/// of another program need not say what it draws.
#[derive(Debug, Clone)]
pub struct Measured {
    /// The paint's name; with the seed it keys what is drawn at random where only a sample can be looked at.
    pub name: String,
    /// The scene's seed or the paint's own.
    pub seed: u64,
    /// What the tiles fill.
    pub region: Region,
    /// Where they lie, in millimetres.
    pub sites: Vec<Point>,
    /// Which are neighbours, and the triangles whose corners are all measured.
    pub graph: Graph,
    /// Whether the links are all those of a Delaunay triangulation of the plane, so that what holds for triangulations may
    /// be said of them.
    pub is_triangulated: bool,
    /// How they are turned, in [0, pi).
    pub angles: Vec<Angle>,
    /// The layers asked for at each site, 0 to 4, fractions included.
    pub k: Vec<f64>,
    /// The layers that are drawn.
    pub layers: Vec<Layers>,
    /// The outline of each tile as cut; empty where an inset left nothing.
    pub outlines: Vec<Vec<Point>>,
    /// How the strokes of each tile's first layer run.
    pub runs: Vec<Run>,
    /// The share of the paper that each tile's layers ink, in [0, 1].
    pub ink: Vec<f64>,
    /// How evenly the strokes of each tile run in all directions, in [0, 1]; none without strokes.
    pub isotropy: Vec<Option<f64>>,
    /// On a page that repeats: the period.
    pub period: Option<Period>,
}

/// What of a paint's region lies where sites were asked for: what is off the canvas has no tiles to be measured.
fn visible(paint: &Paint, stages: &Stages<'_>) -> Region {
    let (domain, bounds) = (stages.sites.domain, paint.region.bounds());
    if domain.intersection(&bounds) == bounds {
        return paint.region.clone();
    }
    paint.region.intersection(&Region::rect(domain))
}

impl Measured {
    /// What is measured of a paint.
    #[must_use]
    pub fn new(paint: &Paint, stages: &Stages<'_>) -> Self {
        let inside: Vec<usize> = (0..stages.tiles.len()).filter(|&tile| stages.tiles.inside[tile]).collect();
        let mut numbers: Vec<Option<u32>> = vec![None; stages.tiles.len()];
        for (number, &tile) in (0u32..).zip(&inside) {
            numbers[tile] = Some(number);
        }
        let number = |tile: u32| numbers[tile as usize];
        let edges: Vec<[u32; 2]> = stages.graph.edges().filter_map(|[a, b]| Some([number(a)?, number(b)?])).collect();
        let triangles = stages.graph.triangles.iter();
        let triangles = triangles.filter_map(|&[a, b, c]| Some([number(a)?, number(b)?, number(c)?])).collect();
        let period = stages.sites.period();
        let layers: Vec<Layers> = inside.iter().map(|&tile| stages.tiles.layers[tile]).collect();
        let outlines: Vec<Vec<Point>> = inside.iter().map(|&tile| stages.tiles.outline(tile).to_vec()).collect();
        let strokes = Strokes::of(&paint.tone.fill);
        Self {
            name: paint.name.clone(),
            seed: paint.seed,
            region: visible(paint, stages),
            sites: inside.iter().map(|&tile| stages.sites.points[tile]).collect(),
            graph: Graph::new(inside.len(), &edges, triangles),
            is_triangulated: paint.tone.link == Link::Delaunay && period.is_none(),
            angles: inside.iter().map(|&tile| stages.angles.0[tile]).collect(),
            k: inside.iter().map(|&tile| stages.tiles.k[tile]).collect(),
            runs: Run::of(paint, stages, &inside),
            ink: inked(paint, &layers, &outlines),
            isotropy: layers.iter().map(|&layers| strokes.isotropy(layers)).collect(),
            layers,
            outlines,
            period,
        }
    }

    /// A graph and nothing else, for whoever knows only a part of the rest to fill that in.
    pub(crate) fn nothing(graph: Graph) -> Self {
        Self {
            name: String::new(),
            seed: 0,
            region: Region::empty(),
            sites: Vec::new(),
            graph,
            is_triangulated: false,
            angles: Vec::new(),
            k: Vec::new(),
            layers: Vec::new(),
            outlines: Vec::new(),
            runs: Vec::new(),
            ink: Vec::new(),
            isotropy: Vec::new(),
            period: None,
        }
    }

    /// How far the tiles at the ends of an edge are turned against each other, in [0, 1]: 2/pi times their distance on the
    /// real projective line.
    #[must_use]
    pub fn contrast(&self, [a, b]: [u32; 2]) -> f64 {
        let distance = self.angles[a as usize].rp1_distance(self.angles[b as usize]);
        distance.to_radians() * std::f64::consts::FRAC_2_PI
    }
}
