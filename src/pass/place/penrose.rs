//! Penrose's rhombs (P3), thick and thin, by inflation.
//!
//! Both rhombs are halved across their shorter or longer diagonal into Robinson's triangles, which are cut into smaller
//! ones of the same two kinds, smaller by the golden ratio (Grünbaum and Shephard, "Tilings and patterns", 1987, section
//! 10.3; N. G. de Bruijn, "Algebraic theory of Penrose's non-periodic tilings", 1981). With ζ a fifth root of unity every
//! vertex is a + bζ + cζ² + dζ³ in whole numbers, and stays so: the golden ratio is a unit there.

use std::ops::{Add, Sub};

use crate::diag::Diagnostic;
use crate::geom::Point;
use crate::random::Stream;
use crate::scene::Placement;
use crate::stage::Sites;

use super::Ground;
use super::patch::{Cell, MOST_REACH, Patch};

/// How often the great triangle is cut: its legs are the golden ratio to this power, some 87 million edges.
const CUTS: u32 = 38;

/// The mean area of rhombs in square edges: thick ones of sin 72° are more than thin ones of sin 36° by the golden ratio.
const AREA: f64 = 0.812_299_240_582_265_8;

/// Rhombs of this edge in millimetres, whose edges lie at whole tenths of a turn from the horizontal. The stream chooses
/// which part of the tiling lies on the domain.
pub(super) fn place(placement: &Placement, ground: &Ground<'_>, edge: f64) -> Result<Sites, Diagnostic> {
    let mut patch = Patch::new(placement, ground, edge, AREA)?;
    let great = Triangle::great();
    let target = target(&great, &mut ground.stream("penrose"));
    // A vertex near by: from there all coefficients in the patch are small, and places exact.
    let origin = great.vertex_near(target);
    let moved = target - origin.place();
    let local = |p: Whole| p.place() - moved;
    let mut stack = vec![great.from(origin)];
    while let Some(triangle) = stack.pop() {
        let [a, b, c] = triangle.corners.map(local);
        // The other half of a rhomb reaches over its diagonal by less than an edge.
        if !patch.comes_near(&[a, b, c], 1.0) {
            continue;
        }
        if triangle.cuts > 0 {
            triangle.cut(|part| stack.push(part));
            continue;
        }
        // Of the two halves of a rhomb, which are mirror images, one stands for it.
        if (b - a).cross(c - a) < 0.0 {
            continue;
        }
        let [wa, wb, wc] = triangle.corners;
        let wd = wb + wc - wa;
        let half = |sum: Whole| {
            let doubled = sum.place();
            Point::new(doubled.x / 2.0, doubled.y / 2.0) - moved
        };
        let sides = [wa + wb, wb + wd, wd + wc, wc + wa].map(half);
        patch.offer(&Cell { corners: &[a, b, local(wd), c], site: half(wb + wc), sides: &sides });
    }
    Ok(patch.finish())
}

/// A random place deep enough in the great triangle for the greatest patch round it.
fn target(great: &Triangle, stream: &mut Stream) -> Point {
    let [a, b, c] = great.corners.map(Whole::place);
    let sides = [c.distance(b), a.distance(c), b.distance(a)];
    let around: f64 = sides.iter().sum();
    // The middle of the inscribed circle: corners weighed by the sides that face them.
    let weighed = |f: fn(Point) -> f64| (f(a) * sides[0] + f(b) * sides[1] + f(c) * sides[2]) / around;
    let radius = (b - a).cross(c - a).abs() / around;
    let free = (radius - MOST_REACH) * std::f64::consts::FRAC_1_SQRT_2;
    let [x, y] = stream.signed_pair();
    Point::new(weighed(|p| p.x) + x * free, weighed(|p| p.y) + y * free)
}

/// A whole number of the ring: its coefficients of 1, ζ, ζ² and ζ³. Places are counted in edges.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Whole([i64; 4]);

impl Whole {
    /// Divided by the golden ratio, that is times ζ + ζ⁻¹.
    fn over_golden(self) -> Self {
        let [a, b, c, d] = self.0;
        Self([b - a - d, c - d, b - a, c - a - d])
    }

    /// Where it lies in the plane, in edges.
    fn place(self) -> Point {
        let [a, b, c, d] = self.0.map(|coefficient| coefficient as f64);
        let [x, y] = [[COS_72, COS_144], [SIN_72, SIN_144]];
        Point::new(a + b * x[0] + (c + d) * x[1], b * y[0] + (c - d) * y[1])
    }
}

const COS_72: f64 = 0.309_016_994_374_947_45;
const SIN_72: f64 = 0.951_056_516_295_153_5;
const COS_144: f64 = -0.809_016_994_374_947_5;
const SIN_144: f64 = 0.587_785_252_292_473_1;

impl Add for Whole {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let ([a, b, c, d], [e, f, g, h]) = (self.0, other.0);
        Self([a + e, b + f, c + g, d + h])
    }
}

impl Sub for Whole {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        let ([a, b, c, d], [e, f, g, h]) = (self.0, other.0);
        Self([a - e, b - f, c - g, d - h])
    }
}

/// Which rhomb a triangle is half of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Half {
    /// Apex 36°, cut along the shorter diagonal.
    Thin,
    /// Apex 108°, cut along the longer diagonal.
    Thick,
}

/// One of Robinson's triangles: the apex, where two edges of the rhomb meet, and the ends of the diagonal.
#[derive(Debug, Clone, Copy)]
struct Triangle {
    half: Half,
    corners: [Whole; 3],
    /// How often it is still to be cut.
    cuts: u32,
}

impl Triangle {
    /// The triangle that all others are cut from.
    fn great() -> Self {
        // One leg lies along 1 and the other along -ζ³, a tenth of a turn from it; both grow by the golden ratio, which
        // is -ζ² - ζ³.
        let (mut one, mut other) = (Whole([1, 0, 0, 0]), Whole([0, 0, 0, -1]));
        for _ in 0..CUTS {
            (one, other) = (one + one.over_golden(), other + other.over_golden());
        }
        Self { half: Half::Thin, corners: [Whole([0; 4]), one, other], cuts: CUTS }
    }

    /// As seen from another origin.
    fn from(&self, origin: Whole) -> Self {
        Self { corners: self.corners.map(|corner| corner - origin), ..*self }
    }

    /// Calls `visit` with the triangles it consists of.
    fn cut(&self, mut visit: impl FnMut(Self)) {
        let cuts = self.cuts - 1;
        let mut part = |half, corners| visit(Self { half, corners, cuts });
        let [a, b, c] = self.corners;
        match self.half {
            Half::Thin => {
                let p = a + (b - a).over_golden();
                part(Half::Thin, [c, p, b]);
                part(Half::Thick, [p, c, a]);
            }
            Half::Thick => {
                let (q, r) = (b + (a - b).over_golden(), b + (c - b).over_golden());
                part(Half::Thick, [r, c, a]);
                part(Half::Thick, [q, r, b]);
                part(Half::Thin, [r, q, a]);
            }
        }
    }

    /// A vertex of the tiling not two edges away from a place in the triangle.
    fn vertex_near(&self, place: Point) -> Whole {
        let mut triangle = *self;
        while triangle.cuts > 0 {
            // The part that holds the place, or by rounding comes nearest to it.
            let mut best = (f64::NEG_INFINITY, triangle);
            triangle.cut(|part| {
                let depth = part.depth(place);
                if depth > best.0 {
                    best = (depth, part);
                }
            });
            triangle = best.1;
        }
        triangle.corners[0]
    }

    /// How far a place lies within the triangle; negative outside.
    fn depth(&self, place: Point) -> f64 {
        let [a, b, c] = self.corners.map(Whole::place);
        let hand = (b - a).cross(c - a).signum();
        let within = |from: Point, to: Point| {
            let way = to - from;
            hand * way.cross(place - from) / way.length()
        };
        within(a, b).min(within(b, c)).min(within(c, a))
    }
}
