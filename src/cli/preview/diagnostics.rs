//! Diagnostics as the page shows them: beside their lines.

use serde_json::{Value, json};

use crate::diag::{Diagnostic, to_json};
use crate::span::Sources;

/// A list of objects. Lines and columns count from 1, columns in characters; what is not there is null.
pub(super) fn listed(diagnostics: &[Diagnostic], sources: &Sources) -> Value {
    let all = to_json(diagnostics, sources);
    all.as_array().into_iter().flatten().map(flat).collect()
}

fn flat(diagnostic: &Value) -> Value {
    let (start, end) = (&diagnostic["start"], &diagnostic["end"]);
    let notes: Vec<Value> = diagnostic["notes"]
        .as_array()
        .into_iter()
        .flatten()
        .map(|note| {
            let start = &note["start"];
            json!({
                "file": note["file"], "line": start["line"], "column": start["column"], "message": note["message"],
            })
        })
        .collect();
    json!({
        "severity": diagnostic["severity"],
        "code": diagnostic["code"],
        "message": diagnostic["message"],
        "label": diagnostic["label"],
        "hint": diagnostic["hint"],
        "file": diagnostic["file"],
        "line": start["line"],
        "column": start["column"],
        "end_line": end["line"],
        "end_column": end["column"],
        "notes": notes,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diag::Code;
    use crate::span::{Span, Syntax};

    #[test]
    fn places_are_lines_and_columns() {
        let mut sources = Sources::new();
        let source = sources.add("scene.kake", "影 = 1\nlet b = c\n", Syntax::Kake);
        let diagnostic = Diagnostic::error(Code::UnknownName, Span::new(source, 16, 17), "no `c`")
            .note(Span::new(source, 0, 3), "here");
        let wanted = json!([
            {
                "severity": "error", "code": "kake::unknown-name", "message": "no `c`", "label": "", "hint": null,
                "file": "scene.kake", "line": 2, "column": 9, "end_line": 2, "end_column": 10,
                "notes": [{ "file": "scene.kake", "line": 1, "column": 1, "message": "here" }],
            },
            {
                "severity": "error", "code": "kake::empty", "message": "nothing", "label": "", "hint": null,
                "file": null, "line": null, "column": null, "end_line": null, "end_column": null, "notes": [],
            },
        ]);
        assert_eq!(listed(&[diagnostic, Diagnostic::without_span(Code::Empty, "nothing")], &sources), wanted);
    }
}
