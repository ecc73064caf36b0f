//! All tiles alike.

use crate::geom::Angle;
use crate::stage::Sites;

/// The same direction for every site.
pub(super) fn turn(sites: &Sites, angle: Angle) -> Vec<Angle> {
    vec![angle.direction(); sites.points.len()]
}
