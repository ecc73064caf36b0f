//! The vocabulary as editors show it: every word of the language with what it takes and a sentence about it.
//!
//! Out: signatures, properties, words, units and types, read from the very tables that lowering uses, so that nothing
//! is told of the language that is not so. Nothing here looks at a scene.

pub use super::call::{Need, Param, Signature};
pub use super::convert::Slot;
pub use super::properties::Property;
pub use super::value::Kind;

use super::{properties, vocabulary};
use crate::scene::Colour;
use crate::syntax::ast::Unit;

/// The blocks that have properties.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Block {
    /// `canvas { … }`
    Canvas,
    /// `tone name { … }`
    Tone,
    /// `experiment name { … }`
    Experiment,
}

/// The properties that a block may have, in the order of the reference.
#[must_use]
pub fn properties(block: Block) -> &'static [Property] {
    match block {
        Block::Canvas => &properties::CANVAS,
        Block::Tone => &properties::TONE,
        Block::Experiment => &properties::EXPERIMENT,
    }
}

impl Signature {
    /// What is called.
    #[must_use]
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// A sentence about it.
    #[must_use]
    pub fn about(&self) -> &'static str {
        self.about
    }

    /// The kind of its value, where that does not depend on the arguments.
    #[must_use]
    pub fn result(&self) -> Option<Kind> {
        self.result
    }

    /// What it takes, in order.
    #[must_use]
    pub fn params(&self) -> &'static [Param] {
        self.params
    }
}

impl Param {
    /// Its name.
    #[must_use]
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// What it takes.
    #[must_use]
    pub fn slot(&self) -> Slot {
        self.slot
    }

    /// Whether it must be given, and what it is otherwise.
    #[must_use]
    pub fn need(&self) -> Need {
        self.need
    }

    /// A few words about it.
    #[must_use]
    pub fn about(&self) -> &'static str {
        self.about
    }
}

/// What can be called where a slot stands: what gives its kind first, then mathematics where it may yield that.
#[must_use]
pub fn callables(slot: Slot) -> Vec<&'static Signature> {
    vocabulary::offered(slot)
}

/// The signature behind a name that is called in a slot. `labels` are the names of the arguments that are given.
#[must_use]
pub fn callable(name: &str, slot: Slot, labels: &[&str]) -> Option<&'static Signature> {
    vocabulary::find_named(name, slot, labels.contains(&"at"))
}

/// The names that stand for values by themselves in a slot, with a sentence about each.
#[must_use]
pub fn constants(slot: Slot) -> Vec<(&'static str, &'static str)> {
    let number = matches!(slot.kind, None | Some(Kind::Number | Kind::Field));
    let region = matches!(slot.kind, None | Some(Kind::Region | Kind::Box | Kind::Field));
    let mut constants = Vec::new();
    if region {
        constants.push(("canvas", "The region of the page, with its bleed."));
    }
    if slot.kind == Some(Kind::Field) {
        constants.push(("x", "A point's place in a field: how far right, in canvas units."));
        constants.push(("y", "A point's place in a field: how far down, in canvas units."));
    }
    if number {
        constants.push(("pi", "Half the way round a circle of radius 1: 3.14159…"));
        constants.push(("tau", "The way round a circle of radius 1: 6.28318…"));
    }
    constants
}

/// The units that a number may carry in a slot.
#[must_use]
pub fn units(slot: Slot) -> Vec<Unit> {
    let lengths = [Unit::Millimetre, Unit::Centimetre, Unit::Inch, Unit::Point, Unit::Pixel];
    let angles = [Unit::Degree, Unit::Radian, Unit::Turn];
    match slot.kind {
        Some(Kind::Length | Kind::Point | Kind::Box) => lengths.to_vec(),
        Some(Kind::Angle) => angles.to_vec(),
        Some(Kind::Percentage | Kind::Number) => vec![Unit::Percent],
        None | Some(Kind::Field | Kind::Range | Kind::List | Kind::Record) => Unit::ALL.to_vec(),
        Some(
            Kind::Colour
            | Kind::String
            | Kind::Bool
            | Kind::Region
            | Kind::Placement
            | Kind::Shape
            | Kind::Angles
            | Kind::Fill
            | Kind::Hand
            | Kind::Tone
            | Kind::Drawing
            | Kind::Word,
        ) => Vec::new(),
    }
}

/// What a unit is.
#[must_use]
pub fn unit(unit: Unit) -> &'static str {
    match unit {
        Unit::Millimetre => "millimetres",
        Unit::Centimetre => "centimetres",
        Unit::Inch => "inches, 25.4 mm",
        Unit::Point => "points, 1/72 inch",
        Unit::Pixel => "pixels, 1/dpi inch",
        Unit::Degree => "degrees",
        Unit::Radian => "radians",
        Unit::Turn => "whole turns",
        Unit::Percent => "per cent",
    }
}

/// Every colour that has a name, in the order of CSS.
pub fn colours() -> impl Iterator<Item = (&'static str, Colour)> {
    csscolorparser::NAMED_COLORS.entries().map(|(name, [r, g, b])| {
        let colour = Colour { r: *r, g: *g, b: *b, a: 255 };
        (name.as_str(), colour)
    })
}

/// The standard libraries: the path of each import, with its text.
pub fn libraries() -> impl Iterator<Item = (String, &'static str)> {
    super::library::all()
}

/// What a type is, in a sentence.
#[must_use]
pub fn kind(kind: Kind) -> &'static str {
    match kind {
        Kind::Number => "A plain number: `12`, `0.5`.",
        Kind::Length => "A length: `6mm`, `1in`, `12pt`, `3px`; a bare number is canvas units.",
        Kind::Angle => "An angle: `45deg`, `0.5rad`, `0.25turn`.",
        Kind::Percentage => "A share: `50%`.",
        Kind::Colour => "A colour: `#rrggbb`, or a name of CSS.",
        Kind::String => "A text in double quotes; `{…}` in it holds an expression.",
        Kind::Point => "A place or a size: `(3mm, 4mm)`.",
        Kind::Box => "A box: `(x, y, width, height)`, or a region, whose box is taken.",
        Kind::List => "A list: `[1, 2, 3]`.",
        Kind::Range => "A range with both ends in: `0 .. 9`.",
        Kind::Record => "Named values: `{ kake: [1, 2], angles: \"bfs\" }`.",
        Kind::Bool => "`true` or `false`.",
        Kind::Region => "A part of the page.",
        Kind::Field => "A value at every point of the page; a plain value is the same everywhere.",
        Kind::Placement => "Where the sites of tiles lie.",
        Kind::Shape => "What tiles look like.",
        Kind::Angles => "How tiles are turned.",
        Kind::Fill => "What is drawn in tiles.",
        Kind::Hand => "How unevenly strokes are drawn.",
        Kind::Tone => "A recipe for tiles.",
        Kind::Drawing => "Strokes and fills of a file.",
        Kind::Word => "A word of its place.",
    }
}

/// What a statement does, in a sentence, with how it is written: `⟨n: …⟩` marks what is filled in.
#[must_use]
pub fn statement(keyword: &str) -> Option<(&'static str, &'static str)> {
    STATEMENTS.iter().find(|(word, ..)| *word == keyword).map(|(_, about, form)| (*about, *form))
}

/// Every statement with what it does and its form as a snippet.
pub const STATEMENTS: [(&str, &str, &str); 17] = [
    ("edition", "Says which edition of the language the scene is written in.", "edition 1"),
    ("import", "Brings in the declarations of another file.", "import \"${1:file.kake}\" as ${2:name}"),
    ("canvas", "Describes the page.", "canvas {\n  size: ${1:a5}\n}"),
    ("seed", "Fixes random choices: a whole number from 0 to 2^53.", "seed ${1:1}"),
    ("let", "Gives a value a name.", "let ${1:name} = ${2:value}"),
    ("param", "A value that `--set` and sliders may replace.", "param ${1:name} = ${2:4mm} in ${3:1mm .. 9mm}"),
    ("field", "A value that varies over the page.", "field ${1:name} = ${2:noise(scale: 20mm)}"),
    ("region", "A part of the page.", "region ${1:name} = ${2:inset(canvas, 5mm)}"),
    (
        "tone",
        "A recipe for tiles, with parameters and properties.",
        "tone ${1:name}(k: field = 1) {\n  place: ${2:poisson(radius: 4mm)}\n  fill: ${3:lines(pitch: 0.8mm)}\n  k: k\n}",
    ),
    ("fn", "A function.", "fn ${1:name}(${2:a}) = ${3:a * 2}"),
    ("paint", "Fills a region with a tone.", "paint ${1:canvas} with ${2:tone}"),
    ("outline", "Draws a region's outline; the pen is 0.2mm unless it is given.", "outline ${1:region} pen ${2:0.3mm}"),
    ("ink", "Draws a file's own strokes and fills.", "ink svg(\"${1:file.svg}\")"),
    ("layer", "A named group of what is drawn, perhaps with an ink of its own.", "layer \"${1:name}\" {\n  $0\n}"),
    ("for", "Repeats statements over a range or a list.", "for ${1:i} in ${2:0 .. 3} {\n  $0\n}"),
    ("if", "Carries statements out, or not.", "if ${1:condition} {\n  $0\n}"),
    (
        "experiment",
        "Runs over seeds and values of parameters, for `kake experiment`.",
        "experiment ${1:name} {\n  seeds: 0 .. ${2:99}\n  factors: { $0 }\n}",
    ),
];

/// What a word means in its place: the property or argument that takes it.
#[must_use]
pub fn word(owner: &str, word: &str) -> Option<&'static str> {
    WORDS.iter().find(|(of, known, _)| *of == owner && *known == word).map(|(.., about)| *about)
}

const WORDS: [(&str, &str, &str); 56] = [
    ("domain", "canvas", "sites are found over the whole canvas, so that moving an outline moves no tile"),
    ("domain", "region", "sites are found over the region's box"),
    ("link", "delaunay", "neighbours are joined by the Delaunay triangulation of the sites"),
    ("link", "edges", "neighbours are the cells of a tiling that share an edge"),
    ("range", "clip", "a darkness that the tone does not print is cut off"),
    ("range", "fit", "the field's own range is mapped onto what the tone prints"),
    ("blend", "step", "the nearest whole number of layers, halves up"),
    ("blend", "partial", "whole layers, and of the next one an even share of its lines"),
    ("blend", "dither", "whole numbers; what is over is passed to neighbours that come later"),
    ("blend", "contour", "layer n ends within the tile where the field is n - 0.5"),
    ("stack", "cover", "a later tile hides what lies under it"),
    ("stack", "through", "all tiles are seen"),
    ("over", "print", "the ink adds to what is there"),
    ("over", "knockout", "what lies under the tiles is removed first"),
    ("ground", "nearest", "gaps are hatched as the nearest tile would"),
    ("ground", "none", "gaps stay white"),
    ("edge", "clip", "strokes end at the region's outline"),
    ("edge", "whole", "only tiles that lie wholly inside are drawn"),
    ("edge", "centre", "tiles whose site lies inside are drawn uncut"),
    ("cap", "butt", "strokes end square"),
    ("cap", "round", "strokes end round"),
    ("see", "primary", "the first layer of every tile"),
    ("see", "layers", "all layers of every tile"),
    ("start", "first", "the first tile lies along x"),
    ("start", "random", "the whole field is turned as the seed says"),
    ("channel", "luminance", "the light of all three, with the weights of BT.709"),
    ("channel", "red", "the red light"),
    ("channel", "green", "the green light"),
    ("channel", "blue", "the blue light"),
    ("channel", "alpha", "how opaque the picture is"),
    ("ease", "linear", "evenly"),
    ("ease", "in", "slowly first"),
    ("ease", "out", "slowly last"),
    ("ease", "in_out", "smoothly at both ends"),
    ("border", "open", "a flood that comes to the page's border has leaked"),
    ("border", "wall", "the page's border is a line"),
    ("paper", "none", "transparent paper"),
    ("size", "a0", "841 x 1189 mm"),
    ("size", "a1", "594 x 841 mm"),
    ("size", "a2", "420 x 594 mm"),
    ("size", "a3", "297 x 420 mm"),
    ("size", "a4", "210 x 297 mm"),
    ("size", "a5", "148 x 210 mm"),
    ("size", "a6", "105 x 148 mm"),
    ("size", "b4", "250 x 353 mm (ISO)"),
    ("size", "b5", "176 x 250 mm (ISO)"),
    ("size", "jis_b4", "257 x 364 mm"),
    ("size", "jis_b5", "182 x 257 mm"),
    ("size", "legal", "215.9 x 355.6 mm"),
    ("size", "letter", "215.9 x 279.4 mm"),
    ("size", "tabloid", "279.4 x 431.8 mm"),
    ("clause", "with", "names the tone that paints, or the properties in which a tone differs"),
    ("clause", "as", "gives a paint its name, or an import its module name"),
    ("clause", "in", "a parameter's range or choices, or what a loop goes over"),
    ("clause", "pen", "the width of the stroke"),
    ("clause", "seed", "a seed of the paint's own"),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::syntax::kake::KEYWORDS;

    /// Every slot that takes words, with what it belongs to.
    fn slots() -> Vec<(&'static str, Slot)> {
        let blocks = [Block::Canvas, Block::Tone, Block::Experiment];
        let properties = blocks.into_iter().flat_map(|block| properties(block).iter().map(|p| (p.name, p.slot)));
        let arguments = vocabulary::all().flat_map(|signature| signature.params.iter().map(|p| (p.name, p.slot)));
        properties.chain(arguments).collect()
    }

    #[test]
    fn every_name_argument_property_and_word_has_its_sentence() {
        for signature in vocabulary::all() {
            assert!(signature.about.len() > 5 && signature.about.ends_with('.'), "{}", signature.name);
            for param in signature.params {
                assert!(!param.about.is_empty(), "{} of {}", param.name, signature.name);
                assert_ne!(param.need, Need::Optional(""), "{} of {}", param.name, signature.name);
            }
        }
        for block in [Block::Canvas, Block::Tone, Block::Experiment] {
            for property in properties(block) {
                assert!(!property.about.is_empty(), "{}", property.name);
            }
        }
        for (owner, slot) in slots() {
            for known in slot.words {
                assert!(word(owner, known).is_some(), "{known} of {owner}");
            }
        }
    }

    #[test]
    fn words_that_are_explained_are_taken_somewhere() {
        let slots = slots();
        for (owner, known, _) in WORDS.iter().filter(|(owner, ..)| *owner != "clause") {
            let taken = slots.iter().any(|(name, slot)| name == owner && slot.words.contains(known));
            assert!(taken, "{known} of {owner}");
        }
    }

    #[test]
    fn every_statement_has_its_sentence_and_its_form() {
        let words: Vec<&str> = STATEMENTS.iter().map(|(word, ..)| *word).collect();
        assert_eq!(words, KEYWORDS);
        for (word, _, form) in STATEMENTS {
            assert!(form.starts_with(word), "{form}");
        }
    }

    #[test]
    fn names_with_two_meanings_are_told_apart_by_their_place() {
        let fill = Slot::of(Kind::Fill);
        assert!(callables(fill).iter().any(|signature| signature.name == "lines"));
        assert!(!callables(fill).iter().any(|signature| signature.name == "sin" || signature.name == "rect"));
        let shape = callable("rect", Slot::of(Kind::Shape), &[]).map(|signature| signature.result);
        let region = callable("rect", Slot::ANY, &["at"]).map(|signature| signature.result);
        assert_eq!((shape, region), (Some(Some(Kind::Shape)), Some(Some(Kind::Region))));
    }

    #[test]
    fn colours_are_those_that_scenes_know() {
        let navy = colours().find(|(name, _)| *name == "navy").map(|(_, colour)| colour.hex());
        assert_eq!(navy.as_deref(), Some("#000080"));
    }
}
