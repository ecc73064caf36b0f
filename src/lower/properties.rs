//! The properties of blocks: what each takes, what it is otherwise, and a sentence about it for editors.

use super::canvas::SHEET_NAMES;
use super::convert::Slot;
use super::value::Kind;

/// A property of a block.
#[derive(Debug, Clone, Copy)]
pub struct Property {
    /// Its name.
    pub name: &'static str,
    /// What it takes.
    pub slot: Slot,
    /// What it is where it is not given, in words of the language or about them; empty where it must be given.
    pub default: &'static str,
    /// What it is, in a sentence.
    pub about: &'static str,
}

/// The properties of a canvas with what each takes.
pub(super) const CANVAS: [Property; 10] = [
    Property {
        name: "size",
        slot: Slot::or_words(Kind::Point, SHEET_NAMES),
        default: "",
        about: "Width and height, or the name of a sheet, upright.",
    },
    Property {
        name: "bleed",
        slot: Slot::of(Kind::Length),
        default: "0mm",
        about: "How far the picture goes on beyond each side, to be trimmed off.",
    },
    Property { name: "dpi", slot: Slot::of(Kind::Number), default: "600", about: "Pixels per inch, 1 to 100,000." },
    Property {
        name: "pixels",
        slot: Slot::ANY,
        default: "from dpi",
        about: "Width and height of a PNG in whole pixels, instead of `dpi`.",
    },
    Property {
        name: "paper",
        slot: Slot::or_words(Kind::Colour, &["none"]),
        default: "white",
        about: "The colour of the paper, or `none`, which is transparent.",
    },
    Property {
        name: "ink",
        slot: Slot::of(Kind::Colour),
        default: "black",
        about: "The colour of what is drawn, unless a layer or a fill says otherwise.",
    },
    Property {
        name: "depth",
        slot: Slot::of(Kind::Number),
        default: "8",
        about: "8 for 256 greys, 1 for ink or paper, decided at half coverage.",
    },
    Property {
        name: "unit",
        slot: Slot::of(Kind::Length),
        default: "1mm",
        about: "The length that a bare number means, above 0.",
    },
    Property {
        name: "gain",
        slot: Slot::of(Kind::Length),
        default: "0mm",
        about: "How far ink spreads beyond each edge of a mark, for `darkness` to reckon with.",
    },
    Property {
        name: "repeat",
        slot: Slot::of(Kind::Bool),
        default: "false",
        about: "Whether the left border continues on the right and the upper one below.",
    },
];

/// The properties of tones with what each takes.
pub(super) const TONE: [Property; 17] = [
    Property { name: "place", slot: Slot::of(Kind::Placement), default: "", about: "Where the sites of tiles lie." },
    Property {
        name: "domain",
        slot: Slot::words(&["canvas", "region"]),
        default: "canvas",
        about: "Over what area sites are found.",
    },
    Property {
        name: "bleed",
        slot: Slot::of(Kind::Length),
        default: "one spacing",
        about: "How far beyond the domain sites are placed, not negative; 0 where tiles are counted.",
    },
    Property { name: "shape", slot: Slot::of(Kind::Shape), default: "rect()", about: "What tiles look like." },
    Property {
        name: "link",
        slot: Slot::words(&["delaunay", "edges"]),
        default: "edges for cell, else delaunay",
        about: "Which tiles are neighbours.",
    },
    Property { name: "angle", slot: Slot::of(Kind::Angles), default: "bfs()", about: "How tiles are turned." },
    Property {
        name: "fill",
        slot: Slot::of(Kind::Fill),
        default: "",
        about: "What is drawn in tiles; a list gives every layer its own.",
    },
    Property {
        name: "k",
        slot: Slot::of(Kind::Field),
        default: "1",
        about: "How many layers a tile has: a number or a field of numbers, 0 to 4.",
    },
    Property {
        name: "darkness",
        slot: Slot::of(Kind::Field),
        default: "none",
        about: "What share of the paper is covered, 0 to 1, instead of `k`; layers and spacing follow.",
    },
    Property {
        name: "range",
        slot: Slot::words(&["clip", "fit"]),
        default: "clip",
        about: "What becomes of a darkness that the tone does not print.",
    },
    Property {
        name: "solid",
        slot: Slot::of(Kind::Number),
        default: "none",
        about: "Tiles that ask for so much darkness are inked all over, above 0 to 1.",
    },
    Property {
        name: "blend",
        slot: Slot::words(&["step", "partial", "dither", "contour"]),
        default: "step",
        about: "What becomes of a fraction of `k`.",
    },
    Property {
        name: "stack",
        slot: Slot::words(&["cover", "through"]),
        default: "cover for stamps, through for cells",
        about: "Whether later tiles hide what lies under them.",
    },
    Property {
        name: "over",
        slot: Slot::words(&["print", "knockout"]),
        default: "print",
        about: "Whether the paint removes what lies under its tiles.",
    },
    Property {
        name: "ground",
        slot: Slot::or_words(Kind::Fill, &["nearest", "none"]),
        default: "nearest under stamps that lie on each other, else none",
        about: "What is drawn where no tile is.",
    },
    Property {
        name: "edge",
        slot: Slot::words(&["clip", "whole", "centre"]),
        default: "clip",
        about: "What becomes of tiles at the region's outline.",
    },
    Property { name: "hand", slot: Slot::of(Kind::Hand), default: "ruled", about: "How unevenly strokes are drawn." },
];

/// The properties of experiments with what each takes.
pub(super) const EXPERIMENT: [Property; 4] = [
    Property {
        name: "seeds",
        slot: Slot::of(Kind::Range),
        default: "",
        about: "A range of whole numbers, both ends in.",
    },
    Property {
        name: "factors",
        slot: Slot::of(Kind::Record),
        default: "none",
        about: "Parameters with the lists of their levels; the conditions are all combinations.",
    },
    Property {
        name: "reference",
        slot: Slot::of(Kind::List),
        default: "none",
        about: "Conditions outside the design, each a record of values of some parameters.",
    },
    Property {
        name: "images",
        slot: Slot::of(Kind::Record),
        default: "none",
        about: "Parameters with the values that each condition is drawn with, in all combinations.",
    },
];
