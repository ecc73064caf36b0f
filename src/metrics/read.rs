//! Patterns as `kake ir --stage tiles` prints them, or another program does.
//!
//! In: JSON text, `{"paints":[{"sites":[[x,y]…],"edges":[[i,j]…],"angles":[…],…}…]}`, in millimetres and radians. Out: what
//! is measured. Sites, links and angles there must be; of the rest what is missing is not measured. Nothing in it is
//! trusted: indices, lengths of lists and numbers are looked at before anything is done with them.

use std::fmt;

use serde::Deserialize;

use super::Measured;
use super::contrast::triangles_of;
use crate::geom::{Angle, Length, Period, Point, Rect, ring_bounds};
use crate::region::{FillRule, Region};
use crate::stage::{Graph, Layers};

/// The greatest k, and the most layers.
const MOST_LAYERS: f64 = 4.0;

/// No page is a hundred kilometres wide: coordinates in millimetres lie within this.
const FARTHEST: f64 = 1e8;

/// Tiles and regions of a page that repeats are at most so many periods wide: more would overlap themselves for no end.
const MOST_PERIODS: f64 = 4.0;

/// One side of a page that repeats is at most so many times as long as the other.
const MOST_OBLONG: f64 = 100.0;

/// What is wrong with a pattern, in words.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BadPattern(String);

impl fmt::Display for BadPattern {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for BadPattern {}

#[derive(Deserialize)]
struct File {
    paints: Vec<Pattern>,
}

/// A paint. Names that are not known say nothing about it.
#[derive(Deserialize)]
struct Pattern {
    paint: Option<String>,
    bounds: Option<[f64; 4]>,
    /// The region's rings, where it is more than a box.
    region: Option<Vec<Vec<[f64; 2]>>>,
    /// Width and height of a page that repeats.
    period: Option<[f64; 2]>,
    sites: Vec<[f64; 2]>,
    edges: Vec<[u64; 2]>,
    triangles: Option<Vec<[u64; 3]>>,
    angles: Vec<f64>,
    k: Option<Vec<f64>>,
    /// The layers that are drawn, where they are not the nearest to k.
    layers: Option<Vec<u8>>,
    /// The rings of each tile.
    tiles: Option<Vec<Vec<Vec<[f64; 2]>>>>,
}

/// Reads patterns, of at most so many tiles each.
///
/// # Errors
/// Where the text is no JSON of this form, or a pattern contradicts itself.
pub fn read(text: &[u8], most_tiles: u64) -> Result<Vec<Measured>, BadPattern> {
    let file: File = serde_json::from_slice(text).map_err(|error| BadPattern(plain(&error)))?;
    let patterns = file.paints.into_iter().enumerate();
    patterns
        .map(|(i, pattern)| {
            let name = pattern.paint.clone().unwrap_or_else(|| format!("paint {}", i + 1));
            measured(name.clone(), pattern, most_tiles).map_err(|words| BadPattern(format!("`{name}`: {words}")))
        })
        .collect()
}

/// What the reader of JSON says, for people.
fn plain(error: &serde_json::Error) -> String {
    match error.classify() {
        serde_json::error::Category::Data => format!("this is not what `kake ir --stage tiles` prints: {error}"),
        serde_json::error::Category::Syntax | serde_json::error::Category::Eof | serde_json::error::Category::Io => {
            format!("this is no JSON: {error}")
        }
    }
}

fn measured(name: String, pattern: Pattern, most_tiles: u64) -> Result<Measured, String> {
    let tiles = pattern.sites.len();
    if tiles as u64 > most_tiles {
        return Err(format!("it has {tiles} tiles, and the limit is {most_tiles}; `--limit tiles={tiles}` lifts it"));
    }
    let counts = [
        ("angles", Some(pattern.angles.len())),
        ("k", pattern.k.as_ref().map(Vec::len)),
        ("layers", pattern.layers.as_ref().map(Vec::len)),
        ("tiles", pattern.tiles.as_ref().map(Vec::len)),
    ];
    for (list, count) in counts {
        if let Some(count) = count.filter(|&count| count != tiles) {
            return Err(format!("`{list}` has {count} entries for {tiles} sites"));
        }
    }
    let index = |list: &str, index: u64| match u32::try_from(index) {
        Ok(number) if (number as usize) < tiles => Ok(number),
        _ => Err(format!("`{list}` names site {index}, and there are {tiles}, counted from 0")),
    };
    let mut edges = Vec::with_capacity(pattern.edges.len());
    for &[a, b] in &pattern.edges {
        if a == b {
            return Err(format!("`edges` links site {a} to itself"));
        }
        edges.push([index("edges", a.min(b))?, index("edges", a.max(b))?]);
    }
    // Whether links are listed once or from both ends, they are the same.
    edges.sort_unstable();
    edges.dedup();
    let mut triangles = Vec::new();
    for &[a, b, c] in pattern.triangles.iter().flatten() {
        if a == b || b == c || c == a {
            return Err(format!("`triangles` has a triangle with site {a} and {c} twice"));
        }
        triangles.push([index("triangles", a)?, index("triangles", b)?, index("triangles", c)?]);
    }
    let points = |list: &str, points: &[[f64; 2]]| -> Result<Vec<Point>, String> {
        points.iter().map(|&[x, y]| Ok(Point::new(coordinate(list, x)?, coordinate(list, y)?))).collect()
    };
    let sites = points("sites", &pattern.sites)?;
    let angles = pattern.angles.iter().map(|&angle| Ok(Angle::radians(finite("angles", angle)?).direction()));
    let angles = angles.collect::<Result<Vec<Angle>, String>>()?;
    let outlines = pattern.tiles.iter().flatten().map(|rings| {
        let rings = rings.iter().map(|ring| points("tiles", ring)).collect::<Result<Vec<_>, _>>()?;
        Ok(joined(&rings))
    });
    let outlines = outlines.collect::<Result<Vec<Vec<Point>>, String>>()?;
    let k = pattern.k.unwrap_or_default();
    if let Some(k) = k.iter().find(|k| !(0.0..=MOST_LAYERS).contains(*k)) {
        return Err(format!("`k` is {k}, and goes from 0 to {MOST_LAYERS}"));
    }
    let layers = match pattern.layers {
        Some(layers) => layers,
        None => k.iter().map(|k| (k + 0.5).floor() as u8).collect(),
    };
    if let Some(layers) = layers.iter().find(|&&layers| f64::from(layers) > MOST_LAYERS) {
        return Err(format!("`layers` is {layers}, and goes from 0 to {MOST_LAYERS}"));
    }
    let region = region(pattern.bounds, pattern.region.as_deref(), points)?;
    let period = pattern.period.map(|size| period(size, &region, &outlines)).transpose()?;
    let sites = match period {
        Some(period) => sites.into_iter().map(|site| period.wrapped(site)).collect(),
        None => sites,
    };
    let graph = Graph::new(tiles, &edges, triangles);
    Ok(Measured {
        name,
        is_triangulated: period.is_none() && is_triangulation(&graph),
        region,
        sites,
        angles,
        k,
        layers: layers.into_iter().map(|layers| Layers::new(layers, 0.0)).collect(),
        outlines,
        period,
        ..Measured::nothing(graph)
    })
}

fn finite(list: &str, value: f64) -> Result<f64, String> {
    if value.is_finite() { Ok(value) } else { Err(format!("`{list}` holds {value}, which is no number to measure by")) }
}

/// A coordinate in millimetres that may lie on a page.
fn coordinate(list: &str, value: f64) -> Result<f64, String> {
    if finite(list, value)?.abs() <= FARTHEST {
        Ok(value)
    } else {
        Err(format!("`{list}` holds {value} mm, which is on no page"))
    }
}

/// Whether sides of triangles are links, and no link is a side of more than two: what is said of triangulations then holds.
fn is_triangulation(graph: &Graph) -> bool {
    let of = triangles_of(graph);
    let sides: usize = of.iter().map(|&triangles| triangles as usize).sum();
    !graph.triangles.is_empty() && sides == 3 * graph.triangles.len() && of.iter().all(|&triangles| triangles <= 2)
}

/// Several rings as one, which runs from the first to each of the others and back: by the even-odd rule it holds the same.
fn joined(rings: &[Vec<Point>]) -> Vec<Point> {
    let rings: Vec<&Vec<Point>> = rings.iter().filter(|ring| !ring.is_empty()).collect();
    if let [ring] = rings[..] {
        return ring.clone();
    }
    let starts = rings.iter().rev().skip(1).map(|ring| ring[0]);
    rings.iter().flat_map(|ring| ring.iter().copied().chain([ring[0]])).chain(starts).collect()
}

/// The region: its rings, or else the box of its bounds; empty where nothing is known.
fn region(
    bounds: Option<[f64; 4]>,
    rings: Option<&[Vec<[f64; 2]>]>,
    points: impl Fn(&str, &[[f64; 2]]) -> Result<Vec<Point>, String>,
) -> Result<Region, String> {
    if let Some(rings) = rings {
        let rings = rings.iter().map(|ring| points("region", ring)).collect::<Result<Vec<_>, _>>()?;
        return Region::try_from_rings(rings, FillRule::NonZero)
            .map_err(|_| "`region` crosses itself too often".to_owned());
    }
    let Some([x0, y0, x1, y1]) = bounds else { return Ok(Region::empty()) };
    let corners = points("bounds", &[[x0, y0], [x1, y1]])?;
    if x0 > x1 || y0 > y1 {
        return Err("`bounds` are [x0, y0, x1, y1], the upper left corner first".to_owned());
    }
    Ok(Region::rect(Rect::new(corners[0], corners[1])))
}

/// The period of a page that repeats, if it bears what lies on it.
fn period([width, height]: [f64; 2], region: &Region, outlines: &[Vec<Point>]) -> Result<Period, String> {
    let (least, most) = (width.min(height), width.max(height));
    if !(least > 0.0 && most.is_finite() && most <= MOST_OBLONG * least) {
        return Err("`period` is no width and height of a page".to_owned());
    }
    let fits = |extent: Rect| extent.width() <= MOST_PERIODS * width && extent.height() <= MOST_PERIODS * height;
    let is_empty = |extent: &Rect| extent.min.x > extent.max.x;
    let extents = outlines.iter().map(|outline| ring_bounds(outline)).chain([region.bounds()]);
    if !extents.filter(|extent| !is_empty(extent)).all(fits) {
        return Err(format!("`period`: tiles and region are at most {MOST_PERIODS} periods wide and high"));
    }
    Ok(Period::new(Length::mm(width), Length::mm(height)))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::metrics::Measures;

    fn words(text: &str) -> String {
        read(text.as_bytes(), 4).unwrap_err().to_string()
    }

    const TWO: &str = r#""sites":[[1,1],[3,1]],"edges":[[0,1],[1,0]],"angles":[0,-1.5707963267948966]"#;

    #[test]
    fn the_least_that_is_said_is_measured() {
        let text = format!(r#"{{"paints":[{{{TWO}}}]}}"#);
        let measures = Measures::new(&read(text.as_bytes(), 4).unwrap()[0]);
        assert_eq!((measures.tiles, measures.edges), (2, 1));
        assert!((measures.contrast.e_contrast - 1.0).abs() < 1e-12);
        assert_eq!((measures.contrast.e_bound, measures.contrast.e_contrast_layers), (None, None));
        assert_eq!((measures.space.c_cov, measures.space.u_vor), (None, None));
    }

    #[test]
    fn all_that_is_said_is_measured() {
        let text = r#"{"paints":[{"paint":"a","bounds":[0,0,4,4],"sites":[[1,1],[3,1],[1,3]],
            "edges":[[0,1],[1,2],[0,2]],"triangles":[[0,1,2]],"angles":[0,1,2],"k":[1,1.5,4],
            "tiles":[[[[0,0],[2,0],[2,2],[0,2]],[[0.5,0.5],[1.5,0.5],[1.5,1.5],[0.5,1.5]]],[],[]]}]}"#;
        let measured = &read(text.as_bytes(), 4).unwrap()[0];
        assert_eq!(measured.layers.iter().map(|layers| layers.full).collect::<Vec<_>>(), [1, 2, 4]);
        let measures = Measures::new(measured);
        // A ring in a ring is a hole: of 100 by 100 centres those in the middle are not covered.
        assert_eq!(measures.space.c_cov, Some(7_500.0 / 40_000.0));
        assert!((measures.contrast.e_bound.unwrap() - 5.0 / 6.0).abs() < 1e-12);
    }

    #[test]
    fn what_contradicts_itself_is_refused() {
        assert!(words("{").contains("no JSON"));
        assert!(words(r#"{"paints":[{"sites":[]}]}"#).contains("missing field `edges`"));
        assert!(words(r#"{"paints":[{"sites":[[1e999,0]],"edges":[],"angles":[0]}]}"#).contains("number out of range"));
        assert!(words(r#"{"paints":[{"sites":[[0,0]],"edges":[],"angles":[]}]}"#).contains("0 entries for 1 sites"));
        let with = |rest: &str| words(&format!(r#"{{"paints":[{{"paint":"a",{TWO},{rest}}}]}}"#));
        assert_eq!(with(r#""triangles":[[0,1,2]]"#), "`a`: `triangles` names site 2, and there are 2, counted from 0");
        assert!(with(r#""triangles":[[0,1,0]]"#).contains("twice"));
        assert!(with(r#""k":[1,5]"#).contains("from 0 to 4"));
        assert!(with(r#""bounds":[1,1,0,0]"#).contains("upper left"));
        assert!(with(r#""period":[0,1]"#).contains("`period`"));
        assert!(with(r#""period":[1,1],"bounds":[0,0,9,9]"#).contains("4 periods"));
        assert!(with(r#""bounds":[0,0,1e9,1]"#).contains("on no page"));
        let edges = |edges: &str| words(&format!(r#"{{"paints":[{{"sites":[[0,0]],"edges":{edges},"angles":[0]}}]}}"#));
        assert!(edges("[[0,0]]").contains("to itself"));
        assert!(edges("[[0,9]]").contains("names site 9"));
        let many = r#"{"paints":[{"sites":[[0,0],[0,0],[0,0],[0,0],[0,0]],"edges":[],"angles":[]}]}"#;
        assert!(words(many).contains("--limit tiles=5"));
    }
}
