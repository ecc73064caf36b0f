//! Knockout of curved strokes: they are cut where tiles begin, and stay curves.

use std::convert::Infallible;

use rayon::prelude::*;

use crate::drawing::{Curves, Strokes, Tapers};
use crate::geom::bezier::cubics;
use crate::geom::clip::{Frame, Ranges};
use crate::geom::{Length, Point, Vec2, chain};
use crate::scene::Cap;
use crate::stage::Standing;

use super::super::curves::{CUTTING, disc, is_long, keep, pieces};
use super::super::cutout::Cutout;
use super::{CHUNK, SHORTEST, Stencil};

/// The page's own frame.
const PAGE: Frame = Frame::new(Point::new(0.0, 0.0), Vec2::new(1.0, 0.0));

/// Memory that is used again for every stroke.
#[derive(Default)]
struct Scratch {
    cutout: Cutout,
    ranges: Ranges,
    inside: Ranges,
    found: Vec<(f64, f64)>,
    hidden: Vec<(f64, f64)>,
    piece: Vec<Point>,
    widths: Vec<f64>,
}

impl Stencil<'_> {
    /// How many looks it takes to cut curves.
    pub(super) fn cost_of_curves(&self, curves: &Curves) -> u64 {
        let of = |number: usize| -> u64 {
            let boxes = cubics(curves.chain(number)).map(|cubic| disc(&cubic.bounds()));
            boxes.map(|(middle, within)| self.nearby.candidates(middle, within)).sum()
        };
        (0..curves.len()).into_par_iter().map(of).sum()
    }

    /// What is left of the curves of some strokes.
    pub(super) fn cut_curves(&self, strokes: &Strokes) -> Curves {
        let cap = match strokes.cap {
            Cap::Butt => 0.0,
            Cap::Round => strokes.pen.to_mm() / 2.0,
        };
        let parts = self.in_chunks(&strokes.curves, |bundle, scratch, out: &mut Curves| {
            for number in bundle {
                let curve = strokes.curves.chain(number);
                if !self.see_curve(curve, cap, scratch) {
                    out.push(curve);
                    continue;
                }
                let (middle, joined) = pieces(curve, scratch.ranges.as_slice());
                for ranges in middle.chunks(1).chain(joined.as_ref().map(<[_; 2]>::as_slice)) {
                    scratch.piece.clear();
                    ranges.iter().for_each(|&range| chain::part(curve, range, &mut scratch.piece));
                    if is_long(&scratch.piece, strokes.pen * SHORTEST) {
                        out.push(&scratch.piece);
                    }
                }
            }
            out.end_bundle();
        });
        let mut left = Curves::default();
        parts.iter().for_each(|part| left.append(part));
        left
    }

    /// What is left of strokes that run out: where they are cut they are as wide as they were there.
    pub(super) fn cut_tapers(&self, tapers: &Tapers) -> Tapers {
        let strokes: Vec<(&[Point], &[f64])> = tapers.iter().collect();
        let parts = self.in_chunks(&tapers.spines, |bundle, scratch, out: &mut Tapers| {
            for number in bundle {
                let (spine, widths) = strokes[number];
                if !self.see_curve(spine, 0.0, scratch) {
                    out.push(spine, widths);
                    continue;
                }
                let widest = Length::mm(widths.iter().copied().fold(0.0, f64::max));
                for &range in scratch.ranges.as_slice() {
                    scratch.piece.clear();
                    chain::part(spine, range, &mut scratch.piece);
                    scratch.widths.clear();
                    for (number, start, end) in chain::parts(spine, range) {
                        let (from, to) = (widths[number], widths[number + 1]);
                        let at = |t: f64| from + (to - from) * t;
                        if scratch.widths.is_empty() {
                            scratch.widths.push(at(start));
                        }
                        scratch.widths.push(at(end));
                    }
                    if is_long(&scratch.piece, widest * SHORTEST) {
                        out.push(&scratch.piece, &scratch.widths);
                    }
                }
            }
            out.spines.end_bundle();
        });
        let mut left = Tapers::default();
        parts.iter().for_each(|part| left.append(part));
        left
    }

    /// Runs over the bundles of some curves in parallel, given as ranges of their numbers.
    fn in_chunks<T: Default + Send>(
        &self,
        curves: &Curves,
        cut: impl Fn(std::ops::Range<usize>, &mut Scratch, &mut T) + Sync,
    ) -> Vec<T> {
        // What no bundle holds is one.
        let ends = curves.bundle_ends().iter().copied().chain([curves.len()]);
        let mut start = 0;
        let bundles: Vec<std::ops::Range<usize>> = ends.map(|end| std::mem::replace(&mut start, end)..end).collect();
        bundles
            .par_chunks(CHUNK)
            .map(|bundles| {
                let (mut scratch, mut out) = (Scratch::default(), T::default());
                bundles.iter().for_each(|bundle| cut(bundle.clone(), &mut scratch, &mut out));
                out
            })
            .collect()
    }

    /// Leaves in `scratch.ranges` what is seen of a chain; false where all of it is.
    fn see_curve(&self, curve: &[Point], cap: f64, scratch: &mut Scratch) -> bool {
        let Scratch { cutout, ranges, inside, found, hidden, .. } = scratch;
        ranges.reset(0.0, chain::count(curve) as f64);
        hidden.clear();
        for (number, cubic) in cubics(curve).enumerate() {
            let (middle, within) = disc(&cubic.bounds());
            self.nearby.near(middle, within, |tile| {
                cutout.set(self.nearby.figure(tile), &PAGE);
                cutout.cut(&cubic.0, number, found);
                inside.set(found);
                if let (Some(region), Standing::Clipped) = (self.region, self.tiles.standing[tile as usize]) {
                    let Ok(()) = keep::<Infallible>(curve, inside, found, CUTTING.to_mm(), |p, _| {
                        let distance = region.signed_distance(p);
                        Ok((distance >= 0.0, distance.abs()))
                    });
                }
                hidden.extend_from_slice(inside.as_slice());
            });
        }
        for &(start, end) in hidden.iter() {
            // Round caps end where the tile begins.
            let margin = |s: f64| if cap > 0.0 { (cap / chain::at(curve, s).1.length()).min(1.0) } else { 0.0 };
            ranges.subtract(start - margin(start), end + margin(end));
        }
        !hidden.is_empty()
    }
}
