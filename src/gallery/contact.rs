//! The contact sheet of a gallery: tones that are shown in steps have a row each, all others stand side by side.

use crate::drawing::Drawing;
use crate::geom::Length;
use crate::sheet::{Grid, Holds, Row, Scale, Sheet, Slot};

use super::{Lacking, Module};

/// The longest side of a picture on the sheet.
const SIDE: Length = Length::mm(48.0);

/// Pictures side by side where there is no longer series.
const COLUMNS: usize = 4;

/// What a tone's doc comment says on the sheet: its first sentence, up to so many characters.
const LONGEST: usize = 140;

/// The sheet of a gallery, with its pictures in the order of its places.
#[must_use]
pub fn contact<'a>(title: &str, modules: &'a [Module]) -> (Sheet, Vec<&'a Drawing>) {
    let longest = modules.iter().flat_map(|module| &module.tones).map(|tone| tone.swatches.len()).max().unwrap_or(0);
    let columns = longest.max(COLUMNS);
    let (mut rows, mut pictures) = (Vec::new(), Vec::new());
    for module in modules.iter().filter(|module| !module.tones.is_empty()) {
        let first = rows.len();
        let mut alone = Side::default();
        for tone in &module.tones {
            if tone.is_series {
                let label = std::iter::once(tone.name.clone()).chain(tone.doc.as_deref().map(summary)).collect();
                let mut side = Side::default();
                for shown in &tone.swatches {
                    side.push(&tone.name, &shown.label, shown.picture.as_ref());
                }
                rows.push(Row { heading: None, label, slots: side.slots });
                pictures.extend(side.pictures);
            } else {
                for shown in &tone.swatches {
                    alone.push(&tone.name, &tone.name, shown.picture.as_ref());
                }
            }
        }
        if let Some(scene) = &module.scene {
            alone.push(&module.path, &module.path, scene.picture.as_ref());
        }
        rows.extend(alone.rows(columns));
        pictures.extend(alone.pictures);
        // One file alone is what the title says.
        if let Some(row) = rows.get_mut(first).filter(|_| module.path != title) {
            row.heading = Some(module.path.clone());
        }
    }
    let mut scenes = Side::default();
    for module in modules.iter().filter(|module| module.tones.is_empty()) {
        if let Some(scene) = &module.scene {
            scenes.push(&module.path, &module.path, scene.picture.as_ref());
        }
    }
    let first = rows.len();
    rows.extend(scenes.rows(columns));
    pictures.extend(scenes.pictures);
    if let Some(row) = rows.get_mut(first).filter(|_| first > 0) {
        row.heading = Some("Scenes".to_owned());
    }
    (Sheet::new(&Grid { title: title.to_owned(), rows, scale: Scale::Each, side: SIDE, ..Grid::default() }), pictures)
}

/// Pictures side by side.
#[derive(Default)]
struct Side<'a> {
    slots: Vec<Slot>,
    pictures: Vec<&'a Drawing>,
}

impl<'a> Side<'a> {
    fn push(&mut self, name: &str, caption: &str, picture: Result<&'a Drawing, &Lacking>) {
        self.slots.push(slot(name, caption.to_owned(), picture));
        self.pictures.extend(picture.ok());
    }

    fn rows(&self, columns: usize) -> impl Iterator<Item = Row> {
        self.slots.chunks(columns).map(|slots| Row { slots: slots.to_vec(), ..Row::default() })
    }
}

fn slot(name: &str, caption: String, picture: Result<&Drawing, &Lacking>) -> Slot {
    let holds = match picture {
        Ok(drawing) => Holds::Picture([drawing.page.width, drawing.page.height]),
        Err(why) => Holds::Words(why.to_string()),
    };
    Slot { name: name.to_owned(), caption: vec![caption], holds }
}

/// The first sentence of a doc comment.
pub(super) fn summary(doc: &str) -> String {
    let text = doc.split_whitespace().collect::<Vec<_>>().join(" ").replace('`', "");
    let end = text.find(". ").map_or(text.len(), |end| end + 1);
    text.chars().take(end.min(LONGEST)).collect()
}
