//! Chains of cubic Béziers by one parameter: its whole part counts the curves, its fraction is the parameter of one.

use super::bezier::{Cubic, cubics};
use super::{Point, Rect, Vec2};

/// Parts of a curve below this much of its parameter are rounding and left out of parts of chains.
const LEAST: f64 = 1e-9;

/// How many curves a chain has.
#[must_use]
pub const fn count(chain: &[Point]) -> usize {
    chain.len().saturating_sub(1) / 3
}

/// A curve of a chain.
#[must_use]
pub fn curve(chain: &[Point], number: usize) -> Option<Cubic> {
    chain.get(3 * number..3 * number + 4)?.try_into().ok().map(Cubic)
}

/// The curve at a parameter, and the parameter in it.
#[must_use]
pub fn locate(chain: &[Point], s: f64) -> Option<(Cubic, f64)> {
    let number = (s as usize).min(count(chain).saturating_sub(1));
    Some((curve(chain, number)?, s - number as f64))
}

/// Place and derivative at a parameter; zero for no chain.
#[must_use]
pub fn at(chain: &[Point], s: f64) -> (Point, Vec2) {
    locate(chain, s).map_or_else(Default::default, |(cubic, t)| (cubic.at(t), cubic.velocity(t)))
}

/// A box around a chain.
#[must_use]
pub fn bounds(chain: &[Point]) -> Rect {
    chain.iter().fold(Rect::EMPTY, |bounds, &p| bounds.including(p))
}

/// How long a chain is in millimetres.
#[must_use]
pub fn length(chain: &[Point]) -> f64 {
    cubics(chain).map(|cubic| cubic.length().to_mm()).sum()
}

/// The curves between two parameters of a chain: their numbers, and the parts of each.
pub fn parts(chain: &[Point], (from, to): (f64, f64)) -> impl Iterator<Item = (usize, f64, f64)> {
    let (first, last) = (from.max(0.0) as usize, (to.ceil() as usize).min(count(chain)));
    let part = move |number: usize| (number, (from - number as f64).max(0.0), (to - number as f64).min(1.0));
    (first..last).map(part).filter(|&(_, start, end)| end - start > LEAST)
}

/// Appends the part of a chain between two parameters. A part that goes on from the end of `out` is joined to it.
pub fn part(chain: &[Point], range: (f64, f64), out: &mut Vec<Point>) {
    for (number, start, end) in parts(chain, range) {
        let Some(cubic) = curve(chain, number) else { return };
        let Cubic([a, b, c, d]) = cubic.part(start, end);
        if out.is_empty() {
            out.push(a);
        }
        out.extend([b, c, d]);
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn chain() -> Vec<Point> {
        (0..10).map(|i| Point::new(f64::from(i), f64::from(i * i % 7))).collect()
    }

    #[test]
    fn parts_lie_on_the_chain() {
        let chain = chain();
        let mut out = Vec::new();
        part(&chain, (0.25, 2.5), &mut out);
        assert_eq!(count(&out), 3);
        assert_eq!((out[0], *out.last().unwrap()), (at(&chain, 0.25).0, at(&chain, 2.5).0));
        assert!(at(&out, 1.5).0.distance(at(&chain, 1.5).0) < 1e-12);
        let mut whole = Vec::new();
        part(&chain, (0.0, 3.0), &mut whole);
        assert_eq!(whole, chain);
    }

    #[test]
    fn slivers_at_joints_are_left_out() {
        let mut out = Vec::new();
        part(&chain(), (1.0 - 1e-12, 2.0 + 1e-12), &mut out);
        assert_eq!(out, chain()[3..7]);
    }
}
