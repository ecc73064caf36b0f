//! The experiment of the report that the measures come from: `examples/paper.kake` over its 500 runs, held to the report's
//! printed tables.

use kakeami::Config;
use kakeami::experiment::{Outcome, Request, one, prepare};

use crate::support::{Folder, here};

/// The conditions in the report's order.
const CONDITIONS: [&str; 5] =
    ["poisson + bfs", "poisson + random", "uniform + bfs", "uniform + random", "grid + checkerboard"];

/// Mean and standard deviation of each measure in each condition: the summary table of section 6.3.
const SUMMARY: [(&str, [(f64, f64); 5]); 8] = [
    ("e_contrast", [(0.640, 0.005), (0.497, 0.026), (0.642, 0.006), (0.500, 0.023), (0.696, 0.0)]),
    ("h_angle", [(0.960, 0.022), (0.968, 0.012), (0.959, 0.023), (0.967, 0.015), (0.279, 0.0)]),
    ("r1", [(-0.353, 0.017), (0.006, 0.063), (-0.358, 0.018), (-0.000, 0.055), (-0.391, 0.0)]),
    ("r2", [(0.168, 0.017), (-0.002, 0.040), (0.170, 0.017), (-0.002, 0.037), (0.241, 0.0)]),
    ("r3", [(-0.067, 0.024), (-0.004, 0.031), (-0.069, 0.020), (-0.002, 0.027), (-0.168, 0.0)]),
    ("c_cov", [(0.948, 0.010), (0.947, 0.010), (0.749, 0.030), (0.749, 0.030), (1.0, 0.0)]),
    ("u_vor", [(0.240, 0.021), (0.240, 0.021), (0.558, 0.073), (0.558, 0.073), (0.0, 0.0)]),
    ("xi", [(1.305, 0.284), (57.439, 46.904), (1.277, 0.206), (57.682, 46.570), (2.047, 0.0)]),
];

/// Mean numbers of tiles and links, of which the report gives no deviation: ours stands in.
const COUNTS: [(&str, [f64; 5]); 2] =
    [("tiles", [68.8, 68.8, 68.8, 68.8, 64.0]), ("edges", [191.6, 191.6, 192.1, 192.1, 161.0])];

/// Where the means of breadth-first angles lie: they depend on the order in which neighbours are visited, which is another
/// one here (e_contrast is 0.640 in the report's order, 0.642 in that of indices). To three digits, as these are given.
const BREADTH_FIRST: [(&str, [f64; 2]); 5] = [
    ("e_contrast", [0.638, 0.645]),
    ("h_angle", [0.945, 0.970]),
    ("r1", [-0.365, -0.345]),
    ("r2", [0.160, 0.180]),
    ("r3", [-0.080, -0.060]),
];

/// Shares of the variance (eta squared) of placement, angles, both together and the rest: the report's appendix A, and how
/// far ours may lie from them. Two are farther off than 0.02. How even breadth-first angles are depends on the order of
/// neighbours: over ten times a hundred seeds the angles' share of `h_angle` lies between 0.085 and 0.148 here. And the
/// variance of `xi` is that of runs whose fit ends on its bound: over the same seeds the share lies between 0.43 and 0.57,
/// so that a hundred do not tell it any closer.
const ETA: [(&str, f64, [f64; 4]); 8] = [
    ("e_contrast", 0.02, [0.0002, 0.9425, 0.0000, 0.0573]),
    ("h_angle", 0.10, [0.0008, 0.0487, 0.0000, 0.9505]),
    ("r1", 0.02, [0.0002, 0.9441, 0.0000, 0.0557]),
    ("c_cov", 0.02, [0.9518, 0.0000, 0.0000, 0.0482]),
    ("u_vor", 0.02, [0.8975, 0.0000, 0.0000, 0.1025]),
    ("r2", 0.02, [0.0000, 0.8918, 0.0001, 0.1080]),
    ("r3", 0.02, [0.0000, 0.6200, 0.0006, 0.3794]),
    ("xi", 0.15, [0.0000, 0.4226, 0.0000, 0.5773]),
];

/// What is asserted, said before the first failure ends the test.
struct Check(Vec<String>);

impl Check {
    fn within(&mut self, what: &str, value: f64, [low, high]: [f64; 2]) {
        if !(low..=high).contains(&value) {
            self.0.push(format!("{what} is {value:.4}, not in {low:.4} .. {high:.4}"));
        }
    }
}

fn outcome() -> Outcome {
    let prepared = prepare("paper.kake", &Folder(here("examples")), &Config::default(), &Request::default());
    let (recipe, plan) = prepared.ready.expect("the example is without fault");
    let done: Vec<_> = (0..plan.runs()).map(|run| one(&recipe, &plan, run)).collect();
    Outcome::new(plan, done)
}

#[test]
fn the_report_is_reproduced() {
    let outcome = outcome();
    let plan = &outcome.plan;
    let names: Vec<&str> = plan.conditions.iter().map(|condition| condition.name.as_str()).collect();
    assert_eq!(names, CONDITIONS);
    assert_eq!((outcome.runs.len(), outcome.failures.len()), (500, 0));
    let analysis = |measure: &str| {
        let measure = outcome.measure(measure).unwrap_or_else(|| panic!("{measure} is measured"));
        outcome.analyses.iter().find(|analysis| analysis.measure == measure).expect("it is analysed")
    };
    let mean = |measure: &str, condition: usize| {
        let summary = analysis(measure).summaries[condition].as_ref().expect("it is measured");
        (summary.mean, summary.sd.expect("there are many seeds"))
    };
    let mut check = Check(Vec::new());
    for (measure, cells) in SUMMARY {
        for (condition, (reported, sd)) in cells.into_iter().enumerate() {
            let what = format!("the mean {measure} of {}", CONDITIONS[condition]);
            let (ours, spread) = mean(measure, condition);
            let range = BREADTH_FIRST.iter().find(|(name, _)| *name == measure);
            match (condition, range) {
                // All seeds are alike. Which diagonal a square of the triangulation has is the report's library's choice
                // there and a fixed rule here: distances of two links and more change with it.
                (4, _) => {
                    check.within(&format!("the spread of {measure}"), spread, [0.0, 1e-9]);
                    if !["r2", "r3", "xi"].contains(&measure) {
                        check.within(&what, ours, [reported - 0.0005, reported + 0.0005]);
                    }
                }
                (0 | 2, Some((_, range))) => check.within(&what, (ours * 1000.0).round() / 1000.0, *range),
                _ => check.within(&what, ours, [reported - 0.3 * sd, reported + 0.3 * sd]),
            }
        }
    }
    for (measure, cells) in COUNTS {
        for (condition, reported) in cells.into_iter().enumerate() {
            let (ours, sd) = mean(measure, condition);
            // The report rounds to one digit.
            let room = 0.3 * sd + 0.05;
            check.within(&format!("{measure} of {}", CONDITIONS[condition]), ours, [reported - room, reported + room]);
        }
    }
    for (measure, room, shares) in ETA {
        for (row, reported) in analysis(measure).anova.rows.iter().zip(shares) {
            let ours = row.eta2.expect("there is variance");
            check.within(&format!("eta2 of {measure}, {}", row.source), ours, [reported - room, reported + room]);
        }
    }
    assert!(check.0.is_empty(), "\n{}", check.0.join("\n"));
    // Exactly: 112 of 161 links of the checkerboard join tiles that are turned by a right angle.
    let contrast = mean("e_contrast", 4).0;
    assert!((contrast - 112.0 / 161.0).abs() < 1e-12, "{contrast}");
}
