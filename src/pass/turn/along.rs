//! Tiles that follow a field of angles.

use crate::field::Field;
use crate::geom::Angle;
use crate::stage::Sites;

/// The field's value at every site, as a direction.
pub(super) fn turn(sites: &Sites, field: &Field) -> Vec<Angle> {
    sites.points.iter().map(|&p| Angle::radians(field.at(p)).direction()).collect()
}
