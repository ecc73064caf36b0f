//! Hilbert's curve: an order of the plane in which what comes next lies near.

use super::{Point, Rect};

/// How far along the curve a cell of a grid of 2^16 a side lies.
#[must_use]
pub fn place(mut x: u16, mut y: u16) -> u32 {
    let mut distance = 0;
    for bit in (0..16).rev() {
        let (right, down) = (x >> bit & 1, y >> bit & 1);
        distance = distance << 2 | u32::from((3 * right) ^ down);
        // The curve within a quarter is turned so that its ends meet those of the next.
        if down == 0 {
            if right == 1 {
                (x, y) = (!x, !y);
            }
            (x, y) = (y, x);
        }
    }
    distance
}

/// The indices of points along the curve over the box that holds them all; those of one cell in their own order.
#[must_use]
pub fn order(points: &[Point]) -> Vec<u32> {
    let bounds = points.iter().fold(Rect::EMPTY, |bounds, &point| bounds.including(point));
    let scale = f64::from(u16::MAX) / bounds.width().max(bounds.height());
    let mut order: Vec<(u32, u32)> = (0u32..)
        .zip(points)
        .map(|(index, &point)| {
            let way = point - bounds.min;
            (place((way.x * scale) as u16, (way.y * scale) as u16), index)
        })
        .collect();
    order.sort_unstable();
    order.into_iter().map(|(_, index)| index).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_that_follow_each_other_share_a_side() {
        let mut cells: Vec<(u32, [i32; 2])> =
            (0..64).flat_map(|x| (0..64).map(move |y| (place(x, y), [i32::from(x), i32::from(y)]))).collect();
        cells.sort_unstable();
        for pair in cells.windows(2) {
            let [(_, a), (_, b)] = [pair[0], pair[1]];
            assert_eq!((a[0] - b[0]).abs() + (a[1] - b[1]).abs(), 1, "{a:?} {b:?}");
        }
    }

    #[test]
    fn every_point_comes_once_even_in_one_place() {
        let points = [Point::new(1.0, 1.0); 3];
        assert_eq!(order(&points), [0, 1, 2]);
        assert!(order(&[]).is_empty());
    }
}
