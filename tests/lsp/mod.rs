//! `kake lsp` as an editor meets it: the real program, over its standard input and output.

mod client;
mod editors;
mod names;
mod session;
mod writing;

/// A library of two tones, and a sheet that uses it.
const LIBRARY: [(&str, &str); 4] = [
    ("kake.toml", "[library]\nname = \"lib\"\nversion = \"0.1.0\"\nedition = 1\n"),
    ("tones/base.kake", BASE),
    ("sheet.kake", SHEET),
    ("other.kake", OTHER),
];

const BASE: &str = "\
edition 1

/// Width of every stroke.
param pen: length = 0.2mm in 0.1mm .. 0.6mm

/// Squares, as by hand.
tone squares(k: field = 1, tile: length = 6mm) {
  place: poisson(radius: tile / 1.6)
  fill: lines(pitch: 0.8mm, pen: pen)
  k: k
}

fn double(a) = a * 2
";

const SHEET: &str = "\
edition 1

import \"tones/base.kake\" as base
import \"std:manga\"

canvas {
  size: (60mm, 30mm)
  ink: navy
}
seed 4

let gap = 1mm + 1pt // 🖌
region inner = inset(canvas, gap)
field shade = linear(across: canvas, start: 1, end: 4)

paint inner with base.squares(k: shade, tile: base.double(3mm)) as \"sheet\"

layer \"front\" ink #c02030 {
  outline inner pen gap
}
";

const OTHER: &str = "\
import \"tones/base.kake\"

canvas { size: a6 }

paint canvas with squares(tile: double(2mm), k: 2)
";
