//! Plane geometry in millimetres: lengths, directions, points, boxes, curves, polygons and the cutting of lines.
//!
//! Coordinates have their origin at the canvas's top left and y pointing down. Angles are measured from +x towards +y.
//! Trigonometry goes through libm, so that every machine gets the same bits.

mod angle;
pub mod bezier;
pub mod chain;
pub mod clip;
pub mod course;
mod figure;
pub mod hilbert;
pub mod hull;
mod length;
mod period;
mod point;
mod polygon;
pub mod tree;

pub use angle::Angle;
pub use bezier::Cubic;
pub use figure::{BadOutline, Figure, Pieces, simple_outline};
pub use length::Length;
pub use period::{Period, whole_steps};
pub use point::{Point, Rect, Vec2};
pub use polygon::{Polygon, ring_area, ring_bounds, ring_contains};
