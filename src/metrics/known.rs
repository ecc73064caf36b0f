//! Patterns whose measures are known: sites, links, angles and figures made with the report's own program.

use serde_json::Value;

use super::{Measured, Measures};
use crate::geom::{Angle, Point, Rect};
use crate::region::Region;
use crate::stage::{Graph, Layers};

const CONFIGURATIONS: &str = include_str!("../../tests/data/configurations.json");

impl Measured {
    /// A pattern of square tiles of one layer, turned about their sites, on a page of so many millimetres.
    pub(super) fn of_squares(
        page: [f64; 2],
        sites: Vec<Point>,
        edges: &[[u32; 2]],
        angles: Vec<Angle>,
        side: f64,
    ) -> Self {
        let outline = |(site, angle): (&Point, &Angle)| {
            let (along, half) = (angle.unit() * (side / 2.0), side / 2.0);
            let across = (*angle + Angle::RIGHT).unit() * half;
            vec![*site - along - across, *site + along - across, *site + along + across, *site - along + across]
        };
        let outlines = sites.iter().zip(&angles).map(outline).collect();
        let tiles = sites.len();
        Self {
            name: "paint".to_owned(),
            seed: 0,
            region: Region::rect(Rect::new(Point::new(0.0, 0.0), Point::new(page[0], page[1]))),
            k: vec![1.0; tiles],
            layers: vec![Layers::new(1, 0.0); tiles],
            outlines,
            sites,
            angles,
            ..Self::nothing(Graph::new(tiles, edges, Vec::new()))
        }
    }
}

/// A list of pairs of numbers.
fn pairs(value: &Value) -> impl Iterator<Item = [f64; 2]> + '_ {
    value.as_array().unwrap().iter().map(|pair| [0, 1].map(|i| pair[i].as_f64().unwrap()))
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
}

/// The configurations, each with what it is called, its pattern and its figures.
pub(super) fn configurations() -> Vec<(String, Measured, Value)> {
    let configurations: Vec<Value> = serde_json::from_str(CONFIGURATIONS).unwrap();
    configurations
        .into_iter()
        .map(|mut configuration| {
            let name = format!("{} {}", configuration["condition"].as_str().unwrap(), configuration["seed"]);
            let edges: Vec<[u32; 2]> = pairs(&configuration["edges"]).map(|edge| edge.map(|end| end as u32)).collect();
            let measured = Measured::of_squares(
                [2, 3].map(|i| configuration["region"][i].as_f64().unwrap()),
                pairs(&configuration["sites"]).map(|[x, y]| Point::new(x, y)).collect(),
                &edges,
                numbers(&configuration["angles"]).into_iter().map(Angle::radians).collect(),
                configuration["tile_size"][0].as_f64().unwrap(),
            );
            (name, measured, configuration["metrics"].take())
        })
        .collect()
}

#[test]
fn measures_are_those_of_the_report() {
    for (name, measured, known) in configurations() {
        let measures = serde_json::to_value(Measures::new(&measured)).unwrap();
        for (figure, tolerance) in
            [("e_contrast", 1e-9), ("h_angle", 1e-9), ("xi", 1e-4), ("xi_r2", 1e-4), ("c_cov", 1e-9), ("u_vor", 1e-9)]
        {
            let [ours, known] = [&measures, &known].map(|figures| figures[figure].as_f64().unwrap());
            assert!((ours - known).abs() < tolerance, "{name}: {figure} is {known}, not {ours}");
        }
        let [ours, reported] = [&measures, &known].map(|figures| numbers(&figures["r"]));
        assert_eq!(ours.len(), reported.len(), "{name}");
        for (k, (ours, known)) in (1..).zip(ours.iter().zip(&reported)) {
            assert!((ours - known).abs() < 1e-9, "{name}: r{k} is {known}, not {ours}");
        }
        assert_eq!(measures["pairs"], known["pairs"], "{name}");
    }
}

#[test]
fn the_checkerboard_fits_by_its_weights_alone() {
    let (_, measured, _) = configurations().into_iter().find(|(name, ..)| name == "gridCheckerboard 0").unwrap();
    let decay = Measures::new(&measured).decay;
    assert!((decay.xi.unwrap() - 2.047).abs() < 1e-3);
    assert!((decay.xi_r2.unwrap() + 0.384).abs() < 1e-3);
    assert!((decay.xi_r2_weighted.unwrap() - 0.881).abs() < 1e-3);
    assert_eq!(decay.xi_at_bound, Some(false));
}
