//! Thinned layers: what is drawn of a layer that a tone's darkness asks for only in part.

use crate::geom::Length;
use crate::scene::{FillKind, Hatch};

/// A layer that was thinned.
pub(super) struct Thinned {
    /// The fill, with its marks farther apart.
    pub(super) kind: FillKind,
    /// The share of its lines that is drawn; 1 where they stand farther apart instead.
    pub(super) share: f64,
}

/// Thins layer `number` of a tile to `part` of its ink, above 0 and at most 1.
///
/// Strokes stand farther apart. So do the dots of a first layer, both ways alike; those of later layers stand between
/// them, and lines of them are left out.
pub(super) fn thinned(kind: &FillKind, number: u8, part: f64) -> Thinned {
    let part = part.max(f64::MIN_POSITIVE);
    let wider = |hatch: &Hatch, by: f64| Hatch { pitch: farther(hatch.pitch, by), ..*hatch };
    match kind {
        FillKind::Lines(hatch) => Thinned { kind: FillKind::Lines(wider(hatch, part)), share: 1.0 },
        FillKind::Dashes { hatch, dash, gap } => {
            let kind = FillKind::Dashes { hatch: wider(hatch, part), dash: *dash, gap: *gap };
            Thinned { kind, share: 1.0 }
        }
        FillKind::Dots { hatch, spacing, radius } if number <= 1 => {
            let by = part.sqrt();
            let kind = FillKind::Dots { hatch: wider(hatch, by), spacing: farther(*spacing, by), radius: *radius };
            Thinned { kind, share: 1.0 }
        }
        FillKind::Dots { .. } | FillKind::Solid => Thinned { kind: kind.clone(), share: part },
    }
}

/// A distance that leaves room for a share of the marks.
fn farther(distance: Length, share: f64) -> Length {
    // No tile is a thousand kilometres wide.
    (distance / share).min(Length::mm(1e9))
}
