//! Back ends: a finished [`Drawing`](crate::drawing::Drawing) goes in, the bytes of a picture come out.
//!
//! They decide nothing about the picture: marks are already cut, placed and inked. The same drawing gives the same
//! bytes whatever the number of threads, the locale and the time; SVG text is the same on every machine.

pub mod contact;
mod inking;
pub mod json;
pub mod metadata;
mod number;
mod outline;
mod path;
pub mod pdf;
mod pieces;
pub mod plot;
pub mod png;
pub mod raster;
pub mod svg;
mod taper;

/// Drawings that several tests use.
#[cfg(test)]
pub(crate) mod samples {
    use crate::drawing::{Dots, Drawing, Layer, Page, Strokes};
    use crate::geom::{Length, Point};
    use crate::random::Key;
    use crate::scene::{Cap, Colour, Depth};

    /// A page of so many millimetres at ten pixels each.
    pub(crate) fn page(width: f64, height: f64) -> Page {
        Page {
            width: Length::mm(width),
            height: Length::mm(height),
            bleed: Length::ZERO,
            pixels: [(width * 10.0) as u32, (height * 10.0) as u32],
            dpi: 254.0,
            paper: Some(Colour::WHITE),
            depth: Depth::Eight,
        }
    }

    pub(crate) fn layer(name: &str, ink: Colour) -> Layer {
        Layer::new(Vec::new(), name.to_owned(), ink)
    }

    pub(crate) fn lines(pen: f64, cap: Cap, bundles: &[&[[(f64, f64); 2]]]) -> Strokes {
        let mut strokes = Strokes::new(Length::mm(pen), cap);
        for bundle in bundles {
            strokes.lines.extend(bundle.iter().map(|line| line.map(|(x, y)| Point::new(x, y))));
            strokes.bundle_ends.push(strokes.lines.len());
        }
        strokes
    }

    pub(crate) fn ring(points: &[(f64, f64)]) -> Vec<Point> {
        points.iter().map(|&(x, y)| Point::new(x, y)).collect()
    }

    /// Every kind of mark, scattered over a page in bundles of ten.
    pub(crate) fn scattered(width: f64, height: f64, bundles: usize) -> Drawing {
        let mut random = Key { seed: 1, name: "scattered", purpose: "test" }.stream();
        let mut black = layer("black", Colour::BLACK);
        let mut red = layer("red", Colour { r: 200, g: 30, b: 40, a: 255 });
        let mut strokes = [Strokes::new(Length::mm(0.2), Cap::Butt), Strokes::new(Length::mm(0.35), Cap::Round)];
        let mut dots = Dots::new(Length::mm(0.3));
        for i in 0..bundles {
            let centre = Point::new(random.unit() * width, random.unit() * height);
            let mut near = || centre + crate::geom::Vec2::new(random.unit() * 6.0 - 3.0, random.unit() * 6.0 - 3.0);
            match i % 7 {
                0 | 1 => {
                    let strokes = &mut strokes[i % 7];
                    strokes.lines.extend((0..10).map(|_| [near(), near()]));
                    strokes.bundle_ends.push(strokes.lines.len());
                }
                2 => {
                    dots.centres.extend((0..10).map(|_| near()));
                    dots.bundle_ends.push(dots.centres.len());
                }
                3 => strokes[1].polylines.push((0..10).map(|_| near()).collect()),
                4 => red.areas.push(vec![(0..5).map(|_| near()).collect()]),
                5 => {
                    let curves = &mut strokes[i / 7 % 2].curves;
                    for _ in 0..10 {
                        curves.push(&[near(), near(), near(), near(), near(), near(), near()]);
                    }
                    curves.end_bundle();
                }
                _ => {
                    for _ in 0..10 {
                        red.tapers.push(&[near(), near(), near(), near(), near(), near(), near()], &[0.3, 0.5, 0.0]);
                    }
                    red.tapers.spines.end_bundle();
                }
            }
        }
        black.strokes.extend(strokes);
        black.dots.push(dots);
        Drawing { page: page(width, height), layers: vec![black, red] }
    }

    /// What a function gives on pools of one and of four threads.
    pub(crate) fn on_threads<T: Send>(make: impl Fn() -> T + Sync) -> [T; 2] {
        [1, 4].map(|threads| {
            rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .map(|pool| pool.install(&make))
                .unwrap_or_else(|_| make())
        })
    }
}
