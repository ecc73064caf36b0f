//! Diagnostics as text, through miette, and as JSON.
//!
//! Spans are clamped to their text and to whole characters, so that no span can make the renderer fail, and what is shown
//! of a source is an [`Excerpt`], whose size does not depend on that of the source.

use std::fmt;

use miette::{GraphicalReportHandler, GraphicalTheme, LabeledSpan, SourceCode, ThemeCharacters, ThemeStyles};
use serde_json::{Value, json};

use super::excerpt::{Excerpt, MOST_LINES, Window, printable};
use super::place::Text;
use super::{Diagnostic, Severity};
use crate::span::{SourceId, Sources, Span};

/// How diagnostics are drawn.
#[derive(Debug, Clone, Copy)]
pub struct RenderConfig {
    /// Columns.
    pub width: usize,
    /// With ANSI colours.
    pub colour: bool,
    /// With line-drawing characters rather than ASCII.
    pub unicode: bool,
}

/// The fewest columns that are drawn on.
const NARROWEST: usize = 40;
/// Columns left of the source for line numbers and frame, and right of it for marks of omission.
const FRAME: usize = 14;

/// Diagnostics as people read them, an empty line between two.
#[must_use]
pub fn render(diagnostics: &[Diagnostic], sources: &Sources, config: RenderConfig) -> String {
    let theme = GraphicalTheme {
        characters: if config.unicode { ThemeCharacters::unicode() } else { ThemeCharacters::ascii() },
        styles: if config.colour { ThemeStyles::ansi() } else { ThemeStyles::none() },
    };
    let width = config.width.max(NARROWEST);
    let handler = GraphicalReportHandler::new_themed(theme)
        .with_width(width)
        .with_links(false)
        .without_syntax_highlighting()
        .without_cause_chain();
    let window = Window { columns: width - FRAME, ellipsis: if config.unicode { "…" } else { "..." } };
    let texts = Texts::new(sources);
    let mut out = String::new();
    for report in diagnostics.iter().flat_map(|diagnostic| reports(diagnostic, &texts, window)) {
        // A further place follows its diagnostic at once.
        if !out.is_empty() && report.code.is_some() {
            out.push('\n');
        }
        if handler.render_report(&mut out, &report).is_err() {
            out.push_str(&report.message);
            out.push('\n');
        }
    }
    out
}

/// Diagnostics as data: a list of objects. Lines and columns count from 1, columns in characters, offsets in bytes
/// from 0; what is not there is null.
#[must_use]
pub fn to_json(diagnostics: &[Diagnostic], sources: &Sources) -> Value {
    let texts = Texts::new(sources);
    diagnostics.iter().map(|diagnostic| diagnostic_json(diagnostic, &texts)).collect()
}

fn diagnostic_json(diagnostic: &Diagnostic, texts: &Texts<'_>) -> Value {
    let severity = match diagnostic.severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
    };
    let [file, start, end] = place_json(diagnostic.span, texts);
    let notes: Vec<Value> = diagnostic
        .notes
        .iter()
        .map(|(span, message)| {
            let [file, start, end] = place_json(Some(*span), texts);
            json!({ "file": file, "start": start, "end": end, "message": message })
        })
        .collect();
    json!({
        "code": diagnostic.code.to_string(),
        "severity": severity,
        "message": diagnostic.message,
        "file": file,
        "start": start,
        "end": end,
        "label": diagnostic.label,
        "hint": diagnostic.hint,
        "notes": notes,
    })
}

/// The file, start and end of a span.
fn place_json(span: Option<Span>, texts: &Texts<'_>) -> [Value; 3] {
    let Some((span, text)) = span.and_then(|span| Some((span, texts.get(span.source)?))) else {
        return [Value::Null, Value::Null, Value::Null];
    };
    let range = text.clamp(span);
    let position = |offset: usize| {
        let (line, column) = (text.line_of(offset) + 1, text.column(offset) + 1);
        json!({ "offset": offset, "line": line, "column": column })
    };
    [text.name.into(), position(range.start), position(range.end)]
}

/// Every source with its lines.
struct Texts<'a>(Vec<(SourceId, Text<'a>)>);

impl<'a> Texts<'a> {
    fn new(sources: &'a Sources) -> Self {
        Self(sources.iter().map(|(id, source)| (id, Text::new(source))).collect())
    }

    fn get(&self, id: SourceId) -> Option<&Text<'a>> {
        let at = self.0.binary_search_by_key(&id, |(id, _)| *id).ok()?;
        self.0.get(at).map(|(_, text)| text)
    }
}

/// What miette draws: a diagnostic, or a further place of one, which has no code.
#[derive(Debug)]
struct Report {
    code: Option<String>,
    severity: miette::Severity,
    message: String,
    hint: Option<String>,
    excerpt: Option<Excerpt>,
}

/// Lines between a note and what is at fault below it that are shown without a break.
const CONTEXT_LINES: usize = 2;

/// Whether a note is shown in the excerpt of what is at fault: an excerpt begins with its first line, so a note further
/// up would take the lead.
fn stands_beside(note: usize, main: usize) -> bool {
    if note < main { main - note <= CONTEXT_LINES } else { note - main <= MOST_LINES }
}

/// A diagnostic and those of its notes that lie in another file or far from it.
fn reports(diagnostic: &Diagnostic, texts: &Texts<'_>, window: Window) -> Vec<Report> {
    let place = |span: Span| texts.get(span.source).map(|text| (text, text.clamp(span)));
    let main = diagnostic.span.and_then(place);
    let mut ranges: Vec<_> = main.iter().map(|(_, range)| (range.clone(), diagnostic.label.as_str())).collect();
    let mut further = Vec::new();
    for (span, note) in &diagnostic.notes {
        let near = diagnostic.span.is_some_and(|main| main.source == span.source);
        match (place(*span), &main) {
            (Some((text, range)), Some((_, first)))
                if near && stands_beside(text.line_of(range.start), text.line_of(first.start)) =>
            {
                ranges.push((range, note.as_str()));
            }
            (found, _) => further.push(Report {
                code: None,
                severity: miette::Severity::Advice,
                message: printable(note),
                hint: None,
                excerpt: found.map(|(text, range)| Excerpt::new(text, &[(range, "")], window)),
            }),
        }
    }
    let report = Report {
        code: Some(diagnostic.code.to_string()),
        severity: match diagnostic.severity {
            Severity::Error => miette::Severity::Error,
            Severity::Warning => miette::Severity::Warning,
        },
        message: lines_printable(&diagnostic.message),
        hint: diagnostic.hint.as_deref().map(lines_printable),
        excerpt: main.map(|(text, _)| Excerpt::new(text, &ranges, window)),
    };
    std::iter::once(report).chain(further).collect()
}

/// Text that may have several lines.
fn lines_printable(text: &str) -> String {
    text.split('\n').map(printable).collect::<Vec<_>>().join("\n")
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Report {}

impl miette::Diagnostic for Report {
    fn code<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        self.code.as_ref().map(|code| Box::new(code) as Box<dyn fmt::Display>)
    }

    fn severity(&self) -> Option<miette::Severity> {
        Some(self.severity)
    }

    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        self.hint.as_ref().map(|hint| Box::new(hint) as Box<dyn fmt::Display>)
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        self.excerpt.as_ref().map(|excerpt| excerpt as &dyn SourceCode)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        self.excerpt.as_ref().map(|excerpt| Box::new(excerpt.labels()) as Box<dyn Iterator<Item = LabeledSpan>>)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::diag::Code;
    use crate::span::Syntax;

    const PLAIN: RenderConfig = RenderConfig { width: 80, colour: false, unicode: true };

    fn sources(texts: &[&str]) -> (Sources, Vec<SourceId>) {
        let mut sources = Sources::new();
        let names = ["scene.kake", "tones/basic.kake"];
        let ids = texts.iter().zip(names).map(|(text, name)| sources.add(name, *text, Syntax::Kake)).collect();
        (sources, ids)
    }

    fn span_of(sources: &Sources, id: SourceId, part: &str) -> Span {
        let start = sources.get(id).text.find(part).unwrap();
        Span::new(id, start, start + part.len())
    }

    fn error(span: Span) -> Diagnostic {
        Diagnostic::error(Code::UnknownName, span, "a name is not known").label("this one")
    }

    #[test]
    fn looks_as_it_should() {
        let scene =
            "import \"tones/basic.kake\"\n\ntone a(raduis: 6mm) = basic with {\n  place: poisson(raduis: 6mm)\n}\n";
        let (sources, ids) = sources(&[scene, "/// Basic.\ntone basic(radius = 2mm) = kake\n"]);
        let at = |i: usize, part| span_of(&sources, ids[i], part);
        let first =
            Diagnostic::error(Code::UnknownArgument, at(0, "raduis: 6mm)\n"), "`poisson` has no argument `raduis`")
                .label("not known")
                .hint("did you mean `radius`?")
                .note(at(0, "a(raduis"), "in this tone")
                .note(at(1, "basic(radius = 2mm)"), "`basic` is declared here");
        let second = Diagnostic::warning(
            Code::Empty,
            at(0, "tone a(raduis: 6mm) = basic with {\n  place: p"),
            "nothing is painted",
        );
        let third = Diagnostic::without_span(Code::Encoding, "the file is not UTF-8");
        let diagnostics = [first, second, third];
        insta::assert_snapshot!(render(&diagnostics, &sources, PLAIN), @r"
        kake::unknown-argument

          × `poisson` has no argument `raduis`
           ╭─[scene.kake:4:18]
         2 │ 
         3 │ tone a(raduis: 6mm) = basic with {
           ·      ────┬───
           ·          ╰── in this tone
         4 │   place: poisson(raduis: 6mm)
           ·                  ──────┬─────
           ·                        ╰── not known
         5 │ }
           ╰────
          help: did you mean `radius`?
          ☞ `basic` is declared here
           ╭─[tones/basic.kake:2:6]
         1 │ /// Basic.
         2 │ tone basic(radius = 2mm) = kake
           ·      ───────────────────
           ╰────

        kake::empty

          ⚠ nothing is painted
           ╭─[scene.kake:3:1]
         2 │     
         3 │ ╭─▶ tone a(raduis: 6mm) = basic with {
         4 │ ╰─▶   place: poisson(raduis: 6mm)
         5 │     }
           ╰────

        kake::encoding

          × the file is not UTF-8
        ");
        let ascii = render(&diagnostics, &sources, RenderConfig { unicode: false, ..PLAIN });
        assert!(ascii.is_ascii());
        let coloured = render(&diagnostics, &sources, RenderConfig { colour: true, ..PLAIN });
        assert!(coloured.contains("\u{1b}[") && !ascii.contains('\u{1b}'));
    }

    #[test]
    fn ends_of_texts_can_be_pointed_at() {
        for (text, start, wanted) in [
            ("", 0, "1:1"),
            ("", 7, "1:1"),
            ("a", 1, "1:2"),
            ("a\n", 1, "1:2"),
            ("a\n", 2, "2:1"),
            ("a\r\nb", 3, "2:1"),
            ("影絵", 4, "1:2"),
            ("影絵", 6, "1:3"),
            ("\t\tb", 2, "1:3"),
        ] {
            let (sources, ids) = sources(&[text]);
            let shown = render(&[error(Span::new(ids[0], start, start + 50))], &sources, PLAIN);
            assert!(shown.contains(&format!("[scene.kake:{wanted}]")), "{text:?} {start}: {shown}");
            assert!(shown.contains("this one"), "{shown}");
        }
    }

    #[test]
    fn a_line_of_a_megabyte_is_cut_around_the_span() {
        let text = format!("{}wrong{}", "right, ".repeat(100_000), ", left".repeat(100_000));
        let (sources, ids) = sources(&[&text]);
        let shown = render(&[error(span_of(&sources, ids[0], "wrong"))], &sources, PLAIN);
        assert!(shown.contains("wrong, left") && shown.contains("…"), "{shown}");
        assert!(shown.contains("[scene.kake:1:700001]"), "{shown}");
        assert!(shown.lines().all(|line| line.chars().count() <= PLAIN.width), "{shown}");
        let long = render(&[error(Span::new(ids[0], 10, text.len()))], &sources, PLAIN);
        assert!(long.len() < 2000, "{long}");
    }

    #[test]
    fn a_long_span_is_shown_by_its_first_line() {
        let text = "first\n".to_owned() + &"more\n".repeat(1000);
        let (sources, ids) = sources(&[&text]);
        let shown = render(&[error(Span::new(ids[0], 0, text.len()))], &sources, PLAIN);
        assert!(shown.contains("first") && shown.lines().count() < 12, "{shown}");
    }

    #[test]
    fn terminals_are_not_given_orders() {
        let (sources, ids) = sources(&["let a = \"\u{1b}]0;title\u{7}\u{202e}\"\n"]);
        let mut diagnostic =
            error(Span::new(ids[0], 8, 20)).hint("\u{1b}[2J").note(Span::new(ids[0], 0, 3), "\r\u{9b}");
        diagnostic.message = "\u{1b}[31m".to_owned();
        let shown = render(&[diagnostic], &sources, PLAIN);
        assert!(!shown.contains(|c: char| (c.is_control() && c != '\n') || c == '\u{202e}'), "{shown:?}");
    }

    #[test]
    fn as_data() {
        let (sources, ids) = sources(&["影 = 1\nlet b = c\n"]);
        let span = span_of(&sources, ids[0], "c\n");
        let diagnostic = error(span).hint("declare it").note(span_of(&sources, ids[0], "影 ="), "here");
        let found = to_json(&[diagnostic, Diagnostic::without_span(Code::Empty, "nothing")], &sources);
        let place = |offset: u32, line: u32, column: u32| json!({ "offset": offset, "line": line, "column": column });
        let wanted = json!([
            {
                "code": "kake::unknown-name", "severity": "error", "message": "a name is not known",
                "file": "scene.kake", "start": place(16, 2, 9), "end": place(18, 3, 1),
                "label": "this one", "hint": "declare it",
                "notes": [{ "file": "scene.kake", "start": place(0, 1, 1), "end": place(5, 1, 4), "message": "here" }],
            },
            {
                "code": "kake::empty", "severity": "error", "message": "nothing",
                "file": null, "start": null, "end": null, "label": "", "hint": null, "notes": [],
            },
        ]);
        assert_eq!(found, wanted);
    }

    proptest! {
        #[test]
        fn any_span_of_any_text_can_be_shown(
            texts in prop::collection::vec("([a-z\t影é\u{1b}\u{301} ]{0,30}(\r?\n|\r)?){0,30}", 2),
            spans in prop::collection::vec((0..2usize, 0..400usize, 0..100usize), 1..5),
            width in 0..120usize,
            unicode: bool,
            label: String,
        ) {
            let (sources, ids) = sources(&[&texts[0], &texts[1]]);
            let mut spans = spans.iter().map(|&(i, start, length)| Span::new(ids[i], start, start + length));
            let mut diagnostic = error(spans.next().unwrap()).label(label.clone());
            for span in spans {
                diagnostic = diagnostic.note(span, label.clone());
            }
            let config = RenderConfig { width, colour: false, unicode };
            let shown = render(std::slice::from_ref(&diagnostic), &sources, config);
            prop_assert!(shown.contains("a name is not known"));
            prop_assert!(shown.contains("scene.kake:") || shown.contains("basic.kake:"));
            prop_assert!(!shown.contains("Failed to read"));
            prop_assert!(to_json(&[diagnostic], &sources).is_array());
        }
    }
}
