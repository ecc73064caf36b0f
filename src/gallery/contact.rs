//! The contact sheet of a gallery: tones that are shown in steps have a row each, all others stand side by side.

use crate::drawing::Drawing;
use crate::geom::Length;
use crate::sheet::{Grid, Holds, Row, Scale, Sheet, Slot};

use super::{Lacking, Module, Shown};

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
    let mut rows = Vec::new();
    let mut pictures = Vec::new();
    for module in modules {
        let first = rows.len();
        let mut single: Vec<Slot> = Vec::new();
        let mut alone: Vec<&Drawing> = Vec::new();
        for tone in &module.tones {
            let slot = |shown: &Shown, caption: String| slot(&tone.name, caption, shown.picture.as_ref());
            if tone.is_series {
                let label = std::iter::once(tone.name.clone()).chain(tone.doc.as_deref().map(summary)).collect();
                let slots = tone.swatches.iter().map(|shown| slot(shown, shown.label.clone())).collect();
                rows.push(Row { heading: None, label, slots });
                pictures.extend(tone.swatches.iter().filter_map(|shown| shown.picture.as_ref().ok()));
            } else {
                single.extend(tone.swatches.iter().map(|shown| slot(shown, tone.name.clone())));
                alone.extend(tone.swatches.iter().filter_map(|shown| shown.picture.as_ref().ok()));
            }
        }
        if let Some(scene) = &module.scene {
            single.push(slot(&module.path, module.path.clone(), scene.picture.as_ref()));
            alone.extend(scene.picture.as_ref().ok());
        }
        rows.extend(single.chunks(columns).map(|slots| Row { slots: slots.to_vec(), ..Row::default() }));
        pictures.extend(alone);
        if let Some(row) = rows.get_mut(first) {
            // A scene alone is called by its caption.
            row.heading = (!module.tones.is_empty()).then(|| module.path.clone());
        }
    }
    let rows = together(rows, columns);
    (Sheet::new(&Grid { title: title.to_owned(), rows, scale: Scale::Each, side: SIDE, ..Grid::default() }), pictures)
}

/// Rows without heading or label, one after the other, as few as they need be.
fn together(rows: Vec<Row>, columns: usize) -> Vec<Row> {
    let mut joined: Vec<Row> = Vec::new();
    let is_plain = |row: &Row| row.heading.is_none() && row.label.is_empty();
    let mut follows = false;
    for mut row in rows {
        let plain = is_plain(&row);
        if let Some(last) = joined.last_mut().filter(|_| plain && follows) {
            let room = columns.saturating_sub(last.slots.len()).min(row.slots.len());
            last.slots.extend(row.slots.drain(..room));
        }
        if !row.slots.is_empty() || !plain {
            joined.push(row);
        }
        follows = plain;
    }
    joined
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
