//! The directions that the strokes of a tile's layers have.
//!
//! They are reckoned on a large area, from the fills: every layer weighs what length of stroke it has on a square millimetre,
//! so that it does not count where a tile's edge happens to cut a line off.

use crate::geom::bezier::cubics;
use crate::geom::course::{half_loop, half_wave};
use crate::geom::{Cubic, Vec2};
use crate::scene::{Fill, FillKind};
use crate::stage::Layers;

/// The most layers.
const LAYERS: usize = 4;

/// Chords that stand for a curve.
const CHORDS: u32 = 32;

/// The unit vectors at twice the angles by which layers are turned against their tile: 0, 90, 45 and 135 degrees.
const TURNS: [Vec2; LAYERS] = [Vec2::new(1.0, 0.0), Vec2::new(-1.0, 0.0), Vec2::new(0.0, 1.0), Vec2::new(0.0, -1.0)];

/// The strokes of all layers of a tone.
pub(super) struct Strokes([Moment; LAYERS]);

/// Strokes on an area.
#[derive(Debug, Clone, Copy, Default)]
struct Moment {
    /// Their length, on a square millimetre.
    length: f64,
    /// The sum over their length of the unit vector at twice their angle.
    sum: Vec2,
}

impl Strokes {
    /// Of a tone's fills: an item a layer, the last for all further ones.
    pub(super) fn of(fills: &[Fill]) -> Self {
        let moments: Vec<Moment> = fills.iter().take(LAYERS).map(|fill| moment(&fill.kind)).collect();
        Self(std::array::from_fn(|layer| {
            let Some(&moment) = moments.get(layer).or(moments.last()) else { return Moment::default() };
            let is_turned = fills.get(layer).or(fills.last()).is_some_and(|fill| !fill.kind.stands_on_one_lattice());
            let turn = if is_turned { TURNS[layer] } else { TURNS[0] };
            let sum = moment.sum;
            // The product of complex numbers adds angles.
            let sum = Vec2::new(sum.x * turn.x - sum.y * turn.y, sum.x * turn.y + sum.y * turn.x);
            Moment { sum, ..moment }
        }))
    }

    /// How evenly the strokes of a tile run in all directions: 1 less the length of the mean, over its strokes by length, of
    /// the unit vector at twice their angle. 0 where all are parallel, 1 where none prevails; none without strokes.
    pub(super) fn isotropy(&self, layers: Layers) -> Option<f64> {
        if layers.is_solid {
            return None;
        }
        let mut all = Moment::default();
        for (number, moment) in (1u8..).zip(self.0) {
            let density = match number {
                number if number < layers.full => 1.0,
                number if number == layers.full => layers.last,
                number if number == layers.full + 1 => layers.part,
                _ => 0.0,
            };
            all.length += moment.length * density;
            all.sum = all.sum + moment.sum * density;
        }
        (all.length > 0.0).then(|| (1.0 - all.sum.length() / all.length).clamp(0.0, 1.0))
    }
}

/// The strokes of a fill along +x. Dots and what is inked all over have none.
fn moment(kind: &FillKind) -> Moment {
    let straight = |length: f64| Moment { length, sum: Vec2::new(length, 0.0) };
    match kind {
        FillKind::Lines(hatch) => straight(1.0 / hatch.pitch.to_mm()),
        FillKind::Dashes { hatch, dash, gap } => straight(*dash / (*dash + *gap) / hatch.pitch.to_mm()),
        // One arm along the lines, one across.
        FillKind::Crosses { hatch, spacing, size } => {
            Moment { length: 2.0 * (*size / *spacing) / hatch.pitch.to_mm(), sum: Vec2::default() }
        }
        // Over a disc with the arcs' centre on its rim in the direction of the layer, the mean of the vector at twice the
        // angle as seen from the centre is 1/2, and arcs run across it.
        FillKind::Arcs(hatch) => {
            let length = 1.0 / hatch.pitch.to_mm();
            Moment { length, sum: Vec2::new(-length / 2.0, 0.0) }
        }
        // The other half is the mirror image: what goes up here goes down there.
        FillKind::Waves { hatch, swing } | FillKind::Nawaami { hatch, swing } => {
            let half = swing.wavelength / 2.0;
            let wave = along(&half_wave(half, swing.amplitude));
            let on = 1.0 / (half.to_mm() * hatch.pitch.to_mm());
            Moment { length: wave.length * on, sum: Vec2::new(wave.sum.x * on, 0.0) }
        }
        FillKind::Scribble { hatch, loops, spacing } => {
            let half = along(&half_loop(*loops, *spacing));
            let on = 2.0 / (spacing.to_mm() * hatch.pitch.to_mm());
            Moment { length: half.length * on, sum: Vec2::new(half.sum.x * on, 0.0) }
        }
        FillKind::Motif { hatch, spacing, figure } => {
            let curves = figure.0.iter().flat_map(|chain| cubics(chain)).map(|curve| along(&curve));
            let all = curves
                .fold(Moment::default(), |all, one| Moment { length: all.length + one.length, sum: all.sum + one.sum });
            let on = 1.0 / (spacing.to_mm() * hatch.pitch.to_mm());
            Moment { length: all.length * on, sum: all.sum * on }
        }
        FillKind::Dots { .. } | FillKind::Solid => Moment::default(),
    }
}

/// The length of a curve in millimetres, and the sum along it.
fn along(curve: &Cubic) -> Moment {
    let mut moment = Moment::default();
    let mut from = curve.start();
    for i in 1..=CHORDS {
        let to = curve.at(f64::from(i) / f64::from(CHORDS));
        let way = to - from;
        let length = way.length();
        if length > 0.0 {
            moment.length += length;
            moment.sum = moment.sum + Vec2::new(way.x * way.x - way.y * way.y, 2.0 * way.x * way.y) * (1.0 / length);
        }
        from = to;
    }
    moment
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::geom::{Angle, Length, Point};
    use crate::scene::{Cap, Hatch, MotifPath, Swing};

    fn hatch(pitch: f64) -> Hatch {
        let pen = Length::mm(0.1);
        Hatch { pitch: Length::mm(pitch), pen, inset: 0.5, shortest: Length::ZERO, cap: Cap::Butt }
    }

    fn isotropy(kinds: &[FillKind], layers: Layers) -> Option<f64> {
        let fills: Vec<Fill> = kinds.iter().map(|kind| Fill { kind: kind.clone(), ink: None }).collect();
        Strokes::of(&fills).isotropy(layers)
    }

    fn near(found: Option<f64>, wanted: f64) {
        assert!((found.unwrap() - wanted).abs() < 1e-9, "{found:?} instead of {wanted}");
    }

    #[test]
    fn crossing_layers_even_each_other_out() {
        let lines = [FillKind::Lines(hatch(0.5))];
        for (layers, wanted) in [(1, 0.0), (2, 1.0), (3, 2.0 / 3.0), (4, 1.0)] {
            near(isotropy(&lines, Layers::new(layers, 0.0)), wanted);
        }
        // Of a layer and half the next a third prevails.
        near(isotropy(&lines, Layers::new(1, 0.5)), 2.0 / 3.0);
        near(isotropy(&lines, Layers { last: 0.5, ..Layers::new(1, 0.5) }), 1.0);
        // So does what stands twice as densely.
        let both = [FillKind::Lines(hatch(0.5)), FillKind::Lines(hatch(1.0))];
        near(isotropy(&both, Layers::new(2, 0.0)), 2.0 / 3.0);
    }

    #[test]
    fn what_has_no_strokes_has_no_isotropy() {
        let dots = [FillKind::Dots { hatch: hatch(1.0), spacing: Length::mm(1.0), radius: Length::mm(0.2) }];
        assert_eq!(isotropy(&dots, Layers::new(2, 0.0)), None);
        assert_eq!(isotropy(&[FillKind::Lines(hatch(1.0))], Layers::new(0, 0.0)), None);
        assert_eq!(isotropy(&[FillKind::Lines(hatch(1.0))], Layers::SOLID), None);
        assert_eq!(isotropy(&[], Layers::new(1, 0.0)), None);
    }

    #[test]
    fn curves_run_in_several_directions() {
        let crosses = [FillKind::Crosses { hatch: hatch(1.0), spacing: Length::mm(1.0), size: Length::mm(0.5) }];
        near(isotropy(&crosses, Layers::new(1, 0.0)), 1.0);
        let waves = |amplitude: f64| {
            let swing = Swing { wavelength: Length::mm(2.0), amplitude: Length::mm(amplitude) };
            isotropy(&[FillKind::Waves { hatch: hatch(1.0), swing }], Layers::new(1, 0.0)).unwrap()
        };
        assert!(waves(0.01) < 0.01 && waves(0.2) > waves(0.1) && waves(0.2) < 0.5);
        // A figure of two strokes across each other, the longer one at 30 degrees.
        let way = Angle::degrees(30.0).unit();
        let stroke = |by: Vec2| Cubic::line(Point::default(), Point::default() + by).0.to_vec();
        let figure = MotifPath(Arc::from([stroke(way * 3.0), stroke(way.turned())]));
        let motif = [FillKind::Motif { hatch: hatch(1.0), spacing: Length::mm(4.0), figure }];
        near(isotropy(&motif, Layers::new(1, 0.0)), 0.5);
        // Figures of later layers are not turned.
        near(isotropy(&motif, Layers::new(2, 0.0)), 0.5);
    }

    #[test]
    fn arcs_run_across_the_way_to_their_foot() {
        let (mut all, mut sum) = (0.0, 0.0);
        for i in 0..400 {
            for j in 0..400 {
                let p = Vec2::new((f64::from(i) + 0.5) / 200.0 - 1.0, (f64::from(j) + 0.5) / 200.0 - 1.0);
                let way = p + Vec2::new(-1.0, 0.0);
                if p.length_squared() <= 1.0 {
                    all += 1.0;
                    sum += (way.x * way.x - way.y * way.y) / way.length_squared();
                }
            }
        }
        let found = isotropy(&[FillKind::Arcs(hatch(0.1))], Layers::new(1, 0.0)).unwrap();
        let counted: f64 = sum / all;
        assert!((found - (1.0 - counted.abs())).abs() < 0.01, "{found} {counted}");
    }
}
