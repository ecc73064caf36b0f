//! Where pictures go: kinds of files by their endings, files written beside their place, and names with `{…}` in them.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use crate::back::metadata::Metadata;
use crate::back::{json, pdf, png, svg};
use crate::cli::Ended;
use crate::cli::files::{Pending, plain, print, write_beside};
use crate::cli::picture::Form;
use crate::drawing::Drawing;

/// The kinds of output.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::cli) enum Kind {
    Svg,
    Png,
    Pdf,
    Json,
}

pub(in crate::cli) fn kind_of(output: &Path) -> Result<Kind, String> {
    if output == Path::new("-") {
        return Ok(Kind::Svg);
    }
    let extension = output.extension().unwrap_or_default().to_ascii_lowercase();
    match extension.to_str() {
        Some("svg") => Ok(Kind::Svg),
        Some("png") => Ok(Kind::Png),
        Some("pdf") => Ok(Kind::Pdf),
        Some("json") => Ok(Kind::Json),
        _ => Err(format!("{}: outputs end in .svg, .png, .pdf or .json", output.display())),
    }
}

impl Kind {
    pub(in crate::cli) fn name(self) -> &'static str {
        match self {
            Self::Svg => "svg",
            Self::Png => "png",
            Self::Pdf => "pdf",
            Self::Json => "json",
        }
    }
}

pub(super) fn same_file(output: &Path, scene: &Path) -> bool {
    match (output.canonicalize(), scene.canonicalize()) {
        // A picture may be built again over itself.
        (Ok(output), Ok(scene)) => output == scene && kind_of(&scene).is_err(),
        _ => false,
    }
}

pub(in crate::cli) fn cannot_write(target: &Path, error: &io::Error) -> Ended {
    let Some(words) = failure(target, error) else { return Ended::Done };
    eprint!("{words}");
    Ended::Io
}

/// What went wrong with an output, in words; nothing where a reader has gone away.
pub(super) fn failure(target: &Path, error: &io::Error) -> Option<String> {
    let is_gone = error.kind() == io::ErrorKind::BrokenPipe;
    (!is_gone).then(|| format!("kake: cannot write {}: {}\n", target.display(), plain(error)))
}

/// Writes one output beside its place; standard output is written at once.
pub(in crate::cli) fn write(
    drawing: &Drawing,
    metadata: Option<&Metadata>,
    (kind, form): (Kind, Form),
    target: &Path,
) -> io::Result<Option<Pending>> {
    let stem = target.file_stem().unwrap_or_default().to_string_lossy();
    let fill = |out: &mut dyn Write| fill(drawing, metadata, (kind, form), &stem, out);
    if target == Path::new("-") {
        let mut bytes = Vec::new();
        fill(&mut bytes)?;
        return match print(&bytes) {
            Ended::Done => Ok(None),
            // What went wrong was said already.
            _ => Err(io::Error::other("standard output failed")),
        };
    }
    write_beside(target, fill).map(Some)
}

/// Writes the bytes of an output; `stem` names the pattern of a swatch.
pub(in crate::cli) fn fill(
    drawing: &Drawing,
    metadata: Option<&Metadata>,
    (kind, form): (Kind, Form),
    stem: &str,
    out: &mut dyn Write,
) -> io::Result<()> {
    match kind {
        Kind::Svg => match form {
            Form::Page => svg::write(drawing, metadata, out),
            Form::Pattern => svg::write_pattern(drawing, stem, metadata, out),
        },
        Kind::Pdf => pdf::write(drawing, metadata, out),
        Kind::Json => json::write(drawing, out),
        Kind::Png => png::write(drawing, metadata, out).map_err(|error| match error {
            png::PngError::Io(error) => error,
            png::PngError::Format(message) => io::Error::other(message),
        }),
    }
}

/// The name of an output with what `{…}` stands for. `value` gives it for a name.
///
/// # Errors
/// The first name that stands for nothing.
pub(super) fn expanded(output: &Path, value: &dyn Fn(&str) -> Option<String>) -> Result<PathBuf, String> {
    let text = output.to_string_lossy();
    let mut name = String::new();
    let mut rest = &*text;
    while let Some((before, after)) = rest.split_once('{') {
        name += before;
        // A brace that is never closed is a character like any other.
        let Some((inside, after)) = after.split_once('}') else {
            name.push('{');
            rest = after;
            continue;
        };
        name += &value(inside).ok_or_else(|| inside.to_owned())?;
        rest = after;
    }
    name += rest;
    Ok(PathBuf::from(name))
}

/// The most characters of a value in a file's name.
const LONGEST: usize = 80;

/// A value as a part of a file's name that every system takes: letters, digits, signs of numbers, and `-` for all else.
pub(in crate::cli) fn safe(value: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || matches!(c, '.' | '_' | '%' | '+');
    let mut name = String::new();
    for (i, c) in value.char_indices() {
        // A minus sign is kept where it begins a number; two values that differ in it are not one.
        let is_sign = c == '-' && value[i + 1..].starts_with(|c: char| c.is_ascii_digit());
        if is_plain(c) || is_sign {
            name.push(c);
        } else if !name.is_empty() && !name.ends_with('-') {
            name.push('-');
        }
    }
    name.truncate(name.trim_end_matches('-').len());
    let name: String = name.chars().take(LONGEST).collect();
    // Dots at the start or alone would hide a file, or lead out of its folder.
    match name.trim_matches('.') {
        "" => "_".to_owned(),
        _ if name.starts_with('.') => format!("_{name}"),
        _ => name,
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn values_are_made_safe() {
        let cases = [
            ("4mm", "4mm"),
            ("-3.5deg", "-3.5deg"),
            ("poisson(radius: 4mm)", "poisson-radius-4mm"),
            ("#ff0000", "ff0000"),
            ("../../etc", "_..-..-etc"),
            ("", "_"),
            ("..", "_"),
            ("a/b\\c:d", "a-b-c-d"),
            ("\u{5f71} 50%", "\u{5f71}-50%"),
        ];
        for (value, wanted) in cases {
            assert_eq!(safe(value), wanted, "{value}");
        }
    }

    #[test]
    fn names_are_expanded() {
        let value = |name: &str| (name == "a").then(|| "1".to_owned());
        let of = |text: &str| expanded(Path::new(text), &value);
        assert_eq!(of("x-{a}{a}-{.png"), Ok(PathBuf::from("x-11-{.png")));
        assert_eq!(of("{b}.png"), Err("b".to_owned()));
    }

    proptest! {
        #[test]
        fn no_value_leads_elsewhere(value in any::<String>()) {
            let name = safe(&value);
            prop_assert!(!name.is_empty() && !name.starts_with('.'));
            prop_assert!(!name.contains(['/', '\\', ':', '\0', '"', '*', '?', '<', '>', '|', '\n']));
        }
    }
}
