//! What a picture carries so that it can be made again from itself: a [`Metadata`] goes into an SVG, a PNG or a PDF, and
//! [`extract`] gets it back from the bytes.
//!
//! The form in all is JSON: the text of an element of its own name space in the SVG and in the PDF's XMP packet, a compressed
//! `iTXt` chunk in the PNG. Nothing in it depends on the time or the machine. Pictures come from strangers, so reading one never panics and
//! never unpacks more than `LARGEST` bytes.

use std::collections::BTreeMap;
use std::io::Cursor;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD as BASE64;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use svg::node::Text;
use usvg::roxmltree;

/// The name space of the element in an SVG.
pub(super) const NAMESPACE: &str = "urn:kakeami:picture:1";
/// The name of the element in an SVG.
pub(super) const ELEMENT: &str = "picture";
/// The keyword of the chunk in a PNG.
pub(super) const KEYWORD: &str = "kakeami";

/// How an XMP packet in a PDF starts, but for its attributes.
const XMP_START: &str = "<x:xmpmeta";
/// How it ends.
const XMP_END: &str = "</x:xmpmeta>";

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
    /// Other options of the command line that change the picture, as text: `dpi`, `only`, `plot`.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub options: BTreeMap<String, String>,
    /// The paths and texts of the scene and what it imports, in the order they were read.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sources: Vec<(String, String)>,
    /// Keys of dependencies that go by another, shorter one.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub dependencies: BTreeMap<String, String>,
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

    /// As an XMP packet (ISO 16684-1), which other programs find without reading the file around it.
    ///
    /// # Errors
    /// None that the type can have.
    pub(super) fn to_xmp(&self) -> std::io::Result<String> {
        let (version, json) = (Text::new(self.version.as_str()), Text::new(self.to_json()?));
        Ok(format!(
            "<?xpacket begin=\"\u{feff}\" id=\"W5M0MpCehiHzreSzNTczkc9d\"?>\n\
             {XMP_START} xmlns:x=\"adobe:ns:meta/\">\n\
             <rdf:RDF xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\">\n\
             <rdf:Description rdf:about=\"\" xmlns:pdf=\"http://ns.adobe.com/pdf/1.3/\" xmlns:kakeami=\"{NAMESPACE}\">\n\
             <pdf:Producer>kake {version}</pdf:Producer>\n\
             <kakeami:{ELEMENT}>{json}</kakeami:{ELEMENT}>\n\
             </rdf:Description>\n</rdf:RDF>\n{XMP_END}\n<?xpacket end=\"r\"?>\n"
        ))
    }

    fn from_json(json: &str) -> Option<Self> {
        serde_json::from_str(json).ok()
    }
}

/// The metadata in the bytes of an SVG, a PNG or a PDF, if it is there and whole.
#[must_use]
pub fn extract(bytes: &[u8]) -> Option<Metadata> {
    if bytes.starts_with(b"\x89PNG") {
        extract_png(bytes, LARGEST)
    } else if bytes.starts_with(b"%PDF") {
        extract_pdf(bytes, LARGEST)
    } else {
        extract_xml(std::str::from_utf8(bytes).ok()?)
    }
}

fn extract_png(bytes: &[u8], largest: usize) -> Option<Metadata> {
    let limits = ::png::Limits { bytes: largest };
    let mut reader = ::png::Decoder::new_with_limits(Cursor::new(bytes), limits).read_info().ok()?;
    if let Some(found) = in_chunks(reader.info(), largest) {
        return Some(found);
    }
    // Programs that rewrite a picture may move the chunk behind the image.
    reader.finish().ok()?;
    in_chunks(reader.info(), largest)
}

fn in_chunks(info: &::png::Info<'_>, largest: usize) -> Option<Metadata> {
    info.utf8_text.iter().filter(|chunk| chunk.keyword == KEYWORD).find_map(|chunk| {
        let mut chunk = chunk.clone();
        chunk.decompress_text_with_limit(largest).ok()?;
        Metadata::from_json(&chunk.get_text().ok()?)
    })
}

/// XMP packets are there to be found by looking for them.
fn extract_pdf(bytes: &[u8], largest: usize) -> Option<Metadata> {
    let mut rest = bytes;
    loop {
        rest = &rest[find(rest, XMP_START)?..];
        let (packet, after) = rest.split_at(find(rest, XMP_END)? + XMP_END.len());
        let text = std::str::from_utf8(packet).ok().filter(|text| text.len() <= largest);
        if let Some(found) = text.and_then(extract_xml) {
            return Some(found);
        }
        rest = after;
    }
}

/// Where a word first stands.
fn find(bytes: &[u8], word: &str) -> Option<usize> {
    bytes.windows(word.len()).position(|window| window == word.as_bytes())
}

fn extract_xml(text: &str) -> Option<Metadata> {
    // A picture without the name space is told apart without reading all of it as XML.
    if !text.contains(NAMESPACE) {
        return None;
    }
    let options = roxmltree::ParsingOptions { allow_dtd: false, nodes_limit: MOST_NODES, ..Default::default() };
    let document = roxmltree::Document::parse_with_options(text.trim_start_matches('\u{feff}'), options).ok()?;
    let element = document.descendants().find(|node| node.has_tag_name((NAMESPACE, ELEMENT)))?;
    let json: String = element.children().filter(|child| child.is_text()).filter_map(|child| child.text()).collect();
    Metadata::from_json(&json)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use proptest::collection::{btree_map, vec};
    use proptest::prelude::*;

    use super::super::samples::scattered;
    use super::super::{pdf, png, svg};
    use super::*;

    /// A picture of each kind that carries the metadata.
    fn pictures(metadata: &Metadata) -> [Vec<u8>; 3] {
        pictures_of(Some(metadata))
    }

    fn pictures_of(metadata: Option<&Metadata>) -> [Vec<u8>; 3] {
        let drawing = scattered(4.0, 4.0, 5);
        let (mut vector, mut raster, mut print) = (Vec::new(), Vec::new(), Vec::new());
        svg::write(&drawing, metadata, &mut vector).unwrap();
        png::write(&drawing, metadata, &mut raster).unwrap();
        pdf::write(&drawing, metadata, &mut print).unwrap();
        [vector, raster, print]
    }

    fn sample() -> Metadata {
        Metadata {
            version: "0.1.0".to_owned(),
            seed: u64::MAX,
            scene: "scene.kake".to_owned(),
            params: [("pen".to_owned(), "0.1mm".to_owned())].into(),
            options: [("dpi".to_owned(), "600.1".to_owned())].into(),
            sources: vec![("scene.kake".to_owned(), "// ]]> </metadata> \"&lt;\" \r\n\t\u{fffe}\0 影\n".to_owned())],
            dependencies: [("ink/base".to_owned(), "base".to_owned())].into(),
            files: vec![("photo.png".to_owned(), (0..=255).collect())],
        }
    }

    #[test]
    fn nothing_in_pictures_without_it() {
        assert_eq!(pictures_of(None).map(|picture| extract(&picture)), [None, None, None]);
        assert_eq!(extract(b""), None);
    }

    #[test]
    fn chunk_behind_the_image_is_found() {
        let [_, mut png, _] = pictures(&sample());
        // The chunks: a length, a name, the data and a checksum each.
        let chunk_at = png.windows(4).position(|name| name == b"iTXt").unwrap() - 4;
        let length = u32::from_be_bytes(png[chunk_at..chunk_at + 4].try_into().unwrap()) as usize + 12;
        let chunk: Vec<u8> = png.drain(chunk_at..chunk_at + length).collect();
        let end = png.len() - 12;
        png.splice(end..end, chunk);
        assert_eq!(extract(&png), Some(sample()));
    }

    #[test]
    fn an_editor_may_rewrite_the_svg() {
        let [svg, ..] = pictures(&sample());
        let text = String::from_utf8(svg)
            .unwrap()
            .replace("<kakeami:", "<other:")
            .replace("</kakeami:", "</other:")
            .replace(":kakeami=", ":other=");
        let text = format!("\u{feff}<?xml version=\"1.0\"?>\n<!-- edited -->\n{text}");
        assert_eq!(extract(text.as_bytes()), Some(sample()));
    }

    #[test]
    fn a_bomb_is_not_unpacked() {
        let [_, png, _] = pictures(&Metadata { scene: "a".repeat(1 << 16), ..sample() });
        assert!(png.len() < 1 << 14);
        assert_eq!(extract_png(&png, 1 << 16), None);
        assert!(extract_png(&png, 1 << 17).is_some());
    }

    #[test]
    fn hostile_xml_is_refused() {
        let entities = format!(
            "<!DOCTYPE svg [<!ENTITY a \"{0}\"><!ENTITY b \"{1}\">]><svg xmlns:k=\"{NAMESPACE}\"><k:picture>{2}</k:picture></svg>",
            "a".repeat(100),
            "&a;".repeat(100),
            "&b;".repeat(100)
        );
        assert_eq!(extract(entities.as_bytes()), None);
        let deep = format!("<svg xmlns:k=\"{NAMESPACE}\">{}", "<g>".repeat(100_000));
        assert_eq!(extract(deep.as_bytes()), None);
        let deep = format!("<svg xmlns:k=\"{NAMESPACE}\">{}{}</svg>", "<g>".repeat(100_000), "</g>".repeat(100_000));
        assert_eq!(extract(deep.as_bytes()), None);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn comes_back_as_it_was(
            seed: u64,
            params in btree_map(any::<String>(), any::<String>(), 0..4),
            sources in vec((any::<String>(), any::<String>()), 0..4),
            files in vec((any::<String>(), vec(any::<u8>(), 0..50)), 0..3),
        ) {
            let metadata = Metadata { seed, params: params.clone(), options: params, sources, files, ..sample() };
            for picture in pictures(&metadata) {
                prop_assert_eq!(extract(&picture), Some(metadata.clone()));
            }
        }

        #[test]
        fn damage_is_survived(damages in vec((any::<prop::sample::Index>(), any::<u8>(), 0..3usize), 1..20)) {
            for mut picture in pictures(&sample()) {
                for (at, byte, kind) in &damages {
                    let at = at.index(picture.len());
                    match kind {
                        0 => picture[at] = *byte,
                        1 => picture.insert(at, *byte),
                        _ => {
                            picture.remove(at);
                        }
                    }
                }
                // Whether anything is found depends on the damage.
                let _ = extract(&picture);
            }
        }

        #[test]
        fn a_part_is_survived(share in 0.0..1.0f64) {
            for picture in pictures(&sample()) {
                let _ = extract(&picture[..(picture.len() as f64 * share) as usize]);
            }
        }
    }
}
