//! Sheets keep their pictures apart and their proportions.

use proptest::prelude::*;

use super::*;

fn picture(name: &str, width: f64, height: f64) -> Slot {
    let holds = Holds::Picture([width, height].map(Length::mm));
    Slot { name: name.to_owned(), caption: vec![name.to_owned()], holds }
}

fn grid(rows: Vec<Vec<Slot>>) -> Grid {
    let rows = rows.into_iter().map(|slots| Row { slots, ..Row::default() }).collect();
    Grid { rows, side: Length::mm(60.0), ..Grid::default() }
}

#[test]
fn a_common_scale_keeps_sizes_and_each_fills_its_place() {
    let slots = vec![picture("a", 100.0, 50.0), picture("b", 50.0, 25.0)];
    let mut grid = grid(vec![slots]);
    let widths = |grid: &Grid| Sheet::new(grid).places.iter().map(|place| place.area.width()).collect::<Vec<_>>();
    assert_eq!(widths(&grid), [60.0, 30.0]);
    grid.scale = Scale::Each;
    assert_eq!(widths(&grid), [60.0, 60.0]);
}

#[test]
fn places_without_a_picture_say_why() {
    let words = Slot { name: String::new(), caption: Vec::new(), holds: Holds::Words("no `k`".to_owned()) };
    let sheet = Sheet::new(&grid(vec![vec![picture("a", 10.0, 10.0), words]]));
    assert_eq!((sheet.places.len(), sheet.frames.len()), (1, 2));
    assert!(sheet.texts.iter().any(|text| text.text == "no `k`"));
}

#[test]
fn a_sheet_without_pictures_is_a_page_all_the_same() {
    let sheet = Sheet::new(&Grid { title: "nothing".to_owned(), ..grid(Vec::new()) });
    assert!(sheet.page.width.to_mm() > 20.0 && sheet.page.height.to_mm() > 20.0);
}

proptest! {
    #[test]
    fn pictures_lie_apart_on_the_page(
        sizes in prop::collection::vec(prop::collection::vec((1.0..300.0f64, 1.0..300.0f64), 1..5), 1..5),
        labels in prop::collection::vec(".{0,60}", 5),
        each in any::<bool>(),
    ) {
        let rows = sizes.iter().map(|row| row.iter().map(|(w, h)| picture("seed 1", *w, *h)).collect()).collect();
        let mut grid = grid(rows);
        grid.scale = if each { Scale::Each } else { Scale::Common };
        grid.heads = labels.clone();
        for (row, label) in grid.rows.iter_mut().zip(&labels) {
            row.label = vec![label.clone()];
        }
        let sheet = Sheet::new(&grid);
        let page = Rect::new(Point::new(0.0, 0.0), Point::new(sheet.page.width.to_mm(), sheet.page.height.to_mm()));
        let wanted: Vec<(f64, f64)> = sizes.into_iter().flatten().collect();
        prop_assert_eq!(sheet.places.len(), wanted.len());
        for (i, (place, (w, h))) in sheet.places.iter().zip(&wanted).enumerate() {
            let area = &place.area;
            prop_assert!(area.width() <= 60.0 + 1e-9 && area.height() <= 60.0 + 1e-9);
            prop_assert!((area.width() / area.height() / (w / h) - 1.0).abs() < 1e-9);
            prop_assert!(area.corners().iter().all(|&corner| page.contains(corner)));
            for other in &sheet.places[i + 1..] {
                prop_assert!(area.intersection(&other.area).is_empty());
            }
        }
    }
}
