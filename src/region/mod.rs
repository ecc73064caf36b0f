//! Regions: areas of the page as polygons in millimetres.
//!
//! A region's polygons do not cross themselves or each other, so that the even-odd and the non-zero rule agree.

use std::sync::Arc;

use serde::{Serialize, Serializer};

use crate::geom::Polygon;

/// An area. Cheap to clone.
#[derive(Debug, Clone)]
pub struct Region(Arc<Data>);

#[derive(Debug)]
struct Data {
    polygons: Vec<Polygon>,
}

impl Region {
    /// The polygons it is made of.
    #[must_use]
    pub fn polygons(&self) -> &[Polygon] {
        &self.0.polygons
    }
}

impl Serialize for Region {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.polygons().serialize(serializer)
    }
}
