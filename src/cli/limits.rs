//! Arguments of the form NAME=VALUE.

use crate::scene::Limits;

use super::SceneArgs;

/// The limits that `--limit` lifts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Limit {
    Tiles,
    Strokes,
    Iterations,
    Megapixels,
    Nesting,
    Runs,
}

const NAMES: [(&str, Limit); 6] = [
    ("tiles", Limit::Tiles),
    ("strokes", Limit::Strokes),
    ("iterations", Limit::Iterations),
    ("megapixels", Limit::Megapixels),
    ("nesting", Limit::Nesting),
    ("runs", Limit::Runs),
];

impl Limit {
    fn name(self) -> &'static str {
        NAMES.iter().find(|(_, limit)| *limit == self).map_or("", |(name, _)| name)
    }
}

/// The root and the limits of a command line as they are written there.
pub(super) fn written(arguments: &SceneArgs) -> Vec<String> {
    let root = arguments.root.iter().flat_map(|root| ["--root".to_owned(), root.to_string_lossy().into_owned()]);
    let limits =
        arguments.limit.iter().flat_map(|(limit, value)| ["--limit".to_owned(), format!("{}={value}", limit.name())]);
    root.chain(limits).collect()
}

/// Calls may be nested this deep at most: the stack has no room for more.
const DEEPEST: u64 = 1000;

pub(super) fn parse_set(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((name, value)) if !name.trim().is_empty() => Ok((name.trim().to_owned(), value.to_owned())),
        _ => Err("expected NAME=VALUE".to_owned()),
    }
}

pub(super) fn parse_limit(text: &str) -> Result<(Limit, u64), String> {
    let (name, value) = text.split_once('=').ok_or("expected NAME=N")?;
    let known = || NAMES.map(|(name, _)| name).join(", ");
    let limit = NAMES.iter().find(|(known, _)| *known == name.trim()).map(|(_, limit)| *limit);
    let limit = limit.ok_or_else(|| format!("there is no limit `{name}`; limits are {}", known()))?;
    let value: u64 = value.trim().parse().map_err(|_| format!("`{value}` is not a whole number"))?;
    if limit == Limit::Nesting && value > DEEPEST {
        return Err(format!("nesting can be lifted to {DEEPEST} at most"));
    }
    Ok((limit, value))
}

pub(super) fn apply(lifted: &[(Limit, u64)]) -> Limits {
    let mut limits = Limits::default();
    for &(limit, value) in lifted {
        match limit {
            Limit::Tiles => limits.tiles = value,
            Limit::Strokes => limits.strokes = value,
            Limit::Iterations => limits.iterations = value,
            Limit::Megapixels => limits.megapixels = value,
            Limit::Nesting => limits.nesting = value,
            Limit::Runs => limits.runs = value,
        }
    }
    limits
}
