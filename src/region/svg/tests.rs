#![allow(clippy::unwrap_used, clippy::expect_used)]

use super::*;

/// A page of 96 x 96 pixels, so that it is an inch wide and high.
fn file(content: &str) -> SvgFile {
    let text = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' xmlns:inkscape='http://www.inkscape.org/namespaces/inkscape' \
         xmlns:xlink='http://www.w3.org/1999/xlink' id='page' width='96' height='96'>{content}</svg>"
    );
    outlines(text.as_bytes()).unwrap()
}

/// The bounds of a part in pixels, rounded to hundredths.
fn bounds(file: &SvgFile, selection: Selection<'_>) -> [f64; 4] {
    let region = file.region(selection, None).unwrap();
    let Rect { min, max } = region.bounds();
    [min.x, min.y, max.x, max.y].map(|v| (v * 96.0 / 25.4 * 100.0).round() / 100.0)
}

/// The area of a part in square pixels, rounded.
fn area(file: &SvgFile, selection: Selection<'_>) -> f64 {
    (file.region(selection, None).unwrap().area() * (96.0 / 25.4) * (96.0 / 25.4)).round()
}

#[test]
fn shapes_stand_where_transforms_and_units_put_them() {
    let drawing = file(
        "<g id='group' transform='translate(10 20)'><g transform='scale(2)'>
           <rect id='box' x='1' y='2' width='3' height='4'/>
         </g><circle id='disc' cx='0.25in' cy='30' r='5'/></g>
         <rect id='square' width='12.7mm' height='0.5in'/>",
    );
    assert_eq!(bounds(&drawing, Selection::Id("box")), [12.0, 24.0, 18.0, 32.0]);
    assert_eq!(bounds(&drawing, Selection::Id("disc")), [29.0, 45.0, 39.0, 55.0]);
    assert_eq!(bounds(&drawing, Selection::Id("square")), [0.0, 0.0, 48.0, 48.0]);
    assert_eq!(bounds(&drawing, Selection::Id("group")), [12.0, 24.0, 39.0, 55.0]);
    assert_eq!(bounds(&drawing, Selection::Id("page")), bounds(&drawing, Selection::Whole));
}

#[test]
fn fill_rules_are_those_of_each_path() {
    let rings = "M0 0H30V30H0Z M10 10H20V20H10Z";
    let drawing = file(&format!(
        "<path id='nonzero' d='{rings}'/><path id='evenodd' fill-rule='evenodd' d='{rings}'/>
         <path d='M40 0H50V10H40Z'/><path d='M40 0V10H50V0Z'/>"
    ));
    assert_eq!(area(&drawing, Selection::Id("nonzero")), 900.0);
    assert_eq!(area(&drawing, Selection::Id("evenodd")), 800.0);
    // The two last ones run in opposite senses and must not cancel each other.
    assert_eq!(area(&drawing, Selection::Whole), 1000.0);
}

#[test]
fn what_is_not_filled_or_not_shown_is_left_out() {
    let drawing = file(
        "<rect id='shown' width='10' height='10'/>
         <rect id='hidden' x='20' width='10' height='10' visibility='hidden'/>
         <rect id='gone' x='20' width='10' height='10' display='none'/>
         <rect id='stroked' x='20' width='10' height='10' fill='none' stroke='black'/>
         <defs><rect id='spare' x='20' width='10' height='10'/></defs>
         <g id='nothing'/>",
    );
    assert_eq!(bounds(&drawing, Selection::Whole), [0.0, 0.0, 10.0, 10.0]);
    for id in ["hidden", "gone", "stroked", "spare", "nothing"] {
        assert_eq!(drawing.region(Selection::Id(id), None).unwrap_err(), SvgError::NotFilled, "{id}");
    }
    let known = ["gone", "hidden", "nothing", "page", "shown", "spare", "stroked"].map(String::from).to_vec();
    let error = drawing.region(Selection::Id("show"), None).unwrap_err();
    assert_eq!(error, SvgError::NoSuchId { id: "show".into(), known });
}

#[test]
fn use_elements_stand_for_what_they_name() {
    let drawing = file(
        "<defs><rect id='spare' width='10' height='10'/></defs>
         <use id='one' href='#spare' x='20'/><use id='two' xlink:href='#spare' y='30'/>
         <use id='outside' href='other.svg#thing'/>",
    );
    assert_eq!(bounds(&drawing, Selection::Id("one")), [20.0, 0.0, 30.0, 10.0]);
    assert_eq!(bounds(&drawing, Selection::Id("two")), [0.0, 30.0, 10.0, 40.0]);
    assert_eq!(drawing.region(Selection::Id("outside"), None).unwrap_err(), SvgError::NotFilled);
}

#[test]
fn clip_paths_cut() {
    let drawing = file(
        "<clipPath id='left'><rect width='10' height='100'/></clipPath>
         <clipPath id='corner' clip-path='url(#left)'><rect width='100' height='10'/></clipPath>
         <g clip-path='url(#left)' transform='translate(5 0)'><rect id='cut' width='40' height='40'/></g>
         <rect id='twice' y='5' width='40' height='40' clip-path='url(#corner)'/>
         <rect id='shifted' x='2' width='40' height='40' transform='translate(50 50)' clip-path='url(#left)'/>",
    );
    assert_eq!(bounds(&drawing, Selection::Id("cut")), [5.0, 0.0, 15.0, 40.0]);
    assert_eq!(bounds(&drawing, Selection::Id("twice")), [0.0, 5.0, 10.0, 10.0]);
    assert_eq!(bounds(&drawing, Selection::Id("shifted")), [52.0, 50.0, 60.0, 90.0]);
}

#[test]
fn layers_and_classes_are_selected_without_ids() {
    let drawing = file(
        "<style>.dark { fill: none }</style>
         <g inkscape:groupmode='layer' inkscape:label='Shadow side'><rect width='10' height='10'/></g>
         <g inkscape:label='no layer' class='a'><rect class='b a' x='20' width='10' height='10'/></g>
         <rect class='b' x='40' width='10' height='10'/><rect class='dark' x='60' width='9' height='9'/>",
    );
    assert_eq!(bounds(&drawing, Selection::Layer("Shadow side")), [0.0, 0.0, 10.0, 10.0]);
    assert_eq!(bounds(&drawing, Selection::Class("a")), [20.0, 0.0, 30.0, 10.0]);
    assert_eq!(bounds(&drawing, Selection::Class("b")), [20.0, 0.0, 50.0, 10.0]);
    assert_eq!(drawing.region(Selection::Class("dark"), None).unwrap_err(), SvgError::NotFilled);
    let error = drawing.region(Selection::Layer("no layer"), None).unwrap_err();
    assert_eq!(error, SvgError::NoSuchLayer { layer: "no layer".into(), known: vec!["Shadow side".into()] });
    let known = vec!["a".into(), "b".into(), "dark".into()];
    let error = drawing.region(Selection::Class("c"), None).unwrap_err();
    assert_eq!(error, SvgError::NoSuchClass { class: "c".into(), known });
    assert!(drawing.region(Selection::Id("kake-0"), None).is_err());
}

#[test]
fn the_page_is_fitted_and_not_the_part() {
    let text = "<svg xmlns='http://www.w3.org/2000/svg' width='40mm' height='20mm' viewBox='0 0 4 2'>
                <rect id='a' x='1' width='1' height='2'/></svg>";
    let drawing = outlines(text.as_bytes()).unwrap();
    let rect = |x0: f64, y0: f64, x1: f64, y1: f64| Rect::new(Point::new(x0, y0), Point::new(x1, y1));
    let natural = drawing.region(Selection::Id("a"), None).unwrap();
    assert_eq!(natural.bounds(), rect(10.0, 0.0, 20.0, 20.0));
    let fitted = drawing.region(Selection::Id("a"), Some(rect(0.0, 0.0, 80.0, 80.0))).unwrap();
    assert_eq!(fitted.bounds(), rect(20.0, 20.0, 40.0, 60.0));
}

#[test]
fn points_are_snapped() {
    let drawing = file("<path d='M1.23456 2.34567 L50.1 3.9 L20.2 70.7Z'/>");
    for polygon in drawing.region(Selection::Whole, None).unwrap().polygons() {
        for p in polygon.rings().flatten() {
            assert_eq!([p.x * 1024.0, p.y * 1024.0].map(f64::fract), [0.0, 0.0]);
        }
    }
}

#[test]
fn bad_files_are_told_apart() {
    let error = |text: &str| outlines(text.as_bytes()).unwrap_err();
    assert!(matches!(error(""), SvgError::Unreadable(_)));
    assert!(matches!(error("<svg xmlns='http://www.w3.org/2000/svg'>"), SvgError::Unreadable(_)));
    assert!(matches!(error("<html/>"), SvgError::Unreadable(_)));
    assert_eq!(error("<svg xmlns='http://www.w3.org/2000/svg' width='0' height='1'/>"), SvgError::NoSize);
    assert_eq!(outlines(&[0x1f, 0x8b, 8, 0]).unwrap_err(), SvgError::Compressed);
    assert!(matches!(outlines(&[0xff, 0xfe, 0x3c]).unwrap_err(), SvgError::Unreadable(_)));
}

#[test]
fn deep_nesting_is_an_error_and_no_crash() {
    let nested = |open: &str, close: &str, depth: usize| {
        let content = format!("{}<rect width='1' height='1'/>{}", open.repeat(depth), close.repeat(depth));
        let text = format!("<svg xmlns='http://www.w3.org/2000/svg' width='9' height='9'>{content}</svg>");
        outlines(text.as_bytes())
    };
    assert!(nested("<g>", "</g>", 200).unwrap().region(Selection::Whole, None).is_ok());
    for depth in [300, 10_000, 100_000] {
        assert!(matches!(nested("<g>", "</g>", depth).unwrap_err(), SvgError::TooDeep { .. }));
    }
    assert!(matches!(nested("<text>", "</text>", 10_000).unwrap_err(), SvgError::TooDeep { .. }));
}

#[test]
fn bombs_are_errors_and_no_crash() {
    // Each group uses the one before: as deep as the file is long.
    let chain = |length: usize| {
        let links: String = (1..length).map(|i| format!("<g id='g{i}'><use href='#g{}'/></g>", i - 1)).collect();
        outlines(
            format!(
                "<svg xmlns='http://www.w3.org/2000/svg' width='9' height='9'>\
                 <defs><rect id='g0' width='1' height='1'/>{links}</defs><use href='#g{}'/></svg>",
                length - 1
            )
            .as_bytes(),
        )
    };
    assert_eq!(bounds(&chain(330).unwrap(), Selection::Whole), [0.0, 0.0, 1.0, 1.0]);
    assert_eq!(chain(3000).unwrap_err(), SvgError::TooLarge);
    // Ten entities, each ten times the one before.
    let entities: String =
        (1..12).map(|i| format!("<!ENTITY e{i} '{}'>", format!("&e{};", i - 1).repeat(10))).collect();
    let text = format!(
        "<!DOCTYPE svg [<!ENTITY e0 'x'>{entities}]><svg xmlns='http://www.w3.org/2000/svg' width='9' height='9'>&e11;</svg>"
    );
    assert!(outlines(text.as_bytes()).is_err());
    // It uses itself.
    let drawing = file("<g id='a'><use href='#a'/><rect width='1' height='1'/></g>");
    assert_eq!(bounds(&drawing, Selection::Whole), [0.0, 0.0, 1.0, 1.0]);
}

#[test]
fn pictures_in_a_file_are_not_looked_at() {
    let drawing = file("<image href='/etc/hostname' width='9' height='9'/><rect id='a' width='1' height='1'/>");
    assert_eq!(bounds(&drawing, Selection::Whole), [0.0, 0.0, 1.0, 1.0]);
}

#[test]
fn colours_select_what_has_them() {
    let drawing = file(
        "<rect width='10' height='10' fill='#c00000' opacity='0.5'/><rect x='20' width='10' height='10' fill='none' stroke='#c00000'/>
         <linearGradient id='g'><stop stop-color='#000'/><stop offset='1' stop-color='#fff'/></linearGradient>
         <rect x='40' width='10' height='10' fill='url(#g)'/>",
    );
    assert_eq!(bounds(&drawing, Selection::Colour([0xc0, 0, 0])), [0.0, 0.0, 10.0, 10.0]);
    // Of a gradient it is the mean.
    assert_eq!(bounds(&drawing, Selection::Colour([128; 3])), [40.0, 0.0, 50.0, 10.0]);
    let error = drawing.region(Selection::Colour([1, 2, 3]), None).unwrap_err();
    assert_eq!(error, SvgError::NoSuchColour { colour: [1, 2, 3], known: vec![[128; 3], [0xc0, 0, 0]] });
    assert_eq!(drawing.ink(Selection::Colour([0xc0, 0, 0]), None).unwrap().marks.len(), 2);
}

#[test]
fn ink_is_what_is_drawn_in_its_order() {
    use ink::InkShape;
    let drawing = file(
        "<g transform='scale(2 8)'><path d='M0 0 C1 0 2 1 3 3' fill='none' stroke='#123' stroke-width='3'/></g>
         <rect id='both' x='20' width='10' height='10' fill='white' stroke='black' stroke-opacity='0.5' stroke-linecap='round'/>
         <path id='dashed' d='M5 50 H15' stroke='black' stroke-dasharray='2' stroke-linecap='square'/>
         <path id='nothing' d='M0 50 H10' stroke='black' stroke-opacity='0'/>",
    );
    let marks = drawing.ink(Selection::Whole, None).unwrap().marks;
    let mm = 25.4 / 96.0;
    let InkShape::Lines { width, is_round: false, chains } = &marks[0].shape else { panic!("a stroke") };
    assert_eq!((marks[0].colour, chains.len(), chains[0].len()), ([0x11, 0x22, 0x33, 255], 1, 4));
    assert!((width.to_mm() - 12.0 * mm).abs() < 1e-4, "{width:?}");
    assert!(chains[0][3].distance(Point::new(6.0 * mm, 24.0 * mm)) < 1e-3);
    assert!(matches!(&marks[1].shape, InkShape::Area(area) if (area.area() - 100.0 * mm * mm).abs() < 0.01));
    let InkShape::Lines { is_round: true, chains, .. } = &marks[2].shape else { panic!("round ends") };
    assert_eq!((marks[2].colour[3], chains[0].first()), (128, chains[0].last()));
    // Three dashes of two pixels, each longer by half a pixel at both ends.
    let InkShape::Lines { chains, .. } = &marks[3].shape else { panic!("dashes") };
    let lengths: Vec<f64> = chains.iter().map(|c| (c[0].distance(c[c.len() - 1]) / mm * 10.0).round() / 10.0).collect();
    assert_eq!((lengths, marks.len()), (vec![3.0; 3], 4));
    assert_eq!(drawing.ink(Selection::Id("nothing"), None).unwrap_err(), SvgError::NotDrawn);
    assert!(drawing.ink(Selection::Whole, None).unwrap().lacks.is_empty());
}

#[test]
fn lines_are_strokes_and_dark_fills() {
    let drawing = file(
        "<path d='M0 0 H50' fill='none' stroke='#888'/><path d='M0 5 H50' fill='none' stroke='#f4f4f4'/>
         <path d='M0 9 H50' stroke='black' stroke-opacity='0.3' fill='none'/>
         <rect x='20' y='20' width='10' height='10' fill='#a00'/><rect x='40' y='20' width='10' height='10' fill='#fcc'/>
         <clipPath id='left'><rect width='10' height='96'/></clipPath>
         <g clip-path='url(#left)'><path d='M0 50 H50' fill='none' stroke='black' stroke-linecap='round' stroke-width='4'/></g>
         <rect id='pale' x='60' y='60' width='9' height='9' fill='white'/>",
    );
    let lines = drawing.lines(Selection::Whole, None).unwrap();
    let mm = 25.4 / 96.0;
    assert_eq!(lines.centres.len(), 2);
    assert!(
        (lines.centres[1].points[1].x - 10.0 * mm).abs() < 1e-3 && (lines.centres[1].beyond - 2.0 * mm).abs() < 1e-9
    );
    assert!((lines.dark.area() - 100.0 * mm * mm).abs() < 0.01);
    assert_eq!(drawing.lines(Selection::Id("pale"), None).unwrap_err(), SvgError::NoLines);
}
