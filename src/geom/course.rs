//! The curves that fills are made of: half waves, half loops and circles, as cubic Béziers.

use super::{Cubic, Length, Point, Vec2};

/// How far the control points of half a sine wave lie from its ends, as a share of its length: 1 - 2 / pi, at which the slope
/// midway is that of the sine. The curve lies within a thousandth of the amplitude of it.
const WAVE: f64 = 0.363_380_227_632_418_7;

/// How far the control points of a quarter of a circle lie from its ends, in radii: 4 / 3 (sqrt 2 - 1).
const QUARTER: f64 = 0.552_284_749_830_793_4;

/// A quarter of a circle as a Bézier lies off by this share of the radius at most, and an eighth by the second.
const OFF: f64 = 2.73e-4;

/// The same control points for an eighth: 4 / 3 tan(pi / 16).
const EIGHTH: f64 = 0.265_216_489_839_544_1;

/// How far the control points of half a loop reach beside it, in its heights: as those of half a circle.
const LOOP: f64 = 2.0 / 3.0;

/// Half a sine wave from its least value at (0, -amplitude) to its greatest at (length, amplitude).
#[must_use]
pub fn half_wave(length: Length, amplitude: Length) -> Cubic {
    let (length, amplitude) = (length.to_mm(), amplitude.to_mm());
    Cubic([
        Point::new(0.0, -amplitude),
        Point::new(WAVE * length, -amplitude),
        Point::new(length - WAVE * length, amplitude),
        Point::new(length, amplitude),
    ])
}

/// Half a loop: from the top at (0, -height / 2) forwards round to the bottom, half a spacing on, where it runs backwards.
#[must_use]
pub fn half_loop(height: Length, spacing: Length) -> Cubic {
    let (top, bottom) =
        (Point::new(0.0, -height.to_mm() / 2.0), Point::new(spacing.to_mm() / 2.0, height.to_mm() / 2.0));
    let [fore, back] = loop_handles(height.to_mm(), spacing.to_mm());
    Cubic([top, top + Vec2::new(fore, 0.0), bottom + Vec2::new(back, 0.0), bottom])
}

/// How far the control points of a loop lie before and after its top, and before and after its bottom, where it runs backwards;
/// in the unit of height and spacing.
#[must_use]
pub fn loop_handles(height: f64, spacing: f64) -> [f64; 2] {
    let drift = spacing / 6.0;
    [LOOP * height + drift, LOOP * height - drift]
}

/// Appends a closed chain along a circle, clockwise on the page. It starts and ends in the direction `start` of length 1 from
/// the centre, and lies within a tolerance of the circle where eight curves can.
pub fn circle(centre: Point, radius: Length, start: Vec2, tolerance: Length, chain: &mut Vec<Point>) {
    let r = radius.to_mm();
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let (count, handle) = if r * OFF <= tolerance.to_mm() { (4, QUARTER) } else { (8, EIGHTH) };
    let mut from = start;
    chain.push(centre + from * r);
    for i in 1..=count {
        let to = if i == count {
            start
        } else if count == 4 {
            from.turned()
        } else {
            (from + from.turned()) * half
        };
        chain.push(centre + (from + from.turned() * handle) * r);
        chain.push(centre + (to - to.turned() * handle) * r);
        chain.push(centre + to * r);
        from = to;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::bezier::cubics;

    #[test]
    fn half_a_wave_is_a_sine() {
        let (length, amplitude) = (3.0, 0.7);
        let half = half_wave(Length::mm(length), Length::mm(amplitude));
        for i in 0..=100 {
            let p = half.at(f64::from(i) / 100.0);
            let sine = -amplitude * libm::cos(std::f64::consts::PI * p.x / length);
            assert!((p.y - sine).abs() < 1e-3 * amplitude, "{p:?}");
        }
        assert!(
            (half.tangent(0.5).map_or(0.0, |v| v.y / v.x) - std::f64::consts::PI * amplitude / length).abs() < 1e-12
        );
    }

    #[test]
    fn circles_are_round_and_closed() {
        for (radius, curves) in [(0.5, 4), (400.0, 8)] {
            let (centre, mut chain) = (Point::new(3.0, -2.0), Vec::new());
            circle(centre, Length::mm(radius), Vec2::new(0.6, 0.8), Length::mm(0.0025), &mut chain);
            assert_eq!(cubics(&chain).count(), curves);
            assert_eq!(chain.first(), chain.last());
            for cubic in cubics(&chain) {
                for i in 0..=20 {
                    assert!((cubic.at(f64::from(i) / 20.0).distance(centre) - radius).abs() < 0.0025);
                }
            }
        }
    }

    #[test]
    fn loops_run_on_from_each_other() {
        let half = half_loop(Length::mm(2.0), Length::mm(0.8));
        assert_eq!((half.start(), half.end()), (Point::new(0.0, -1.0), Point::new(0.4, 1.0)));
        assert!(half.velocity(0.0).x > 0.0 && half.velocity(1.0).x < 0.0);
        assert!(half.velocity(0.0).y.abs() < 1e-12 && half.velocity(1.0).y.abs() < 1e-12);
    }
}
