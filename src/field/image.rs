//! Images as fields.
use serde::Serialize;

/// A decoded image.
#[derive(Debug, Serialize)]
pub struct Image {
    /// Samples across.
    pub width: u32,
    /// Samples down.
    pub height: u32,
    /// Row by row from the top left, 0 black to 1 white, linear light.
    #[serde(skip)]
    pub samples: Vec<f32>,
}
