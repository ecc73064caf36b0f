//! The colour maps of overlays.

use colorous::{Color, Gradient};

use crate::geom::Angle;
use crate::scene::Colour;

/// Lightness of every direction's colour in OKLab.
const LIGHTNESS: f64 = 0.72;

/// Chroma of every direction's colour in OKLab: about the greatest at which all hues of this lightness are in sRGB.
const CHROMA: f64 = 0.118;

/// The hue of direction 0 in degrees, a red.
const FIRST_HUE: f64 = 25.0;

/// From few layers to many, light to dark.
const K: Gradient = colorous::YELLOW_GREEN_BLUE;

/// Which part of the gradient is used: its palest colours are lost on paper.
const K_FROM: f64 = 0.12;

/// From equal neighbours, a glaring red, over a grey that recedes to crossed ones, a blue; in OKLab, and readable without
/// telling red from green.
const CONTRAST: [[f64; 3]; 3] = [[0.6, 0.2, 0.11], [0.68, 0.02, 0.03], [0.5, -0.04, -0.16]];

/// The colour of a direction: once round the hues within half a turn, all equally light and vivid (OKLab, Ottosson
/// 2020), so that equal differences of direction look equally different and directions at right angles have opposite
/// hues.
#[must_use]
pub(super) fn direction(angle: Angle) -> Colour {
    let hue = angle * 2.0 + Angle::degrees(FIRST_HUE);
    let (sin, cos) = hue.sin_cos();
    oklab([LIGHTNESS, CHROMA * cos, CHROMA * sin])
}

/// The colour of so many layers, 0 to 4.
#[must_use]
pub(super) fn layers(k: f64) -> Colour {
    let Color { r, g, b } = K.eval_continuous(K_FROM + (1.0 - K_FROM) * (k / 4.0).clamp(0.0, 1.0));
    Colour { r, g, b, a: 255 }
}

/// The colour of a contrast from 0 to 1.
pub(super) fn contrast(contrast: f64) -> Colour {
    let [equal, half, crossed] = CONTRAST;
    let place = contrast.clamp(0.0, 1.0) * 2.0;
    let (from, to, share) = if place < 1.0 { (equal, half, place) } else { (half, crossed, place - 1.0) };
    oklab([0, 1, 2].map(|i| from[i] + (to[i] - from[i]) * share))
}

/// From OKLab to sRGB; what lies outside is moved to its border channel by channel.
fn oklab([lightness, a, b]: [f64; 3]) -> Colour {
    let cube = |v: f64| v * v * v;
    let l = cube(lightness + 0.396_337_777_4 * a + 0.215_803_757_3 * b);
    let m = cube(lightness - 0.105_561_345_8 * a - 0.063_854_172_8 * b);
    let s = cube(lightness - 0.089_484_177_5 * a - 1.291_485_548_0 * b);
    let channel = |linear: f64| {
        let linear = linear.clamp(0.0, 1.0);
        let value = if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * libm::pow(linear, 1.0 / 2.4) - 0.055 };
        (value * 255.0).round() as u8
    };
    Colour {
        r: channel(4.076_741_662_1 * l - 3.307_711_591_3 * m + 0.230_969_929_2 * s),
        g: channel(-1.268_438_004_6 * l + 2.609_757_401_1 * m - 0.341_319_396_5 * s),
        b: channel(-0.004_196_086_3 * l - 0.703_418_614_7 * m + 1.707_614_701_0 * s),
        a: 255,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn greys_are_grey() {
        assert_eq!(oklab([1.0, 0.0, 0.0]), Colour::WHITE);
        assert_eq!(oklab([0.0, 0.0, 0.0]), Colour::BLACK);
    }

    #[test]
    fn directions_close_their_circle_and_oppose_at_right_angles() {
        let at = |degrees: f64| direction(Angle::degrees(degrees));
        assert_eq!(at(0.0), at(180.0));
        let distance = |a: Colour, b: Colour| {
            let d = |a: u8, b: u8| (f64::from(a) - f64::from(b)).powi(2);
            d(a.r, b.r) + d(a.g, b.g) + d(a.b, b.b)
        };
        for degrees in (0..180).step_by(5).map(f64::from) {
            assert!(distance(at(degrees), at(degrees + 90.0)) > 1.8 * distance(at(degrees), at(degrees + 20.0)));
        }
    }

    #[test]
    fn every_hue_is_in_srgb() {
        // Where a channel is cut off, colours would not be equally light: none comes to either end.
        for degrees in 0..180 {
            let Colour { r, g, b, .. } = direction(Angle::degrees(f64::from(degrees)));
            assert!([r, g, b].into_iter().all(|v| v > 0 && v < 255), "{degrees}: {r} {g} {b}");
        }
    }
}
