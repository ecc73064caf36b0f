use hayro_syntax::Pdf as Read;
use hayro_syntax::content::TypedIter;
use hayro_syntax::content::ops::TypedInstruction as Op;
use hayro_syntax::object::{Array, Dict, Name as ReadName, Number, Object, Stream, String as ReadString};

use super::super::samples::{layer, lines, on_threads, page, ring, scattered};
use super::*;
use crate::drawing::{Dots, Strokes};
use crate::scene::Cap;

fn bytes_of(drawing: &Drawing) -> Vec<u8> {
    let mut out = Vec::new();
    write(drawing, None, &mut out).unwrap();
    out
}

fn read(drawing: &Drawing) -> Read {
    Read::new(bytes_of(drawing)).unwrap()
}

fn content(pdf: &Read) -> String {
    String::from_utf8(pdf.pages()[0].page_stream().unwrap().to_vec()).unwrap()
}

/// A drawing with each kind of mark, in three layers.
fn small() -> Drawing {
    let mut sky = layer("sky", Colour::BLACK);
    sky.groups.push("back".to_owned());
    sky.strokes.push(lines(0.25, Cap::Butt, &[&[[(1.0, 1.0), (4.0, 1.0)]], &[[(10.0, 10.0), (7.123_44, 9.5)]]]));
    sky.strokes[0].polylines = vec![ring(&[(0.0, 0.0), (1.0, 0.5), (2.0, 0.0), (0.0, 0.0)])];
    let mut ground = layer("ground", Colour { r: 255, g: 0, b: 16, a: 128 });
    ground.groups.push("back".to_owned());
    ground.strokes = vec![Strokes::new(Length::mm(0.1), Cap::Round)];
    ground.strokes[0].curves.push(&ring(&[(0.0, 0.0), (1.0, 0.5), (2.0, -0.5), (3.0, 0.0)]));
    ground.tapers.push(&ring(&[(0.0, 5.0), (1.0, 5.0), (2.0, 5.0), (3.0, 5.0)]), &[0.5, 0.0]);
    let mut dots = layer("dots", Colour { r: 51, g: 51, b: 51, a: 255 });
    dots.dots.push(Dots { radius: Length::mm(0.5), centres: ring(&[(3.0, 3.0)]), bundle_ends: vec![1] });
    dots.areas.push(vec![ring(&[(4.0, 4.0), (8.0, 4.0), (8.0, 8.0)])]);
    Drawing { page: page(60.0, 40.0), layers: vec![sky, ground, layer("empty", Colour::BLACK), dots] }
}

#[test]
fn small_drawing() {
    insta::assert_snapshot!(content(&read(&small())), @r"
    2.8346457 0 0 -2.8346457 0 113.385826 cm
    1 j
    1 G 1 g
    0 0 60 40 re f
    /OC /L0 BDC
    /OC /L1 BDC
    0 G 0 g
    0.25 w 0 J
    1 1 m
    4 1 l
    S
    10 10 m
    7.1234 9.5 l
    S
    0 0 m
    1 0.5 l
    2 0 l
    h
    S
    EMC
    /OC /L2 BDC
    q /A128 gs
    /F0 Do Q
    EMC
    EMC
    /OC /L3 BDC
    0.2 G 0.2 g
    4 4 m
    8 4 l
    8 8 l
    h
    f*
    1 w 1 J
    3 3 m
    3 3 l
    S
    EMC
    ");
}

/// Fills and strokes in the colour that is set, through another program's stroker.
struct Painter {
    pixmap: tiny_skia::Pixmap,
    transform: tiny_skia::Transform,
    colour: [f64; 3],
    stroke: tiny_skia::Stroke,
    path: tiny_skia::PathBuilder,
}

impl Painter {
    fn paint(&mut self, rule: Option<tiny_skia::FillRule>) {
        let path = std::mem::take(&mut self.path).finish().unwrap();
        let mut paint = tiny_skia::Paint::default();
        let [r, g, b] = self.colour.map(|share| (share * 255.0).round() as u8);
        paint.set_color_rgba8(r, g, b, 255);
        match rule {
            Some(rule) => self.pixmap.fill_path(&path, &paint, rule, self.transform, None),
            None => self.pixmap.stroke_path(&path, &paint, &self.stroke, self.transform, None),
        }
    }

    fn run(&mut self, operations: TypedIter<'_>) {
        let f = |number: &Number| number.as_f64() as f32;
        let mut operations = operations;
        while let Some(operation) = operations.next() {
            match operation {
                Op::Transform(t) => {
                    let own = tiny_skia::Transform::from_row(f(&t.0), f(&t.1), f(&t.2), f(&t.3), f(&t.4), f(&t.5));
                    self.transform = self.transform.pre_concat(own);
                }
                Op::LineWidth(width) => self.stroke.width = f(&width.0),
                Op::LineCap(cap) => {
                    let round = cap.0.as_i64() == 1;
                    self.stroke.line_cap = if round { tiny_skia::LineCap::Round } else { tiny_skia::LineCap::Butt };
                }
                Op::LineJoin(join) => {
                    assert_eq!(join.0.as_i64(), 1);
                    self.stroke.line_join = tiny_skia::LineJoin::Round;
                }
                Op::StrokeColorDeviceGray(grey) => self.colour = [grey.0.as_f64(); 3],
                Op::StrokeColorDeviceRgb(c) => self.colour = [c.0.as_f64(), c.1.as_f64(), c.2.as_f64()],
                Op::NonStrokeColorDeviceGray(_) | Op::NonStrokeColorDeviceRgb(_) => {}
                Op::MoveTo(p) => self.path.move_to(f(&p.0), f(&p.1)),
                Op::LineTo(p) => self.path.line_to(f(&p.0), f(&p.1)),
                Op::CubicTo(p) => self.path.cubic_to(f(&p.0), f(&p.1), f(&p.2), f(&p.3), f(&p.4), f(&p.5)),
                Op::ClosePath(_) => self.path.close(),
                Op::RectPath(rect) => {
                    let rect = tiny_skia::Rect::from_xywh(f(&rect.0), f(&rect.1), f(&rect.2), f(&rect.3));
                    self.path.push_rect(rect.unwrap());
                }
                Op::StrokePath(_) => self.paint(None),
                Op::FillPathNonZero(_) => self.paint(Some(tiny_skia::FillRule::Winding)),
                Op::FillPathEvenOdd(_) => self.paint(Some(tiny_skia::FillRule::EvenOdd)),
                Op::BeginMarkedContentWithProperties(_) | Op::EndMarkedContent(_) => {}
                other => panic!("{other:?}"),
            }
        }
    }
}

#[test]
fn other_programs_draw_what_the_raster_shows() {
    let drawing = scattered(40.0, 30.0, 60);
    let pixels = crate::back::raster::render(&drawing);
    let pdf = read(&drawing);
    let [width, height] = drawing.page.pixels;
    let scale = width as f32 / pdf.pages()[0].media_box().width() as f32;
    let mut painter = Painter {
        pixmap: tiny_skia::Pixmap::new(width, height).unwrap(),
        transform: tiny_skia::Transform::from_row(scale, 0.0, 0.0, -scale, 0.0, height as f32),
        colour: [0.0; 3],
        stroke: tiny_skia::Stroke::default(),
        path: tiny_skia::PathBuilder::new(),
    };
    painter.run(pdf.pages()[0].typed_operations());
    let (mut sum, mut far) = (0, 0);
    for (i, theirs) in painter.pixmap.pixels().iter().enumerate() {
        let ours = pixels.colour(i % pixels.width, i / pixels.width).unwrap();
        let off = ours.g.abs_diff(theirs.green());
        sum += u64::from(off);
        far += u32::from(off > 100);
    }
    // Rounding apart, and the angles at which strokers make arcs.
    assert!(far <= 5 && sum < u64::from(width * height), "{far} {sum}");
}

/// The catalog of a file.
fn catalog(pdf: &Read) -> Dict<'_> {
    let mut dicts = pdf.objects().into_iter().filter_map(Object::into_dict);
    dicts.find(|dict| dict.get::<ReadName<'_>>("Type").is_some_and(|name| name.as_str() == "Catalog")).unwrap()
}

fn box_of(dict: &Dict<'_>, name: &str) -> Vec<f64> {
    dict.get::<Array<'_>>(name).unwrap().iter::<Number>().map(|number| number.as_f64()).collect()
}

#[test]
fn the_trimmed_page_lies_within_its_bleed() {
    let mut drawing = small();
    drawing.page.bleed = Length::mm(5.0);
    let pdf = read(&drawing);
    let page = pdf.pages()[0].raw();
    let in_points = |sides: [f64; 4]| sides.map(|mm| mm * 72.0 / 25.4);
    for (name, wanted) in [
        ("MediaBox", in_points([0.0, 0.0, 70.0, 50.0])),
        ("BleedBox", in_points([0.0, 0.0, 70.0, 50.0])),
        ("TrimBox", in_points([5.0, 5.0, 65.0, 45.0])),
    ] {
        let found = box_of(page, name);
        let near = found.iter().zip(wanted).all(|(found, wanted)| (found - wanted).abs() < 1e-4);
        assert!(near && found.len() == 4, "{name}: {found:?} instead of {wanted:?}");
    }
    let content = content(&pdf);
    assert!(
        content.starts_with("2.8346457 0 0 -2.8346457 14.173228 127.55905 cm\n1 j\n1 G 1 g\n-5 -5 70 50 re f\n"),
        "{content}"
    );
}

#[test]
fn huge_pages_have_larger_units() {
    let mut drawing = small();
    drawing.page = page(20_000.0, 100.0);
    let pdf = read(&drawing);
    let page = pdf.pages()[0].raw();
    assert_eq!(page.get::<Number>("UserUnit").map(|unit| unit.as_f64()), Some(4.0));
    assert!((box_of(page, "MediaBox")[2] * 4.0 - 20_000.0 * 72.0 / 25.4).abs() < 0.01);
    assert!(read(&small()).pages()[0].raw().get::<Number>("UserUnit").is_none());
}

/// The names of a list of layers, those of a list within it in brackets.
fn names(list: &Array<'_>) -> String {
    let text = |item: Object<'_>| match item {
        Object::Dict(group) => {
            assert_eq!(group.get::<ReadName<'_>>("Type").unwrap().as_str(), "OCG");
            String::from_utf8_lossy(group.get::<ReadString<'_>>("Name").unwrap().as_bytes()).into_owned()
        }
        Object::Array(list) => format!("[{}]", names(&list)),
        other => panic!("{other:?}"),
    };
    list.iter::<Object<'_>>().map(text).collect::<Vec<_>>().join(" ")
}

#[test]
fn groups_and_paints_are_layers() {
    let pdf = read(&small());
    let optional = catalog(&pdf).get::<Dict<'_>>("OCProperties").unwrap();
    let order = optional.get::<Dict<'_>>("D").unwrap().get::<Array<'_>>("Order").unwrap();
    assert_eq!(names(&order), "back [sky ground] dots");
    assert_eq!(names(&optional.get::<Array<'_>>("OCGs").unwrap()), "back sky ground dots");
    let resources = pdf.pages()[0].raw().get::<Dict<'_>>("Resources").unwrap();
    assert_eq!(resources.get::<Dict<'_>>("Properties").unwrap().len(), 4);
    let content = content(&pdf);
    assert_eq!((content.matches("BDC").count(), content.matches("EMC").count()), (4, 4));
}

#[test]
fn any_depth_and_any_name_is_a_layer() {
    let mut drawing = small();
    let name = "(\\) <</Type>> \0 おはよう";
    drawing.layers[0].groups = vec![name.to_owned(); 1_000];
    let pdf = read(&drawing);
    let optional = catalog(&pdf).get::<Dict<'_>>("OCProperties").unwrap();
    let groups: Vec<Dict<'_>> = optional.get::<Array<'_>>("OCGs").unwrap().iter().collect();
    assert_eq!(groups.len(), 1_000 + 4);
    let wanted: Vec<u8> = [0xfe, 0xff].into_iter().chain(name.encode_utf16().flat_map(u16::to_be_bytes)).collect();
    assert_eq!(groups[999].get::<ReadString<'_>>("Name").unwrap().as_bytes(), wanted);
}

#[test]
fn a_translucent_layer_is_one_ink() {
    let pdf = read(&small());
    let page = &pdf.pages()[0];
    assert!(content(&pdf).contains("q /A128 gs\n/F0 Do Q\n"));
    let form = page.resources().x_objects.get::<Stream<'_>>("F0").unwrap();
    let group = form.dict().get::<Dict<'_>>("Group").unwrap();
    assert_eq!(group.get::<ReadName<'_>>("S").unwrap().as_str(), "Transparency");
    let state = page.resources().ext_g_states.get::<Dict<'_>>("A128").unwrap();
    assert!((state.get::<Number>("ca").unwrap().as_f64() - 128.0 / 255.0).abs() < 1e-6);
    insta::assert_snapshot!(String::from_utf8(form.decoded().unwrap().to_vec()).unwrap(), @r"
    1 0 0.0627 RG 1 0 0.0627 rg
    0.1 w 1 J
    0 0 m
    1 0.5 2 -0.5 3 0 c
    S
    0 4.75 m
    3 5 l
    0 5.25 l
    h
    f
    ");
}

#[test]
fn paper_may_be_missing_or_translucent() {
    let mut drawing = small();
    drawing.page.paper = None;
    assert!(!content(&read(&drawing)).contains(" re f"));
    drawing.page.paper = Some(Colour { a: 51, ..Colour::WHITE });
    assert!(content(&read(&drawing)).contains("q /A51 gs 1 G 1 g\n0 0 60 40 re f\nQ\n"));
}

#[test]
fn a_long_page_is_several_streams_and_threads_do_not_matter() {
    let drawing = scattered(100.0, 100.0, 8_000);
    let [one, four] = on_threads(|| bytes_of(&drawing));
    assert!(one == four);
    let pdf = Read::new(one).unwrap();
    assert!(pdf.pages()[0].raw().get::<Array<'_>>("Contents").unwrap().iter::<Stream<'_>>().count() > 3);
    // No mark is lost: the paper's box aside, every subpath starts with a move.
    let rings = |layer: &Layer| {
        layer.tapers.iter().map(|(spine, widths)| crate::back::taper::outline(spine, widths).len()).sum::<usize>()
    };
    let wanted: usize =
        drawing.layers.iter().map(|layer| layer.marks() as usize - layer.tapers.spines.len() + rings(layer)).sum();
    let content = content(&pdf);
    assert_eq!(content.lines().filter(|line| line.ends_with(" m")).count(), wanted);
}

#[test]
fn a_drawing_of_nothing_is_a_page() {
    let pdf = read(&Drawing { page: page(10.0, 10.0), layers: Vec::new() });
    assert!(catalog(&pdf).get::<Dict<'_>>("OCProperties").is_none());
    assert!(content(&pdf).trim_end().ends_with(" re f"));
}
