//! PDF: a drawing goes in, a page of strokes and filled outlines comes out, as a print shop wants it.
//!
//! The page is as large as the drawing with its bleed; the trim box is the sheet. Groups and paints are optional content,
//! which readers show as layers that can be switched off. There are no clip paths, fonts or pictures, and nothing that
//! depends on time or machine. A translucent layer is a transparency group, so that it is one ink where its strokes cross,
//! as in the other formats. The compressed page is held in memory once.

mod content;

use std::io::{self, Write};

use pdf_writer::types::LineJoinStyle;
use pdf_writer::{Array, Content, Filter, Finish, Name, Pdf, Rect, Ref, TextStr};

use self::content::{Cut, Streams, set_ink};
use super::metadata::Metadata;
use super::pieces;
use crate::drawing::{Drawing, Layer, Page};
use crate::geom::{Length, Point};
use crate::scene::Colour;
use crate::sheet::Sheet;

/// Points in a millimetre.
const PER_MM: f64 = 72.0 / Length::MM_PER_INCH;
/// The longest side of a page in its units: readers refuse longer ones (ISO 32000-1, annex C).
const LONGEST_SIDE: f64 = 14_400.0;
/// Layers nested deeper are shown as if they lay this deep.
const DEEPEST: usize = 32;

/// Writes a PDF.
///
/// # Errors
/// What `out` answers.
pub fn write(drawing: &Drawing, metadata: Option<&Metadata>, out: &mut dyn Write) -> io::Result<()> {
    let mut document = Document::new(&drawing.page);
    let content = document.content(drawing)?;
    out.write_all(&document.finish(content, metadata)?)?;
    out.flush()
}

/// Writes a contact sheet with its pictures, one for each place: those that are missing stay white. What is written on it
/// is filled outlines. Pictures are forms, which show no more than their own page.
///
/// # Errors
/// What `out` answers.
pub fn write_sheet(sheet: &Sheet, pictures: &[Option<Drawing>], out: &mut dyn Write) -> io::Result<()> {
    let mut document = Document::new(&sheet.page);
    let content = document.sheet(sheet, pictures)?;
    out.write_all(&document.finish(content, None)?)?;
    out.flush()
}

/// Something optional: a group or a paint.
struct Entry {
    id: Ref,
    name: String,
    /// How many groups it lies in.
    depth: usize,
}

/// What a page refers to by name.
#[derive(Default)]
struct Resources {
    /// Transparency groups.
    forms: Vec<Ref>,
    /// Degrees of transparency from 1 to 254, ascending.
    alphas: Vec<u8>,
}

struct Document<'a> {
    page: &'a Page,
    pdf: Pdf,
    next: Ref,
    entries: Vec<Entry>,
    resources: Resources,
}

impl<'a> Document<'a> {
    fn new(page: &'a Page) -> Self {
        let (entries, resources) = (Vec::new(), Resources::default());
        Self { page, pdf: Pdf::new(), next: Ref::new(1), entries, resources }
    }

    /// How many millimetres the page is wide and high with its bleed.
    fn size(&self) -> [f64; 2] {
        [self.page.width, self.page.height].map(|side| side.to_mm() + 2.0 * self.page.bleed.to_mm())
    }

    /// How many points a unit of the page has: 1 but for huge pages.
    fn unit(&self) -> f64 {
        let [width, height] = self.size();
        (width.max(height) * PER_MM / LONGEST_SIDE).ceil().max(1.0)
    }

    /// The page's drawing as compressed streams.
    fn content(&mut self, drawing: &Drawing) -> io::Result<Vec<Ref>> {
        let mut streams = Streams::new(Cut::Anywhere);
        streams.push(&self.start());
        if let Some(paper) = self.page.paper {
            streams.push(&self.paper(paper));
        }
        let together = pieces::together(drawing);
        // The groups that are open, outermost first, and whether each is a paint's: a group may have the same name.
        let mut open: Vec<(&str, bool)> = Vec::new();
        for layer in drawing.layers.iter().filter(|layer| layer.marks() > 0) {
            let groups = layer.groups.iter().map(|name| (name.as_str(), false));
            let names: Vec<(&str, bool)> = groups.chain([(layer.name.as_str(), true)]).collect();
            let shared = open.iter().zip(&names).take_while(|(a, b)| a == b).count();
            streams.push(&"EMC\n".repeat(open.len() - shared));
            open.truncate(shared);
            for &(name, paint) in &names[shared..] {
                streams.push(&format!("/OC /L{} BDC\n", self.entries.len()));
                let entry = Entry { id: self.next.bump(), name: name.to_owned(), depth: open.len() };
                self.entries.push(entry);
                open.push((name, paint));
            }
            if layer.ink.a == 255 {
                streams.push(&set_ink(layer.ink));
                streams.layer(layer, together)?;
            } else {
                self.translucent(layer, together, &mut streams)?;
            }
        }
        streams.push(&"EMC\n".repeat(open.len()));
        let add = |stream: Vec<u8>| {
            let id = self.next.bump();
            self.pdf.stream(id, &stream).filter(Filter::FlateDecode);
            id
        };
        Ok(streams.finish()?.into_iter().map(add).collect())
    }

    /// A sheet's drawing as compressed streams.
    fn sheet(&mut self, sheet: &Sheet, pictures: &[Option<Drawing>]) -> io::Result<Vec<Ref>> {
        let mut streams = Streams::new(Cut::Anywhere);
        streams.push(&self.start());
        if let Some(paper) = self.page.paper {
            streams.push(&self.paper(paper));
        }
        for (place, picture) in sheet.places.iter().zip(pictures) {
            let Some(picture) = picture else { continue };
            let scale = place.area.width() / picture.page.width.to_mm();
            let [x, y] = [place.area.min.x, place.area.min.y].map(super::number::text);
            streams.push(&format!("q {scale:.6} 0 0 {scale:.6} {x} {y} cm\n"));
            self.form(picture, &mut streams)?;
            streams.push("Q\n");
        }
        for layer in std::iter::once(sheet.frame_layer()).chain(sheet.text_layers()) {
            streams.push(&set_ink(layer.ink));
            streams.layer(&layer, 1)?;
        }
        let add = |stream: Vec<u8>| {
            let id = self.next.bump();
            self.pdf.stream(id, &stream).filter(Filter::FlateDecode);
            id
        };
        Ok(streams.finish()?.into_iter().map(add).collect())
    }

    /// Draws a whole picture as a form of the page.
    fn form(&mut self, picture: &Drawing, page: &mut Streams) -> io::Result<()> {
        let mut streams = Streams::new(Cut::Nowhere);
        // A line width is no part of what a form begins with; joins are.
        streams.push("1 j\n");
        let [width, height] = [picture.page.width, picture.page.height].map(Length::to_mm);
        // Translucent layers are forms of their own, and lie on the page: a form has no resources here.
        let paper = picture.page.paper.map(|paper| Layer {
            areas: vec![vec![rectangle(width, height)]],
            ..Layer::new(Vec::new(), String::new(), paper)
        });
        let together = pieces::together(picture);
        let bounds = Rect::new(0.0, 0.0, width as f32, height as f32);
        for layer in paper.iter().chain(&picture.layers).filter(|layer| layer.marks() > 0) {
            if layer.ink.a == 255 {
                streams.push(&set_ink(layer.ink));
                streams.layer(layer, together)?;
                continue;
            }
            let opaque = std::mem::replace(&mut streams, Streams::new(Cut::Nowhere));
            self.use_form(opaque, bounds, page)?;
            streams.push("1 j\n");
            let mut translucent = Streams::new(Cut::Nowhere);
            translucent.push("1 j\n");
            translucent.push(&set_ink(layer.ink));
            translucent.layer(layer, together)?;
            page.push(&format!("q /A{} gs\n", self.alpha(layer.ink.a)));
            self.use_form(translucent, bounds, page)?;
            page.push("Q\n");
        }
        self.use_form(streams, bounds, page)
    }

    /// Makes a transparency group of content and draws it.
    fn use_form(&mut self, content: Streams, bounds: Rect, page: &mut Streams) -> io::Result<()> {
        let content = content.finish()?.concat();
        let id = self.next.bump();
        page.push(&format!("/F{} Do\n", self.resources.forms.len()));
        self.resources.forms.push(id);
        self.group(id, &content, bounds);
        Ok(())
    }

    /// Makes the page's units millimetres from the trimmed sheet's top left corner, downwards.
    fn start(&self) -> String {
        let scale = PER_MM / self.unit();
        let (bleed, height) = (self.page.bleed.to_mm(), self.page.height.to_mm());
        let mut content = Content::new();
        let offset = [bleed * scale, (bleed + height) * scale].map(|offset| offset as f32);
        content.transform([scale as f32, 0.0, 0.0, -scale as f32, offset[0], offset[1]]);
        content.set_line_join(LineJoinStyle::RoundJoin);
        let mut text = String::from_utf8_lossy(content.finish().as_slice()).into_owned();
        text.push('\n');
        text
    }

    /// Fills the whole page.
    fn paper(&mut self, paper: Colour) -> String {
        let (bleed, [width, height]) = (self.page.bleed.to_mm(), self.size());
        let [corner, width, height] = [-bleed, width, height].map(super::number::text);
        let sheet = format!("{}{corner} {corner} {width} {height} re f\n", set_ink(paper));
        if paper.a == 255 { sheet } else { format!("q /A{} gs {sheet}Q\n", self.alpha(paper.a)) }
    }

    /// A degree of transparency as something to refer to.
    fn alpha(&mut self, alpha: u8) -> u8 {
        if let Err(place) = self.resources.alphas.binary_search(&alpha) {
            self.resources.alphas.insert(place, alpha);
        }
        alpha
    }

    /// Draws a layer in opaque ink as a group of its own, and makes the whole group translucent.
    fn translucent(&mut self, layer: &Layer, together: usize, page: &mut Streams) -> io::Result<()> {
        let mut streams = Streams::new(Cut::Nowhere);
        streams.push(&set_ink(layer.ink));
        streams.layer(layer, together)?;
        page.push(&format!("q /A{} gs\n", self.alpha(layer.ink.a)));
        let bounds = self.bounds();
        let content = streams.finish()?.concat();
        let group = self.next.bump();
        page.push(&format!("/F{} Do Q\n", self.resources.forms.len()));
        self.resources.forms.push(group);
        self.group(group, &content, bounds);
        Ok(())
    }

    /// Writes a transparency group.
    fn group(&mut self, id: Ref, content: &[u8], bounds: Rect) {
        let mut form = self.pdf.form_xobject(id, content);
        form.bbox(bounds).filter(Filter::FlateDecode);
        form.group().transparency();
        form.resources();
    }

    /// The page with its bleed, in millimetres.
    fn bounds(&self) -> Rect {
        let (bleed, page) = (self.page.bleed.to_mm(), self.page);
        let [right, bottom] = [page.width, page.height].map(|side| (side.to_mm() + bleed) as f32);
        Rect::new(-bleed as f32, -bleed as f32, right, bottom)
    }

    /// The whole file.
    fn finish(mut self, content: Vec<Ref>, metadata: Option<&Metadata>) -> io::Result<Vec<u8>> {
        let (pages, page) = (self.next.bump(), self.next.bump());
        let packet = match metadata {
            Some(metadata) => {
                let id = self.next.bump();
                self.pdf.metadata(id, metadata.to_xmp()?.as_bytes());
                let mut info = self.pdf.document_info(self.next.bump());
                info.title(TextStr(&metadata.scene));
                info.producer(TextStr(&format!("kake {}", metadata.version)));
                Some(id)
            }
            None => None,
        };
        let mut catalog = self.pdf.catalog(self.next.bump());
        catalog.pages(pages);
        if let Some(packet) = packet {
            catalog.metadata(packet);
        }
        if !self.entries.is_empty() {
            let mut optional = catalog.insert(Name(b"OCProperties")).dict();
            optional.insert(Name(b"OCGs")).array().items(self.entries.iter().map(|entry| entry.id));
            let mut usual = optional.insert(Name(b"D")).dict();
            order(&self.entries, 0, &mut usual.insert(Name(b"Order")).array());
        }
        catalog.finish();
        for entry in &self.entries {
            let mut group = self.pdf.indirect(entry.id).dict();
            group.pair(Name(b"Type"), Name(b"OCG"));
            group.pair(Name(b"Name"), TextStr(&entry.name));
        }
        self.pdf.pages(pages).kids([page]).count(1);
        self.page(pages, page, content);
        Ok(self.pdf.finish())
    }

    fn page(&mut self, pages: Ref, id: Ref, content: Vec<Ref>) {
        let ([width, height], unit) = (self.size(), self.unit());
        let bleed = self.page.bleed.to_mm();
        let around = |inset: f64| {
            let [left, right, top] = [inset, width - inset, height - inset].map(|mm| (mm * PER_MM / unit) as f32);
            Rect::new(left, left, right, top)
        };
        let mut page = self.pdf.page(id);
        page.parent(pages).media_box(around(0.0)).bleed_box(around(0.0)).trim_box(around(bleed));
        if unit > 1.0 {
            page.user_unit(unit as f32);
        }
        page.contents_array(content);
        let mut resources = page.resources();
        if !self.entries.is_empty() {
            let mut properties = resources.insert(Name(b"Properties")).dict();
            for (i, entry) in self.entries.iter().enumerate() {
                properties.pair(Name(format!("L{i}").as_bytes()), entry.id);
            }
        }
        if !self.resources.alphas.is_empty() {
            let mut states = resources.ext_g_states();
            for alpha in &self.resources.alphas {
                let mut state = states.insert(Name(format!("A{alpha}").as_bytes())).dict();
                state.pair(Name(b"ca"), f32::from(*alpha) / 255.0);
            }
        }
        if !self.resources.forms.is_empty() {
            let mut forms = resources.x_objects();
            for (i, form) in self.resources.forms.iter().enumerate() {
                forms.pair(Name(format!("F{i}").as_bytes()), *form);
            }
        }
    }
}

/// The outline of a page of so many millimetres.
fn rectangle(width: f64, height: f64) -> Vec<Point> {
    crate::geom::Rect::new(Point::new(0.0, 0.0), Point::new(width, height)).corners().to_vec()
}

/// Lists entries as a reader shows them: what lies in a group is a list after it.
fn order(entries: &[Entry], depth: usize, list: &mut Array<'_>) {
    let mut rest = entries;
    while let Some((entry, after)) = rest.split_first() {
        list.item(entry.id);
        let inside = after.iter().take_while(|other| other.depth > depth).count();
        let (inside, others) = after.split_at(inside);
        if depth < DEEPEST && !inside.is_empty() {
            order(inside, depth + 1, &mut list.push().array());
            rest = others;
        } else {
            rest = after;
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, clippy::panic)]
mod tests;
