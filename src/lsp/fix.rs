//! Mending what a diagnostic's hint says how to mend.

use crate::diag::Diagnostic;
use crate::span::{Sources, Span};

/// An edit that mends a mistake.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fix {
    /// What it does.
    pub title: String,
    /// What is replaced.
    pub span: Span,
    /// By what.
    pub text: String,
}

/// How hints begin that give in backquotes what stands in place of what is wrong.
const REPLACING: [&str; 5] = [
    "did you mean `",
    "write it without the quotes: `",
    "angles need a unit: `",
    "a string is written in quotes: `",
    "a share is written in per cent: `",
];

/// What mends a diagnostic, where its hint says so in the language.
#[must_use]
pub fn fixes(diagnostic: &Diagnostic, sources: &Sources) -> Option<Fix> {
    let (hint, span) = (diagnostic.hint.as_ref()?, diagnostic.span?);
    let written = sources.text(span);
    let rest = REPLACING.iter().find_map(|begin| hint.strip_prefix(begin))?;
    let (word, end) = rest.rsplit_once('`')?;
    if !matches!(end, "" | "?") || word.contains('`') || written.is_empty() || written.contains('\n') {
        return None;
    }
    let is_near = hint.starts_with("did you mean");
    let quoted = written.len() > 1 && written.starts_with('"') && written.ends_with('"');
    let text = if is_near && quoted { format!("\"{word}\"") } else { word.to_owned() };
    // A number that a name stands for is not mended where the name is used.
    let is_literal = quoted || written.starts_with(|c: char| c.is_ascii_digit());
    let is_word = written.chars().all(|c| c.is_alphanumeric() || matches!(c, '_' | ':' | '-' | '.'));
    let fits = match hint {
        hint if hint.starts_with("a string is written") => is_word,
        _ if is_near => is_word || quoted,
        _ => is_literal,
    };
    fits.then(|| Fix { title: format!("Write `{text}`"), span, text })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diag::Code;
    use crate::span::Syntax;

    fn mended(text: &str, hint: &str) -> Option<String> {
        let mut sources = Sources::new();
        let source = sources.add("a.kake", text, Syntax::Kake);
        let span = Span::new(source, 0, text.len());
        fixes(&Diagnostic::error(Code::UnknownName, span, "").hint(hint), &sources).map(|fix| fix.text)
    }

    #[test]
    fn hints_that_say_what_to_write_mend() {
        assert_eq!(mended("radus", "did you mean `radius`?").as_deref(), Some("radius"));
        assert_eq!(mended("\"diter\"", "did you mean `dither`?").as_deref(), Some("\"dither\""));
        assert_eq!(mended("30", "angles need a unit: `30deg`").as_deref(), Some("30deg"));
        assert_eq!(mended("\"6mm\"", "write it without the quotes: `6mm`").as_deref(), Some("6mm"));
        assert_eq!(mended("grid", "a string is written in quotes: `\"grid\"`").as_deref(), Some("\"grid\""));
    }

    #[test]
    fn hints_that_only_explain_mend_nothing() {
        assert_eq!(mended("turn", "angles need a unit: `30deg`"), None);
        assert_eq!(mended("a", "this takes `step`, `partial`"), None);
        assert_eq!(mended("f(a)", "did you mean `g`?"), None);
    }
}
