//! Scenes of the language that this version cannot draw yet: they are read, formatted and converted like any other,
//! and what is said of them names only what is to come.

use std::path::Path;
use std::sync::Arc;

use kakeami::diag::Code;
use kakeami::loader::{LoadError, Loader};
use kakeami::{Config, compile};

use crate::examples::keeps_its_meaning;
use crate::support::{Folder, each, here, name, pin, scenes, shown};

/// The scenes with what they share with the examples.
struct Later;

impl Loader for Later {
    fn load(&self, path: &str) -> Result<Arc<[u8]>, LoadError> {
        Folder(here("tests/cases/later")).load(path).or_else(|_| Folder(here("examples")).load(path))
    }
}

#[test]
fn scenes_of_later_versions_keep_their_meaning() {
    each(&scenes("tests/cases/later"), keeps_its_meaning);
}

#[test]
fn what_is_not_known_yet_is_named() {
    each(&scenes("tests/cases/later"), |path: &Path| {
        let compiled = compile(name(path), &Later, &Config::default(), &mut ());
        let said = shown(&compiled.lowered.diagnostics, &compiled.lowered.sources);
        assert!(compiled.drawing.is_none(), "{} can be drawn: move it to the examples", path.display());
        for diagnostic in &compiled.lowered.diagnostics {
            assert_eq!(diagnostic.code, Code::NotYet, "{said}");
        }
        pin("later", name(path), &said);
    });
}
