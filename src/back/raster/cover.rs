//! Shapes as the share of every pixel that they cover: rings of straight sides go in, coverage comes out.
//!
//! Shares are exact areas and not counted samples, so that strokes far thinner than a pixel come out even. Every side adds,
//! row by row, the signed area to its right to the pixel that it crosses and to the next, and sums along the row are the
//! coverage (Levien 2016, "Inside the fastest font renderer in the world"). Rings of one shape must run the same way round;
//! where they overlap within a pixel they count twice, up to all of it.

use tiny_skia::{Path, PathSegment, Point};

/// The coverage of one shape after the other, within a tile of fixed size.
#[derive(Debug, Default)]
pub(super) struct Cover {
    width: usize,
    height: usize,
    /// What each pixel adds to the coverage along its row; two more than `width` in a row.
    sums: Vec<f32>,
    /// The first pixel of each row that adds anything, and the one after the last.
    touched: Vec<[usize; 2]>,
}

impl Cover {
    /// Lays a shape over a mask of a size. Where a mask is covered already, what is left is covered.
    pub(super) fn fill(&mut self, path: &Path, [width, height]: [usize; 2], mask: &mut [u8]) {
        if [self.width, self.height] != [width, height] {
            let (sums, touched) = (vec![0.0; (width + 2) * height], vec![[usize::MAX, 0]; height]);
            *self = Self { width, height, sums, touched };
        }
        let (mut first, mut last) = (Point::zero(), Point::zero());
        for segment in path.segments() {
            match segment {
                PathSegment::MoveTo(to) => (first, last) = (to, to),
                PathSegment::LineTo(to) | PathSegment::QuadTo(_, to) | PathSegment::CubicTo(_, _, to) => {
                    self.side(last, to);
                    last = to;
                }
                PathSegment::Close => {
                    self.side(last, first);
                    last = first;
                }
            }
        }
        let bounds = path.bounds();
        let row = |at: f32| (at.max(0.0) as usize).min(height);
        self.lay(row(bounds.top().floor()), row(bounds.bottom().ceil()), mask);
    }

    /// Adds a side of a ring.
    fn side(&mut self, a: Point, b: Point) {
        let (sign, a, b) = if a.y < b.y { (1.0, a, b) } else { (-1.0, b, a) };
        let (width, height) = (self.width as f32, self.height as f32);
        let (top, bottom) = (a.y.max(0.0), b.y.min(height));
        if top >= bottom {
            return;
        }
        let slope = (b.x - a.x) / (b.y - a.y);
        let x = |y: f32| a.x + (y - a.y) * slope;
        // What lies beside the tile covers it as its border would: the side is cut there.
        let crossing = |x: f32| (a.y + (x - a.x) / slope).clamp(top, bottom);
        let [mut left, mut right] = [top, top];
        if a.x.min(b.x) < 0.0 && a.x.max(b.x) > 0.0 {
            left = crossing(0.0);
        }
        if a.x.min(b.x) < width && a.x.max(b.x) > width {
            right = crossing(width);
        }
        let cuts = [top, left.min(right), left.max(right), bottom];
        for cut in cuts.windows(2) {
            let (top, bottom) = (cut[0], cut[1]);
            if top < bottom {
                let middle = x((top + bottom) / 2.0);
                if middle <= 0.0 {
                    self.piece(top, bottom, |_| 0.0, sign);
                } else if middle >= width {
                    self.piece(top, bottom, |_| width, sign);
                } else {
                    self.piece(top, bottom, |y| x(y).clamp(0.0, width), sign);
                }
            }
        }
    }

    /// Adds a part of a side that lies within the tile.
    fn piece(&mut self, top: f32, bottom: f32, x: impl Fn(f32) -> f32, sign: f32) {
        let mut from = x(top);
        for row in top as usize..(bottom.ceil() as usize).min(self.height) {
            let (start, end) = (top.max(row as f32), bottom.min((row + 1) as f32));
            let to = x(end);
            let area = (end - start) * sign;
            let (left, right) = (from.min(to), from.max(to));
            from = to;
            let first = left as usize;
            let sums = &mut self.sums[row * (self.width + 2)..(row + 1) * (self.width + 2)];
            let after = if right <= (first + 1) as f32 {
                // All in one column: as much as an upright side in its middle.
                let beside = (left + right) / 2.0 - first as f32;
                sums[first] += area * (1.0 - beside);
                sums[first + 1] += area * beside;
                first + 2
            } else {
                let each = 1.0 / (right - left);
                let after = right.ceil() as usize;
                let (inside, over) = ((first + 1) as f32 - left, right - (after - 1) as f32);
                let (head, tail) = (inside * inside * each / 2.0, over * over * each / 2.0);
                sums[first] += area * head;
                if after == first + 2 {
                    sums[first + 1] += area * (1.0 - head - tail);
                } else {
                    // The second column is covered by the rest of the first and by half of itself.
                    let second = each * (inside + 0.5);
                    sums[first + 1] += area * (second - head);
                    sums[first + 2..after - 1].iter_mut().for_each(|sum| *sum += area * each);
                    let before_last = second + (after - first - 3) as f32 * each;
                    sums[after - 1] += area * (1.0 - before_last - tail);
                }
                sums[after] += area * tail;
                after + 1
            };
            let [least, most] = &mut self.touched[row];
            *least = (*least).min(first);
            *most = (*most).max(after);
        }
    }

    /// Lays what was added over rows of the mask, and forgets it.
    fn lay(&mut self, top: usize, bottom: usize, mask: &mut [u8]) {
        let rows = self.sums.chunks_exact_mut(self.width + 2).zip(mask.chunks_exact_mut(self.width));
        for ((sums, mask), touched) in rows.zip(&mut self.touched).take(bottom).skip(top) {
            let [least, most] = std::mem::replace(touched, [usize::MAX, 0]);
            let Some(sums) = sums.get_mut(least..most) else { continue };
            let mut sum = 0.0;
            for (add, mask) in sums.iter().zip(&mut mask[least.min(self.width)..]) {
                sum += add;
                let covered = (f32::abs(sum).min(1.0) * 255.0 + 0.5) as u32;
                let left = (255 - u32::from(*mask)) * (255 - covered);
                *mask = (255 - (left + 127) / 255) as u8;
            }
            sums.fill(0.0);
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use tiny_skia::PathBuilder;

    use super::*;

    /// What a ring covers of each pixel of a tile of four by three.
    fn covered(ring: &[(f32, f32)]) -> Vec<u8> {
        let mut path = PathBuilder::new();
        path.move_to(ring[0].0, ring[0].1);
        ring[1..].iter().for_each(|&(x, y)| path.line_to(x, y));
        path.close();
        let mut mask = vec![0; 12];
        Cover::default().fill(&path.finish().unwrap(), [4, 3], &mut mask);
        mask
    }

    #[test]
    fn shares_are_areas() {
        // Half of a pixel's width and half of its height.
        let square = covered(&[(1.5, 0.5), (3.0, 0.5), (3.0, 2.0), (1.5, 2.0)]);
        assert_eq!(square, [0, 64, 128, 0, 0, 128, 255, 0, 0, 0, 0, 0]);
        // A triangle over all of the first row: its lower side falls by a pixel over four.
        let triangle = covered(&[(0.0, 0.0), (4.0, 0.0), (4.0, 1.0)]);
        assert_eq!(triangle, [32, 96, 159, 223, 0, 0, 0, 0, 0, 0, 0, 0]);
    }

    #[test]
    fn what_lies_beside_the_tile_is_cut_off() {
        let all = covered(&[(-50.0, -60.0), (70.0, -60.0), (70.0, 80.0), (-50.0, 80.0)]);
        assert_eq!(all, [255; 12]);
        assert_eq!(covered(&[(-5.0, 0.0), (-1.0, 0.0), (-1.0, 3.0), (-5.0, 3.0)]), [0; 12]);
        assert_eq!(covered(&[(5.0, 0.0), (9.0, 0.0), (9.0, 3.0), (5.0, 3.0)]), [0; 12]);
        // The diagonal enters at the left and leaves at the right in the middle of a row.
        let slanted = covered(&[(-4.0, 0.0), (8.0, 3.0), (8.0, 9.0), (-4.0, 9.0)]);
        assert_eq!(slanted, [0, 0, 0, 0, 223, 159, 96, 32, 255, 255, 255, 255]);
    }
}
