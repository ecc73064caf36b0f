//! Parts of a picture as PNG: tiles for what is too large for SVG, and small pictures of the whole.

use crate::back::png;
use crate::back::raster::{Format, Pixels, Window, fitting, render_window};

use super::pictures::Picture;

/// A tile's side in pixels.
const SIDE: u32 = 512;

/// The coarsest and the finest level: level z has 2^z pixels a millimetre.
const LEVELS: std::ops::RangeInclusive<i32> = -6..=10;

/// The sides that a small picture may have.
const SMALL: std::ops::RangeInclusive<u32> = 16..=1024;

/// The tile of a level at a place, counted from the top left; none where the picture has none. What of it lies beyond the
/// page is transparent.
pub(super) fn tile(
    picture: &Picture,
    level: i32,
    [x, y]: [u32; 2],
    hidden: &[usize],
) -> Option<Result<Vec<u8>, String>> {
    if !LEVELS.contains(&level) {
        return None;
    }
    let per_mm = libm::ldexp(1.0, level);
    let page = &picture.drawing.page;
    let pixels = [page.width, page.height].map(|length| (length.to_mm() * per_mm).ceil().max(1.0) as u32);
    let corner = [x.checked_mul(SIDE)?, y.checked_mul(SIDE)?];
    if corner[0] >= pixels[0] || corner[1] >= pixels[1] {
        return None;
    }
    let window = Window { per_mm, corner, size: [SIDE, SIDE] };
    let drawn = render_window(&picture.drawing, picture.index(), &window, |layer| !hidden.contains(&layer));
    let inside = [0, 1].map(|i| (pixels[i] - corner[i]).min(SIDE) as usize);
    Some(encoded(&cut(drawn, inside)))
}

/// All of a picture, as large as fits into a square.
pub(super) fn thumb(picture: &Picture, side: u32, hidden: &[usize]) -> Result<Vec<u8>, String> {
    let side = side.clamp(*SMALL.start(), *SMALL.end());
    let page = &picture.drawing.page;
    let per_mm = fitting(&picture.drawing, side);
    let size = [page.width, page.height].map(|length| (length.to_mm() * per_mm).round().clamp(1.0, 1024.0) as u32);
    let window = Window { per_mm, corner: [0, 0], size };
    encoded(&render_window(&picture.drawing, picture.index(), &window, |layer| !hidden.contains(&layer)))
}

fn encoded(pixels: &Pixels) -> Result<Vec<u8>, String> {
    png::encode_quickly(pixels).map_err(|error| error.to_string())
}

/// Makes what lies beyond a width and height transparent.
fn cut(pixels: Pixels, [width, height]: [usize; 2]) -> Pixels {
    if width >= pixels.width && height >= pixels.height {
        return pixels;
    }
    let (format, colours, has_alpha) = match pixels.format {
        Format::Grey => (Format::GreyAlpha, 1, false),
        Format::GreyAlpha => (Format::GreyAlpha, 1, true),
        Format::Rgb => (Format::Rgba, 3, false),
        Format::Rgba => (Format::Rgba, 3, true),
        // Windows have all levels.
        Format::Indexed(_) => return pixels,
    };
    let stride = colours + usize::from(has_alpha);
    let mut data = Vec::with_capacity(pixels.width * pixels.height * (colours + 1));
    for (i, pixel) in pixels.data.chunks_exact(stride).enumerate() {
        let is_inside = i % pixels.width < width && i / pixels.width < height;
        data.extend_from_slice(&pixel[..colours]);
        data.push(if is_inside { pixel.get(colours).copied().unwrap_or(255) } else { 0 });
    }
    Pixels { format, data, ..pixels }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_lies_beyond_the_page_is_transparent() {
        let grey = Pixels { width: 3, height: 2, format: Format::Grey, data: vec![1, 2, 3, 4, 5, 6] };
        let found = cut(grey.clone(), [2, 1]);
        assert_eq!(found.format, Format::GreyAlpha);
        assert_eq!(found.data, [1, 255, 2, 255, 3, 0, 4, 0, 5, 0, 6, 0]);
        assert_eq!(cut(grey.clone(), [3, 2]), grey);
        let clear = Pixels { width: 2, height: 1, format: Format::Rgba, data: vec![1, 2, 3, 77, 4, 5, 6, 88] };
        assert_eq!(cut(clear, [1, 1]).data, [1, 2, 3, 77, 4, 5, 6, 0]);
    }
}
