//! What a picture carries so that it can be made again from itself: a [`Metadata`] goes into an SVG or a PNG, and
//! [`extract`] gets it back from the bytes.
//!
//! The form in both is JSON: the text of an element of its own name space in the SVG, a compressed `iTXt` chunk in the
//! PNG. Nothing in it depends on the time or the machine. Pictures come from strangers, so reading one never panics and
//! never unpacks more than [`LARGEST`] bytes.

use std::collections::BTreeMap;
use std::io::Cursor;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD as BASE64;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use usvg::roxmltree;

/// The name space of the element in an SVG.
pub(super) const NAMESPACE: &str = "urn:kakeami:picture:1";
/// The name of the element in an SVG.
pub(super) const ELEMENT: &str = "picture";
/// The keyword of the chunk in a PNG.
pub(super) const KEYWORD: &str = "kakeami";

/// The most bytes of JSON that are unpacked from a picture.
const LARGEST: usize = 256 << 20;
/// The most elements, texts and comments of an SVG that are looked at.
const MOST_NODES: u32 = 8_000_000;

/// How a picture was made.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Metadata {
    /// The version of the program.
    pub version: String,
    /// The seed of the scene.
    pub seed: u64,
    /// The path of the main file: one of `sources`.
    pub scene: String,
    /// What `--set` gave, as text.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub params: BTreeMap<String, String>,
    /// Other options of the command line that change the picture, as text: `dpi`, `only`.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub options: BTreeMap<String, String>,
    /// The paths and texts of the scene and what it imports, in the order they were read.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sources: Vec<(String, String)>,
    /// The paths and bytes of other files that were read.
    #[serde(
        default,
        skip_serializing_if = "Vec::is_empty",
        serialize_with = "write_files",
        deserialize_with = "read_files"
    )]
    pub files: Vec<(String, Vec<u8>)>,
}

fn write_files<S: Serializer>(files: &[(String, Vec<u8>)], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(files.iter().map(|(path, bytes)| (path, BASE64.encode(bytes))))
}

fn read_files<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<(String, Vec<u8>)>, D::Error> {
    Vec::<(String, String)>::deserialize(deserializer)?
        .into_iter()
        .map(|(path, text)| Ok((path, BASE64.decode(text).map_err(serde::de::Error::custom)?)))
        .collect()
}

impl Metadata {
    /// The JSON, on one line and with no character that XML forbids.
    ///
    /// # Errors
    /// None that the type can have; the serialiser's signature allows for some.
    pub(super) fn to_json(&self) -> std::io::Result<String> {
        let json = serde_json::to_string(self)?;
        // JSON escapes control characters itself; these two may stand in JSON but not in XML. They occur in strings only.
        Ok(json.replace('\u{fffe}', "\\ufffe").replace('\u{ffff}', "\\uffff"))
    }

    fn from_json(json: &str) -> Option<Self> {
        serde_json::from_str(json).ok()
    }
}

/// The metadata in the bytes of an SVG or PNG, if it is there and whole.
#[must_use]
pub fn extract(bytes: &[u8]) -> Option<Metadata> {
    if bytes.starts_with(b"\x89PNG") { extract_png(bytes) } else { extract_svg(std::str::from_utf8(bytes).ok()?) }
}

fn extract_png(bytes: &[u8]) -> Option<Metadata> {
    let limits = ::png::Limits { bytes: LARGEST };
    let mut reader = ::png::Decoder::new_with_limits(Cursor::new(bytes), limits).read_info().ok()?;
    if let Some(found) = in_chunks(reader.info()) {
        return Some(found);
    }
    // Programs that rewrite a picture may move the chunk behind the image.
    reader.finish().ok()?;
    in_chunks(reader.info())
}

fn in_chunks(info: &::png::Info<'_>) -> Option<Metadata> {
    info.utf8_text.iter().filter(|chunk| chunk.keyword == KEYWORD).find_map(|chunk| {
        let mut chunk = chunk.clone();
        chunk.decompress_text_with_limit(LARGEST).ok()?;
        Metadata::from_json(&chunk.get_text().ok()?)
    })
}

fn extract_svg(text: &str) -> Option<Metadata> {
    // A picture without the name space is told apart without reading all of it as XML.
    if !text.contains(NAMESPACE) {
        return None;
    }
    let options = roxmltree::ParsingOptions { allow_dtd: false, nodes_limit: MOST_NODES, ..Default::default() };
    let document = roxmltree::Document::parse_with_options(text.trim_start_matches('\u{feff}'), options).ok()?;
    let element = document.descendants().find(|node| node.has_tag_name((NAMESPACE, ELEMENT)))?;
    let json: String = element.children().filter_map(|child| child.text()).collect();
    Metadata::from_json(&json)
}
