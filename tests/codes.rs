//! Every code of the table is shown by a case.

use std::collections::BTreeSet;

use kakeami::diag::Code;

use crate::support::{compile_case, scenes};

/// Codes that only the command line shows; its tests do.
const BY_THE_COMMAND_LINE: [Code; 4] = [Code::Lock, Code::Manifest, Code::Metadata, Code::Pin];

#[test]
fn every_code_is_shown() {
    let mut seen: BTreeSet<Code> = BY_THE_COMMAND_LINE.into();
    for folder in ["tests/cases/build", "tests/cases/fail"] {
        for path in scenes(folder) {
            seen.extend(compile_case(&path).lowered.diagnostics.iter().map(|diagnostic| diagnostic.code));
        }
    }
    let missing: Vec<String> = Code::ALL.iter().filter(|code| !seen.contains(code)).map(ToString::to_string).collect();
    assert!(missing.is_empty(), "no case shows {}", missing.join(", "));
}

#[test]
fn codes_have_words() {
    let mut names = BTreeSet::new();
    for &code in Code::ALL {
        assert!(names.insert(code.name()), "{code} stands twice in the table");
        assert!(code.name().chars().all(|c| c.is_ascii_lowercase() || c == '-'), "{code}");
        assert!(!code.title().ends_with('.') && code.explanation().ends_with('.'), "{code}");
        assert_eq!(Code::from_name(&code.to_string()), Some(code));
        assert_eq!(Code::from_name(code.name()), Some(code));
    }
}
