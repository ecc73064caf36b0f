//! Overlays: pictures that explain a pattern, drawn on top of it.
//!
//! In: what the passes found for a paint. Out: layers of a drawing, so that every back end shows them, one group for each
//! overlay. They show what is measured: the tiles whose sites lie in the region, and the links among them. Widths follow
//! the spacing of the tiles. What lies below them only
//! pales.

mod colours;
#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests;

use std::collections::BTreeMap;
use std::f64::consts::PI;

use rayon::prelude::*;

use crate::drawing::{Dots, Layer, Strokes};
use crate::geom::{Angle, Length, Point, ring_bounds};
use crate::metrics::{Measured, space};
use crate::pass::cut;
use crate::pass::draw::Stages;
use crate::region::Region;
use crate::scene::{Canvas, Cap, Colour, Paint, Shape};

/// Something about a pattern that can be shown on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Overlay {
    /// Every tile filled by how many layers were asked for at its site.
    K,
    /// Every tile filled by its direction, with a bar along it.
    Angles,
    /// The sites' Voronoi cells.
    Cells,
    /// The links between neighbours.
    Graph,
    /// The links coloured by their contrast.
    Contrast,
    /// The sites.
    Sites,
}

impl Overlay {
    /// All, from the bottom up: what fills lies under lines and these under dots.
    pub const ALL: [Self; 6] = [Self::K, Self::Angles, Self::Cells, Self::Graph, Self::Contrast, Self::Sites];

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::K => "k",
            Self::Angles => "angles",
            Self::Cells => "cells",
            Self::Graph => "graph",
            Self::Contrast => "contrast",
            Self::Sites => "sites",
        }
    }

    /// The overlay of a name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|overlay| overlay.name() == name)
    }
}

/// How opaque fills are.
const FILL: u8 = 165;

/// The white between the picture and what is shown on it.
const VEIL: Colour = Colour { r: 255, g: 255, b: 255, a: 115 };

/// How opaque the white below a line is, which lifts it off the pattern.
const HALO: Colour = Colour { r: 255, g: 255, b: 255, a: 215 };

/// How much wider than its line it is on either side, in spacings.
const MARGIN: f64 = 0.03;

/// The widths of lines, in spacings.
const HAIR: f64 = 0.035;

/// The widths of links of contrast 1 and 0, in spacings.
const LINKS: [f64; 2] = [0.05, 0.17];

/// Width and length of the bar along a direction, in spacings.
const BAR: [f64; 2] = [0.08, 0.6];

/// The radius of a site, in spacings.
const SITE: f64 = 0.08;

/// Colours that a map is cut into, so that a pattern of many tiles has few layers; a multiple of four, so that every
/// whole number of layers has one.
const SHADES: u32 = 36;

/// Ink of lines.
const LINE: Colour = Colour { r: 20, g: 40, b: 75, a: 255 };

/// Ink of cells.
const CELL: Colour = Colour { r: 0, g: 125, b: 95, a: 255 };

/// Ink of sites.
const DOT: Colour = Colour { r: 200, g: 30, b: 90, a: 255 };

/// Rings by the even-odd rule.
type Area = Vec<Vec<Point>>;

/// A paint's pattern as overlays show it.
#[derive(Debug)]
pub struct Pattern {
    name: String,
    measured: Measured,
    /// The Voronoi cell of each tile in the region, among the measured sites alone, so that they share it out.
    cells: Vec<Vec<Area>>,
    /// What stands for each tile where it is filled: its outline in the region where tiles lie side by side, else its
    /// cell, for tiles that lie on each other would hide each other's colours.
    bodies: Vec<Vec<Area>>,
    /// The spacing of the tiles, in millimetres.
    spacing: f64,
}

impl Pattern {
    /// What overlays need of a paint.
    #[must_use]
    pub fn new(paint: &Paint, canvas: &Canvas, stages: &Stages<'_>) -> Self {
        let measured = Measured::new(paint, stages);
        let visible = cut::visible(paint, canvas);
        let clipped = |rings: &[Vec<Point>]| rings.par_iter().map(|ring| areas(ring, &visible)).collect();
        let cells: Vec<Vec<Area>> = clipped(&space::outlines(&measured));
        let bodies = match paint.tone.shape {
            Shape::Voronoi { .. } | Shape::Cell { .. } => clipped(&measured.outlines),
            Shape::Rect { .. }
            | Shape::Hexagon { .. }
            | Shape::Triangle { .. }
            | Shape::Trapezoid { .. }
            | Shape::Stamp { .. } => cells.clone(),
        };
        Self { name: paint.name.clone(), measured, cells, bodies, spacing: stages.sites.spacing }
    }

    /// The layers of an overlay, from the bottom up.
    #[must_use]
    pub fn layers(&self, overlay: Overlay) -> Vec<Layer> {
        let mut layers = match overlay {
            Overlay::K => self.filled(|tile| self.measured.k[tile] / 4.0, |share| colours::layers(share * 4.0)),
            Overlay::Angles => {
                let turns = |tile: usize| self.measured.angles[tile].to_radians() / PI;
                let mut layers = self.filled(turns, |share| colours::direction(Angle::radians(share * PI)));
                layers.extend(self.haloed(vec![(BAR[0], LINE, self.bars())]));
                layers
            }
            Overlay::Cells => self.outlined(),
            Overlay::Graph => {
                let links = self.measured.graph.edges().map(|edge| self.link(edge)).collect();
                self.haloed(vec![(HAIR, LINE, links)])
            }
            Overlay::Contrast => self.haloed(self.contrasts()),
            Overlay::Sites => vec![self.dotted()],
        };
        layers.retain(|layer| layer.marks() > 0);
        // A name with a word before it is no other group's by chance.
        layers.iter_mut().for_each(|layer| layer.groups.push(format!("overlay {}", overlay.name())));
        layers
    }

    /// Every tile filled with the colour of its share of a map from 0 to 1, one layer a shade.
    fn filled(&self, share: impl Fn(usize) -> f64, colour: impl Fn(f64) -> Colour) -> Vec<Layer> {
        let mut shades: BTreeMap<u32, Vec<Area>> = BTreeMap::new();
        for (tile, areas) in self.bodies.iter().enumerate() {
            shades.entry(shade(share(tile))).or_default().extend_from_slice(areas);
        }
        let layer = |(shade, areas)| {
            let ink = colour(f64::from(shade) / f64::from(SHADES));
            Layer { areas, ..self.layer(Colour { a: FILL, ..ink }) }
        };
        shades.into_iter().map(layer).collect()
    }

    /// Lines of some widths (in spacings) and inks from the bottom up, all above one white that is a little wider.
    fn haloed(&self, lines: Vec<(f64, Colour, Vec<[Point; 2]>)>) -> Vec<Layer> {
        let strokes = |spacings: f64, lines: &[[Point; 2]]| {
            let bundle_ends = (1..=lines.len()).collect();
            Strokes { lines: lines.to_vec(), bundle_ends, ..Strokes::new(self.width(spacings), Cap::Round) }
        };
        let mut halo = self.layer(HALO);
        halo.strokes = lines.iter().map(|(width, _, lines)| strokes(width + 2.0 * MARGIN, lines)).collect();
        let inked = lines.iter().map(|(width, ink, lines)| {
            let mut layer = self.layer(*ink);
            layer.strokes.push(strokes(*width, lines));
            layer
        });
        std::iter::once(halo).chain(inked).collect()
    }

    /// A bar along every tile's direction.
    fn bars(&self) -> Vec<[Point; 2]> {
        let half = self.spacing * BAR[1] / 2.0;
        let tiles = self.measured.sites.iter().zip(&self.measured.angles);
        tiles.map(|(&site, angle)| [site - angle.unit() * half, site + angle.unit() * half]).collect()
    }

    /// The links by their contrast: the greater it is the lower they lie, so that equal neighbours are seen first.
    fn contrasts(&self) -> Vec<(f64, Colour, Vec<[Point; 2]>)> {
        let mut shades: BTreeMap<u32, Vec<[Point; 2]>> = BTreeMap::new();
        for edge in self.measured.graph.edges() {
            shades.entry(shade(self.measured.contrast(edge))).or_default().push(self.link(edge));
        }
        let lines = |(shade, lines)| {
            let contrast = f64::from(shade) / f64::from(SHADES);
            let equal = (1.0 - contrast) * (1.0 - contrast);
            (LINKS[0] + (LINKS[1] - LINKS[0]) * equal, colours::contrast(contrast), lines)
        };
        shades.into_iter().rev().map(lines).collect()
    }

    /// From one site to another, on a page that repeats to its nearest image.
    fn link(&self, [a, b]: [u32; 2]) -> [Point; 2] {
        let [a, b] = [a, b].map(|site| self.measured.sites[site as usize]);
        [a, self.measured.period.map_or(b, |period| a + period.shortest(b - a))]
    }

    fn outlined(&self) -> Vec<Layer> {
        let rings = self.cells.iter().flatten().flatten();
        let polylines: Vec<Vec<Point>> = rings.map(|ring| ring.iter().chain(ring.first()).copied().collect()).collect();
        let layer = |ink: Colour, spacings: f64| {
            let strokes = Strokes::new(self.width(spacings), Cap::Round);
            Layer { strokes: vec![Strokes { polylines: polylines.clone(), ..strokes }], ..self.layer(ink) }
        };
        vec![layer(HALO, HAIR + 2.0 * MARGIN), layer(CELL, HAIR)]
    }

    fn dotted(&self) -> Layer {
        let mut layer = self.layer(DOT);
        let centres = self.measured.sites.clone();
        let bundle_ends = (1..=centres.len()).collect();
        layer.dots.push(Dots { radius: self.width(SITE), centres, bundle_ends });
        layer
    }

    fn width(&self, spacings: f64) -> Length {
        Length::mm(self.spacing * spacings)
    }

    fn layer(&self, ink: Colour) -> Layer {
        Layer::new(Vec::new(), self.name.clone(), ink)
    }
}

/// The overlays of all patterns on top of each other: every fill below every line, whatever paint it belongs to, and below
/// all of them a veil over the canvas, so that they stand out from the picture.
#[must_use]
pub fn layers(overlays: &[Overlay], patterns: &[Pattern], canvas: &Canvas) -> Vec<Layer> {
    let sheet = canvas.bounds().corners().to_vec();
    let veil = Layer { areas: vec![vec![sheet]], ..Layer::new(Vec::new(), "overlay veil".to_owned(), VEIL) };
    let shown = Overlay::ALL.into_iter().filter(|overlay| overlays.contains(overlay));
    let shown = shown.flat_map(|overlay| patterns.iter().flat_map(move |pattern| pattern.layers(overlay)));
    std::iter::once(veil).chain(shown).collect()
}

/// The nearest of the shades of a map, 0 to [`SHADES`].
fn shade(share: f64) -> u32 {
    (share.clamp(0.0, 1.0) * f64::from(SHADES)).round() as u32
}

/// What of a ring lies in a region.
fn areas(ring: &[Point], region: &Region) -> Vec<Area> {
    if ring.is_empty() {
        return Vec::new();
    }
    let whole = || vec![ring.to_vec()];
    if !region.touches_outline(ring_bounds(ring)) {
        return if region.contains(ring[0]) { vec![whole()] } else { Vec::new() };
    }
    // Tiles are small and cross little, so that nothing is too tangled; a cell that rounding ruined is left out.
    let Ok(cell) = Region::polygon(ring) else { return Vec::new() };
    let shared = cell.intersection(region);
    shared.polygons().iter().map(|polygon| polygon.rings().cloned().collect()).collect()
}
