//! Galleries show every tone, and say why where they cannot.

use super::*;
use crate::loader::MemoryLoader;

const TONES: &str = "// Tones for a test.
// Two lines.

/// Squares. And more.
tone squares(
  k: field = 1,
  /// The side of a square.
  tile: length = 5mm,
) {
  place: poisson(radius: tile / 1.6)
  shape: rect(size: tile)
  fill: lines(pitch: 1mm, pen: 0.2mm)
  k: k
}

tone two = squares(k: 2) with {}

tone share(darkness: field) {
  place: hex(spacing: 3mm)
  shape: hexagon()
  fill: lines(pitch: 0.5mm, pen: 0.2mm)
  darkness: darkness
}

tone around(center: point, radius: length, across: region, shade: colour = #000000) = squares(
  k: radial(center: center, radius: radius, start: 0, end: 4),
) with { fill: lines(pitch: 1mm, pen: 0.2mm, ink: shade) }

tone named(word: string) = squares() with { k: if word == \"a\" then 1 else 2 }
";

fn module(text: &str, over: Over) -> Module {
    let mut loader = MemoryLoader::default();
    loader.files.insert("tones/ink.kake".to_owned(), text.as_bytes().into());
    survey("tones/ink.kake", &loader, &GalleryConfig { lower: LowerConfig::default(), over })
}

fn labels(tone: &Tone) -> Vec<&str> {
    tone.swatches.iter().map(|shown| shown.label.as_str()).collect()
}

#[test]
fn tones_are_shown_in_steps_where_they_have_any() {
    let module = module(TONES, Over::Layers(1, 3));
    assert_eq!(module.faults, None);
    assert_eq!(module.intro.as_deref(), Some("Tones for a test.\nTwo lines."));
    let names: Vec<&str> = module.tones.iter().map(|tone| tone.name.as_str()).collect();
    assert_eq!(names, ["squares", "two", "share", "around", "named"]);
    let [squares, two, share, around, named] = module.tones.as_slice() else { return };
    assert_eq!(labels(squares), ["k = 1", "k = 2", "k = 3"]);
    assert_eq!(squares.doc.as_deref(), Some("Squares. And more."));
    let tile = Parameter {
        name: "tile".to_owned(),
        ty: Some("length".to_owned()),
        default: Some("5mm".to_owned()),
        doc: Some("The side of a square.".to_owned()),
    };
    assert_eq!(squares.params[1], tile);
    assert_eq!((labels(two), two.is_series), (vec![""], false));
    assert_eq!(labels(share), ["darkness = 0.333", "darkness = 0.667", "darkness = 1"]);
    assert!(around.swatches[0].call.starts_with("around(center: ("), "{}", around.swatches[0].call);
    for tone in [squares, two, share, around] {
        for shown in &tone.swatches {
            let marks = |drawing: &Drawing| drawing.layers.iter().map(crate::drawing::Layer::marks).sum::<u64>();
            assert!(shown.picture.as_ref().is_ok_and(|drawing| marks(drawing) > 20), "{} {:?}", tone.name, shown.label);
        }
    }
    assert!(matches!(&named.swatches[0].picture, Err(Lacking::Value(why)) if why.contains("`word`")));
}

#[test]
fn a_parameter_is_shown_over_its_values() {
    let module = module(TONES, Over::Param("tile".to_owned(), vec!["3mm".to_owned(), "6mm".to_owned()]));
    let [squares, two, ..] = module.tones.as_slice() else { return };
    assert_eq!(labels(squares), ["tile = 3mm", "tile = 6mm"]);
    let widths: Vec<Length> =
        squares.swatches.iter().flat_map(|shown| &shown.picture).map(|drawing| drawing.page.width).collect();
    // Both show as much, so that the larger tiles are larger.
    assert_eq!(widths.len(), 2);
    assert_eq!(widths[0], widths[1]);
    assert_eq!(labels(two), [""]);
}

#[test]
fn a_broken_file_still_says_what_it_declares() {
    let module = module(&TONES.replace("poisson(radius: tile / 1.6)", "poison(tile)"), Over::Layers(1, 4));
    assert!(module.faults.is_some_and(|faults| faults.contains("poison")));
    assert_eq!(module.tones.len(), 5);
    assert!(module.tones[0].swatches.iter().all(|shown| matches!(shown.picture, Err(Lacking::Fault(_)))));
}

#[test]
fn a_standard_library_is_surveyed_too() {
    let config = GalleryConfig { lower: LowerConfig::default(), over: Over::Layers(1, 1) };
    let module = survey("std:manga", &MemoryLoader::default(), &config);
    assert_eq!(module.faults, None);
    assert!(module.tones.len() > 10);
    for tone in &module.tones {
        assert!(tone.swatches.iter().all(|shown| shown.picture.is_ok()), "{}", tone.name);
    }
}

#[test]
fn the_page_escapes_what_strangers_wrote() {
    let text = TONES.replace("Squares. And more.", "<script>alert(1)</script> & `code <b>`");
    let modules = [module(&text, Over::Layers(1, 1))];
    let pictures = [vec![Some("pictures/a b#1.svg".to_owned())]];
    let written = page(&Page {
        title: "<i>T</i>",
        about: None,
        library: Some("inks"),
        sheet: Some("gallery.png"),
        modules: &modules,
        pictures: &pictures,
    });
    assert!(!written.contains("<script>") && !written.contains("<i>T"));
    assert!(written.contains("<code>code &lt;b&gt;</code>"));
    assert!(written.contains("import &quot;inks:tones/ink.kake&quot;"));
    assert!(written.contains("src=\"pictures/a%20b%231.svg\""));
    assert!(!written.contains("http"));
}

#[test]
fn tones_without_steps_stand_side_by_side_on_the_sheet() {
    let modules = [module(TONES, Over::Layers(1, 4))];
    let (sheet, pictures) = contact("test", &modules);
    assert_eq!(sheet.places.len(), pictures.len());
    // The pictures have the proportions of their places.
    for (place, picture) in sheet.places.iter().zip(pictures) {
        let wanted = picture.page.width.to_mm() / picture.page.height.to_mm();
        assert!((place.area.width() / place.area.height() / wanted - 1.0).abs() < 1e-6, "{}", place.name);
    }
}
