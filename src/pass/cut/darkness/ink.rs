//! How much of the paper layers of a fill cover: shares of an area without end, reckoned from pitches and pens.
//!
//! Layers of strokes are turned against each other, so that what two of them leave bare is the product of what each
//! leaves bare. Dots of all layers stand on one lattice and add up until they touch. Dashes of all layers are set from the
//! site, where they fall on each other: what layers of them cover together is counted over a tile.

use std::f64::consts::PI;

use crate::geom::Length;
use crate::scene::{Fill, FillKind, Hatch};

use super::super::layers::MOST;
use super::NEAR;
use crate::stage::Layers;

/// Samples along a side of a field of dots that grow together.
const SAMPLES: u32 = 128;

/// Places at which layers of dashes are looked at.
const PLACES: u32 = 16_384;

/// The two steps of the additive sequence that fills a square most evenly: 1 / p and 1 / p^2 with p^3 = p + 1 (Roberts, "The
/// unreasonable effectiveness of quasirandom sequences", 2018).
const EVENLY: [f64; 2] = [0.754_877_666_246_692_7, 0.569_840_290_998_053_2];

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
/// a layer without end; `radius` is that of a disc as large as a tile.
pub(super) fn levels(
    fills: &[Fill],
    gain: Length,
    held: &[f64; MOST as usize],
    radius: Length,
) -> [f64; MOST as usize + 1] {
    let mut levels = [0.0; MOST as usize + 1];
    let mut bare = 1.0;
    // The fill whose marks stand between each other: what was bare before it, the numbers of its layers.
    let mut laid: Option<(&FillKind, f64, Vec<usize>)> = None;
    for n in 1..levels.len() {
        let Some(fill) = fills.get((n - 1).min(fills.len().saturating_sub(1))) else { return levels };
        let kind = &fill.kind;
        let held_by = |layers: &[usize]| layers.iter().map(|&layer| held[layer - 1]).sum::<f64>() / layers.len() as f64;
        match kind {
            FillKind::Dots { .. } | FillKind::Crosses { .. } | FillKind::Motif { .. } | FillKind::Dashes { .. } => {
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
                    FillKind::Dashes { .. } if layers.len() > 1 => match spread(kind, gain) {
                        FillKind::Dashes { hatch, dash, gap } => bricked(&hatch, dash, gap, &layers, radius),
                        _ => 0.0,
                    },
                    FillKind::Crosses { .. } => match spread(kind, gain) {
                        FillKind::Crosses { hatch, spacing, size } => {
                            let places: Vec<[f64; 2]> = layers.iter().map(|&layer| DOTS[layer - 1]).collect();
                            crossed(hatch.pitch, spacing, (size, hatch.pen), &places)
                        }
                        _ => 0.0,
                    },
                    _ => (share(kind, gain) * layers.len() as f64).min(1.0),
                };
                bare = before * (1.0 - inked * held_by(&layers)).clamp(0.0, 1.0);
                laid = Some((kind, before, layers));
            }
            FillKind::Lines(_)
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

/// The share of ink that layers have, from the share that 0 to 4 full ones cover. `drawn` says what of a full layer is drawn
/// in one, by its number, that stands so densely.
pub(super) fn of_layers(
    levels: &[f64; MOST as usize + 1],
    layers: Layers,
    mut drawn: impl FnMut(u8, f64) -> f64,
) -> f64 {
    if layers.is_solid {
        return 1.0;
    }
    let full = usize::from(layers.full).min(MOST as usize);
    let Some(&above) = levels.get(full + 1) else { return levels[full] };
    if layers.last < 1.0
        && let Some((bare, [last, next])) = steps(levels, full)
    {
        let last = 1.0 - last * drawn(full as u8, layers.last);
        return 1.0 - bare * last * (1.0 - next * drawn(full as u8 + 1, layers.part));
    }
    let drawn = if layers.part <= NEAR { 0.0 } else { drawn(full as u8 + 1, layers.part) };
    levels[full] + (above - levels[full]) * drawn
}

/// What is bare under the last of some full layers, and what that one and the next cover of what is bare under each.
pub(super) fn steps(levels: &[f64; MOST as usize + 1], full: usize) -> Option<(f64, [f64; 2])> {
    let bare = 1.0 - levels.get(full.checked_sub(1)?)?;
    let covered = 1.0 - levels.get(full)?;
    let all = 1.0 - levels.get(full + 1)?;
    let is_worth = bare > NEAR && covered > NEAR && bare - covered > NEAR;
    is_worth.then(|| (bare, [1.0 - covered / bare, 1.0 - all / covered]))
}

/// What of the ink of a full layer of a fill a layer of this density has: loops of scribble that stand farther apart lie less
/// on each other.
pub(super) fn inked(kind: &FillKind, gain: Length, density: f64) -> f64 {
    heaped(kind, gain).map_or(density, |full| (1.0 - libm::pow(1.0 - full, density)) / full)
}

/// The share of the paper that a full layer of a fill covers whose own marks lie on each other by chance; none for others.
pub(super) fn heaped(kind: &FillKind, gain: Length) -> Option<f64> {
    match kind {
        FillKind::Scribble { .. } => Some(share(kind, gain)).filter(|&full| full > 0.0 && full < 1.0),
        FillKind::Lines(_)
        | FillKind::Dashes { .. }
        | FillKind::Dots { .. }
        | FillKind::Crosses { .. }
        | FillKind::Arcs(_)
        | FillKind::Waves { .. }
        | FillKind::Nawaami { .. }
        | FillKind::Motif { .. }
        | FillKind::Solid => None,
    }
}

/// The share of a disc that layers of dashes cover together which are set like bricks from its middle.
fn bricked(hatch: &Hatch, dash: Length, gap: Length, layers: &[usize], radius: Length) -> f64 {
    let (pitch, dash, step) = (hatch.pitch.to_mm(), dash.to_mm(), (dash + gap).to_mm());
    let radius = radius.to_mm();
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let is_inked = |x: f64, y: f64| {
        layers.iter().any(|layer| {
            let (u, v) = match layer {
                1 => (x, y),
                2 => (y, x),
                3 => ((x + y) * half, (y - x) * half),
                _ => ((y - x) * half, (x + y) * half),
            };
            let line = (v / pitch).round();
            let bond = if line.rem_euclid(2.0) == 0.0 { 0.0 } else { step / 2.0 };
            let along = u - bond - ((u - bond) / step).round() * step;
            (v - line * pitch).abs() <= hatch.pen.to_mm() / 2.0 && along.abs() <= dash / 2.0
        })
    };
    let at = |i: u32, step: f64| ((0.5 + f64::from(i) * step).fract() * 2.0 - 1.0) * radius;
    let (mut all, mut inked) = (0.0, 0.0);
    for i in 0..PLACES {
        let (x, y) = (at(i, EVENLY[0]), at(i, EVENLY[1]));
        if x * x + y * y <= radius * radius {
            all += 1.0;
            inked += f64::from(u8::from(is_inked(x, y)));
        }
    }
    inked / all
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
    sampled([spacing, pitch], places, |x, y| x * x + y * y <= radius * radius)
}

/// The share that crosses with arms of a length and a width cover which stand at some places of a field of `pitch` by
/// `spacing`.
fn crossed(pitch: Length, spacing: Length, (size, pen): (Length, Length), places: &[[f64; 2]]) -> f64 {
    let (half, wide) = (size.to_mm() / 2.0, pen.to_mm() / 2.0);
    sampled([spacing.to_mm(), pitch.to_mm()], places, |x, y| {
        let (x, y) = (x.abs(), y.abs());
        (x <= half && y <= wide) || (x <= wide && y <= half)
    })
}

/// The share of a field that marks cover which stand at some places of each of its meshes; `is_inked` sees the way from the
/// middle of the nearest mark.
fn sampled([along, across]: [f64; 2], places: &[[f64; 2]], is_inked: impl Fn(f64, f64) -> bool) -> f64 {
    let side = f64::from(SAMPLES);
    let sample = |i: u32| (f64::from(i) + 0.5) / side;
    let is_covered = |u: f64, v: f64| {
        places.iter().any(|[x, y]| {
            // Of a mark's images the nearest in each direction counts.
            let off = |at: f64, step: f64| (at - at.round()) * step;
            is_inked(off(u - x, along), off(v - y, across))
        })
    };
    let covered = (0..SAMPLES).flat_map(|j| (0..SAMPLES).map(move |i| (i, j)));
    covered.filter(|&(i, j)| is_covered(sample(i), sample(j))).count() as f64 / (side * side)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Cap;

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
        levels(fills, Length::ZERO, &[1.0; 4], Length::mm(40.0))
    }

    fn near(found: [f64; 5], wanted: [f64; 5]) {
        for (found, wanted) in found.iter().zip(wanted) {
            assert!((found - wanted).abs() < 1e-9, "{found} instead of {wanted}");
        }
    }

    #[test]
    fn crossed_lines_leave_the_product_bare() {
        let lines = fill(FillKind::Lines(hatch(1.0, 0.25)));
        near(levels_of(std::slice::from_ref(&lines)), [0.0, 0.25, 0.4375, 0.578_125, 0.683_593_75]);
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
    fn dashes_that_fall_on_each_other_count_once() {
        let dash = Length::mm(0.5);
        let fills = [fill(FillKind::Dashes { hatch: hatch(0.2, 0.1), dash, gap: dash })];
        let covered = |radius: f64| levels(&fills, Length::ZERO, &[1.0; 4], Length::mm(radius))[4];
        // Far from the middle layers meet by chance; in a tile as wide as three dashes they lie on each other.
        assert!((covered(40.0) - (1.0 - 0.316_406_25)).abs() < 0.02, "{}", covered(40.0));
        assert!((covered(0.8) - 0.593).abs() < 0.02, "{}", covered(0.8));
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
        let found =
            levels(&[fill(FillKind::Lines(hatch(1.0, 0.5)))], Length::ZERO, &[0.8, 1.0, 1.0, 1.0], Length::mm(1.0));
        near(found, [0.0, 0.4, 0.7, 0.85, 0.925]);
    }
}
