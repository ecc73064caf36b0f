//! Outlines that need not be convex, with the convex pieces they are made of.
//!
//! Lines, dots and half-planes are cleanly cut against convex rings only. An outline that is not convex is therefore
//! taken apart once, and whoever cuts against it goes through its pieces: they share sides, but no area. A convex outline
//! is its own only piece and costs nothing more.

use super::clip::{TOLERANCE, convex_clearance, convex_overlap};
use super::{Point, ring_contains};

/// An outline, clockwise on the page, with its convex pieces.
#[derive(Debug, Clone, Copy)]
pub struct Figure<'a> {
    outline: &'a [Point],
    /// Corners of all pieces, one after the other; empty where the outline is convex.
    corners: &'a [Point],
    /// Where each piece ends in `corners`.
    ends: &'a [u32],
}

impl<'a> Figure<'a> {
    /// An outline that is convex; it may be empty.
    #[must_use]
    pub const fn convex(outline: &'a [Point]) -> Self {
        Self { outline, corners: &[], ends: &[] }
    }

    /// An outline that falls into pieces, with [`Pieces::corners`] of it.
    #[must_use]
    pub fn new(outline: &'a [Point], pieces: &'a Pieces, corners: &'a [Point]) -> Self {
        Self { outline, corners, ends: &pieces.ends }
    }

    /// The outline.
    #[must_use]
    pub const fn outline(&self) -> &'a [Point] {
        self.outline
    }

    /// Whether the outline is its own only piece.
    #[must_use]
    pub const fn is_convex(&self) -> bool {
        self.ends.is_empty()
    }

    /// The convex pieces, none of them empty.
    pub fn pieces(self) -> impl Iterator<Item = &'a [Point]> {
        let whole = if self.is_convex() && !self.outline.is_empty() { Some(self.outline) } else { None };
        let mut start = 0;
        let parts = self.ends.iter().map(move |&end| {
            let piece = &self.corners[start..end as usize];
            start = end as usize;
            piece
        });
        whole.into_iter().chain(parts)
    }

    /// The distance of a point from the outline in millimetres, positive inside; minus infinity for no outline.
    #[must_use]
    pub fn clearance(&self, p: Point) -> f64 {
        if self.is_convex() {
            return convex_clearance(self.outline, p);
        }
        let Some(&last) = self.outline.last() else { return f64::NEG_INFINITY };
        let (mut a, mut nearest) = (last, f64::INFINITY);
        for &b in self.outline {
            let edge = b - a;
            let length = edge.length_squared().max(TOLERANCE * TOLERANCE);
            nearest = nearest.min(a.lerp(b, ((p - a).dot(edge) / length).clamp(0.0, 1.0)).distance_squared(p));
            a = b;
        }
        if ring_contains(self.outline, p) { nearest.sqrt() } else { -nearest.sqrt() }
    }

    /// Whether two figures share more than their outlines.
    #[must_use]
    pub fn overlaps(self, other: Self) -> bool {
        self.pieces().any(|piece| other.pieces().any(|another| convex_overlap(piece, another)))
    }
}

/// How outlines of one shape fall into convex pieces, all in the same way.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Pieces {
    /// The numbers of all pieces' corners in the outline, piece by piece; empty where outlines are convex.
    order: Vec<u32>,
    /// Where each piece ends in `order`.
    ends: Vec<u32>,
}

impl Pieces {
    /// Of outlines that are convex.
    pub const NONE: Self = Self { order: Vec::new(), ends: Vec::new() };

    /// Of an outline made by [`simple_outline`].
    #[must_use]
    pub fn of(outline: &[Point]) -> Self {
        let rings = convex_pieces(outline);
        if rings.len() < 2 {
            return Self::default();
        }
        let ends = rings.iter().scan(0, |end, ring| {
            *end += ring.len() as u32;
            Some(*end)
        });
        let ends = ends.collect();
        Self { order: rings.into_iter().flatten().collect(), ends }
    }

    /// How many corners all pieces have together; none where outlines are convex.
    #[must_use]
    pub fn len(&self) -> usize {
        self.order.len()
    }

    /// Whether outlines are convex.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.order.is_empty()
    }

    /// The corners of all pieces of an outline, piece by piece.
    pub fn corners<'a>(&'a self, outline: &'a [Point]) -> impl Iterator<Item = Point> + 'a {
        self.order.iter().map(|&corner| outline[corner as usize])
    }
}

/// Why an outline cannot be that of a tile.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BadOutline {
    /// Fewer than three corners that differ.
    FewCorners,
    /// All corners on one line, or nearly so.
    Flat,
    /// Two of its sides meet where they are not neighbours, or run back over each other.
    Crossing,
}

/// The least area of an outline as a share of the square of its extent: below it a ring counts as a line.
const LEAST_AREA: f64 = 1e-6;

/// Corners that turn by less, as a share of the extent's square, lie on a straight line.
const STRAIGHT: f64 = 1e-12;

/// A ring as an outline of tiles: corners in one place merged, clockwise on the page.
///
/// # Errors
/// Where it has no area or its sides cross. All pairs of sides are looked at.
pub fn simple_outline(ring: &[Point]) -> Result<Vec<Point>, BadOutline> {
    let mut outline = ring.to_vec();
    let bounds = super::ring_bounds(ring);
    let extent = bounds.width().max(bounds.height());
    let is_same = |a: Point, b: Point| a.distance_squared(b) <= extent * extent * STRAIGHT;
    outline.dedup_by(|b, a| is_same(*a, *b));
    while outline.len() > 1 && is_same(outline[0], outline[outline.len() - 1]) {
        outline.pop();
    }
    let count = outline.len();
    if count < 3 {
        return Err(BadOutline::FewCorners);
    }
    let side = |i: usize| (outline[i], outline[(i + 1) % count]);
    for i in 0..count {
        let (a, b) = side(i);
        let (_, c) = side((i + 1) % count);
        // Neighbours share a corner, but may not run back.
        if turn(a, b, c).abs() <= extent * extent * STRAIGHT && (b - a).dot(c - b) < 0.0 {
            let area = super::ring_area(&outline).abs();
            return Err(if area < extent * extent * LEAST_AREA { BadOutline::Flat } else { BadOutline::Crossing });
        }
        for j in i + 2..count {
            if (j + 1) % count != i && meet(side(i), side(j)) {
                return Err(BadOutline::Crossing);
            }
        }
    }
    let area = super::ring_area(&outline);
    if area.abs() < extent * extent * LEAST_AREA {
        return Err(BadOutline::Flat);
    }
    if area < 0.0 {
        outline.reverse();
    }
    Ok(outline)
}

/// Twice the area of a triangle, positive where its corners run clockwise on the page.
fn turn(a: Point, b: Point, c: Point) -> f64 {
    (b - a).cross(c - a)
}

/// Whether two sides have a point in common.
fn meet((a, b): (Point, Point), (c, d): (Point, Point)) -> bool {
    let between = |a: Point, b: Point, p: Point| (p - a).dot(p - b) <= 0.0;
    let (abc, abd, cda, cdb) = (turn(a, b, c), turn(a, b, d), turn(c, d, a), turn(c, d, b));
    let crosses = (abc > 0.0) != (abd > 0.0) && (cda > 0.0) != (cdb > 0.0);
    crosses
        || (abc == 0.0 && between(a, b, c))
        || (abd == 0.0 && between(a, b, d))
        || (cda == 0.0 && between(c, d, a))
        || (cdb == 0.0 && between(c, d, b))
}

/// The convex pieces of an outline made by [`simple_outline`], as rings of corner numbers; a convex one is its own only
/// piece.
///
/// Ears are cut off until a triangle is left (Meisters 1975), then triangles are joined over every diagonal that a convex
/// piece can do without (Hertel and Mehlhorn 1983): at most four times as many pieces as there must be.
fn convex_pieces(outline: &[Point]) -> Vec<Vec<u32>> {
    let bounds = super::ring_bounds(outline);
    let extent = bounds.width().max(bounds.height());
    let straight = extent * extent * STRAIGHT;
    let turn_at = |ring: &[u32], i: usize| {
        let at = |i: usize| outline[ring[i % ring.len()] as usize];
        turn(at(i + ring.len() - 1), at(i), at(i + 1))
    };
    let mut left: Vec<u32> = (0..outline.len() as u32).collect();
    if (0..left.len()).all(|i| turn_at(&left, i) >= -straight) {
        return vec![left];
    }
    let mut pieces = Vec::new();
    while left.len() > 3 {
        let is_ear = |&i: &usize| {
            let [before, here, after] = [i + left.len() - 1, i, i + 1].map(|i| left[i % left.len()]);
            let [a, b, c] = [before, here, after].map(|corner| outline[corner as usize]);
            let holds = |p: Point| turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0;
            turn_at(&left, i) > straight
                && left.iter().all(|&j| [before, here, after].contains(&j) || !holds(outline[j as usize]))
        };
        // A straight corner takes no area away. That there is neither is rounding; any corner is as good then.
        let flat = (0..left.len()).find(|&i| turn_at(&left, i).abs() <= straight);
        let ear = flat.or_else(|| (0..left.len()).find(is_ear)).unwrap_or(0);
        if flat.is_none() {
            pieces.push([ear + left.len() - 1, ear, ear + 1].map(|i| left[i % left.len()]).to_vec());
        }
        left.remove(ear);
    }
    pieces.push(left);
    join(&mut pieces, |ring, i| turn_at(ring, i) >= -straight);
    pieces
}

/// Joins pieces that share a side and are convex together.
fn join(pieces: &mut Vec<Vec<u32>>, is_convex_at: impl Fn(&[u32], usize) -> bool) {
    let mut i = 0;
    while i < pieces.len() {
        let joined = (i + 1..pieces.len()).find_map(|j| {
            let ring = joined(&pieces[i], &pieces[j])?;
            (0..ring.len()).all(|k| is_convex_at(&ring, k)).then_some((j, ring))
        });
        match joined {
            // The greater piece may now take others that it could not before.
            Some((j, ring)) => {
                pieces[i] = ring;
                pieces.remove(j);
            }
            None => i += 1,
        }
    }
}

/// Two rings as one without the side they share, if they do.
fn joined(a: &[u32], b: &[u32]) -> Option<Vec<u32>> {
    for i in 0..a.len() {
        let (from, to) = (a[i], a[(i + 1) % a.len()]);
        let shared = (0..b.len()).find(|&j| b[j] == to && b[(j + 1) % b.len()] == from);
        if let Some(j) = shared {
            // From the side's end round a to its start, then round b back to before the end.
            let round_a = (1..=a.len()).map(|step| a[(i + step) % a.len()]);
            let round_b = (2..b.len()).map(|step| b[(j + step) % b.len()]);
            return Some(round_a.chain(round_b).collect());
        }
    }
    None
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::geom::{Angle, ring_area};

    fn ring(corners: &[(f64, f64)]) -> Vec<Point> {
        corners.iter().map(|&(x, y)| Point::new(x, y)).collect()
    }

    /// Corners in the order of their directions from the middle: never crossing, seldom convex.
    fn star() -> impl Strategy<Value = Vec<Point>> {
        prop::collection::vec(0.3..3.0f64, 3..24).prop_map(|radii| {
            let step = 360.0 / radii.len() as f64;
            radii
                .iter()
                .enumerate()
                .map(|(i, &radius)| Point::default() + Angle::degrees(step * i as f64).unit() * radius)
                .collect()
        })
    }

    fn pieces(outline: &[Point]) -> Vec<Vec<Point>> {
        let pieces = convex_pieces(outline);
        pieces.iter().map(|piece| piece.iter().map(|&i| outline[i as usize]).collect()).collect()
    }

    #[test]
    fn convex_rings_are_one_piece() {
        assert_eq!(convex_pieces(&ring(&[(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)])), [[0, 1, 2, 3]]);
        assert_eq!(pieces(&ring(&[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (2.0, 2.0)])).len(), 1);
    }

    #[test]
    fn arrows_crosses_and_combs_fall_into_few_pieces() {
        let arrow = ring(&[(0.0, 0.0), (4.0, 2.0), (0.0, 4.0), (1.0, 2.0)]);
        assert_eq!(pieces(&arrow).len(), 2);
        let cross = [(1, 0), (2, 0), (2, 1), (3, 1), (3, 2), (2, 2), (2, 3), (1, 3), (1, 2), (0, 2), (0, 1), (1, 1)];
        let cross: Vec<Point> = cross.iter().map(|&(x, y)| Point::new(f64::from(x), f64::from(y))).collect();
        assert!(pieces(&cross).len() <= 5);
        let comb = [(0, 0), (7, 0), (7, 3), (6, 3), (6, 1), (4, 1), (4, 3), (3, 3), (3, 1), (1, 1), (1, 3), (0, 3)];
        let comb: Vec<Point> = comb.iter().map(|&(x, y)| Point::new(f64::from(x), f64::from(y))).collect();
        assert!(pieces(&comb).len() <= 7);
        let area: f64 = pieces(&comb).iter().map(|piece| ring_area(piece)).sum();
        assert_eq!(area, ring_area(&comb));
    }

    #[test]
    fn bad_rings_are_told_apart() {
        let outcome = |corners: &[(f64, f64)]| simple_outline(&ring(corners)).map(|outline| outline.len());
        assert_eq!(outcome(&[(0.0, 0.0), (1.0, 0.0), (0.0, 0.0)]), Err(BadOutline::FewCorners));
        assert_eq!(outcome(&[]), Err(BadOutline::FewCorners));
        assert_eq!(outcome(&[(0.0, 0.0), (1.0, 1.0), (2.0, 2.0)]), Err(BadOutline::Flat));
        assert_eq!(outcome(&[(0.0, 0.0), (2.0, 2.0), (2.0, 0.0), (0.0, 2.0)]), Err(BadOutline::Crossing));
        assert_eq!(outcome(&[(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (2.0, 0.0)]), Err(BadOutline::Crossing));
        // A spike runs back over itself.
        let spike = [(0.0, 0.0), (2.0, 0.0), (4.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)];
        assert_eq!(outcome(&spike), Err(BadOutline::Crossing));
        // Closed by hand, and the other way round.
        let closed = [(0.0, 0.0), (0.0, 2.0), (2.0, 2.0), (2.0, 0.0), (0.0, 0.0)];
        assert_eq!(outcome(&closed), Ok(4));
        assert_eq!(ring_area(&simple_outline(&ring(&closed)).unwrap()), 4.0);
    }

    proptest! {
        #[test]
        fn pieces_are_convex_and_make_up_the_whole(outline in star()) {
            let outline = simple_outline(&outline).unwrap();
            let parts = pieces(&outline);
            let area: f64 = parts.iter().map(|piece| ring_area(piece)).sum();
            prop_assert!((area - ring_area(&outline)).abs() < 1e-9);
            for piece in &parts {
                for i in 0..piece.len() {
                    let at = |i: usize| piece[i % piece.len()];
                    prop_assert!(turn(at(i), at(i + 1), at(i + 2)) >= -1e-9);
                }
            }
            for (i, a) in parts.iter().enumerate() {
                prop_assert!(parts[i + 1..].iter().all(|b| !convex_overlap(a, b)));
            }
        }

        #[test]
        fn clearance_is_that_of_the_whole_outline(outline in star(), x in -3.0..3.0f64, y in -3.0..3.0f64) {
            let outline = simple_outline(&outline).unwrap();
            let pieces = Pieces::of(&outline);
            let corners: Vec<Point> = pieces.corners(&outline).collect();
            let figure = Figure::new(&outline, &pieces, &corners);
            let p = Point::new(x, y);
            let clearance = figure.clearance(p);
            let most = figure.pieces().map(|piece| convex_clearance(piece, p)).fold(f64::NEG_INFINITY, f64::max);
            // Inside some piece is inside, and no piece's disc is greater than the whole's.
            prop_assert!(clearance >= most - 1e-9);
            prop_assert_eq!(clearance > 1e-9, ring_contains(&outline, p) && clearance.abs() > 1e-9);
        }
    }
}
