//! Chains of cubic Béziers, each of 3n + 1 points: building, cutting and straightening them.

use super::{FLATTENING, Region};
use crate::geom::bezier::cubics;
use crate::geom::{Cubic, Point, Rect};

/// Adds a straight piece from `a`, the chain's last point, to `b`; nothing where they are the same.
pub(super) fn push_line(chain: &mut Vec<Point>, a: Point, b: Point) {
    if a != b {
        chain.extend_from_slice(&Cubic::line(a, b).0[1..]);
    }
}

/// Makes an open chain longer by straight pieces of `by` millimetres at both ends, in their directions.
pub(super) fn lengthen(chain: &mut Vec<Point>, by: f64) {
    let (Some(&first), Some(&last)) = (chain.first(), chain.last()) else { return };
    if first == last {
        return;
    }
    let beyond = |end: Point, mut others: Box<dyn Iterator<Item = &Point> + '_>| {
        let other = others.find(|&&p| p != end)?;
        let way = end - *other;
        Some(end + way * (by / way.length()))
    };
    let before = beyond(first, Box::new(chain.iter()));
    let after = beyond(last, Box::new(chain.iter().rev()));
    let mut longer = Vec::with_capacity(chain.len() + 6);
    if let Some(before) = before {
        longer.push(before);
        push_line(&mut longer, before, first);
        longer.pop();
    }
    longer.append(chain);
    if let Some(after) = after {
        push_line(&mut longer, last, after);
    }
    *chain = longer;
}

/// The pieces of a chain that lie in a region, in order. A closed chain that lies in it whole stays closed.
#[must_use]
pub fn clipped(chain: &[Point], region: &Region) -> Vec<Vec<Point>> {
    let bounds = chain.iter().fold(Rect::EMPTY, |bounds, &p| bounds.including(p));
    let Some(&first) = chain.first() else { return Vec::new() };
    if !region.touches_outline(bounds) {
        return if region.contains(first) { vec![chain.to_vec()] } else { Vec::new() };
    }
    // Stretches as numbers: the Bézier's place in the chain and the parameter within it.
    let mut stretches: Vec<(f64, f64)> = Vec::new();
    let mut inside = Vec::new();
    for (i, cubic) in cubics(chain).enumerate() {
        let count = cubic.steps(FLATTENING);
        let mut a = cubic.start();
        for (k, b) in (0..count).zip(cubic.flatten(FLATTENING)) {
            inside.clear();
            region.clip_line(a, b, &mut inside);
            for &(from, to) in &inside {
                let at = |share: f64| i as f64 + (f64::from(k) + share) / f64::from(count);
                match stretches.last_mut() {
                    // Where one piece ends and the next begins nothing is cut.
                    Some(last) if from == 0.0 && last.1 == at(0.0) => last.1 = at(to),
                    _ => stretches.push((at(from), at(to))),
                }
            }
            a = b;
        }
    }
    let end = (chain.len() / 3) as f64;
    let mut found: Vec<Vec<Point>> = stretches.iter().map(|&(from, to)| stretch(chain, from, to)).collect();
    let wraps = chain.last() == Some(&first)
        && stretches.len() > 1
        && stretches.first().is_some_and(|s| s.0 == 0.0)
        && stretches.last().is_some_and(|s| s.1 == end);
    if wraps && let Some(mut joined) = found.pop() {
        let start = found.remove(0);
        joined.extend_from_slice(start.get(1..).unwrap_or_default());
        found.insert(0, joined);
    }
    found.retain(|chain| chain.len() > 1);
    found
}

/// The corners of a chain whose pieces are all straight, within a thousandth of a millimetre.
#[must_use]
pub fn straight(chain: &[Point]) -> Option<Vec<Point>> {
    const NEAR: f64 = 1e-3;
    let is_straight =
        |Cubic([a, b, c, d])| a.lerp(d, 1.0 / 3.0).distance(b) <= NEAR && a.lerp(d, 2.0 / 3.0).distance(c) <= NEAR;
    cubics(chain).all(is_straight).then(|| chain.iter().step_by(3).copied().collect())
}

/// From one place of a chain to another, both as numbers of Béziers.
fn stretch(chain: &[Point], from: f64, to: f64) -> Vec<Point> {
    let mut out = Vec::new();
    for (i, cubic) in cubics(chain).enumerate() {
        let (from, to) = ((from - i as f64).max(0.0), (to - i as f64).min(1.0));
        if from >= to {
            continue;
        }
        let Cubic([a, b, c, d]) = cubic.part(from, to);
        if out.is_empty() {
            out.push(a);
        }
        out.extend([b, c, d]);
    }
    out
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::geom::Length;

    fn points(list: &[(f64, f64)]) -> Vec<Point> {
        list.iter().map(|&(x, y)| Point::new(x, y)).collect()
    }

    #[test]
    fn chains_are_cut_where_the_outline_crosses() {
        let window = Region::rect(Rect::new(Point::new(2.0, -5.0), Point::new(6.0, 5.0)));
        let mut line = points(&[(0.0, 0.0)]);
        push_line(&mut line, Point::new(0.0, 0.0), Point::new(4.0, 0.0));
        push_line(&mut line, Point::new(4.0, 0.0), Point::new(8.0, 0.0));
        let cut = clipped(&line, &window);
        let corners: Vec<Point> = straight(&cut[0]).unwrap();
        assert_eq!((cut.len(), corners), (1, points(&[(2.0, 0.0), (4.0, 0.0), (6.0, 0.0)])));
        let beside: Vec<Point> = line.iter().map(|p| Point::new(p.x, p.y + 9.0)).collect();
        assert!(clipped(&beside, &window).is_empty());
        // An arch that leaves above and comes back.
        let arch = points(&[(3.0, 0.0), (3.0, 12.0), (5.0, 12.0), (5.0, 0.0)]);
        let cut = clipped(&arch, &window);
        assert_eq!(cut.len(), 2);
        assert!(cut.iter().flatten().all(|p| p.y < 5.01) && straight(&cut[0]).is_none());
        assert_eq!((cut[0][0], cut[1][3]), (arch[0], arch[3]));
    }

    #[test]
    fn closed_chains_are_joined_where_they_begin() {
        let disc = Region::circle(Point::new(0.0, 0.0), Length::mm(5.0));
        let mut square = points(&[(0.0, 0.0)]);
        for (a, b) in
            [((0.0, 0.0), (9.0, 0.0)), ((9.0, 0.0), (9.0, 9.0)), ((9.0, 9.0), (0.0, 9.0)), ((0.0, 9.0), (0.0, 0.0))]
        {
            push_line(&mut square, Point::new(a.0, a.1), Point::new(b.0, b.1));
        }
        let cut = clipped(&square, &disc);
        assert_eq!(cut.len(), 1);
        let corners = straight(&cut[0]).unwrap();
        assert_eq!(corners[1], Point::new(0.0, 0.0));
        assert!(corners[0].distance(Point::new(0.0, 5.0)) < 0.01 && corners[2].distance(Point::new(5.0, 0.0)) < 0.01);
        let whole = Region::circle(Point::new(0.0, 0.0), Length::mm(50.0));
        assert_eq!(clipped(&square, &whole), [square]);
    }

    #[test]
    fn open_chains_grow_at_both_ends() {
        let mut line = points(&[(0.0, 0.0)]);
        push_line(&mut line, Point::new(0.0, 0.0), Point::new(4.0, 0.0));
        lengthen(&mut line, 1.0);
        assert_eq!(straight(&line).unwrap(), points(&[(-1.0, 0.0), (0.0, 0.0), (4.0, 0.0), (5.0, 0.0)]));
    }
}
