//! Ramps, steps, blurred images and directions.

use super::*;

fn ramp(stops: &[(f64, f64)], ease: Ease) -> Ramp {
    Ramp { stops: stops.iter().map(|&(at, value)| Stop { at, value }).collect(), ease }
}

#[test]
fn ramps_have_the_values_of_their_stops() {
    let three = ramp(&[(0.2, 1.0), (0.4, 3.0), (1.0, 4.0)], Ease::Linear);
    assert_eq!([0.0, 0.2, 0.4, 1.0, 7.0].map(|share| three.at(share)), [1.0, 1.0, 3.0, 4.0, 4.0]);
    assert!((three.at(0.3) - 2.0).abs() < 1e-12 && (three.at(0.7) - 3.5).abs() < 1e-12);
    // Two stops at one place are a jump.
    let jump = ramp(&[(0.0, 1.0), (0.5, 1.0), (0.5, 4.0), (1.0, 4.0)], Ease::InOut);
    assert_eq!([0.0, 0.499, 0.5, 0.6].map(|share| jump.at(share)), [1.0, 1.0, 4.0, 4.0]);
}

#[test]
fn eases_begin_and_end_where_they_should() {
    for ease in [Ease::Linear, Ease::In, Ease::Out, Ease::InOut] {
        assert_eq!([ease.apply(0.0), ease.apply(1.0)], [0.0, 1.0], "{ease:?}");
    }
    assert_eq!([Ease::In, Ease::Out, Ease::InOut].map(|ease| ease.apply(0.25)), [0.0625, 0.4375, 0.15625]);
}

#[test]
fn steps_are_even_bands() {
    let steps = Steps::even(4, 0.0, 3.0);
    let values = [-1.0, 0.0, 0.74, 0.75, 1.5, 2.24, 2.25, 9.0].map(|value| steps.apply(value));
    assert_eq!(values, [0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 3.0, 3.0]);
    let downwards = Steps { bounds: vec![0.1, 0.9], start: 4.0, end: 0.0 };
    assert_eq!([0.0, 0.1, 0.5, 0.9].map(|value| downwards.apply(value)), [4.0, 2.0, 2.0, 0.0]);
}

#[test]
fn blurring_keeps_what_is_even_and_spreads_a_dot_as_a_gaussian_does() {
    let even = Image { width: 5, height: 3, samples: vec![0.25; 15] };
    for deviation in [0.0, 0.3, 2.0, 40.0] {
        assert!(even.blurred(deviation).samples.iter().all(|sample| (sample - 0.25).abs() < 1e-7), "{deviation}");
    }
    // The last is wide enough for boxes.
    for deviation in [0.4, 1.0, 2.7, 6.0, 8.0, 8.1] {
        let mut dot = Image { width: 81, height: 81, samples: vec![0.0; 81 * 81] };
        dot.samples[40 * 81 + 40] = 1.0;
        let spread = dot.blurred(deviation);
        let (mut mass, mut variance) = (0.0, 0.0);
        for (i, &sample) in spread.samples.iter().enumerate() {
            let x = i as f64 % 81.0 - 40.0;
            mass += f64::from(sample);
            variance += f64::from(sample) * x * x;
        }
        assert!((mass - 1.0).abs() < 1e-5, "{deviation}: {mass}");
        assert!((variance / (deviation * deviation) - 1.0).abs() < 1e-4, "{deviation}: {variance}");
        let gauss =
            |r2: f64| libm::exp(-r2 / (2.0 * deviation * deviation)) / (std::f64::consts::TAU * deviation * deviation);
        if deviation >= 1.0 {
            let slack = if deviation > 8.0 { 0.061 } else { 1e-5 };
            for (x, y) in [(40, 40), (41, 40), (41, 42), (48, 40), (52, 31)] {
                let r2 = f64::from((x - 40) * (x - 40) + (y - 40) * (y - 40));
                let error = spread.sample(x as usize, y as usize) - gauss(r2);
                assert!(error.abs() < slack * gauss(0.0), "{deviation} at {x}, {y}: {error}");
            }
        }
    }
}

#[test]
fn a_blur_wider_than_the_image_ends() {
    let image = Image { width: 3, height: 1, samples: vec![0.0, 0.5, 1.0] };
    let blurred = image.blurred(1000.0);
    // Edges go on outwards, so what is left is half of either.
    assert!(blurred.samples.iter().all(|sample| (sample - 0.5).abs() < 0.01), "{:?}", blurred.samples);
}

#[test]
fn directions_follow_gradients_and_level_lines() {
    let scale = Length::mm(2.0);
    for degrees in [0.0, 30.0, 90.0, 179.0] {
        let slope = Field::linear_across(rect(0.0, 0.0, 50.0, 50.0), Angle::degrees(degrees), 0.0, 1.0);
        for (sense, turn) in [(Sense::Gradient, 0.0), (Sense::Level, 90.0)] {
            let found = Angle::radians(slope.clone().direction(scale, sense).at(p(24.0, 26.0)));
            let error = found.rp1_distance(Angle::degrees(degrees + turn)).to_radians();
            assert!(error < 1e-6, "{degrees} {sense:?}: {error}");
            assert!((0.0..std::f64::consts::PI).contains(&found.to_radians()));
        }
    }
    // A dark line has one direction although its sides slope against each other.
    let line = x().zip(Field::constant(10.0), Operator::Subtract).map(Function::Abs);
    let level = Angle::radians(line.direction(scale, Sense::Level).at(p(10.0, 3.0)));
    assert!(level.rp1_distance(Angle::RIGHT).to_radians() < 1e-9);
}

#[test]
fn where_nothing_changes_the_next_change_counts() {
    let edge = Field::linear(p(30.0, 0.0), p(30.0, 1.0), 0.0, 1.0);
    let flow = edge.clone().direction(Length::mm(1.0), Sense::Gradient);
    assert!((flow.at(p(30.0, 9.0)) - std::f64::consts::FRAC_PI_2).abs() < 1e-9);
    // Out of all reach, and where there is nothing at all.
    assert_eq!(flow.at(p(30.0, 90.0)), 0.0);
    assert_eq!(Field::constant(3.0).direction(Length::mm(1.0), Sense::Level).at(p(1.0, 1.0)), 0.0);
    // A peak slopes every way alike.
    let peak = Field::radial(p(5.0, 5.0), Length::mm(40.0), 1.0, 0.0);
    assert_eq!(peak.direction(Length::mm(1.0), Sense::Gradient).at(p(5.0, 5.0)), 0.0);
    assert_eq!(flow.cost(), 1 + 81 * 6 * edge.cost());
}

#[test]
fn tangents_run_along_the_nearest_edge() {
    let square = Field::tangent(Region::rect(rect(10.0, 10.0, 30.0, 30.0)));
    let degrees = |x: f64, y: f64| square.at(p(x, y)).to_degrees();
    for (x, y, expected) in [(12.0, 20.0, 90.0), (20.0, 12.0, 0.0), (30.0, 17.0, 90.0), (5.0, 5.0, 135.0)] {
        assert!((degrees(x, y) - expected).abs() < 1e-9, "{x}, {y}: {}", degrees(x, y));
    }
    assert_eq!(Field::tangent(Region::empty()).at(p(1.0, 1.0)), 0.0);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, ..ProptestConfig::default() })]

    /// The tangent is that of the circle, and the level lines of the distance agree with it.
    #[test]
    fn circles_turn_round(at in (-9.0..9.0f64, -9.0..9.0f64)) {
        let at = p(at.0, at.1);
        let away = (at - p(0.0, 0.0)).length();
        prop_assume!(away > 1.5 && (away - 5.0).abs() > 0.5);
        let corners = (0..720).map(|i| p(0.0, 0.0) + Angle::degrees(f64::from(i) / 2.0).unit() * 5.0).collect();
        let circle = Region::from_rings(vec![corners], crate::region::FillRule::NonZero);
        let expected = Angle::of(at - p(0.0, 0.0)) + Angle::RIGHT;
        let tangent = Angle::radians(Field::tangent(circle.clone()).at(at));
        prop_assert!(tangent.rp1_distance(expected).to_radians() < 0.01);
        let level = Field::distance(circle).direction(Length::mm(0.4), Sense::Level).at(at);
        prop_assert!(Angle::radians(level).rp1_distance(expected).to_radians() < 0.02);
    }
}
