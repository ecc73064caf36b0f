//! The page's files, which lie inside the program.

/// A file of the page.
pub(super) struct Asset {
    /// Its name below `/page/`.
    pub(super) name: &'static str,
    /// Its media type.
    pub(super) kind: &'static str,
    /// What is in it.
    pub(super) bytes: &'static [u8],
}

/// The page itself. Of its two `<meta>` elements `kake-token` and `kake-scene` the contents `TOKEN` and `scene.kake` are
/// replaced.
pub(super) const INDEX: &str = include_str!("page/index.html");

/// Names a file of the page with its media type.
macro_rules! asset {
    ($name:literal, $kind:literal) => {
        Asset { name: $name, kind: $kind, bytes: include_bytes!(concat!("page/", $name)) }
    };
}

/// Every other file.
pub(super) const ASSETS: &[Asset] =
    &[asset!("page.css", "text/css; charset=utf-8"), asset!("page.js", "text/javascript; charset=utf-8")];
