//! The statistics against known answers: those of the report, and those of SciPy and statsmodels to data of many kinds.
//!
//! `tests/data/statistics` holds the report's 500 runs with what pandas, SciPy and statsmodels made of them, and
//! `reference.json` with the program that wrote it.

use std::collections::BTreeMap;
use std::fs;

use kakeami::stats::{
    Anova, Factor, Factorial, Observation, anova, assumptions, cohen_d, paired_t, shapiro_wilk,
    studentized_range_quantile, studentized_range_upper, summary, tukey, wilcoxon_signed_rank,
};
use serde::Deserialize;
use serde_json::Value;

use crate::support::here;

/// A file of known answers.
fn known(name: &str) -> Value {
    let text = fs::read_to_string(here("tests/data/statistics").join(name)).expect("the answers are there");
    serde_json::from_str(&text).expect("the answers are JSON")
}

/// Fails unless a number is as it should be, absolutely or as a share of what it should be.
fn near(what: &str, found: impl Into<Option<f64>>, known: &Value, absolute: f64, relative: f64) {
    let (found, known) = (found.into(), known.as_f64());
    let (Some(a), Some(b)) = (found, known) else {
        assert!(found.is_none() && known.is_none(), "{what}: {found:?} for {known:?}");
        return;
    };
    assert!((a - b).abs() <= absolute.max(relative * b.abs()), "{what}: {a:e} for {b:e}");
}

/// Fails unless a table is as it should be: sums of squares to 1e-8, probabilities above 1e-12 to 1e-6 of themselves.
fn near_table(what: &str, found: &Anova, known: &Value) {
    let rows = known.as_object().expect("rows have names");
    assert_eq!(found.rows.len(), rows.len(), "{what}");
    for row in &found.rows {
        let what = format!("{what} {}", row.source);
        let known = &rows[&row.source];
        near(&what, row.ss, &known["ss"], 1e-8, 1e-10);
        near(&what, row.df as f64, &known["df"], 0.0, 0.0);
        near(&what, row.f, &known["f"], 1e-8, 1e-8);
        near(&what, row.p, &known["p"], 1e-300, 1e-6);
        if let Some(eta2) = known.get("eta2") {
            near(&what, row.eta2, eta2, 1e-10, 0.0);
            near(&what, row.omega2, known.get("omega2").unwrap_or(&Value::Null), 1e-10, 0.0);
        }
    }
}

/// The measures of the report's runs, by condition and name.
fn runs() -> BTreeMap<String, BTreeMap<String, Vec<f64>>> {
    let mut reader = csv::Reader::from_path(here("tests/data/statistics/runs.csv")).expect("the runs are there");
    let names = reader.headers().expect("the runs have a header").clone();
    let mut runs: BTreeMap<String, BTreeMap<String, Vec<f64>>> = BTreeMap::new();
    for record in reader.records() {
        let record = record.expect("every run is whole");
        let of_condition = runs.entry(record[0].to_owned()).or_default();
        for (name, field) in names.iter().zip(&record).skip(2) {
            of_condition.entry(name.to_owned()).or_default().extend(field.parse::<f64>().ok());
        }
    }
    runs
}

/// The report's factorial conditions, with the levels of placement and of angle.
const CONDITIONS: [(&str, [usize; 2]); 4] =
    [("poissonBfs", [0, 0]), ("poissonRandom", [0, 1]), ("randomBfs", [1, 0]), ("randomRandom", [1, 1])];

/// The report's design for a measure.
fn report(runs: &BTreeMap<String, BTreeMap<String, Vec<f64>>>, measure: &str) -> Factorial {
    let factor = |name: &str| Factor { name: name.to_owned(), levels: vec!["first".into(), "second".into()] };
    Factorial {
        factors: vec![factor("placement"), factor("angle")],
        observations: CONDITIONS
            .iter()
            .flat_map(|(name, levels)| {
                runs[*name][measure].iter().map(|value| Observation { levels: levels.to_vec(), value: *value })
            })
            .collect(),
    }
}

#[test]
fn the_reports_statistics_are_found_again() {
    let (known, runs) = (known("report.json"), runs());
    for (condition, measures) in known["summary"].as_object().unwrap() {
        for (measure, known) in measures.as_object().unwrap() {
            let found = summary(&runs[condition][measure]).unwrap();
            near(measure, found.mean, &known["mean"], 1e-12, 1e-12);
            near(measure, found.sd, &known["sd"], 1e-12, 1e-12);
        }
    }
    for (measure, known) in known["anova"].as_object().unwrap() {
        let design = report(&runs, measure);
        let found = anova(&design);
        assert_eq!(found.note, None);
        near_table(measure, &found, &known["rows"]);
        let found = assumptions(&design);
        near(measure, found.shapiro_w, &known["shapiro_w"], 1e-10, 0.0);
        near(measure, found.shapiro_p, &known["shapiro_p"], 0.0, 1e-6);
        near(measure, found.levene_f, &known["levene_f"], 1e-8, 0.0);
        near(measure, found.levene_p, &known["levene_p"], 0.0, 1e-6);
        assert_eq!(found.note, None);
    }
    for (measure, pairs) in known["cohen_d"].as_object().unwrap() {
        for (pair, known) in pairs.as_object().unwrap() {
            let (a, b) = pair.split_once(" vs ").unwrap();
            near(measure, cohen_d(&runs[a][measure], &runs[b][measure]), known, 1e-8, 0.0);
        }
    }
    for (measure, rows) in known["tukey"].as_object().unwrap() {
        let groups: Vec<(String, Vec<f64>)> =
            CONDITIONS.iter().map(|(name, _)| ((*name).to_owned(), runs[*name][measure].clone())).collect();
        let found = tukey(&groups, 0.05);
        assert_eq!(found.len(), rows.as_array().unwrap().len());
        for (found, known) in found.iter().zip(rows.as_array().unwrap()) {
            assert_eq!(
                (Some(&*found.group1), Some(&*found.group2)),
                (known["group1"].as_str(), known["group2"].as_str())
            );
            near(measure, found.meandiff, &known["meandiff"], 1e-10, 0.0);
            near(measure, found.p_adj, &known["p_adj"], 1e-8, 0.0);
            near(measure, found.lower, &known["lower"], 1e-6, 0.0);
            near(measure, found.upper, &known["upper"], 1e-6, 0.0);
            assert_eq!(found.reject, known["reject"].as_bool());
        }
    }
}

/// Numbers out of JSON.
fn numbers(value: &Value) -> Vec<f64> {
    Vec::deserialize(value).expect("these are numbers")
}

/// A design out of JSON: factors a, b, c and so on.
fn design(known: &Value) -> Factorial {
    let shape: Vec<usize> = Vec::deserialize(&known["shape"]).unwrap();
    let levels: Vec<Vec<usize>> = Vec::deserialize(&known["levels"]).unwrap();
    let names = "abcdef".chars();
    let observation = |(levels, value)| Observation { levels, value };
    Factorial {
        factors: names
            .zip(&shape)
            .map(|(name, count)| Factor { name: name.into(), levels: (0..*count).map(|i| i.to_string()).collect() })
            .collect(),
        observations: levels.into_iter().zip(numbers(&known["values"])).map(observation).collect(),
    }
}

#[test]
fn designs_of_any_shape_are_analysed_as_statsmodels_does() {
    let known = known("reference.json");
    for (i, known) in known["anova"].as_array().unwrap().iter().enumerate() {
        let (what, design) = (format!("design {i}"), design(known));
        let found = anova(&design);
        assert_eq!(found.note, None);
        near_table(&what, &found, &known["rows"]);
        let found = assumptions(&design);
        near(&what, found.shapiro_w, &known["shapiro_w"], 1e-10, 0.0);
        near(&what, found.shapiro_p, &known["shapiro_p"], 0.0, 1e-8);
        near(&what, found.levene_f, &known["levene_f"], 1e-10, 0.0);
        near(&what, found.levene_p, &known["levene_p"], 0.0, 1e-8);
    }
}

#[test]
fn empty_cells_are_told_and_their_degrees_of_freedom_not_counted() {
    let known = known("reference.json");
    for (i, known) in known["gaps"].as_array().unwrap().iter().enumerate() {
        let found = anova(&design(known));
        near_table(&format!("design {i}"), &found, &known["rows"]);
        assert!(found.note.is_some_and(|note| note.contains("cells hold no run")));
    }
}

#[test]
fn normality_is_judged_as_scipy_does() {
    let known = known("reference.json");
    for known in known["shapiro"].as_array().unwrap() {
        let found = shapiro_wilk(&numbers(&known["values"])).unwrap();
        near("w", found.w, &known["w"], 1e-10, 0.0);
        near("p", found.p, &known["p"], 1e-12, 1e-8);
    }
}

#[test]
fn the_studentized_range_is_distributed_as_scipy_has_it() {
    let known = known("reference.json");
    for known in known["range"].as_array().unwrap() {
        let count = |name: &str| usize::deserialize(&known[name]).unwrap();
        let q = known["q"].as_f64().unwrap();
        let found = studentized_range_upper(q, count("groups"), count("df"));
        near(&known.to_string(), found, &known["p"], 2e-11, 0.0);
    }
    for known in known["quantile"].as_array().unwrap() {
        let count = |name: &str| usize::deserialize(&known[name]).unwrap();
        let found = studentized_range_quantile(known["alpha"].as_f64().unwrap(), count("groups"), count("df"));
        near(&known.to_string(), found, &known["q"], 0.0, 1e-7);
    }
}

#[test]
fn groups_of_unlike_size_are_compared_as_statsmodels_does() {
    let known = known("reference.json");
    for (i, known) in known["tukey"].as_array().unwrap().iter().enumerate() {
        let what = format!("groups {i}");
        let groups: Vec<(String, Vec<f64>)> = known["groups"]
            .as_array()
            .unwrap()
            .iter()
            .enumerate()
            .map(|(i, values)| (i.to_string(), numbers(values)))
            .collect();
        let found = tukey(&groups, known["alpha"].as_f64().unwrap());
        assert_eq!(found.len(), known["p_adj"].as_array().unwrap().len());
        for (j, found) in found.iter().enumerate() {
            near(&what, found.meandiff, &known["meandiff"][j], 1e-10, 0.0);
            near(&what, found.p_adj, &known["p_adj"][j], 1e-8, 0.0);
            near(&what, found.lower, &known["lower"][j], 1e-6, 0.0);
            near(&what, found.upper, &known["upper"][j], 1e-6, 0.0);
            assert_eq!(found.reject, known["reject"][j].as_bool());
        }
    }
}

#[test]
fn pairs_are_compared_as_scipy_does() {
    let known = known("reference.json");
    for (i, known) in known["paired"].as_array().unwrap().iter().enumerate() {
        let what = format!("pairs {i}");
        let (a, b) = (numbers(&known["a"]), numbers(&known["b"]));
        let t = paired_t(&a, &b).unwrap();
        near(&what, t.t, &known["t"], 1e-10, 0.0);
        near(&what, t.df as f64, &known["df"], 0.0, 0.0);
        near(&what, t.p, &known["p"], 1e-300, 1e-8);
        near(&what, t.p_greater, &known["p_greater"], 1e-300, 1e-8);
        let ranks = wilcoxon_signed_rank(&a, &b).unwrap();
        near(&what, ranks.plus, &known["plus"], 0.0, 0.0);
        near(&what, ranks.z.abs(), &Value::from(known["rank_z"].as_f64().unwrap().abs()), 1e-10, 0.0);
        near(&what, ranks.p, &known["rank_p"], 1e-300, 1e-8);
        near(&what, ranks.p_greater, &known["rank_p_greater"], 1e-300, 1e-8);
    }
}
