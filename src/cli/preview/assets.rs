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

const PICTURE: &str = "image/svg+xml";
const SCRIPT: &str = "text/javascript; charset=utf-8";
const STYLE: &str = "text/css; charset=utf-8";

/// Names a file of the page with its media type.
macro_rules! asset {
    ($name:literal, $kind:expr) => {
        Asset { name: $name, kind: $kind, bytes: include_bytes!(concat!("page/", $name)) }
    };
}

/// Every other file.
pub(super) const ASSETS: &[Asset] = &[
    asset!("api.js", SCRIPT),
    asset!("clipboard.js", SCRIPT),
    asset!("controls.js", SCRIPT),
    asset!("desk.js", SCRIPT),
    asset!("dom.js", SCRIPT),
    asset!("drawer.js", SCRIPT),
    asset!("icon.svg", PICTURE),
    asset!("image.js", SCRIPT),
    asset!("keys.js", SCRIPT),
    asset!("layers.js", SCRIPT),
    asset!("link.js", SCRIPT),
    asset!("measures.js", SCRIPT),
    asset!("page.css", STYLE),
    asset!("page.js", SCRIPT),
    asset!("params.js", SCRIPT),
    asset!("picture.js", SCRIPT),
    asset!("source.js", SCRIPT),
    asset!("status.js", SCRIPT),
    asset!("syntax.js", SCRIPT),
    asset!("tiles.js", SCRIPT),
    asset!("values.js", SCRIPT),
    asset!("variations.js", SCRIPT),
    asset!("view.js", SCRIPT),
    asset!("wish.js", SCRIPT),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_file_of_the_page_is_served() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/src/cli/preview/page");
        let files = std::fs::read_dir(folder).expect("the folder is there");
        let names = files.map(|file| file.expect("the folder can be read").file_name().to_string_lossy().into_owned());
        let mut there: Vec<String> = names.filter(|name| name != "index.html").collect();
        there.sort();
        assert_eq!(ASSETS.iter().map(|asset| asset.name).collect::<Vec<_>>(), there);
    }

    #[test]
    fn texts_never_become_markup() {
        for asset in ASSETS {
            let text = String::from_utf8_lossy(asset.bytes);
            for way in ["innerHTML", "outerHTML", "insertAdjacentHTML", "document.write", "eval("] {
                assert!(!text.contains(way), "{}: {way}", asset.name);
            }
        }
    }
}
