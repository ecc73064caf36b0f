//! How much of the paper layers of a fill cover: shares of an area without end, reckoned from pitches and pens.
//!
//! Layers of strokes are turned against each other, so that what two of them leave bare is the product of what each
//! leaves bare. Dots of all layers stand on one lattice and add up until they touch.

use std::f64::consts::PI;

use crate::geom::Length;
use crate::scene::{Fill, FillKind};

use super::super::layers::MOST;

/// Samples along a side of a field of dots that grow together.
const SAMPLES: u32 = 64;

/// Places of the dots of layers 1 to 4, in steps along and across.
pub(super) const DOTS: [[f64; 2]; 4] = [[0.0, 0.0], [0.5, 0.5], [0.5, 0.0], [0.0, 0.5]];

/// The share of the paper that one layer of a fill covers at its own pitch, in [0, 1]. `gain` is how far ink spreads beyond
/// every edge.
pub(super) fn share(kind: &FillKind, gain: Length) -> f64 {
    match kind {
        FillKind::Dots { hatch, spacing, radius } => dotted(hatch.pitch, *spacing, *radius + gain, &DOTS[..1]),
        // Loops lie on loops as they come, so that each leaves the same share of what is bare.
        FillKind::Scribble { .. } => 1.0 - libm::exp(-spread(kind, gain).coverage()),
        FillKind::Lines(_)
        | FillKind::Dashes { .. }
        | FillKind::Crosses { .. }
        | FillKind::Arcs(_)
        | FillKind::Waves { .. }
        | FillKind::Nawaami { .. }
        | FillKind::Motif { .. }
        | FillKind::Solid => spread(kind, gain).coverage().min(1.0),
    }
}

/// A fill as its ink spreads.
fn spread(kind: &FillKind, gain: Length) -> FillKind {
    let mut spread = kind.clone();
    let by = gain * 2.0;
    match &mut spread {
        FillKind::Lines(hatch)
        | FillKind::Arcs(hatch)
        | FillKind::Waves { hatch, .. }
        | FillKind::Scribble { hatch, .. }
        | FillKind::Nawaami { hatch, .. }
        | FillKind::Motif { hatch, .. } => hatch.pen += by,
        FillKind::Dashes { hatch, dash, gap } => {
            hatch.pen += by;
            let grown = by.min(*gap);
            *dash += grown;
            *gap = *gap - grown;
        }
        FillKind::Crosses { hatch, size, .. } => {
            hatch.pen += by;
            *size += by;
        }
        FillKind::Dots { radius, .. } => *radius += gain,
        FillKind::Solid => {}
    }
    spread
}

/// The share of a tile that 0 to 4 full layers cover, which never falls. `held` is what tiles hold of each layer, against
/// a layer without end.
pub(super) fn levels(fills: &[Fill], gain: Length, held: &[f64; MOST as usize]) -> [f64; MOST as usize + 1] {
    let mut levels = [0.0; MOST as usize + 1];
    let mut bare = 1.0;
    // The fill whose marks stand between each other: what was bare before it, the numbers of its layers.
    let mut laid: Option<(&FillKind, f64, Vec<usize>)> = None;
    for n in 1..levels.len() {
        let Some(fill) = fills.get((n - 1).min(fills.len().saturating_sub(1))) else { return levels };
        let kind = &fill.kind;
        let held_by = |layers: &[usize]| layers.iter().map(|&layer| held[layer - 1]).sum::<f64>() / layers.len() as f64;
        match kind {
            FillKind::Dots { .. } | FillKind::Crosses { .. } | FillKind::Motif { .. } => {
                let (before, mut layers) = match laid.take() {
                    Some((earlier, before, layers)) if earlier == kind => (before, layers),
                    _ => (bare, Vec::new()),
                };
                layers.push(n);
                let inked = match kind {
                    FillKind::Dots { hatch, spacing, radius } => {
                        let places: Vec<[f64; 2]> = layers.iter().map(|&layer| DOTS[layer - 1]).collect();
                        dotted(hatch.pitch, *spacing, *radius + gain, &places)
                    }
                    _ => (share(kind, gain) * layers.len() as f64).min(1.0),
                };
                bare = before * (1.0 - inked * held_by(&layers)).clamp(0.0, 1.0);
                laid = Some((kind, before, layers));
            }
            FillKind::Lines(_)
            | FillKind::Dashes { .. }
            | FillKind::Arcs(_)
            | FillKind::Waves { .. }
            | FillKind::Scribble { .. }
            | FillKind::Nawaami { .. }
            | FillKind::Solid => {
                bare *= (1.0 - held[n - 1] * share(kind, gain)).clamp(0.0, 1.0);
                laid = None;
            }
        }
        levels[n] = f64::max(levels[n - 1], 1.0 - bare);
    }
    levels
}

/// The share that dots of a radius cover which stand at some places of a field of `pitch` by `spacing`.
fn dotted(pitch: Length, spacing: Length, radius: Length, places: &[[f64; 2]]) -> f64 {
    let (pitch, spacing, radius) = (pitch.to_mm(), spacing.to_mm(), radius.to_mm());
    let least = pitch.min(spacing) / if places.len() > 1 { 2.0 } else { 1.0 };
    if 2.0 * radius <= least {
        return places.len() as f64 * PI * radius * radius / (pitch * spacing);
    }
    if radius >= (pitch * pitch + spacing * spacing).sqrt() {
        return 1.0;
    }
    let side = f64::from(SAMPLES);
    let sample = |i: u32| (f64::from(i) + 0.5) / side;
    let is_inked = |u: f64, v: f64| {
        places.iter().any(|[along, across]| {
            // Of a dot's images the nearest in each direction counts.
            let off = |at: f64, step: f64| (at - at.round()) * step;
            let (x, y) = (off(u - along, spacing), off(v - across, pitch));
            x * x + y * y <= radius * radius
        })
    };
    let inked = (0..SAMPLES).flat_map(|j| (0..SAMPLES).map(move |i| (i, j)));
    inked.filter(|&(i, j)| is_inked(sample(i), sample(j))).count() as f64 / (side * side)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Cap, Hatch};

    fn hatch(pitch: f64, pen: f64) -> Hatch {
        Hatch { pitch: Length::mm(pitch), pen: Length::mm(pen), inset: 0.5, shortest: Length::ZERO, cap: Cap::Butt }
    }

    fn fill(kind: FillKind) -> Fill {
        Fill { kind, ink: None }
    }

    fn dots(radius: f64) -> Fill {
        fill(FillKind::Dots { hatch: hatch(1.0, 0.1), spacing: Length::mm(1.0), radius: Length::mm(radius) })
    }

    fn levels_of(fills: &[Fill]) -> [f64; 5] {
        levels(fills, Length::ZERO, &[1.0; 4])
    }

    fn near(found: [f64; 5], wanted: [f64; 5]) {
        for (found, wanted) in found.iter().zip(wanted) {
            assert!((found - wanted).abs() < 1e-9, "{found} instead of {wanted}");
        }
    }

    #[test]
    fn crossed_lines_leave_the_product_bare() {
        let lines = fill(FillKind::Lines(hatch(1.0, 0.25)));
        near(levels_of(&[lines.clone()]), [0.0, 0.25, 0.4375, 0.578_125, 0.683_593_75]);
        near(levels_of(&[lines, fill(FillKind::Solid)]), [0.0, 0.25, 1.0, 1.0, 1.0]);
    }

    #[test]
    fn ink_that_spreads_widens_both_edges() {
        let dash = |gain| {
            let kind = FillKind::Dashes { hatch: hatch(1.0, 0.2), dash: Length::mm(0.5), gap: Length::mm(0.5) };
            share(&kind, Length::mm(gain))
        };
        assert!((dash(0.0) - 0.1).abs() < 1e-12);
        assert!((dash(0.05) - 0.3 * 0.6).abs() < 1e-12);
        assert!((dash(2.0) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn dots_add_up_until_they_touch() {
        let one = PI * 0.04;
        near(levels_of(&[dots(0.2)]), [0.0, one, 2.0 * one, 3.0 * one, 4.0 * one]);
        let large = levels_of(&[dots(0.45)]);
        assert!((large[1] - PI * 0.2025).abs() < 1e-9);
        assert!(large[2] < 2.0 * large[1] - 0.2 && large[2] > large[1] + 0.2, "{large:?}");
        near(levels_of(&[dots(2.0)]), [0.0, 1.0, 1.0, 1.0, 1.0]);
    }

    #[test]
    fn what_tiles_do_not_hold_is_left_out() {
        let found = levels(&[fill(FillKind::Lines(hatch(1.0, 0.5)))], Length::ZERO, &[0.8, 1.0, 1.0, 1.0]);
        near(found, [0.0, 0.4, 0.7, 0.85, 0.925]);
    }
}
