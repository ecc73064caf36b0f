//! What editors ask about scenes: mistakes, completion, what names mean, where they are declared, and new names for them.
//!
//! In: texts, as they are being written, and places in them. Out: answers in the types of the Language Server Protocol.
//! Nothing here reads a file, knows an address or speaks the protocol: that is the command line's.
//!
//! Names, values and mistakes come from lowering itself, which keeps a [`Survey`](crate::lower::Survey) when it is asked
//! to, so that an editor is told what the compiler does. What fits a half-typed place is found from the tokens before it
//! (see [`Context`]), for nothing of such a text need be whole, and from the tables of the vocabulary
//! ([`reference`](crate::lower::reference)).

mod analysis;
mod colour;
mod complete;
mod context;
mod declared;
mod fix;
mod frame;
mod hover;
mod outline;
mod problem;
mod rename;
mod signature;
#[cfg(test)]
mod tests;
mod text;

pub use analysis::{Analysis, Seen, Spot, touches};
pub use colour::{colours, presentations};
pub use complete::{Folder, Snippets, complete};
pub use context::{CallAt, Context, Found, Known, Place, context};
pub use declared::{Declared, What, declared};
pub use fix::{Fix, fixes};
pub use frame::{Argument, Called};
pub use hover::hover;
pub use outline::{foldings, symbols};
pub use problem::{Related, problem, severity};
pub use rename::{Named, check_name, places, renameable, same_meanings};
pub use signature::help;
pub use text::{Encoding, Text};
