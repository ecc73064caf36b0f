//! Tiles that are turned independently.

use std::f64::consts::PI;

use crate::geom::Angle;
use crate::random::Key;
use crate::stage::Sites;

/// A uniform direction for every site, each from a stream of its own.
pub(super) fn turn(sites: &Sites, key: &Key<'_>) -> Vec<Angle> {
    (0..sites.points.len()).map(|site| Angle::radians(key.tile(site).unit() * PI).direction()).collect()
}
