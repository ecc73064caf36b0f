use usvg::roxmltree::Document;

use super::*;

/// Values that no chart should choke on.
fn odd() -> Vec<Vec<f64>> {
    vec![
        vec![],
        vec![0.0],
        vec![0.948; 5],
        vec![f64::NAN, f64::INFINITY, f64::NEG_INFINITY],
        vec![1.0, f64::NAN, 2.0],
        vec![1.0, 1.0 + 1e-15],
        vec![0.1, 0.2, 0.3, 1e300],
        vec![-1e300, 1e300],
        vec![-1e-300, 1e-300],
    ]
}

/// A text with all that XML and HTML give a meaning to.
const NAME: &str = "<b>\"a\" & 'b'</b> \u{0} ]]> \u{5199}";

fn every_chart(values: &[f64]) -> Vec<String> {
    let titles = Titles { title: NAME, x: NAME, y: NAME };
    let spot = |&y: &f64| Spot { x: y, y, band: Some([y - 1.0, y + 1.0]) };
    let series = |look| Series { name: NAME, look, spots: values.iter().map(spot).collect() };
    let means = |value: &f64| Some(Estimate { mean: *value, interval: Some([value - 1.0, value + 1.0]) });
    let sectors: Vec<Sector> = values.iter().map(|&v| Sector { share: v, spread: Some([v, v + 1.0]) }).collect();
    let names: Vec<&str> = values.iter().map(|_| NAME).collect();
    let spreads: Vec<[f64; 2]> = values.iter().map(|v| [v - 1.0, v + 1.0]).collect();
    let ends = [values.first().copied().unwrap_or(0.0), values.last().copied().unwrap_or(0.0)];
    let mark = Mark { name: NAME, value: ends[0] };
    vec![
        boxes(&titles, &[Group { name: NAME, values }, Group { name: "", values: &[1.0] }]),
        lines(&titles, &[series(Look::Joined), series(Look::Line), series(Look::Markers)], None),
        histogram(&titles, &Bars { range: ends, heights: values, spreads: &spreads, marks: &[mark] }),
        directions(&titles, &sectors),
        effects(&titles, &names, &[Effect { name: NAME, means: values.iter().map(means).collect() }]),
        matrix(&titles, &names, &names, &[values.iter().map(|&value| Some(value)).collect()]),
    ]
}

#[test]
fn charts_are_whole_whatever_the_data_are() {
    for values in odd() {
        for text in every_chart(&values) {
            assert!(!text.contains("NaN") && !text.contains("inf"), "{values:?}: {text}");
            let document = Document::parse(&text).unwrap_or_else(|error| panic!("{values:?}: {error}\n{text}"));
            let texts = document.descendants().filter_map(|node| node.text());
            assert!(texts.clone().any(|text| text.contains("<b>\"a\" & 'b'</b>")), "{text}");
            assert!(document.descendants().all(|node| !node.has_tag_name("b")));
        }
    }
}

#[test]
fn nothing_to_draw_is_said() {
    for text in every_chart(&[]).iter().take(5) {
        assert!(text.contains("no data"), "{text}");
    }
}

#[test]
fn a_box_plot() {
    let values = [1.0, 2.0, 3.0, 4.0, 10.0];
    let groups = [Group { name: "poisson + bfs", values: &values }, Group { name: "grid", values: &[2.0] }];
    insta::assert_snapshot!(boxes(&Titles { title: "Contrast", x: "e_contrast", y: "" }, &groups));
}

#[test]
fn quartiles_lie_between_order_statistics() {
    let values = [1.0, 2.0, 3.0, 10.0];
    assert_eq!([0.0, 0.25, 0.5, 0.75, 1.0].map(|q| super::boxes::quantile(&values, q)), [1.0, 1.75, 2.5, 4.75, 10.0]);
}
