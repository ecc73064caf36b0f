//! Knockout: what lies under a paint's tiles is removed from everything drawn before.
//!
//! Strokes are cut by their centre lines, dots are dropped where they are touched, areas are cut as polygons. Where a
//! paint ends at its region's outline its tiles remove nothing beyond it.

mod curves;

use rayon::prelude::*;

use crate::drawing::{Dots, Layer, Strokes};
use crate::geom::clip::{Frame, Ranges, TOLERANCE};
use crate::geom::{Point, Vec2, ring_bounds};
use crate::region::{FillRule, Region};
use crate::scene::{Cap, Edge, Paint};
use crate::stage::{Sites, Standing, Tiles};

use super::nearby::Nearby;
use super::silhouette::Silhouette;

/// Bundles that one thread cuts at a time.
const CHUNK: usize = 256;

/// What is left of a cut stroke is dropped where it is shorter than so many pens, as for tiles by default.
const SHORTEST: f64 = 2.0;

/// The tiles of a paint, as a stencil.
pub(super) struct Stencil<'a> {
    tiles: &'a Tiles,
    nearby: Nearby<'a>,
    /// What the tiles end at.
    region: Option<&'a Region>,
}

/// Memory that is used again for every stroke.
#[derive(Default)]
struct Scratch {
    silhouette: Silhouette,
    ranges: Ranges,
    inside: Ranges,
    spans: Vec<(f64, f64)>,
}

impl<'a> Stencil<'a> {
    /// `visible` is the part of the paint's region that lies on the canvas.
    pub(super) fn new(paint: &Paint, visible: &'a Region, sites: &'a Sites, tiles: &'a Tiles) -> Self {
        let region = match paint.tone.edge {
            Edge::Clip => Some(visible),
            Edge::Whole | Edge::Centre => None,
        };
        Self { tiles, nearby: Nearby::new(sites, tiles), region }
    }

    /// How many looks it takes to cut layers.
    pub(super) fn cost(&self, layers: &[Layer]) -> f64 {
        let lines = |strokes: &Strokes| -> u64 {
            strokes.lines.par_iter().map(|&[a, b]| self.nearby.candidates_along(a, b)).sum::<u64>()
                + strokes
                    .polylines
                    .par_iter()
                    .flat_map_iter(|polyline| polyline.windows(2))
                    .map(|pair| self.nearby.candidates_along(pair[0], pair[1]))
                    .sum::<u64>()
                + self.cost_of_curves(&strokes.curves)
        };
        let dots = |dots: &Dots| -> u64 {
            dots.centres.par_iter().map(|&centre| self.nearby.candidates(centre, dots.radius.to_mm())).sum()
        };
        let cost = |layer: &Layer| {
            layer.strokes.iter().map(lines).sum::<u64>() as f64
                + layer.dots.iter().map(dots).sum::<u64>() as f64
                + self.cost_of_curves(&layer.tapers.spines) as f64
        };
        layers.iter().map(cost).sum()
    }

    /// Removes what lies under the tiles.
    pub(super) fn cut(&self, layer: &mut Layer) {
        for strokes in &mut layer.strokes {
            *strokes = self.cut_strokes(strokes);
        }
        layer
            .strokes
            .retain(|strokes| !(strokes.lines.is_empty() && strokes.polylines.is_empty() && strokes.curves.is_empty()));
        layer.tapers = self.cut_tapers(&layer.tapers);
        for dots in &mut layer.dots {
            *dots = self.cut_dots(dots);
        }
        layer.dots.retain(|dots| !dots.centres.is_empty());
        layer.areas = layer.areas.par_iter().flat_map_iter(|area| self.cut_area(area)).collect();
    }

    fn cut_strokes(&self, strokes: &Strokes) -> Strokes {
        let bundles: Vec<&[[Point; 2]]> = strokes.bundles().collect();
        let chunks: Vec<(Vec<[Point; 2]>, Vec<usize>)> = bundles
            .par_chunks(CHUNK)
            .map(|bundles| {
                let (mut scratch, mut lines, mut ends) = (Scratch::default(), Vec::new(), Vec::new());
                for bundle in bundles {
                    let start = lines.len();
                    bundle.iter().for_each(|&line| self.cut_line(line, strokes, &mut scratch, &mut lines));
                    if lines.len() > start {
                        ends.push(lines.len());
                    }
                }
                (lines, ends)
            })
            .collect();
        let mut cut = Strokes { curves: self.cut_curves(strokes), ..Strokes::new(strokes.pen, strokes.cap) };
        for (lines, ends) in chunks {
            cut.bundle_ends.extend(ends.iter().map(|end| cut.lines.len() + end));
            cut.lines.extend(lines);
        }
        let mut scratch = Scratch::default();
        for polyline in &strokes.polylines {
            self.cut_polyline(polyline, strokes, &mut scratch, &mut cut.polylines);
        }
        cut
    }

    /// Leaves in `scratch.ranges` what is seen of a line, measured along it from its start; false where all of it is.
    fn see(&self, [a, b]: [Point; 2], cap: f64, scratch: &mut Scratch) -> bool {
        let length = a.distance(b);
        scratch.ranges.reset(0.0, length);
        if length <= TOLERANCE {
            return false;
        }
        let frame = Frame::new(a, (b - a) * (1.0 / length));
        let Scratch { silhouette, ranges, inside, spans } = scratch;
        let mut is_cut = false;
        let mut has_spans = false;
        self.nearby.along(a, b, |tile| {
            silhouette.set(self.nearby.figure(tile), &frame);
            silhouette.spans(&0.0, |(start, end)| {
                if end <= 0.0 || start >= length {
                    return;
                }
                inside.reset(start, end);
                if let (Some(region), Standing::Clipped) = (self.region, self.tiles.standing[tile as usize]) {
                    if !has_spans {
                        spans.clear();
                        region.clip_line(a, b, spans);
                        spans.iter_mut().for_each(|span| *span = (span.0 * length, span.1 * length));
                        has_spans = true;
                    }
                    inside.intersect(spans);
                }
                for &(start, end) in inside.as_slice() {
                    // Round caps end where the tile begins.
                    ranges.subtract(start - cap, end + cap);
                    is_cut = true;
                }
            });
        });
        is_cut
    }

    fn cut_line(&self, line: [Point; 2], strokes: &Strokes, scratch: &mut Scratch, out: &mut Vec<[Point; 2]>) {
        if !self.see(line, cap(strokes), scratch) {
            out.push(line);
            return;
        }
        let [a, b] = line;
        let length = a.distance(b);
        for &(start, end) in scratch.ranges.as_slice() {
            if end - start >= SHORTEST * strokes.pen.to_mm() - TOLERANCE {
                out.push([at(a, b, start / length), at(a, b, end / length)]);
            }
        }
    }

    /// Cuts a polyline segment by segment and joins what is seen on both sides of a corner.
    fn cut_polyline(&self, polyline: &[Point], strokes: &Strokes, scratch: &mut Scratch, out: &mut Vec<Vec<Point>>) {
        let mut pieces: Vec<Vec<Point>> = Vec::new();
        let mut is_cut = false;
        for pair in polyline.windows(2) {
            let [a, b] = [pair[0], pair[1]];
            is_cut |= self.see([a, b], cap(strokes), scratch);
            let length = a.distance(b);
            for &(start, end) in scratch.ranges.as_slice() {
                let (from, to) = (at(a, b, start / length), at(a, b, end / length));
                match pieces.last_mut() {
                    Some(piece) if piece.last() == Some(&from) => piece.push(to),
                    _ => pieces.push(vec![from, to]),
                }
            }
        }
        if !is_cut {
            out.push(polyline.to_vec());
            return;
        }
        // A closed one that was cut elsewhere runs on through its first point.
        if pieces.len() > 1 && pieces.last().and_then(|piece| piece.last()) == pieces[0].first() {
            let first = pieces.remove(0);
            if let Some(last) = pieces.last_mut() {
                last.extend_from_slice(&first[1..]);
            }
        }
        let length = |piece: &[Point]| piece.windows(2).map(|pair| pair[0].distance(pair[1])).sum::<f64>();
        pieces.retain(|piece| length(piece) >= SHORTEST * strokes.pen.to_mm() - TOLERANCE);
        out.extend(pieces);
    }

    fn cut_dots(&self, dots: &Dots) -> Dots {
        let radius = dots.radius.to_mm();
        let mut cut = Dots::new(dots.radius);
        for bundle in dots.bundles() {
            let start = cut.centres.len();
            cut.centres.extend(bundle.iter().copied().filter(|&centre| !self.touches(centre, radius)));
            if cut.centres.len() > start {
                cut.bundle_ends.push(cut.centres.len());
            }
        }
        cut
    }

    /// Whether a tile comes into a dot.
    fn touches(&self, centre: Point, radius: f64) -> bool {
        let mut is_touched = false;
        self.nearby.near(centre, radius, |tile| {
            let reaches = || self.nearby.figure(tile).clearance(centre) > TOLERANCE - radius;
            let standing = self.tiles.standing[tile as usize];
            let is_there = || match (self.region, standing) {
                (Some(region), Standing::Clipped) => region.signed_distance(centre) > TOLERANCE - radius,
                _ => true,
            };
            is_touched = is_touched || (reaches() && is_there());
        });
        is_touched
    }

    fn cut_area(&self, area: &[Vec<Point>]) -> Vec<Vec<Vec<Point>>> {
        let bounds = area.first().map(|ring| ring_bounds(ring)).unwrap_or(crate::geom::Rect::EMPTY);
        let reach = Vec2::new(bounds.width(), bounds.height()).length() / 2.0;
        let (mut whole, mut clipped) = (Vec::new(), Vec::new());
        self.nearby.near(bounds.centre(), reach, |tile| {
            let is_clipped = self.tiles.standing[tile as usize] == Standing::Clipped;
            let list = if is_clipped { &mut clipped } else { &mut whole };
            list.push(self.nearby.figure(tile).outline().to_vec());
        });
        if whole.is_empty() && clipped.is_empty() {
            return vec![area.to_vec()];
        }
        let mut left = Region::from_rings(area.to_vec(), FillRule::EvenOdd);
        left = left.difference(&Region::from_rings(whole, FillRule::NonZero));
        if !clipped.is_empty() {
            let clipped = Region::from_rings(clipped, FillRule::NonZero);
            left = left.difference(&self.region.map_or(clipped.clone(), |region| clipped.intersection(region)));
        }
        left.polygons().iter().map(|polygon| polygon.rings().cloned().collect()).collect()
    }
}

/// How far a stroke's caps reach beyond its ends in millimetres.
fn cap(strokes: &Strokes) -> f64 {
    match strokes.cap {
        Cap::Butt => 0.0,
        Cap::Round => strokes.pen.to_mm() / 2.0,
    }
}

/// The point a share of the way from a to b; the ends exactly.
fn at(a: Point, b: Point, share: f64) -> Point {
    if share >= 1.0 { b } else { a.lerp(b, share) }
}
