//! The text of an SVG file as elements: checks its depth and finds out which elements have which id, layer and class.
//!
//! What draws the file knows ids only, so elements that can be selected otherwise but have none are given one.

use std::collections::{BTreeMap, BTreeSet};

use usvg::roxmltree::{Document, Error, Node, ParsingOptions};

use super::{Lack, SvgError};

/// How deep elements may be nested.
const DEEPEST: usize = 256;

/// How many elements, pieces of text and comments a file may have.
const MOST_NODES: u32 = 1_000_000;

const INKSCAPE: &str = "http://www.inkscape.org/namespaces/inkscape";

/// Names, and the ids of the elements that have them.
pub(super) type Names = BTreeMap<String, Vec<String>>;

/// What is known about the elements of a file.
#[derive(Debug, Default)]
pub(super) struct Elements {
    /// Every id of the file, which stands for itself, and in the root's case for the whole.
    pub(super) ids: Vec<String>,
    pub(super) root: Option<String>,
    pub(super) layers: Names,
    pub(super) classes: Names,
    /// The kinds of element that are not drawn, as far as the file has any.
    pub(super) unread: BTreeSet<Lack>,
    /// Places in the text and the ids to be put there, in order.
    missing: Vec<(usize, String)>,
}

/// Parses the text of a file. Entities are expanded within limits; nothing outside the text is read.
pub(super) fn parse(text: &str) -> Result<Document<'_>, SvgError> {
    let options = ParsingOptions { allow_dtd: true, nodes_limit: MOST_NODES, ..ParsingOptions::default() };
    Document::parse_with_options(text, options).map_err(explain)
}

pub(super) fn explain(error: Error) -> SvgError {
    match error {
        Error::NodesLimitReached => SvgError::TooLarge,
        other => SvgError::Unreadable(other.to_string()),
    }
}

/// Looks through all elements.
pub(super) fn elements(document: &Document<'_>, text: &str) -> Result<Elements, SvgError> {
    let mut elements = Elements::default();
    // Ids that are made up begin as no id of the file does.
    let mut prefix = String::from("kake-");
    while document.descendants().any(|node| node.attribute("id").is_some_and(|id| id.starts_with(&prefix))) {
        prefix.push('-');
    }
    let mut depth = 0usize;
    let mut next = Some(document.root());
    while let Some(node) = next {
        if depth > DEEPEST {
            return Err(SvgError::TooDeep { most: DEEPEST });
        }
        if node.is_element() {
            elements.note(node, text, &prefix);
        }
        // On to the first child, else the next sibling, else that of the nearest ancestor that has one.
        next = node.first_child();
        if next.is_some() {
            depth += 1;
            continue;
        }
        let mut at = Some(node);
        while let Some(node) = at {
            next = node.next_sibling();
            if next.is_some() {
                break;
            }
            at = node.parent();
            depth = depth.saturating_sub(1);
        }
    }
    let root = document.root_element();
    elements.root = root.attribute("id").map(str::to_owned);
    Ok(elements)
}

impl Elements {
    fn note(&mut self, node: Node<'_, '_>, text: &str, prefix: &str) {
        match node.tag_name().name() {
            "image" => drop(self.unread.insert(Lack::Picture)),
            "text" => drop(self.unread.insert(Lack::Text)),
            _ => {}
        }
        let is_layer = node.attribute((INKSCAPE, "groupmode")) == Some("layer");
        let layer = node.attribute((INKSCAPE, "label")).filter(|_| is_layer);
        let classes = node.attribute("class").unwrap_or_default();
        let id = match node.attribute("id") {
            Some(id) => {
                self.ids.push(id.to_owned());
                id.to_owned()
            }
            None if layer.is_some() || !classes.trim().is_empty() => {
                let made_up = format!("{prefix}{}", self.missing.len());
                let Some(place) = after_name(text, node.range().start) else { return };
                self.missing.push((place, made_up.clone()));
                made_up
            }
            None => return,
        };
        if let Some(layer) = layer {
            self.layers.entry(layer.to_owned()).or_default().push(id.clone());
        }
        for class in classes.split_whitespace() {
            self.classes.entry(class.to_owned()).or_default().push(id.clone());
        }
    }

    /// The text with the ids that were missing.
    pub(super) fn completed(&self, text: &str) -> Option<String> {
        if self.missing.is_empty() {
            return None;
        }
        let mut out = String::with_capacity(text.len() + self.missing.len() * 24);
        let mut end = 0;
        for (place, id) in &self.missing {
            // An element out of an expanded entity may stand anywhere; only the first place of each is of use.
            let Some(piece) = text.get(end..*place) else { continue };
            out.push_str(piece);
            out.push_str(&format!(" id=\"{id}\""));
            end = *place;
        }
        out.push_str(text.get(end..).unwrap_or_default());
        Some(out)
    }
}

/// The end of a tag's name, where attributes may be put.
fn after_name(text: &str, start: usize) -> Option<usize> {
    let tag = text.get(start..)?.strip_prefix('<')?;
    let length = tag.find(|c: char| c.is_whitespace() || c == '/' || c == '>')?;
    Some(start + 1 + length)
}
