//! Warnings of hands that stray so far that nothing is left of the pattern.

use crate::diag::{Code, Diagnostic};
use crate::geom::Length;
use crate::scene::Paint;
use crate::stage::Sites;

/// What a paint's hand does too much of.
pub(super) fn warnings(paint: &Paint, sites: &Sites) -> impl Iterator<Item = Diagnostic> {
    let (tone, hand) = (&paint.tone, paint.tone.hand);
    let pitches = tone.fill.iter().filter_map(|fill| fill.kind.hatch()).map(|hatch| hatch.pitch);
    let pitch = pitches.min_by(|a, b| a.to_mm().total_cmp(&b.to_mm())).filter(|pitch| hand.wobble > *pitch / 2.0);
    let spacing = Length::mm(sites.spacing);
    let warning = move |message: String| {
        Diagnostic::warning(Code::Hand, tone.hand_span, message).note(paint.span, "painted here")
    };
    let wobble = pitch.map(|pitch| {
        let message = format!("strokes wander by {}, more than half of the pitch of {}", mm(hand.wobble), mm(pitch));
        warning(message).label("they run into each other").hint("a twentieth of the pitch is a good deal")
    });
    let overshoot = (hand.overshoot > spacing).then(|| {
        let message =
            format!("strokes overshoot by {}, more than the {} from tile to tile", mm(hand.overshoot), mm(spacing));
        warning(message).label("they cross the next tiles").hint("a twentieth of a tile is a good deal")
    });
    wobble.into_iter().chain(overshoot)
}

/// A length for people.
fn mm(length: Length) -> String {
    format!("{}mm", (length.to_mm() * 1e3).round() / 1e3)
}
