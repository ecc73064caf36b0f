//! Thinned layers: what is drawn of a layer that a tone's darkness asks for only in part.

use crate::geom::Length;
use crate::scene::FillKind;

/// A layer that was thinned.
pub(super) struct Thinned {
    /// The fill, with its marks farther apart.
    pub(super) kind: FillKind,
    /// The share of its lines that is drawn; 1 where they stand farther apart instead.
    pub(super) share: f64,
}

/// Thins layer `number` of a tile to `part` of its ink, above 0 and at most 1.
///
/// Strokes stand farther apart. So do the dots, crosses and figures of a first layer, both ways alike; those of later layers
/// stand between them, and rows of them are left out.
pub(super) fn thinned(kind: &FillKind, number: u8, part: f64) -> Thinned {
    let part = part.max(f64::MIN_POSITIVE);
    let mut kind = kind.clone();
    let share = match &mut kind {
        FillKind::Lines(hatch)
        | FillKind::Arcs(hatch)
        | FillKind::Dashes { hatch, .. }
        | FillKind::Waves { hatch, .. }
        | FillKind::Scribble { hatch, .. }
        | FillKind::Nawaami { hatch, .. } => {
            hatch.pitch = farther(hatch.pitch, part);
            1.0
        }
        FillKind::Dots { hatch, spacing, .. }
        | FillKind::Crosses { hatch, spacing, .. }
        | FillKind::Motif { hatch, spacing, .. }
            if number <= 1 =>
        {
            hatch.pitch = farther(hatch.pitch, part.sqrt());
            *spacing = farther(*spacing, part.sqrt());
            1.0
        }
        FillKind::Dots { .. } | FillKind::Crosses { .. } | FillKind::Motif { .. } | FillKind::Solid => part,
    };
    Thinned { kind, share }
}

/// A distance that leaves room for a share of the marks.
fn farther(distance: Length, share: f64) -> Length {
    // No tile is a thousand kilometres wide.
    (distance / share).min(Length::mm(1e9))
}

#[cfg(test)]
#[allow(clippy::panic)]
mod tests {
    use super::*;
    use crate::scene::{Cap, Hatch};

    #[test]
    fn what_is_thinned_keeps_its_share_of_marks() {
        let (pitch, pen) = (Length::mm(0.5), Length::mm(0.1));
        let hatch = Hatch { pitch, pen, inset: 0.5, shortest: Length::ZERO, cap: Cap::Butt };
        let dots = FillKind::Dots { hatch, spacing: Length::mm(0.8), radius: Length::mm(0.1) };
        for part in [0.01, 0.25, 1.0] {
            let Thinned { kind: FillKind::Lines(lines), share } = thinned(&FillKind::Lines(hatch), 2, part) else {
                panic!("lines stay lines");
            };
            assert!((pitch / lines.pitch - part).abs() < 1e-12 && (share - 1.0).abs() < 1e-12);
            let Thinned { kind: FillKind::Dots { hatch, spacing, .. }, share } = thinned(&dots, 1, part) else {
                panic!("dots stay dots");
            };
            assert!((pitch / hatch.pitch * (Length::mm(0.8) / spacing) - part).abs() < 1e-12);
            assert!((share - 1.0).abs() < 1e-12);
            assert!((thinned(&dots, 3, part).share - part).abs() < 1e-12);
        }
        let Thinned { kind, .. } = thinned(&FillKind::Lines(hatch), 1, 0.0);
        assert!(kind.hatch().is_some_and(|hatch| hatch.pitch.to_mm().is_finite()));
    }
}
