//! What charts are drawn on: lines, shapes and texts in pixels, as SVG elements.

use svg::Node;
use svg::node::element::{Circle, Line, Path, Rectangle, SVG, Text, Title};

/// Sizes of text in pixels.
pub(super) const TEXT: f64 = 12.0;
pub(super) const SMALL: f64 = 11.0;
pub(super) const LARGE: f64 = 14.0;

/// Greys: text, axes, lines behind data.
pub(super) const INK: &str = "#222222";
pub(super) const GREY: &str = "#777777";
pub(super) const FAINT: &str = "#e6e6e6";

/// The width of all charts but square ones.
pub(super) const WIDTH: f64 = 640.0;

/// Eight colours that readers tell apart whatever colours they see (Okabe and Ito 2008), those that are weak on white last.
const COLOURS: [&str; 8] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#000000", "#b8a900"];

/// The fonts that texts ask for.
const FONTS: &str = "Helvetica, Arial, 'Liberation Sans', 'Noto Sans', sans-serif";

/// The colour of a series.
pub(super) fn colour(series: usize) -> &'static str {
    COLOURS[series % COLOURS.len()]
}

/// The dashes of a series: those that share a colour differ.
pub(super) fn dashes(series: usize) -> Option<&'static str> {
    [None, Some("6 3"), Some("2 2"), Some("8 3 2 3")][series / COLOURS.len() % 4]
}

/// Where a text stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

impl Anchor {
    fn name(self) -> &'static str {
        match self {
            Self::Start => "start",
            Self::Middle => "middle",
            Self::End => "end",
        }
    }
}

/// About how wide a text is, rather too wide: fonts differ, and none is read here.
pub(super) fn width_of(text: &str, size: f64) -> f64 {
    let em = |c: char| match c {
        'i' | 'j' | 'l' | 'I' | '.' | ',' | ':' | ';' | '|' | '\'' | ' ' | 'f' | 't' | 'r' => 0.38,
        'm' | 'w' | 'M' | 'W' | '%' => 0.95,
        'A'..='Z' => 0.72,
        c if (c as u32) < 0x1100 => 0.62,
        _ => 1.0,
    };
    text.chars().map(em).sum::<f64>() * size
}

/// A text that is no wider than so many pixels; what is cut off is marked.
pub(super) fn shortened(text: &str, size: f64, most: f64) -> String {
    if width_of(text, size) <= most {
        return text.to_owned();
    }
    let mut short = String::new();
    for c in text.chars() {
        short.push(c);
        if width_of(&short, size) + size > most {
            break;
        }
    }
    short + "\u{2026}"
}

/// A coordinate: hundredths of a pixel.
fn at(value: f64) -> f64 {
    let rounded = (value * 100.0).round() / 100.0;
    // Minus zero is zero.
    rounded + 0.0
}

/// A text without the characters that XML forbids; the writer escapes the rest.
fn plain(text: &str) -> String {
    let is_bad = |c: char| (c.is_control() && c != '\t' && c != '\n') || matches!(c, '\u{fffe}' | '\u{ffff}');
    text.chars().map(|c| if is_bad(c) { char::REPLACEMENT_CHARACTER } else { c }).collect()
}

/// A chart while it is drawn.
pub(super) struct Sheet {
    svg: SVG,
}

impl Sheet {
    /// A white sheet of a size with a title above.
    pub(super) fn new(width: f64, height: f64, title: &str) -> Self {
        let svg = SVG::new()
            .set("viewBox", format!("0 0 {} {}", at(width), at(height)))
            .set("width", at(width))
            .set("height", at(height))
            .set("role", "img")
            .set("font-family", FONTS)
            .add(Title::new(plain(title)))
            .add(Rectangle::new().set("width", at(width)).set("height", at(height)).set("fill", "#ffffff"));
        let mut sheet = Self { svg };
        sheet.text([width / 2.0, 20.0], Anchor::Middle, LARGE, INK, &shortened(title, LARGE, width - 16.0));
        sheet
    }

    /// The whole SVG.
    pub(super) fn finish(self) -> String {
        let mut text = self.svg.to_string();
        text.push('\n');
        text
    }

    pub(super) fn line(&mut self, from: [f64; 2], to: [f64; 2], colour: &str, width: f64) {
        self.svg.append(
            Line::new()
                .set("x1", at(from[0]))
                .set("y1", at(from[1]))
                .set("x2", at(to[0]))
                .set("y2", at(to[1]))
                .set("stroke", colour)
                .set("stroke-width", width),
        );
    }

    /// A line with dashes.
    pub(super) fn dashed(&mut self, from: [f64; 2], to: [f64; 2], colour: &str, dashes: &str) {
        self.path(&format!("M{} {}L{} {}", at(from[0]), at(from[1]), at(to[0]), at(to[1])), colour, Some(dashes));
    }

    /// A line through points.
    pub(super) fn polyline(&mut self, points: &[[f64; 2]], colour: &str, dashes: Option<&str>) {
        if points.len() > 1 {
            self.path(&outline(points), colour, dashes);
        }
    }

    fn path(&mut self, data: &str, colour: &str, dashes: Option<&str>) {
        let mut path = Path::new()
            .set("d", data)
            .set("fill", "none")
            .set("stroke", colour)
            .set("stroke-width", 1.6)
            .set("stroke-linejoin", "round");
        if let Some(dashes) = dashes {
            path = path.set("stroke-dasharray", dashes);
        }
        self.svg.append(path);
    }

    /// A filled outline.
    pub(super) fn polygon(&mut self, points: &[[f64; 2]], fill: &str, opacity: f64) {
        if points.len() > 2 {
            let data = outline(points) + "z";
            self.svg.append(Path::new().set("d", data).set("fill", fill).set("fill-opacity", opacity));
        }
    }

    /// A filled path of SVG's commands, whose numbers [`number`] writes.
    pub(super) fn area(&mut self, data: &str, fill: &str, opacity: f64) {
        let path = Path::new().set("d", data).set("fill", fill).set("fill-opacity", opacity);
        self.svg.append(path.set("stroke", "#ffffff").set("stroke-width", 0.8));
    }

    /// A box from one corner to the opposite one.
    pub(super) fn rectangle(&mut self, from: [f64; 2], to: [f64; 2], fill: &str, opacity: f64, stroke: &str) {
        let (left, top) = (from[0].min(to[0]), from[1].min(to[1]));
        self.svg.append(
            Rectangle::new()
                .set("x", at(left))
                .set("y", at(top))
                .set("width", at((to[0] - from[0]).abs()))
                .set("height", at((to[1] - from[1]).abs()))
                .set("fill", fill)
                .set("fill-opacity", opacity)
                .set("stroke", stroke),
        );
    }

    /// A circle that is only a line.
    pub(super) fn ring(&mut self, centre: [f64; 2], radius: f64, stroke: &str) {
        let circle = Circle::new().set("cx", at(centre[0])).set("cy", at(centre[1])).set("r", at(radius));
        self.svg.append(circle.set("fill", "none").set("stroke", stroke));
    }

    /// The marker of a series: those that share a colour have different shapes.
    pub(super) fn marker(&mut self, centre: [f64; 2], radius: f64, series: usize) {
        let ([x, y], fill) = (centre, colour(series));
        let corners: &[[f64; 2]] = match series / COLOURS.len() % 4 {
            0 => {
                let circle = Circle::new().set("cx", at(x)).set("cy", at(y)).set("r", at(radius));
                self.svg.append(circle.set("fill", fill));
                return;
            }
            1 => &[[-0.9, -0.9], [0.9, -0.9], [0.9, 0.9], [-0.9, 0.9]],
            2 => &[[0.0, -1.2], [1.1, 0.8], [-1.1, 0.8]],
            _ => &[[0.0, -1.25], [1.25, 0.0], [0.0, 1.25], [-1.25, 0.0]],
        };
        let corners: Vec<[f64; 2]> = corners.iter().map(|[u, v]| [x + u * radius, y + v * radius]).collect();
        self.polygon(&corners, fill, 1.0);
    }

    /// A text; none where it is empty.
    pub(super) fn text(&mut self, place: [f64; 2], anchor: Anchor, size: f64, colour: &str, text: &str) {
        if !text.is_empty() {
            self.svg.append(words(place, anchor, size, colour, text));
        }
    }

    /// A text that runs upwards, centred.
    pub(super) fn upright(&mut self, place: [f64; 2], size: f64, colour: &str, text: &str) {
        if !text.is_empty() {
            let turn = format!("rotate(-90 {} {})", at(place[0]), at(place[1]));
            self.svg.append(words(place, Anchor::Middle, size, colour, text).set("transform", turn));
        }
    }

    /// That there is nothing to be drawn.
    pub(super) fn no_data(&mut self, place: [f64; 2]) {
        self.text(place, Anchor::Middle, TEXT, GREY, "no data");
    }
}

fn words(place: [f64; 2], anchor: Anchor, size: f64, colour: &str, text: &str) -> Text {
    Text::new(plain(text))
        .set("x", at(place[0]))
        .set("y", at(place[1]))
        .set("text-anchor", anchor.name())
        .set("font-size", size)
        .set("fill", colour)
}

/// A coordinate as text.
pub(super) fn number(value: f64) -> String {
    at(value).to_string()
}

fn outline(points: &[[f64; 2]]) -> String {
    let pairs: Vec<String> = points.iter().map(|[x, y]| format!("{} {}", at(*x), at(*y))).collect();
    format!("M{}", pairs.join("L"))
}

/// Draws the names of series in rows below a height, each with its marker and line; how high they are.
pub(super) fn legend(sheet: &mut Sheet, names: &[&str], left: f64, right: f64, top: f64) -> f64 {
    if names.iter().all(|name| name.is_empty()) || names.is_empty() {
        return 0.0;
    }
    let (mut x, mut y) = (left, top + 8.0);
    for (series, name) in names.iter().enumerate() {
        let name = shortened(name, TEXT, right - left - 40.0);
        let width = 34.0 + width_of(&name, TEXT) + 18.0;
        if x + width > right + 18.0 && x > left {
            (x, y) = (left, y + 18.0);
        }
        sheet.polyline(&[[x, y], [x + 24.0, y]], colour(series), dashes(series));
        sheet.marker([x + 12.0, y], 3.2, series);
        sheet.text([x + 30.0, y + 4.0], Anchor::Start, TEXT, INK, &name);
        x += width;
    }
    y - top + 14.0
}
