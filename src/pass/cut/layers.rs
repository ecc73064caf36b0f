//! How many layers a tile has: what becomes of the fraction of k.

use crate::field::Field;
use crate::geom::Point;
use crate::stage::{Graph, Layers};

/// The greatest number of layers.
pub(super) const MOST: f64 = 4.0;

/// Fractions nearer to a whole number are rounding.
const ROUNDING: f64 = 1e-9;

/// The nearest whole number, halves up. `k` lies in 0..=4, as in all functions here.
pub(super) fn step(k: f64) -> Layers {
    Layers::new(whole(k), 0.0)
}

/// Whole layers, and of the next one the share that is left.
pub(super) fn partial(k: f64) -> Layers {
    let full = (k + ROUNDING).floor();
    let part = k - full;
    Layers::new(full as u8, if part > ROUNDING { part } else { 0.0 })
}

/// Whole numbers whose errors are passed on in equal shares to neighbours that come later; what the last of their
/// neighbourhood leaves over is lost. It runs over all tiles, drawn or not, so that moving a region's outline changes
/// no tile.
pub(super) fn dither(k: &[f64], graph: &Graph) -> Vec<Layers> {
    let mut wanted = k.to_vec();
    (0..k.len())
        .map(|i| {
            let full = whole(wanted[i].clamp(0.0, MOST));
            // Neighbours ascend.
            let neighbours = graph.neighbours(i);
            let later = &neighbours[neighbours.partition_point(|&j| j as usize <= i)..];
            let error = (wanted[i] - f64::from(full)) / later.len().max(1) as f64;
            for &j in later {
                wanted[j as usize] += error;
            }
            Layers::new(full, 0.0)
        })
        .collect()
}

/// The layers that occur anywhere in a tile whose layer n ends where the field is n - 0.5: the greatest number at the
/// site, the corners, halfway between corners and halfway in.
pub(super) fn most(field: &Field, site: Point, ring: &[Point]) -> u8 {
    let mut greatest = field.at(site);
    let Some(&last) = ring.last() else { return 0 };
    let mut a = last;
    for &b in ring {
        for p in [b, a.lerp(b, 0.5)] {
            greatest = greatest.max(field.at(p)).max(field.at(p.lerp(site, 0.5)));
        }
        a = b;
    }
    whole(greatest.clamp(0.0, MOST))
}

/// The nearest whole number, halves up.
fn whole(k: f64) -> u8 {
    (k + 0.5).floor() as u8
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::Node;

    #[test]
    fn halves_go_up() {
        assert_eq!([0.49, 0.5, 1.5, 3.49, 4.0].map(|k| step(k).full), [0, 1, 2, 3, 4]);
    }

    #[test]
    fn partial_keeps_the_fraction() {
        assert_eq!(partial(2.25), Layers::new(2, 0.25));
        assert_eq!(partial(2.0 - 1e-12), Layers::new(2, 0.0));
        assert_eq!(partial(4.0), Layers::new(4, 0.0));
    }

    #[test]
    fn dithering_keeps_the_mean() {
        let n = 400;
        let edges: Vec<[u32; 2]> = (1..n).map(|i| [i - 1, i]).collect();
        let graph = Graph::new(n as usize, &edges, Vec::new());
        for k in [0.3, 1.5, 3.9] {
            let layers = dither(&vec![k; n as usize], &graph);
            let sum: u32 = layers.iter().map(|l| u32::from(l.full)).sum();
            assert!((f64::from(sum) - k * f64::from(n)).abs() <= 0.5 + 1e-9, "{k}: {sum}");
        }
    }

    #[test]
    fn most_looks_all_over_the_tile() {
        let (from, to) = (Point::new(0.0, 0.0), Point::new(4.0, 0.0));
        let field = Field::new(Node::Linear { from, to, start: 0.0, end: 4.0 });
        let ring = [Point::new(0.0, 0.0), Point::new(3.6, 0.0), Point::new(3.6, 1.0), Point::new(0.0, 1.0)];
        assert_eq!(most(&field, Point::new(1.0, 0.5), &ring), 4);
        assert_eq!(most(&Field::constant(0.4), Point::new(1.0, 0.5), &ring), 0);
    }
}
