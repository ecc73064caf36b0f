//! A picture of what went and what came.
//!
//! In: two pictures. Out: how many pixels differ, and a picture on white in which ink that went is red, ink that came blue
//! and ink that stayed grey. Ink is how far a pixel is from its paper, in the channel where that is farthest. Of two pixels
//! with the inks a and b that lie d apart, (a + b - d) / 2 stayed, the rest of a went and the rest of b came: what is common
//! to two points of a metric space seen from a third (Gromov's product), never negative, so that a change of colour shows
//! too.

use rayon::prelude::*;

use crate::back::raster::{Format, Pixels};
use crate::scene::Colour;

/// Channels that differ by so many levels of 255 look alike: less than can be seen on the page, more than what rounding
/// makes of a pixel on another machine.
const ALIKE: u8 = 5;

/// Ink that went.
const WENT: [f64; 3] = [215.0, 25.0, 28.0];
/// Ink that came.
const CAME: [f64; 3] = [25.0, 85.0, 205.0];
/// Ink that stayed.
const STAYED: [f64; 3] = [165.0, 165.0, 165.0];
/// Paper that went with its part of the sheet.
const PAPER_WENT: [u8; 3] = [253, 233, 231];
/// Paper that came.
const PAPER_CAME: [u8; 3] = [230, 238, 252];

/// What differs between two pictures.
#[derive(Debug, Clone, PartialEq)]
pub struct Difference {
    /// Pixels that differ visibly, those included that only one of the pictures has.
    pub changed: u64,
    /// Their share of the sheet that holds both pictures, in [0, 1].
    pub share: f64,
    /// What went in red, what came in blue, what stayed in grey, on white. Sheet that only one of the pictures has is tinted.
    pub picture: Pixels,
}

/// What differs between two pictures on white paper. They are laid on each other by their top left corners.
#[must_use]
pub fn pictures(old: &Pixels, new: &Pixels) -> Difference {
    pictures_on(old, new, [Colour::WHITE; 2])
}

/// What differs between two pictures, each on the paper of this colour: what is translucent is laid on it, and only what is
/// not of its colour is ink. Where the papers differ, so does every pixel.
#[must_use]
pub fn pictures_on(old: &Pixels, new: &Pixels, papers: [Colour; 2]) -> Difference {
    let (width, height) = (old.width.max(new.width), old.height.max(new.height));
    let mut data = vec![0; width * height * 3];
    let rows = data.par_chunks_mut((width * 3).max(1)).enumerate().map_init(
        || [Vec::new(), Vec::new()],
        |[before, after], (y, out)| {
            row(old, y, papers[0], before);
            row(new, y, papers[1], after);
            let mut changed = 0u64;
            for (x, out) in out.chunks_exact_mut(3).enumerate() {
                let (is_changed, colour) = pixel(before.get(x), after.get(x), papers);
                changed += u64::from(is_changed);
                out.copy_from_slice(&colour);
            }
            changed
        },
    );
    let changed: u64 = rows.sum();
    let share = changed as f64 / (width * height).max(1) as f64;
    Difference { changed, share, picture: Pixels { width, height, format: Format::Rgb, data } }
}

/// Whether a pixel changed, and its colour in the difference.
fn pixel(old: Option<&[u8; 3]>, new: Option<&[u8; 3]>, papers: [Colour; 2]) -> (bool, [u8; 3]) {
    let [old_paper, new_paper] = papers.map(|paper| [paper.r, paper.g, paper.b]);
    match (old, new) {
        (Some(&old), Some(&new)) => {
            let (a, b, d) = (apart(old, old_paper), apart(new, new_paper), apart(old, new));
            if d <= ALIKE {
                return (false, mixed(0.0, 0.0, share(a).midpoint(share(b)), [255; 3]));
            }
            let (a, b, d) = (share(a), share(b), share(d));
            // With two colours of paper the inks need not be nearer to each other than to their papers.
            let stayed = ((a + b - d) / 2.0).max(0.0);
            (true, mixed(a - stayed, b - stayed, stayed, [255; 3]))
        }
        (Some(&old), None) => (true, mixed(share(apart(old, old_paper)), 0.0, 0.0, PAPER_WENT)),
        (None, Some(&new)) => (true, mixed(0.0, share(apart(new, new_paper)), 0.0, PAPER_CAME)),
        // A corner of the common sheet that neither picture has.
        (None, None) => (false, [255; 3]),
    }
}

/// How far two colours are apart, in the channel where that is farthest.
fn apart(a: [u8; 3], b: [u8; 3]) -> u8 {
    let channels = a.into_iter().zip(b).map(|(a, b)| a.abs_diff(b));
    channels.max().unwrap_or(0)
}

fn share(levels: u8) -> f64 {
    f64::from(levels) / 255.0
}

/// Shares of the three inks on a paper; where they are more than one, they thin each other.
fn mixed(went: f64, came: f64, stayed: f64, paper: [u8; 3]) -> [u8; 3] {
    let sum = went + came + stayed;
    let thin = if sum > 1.0 { 1.0 / sum } else { 1.0 };
    let bare = (1.0 - sum).max(0.0);
    std::array::from_fn(|i| {
        let inks = went * WENT[i] + came * CAME[i] + stayed * STAYED[i];
        (thin * inks + bare * f64::from(paper[i])).round() as u8
    })
}

/// A row of a picture as red, green and blue on paper; empty below the picture.
fn row(pixels: &Pixels, y: usize, paper: Colour, out: &mut Vec<[u8; 3]>) {
    out.clear();
    let stride = pixels.width * pixels.format.channels();
    let Some(data) = y.checked_mul(stride).and_then(|start| pixels.data.get(start..start + stride)) else { return };
    match &pixels.format {
        Format::Grey => out.extend(data.iter().map(|&v| [v; 3])),
        Format::GreyAlpha => {
            let (pairs, _) = data.as_chunks::<2>();
            out.extend(pairs.iter().map(|&[v, a]| laid(Colour { r: v, g: v, b: v, a }, paper)));
        }
        Format::Rgb => out.extend(data.as_chunks::<3>().0),
        Format::Rgba => {
            let (fours, _) = data.as_chunks::<4>();
            out.extend(fours.iter().map(|&[r, g, b, a]| laid(Colour { r, g, b, a }, paper)));
        }
        Format::Indexed(palette) => {
            let laid: Vec<[u8; 3]> = palette.iter().map(|&colour| laid(colour, paper)).collect();
            let bare = [paper.r, paper.g, paper.b];
            out.extend(data.iter().map(|&i| laid.get(usize::from(i)).copied().unwrap_or(bare)));
        }
    }
}

/// A colour laid on paper, as a raster lays ink: in sRGB, rounded once.
fn laid(colour: Colour, paper: Colour) -> [u8; 3] {
    let alpha = u32::from(colour.a);
    let mix = |over: u8, under: u8| ((u32::from(over) * alpha + u32::from(under) * (255 - alpha) + 127) / 255) as u8;
    [mix(colour.r, paper.r), mix(colour.g, paper.g), mix(colour.b, paper.b)]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(width: usize, data: &[u8]) -> Pixels {
        Pixels { width, height: data.len() / width, format: Format::Grey, data: data.to_vec() }
    }

    fn colours(difference: &Difference) -> Vec<[u8; 3]> {
        difference.picture.data.as_chunks::<3>().0.to_vec()
    }

    const RED: [u8; 3] = [215, 25, 28];
    const BLUE: [u8; 3] = [25, 85, 205];
    const GREY: [u8; 3] = [165; 3];
    const WHITE: [u8; 3] = [255; 3];

    #[test]
    fn what_went_is_red_what_came_blue_and_what_stayed_grey() {
        let found = pictures(&grey(4, &[0, 255, 0, 255]), &grey(4, &[255, 0, 0, 255]));
        assert_eq!(colours(&found), [RED, BLUE, GREY, WHITE]);
        assert_eq!((found.changed, found.share), (2, 0.5));
    }

    #[test]
    fn a_level_more_or_less_is_nothing() {
        let found = pictures(&grey(3, &[0, 100, 255]), &grey(3, &[4, 105, 250]));
        assert_eq!(found.changed, 0);
        let found = pictures(&grey(3, &[0, 100, 255]), &grey(3, &[6, 106, 249]));
        assert_eq!(found.changed, 3);
    }

    #[test]
    fn another_size_is_laid_on_a_common_sheet() {
        let found = pictures(&grey(2, &[0, 255]), &grey(1, &[0, 0, 255]));
        assert_eq!((found.picture.width, found.picture.height), (2, 3));
        assert_eq!(colours(&found), [GREY, PAPER_WENT, BLUE, WHITE, PAPER_CAME, WHITE]);
        assert_eq!((found.changed, found.share), (3, 0.5));
        let nothing = pictures(&grey(1, &[]), &grey(1, &[]));
        assert_eq!((nothing.changed, nothing.share), (0, 0.0));
    }

    #[test]
    fn every_format_is_read() {
        let red = Colour { r: 255, g: 0, b: 0, a: 255 };
        let clear = Colour { r: 9, g: 9, b: 9, a: 0 };
        let forms = [
            (Format::Rgb, vec![255, 0, 0, 255, 255, 255]),
            (Format::Rgba, vec![255, 0, 0, 255, 9, 9, 9, 0]),
            (Format::Indexed(vec![clear, red]), vec![1, 0]),
        ];
        let forms = forms.map(|(format, data)| Pixels { width: 2, height: 1, format, data });
        for a in &forms {
            for b in &forms {
                assert_eq!(pictures(a, b).changed, 0, "{a:?} {b:?}");
            }
        }
        let shade = Pixels { width: 2, height: 1, format: Format::GreyAlpha, data: vec![0, 255, 0, 128] };
        let found = pictures(&shade, &grey(2, &[0, 127]));
        assert_eq!(found.changed, 0);
    }

    #[test]
    fn another_colour_went_and_came() {
        let one = |r, g, b| Pixels { width: 1, height: 1, format: Format::Rgb, data: vec![r, g, b] };
        let found = pictures(&one(255, 0, 0), &one(0, 0, 255));
        assert_eq!(found.changed, 1);
        let [r, _, b] = colours(&found)[0];
        assert!(r < 255 && b < 255 && r != b, "{found:?}");
    }

    #[test]
    fn white_ink_on_black_is_ink() {
        let found = pictures_on(&grey(3, &[255, 0, 0]), &grey(3, &[0, 255, 0]), [Colour::BLACK; 2]);
        assert_eq!(colours(&found), [RED, BLUE, WHITE]);
    }
}
