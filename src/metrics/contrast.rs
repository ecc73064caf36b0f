//! How far neighbours are turned against each other.

use std::f64::consts::FRAC_2_PI;

use serde::Serialize;

use super::{Measured, Scalars, mean};
use crate::geom::Angle;
use crate::stage::Graph;
use crate::stats::percentile;

/// The per cent of the links that may have less contrast than the figure that tells whether tiles run together.
const FIFTH: f64 = 5.0;

/// Contrasts over the links: 2/pi times distances on the real projective line, so in [0, 1].
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Contrast {
    /// The mean contrast of the links; 0 without links.
    pub e_contrast: f64,
    /// What `e_contrast` cannot exceed, in [2/3, 1]: three directions lie at most pi apart in all, so that over T triangles,
    /// B links that belong to just one and Z to none it is at most (2 T + B + 2 Z) / 2 E. None without links, where they
    /// are not a triangulation's, and on a page that repeats.
    pub e_bound: Option<f64>,
    /// `e_contrast` over `e_bound`, in [0, 1].
    pub e_share: Option<f64>,
    /// The 5th percentile of the contrasts, with linear interpolation between order statistics. None without links, like
    /// all that follow.
    pub p5_contrast: Option<f64>,
    /// The least contrast.
    pub min_contrast: Option<f64>,
    /// The mean contrast as the eye sees it: of two tiles those layers count that are nearest in direction. Links of tiles
    /// without strokes are left out; none where no others are.
    pub e_contrast_layers: Option<f64>,
    /// The 5th percentile of the same.
    pub p5_contrast_layers: Option<f64>,
    /// The mean contrast, each link weighted by the mean k of its ends; none where all weights are zero.
    pub e_contrast_k: Option<f64>,
    /// The mean contrast of the directions that strokes have where tiles meet, halfway between their sites: `e_contrast`
    /// itself where strokes are straight. Strands of nawaami count by the ends that face each other. Of other programs'
    /// patterns nothing is known of it.
    pub e_contrast_tangent: Option<f64>,
}

impl Contrast {
    /// The figures by their names.
    #[must_use]
    pub fn scalars(&self) -> Scalars {
        vec![
            ("e_contrast".into(), Some(self.e_contrast)),
            ("e_bound".into(), self.e_bound),
            ("e_share".into(), self.e_share),
            ("p5_contrast".into(), self.p5_contrast),
            ("min_contrast".into(), self.min_contrast),
            ("e_contrast_layers".into(), self.e_contrast_layers),
            ("p5_contrast_layers".into(), self.p5_contrast_layers),
            ("e_contrast_k".into(), self.e_contrast_k),
            ("e_contrast_tangent".into(), self.e_contrast_tangent),
        ]
    }
}

/// Measures the contrasts.
#[must_use]
pub fn measure(measured: &Measured) -> Contrast {
    let contrasts: Vec<f64> = measured.graph.edges().map(|edge| measured.contrast(edge)).collect();
    let e_contrast = mean(&contrasts).unwrap_or(0.0);
    let e_bound = bound(measured);
    let layered: Vec<f64> = measured.graph.edges().filter_map(|edge| layered(measured, edge)).collect();
    let tangents = measured.graph.edges().filter_map(|edge| tangent(measured, edge)).collect::<Vec<f64>>();
    Contrast {
        e_contrast,
        e_bound,
        e_share: e_bound.map(|bound| e_contrast / bound),
        p5_contrast: percentile(&contrasts, FIFTH),
        min_contrast: contrasts.iter().copied().min_by(f64::total_cmp),
        e_contrast_k: weighted(measured),
        e_contrast_layers: mean(&layered),
        p5_contrast_layers: percentile(&layered, FIFTH),
        e_contrast_tangent: mean(&tangents),
    }
}

/// What the mean contrast cannot exceed.
fn bound(measured: &Measured) -> Option<f64> {
    let graph = &measured.graph;
    let edges = graph.edges().count();
    if !measured.is_triangulated || edges == 0 {
        return None;
    }
    let of = triangles_of(graph);
    let (one, none) = of.iter().fold((0usize, 0usize), |(one, none), &triangles| {
        (one + usize::from(triangles == 1), none + usize::from(triangles == 0))
    });
    Some((2 * graph.triangles.len() + one + 2 * none) as f64 / (2 * edges) as f64)
}

/// How many triangles each link belongs to, in the order of the links.
pub(super) fn triangles_of(graph: &Graph) -> Vec<u32> {
    // Where the links of every tile to later ones start.
    let later = |tile: usize| {
        let neighbours = graph.neighbours(tile);
        &neighbours[neighbours.partition_point(|&other| other as usize <= tile)..]
    };
    let mut starts = Vec::with_capacity(graph.len() + 1);
    starts.push(0);
    for tile in 0..graph.len() {
        starts.push(starts[tile] + later(tile).len());
    }
    let mut of = vec![0; starts[graph.len()]];
    for &[a, b, c] in &graph.triangles {
        for (a, b) in [(a, b), (b, c), (c, a)] {
            let first = a.min(b) as usize;
            if let Ok(place) = later(first).binary_search(&a.max(b)) {
                of[starts[first] + place] += 1;
            }
        }
    }
    of
}

/// The contrast of the nearest layers of a link's ends.
fn layered(measured: &Measured, [a, b]: [u32; 2]) -> Option<f64> {
    let [(angle, layers), (other, others)] = [a, b]
        .map(|tile| tile as usize)
        .map(|tile| (measured.angles[tile], measured.layers.get(tile).map_or(0, |layers| layers.seen())));
    angle.layered_distance(layers, other, others).map(of_distance)
}

/// The mean contrast, weighted by k.
fn weighted(measured: &Measured) -> Option<f64> {
    let (mut sum, mut weights) = (0.0, 0.0);
    for edge in measured.graph.edges() {
        let [a, b] = edge.map(|tile| measured.k.get(tile as usize));
        let weight = (a? + b?) / 2.0;
        sum += weight * measured.contrast(edge);
        weights += weight;
    }
    (weights > 0.0).then(|| sum / weights)
}

/// The contrast of the directions that the strokes of two tiles have where their cells meet, halfway between the sites. Of
/// several directions the nearest count.
fn tangent(measured: &Measured, [a, b]: [u32; 2]) -> Option<f64> {
    let [a, b] = [a, b].map(|tile| tile as usize);
    let way = measured.sites[b] - measured.sites[a];
    let way = measured.period.map_or(way, |period| period.shortest(way));
    let towards =
        |tile: usize, way| Some(measured.runs.get(tile)?.towards(measured.sites[tile], measured.angles[tile], way));
    let (near, far) = (towards(a, way)?, towards(b, -way)?);
    let distances = near.into_iter().flat_map(|a| far.into_iter().map(move |b| of_distance(a.rp1_distance(b))));
    distances.min_by(f64::total_cmp)
}

/// The contrast that a distance on the real projective line makes.
fn of_distance(distance: Angle) -> f64 {
    distance.to_radians() * FRAC_2_PI
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::geom::{Length, Period, Point, Rect};
    use crate::metrics::Run;
    use crate::pass::link::link;
    use crate::scene::Link;
    use crate::stage::{Layers, Sites};

    /// Sites with Delaunay's links and some angles.
    fn pattern(sites: Vec<Point>, angles: &[f64]) -> Measured {
        let area = Rect::new(Point::default(), Point::new(10.0, 10.0));
        let all = Sites {
            points: sites.clone(),
            domain: area,
            extent: area,
            spacing: 1.0,
            cells: None,
            tiling: None,
            torus: None,
        };
        let angles: Vec<Angle> = angles.iter().map(|&angle| Angle::degrees(angle).direction()).collect();
        Measured {
            sites,
            runs: vec![Run::Straight; angles.len()],
            angles,
            is_triangulated: true,
            ..Measured::nothing(link(&all, Link::Delaunay))
        }
    }

    fn patterns() -> impl Strategy<Value = Measured> {
        prop::collection::vec((0.0..10.0f64, 0.0..10.0f64, 0.0..180.0f64), 2..80).prop_map(|all| {
            let sites = all.iter().map(|&(x, y, _)| Point::new(x, y)).collect();
            pattern(sites, &all.iter().map(|&(.., angle)| angle).collect::<Vec<_>>())
        })
    }

    proptest! {
        #[test]
        fn no_pattern_exceeds_its_bound(measured in patterns()) {
            let found = measure(&measured);
            prop_assert!(found.e_contrast <= found.e_bound.unwrap() + 1e-12);
            // Of a whole triangulation Euler's formula says how many links are at the rim; of sites on a line all are free.
            let (edges, triangles) = (measured.graph.edges().count(), measured.graph.triangles.len());
            let free = if triangles == 0 { 2 * edges } else { 2 * edges - 3 * triangles };
            let bound = (2 * triangles + free) as f64 / (2 * edges) as f64;
            prop_assert!((found.e_bound.unwrap() - bound).abs() < 1e-12);
        }

        #[test]
        fn straight_strokes_leave_tiles_as_they_lie(measured in patterns(), is_torus: bool) {
            let period = is_torus.then(|| Period::new(Length::mm(10.0), Length::mm(10.0)));
            let found = measure(&Measured { period, ..measured });
            prop_assert!((found.e_contrast_tangent.unwrap() - found.e_contrast).abs() < 1e-12);
        }

        #[test]
        fn a_twentieth_of_the_links_has_less_contrast(measured in patterns()) {
            let mut all: Vec<f64> = measured.graph.edges().map(|edge| measured.contrast(edge)).collect();
            all.sort_by(f64::total_cmp);
            let place = 0.05 * (all.len() - 1) as f64;
            let (low, high) = (all[place.floor() as usize], all[place.ceil() as usize]);
            let found = measure(&measured);
            prop_assert!((found.p5_contrast.unwrap() - (low + (high - low) * place.fract())).abs() < 1e-12);
            prop_assert_eq!(found.min_contrast, Some(all[0]));
        }

        #[test]
        fn one_layer_is_seen_as_it_lies_and_more_come_nearer(measured in patterns(), layers in 1u8..=4) {
            let with = |layers| vec![Layers::new(layers, 0.0); measured.sites.len()];
            let one = measure(&Measured { layers: with(1), ..measured.clone() });
            prop_assert!((one.e_contrast_layers.unwrap() - one.e_contrast).abs() < 1e-12);
            prop_assert!((one.p5_contrast_layers.unwrap() - one.p5_contrast.unwrap()).abs() < 1e-12);
            let more = measure(&Measured { layers: with(layers), ..measured.clone() });
            prop_assert!(more.e_contrast_layers.unwrap() <= one.e_contrast + 1e-12);
        }
    }

    fn three(angles: [f64; 3]) -> Measured {
        pattern(vec![Point::new(1.0, 1.0), Point::new(3.0, 1.0), Point::new(1.0, 3.0)], &angles)
    }

    #[test]
    fn a_triangle_s_rim_is_free() {
        // Its three directions are as far apart as can be; of links at the rim the bound allows more.
        let found = measure(&three([0.0, 60.0, 120.0]));
        assert!((found.e_contrast - 2.0 / 3.0).abs() < 1e-12);
        assert!((found.e_bound.unwrap() - 5.0 / 6.0).abs() < 1e-12);
        assert!((found.e_share.unwrap() - 0.8).abs() < 1e-12);
        assert!((found.min_contrast.unwrap() - 2.0 / 3.0).abs() < 1e-12);
    }

    #[test]
    fn layers_and_k_weigh_links() {
        let measured = three([0.0, 90.0, 45.0]);
        let layers = vec![Layers::new(2, 0.0), Layers::new(1, 0.0), Layers::new(0, 0.0)];
        // A tile without layers is no one's neighbour; the others share a direction.
        let found = measure(&Measured { layers, k: vec![2.0, 1.0, 0.0], ..measured.clone() });
        assert_eq!((found.e_contrast_layers, found.p5_contrast_layers), (Some(0.0), Some(0.0)));
        let weighted = (1.5 * 1.0 + 1.0 * 0.5 + 0.5 * 0.5) / 3.0;
        assert!((found.e_contrast_k.unwrap() - weighted).abs() < 1e-12);
        let blank = measure(&Measured { layers: vec![Layers::new(0, 0.0); 3], k: vec![0.0; 3], ..measured });
        assert_eq!((blank.e_contrast_layers, blank.p5_contrast_layers, blank.e_contrast_k), (None, None, None));
    }

    #[test]
    fn ends_that_face_each_other_meet() {
        let mut measured = pattern(vec![Point::new(1.0, 1.0), Point::new(3.0, 1.0)], &[0.0, 0.0]);
        let [back, forth] = [30.0, 60.0].map(Angle::degrees);
        measured.runs = [[Angle::ZERO, forth], [back, Angle::ZERO]].map(Run::Strand).to_vec();
        assert!((measure(&measured).e_contrast_tangent.unwrap() - 1.0 / 3.0).abs() < 1e-12);
        // Side by side both ends face the neighbour, and the nearest directions count.
        measured.sites = vec![Point::new(1.0, 1.0), Point::new(1.0, 3.0)];
        assert_eq!(measure(&measured).e_contrast_tangent, Some(0.0));
    }

    #[test]
    fn what_cannot_be_said_is_not_said() {
        let none = measure(&Measured { is_triangulated: true, ..Measured::nothing(Graph::new(0, &[], Vec::new())) });
        let one = measure(&pattern(vec![Point::new(1.0, 1.0)], &[0.0]));
        for found in [none, one] {
            assert_eq!(found.e_contrast, 0.0);
            assert!(found.scalars().iter().skip(1).all(|(_, value)| value.is_none()), "{found:?}");
        }
        let untold = Measured { runs: Vec::new(), is_triangulated: false, ..three([0.0, 60.0, 120.0]) };
        let found = measure(&untold);
        assert_eq!((found.e_bound, found.e_contrast_k, found.e_contrast_layers), (None, None, None));
        assert_eq!(found.e_contrast_tangent, None);
        assert!(found.p5_contrast.is_some());
    }
}
