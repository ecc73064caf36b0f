//! Least squares of two parameters within bounds.
//!
//! The method is the trust-region reflective one of Branch, Coleman and Li (SIAM J. Sci. Comput. 21, 1999): Gauss-Newton
//! steps in variables that shrink towards the bounds (Coleman and Li, SIAM J. Optim. 6, 1996), within a trust region
//! whose multiplier is found by Newton's steps (Moré 1978), and where a step would leave the bounds the best of the step
//! cut short, its reflection and the steepest descent. Constants and stopping rules are those of SciPy's `least_squares`
//! with `method="trf"`, so that a fit takes the same way and stops at the same place: in a flat valley that place is not
//! the bottom to more than three digits, and figures made with SciPy can only be met by stopping where it does.

/// Two parameters, or one value for each.
pub(super) type Pair = [f64; 2];

/// A residual and its derivatives.
pub(super) type Row = (f64, Pair);

/// When a fit has arrived: relative changes of the cost and of the parameters, and the gradient, as SciPy has them.
const TOLERANCE: f64 = 1e-8;

/// The most evaluations.
const EVALUATIONS: usize = 200;

/// The values that parameters may take, both ends included.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bounds {
    /// The least.
    pub(super) low: Pair,
    /// The greatest; above the least.
    pub(super) high: Pair,
}

/// Fits parameters from a start within the bounds: the sum of the squares of all residuals becomes least. Residuals have to
/// be finite within the bounds. The result lies strictly inside, by the smallest step of a number where it would be on a
/// bound.
pub(super) fn fit(start: Pair, bounds: Bounds, rows: impl Fn(Pair) -> Vec<Row>) -> Pair {
    let mut x = bounds.inside(start, 1e-10);
    let mut here = Model::new(&rows(x));
    let (v, _) = bounds.scaling(x, here.gradient);
    let mut radius = norm([x[0] / v[0].sqrt(), x[1] / v[1].sqrt()]);
    if radius == 0.0 {
        radius = 1.0;
    }
    let mut multiplier = 0.0;
    let mut evaluations = 1;
    while evaluations < EVALUATIONS {
        let (v, dv) = bounds.scaling(x, here.gradient);
        let steepness = (here.gradient[0] * v[0]).abs().max((here.gradient[1] * v[1]).abs());
        if steepness < TOLERANCE {
            break;
        }
        let scaled = Scaled::new(&here, v, dv);
        // How near to a bound a step may come.
        let share = f64::max(0.995, 1.0 - steepness);
        let mut has_arrived = false;
        let mut next = None;
        while next.is_none() && !has_arrived && evaluations < EVALUATIONS {
            let newton = scaled.step(radius, multiplier);
            multiplier = newton.1;
            let step = scaled.within(&bounds, x, newton.0, radius, share);
            let moved = scaled.unscaled(step.to);
            let there = bounds.inside([x[0] + moved[0], x[1] + moved[1]], 0.0);
            let model = Model::new(&rows(there));
            evaluations += 1;
            let length = norm(step.to);
            let gain = here.cost - model.cost;
            if !model.cost.is_finite() {
                radius = 0.25 * length;
                continue;
            }
            let ratio = match step.gain {
                expected if expected > 0.0 => gain / expected,
                expected if expected == 0.0 && gain == 0.0 => 1.0,
                _ => 0.0,
            };
            let old = radius;
            if ratio < 0.25 {
                radius = 0.25 * length;
            } else if ratio > 0.75 && length > 0.95 * radius {
                radius *= 2.0;
            }
            has_arrived =
                (gain < TOLERANCE * here.cost && ratio > 0.25) || norm(moved) < TOLERANCE * (TOLERANCE + norm(x));
            if !has_arrived {
                multiplier *= old / radius;
            }
            if gain > 0.0 {
                next = Some((there, model));
            }
        }
        if let Some(next) = next {
            (x, here) = next;
        }
        if has_arrived {
            break;
        }
    }
    x
}

impl Bounds {
    /// The parameters, moved off the bounds by so much, or by the smallest step of a number where that is nothing.
    fn inside(&self, x: Pair, by: f64) -> Pair {
        std::array::from_fn(|i| {
            let (low, high) = (self.low[i], self.high[i]);
            let (below, above) = (by * low.abs().max(1.0), by * high.abs().max(1.0));
            if x[i] - low <= below.min(high - x[i]) || x[i] <= low {
                if by == 0.0 { low.next_up() } else { low + below }
            } else if high - x[i] <= above.min(x[i] - low) || x[i] >= high {
                if by == 0.0 { high.next_down() } else { high - above }
            } else {
                x[i]
            }
        })
    }

    /// The parameters, put on a bound where a fit has come as near to it as it can, and whether one is.
    pub(super) fn snapped(&self, x: Pair) -> (Pair, bool) {
        let near = |i: usize| 1e-6 * (self.high[i] - self.low[i]);
        let snapped = std::array::from_fn(|i| match x[i] {
            value if value - self.low[i] < near(i) => self.low[i],
            value if self.high[i] - value < near(i) => self.high[i],
            value => value,
        });
        (snapped, snapped != x)
    }

    /// How far each parameter is from the bound that the descent leads to, and how that changes with it.
    fn scaling(&self, x: Pair, gradient: Pair) -> (Pair, Pair) {
        let each = |i: usize| match gradient[i] {
            g if g < 0.0 => (self.high[i] - x[i], -1.0),
            g if g > 0.0 => (x[i] - self.low[i], 1.0),
            _ => (1.0, 0.0),
        };
        let [(v0, dv0), (v1, dv1)] = [each(0), each(1)];
        ([v0, v1], [dv0, dv1])
    }

    /// How many of these steps lead to the first bound, and which parameters are then on one.
    fn strides(&self, x: Pair, step: Pair) -> (f64, [bool; 2]) {
        let strides: Pair = std::array::from_fn(|i| {
            if step[i] == 0.0 {
                f64::INFINITY
            } else {
                ((self.low[i] - x[i]) / step[i]).max((self.high[i] - x[i]) / step[i])
            }
        });
        let least = strides[0].min(strides[1]);
        (least, strides.map(|stride| stride == least))
    }

    fn hold(&self, x: Pair) -> bool {
        (0..2).all(|i| self.low[i] <= x[i] && x[i] <= self.high[i])
    }
}

/// The residuals at a place, as far as a step needs them.
struct Model {
    /// Half the sum of the squares.
    cost: f64,
    /// Its gradient.
    gradient: Pair,
    rows: Vec<Row>,
}

impl Model {
    fn new(rows: &[Row]) -> Self {
        let cost = 0.5 * rows.iter().map(|(f, _)| f * f).sum::<f64>();
        let gradient = [0, 1].map(|i| rows.iter().map(|(f, slopes)| f * slopes[i]).sum());
        Self { cost, gradient, rows: rows.to_vec() }
    }
}

/// A quadratic model of the cost in the scaled variables.
struct Scaled {
    /// What a scaled step is multiplied by.
    scale: Pair,
    gradient: Pair,
    /// The product of the scaled derivatives with themselves.
    product: [Pair; 2],
    /// What the scaling itself adds to the curvature.
    diagonal: Pair,
    /// Singular values of the derivatives with the diagonal below them, the greater first; the coefficients of the residuals
    /// along them; and the directions that belong to them.
    singular: Pair,
    coefficients: Pair,
    directions: [Pair; 2],
    /// How many residuals there are.
    count: usize,
}

/// A step in the scaled variables, and by how much the model says that it lessens the cost.
struct Step {
    to: Pair,
    gain: f64,
}

impl Scaled {
    fn new(model: &Model, v: Pair, dv: Pair) -> Self {
        let scale = v.map(f64::sqrt);
        let diagonal = [0, 1].map(|i| model.gradient[i] * dv[i]);
        let columns: [Vec<f64>; 2] = [0, 1].map(|i| {
            let mut column: Vec<f64> = model.rows.iter().map(|(_, slopes)| slopes[i] * scale[i]).collect();
            column.extend([0, 1].map(|j| if i == j { diagonal[i].sqrt() } else { 0.0 }));
            column
        });
        let products = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let count = model.rows.len();
        let [p, q, r] = [(0, 0), (1, 1), (0, 1)].map(|(i, j)| products(&columns[i][..count], &columns[j][..count]));
        // Two columns are made square to each other by one rotation (Hestenes 1958): their lengths are the singular values.
        let [a, b, c] = [(0, 0), (1, 1), (0, 1)].map(|(i, j)| products(&columns[i], &columns[j]));
        let angle = 0.5 * libm::atan2(2.0 * c, a - b);
        let (sin, cos) = libm::sincos(angle);
        let directions = [[cos, sin], [-sin, cos]];
        let turned = directions
            .map(|[x, y]| -> Vec<f64> { columns[0].iter().zip(&columns[1]).map(|(a, b)| x * a + y * b).collect() });
        let singular = [0, 1].map(|i: usize| products(&turned[i], &turned[i]).sqrt());
        let coefficients = [0, 1].map(|i: usize| {
            let along: f64 = turned[i].iter().zip(&model.rows).map(|(t, (f, _))| t * f).sum();
            if singular[i] > 0.0 { along / singular[i] } else { 0.0 }
        });
        let gradient = [0, 1].map(|i| model.gradient[i] * scale[i]);
        Self { scale, gradient, product: [[p, r], [r, q]], diagonal, singular, coefficients, directions, count }
    }

    fn unscaled(&self, step: Pair) -> Pair {
        [step[0] * self.scale[0], step[1] * self.scale[1]]
    }

    /// The least of the model within the trust region, and the multiplier that leads there from the one before.
    fn step(&self, radius: f64, multiplier: f64) -> (Pair, f64) {
        let along = |lengths: Pair| -> Pair {
            std::array::from_fn(|i| -(self.directions[0][i] * lengths[0] + self.directions[1][i] * lengths[1]))
        };
        let [s, t] = self.singular;
        let has_full_rank = t > f64::EPSILON * self.count as f64 * s;
        if has_full_rank {
            let newton = along([self.coefficients[0] / s, self.coefficients[1] / t]);
            if norm(newton) <= radius {
                return (newton, 0.0);
            }
        }
        let weights = [s * self.coefficients[0], t * self.coefficients[1]];
        let excess = |multiplier: f64| {
            let denominators = [s * s + multiplier, t * t + multiplier];
            let length = norm([weights[0] / denominators[0], weights[1] / denominators[1]]);
            let slope: f64 =
                (0..2).map(|i| weights[i] * weights[i] / (denominators[i] * denominators[i] * denominators[i])).sum();
            (length - radius, -slope / length)
        };
        let mut upper = norm(weights) / radius;
        let mut lower = if has_full_rank {
            let (excess, slope) = excess(0.0);
            -excess / slope
        } else {
            0.0
        };
        let between = |lower: f64, upper: f64| f64::max(0.001 * upper, (lower * upper).sqrt());
        let mut multiplier = if !has_full_rank && multiplier == 0.0 { between(lower, upper) } else { multiplier };
        for _ in 0..10 {
            if multiplier < lower || multiplier > upper {
                multiplier = between(lower, upper);
            }
            let (excess, slope) = excess(multiplier);
            if excess < 0.0 {
                upper = multiplier;
            }
            let ratio = excess / slope;
            lower = lower.max(multiplier - ratio);
            multiplier -= (excess + radius) * ratio / radius;
            if excess.abs() < 0.01 * radius {
                break;
            }
        }
        let step = along([weights[0] / (s * s + multiplier), weights[1] / (t * t + multiplier)]);
        let length = norm(step);
        if length > 0.0 { (step.map(|part| part * (radius / length)), multiplier) } else { (step, multiplier) }
    }

    /// The product of two steps under the model's curvature.
    fn curvature(&self, a: Pair, b: Pair) -> f64 {
        let sides = |i: usize| a[i] * (self.product[i][0] * b[0] + self.product[i][1] * b[1] + self.diagonal[i] * b[i]);
        sides(0) + sides(1)
    }

    /// By how much a step lessens the model.
    fn gain(&self, step: Pair) -> f64 {
        -(0.5 * self.curvature(step, step) + dot(self.gradient, step))
    }

    /// The best step that stays within the bounds.
    fn within(&self, bounds: &Bounds, x: Pair, step: Pair, radius: f64, share: f64) -> Step {
        let moved = self.unscaled(step);
        if bounds.hold([x[0] + moved[0], x[1] + moved[1]]) {
            return Step { to: step, gain: self.gain(step) };
        }
        let (stride, hits) = bounds.strides(x, moved);
        let mut reflected = step;
        for i in 0..2 {
            if hits[i] {
                reflected[i] = -reflected[i];
            }
        }
        let cut = step.map(|part| part * stride);
        let on_bound = self.unscaled(cut);
        let from = [x[0] + on_bound[0], x[1] + on_bound[1]];
        let to_bound = bounds.strides(from, self.unscaled(reflected)).0;
        let to_radius = leaves(cut, reflected, radius);
        let room = to_bound.min(to_radius);
        let (least, most) = if room > 0.0 {
            ((1.0 - share) * stride / room, if room == to_bound { share * to_bound } else { to_radius })
        } else {
            (0.0, -1.0)
        };
        let along = |from: Pair, way: Pair, least: f64, most: f64| {
            let linear = dot(self.gradient, way) + self.curvature(from, way);
            let stride = lowest(0.5 * self.curvature(way, way), linear, least, most);
            let to = [from[0] + stride * way[0], from[1] + stride * way[1]];
            Step { to, gain: self.gain(to) }
        };
        let reflection = (least <= most).then(|| along(cut, reflected, least, most));
        let cut = cut.map(|part| part * share);
        let cut = Step { to: cut, gain: self.gain(cut) };
        let descent = self.gradient.map(|slope| -slope);
        let to_radius = radius / norm(descent);
        let to_bound = bounds.strides(x, self.unscaled(descent)).0;
        let most = if to_bound < to_radius { share * to_bound } else { to_radius };
        let descent = along([0.0; 2], descent, 0.0, most);
        match reflection {
            Some(reflection) if reflection.gain > cut.gain && reflection.gain > descent.gain => reflection,
            Some(reflection) if cut.gain > reflection.gain && cut.gain > descent.gain => cut,
            None if cut.gain > descent.gain => cut,
            Some(_) | None => descent,
        }
    }
}

/// Where a t^2 + b t is least within the range.
fn lowest(a: f64, b: f64, least: f64, most: f64) -> f64 {
    let value = |t: f64| t * (a * t + b);
    let ends = if value(most) < value(least) { most } else { least };
    let bottom = -0.5 * b / a;
    if a != 0.0 && least < bottom && bottom < most && value(bottom) < value(ends) { bottom } else { ends }
}

/// How many of these steps from a place lead out of the trust region.
fn leaves(from: Pair, step: Pair, radius: f64) -> f64 {
    let a = dot(step, step);
    let b = dot(from, step);
    let c = (dot(from, from) - radius * radius).min(0.0);
    let root = (b * b - a * c).sqrt();
    // The greater root, without the difference of like numbers.
    if b <= 0.0 { (root - b) / a } else { -c / (b + root) }
}

fn dot(a: Pair, b: Pair) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn norm(a: Pair) -> f64 {
    dot(a, a).sqrt()
}

#[cfg(test)]
mod tests {
    use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
    use nalgebra::storage::Owned;
    use nalgebra::{Dyn, OMatrix, OVector, U2, Vector2};
    use proptest::prelude::*;

    use super::*;

    /// Points near A exp(-t / b).
    #[derive(Debug, Clone)]
    struct Points {
        parameters: Pair,
        values: Vec<f64>,
    }

    impl Points {
        fn rows(&self, [a, b]: Pair) -> Vec<Row> {
            let row = |(t, value): (u32, &f64)| {
                let share = libm::exp(-f64::from(t) / b);
                (a * share - value, [share, a * share * f64::from(t) / (b * b)])
            };
            (1u32..).zip(&self.values).map(row).collect()
        }

        fn cost(&self, parameters: Pair) -> f64 {
            Model::new(&self.rows(parameters)).cost
        }
    }

    impl LeastSquaresProblem<f64, Dyn, U2> for Points {
        type ParameterStorage = Owned<f64, U2>;
        type ResidualStorage = Owned<f64, Dyn>;
        type JacobianStorage = Owned<f64, Dyn, U2>;

        fn set_params(&mut self, parameters: &Vector2<f64>) {
            self.parameters = [parameters.x, parameters.y];
        }

        fn params(&self) -> Vector2<f64> {
            Vector2::from(self.parameters)
        }

        fn residuals(&self) -> Option<OVector<f64, Dyn>> {
            Some(OVector::from(self.rows(self.parameters).iter().map(|(f, _)| *f).collect::<Vec<f64>>()))
        }

        fn jacobian(&self) -> Option<OMatrix<f64, Dyn, U2>> {
            let rows = self.rows(self.parameters);
            Some(OMatrix::from_fn_generic(Dyn(rows.len()), U2, |row, column| rows[row].1[column]))
        }
    }

    proptest! {
        /// The library knows no bounds and stops later: within them both come to the same bottom.
        #[test]
        fn an_independent_method_finds_nothing_lower(
            a in 0.2..1.5,
            b in 0.5..8.0,
            noise in proptest::collection::vec(-0.05..0.05, 8..16),
        ) {
            let law = |t: u32| a * libm::exp(-f64::from(t) / b);
            let values: Vec<f64> = (1u32..).zip(&noise).map(|(t, noise)| law(t) + noise).collect();
            let points = Points { parameters: [0.7, 2.0], values };
            let bounds = Bounds { low: [0.0, 0.01], high: [2.0, 100.0] };
            let ours = fit(points.parameters, bounds, |parameters| points.rows(parameters));
            prop_assert!(bounds.hold(ours));
            let (theirs, report) = LevenbergMarquardt::new().minimize(points.clone());
            if report.termination.was_successful() && bounds.hold(theirs.parameters) {
                let [ours, theirs] = [ours, theirs.parameters].map(|parameters| points.cost(parameters));
                prop_assert!(ours <= theirs * (1.0 + 1e-5) + 1e-12, "{} {}", ours, theirs);
            }
        }

        #[test]
        fn the_best_of_a_line_lies_within_the_bounds(slope in -3.0..3.0f64, low in -1.0..0.5f64, width in 0.1..4.0f64) {
            // Residuals x - slope and y - 2 are least at the nearest point of the bounds.
            let bounds = Bounds { low: [low, 0.0], high: [low + width, 1.0] };
            let [x, y] = fit([low + width / 2.0, 0.5], bounds, |[x, y]| vec![(x - slope, [1.0, 0.0]), (y - 2.0, [0.0, 1.0])]);
            prop_assert!((x - slope.clamp(low, low + width)).abs() < 1e-4, "{} {}", x, slope);
            prop_assert!((y - 1.0).abs() < 1e-4, "{}", y);
        }
    }
}
