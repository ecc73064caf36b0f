//! SVG: a drawing goes in, a page in millimetres comes out, as a plotter and an editor want it.
//!
//! Groups and paints become Inkscape layers, and within them one group holds all marks of one pen. Strokes are strokes
//! and end where they end: there are no clip paths, masks or white covers. Strokes that run out are filled outlines. Each tile
//! is one path; where there are very many several tiles share one, for there are readers that refuse a million elements.
//! Text is made by several threads in pieces that do not depend on their number.

use std::io::{self, Write};

use svg::node::Text as Characters;
use svg::node::element::{self, Element, Pattern, Rectangle, SVG};

use super::metadata::{ELEMENT, Metadata, NAMESPACE};
use super::number;
use super::path::{write_curve, write_line, write_outline, write_polyline, write_ring};
use super::pieces::{self, Group, Marks, Piece, Style};
use super::taper::outline;
use crate::drawing::{Drawing, Layer};
use crate::geom::{Length, ring_area};
use crate::scene::{Cap, Colour};
use crate::sheet::{Anchor, Sheet, Text};

/// Writes an SVG.
///
/// # Errors
/// What `out` answers.
pub fn write(drawing: &Drawing, metadata: Option<&Metadata>, out: &mut dyn Write) -> io::Result<()> {
    write_head(drawing, 1.0, metadata, out)?;
    write_page(drawing, "", out)?;
    out.write_all(b"</svg>\n")?;
    out.flush()
}

/// Writes a contact sheet with its pictures, one for each place: those that are missing stay white. What is written on it
/// is text.
///
/// # Errors
/// What `out` answers.
pub fn write_sheet(sheet: &Sheet, pictures: &[Option<Drawing>], out: &mut dyn Write) -> io::Result<()> {
    let page = Drawing { page: sheet.page.clone(), layers: vec![sheet.frame_layer()] };
    write_head(&page, 1.0, None, out)?;
    write_paper(&page, "", out)?;
    for (i, (place, picture)) in sheet.places.iter().zip(pictures).enumerate() {
        let Some(picture) = picture else { continue };
        let ([width, height], area) = ([picture.page.width, picture.page.height].map(Length::to_mm), &place.area);
        // A picture within another shows no more than its own page.
        let inner = SVG::new()
            .set("x", number::text(area.min.x))
            .set("y", number::text(area.min.y))
            .set("width", number::text(area.width()))
            .set("height", number::text(area.height()))
            .set("viewBox", format!("0 0 {} {}", number::text(width), number::text(height)));
        writeln!(out, "{}", open_tag(&inner).replace(SVG_NAMESPACE, ""))?;
        writeln!(out, "{}", on_a_line(&element::Title::new(xml_text(&place.name))))?;
        write_page(picture, &format!("p{}-", i + 1), out)?;
        out.write_all(b"</svg>\n")?;
    }
    for layer in &page.layers {
        write_layer(layer, 1, out)?;
    }
    let fonts = element::Group::new().set("font-family", FONTS);
    writeln!(out, "{}", open_tag(&fonts))?;
    for Text { text, at, anchor, size, ink } in &sheet.texts {
        let mut line = element::Text::new(xml_text(text))
            .set("x", number::text(at.x))
            .set("y", number::text(at.y))
            .set("font-size", number::text(size.to_mm()))
            .set("fill", ink.hex());
        match anchor {
            Anchor::Start => {}
            Anchor::Middle => line = line.set("text-anchor", "middle"),
        }
        writeln!(out, "{}", on_a_line(&line))?;
    }
    close(1, out)?;
    out.write_all(b"</svg>\n")?;
    out.flush()
}

/// An element with its text on one line: white space in a text may be drawn.
fn on_a_line(element: &Element) -> String {
    element.to_string().replace('\n', "")
}

/// The name space that every root element is given, and needs only once in a file.
const SVG_NAMESPACE: &str = " xmlns=\"http://www.w3.org/2000/svg\"";

/// The fonts that captions ask for.
const FONTS: &str = "Ubuntu, Helvetica, Arial, 'Noto Sans', 'Noto Sans CJK JP', sans-serif";

/// How often a swatch shows its pattern each way.
const SHOWN: f64 = 2.0;

/// Writes an SVG that holds the drawing as a `<pattern>`, and shows it on a rectangle of two periods each way. The page
/// is one period. `id` names the pattern; characters that an id cannot have become `-`.
///
/// # Errors
/// What `out` answers.
pub fn write_pattern(drawing: &Drawing, id: &str, metadata: Option<&Metadata>, out: &mut dyn Write) -> io::Result<()> {
    write_head(drawing, SHOWN, metadata, out)?;
    let id = pattern_id(id);
    let page = &drawing.page;
    let pattern = Pattern::new()
        .set("id", id.as_str())
        .set("patternUnits", "userSpaceOnUse")
        .set("width", number::text(page.width.to_mm()))
        .set("height", number::text(page.height.to_mm()));
    writeln!(out, "<defs>\n{}", open_tag(&pattern))?;
    write_page(drawing, "", out)?;
    out.write_all(b"</pattern>\n</defs>\n")?;
    let shown = Rectangle::new()
        .set("width", number::text(page.width.to_mm() * SHOWN))
        .set("height", number::text(page.height.to_mm() * SHOWN))
        .set("fill", format!("url(#{id})"));
    writeln!(out, "{shown}\n</svg>")?;
    out.flush()
}

/// A name that XML takes as an id and CSS as part of a URL.
fn pattern_id(name: &str) -> String {
    let plain: String = name.chars().map(|c| if c.is_ascii_alphanumeric() || c == '_' { c } else { '-' }).collect();
    if plain.starts_with(|c: char| c.is_ascii_alphabetic()) { plain } else { format!("kakeami-{plain}") }
}

/// The paper and all layers; their ids begin with `ids`.
fn write_page(drawing: &Drawing, ids: &str, out: &mut dyn Write) -> io::Result<()> {
    write_paper(drawing, ids, out)?;
    let together = pieces::together(drawing);
    // The groups that are open, outermost first, and whether each is a paint's: a group may have the same name.
    let mut open: Vec<(&str, bool)> = Vec::new();
    let mut named = 0;
    for layer in drawing.layers.iter().filter(|layer| layer.marks() > 0) {
        let groups = layer.groups.iter().map(|name| (name.as_str(), false));
        let names: Vec<(&str, bool)> = groups.chain([(layer.name.as_str(), true)]).collect();
        let shared = open.iter().zip(&names).take_while(|(a, b)| a == b).count();
        close(open.len() - shared, out)?;
        open.truncate(shared);
        for &(name, paint) in &names[shared..] {
            named += 1;
            let group = element::Group::new()
                .set("inkscape:groupmode", "layer")
                .set("inkscape:label", xml_text(name))
                .set("id", format!("{ids}layer{named}"));
            writeln!(out, "{}", open_tag(&group))?;
            open.push((name, paint));
        }
        // The whole layer is made translucent at once: where its strokes cross they are one ink, as in the raster.
        let translucent = layer.ink.a < 255;
        if translucent {
            writeln!(out, "{}", open_tag(&element::Group::new().set("opacity", opacity(layer.ink))))?;
        }
        write_layer(layer, together, out)?;
        close(usize::from(translucent), out)?;
    }
    close(open.len(), out)
}

/// The root's start and the metadata; the page is shown so often each way.
fn write_head(drawing: &Drawing, shown: f64, metadata: Option<&Metadata>, out: &mut dyn Write) -> io::Result<()> {
    let page = &drawing.page;
    let (width, height) = (number::text(page.width.to_mm() * shown), number::text(page.height.to_mm() * shown));
    let root = SVG::new()
        .set("xmlns:inkscape", "http://www.inkscape.org/namespaces/inkscape")
        .set("width", format!("{width}mm"))
        .set("height", format!("{height}mm"))
        .set("viewBox", format!("0 0 {width} {height}"));
    writeln!(out, "{}", open_tag(&root))?;
    if let Some(metadata) = metadata {
        let name = format!("kakeami:{ELEMENT}");
        let mut picture = Element::new(name);
        svg::Node::assign(&mut picture, "xmlns:kakeami", NAMESPACE);
        svg::Node::append(&mut picture, Characters::new(metadata.to_json()?));
        writeln!(out, "<metadata>{picture}</metadata>")?;
    }
    Ok(())
}

fn write_paper(drawing: &Drawing, ids: &str, out: &mut dyn Write) -> io::Result<()> {
    let page = &drawing.page;
    if let Some(paper) = page.paper {
        let (width, height) = (number::text(page.width.to_mm()), number::text(page.height.to_mm()));
        let mut rect = Rectangle::new()
            .set("id", format!("{ids}paper"))
            .set("width", width)
            .set("height", height)
            .set("fill", paper.hex());
        if paper.a < 255 {
            rect = rect.set("fill-opacity", opacity(paper));
        }
        writeln!(out, "{rect}")?;
    }
    Ok(())
}

/// The start tag of an element without children.
fn open_tag(element: &Element) -> String {
    let mut text = element.to_string();
    if let Some(start) = text.strip_suffix("/>") {
        text = format!("{start}>");
    }
    text
}

fn close(groups: usize, out: &mut dyn Write) -> io::Result<()> {
    for _ in 0..groups {
        out.write_all(b"</g>\n")?;
    }
    Ok(())
}

/// A name without the characters that XML forbids; the writer escapes the rest.
fn xml_text(name: &str) -> String {
    name.chars()
        .map(|c| match c {
            '\t' | '\n' | '\r' => ' ',
            c if c.is_control() => char::REPLACEMENT_CHARACTER,
            '\u{fffe}' | '\u{ffff}' => char::REPLACEMENT_CHARACTER,
            c => c,
        })
        .collect()
}

/// A colour's alpha from 0 to 1.
fn opacity(colour: Colour) -> String {
    number::text(f64::from(colour.a) / 255.0)
}

fn write_layer(layer: &Layer, together: usize, out: &mut dyn Write) -> io::Result<()> {
    for Group { style, pieces } in pieces::groups(layer, together) {
        let element = match style {
            Style::Areas => element::Group::new().set("fill", layer.ink.hex()).set("fill-rule", "evenodd"),
            Style::Tapers => element::Group::new().set("fill", layer.ink.hex()),
            Style::Stroke(pen, cap) => stroke_group(layer.ink, pen, cap),
        };
        writeln!(out, "{}", open_tag(&element))?;
        pieces::for_each_portion(&pieces, pieces_text, |text| out.write_all(&text))?;
        close(1, out)?;
    }
    Ok(())
}

fn stroke_group(ink: Colour, pen: Length, cap: Cap) -> element::Group {
    // A pen that rounds to nothing would not be drawn at all.
    let width = number::units_text(number::units(pen.to_mm()).max(1));
    let cap = match cap {
        Cap::Butt => "butt",
        Cap::Round => "round",
    };
    element::Group::new()
        .set("fill", "none")
        .set("stroke", ink.hex())
        .set("stroke-width", width)
        .set("stroke-linecap", cap)
        .set("stroke-linejoin", "round")
}

fn pieces_text(pieces: &[Piece<'_>]) -> Vec<u8> {
    let mut text = Vec::with_capacity(pieces.iter().map(Piece::points).sum::<usize>() * 16 + pieces.len() * 16);
    for piece in pieces {
        if piece.starts {
            // Rings of several areas keep their inside where they overlap: they run the same way round.
            let several = matches!(piece.marks, Marks::Rings(_));
            text.extend_from_slice(if several { b"<path fill-rule=\"nonzero\" d=\"" } else { b"<path d=\"" });
        }
        match piece.marks {
            Marks::Lines(lines) => lines.iter().for_each(|line| write_line(line, &mut text)),
            Marks::Polylines(lines) => lines.iter().for_each(|line| write_polyline(line, &mut text)),
            Marks::Curves(curves, from, to) => (from..to).for_each(|i| write_curve(curves.chain(i), &mut text)),
            Marks::Tapers(tapers, from, to) => {
                let rings =
                    (from..to).filter_map(|i| tapers.stroke(i)).flat_map(|(spine, widths)| outline(spine, widths));
                rings.for_each(|ring| write_outline(&ring, &mut text));
            }
            Marks::Dots(centres) => centres.iter().for_each(|&centre| write_line(&[centre, centre], &mut text)),
            Marks::Area(rings) => rings.iter().for_each(|ring| write_ring(ring.iter().copied(), &mut text)),
            Marks::Rings(areas) => areas.iter().flatten().for_each(|ring| {
                if ring_area(ring) < 0.0 {
                    write_ring(ring.iter().rev().copied(), &mut text);
                } else {
                    write_ring(ring.iter().copied(), &mut text);
                }
            }),
        }
        if piece.ends {
            text.extend_from_slice(b"\"/>\n");
        }
    }
    text
}

#[cfg(test)]
#[allow(clippy::unwrap_used, clippy::panic)]
mod tests {
    use usvg::roxmltree;

    use super::super::samples::{layer, lines, on_threads, page, ring, scattered};
    use super::pieces::{MANY, PIECE, TOGETHER, area_pieces};
    use super::*;
    use crate::drawing::{Dots, Strokes};
    use crate::geom::Point;

    fn text_of(drawing: &Drawing, metadata: Option<&Metadata>) -> String {
        let mut out = Vec::new();
        write(drawing, metadata, &mut out).unwrap();
        String::from_utf8(out).unwrap()
    }

    fn small() -> Drawing {
        let mut sky = layer("sky", Colour::BLACK);
        sky.groups.push("back & <ground>".to_owned());
        let square = [[(1.0, 1.0), (4.0, 1.0)], [(1.0, 2.0), (1.0, 4.5)]];
        sky.strokes.push(lines(0.25, Cap::Butt, &[&square, &[[(10.0, 10.0), (7.123_44, 9.5)]]]));
        let mut ground = sky.clone();
        ground.ink = Colour { r: 255, g: 0, b: 16, a: 128 };
        ground.strokes = vec![Strokes::new(Length::mm(0.1), Cap::Round)];
        ground.strokes[0].curves.push(&ring(&[(0.0, 0.0), (1.0, 0.5), (2.0, -0.5), (3.0, 0.0)]));
        ground.tapers.push(&ring(&[(0.0, 5.0), (1.0, 5.0), (2.0, 5.0), (3.0, 5.0)]), &[0.5, 0.0]);
        ground.strokes[0].polylines = vec![ring(&[(0.0, 0.0), (1.0, 0.5), (2.0, 0.0), (0.0, 0.0)])];
        let mut dots = layer("dots", Colour::BLACK);
        dots.dots.push(Dots {
            radius: Length::mm(0.5),
            centres: ring(&[(3.0, 3.0), (4.0, 4.0)]),
            bundle_ends: vec![2],
        });
        let hole = ring(&[(5.0, 5.0), (6.0, 5.0), (6.0, 6.0)]);
        dots.areas.push(vec![ring(&[(4.0, 4.0), (8.0, 4.0), (8.0, 8.0), (4.0, 8.0)]), hole]);
        Drawing { page: page(60.0, 40.5), layers: vec![sky, ground, layer("empty", Colour::BLACK), dots] }
    }

    #[test]
    fn small_drawing() {
        insta::assert_snapshot!(text_of(&small(), None), @r##"
        <svg height="40.5mm" viewBox="0 0 60 40.5" width="60mm" xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape">
        <rect fill="#ffffff" height="40.5" id="paper" width="60"/>
        <g id="layer1" inkscape:groupmode="layer" inkscape:label="back &amp; &lt;ground&gt;">
        <g id="layer2" inkscape:groupmode="layer" inkscape:label="sky">
        <g fill="none" stroke="#000000" stroke-linecap="butt" stroke-linejoin="round" stroke-width="0.25">
        <path d="M1 1h3M1 2v2.5"/>
        <path d="M10 10l-2.8766-0.5"/>
        </g>
        <g opacity="0.502">
        <g fill="none" stroke="#ff0010" stroke-linecap="round" stroke-linejoin="round" stroke-width="0.1">
        <path d="M0 0l1 0.5l1-0.5z"/>
        <path d="M0 0c1 0.5 2-0.5 3 0"/>
        </g>
        <g fill="#ff0010">
        <path d="M0 4.75l3 0.25l-3 0.25z"/>
        </g>
        </g>
        </g>
        </g>
        <g id="layer3" inkscape:groupmode="layer" inkscape:label="dots">
        <g fill="#000000" fill-rule="evenodd">
        <path d="M4 4h4v4h-4zM5 5h1v1z"/>
        </g>
        <g fill="none" stroke="#000000" stroke-linecap="round" stroke-linejoin="round" stroke-width="1">
        <path d="M3 3h0M4 4h0"/>
        </g>
        </g>
        </svg>
        "##);
    }

    #[test]
    fn a_pattern_holds_the_page() {
        let mut out = Vec::new();
        write_pattern(&small(), "rain 2/é", None, &mut out).unwrap();
        let text = String::from_utf8(out).unwrap();
        let document = roxmltree::Document::parse(&text).unwrap();
        let find = |name: &str| document.descendants().find(|node| node.tag_name().name() == name).unwrap();
        let pattern = find("pattern");
        let attribute = |name: &str| pattern.attribute(name).unwrap();
        assert_eq!([attribute("id"), attribute("width"), attribute("height")], ["rain-2--", "60", "40.5"]);
        assert_eq!(document.root_element().attribute("viewBox"), Some("0 0 120 81"));
        let shown = document.root_element().children().find(|node| node.tag_name().name() == "rect").unwrap();
        assert_eq!(shown.attribute("fill"), Some("url(#rain-2--)"));
        // All that the page has is in it, and a reader finds it.
        let paths = pattern.descendants().filter(|node| node.tag_name().name() == "path").count();
        assert_eq!(paths, text_of(&small(), None).matches("<path").count());
        assert!(usvg::Tree::from_str(&text, &usvg::Options::default()).unwrap().patterns().len() == 1);
        assert_eq!([pattern_id("3"), pattern_id("")], ["kakeami-3", "kakeami-"]);
    }

    #[test]
    fn other_readers_understand_it() {
        let drawing = small();
        let tree = usvg::Tree::from_str(&text_of(&drawing, None), &usvg::Options::default()).unwrap();
        fn paths(group: &usvg::Group, found: &mut Vec<(f32, bool)>) {
            for node in group.children() {
                match node {
                    usvg::Node::Group(group) => paths(group, found),
                    usvg::Node::Path(path) => found.push((
                        path.stroke().map_or(0.0, |stroke| stroke.width().get()),
                        path.abs_stroke_bounding_box().width() > 0.0,
                    )),
                    _ => {}
                }
            }
        }
        let mut found = Vec::new();
        paths(tree.root(), &mut found);
        // The paper, two tiles, the closed stroke, the curve, the taper, the area and the dots.
        let wanted = [0.0, 0.25, 0.25, 0.1, 0.1, 0.0, 0.0, 1.0].map(|width| (width, true));
        assert_eq!(found, wanted);
    }

    /// What another program's reader and stroker make of a picture.
    fn drawn_by_others(text: &str, [width, height]: [u32; 2]) -> tiny_skia::Pixmap {
        fn draw(group: &usvg::Group, scale: tiny_skia::Transform, pixmap: &mut tiny_skia::Pixmap) {
            for node in group.children() {
                let path = match node {
                    usvg::Node::Group(group) => {
                        draw(group, scale, pixmap);
                        continue;
                    }
                    usvg::Node::Path(path) => path,
                    _ => panic!("neither group nor path"),
                };
                let transform = path.abs_transform().post_concat(scale);
                let paint_of = |paint: &usvg::Paint| {
                    let usvg::Paint::Color(colour) = paint else { panic!("no colour") };
                    let mut paint = tiny_skia::Paint::default();
                    paint.set_color_rgba8(colour.red, colour.green, colour.blue, 255);
                    paint
                };
                if let Some(fill) = path.fill() {
                    let rule = match fill.rule() {
                        usvg::FillRule::NonZero => tiny_skia::FillRule::Winding,
                        usvg::FillRule::EvenOdd => tiny_skia::FillRule::EvenOdd,
                    };
                    pixmap.fill_path(path.data(), &paint_of(fill.paint()), rule, transform, None);
                }
                if let Some(stroke) = path.stroke() {
                    let paint = paint_of(stroke.paint());
                    pixmap.stroke_path(path.data(), &paint, &stroke.to_tiny_skia(), transform, None);
                }
            }
        }
        let tree = usvg::Tree::from_str(text, &usvg::Options::default()).unwrap();
        let scale =
            tiny_skia::Transform::from_scale(width as f32 / tree.size().width(), height as f32 / tree.size().height());
        let mut pixmap = tiny_skia::Pixmap::new(width, height).unwrap();
        draw(tree.root(), scale, &mut pixmap);
        pixmap
    }

    #[test]
    fn other_programs_draw_what_the_raster_shows() {
        let drawing = scattered(40.0, 30.0, 60);
        let pixels = crate::back::raster::render(&drawing);
        let other = drawn_by_others(&text_of(&drawing, None), drawing.page.pixels);
        let (mut sum, mut far) = (0, 0);
        for (i, theirs) in other.pixels().iter().enumerate() {
            let ours = pixels.colour(i % pixels.width, i / pixels.width).unwrap();
            let off = ours.g.abs_diff(theirs.green());
            sum += u64::from(off);
            far += u32::from(off > 100);
        }
        // Rounding apart, and the angles at which strokers make arcs.
        assert!(far <= 5 && sum < other.pixels().len() as u64, "{far} {sum}");
    }

    #[test]
    fn paper_may_be_missing_or_translucent() {
        let mut drawing = small();
        drawing.page.paper = None;
        assert!(!text_of(&drawing, None).contains("<rect"));
        drawing.page.paper = Some(Colour { r: 1, g: 2, b: 3, a: 51 });
        let wanted = r##"<rect fill="#010203" fill-opacity="0.2" height="40.5" id="paper" width="60"/>"##;
        assert!(text_of(&drawing, None).contains(wanted));
    }

    #[test]
    fn hostile_names_stay_well_formed() {
        let mut drawing = small();
        let name = "\"'>]]>\0\u{1b}[31m\u{fffe}\nおはよう &amp; <g id=\"layer1\">";
        drawing.layers[0].name = name.to_owned();
        let text = text_of(&drawing, None);
        let document = roxmltree::Document::parse(&text).unwrap();
        let inkscape = "http://www.inkscape.org/namespaces/inkscape";
        let labels: Vec<_> = document.descendants().filter_map(|node| node.attribute((inkscape, "label"))).collect();
        let wanted = "\"'>]]>\u{fffd}\u{fffd}[31m\u{fffd} おはよう &amp; <g id=\"layer1\">";
        assert_eq!(labels, ["back & <ground>", wanted, "sky", "dots"]);
        let mut ids: Vec<_> = document.descendants().filter_map(|node| node.attribute("id")).collect();
        ids.sort_unstable();
        assert_eq!(ids, ["layer1", "layer2", "layer3", "layer4", "paper"]);
    }

    #[test]
    fn many_tiles_share_paths() {
        let few = scattered(100.0, 100.0, MANY);
        let many = scattered(100.0, 100.0, MANY + 1);
        let count = |text: &str| text.matches("<path").count();
        assert_eq!(count(&text_of(&few, None)), MANY);
        let shared = text_of(&many, None);
        // Each of the eight kinds of mark may leave one path that is not full.
        assert!(count(&shared) <= MANY / TOGETHER + 8, "{}", count(&shared));
        // No mark is lost: a tile has ten subpaths, a longer stroke or area one. Joins of tapers are circles of four
        // curves.
        let rings =
            |layer: &Layer| layer.tapers.iter().map(|(spine, widths)| outline(spine, widths).len()).sum::<usize>();
        let tapers: usize = many.layers.iter().map(rings).sum();
        assert_eq!(shared.matches('M').count() - tapers, (MANY + 1) / 7 * 42 + 20);
        assert!(roxmltree::Document::parse(&shared).is_ok());
    }

    #[test]
    fn areas_that_share_a_path_run_the_same_way_round() {
        let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
        let mut back = square;
        back.reverse();
        let areas = [vec![ring(&square)], vec![ring(&back)], vec![ring(&square), ring(&back)]];
        let text = String::from_utf8(pieces_text(&area_pieces(&areas, 2))).unwrap();
        assert_eq!(
            text,
            "<path fill-rule=\"nonzero\" d=\"M0 0h1v1h-1zM0 0h1v1h-1z\"/>\n\
             <path d=\"M0 0h1v1h-1zM0 1h1v-1h-1z\"/>\n"
        );
    }

    #[test]
    fn a_tile_longer_than_a_piece_is_one_path() {
        let line = [Point::new(0.0, 0.0), Point::new(1.0, 1.0)];
        let mut strokes = Strokes::new(Length::mm(0.1), Cap::Butt);
        strokes.lines = vec![line; 2 * PIECE + 1];
        strokes.bundle_ends = vec![2 * PIECE, 2 * PIECE + 1];
        let mut one = layer("one", Colour::BLACK);
        one.strokes.push(strokes);
        let text = text_of(&Drawing { page: page(10.0, 10.0), layers: vec![one] }, None);
        assert_eq!((text.matches("<path").count(), text.matches("\"/>\n").count()), (2, 3));
        assert_eq!(text.matches("M0 0l1 1").count(), 2 * PIECE + 1);
    }

    #[test]
    fn long_strokes_do_not_drift() {
        let points: Vec<Point> =
            (0..1000).map(|i| Point::new(f64::from(i) * 0.333_333, f64::from(i % 7) / 3.0)).collect();
        let mut text = Vec::new();
        write_polyline(&points, &mut text);
        let tree = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' width='400' height='9'><path stroke='red' d='{}'/></svg>",
            String::from_utf8(text).unwrap()
        );
        let tree = usvg::Tree::from_str(&tree, &usvg::Options::default()).unwrap();
        let Some(usvg::Node::Path(path)) = tree.root().children().first() else { panic!("no path") };
        assert_eq!(path.data().points().len(), points.len());
        for (read, wanted) in path.data().points().iter().zip(&points) {
            let off = (f64::from(read.x) - wanted.x).abs().max((f64::from(read.y) - wanted.y).abs());
            assert!(off < 5e-4, "{off}");
        }
    }

    #[test]
    fn threads_do_not_matter() {
        let drawing = scattered(100.0, 100.0, 30_000);
        let [one, four] = on_threads(|| text_of(&drawing, None));
        assert!(one == four);
    }
}
