//! Scenes in TOML: [`read`] makes a document of them, [`write()`] makes them of a document.
//!
//! In: the text of a `.toml` scene. Out: the same [`Document`](super::ast::Document) that the `.kake` front end makes,
//! every span pointing into the TOML, and diagnostics. [`write()`] goes the other way and loses nothing but comments and
//! the order among declarations of different kinds: `read(write(d))` says what `d` says.
//!
//! # The form
//!
//! A string is an expression of the language (`size = "(60mm, 60mm)"`, `mode = '"grid"'`) but for the keys `as`,
//! `name`, `import` and `doc`, which are plain text, and `for` and `type`, which are a name. Integers, floats and
//! booleans are numbers and booleans, arrays are lists, tables are records.
//!
//! ```toml
//! edition = 1
//! seed = 42
//!
//! [[import]]
//! import = "manga.kake"
//! as = "manga"                     # optional
//!
//! [canvas]                         # its properties
//! size = "(60mm, 60mm)"
//!
//! [param.pen]
//! type = "length"                  # optional
//! default = "0.2mm"
//! in = "0.1mm .. 0.6mm"            # optional
//! doc = "Width of every stroke"    # optional, as it is everywhere
//!
//! [let]                            # [field] and [region] likewise
//! gap = "0.3mm"
//! step = { type = "length", value = "gap * 2", doc = "From one row to the next" }
//!
//! [fn.square]
//! params = "a"
//! value = "a * a"
//!
//! [tone.plain]
//! params = "k: field = 1, tile: length = 6mm"
//! place = "poisson(radius: tile)"  # what is no `doc`, `params`, `from` or `properties` is a property
//! k = "k"
//!
//! [tone.dense]                     # derived: what follows `from` differs from it
//! from = "plain(k: 3)"
//! blend = "dither"
//!
//! [[draw]]
//! paint = "canvas"
//! with = "plain(k: 2)"
//! as = "sheet {1 + 1}"             # optional; `\{` is a brace
//! seed = 7                         # optional
//!
//! [[draw]]
//! outline = "canvas"
//! pen = "0.3mm"
//!
//! [[draw]]
//! layer = '"front"'
//! ink = "#333333"                  # optional
//! [[draw.draw]]
//! paint = "canvas"
//! with = "plain"
//!
//! [[draw]]
//! for = "i"
//! in = "0 .. 4"
//! [[draw.draw]]
//! if = "i < 2"
//! draw = [{ paint = "canvas", with = "plain" }]
//! else-if = [{ if = "i < 3", draw = [] }]        # optional, in order
//! else = [{ paint = "canvas", with = "dense" }]  # optional
//!
//! [experiment.factorial]           # its properties
//! seeds = "0 .. 99"
//! factors = { mode = ['"grid"', '"hex"'] }
//! ```
//!
//! - `params` is a string in the syntax of the language; or an array of such strings and of tables with `name`, `type`,
//!   `default` and `doc`; or a table from names to tables with `type`, `default` and `doc`. All keep their order.
//! - A property with a doc comment is `{ value = …, doc = "…" }`; a table with just these two keys is always that. A
//!   `let`, `field` or `region` whose value is a record with a key `value` is written `{ value = { … } }`.
//! - `edition` and `seed` may be `{ value = …, doc = "…" }`.
//! - `[canvas]`, `[tone.NAME]` and `[experiment.NAME]` may have `properties`, a record whose properties are the block's:
//!   for names that mean something else there.
//! - `as` may be `{ value = "expression" }` where the name of a paint is computed.
//! - An entry of a `draw`, `else` or `else-if` array without a drawing statement may hold declarations, with the same
//!   keys as the file: `let.row = "i * 2"`.
//! - In a multi-line string of plain text the line end before the closing quotes does not count.

pub mod data;
mod draw;
mod encode;
mod guard;
mod place;
mod read;
#[cfg(test)]
mod tests;
mod text;
mod value;
mod write;

pub use read::read;
pub use write::write;

use super::ast::Expr;

/// An expression as a value of TOML that begins a line of its own.
pub(super) fn value(expr: &Expr) -> String {
    encode::value(expr, 0)
}
