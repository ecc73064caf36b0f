//! Values that fit: what a tone is called with where it cannot do without a parameter.

use crate::syntax::ast::Parameter;

/// Parameters that ask for a share from 0 to 1.
pub(super) const SHARES: [&str; 2] = ["darkness", "density"];

/// A tone as it stands behind `with`.
#[derive(Debug, Clone)]
pub(super) struct Call {
    pub(super) text: String,
    /// Whether a value in it is only thought to fit.
    pub(super) is_guessed: bool,
}

/// The tone as it stands behind `with`: with what is given, and with values that fit for all parameters that have no default.
/// `size` is the width and height of the page in millimetres.
///
/// # Errors
/// Why no value is known to fit a parameter.
pub(super) fn call(
    tone: &str,
    params: &[Parameter],
    given: Option<&(String, String)>,
    size: [f64; 2],
) -> Result<Call, String> {
    let mut arguments = Vec::new();
    let mut is_guessed = false;
    for param in params {
        let name = &param.name.name;
        let value = match given.filter(|(given, _)| given == name) {
            Some((_, value)) => value.clone(),
            None if param.default.is_some() => continue,
            None => {
                is_guessed = true;
                fitting(param, size)?
            }
        };
        arguments.push(format!("{name}: {value}"));
    }
    let text = if arguments.is_empty() { tone.to_owned() } else { format!("{tone}({})", arguments.join(", ")) };
    Ok(Call { text, is_guessed })
}

/// A value for a parameter that has no default.
fn fitting(param: &Parameter, [width, height]: [f64; 2]) -> Result<String, String> {
    let name = param.name.name.as_str();
    let mm = |value: f64| format!("{}mm", (value * 10.0).round() / 10.0);
    // What has no type is called after what it is, more often than not.
    let kind = match param.ty.as_ref().map_or(name, |ty| ty.name.as_str()) {
        "place" => "placement",
        "angle" if param.ty.is_none() => "angles",
        kind => kind,
    };
    let value = match kind {
        "k" => "2".to_owned(),
        "number" | "field" if name == "k" => "2".to_owned(),
        "field" => {
            let (from, to) = ("(0mm, 0mm)", format!("({}, 0mm)", mm(width)));
            format!("linear(from: {from}, to: {to}, start: 0, end: 1)")
        }
        "number" => "1".to_owned(),
        "darkness" | "density" => "0.5".to_owned(),
        "percentage" => "50%".to_owned(),
        "length" if name.contains("radius") => mm(width / 2.0),
        "length" => "5mm".to_owned(),
        "angle" => "30deg".to_owned(),
        "colour" => "#b03a2e".to_owned(),
        "bool" => "true".to_owned(),
        "point" => format!("({}, {})", mm(width / 2.0), mm(height / 2.0)),
        "box" => format!("(0mm, 0mm, {}, {})", mm(width), mm(height)),
        "region" => "canvas".to_owned(),
        "placement" => "poisson(radius: 4mm)".to_owned(),
        "shape" => "rect()".to_owned(),
        "angles" => "bfs()".to_owned(),
        "fill" => "lines(pitch: 0.8mm, pen: 0.2mm)".to_owned(),
        "hand" => "hand(angle: 3deg, spacing: 10%)".to_owned(),
        other => {
            return Err(match &param.ty {
                Some(_) => format!("`{name}` has no default, and no {other} is known to fit"),
                None => format!("`{name}` has neither a default nor a type that would say what fits"),
            });
        }
    };
    Ok(value)
}
