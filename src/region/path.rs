//! SVG path data: text and the length of its unit come in, flattened lines go out.

use std::fmt;

use svgtypes::{Error, PathParser, PathSegment};

use super::curve::{Arc, CurvePen, Draw, Pen, Subpath};
use super::{FillRule, Region};
use crate::geom::{Angle, Length, Point, Vec2};

/// What is wrong with path data.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PathError {
    /// Where, in bytes from the start.
    pub offset: usize,
    /// What.
    pub problem: PathProblem,
}

/// The ways in which path data can be wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PathProblem {
    /// It draws nothing.
    Empty,
    /// It does not begin with `M` or `m`.
    NoStart,
    /// Something that is neither a command nor a number where one belongs.
    Unexpected,
    /// A number is missing or cannot be read.
    BadNumber,
    /// It ends in the middle of a command.
    Unfinished,
    /// A coordinate is too large to be a number.
    TooLarge,
    /// The lines cross too often.
    TooTangled,
}

impl fmt::Display for PathError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self.problem {
            PathProblem::Empty => "the path draws nothing",
            PathProblem::NoStart => "a path begins with `M` and the point where it starts",
            PathProblem::Unexpected => "this is no command of a path",
            PathProblem::BadNumber => "here the path needs a number",
            PathProblem::Unfinished => "the path ends in the middle of a command",
            PathProblem::TooLarge => "a coordinate of the path is too large",
            PathProblem::TooTangled => "the path crosses itself more than a million times",
        })
    }
}

impl std::error::Error for PathError {}

/// The lines that path data draws, one for every `M`; curves are flattened within [`super::FLATTENING`].
///
/// # Errors
/// Says where the data is wrong.
pub fn subpaths(data: &str, unit: Length) -> Result<Vec<Subpath>, PathError> {
    let subpaths = read(data, unit, Pen::default())?.finish();
    check(subpaths.iter().map(|subpath| subpath.points.as_slice()))?;
    Ok(subpaths)
}

/// The chains of cubic Béziers that path data draws, one for every `M`: each its first point, and then two control points and
/// an end for every Bézier. A closed one ends at its first point.
///
/// # Errors
/// Says where the data is wrong.
pub fn chains(data: &str, unit: Length) -> Result<Vec<Vec<Point>>, PathError> {
    let chains = read(data, unit, CurvePen::default())?.finish();
    check(chains.iter().map(Vec::as_slice))?;
    Ok(chains)
}

/// Draws all of the data with a pen.
fn read<P: Draw>(data: &str, unit: Length, pen: P) -> Result<P, PathError> {
    let mut reader = Reader { unit: unit.to_mm(), pen, start: ORIGIN, at: ORIGIN, control: Control::None };
    for segment in PathParser::from(data) {
        let segment = segment.map_err(|error| explain(data, &error))?;
        reader.draw(segment);
        if !(reader.at.x.is_finite() && reader.at.y.is_finite()) {
            return Err(PathError { offset: 0, problem: PathProblem::TooLarge });
        }
    }
    Ok(reader.pen)
}

/// Checks that something was drawn, and that all of it lies on the page.
fn check<'a>(lines: impl Iterator<Item = &'a [Point]>) -> Result<(), PathError> {
    let mut is_empty = true;
    for line in lines {
        is_empty = false;
        if !line.iter().all(|p| p.x.is_finite() && p.y.is_finite()) {
            return Err(PathError { offset: 0, problem: PathProblem::TooLarge });
        }
    }
    if is_empty { Err(PathError { offset: 0, problem: PathProblem::Empty }) } else { Ok(()) }
}

impl Region {
    /// What path data runs round, by the non-zero rule; open lines are closed. One unit of the data is `unit` long.
    ///
    /// # Errors
    /// Says where the data is wrong; or that the lines cross too often.
    pub fn path(data: &str, unit: Length) -> Result<Self, PathError> {
        let rings = subpaths(data, unit)?.into_iter().map(|subpath| subpath.points).collect();
        Self::try_from_rings(rings, FillRule::NonZero)
            .map_err(|_| PathError { offset: 0, problem: PathProblem::TooTangled })
    }
}

fn explain(data: &str, error: &Error) -> PathError {
    let is_started = data.trim_start().starts_with(['M', 'm']);
    // Positions count characters from 1.
    let at =
        |position: usize| data.char_indices().nth(position.saturating_sub(1)).map_or(data.len(), |(offset, _)| offset);
    let (offset, problem) = match error {
        Error::UnexpectedData(position) if !is_started => (at(*position), PathProblem::NoStart),
        Error::UnexpectedData(position) | Error::InvalidChar(_, position) | Error::InvalidString(_, position) => {
            (at(*position), PathProblem::Unexpected)
        }
        Error::InvalidNumber(position) if at(*position) == data.len() => (data.len(), PathProblem::Unfinished),
        Error::InvalidNumber(position) => (at(*position), PathProblem::BadNumber),
        Error::UnexpectedEndOfStream | Error::InvalidValue | Error::InvalidIdent => {
            (data.len(), PathProblem::Unfinished)
        }
    };
    PathError { offset, problem }
}

const ORIGIN: Point = Point::new(0.0, 0.0);

/// The last control point, which smooth curves mirror: only those of their own kind.
#[derive(Debug, Clone, Copy)]
enum Control {
    None,
    Quadratic(Point),
    Cubic(Point),
}

struct Reader<P> {
    unit: f64,
    pen: P,
    /// Where the current line began.
    start: Point,
    at: Point,
    control: Control,
}

impl<P: Draw> Reader<P> {
    /// A point of the data on the page.
    fn place(&self, is_absolute: bool, x: f64, y: f64) -> Point {
        let origin = if is_absolute { ORIGIN } else { self.at };
        origin + Vec2::new(x, y) * self.unit
    }

    fn draw(&mut self, segment: PathSegment) {
        let mut control = Control::None;
        let end;
        match segment {
            PathSegment::MoveTo { abs, x, y } => {
                end = self.place(abs, x, y);
                self.start = end;
                self.pen.move_to(end);
            }
            PathSegment::LineTo { abs, x, y } => {
                end = self.place(abs, x, y);
                self.pen.line_to(end);
            }
            PathSegment::HorizontalLineTo { abs, x } => {
                end = Point::new(self.place(abs, x, 0.0).x, self.at.y);
                self.pen.line_to(end);
            }
            PathSegment::VerticalLineTo { abs, y } => {
                end = Point::new(self.at.x, self.place(abs, 0.0, y).y);
                self.pen.line_to(end);
            }
            PathSegment::CurveTo { abs, x1, y1, x2, y2, x, y } => {
                end = self.place(abs, x, y);
                let second = self.place(abs, x2, y2);
                self.pen.cubic_to(self.place(abs, x1, y1), second, end);
                control = Control::Cubic(second);
            }
            PathSegment::SmoothCurveTo { abs, x2, y2, x, y } => {
                end = self.place(abs, x, y);
                let second = self.place(abs, x2, y2);
                let first = match self.control {
                    Control::Cubic(last) => self.at + (self.at - last),
                    Control::None | Control::Quadratic(_) => self.at,
                };
                self.pen.cubic_to(first, second, end);
                control = Control::Cubic(second);
            }
            PathSegment::Quadratic { abs, x1, y1, x, y } => {
                end = self.place(abs, x, y);
                let middle = self.place(abs, x1, y1);
                self.pen.quadratic_to(middle, end);
                control = Control::Quadratic(middle);
            }
            PathSegment::SmoothQuadratic { abs, x, y } => {
                end = self.place(abs, x, y);
                let middle = match self.control {
                    Control::Quadratic(last) => self.at + (self.at - last),
                    Control::None | Control::Cubic(_) => self.at,
                };
                self.pen.quadratic_to(middle, end);
                control = Control::Quadratic(middle);
            }
            PathSegment::EllipticalArc { abs, rx, ry, x_axis_rotation, large_arc, sweep, x, y } => {
                end = self.place(abs, x, y);
                let arc = Arc {
                    radii: [rx * self.unit, ry * self.unit],
                    rotation: Angle::degrees(x_axis_rotation),
                    is_large: large_arc,
                    is_clockwise: sweep,
                };
                self.pen.arc_to(arc, end);
            }
            PathSegment::ClosePath { .. } => {
                end = self.start;
                self.pen.close();
            }
        }
        self.at = end;
        self.control = control;
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn mm(data: &str) -> Region {
        Region::path(data, Length::mm(1.0)).unwrap()
    }

    #[test]
    fn commands_draw_what_svg_says() {
        assert_eq!(mm("M1 2 h3 v4 H1 z").bounds(), mm("m1,2 3,0 0,4-3 0Z").bounds());
        assert_eq!(mm("M0 0 L10 0 10 10z m20 0 5 0 0 5z").polygons().len(), 2);
        assert_eq!(Region::path("M0 0H1V1Z", Length::mm(25.4)).unwrap().bounds().max, Point::new(25.4, 25.4).snapped());
        // The half circle over (0, 0)-(20, 0), by arc, by its mirror and by cubics with a smooth join.
        let half = std::f64::consts::PI * 50.0;
        for data in ["M0 0A10 10 0 0 1 20 0Z", "M0 0a10 10 0 1 0 20 0z", "M0 0C0-5.523 4.477-10 10-10S20-5.523 20 0Z"] {
            assert!((mm(data).area() - half).abs() < 0.2, "{data}: {}", mm(data).area());
        }
        assert!(mm("M0 0A10 10 0 0 1 20 0Z").bounds().min.y < -9.99);
        assert!(mm("M0 0A10 10 0 0 0 20 0Z").bounds().max.y > 9.99);
        // Radii that are too small are scaled up; a quarter ellipse on its side.
        assert!((mm("M0 0A1 1 0 0 1 20 0Z").area() - half).abs() < 0.2);
        let quarter = mm("M10 0A10 5 90 0 1 5 10L5 0Z");
        assert!((quarter.area() - std::f64::consts::PI * 50.0 / 4.0).abs() < 0.1, "{}", quarter.area());
        // T mirrors the control point of Q, and after anything else there is none.
        assert!((mm("M0 0Q5-10 10 0T20 0Z").area() - 2.0 * 100.0 / 3.0).abs() < 0.1);
    }

    impl Point {
        /// On the grid of regions.
        fn snapped(self) -> Self {
            let snap = |v: f64| (v * (1u64 << 24) as f64).round() / (1u64 << 24) as f64;
            Self::new(snap(self.x), snap(self.y))
        }
    }

    #[test]
    fn curves_are_within_the_tolerance() {
        let drawn = subpaths("M0 0C0 80 100-80 100 0", Length::mm(1.0)).unwrap();
        let exact = |t: f64| {
            let s = 1.0 - t;
            Point::new(300.0 * s * t * t + 100.0 * t * t * t, 240.0 * s * s * t - 240.0 * s * t * t)
        };
        let points = &drawn[0].points;
        let steps = (points.len() - 1) as f64;
        for (i, pair) in points.windows(2).enumerate() {
            assert!(exact((i as f64 + 0.5) / steps).distance(pair[0].lerp(pair[1], 0.5)) < 0.005);
        }
        assert!(!drawn[0].is_closed && points.len() > 20);
    }

    #[test]
    fn chains_are_the_curves_that_lines_stand_for() {
        for data in
            ["M0 0A10 10 0 0 1 20 0L3 4z", "M0 0C0 80 100-80 100 0q3 4 5 2t5-9", "M10 0A10 5 33 1 0 5 10m3 4h5v3z"]
        {
            let (lines, curves) = (subpaths(data, Length::mm(1.0)).unwrap(), chains(data, Length::mm(1.0)).unwrap());
            assert_eq!(lines.len(), curves.len());
            for (line, chain) in lines.iter().zip(&curves) {
                assert_eq!(chain.len() % 3, 1);
                assert_eq!(line.is_closed, chain.first() == chain.last());
                assert_eq!(line.points.first(), chain.first());
                let corners: Vec<Point> =
                    line.points.iter().chain(line.is_closed.then(|| &line.points[0])).copied().collect();
                let length: f64 = corners.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
                let exact: f64 = crate::geom::bezier::cubics(chain).map(|cubic| cubic.length().to_mm()).sum();
                assert!((length / exact - 1.0).abs() < 2e-3, "{data}: {length} {exact}");
            }
        }
    }

    #[test]
    fn mistakes_are_located() {
        let error = |data: &str| {
            let PathError { offset, problem } = subpaths(data, Length::mm(1.0)).unwrap_err();
            (offset, problem)
        };
        assert_eq!(error(""), (0, PathProblem::Empty));
        assert_eq!(error("M 1 2"), (0, PathProblem::Empty));
        assert_eq!(error("  L 1 2"), (2, PathProblem::NoStart));
        assert_eq!(error("M 0 0 L 1 x"), (10, PathProblem::BadNumber));
        assert_eq!(error("M 0 0 L 1 1 é 1"), (12, PathProblem::Unexpected));
        assert_eq!(error("M 0 0 Lé 1"), (7, PathProblem::BadNumber));
        assert_eq!(error("M 0 0 L 1"), (9, PathProblem::Unfinished));
        assert_eq!(error("M 0 0 L 1 1 z 5"), (14, PathProblem::Unexpected));
        assert_eq!(error("M 0 0 A 1 1 0 2 0 5 5"), (14, PathProblem::Unexpected));
        assert!(matches!(error("M 0 0 L 1e308 1e308 l 1e308 1e308"), (_, PathProblem::TooLarge)));
    }
}
