//! Images as fields, with what brings their light into the range that is wanted.

use crate::diag::{Code, Diagnostic};
use crate::field::{Blender, Field, Operator};
use crate::region::contained;

use super::super::call::Call;
use super::super::files;
use super::super::value::{FieldUnit, Value};
use super::field;

/// The most and, as its inverse, the least that `gamma` may be.
const MOST_GAMMA: f64 = 10.0;

/// `image`: the light of a picture, blurred, then stretched from the levels, bent by gamma and inverted.
pub(super) fn image(call: &mut Call<'_, '_, '_>) -> Option<Value> {
    let fit = call.area("fit")?;
    let channel = call.word("channel").unwrap_or("luminance");
    let gamma = call.within("gamma", 1.0 / MOST_GAMMA, MOST_GAMMA, 1.0);
    let levels = levels(call);
    let blur = call.not_negative("blur", crate::geom::Length::mm(0.0))?;
    if blur.to_mm() > fit.width().max(fit.height()) {
        return call.refuse("blur", "`blur` must not be more than the longer side of `fit`".to_owned());
    }
    let image = files::image(call, channel)?;
    let place = contained(f64::from(image.width), f64::from(image.height), fit);
    let image = files::blurred(call, "blur", &image, &place, blur)?;
    let mut light = Field::image(image, fit);
    let (black, white) = levels?;
    if (black, white) != (0.0, 1.0) {
        let share = light.zip(Field::constant(black), Operator::Subtract);
        let share = share.zip(Field::constant(white - black), Operator::Divide);
        light = Field::blend(Blender::Clamp, share, Field::constant(0.0), Field::constant(1.0));
    }
    let gamma = gamma?;
    if gamma != 1.0 {
        light = light.zip(Field::constant(1.0 / gamma), Operator::Power);
    }
    if call.flag("invert") {
        light = Field::constant(1.0).zip(light, Operator::Subtract);
    }
    field(light, FieldUnit::Number)
}

/// What becomes black and what white.
fn levels(call: &mut Call<'_, '_, '_>) -> Option<(f64, f64)> {
    let Some(given) = call.value("levels") else { return Some((0.0, 1.0)) };
    let Value::Range(ends) = &given else { return None };
    let (Value::Number(black) | Value::Percent(black), Value::Number(white) | Value::Percent(white)) = &**ends else {
        let message = format!("`levels` go from a number to a number, not from {} to {}", ends.0.text(), ends.1.text());
        let diagnostic = Diagnostic::error(Code::Type, call.span_of("levels"), message);
        call.cx.report(diagnostic.hint("what is black and what is white: `0.05 .. 0.9`"));
        return None;
    };
    let inside = (0.0..=1.0).contains(black) && (0.0..=1.0).contains(white);
    if !inside || black >= white {
        let message = "`levels` must go from a lower to a higher number between 0 and 1".to_owned();
        return call.refuse("levels", message);
    }
    Some((*black, *white))
}
