//! Content of a page: pieces of a layer go in, the operators that draw them come out as text, in millimetres.
//!
//! Large pieces become streams of their own, made and compressed by several threads: a page's content is the row of
//! them. How it is cut depends on the drawing alone.

use std::io::{self, Write};

use flate2::Compression;
use flate2::write::ZlibEncoder;

use crate::back::number;
use crate::back::pieces::{self, Group, Marks, Piece, Style};
use crate::back::taper::{Edge, Ring, outline};
use crate::drawing::Layer;
use crate::geom::bezier::cubics;
use crate::geom::{Cubic, Point, ring_area};
use crate::scene::{Cap, Colour};

/// Marks of so many points are made and compressed by several threads.
const LONG: usize = 1 << 14;

/// Bytes as a compressed stream.
///
/// # Errors
/// None that writing to memory has.
fn compressed(text: &[u8]) -> io::Result<Vec<u8>> {
    let mut encoder = ZlibEncoder::new(Vec::with_capacity(text.len() / 3), Compression::new(4));
    encoder.write_all(text)?;
    encoder.finish()
}

/// Whether content may be cut.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Cut {
    /// Into any number of streams: a page.
    Anywhere,
    /// It is one stream: a form.
    Nowhere,
}

/// Content as a row of compressed streams.
pub(super) struct Streams {
    cut: Cut,
    done: Vec<Vec<u8>>,
    text: Vec<u8>,
}

impl Streams {
    /// Without content as yet.
    pub(super) fn new(cut: Cut) -> Self {
        Self { cut, done: Vec::new(), text: Vec::new() }
    }

    /// Adds operators.
    pub(super) fn push(&mut self, text: &str) {
        self.text.extend_from_slice(text.as_bytes());
    }

    /// Adds all marks of a layer in its ink.
    pub(super) fn layer(&mut self, layer: &Layer, together: usize) -> io::Result<()> {
        for Group { style, pieces } in pieces::groups(layer, together) {
            match style {
                Style::Areas | Style::Tapers => {}
                Style::Stroke(pen, cap) => {
                    let cap = match cap {
                        Cap::Butt => 0,
                        Cap::Round => 1,
                    };
                    // A pen of no width would draw as fine as the device can.
                    let width = number::units_text(number::units(pen.to_mm()).max(1));
                    self.push(&format!("{width} w {cap} J\n"));
                }
            }
            let text = |pieces: &[Piece<'_>]| {
                let mut text = Vec::with_capacity(pieces.iter().map(Piece::points).sum::<usize>() * 20);
                write_pieces(pieces, style, &mut text);
                text
            };
            match self.cut {
                Cut::Anywhere if pieces.iter().map(Piece::points).sum::<usize>() >= LONG => {
                    self.end_stream()?;
                    pieces::for_each_portion(
                        &pieces,
                        |pieces| compressed(&text(pieces)),
                        |stream| {
                            self.done.push(stream?);
                            Ok(())
                        },
                    )?;
                }
                Cut::Anywhere => {
                    self.text.extend(text(&pieces));
                    if self.text.len() >= 64 * LONG {
                        self.end_stream()?;
                    }
                }
                Cut::Nowhere => pieces::for_each_portion(&pieces, text, |text| {
                    self.text.extend(text);
                    Ok(())
                })?,
            }
        }
        Ok(())
    }

    fn end_stream(&mut self) -> io::Result<()> {
        if !self.text.is_empty() {
            self.done.push(compressed(&self.text)?);
            self.text.clear();
        }
        Ok(())
    }

    /// The streams; at most one where it may not be cut.
    pub(super) fn finish(mut self) -> io::Result<Vec<Vec<u8>>> {
        self.end_stream()?;
        Ok(self.done)
    }
}

/// Sets the colour that a layer strokes and fills with.
pub(super) fn set_ink(ink: Colour) -> String {
    // Greys stay grey, so that black prints with black ink alone.
    let share = |value: u8| number::text(f64::from(value) / 255.0);
    if ink.is_grey() {
        let grey = share(ink.r);
        return format!("{grey} G {grey} g\n");
    }
    let [r, g, b] = [ink.r, ink.g, ink.b].map(share);
    format!("{r} {g} {b} RG {r} {g} {b} rg\n")
}

/// Writes pieces, each with the operator that paints it: strokes look the same whether they share a path or not.
fn write_pieces(pieces: &[Piece<'_>], style: Style, text: &mut Vec<u8>) {
    for piece in pieces {
        let mut paint: &[u8] = match style {
            Style::Areas => b"f*\n",
            Style::Tapers => b"f\n",
            Style::Stroke(..) => b"S\n",
        };
        match piece.marks {
            Marks::Lines(lines) => lines.iter().for_each(|[a, b]| write_points([*a, *b], text)),
            Marks::Polylines(lines) => lines.iter().for_each(|line| write_polyline(line, text)),
            Marks::Curves(curves, from, to) => (from..to).for_each(|i| write_curve(curves.chain(i), text)),
            Marks::Tapers(tapers, from, to) => {
                let strokes = (from..to).filter_map(|i| tapers.stroke(i));
                strokes.flat_map(|(spine, widths)| outline(spine, widths)).for_each(|ring| write_ring(&ring, text));
            }
            Marks::Dots(centres) => centres.iter().for_each(|&centre| write_points([centre, centre], text)),
            Marks::Area(rings) => rings.iter().for_each(|ring| write_closed(ring.iter().copied(), text)),
            Marks::Rings(areas) => {
                // Rings of several areas keep their inside where they overlap: they run the same way round.
                paint = b"f\n";
                areas.iter().flatten().for_each(|ring| {
                    if ring_area(ring) < 0.0 {
                        write_closed(ring.iter().rev().copied(), text);
                    } else {
                        write_closed(ring.iter().copied(), text);
                    }
                });
            }
        }
        text.extend_from_slice(paint);
    }
}

/// Writes the numbers of points and an operator.
fn write_operator<const N: usize>(points: [Point; N], operator: u8, text: &mut Vec<u8>) {
    for p in points {
        for mm in [p.x, p.y] {
            let mut number = [0; number::LONGEST];
            let length = number::put(number::units(mm), &mut number);
            text.extend_from_slice(&number[..length]);
            text.push(b' ');
        }
    }
    text.extend_from_slice(&[operator, b'\n']);
}

fn write_points(points: impl IntoIterator<Item = Point>, text: &mut Vec<u8>) {
    for (i, p) in points.into_iter().enumerate() {
        write_operator([p], if i == 0 { b'm' } else { b'l' }, text);
    }
}

fn write_polyline(points: &[Point], text: &mut Vec<u8>) {
    match points {
        [first, open @ .., last] if open.len() > 1 && first == last => {
            write_closed(points[..points.len() - 1].iter().copied(), text);
        }
        points => write_points(points.iter().copied(), text),
    }
}

fn write_closed(points: impl Iterator<Item = Point>, text: &mut Vec<u8>) {
    let before = text.len();
    write_points(points, text);
    if text.len() > before {
        text.extend_from_slice(b"h\n");
    }
}

fn write_curve(chain: &[Point], text: &mut Vec<u8>) {
    let (Some(first), Some(last)) = (chain.first(), chain.last()) else { return };
    write_operator([*first], b'm', text);
    for Cubic([_, b, c, d]) in cubics(chain) {
        write_operator([b, c, d], b'c', text);
    }
    if first == last {
        text.extend_from_slice(b"h\n");
    }
}

fn write_ring(ring: &Ring, text: &mut Vec<u8>) {
    write_operator([ring.start], b'm', text);
    for &edge in &ring.edges {
        match edge {
            Edge::Line(p) => write_operator([p], b'l', text),
            Edge::Curve(b, c, d) => write_operator([b, c, d], b'c', text),
        }
    }
    text.extend_from_slice(b"h\n");
}
