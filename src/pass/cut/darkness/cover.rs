//! How deeply tiles lie over the paper, and so what becomes on paper of the ink that they have.

use std::collections::BTreeSet;

use crate::geom::{Point, ring_area};
use crate::scene::{Ground, Shape, Stack};
use crate::stage::{Graph, Sites};

use super::{Bed, ink};

/// Places that are looked at.
const SAMPLES: usize = 1024;

/// Depths that are told apart; whatever lies deeper counts as the last.
const DEEPEST: usize = 16;

/// Shares of the paper below it are rounding.
const ROUNDING: f64 = 1e-6;

/// Halvings in the search for the ink of a tile.
const HALVINGS: usize = 30;

/// Steps of an even sequence in the plane (Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018): 1/p
/// and 1/p² for the real p with p³ = p + 1.
const EVEN: [f64; 2] = [0.754_877_666_246_692_7, 0.569_840_290_998_053_3];

/// How deeply the tiles of a paint lie over its domain.
pub(super) struct Cover {
    /// The share of the paper that lies under so many tiles.
    depths: [f64; DEEPEST + 1],
    /// How dark the paper is where no tile lies.
    ground: f64,
    stack: Stack,
}

impl Cover {
    /// Finds it for the tiles of a paint. Cells tell it by their area, stamps are looked for at some places of the domain.
    pub(super) fn new(bed: &Bed<'_>) -> Self {
        let Bed { paint, sites, tiles, .. } = *bed;
        let mut depths = [0.0; DEEPEST + 1];
        let area = |tile: usize| ring_area(tiles.outline(tile)).abs();
        match &paint.tone.shape {
            Shape::Voronoi { .. } => {
                let extent = sites.extent.width() * sites.extent.height();
                depths[1] = (0..tiles.len()).map(area).sum::<f64>() / extent;
            }
            Shape::Cell { inset } => {
                // Cells of a tiling are taken to have a circle that touches all sides: drawn in by less, they grow alike.
                let whole = |tile: usize| {
                    let (area, round) = (area(tile), perimeter(tiles.outline(tile)));
                    let grown = 1.0 + inset.to_mm() * round / (2.0 * area.max(f64::MIN_POSITIVE));
                    area * grown * grown
                };
                depths[1] = (0..tiles.len()).map(area).sum::<f64>() / (0..tiles.len()).map(whole).sum::<f64>();
            }
            Shape::Rect { .. }
            | Shape::Hexagon { .. }
            | Shape::Triangle { .. }
            | Shape::Trapezoid { .. }
            | Shape::Stamp { .. } => sample(bed, &mut depths),
        }
        if paint.tone.shape.is_cell() {
            depths[1] = if depths[1] > 0.0 { depths[1].min(1.0) } else { 1.0 };
            // Where rounding alone leaves something bare, nothing is.
            if depths[1] > 1.0 - ROUNDING {
                depths[1] = 1.0;
            }
            depths[0] = 1.0 - depths[1];
        }
        let ground = match &paint.tone.ground {
            Some(Ground::Fill { fill, .. }) => ink::share(&fill.kind, bed.canvas.gain),
            Some(Ground::Nearest) => {
                depths[1] += depths[0];
                depths[0] = 0.0;
                0.0
            }
            None => 0.0,
        };
        Self { depths, ground, stack: paint.tone.stack }
    }

    /// The share of the paper that lies under a tile.
    pub(super) fn covered(&self) -> f64 {
        1.0 - self.depths[0]
    }

    /// How many tiles lie over a place that is covered.
    pub(super) fn depth(&self) -> f64 {
        let sum: f64 = self.depths.iter().enumerate().map(|(depth, share)| depth as f64 * share).sum();
        if self.covered() > 0.0 { sum / self.covered() } else { 1.0 }
    }

    /// The share of the paper that is inked where tiles have this share of ink.
    pub(super) fn on_paper(&self, ink: f64) -> f64 {
        let bare = self.depths[0] * (1.0 - self.ground);
        match self.stack {
            Stack::Cover => 1.0 - bare - self.covered() * (1.0 - ink),
            Stack::Through => {
                let mut left = 1.0;
                let mut sum = 0.0;
                for share in &self.depths[1..] {
                    left *= 1.0 - ink;
                    sum += share * left;
                }
                1.0 - bare - sum
            }
        }
    }

    /// The share of ink of tiles that covers this share of the paper, in [0, 1].
    pub(super) fn in_tiles(&self, paper: f64) -> f64 {
        if self.depths[1] >= 1.0 {
            return paper.clamp(0.0, 1.0);
        }
        match self.stack {
            Stack::Cover => {
                let bare = self.depths[0] * (1.0 - self.ground);
                let covered = self.covered();
                if covered > 0.0 { (1.0 - (1.0 - bare - paper) / covered).clamp(0.0, 1.0) } else { 0.0 }
            }
            // Halving never comes to nothing by itself.
            Stack::Through if self.on_paper(0.0) >= paper => 0.0,
            Stack::Through => {
                let (mut low, mut high) = (0.0, 1.0);
                for _ in 0..HALVINGS {
                    let middle = (low + high) / 2.0;
                    if self.on_paper(middle) < paper {
                        low = middle;
                    } else {
                        high = middle;
                    }
                }
                high
            }
        }
    }
}

fn perimeter(ring: &[Point]) -> f64 {
    let ends = ring.iter().cycle().skip(1);
    ring.iter().zip(ends).map(|(a, b)| a.distance(*b)).sum()
}

/// Looks how many stamps lie over places that are spread evenly over the domain.
fn sample(bed: &Bed<'_>, depths: &mut [f64; DEEPEST + 1]) {
    let Bed { sites, graph, tiles, .. } = *bed;
    let reach = |i: usize| {
        let corners = tiles.outline(i).iter();
        corners.map(|&corner| sites.points[i].distance_squared(corner)).fold(0.0, f64::max)
    };
    let Some(reach) = (0..tiles.len()).map(reach).reduce(f64::max) else {
        depths[1] = 1.0;
        return;
    };
    let (domain, samples) = (sites.domain, SAMPLES.min(tiles.len()));
    let mut nearest = 0;
    let (mut seen, mut list) = (BTreeSet::new(), Vec::new());
    for i in 0..samples {
        let at = |step: f64| ((i as f64 + 0.5) * step).fract();
        let place =
            Point::new(domain.min.x + at(EVEN[0]) * domain.width(), domain.min.y + at(EVEN[1]) * domain.height());
        nearest = walk(sites, graph, nearest, place);
        seen.clear();
        list.clear();
        seen.insert(nearest);
        list.push(nearest);
        let (mut next, mut depth) = (0, 0);
        while let Some(&site) = list.get(next)
            && depth < DEEPEST
        {
            next += 1;
            depth += usize::from(tiles.figure(site).clearance(place) > 0.0);
            for &neighbour in graph.neighbours(site) {
                let neighbour = neighbour as usize;
                if sites.points[neighbour].distance_squared(place) < reach && seen.insert(neighbour) {
                    list.push(neighbour);
                }
            }
        }
        depths[depth] += 1.0 / samples as f64;
    }
}

/// The site nearest to a place, from another along links that lead nearer: in a Delaunay triangulation they do.
fn walk(sites: &Sites, graph: &Graph, from: usize, place: Point) -> usize {
    let distance = |site: usize| sites.points[site].distance_squared(place);
    let mut at = from;
    loop {
        let nearer =
            graph.neighbours(at).iter().map(|&site| site as usize).min_by(|&a, &b| distance(a).total_cmp(&distance(b)));
        match nearer {
            Some(site) if distance(site) < distance(at) => at = site,
            _ => return at,
        }
    }
}
