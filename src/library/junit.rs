//! Reviews as JUnit, which build servers read: a suite for each library, a test case for each swatch.

use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};

use super::review::{Outcome, Review, Swatch};

/// The XML. There are no times in it: the same reviews give the same bytes.
///
/// # Errors
/// In the words of the XML writer.
pub fn write(reviews: &[Review]) -> Result<String, String> {
    let mut report = Report::new("kake test");
    report.add_test_suites(reviews.iter().map(suite));
    report.to_string().map_err(|error| error.to_string())
}

fn suite(review: &Review) -> TestSuite {
    let mut suite = TestSuite::new(review.title.as_str());
    suite.add_test_cases(review.swatches.iter().map(|swatch| case(swatch, &review.title)));
    for fault in &review.faults {
        let mut status = TestCaseStatus::non_success(NonSuccessKind::Failure);
        status.set_message(fault.as_str());
        let mut case = TestCase::new("dependencies", status);
        case.set_classname(review.title.as_str());
        suite.add_test_case(case);
    }
    suite
}

fn case(swatch: &Swatch, title: &str) -> TestCase {
    let status = match swatch.outcome {
        Outcome::Same => TestCaseStatus::success(),
        Outcome::Changed(_) | Outcome::New | Outcome::Orphan => failure(swatch, NonSuccessKind::Failure),
        Outcome::Broken => failure(swatch, NonSuccessKind::Error),
    };
    let mut case = TestCase::new(swatch.name.as_str(), status);
    case.set_classname(title);
    if !swatch.said.is_empty() {
        case.set_system_err(swatch.said.as_str());
    }
    case
}

fn failure(swatch: &Swatch, kind: NonSuccessKind) -> TestCaseStatus {
    let mut status = TestCaseStatus::non_success(kind);
    status.set_type(swatch.outcome.word());
    status.set_message(format!("{}: {}", swatch.file, swatch.outcome));
    let or_none = |value: &Option<String>| value.clone().unwrap_or_else(|| "nothing".to_owned());
    let lines = swatch.changes.iter().map(|change| {
        let (old, new) = (or_none(&change.old), or_none(&change.new));
        format!("{}: {old} → {new}\n", change.what)
    });
    let text: String = lines.collect();
    if !text.is_empty() {
        status.set_description(text);
    }
    status
}
