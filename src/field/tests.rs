#![allow(clippy::unwrap_used, clippy::expect_used)]

mod shaped;

use std::io::Cursor;

use ::image::{self as pictures, DynamicImage, ImageFormat};
use proptest::prelude::*;

use super::*;
use crate::geom::Angle;

fn p(x: f64, y: f64) -> Point {
    Point::new(x, y)
}

fn rect(x0: f64, y0: f64, x1: f64, y1: f64) -> Rect {
    Rect::new(p(x0, y0), p(x1, y1))
}

fn x() -> Field {
    Field::new(Node::X(Length::mm(1.0)))
}

fn encoded(image: impl Into<DynamicImage>, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    image.into().write_to(&mut bytes, format).unwrap();
    bytes.into_inner()
}

#[test]
fn gradients_are_exact_at_their_ends_and_clamped_beyond() {
    let linear = Field::linear(p(20.0, 30.0), p(75.0, 70.0), 0.1, 3.3);
    assert_eq!([linear.at(p(20.0, 30.0)), linear.at(p(75.0, 70.0))], [0.1, 3.3]);
    assert_eq!([linear.at(p(0.0, 0.0)), linear.at(p(500.0, 500.0))], [0.1, 3.3]);
    assert!((linear.at(p(47.5, 50.0)) - 1.7).abs() < 1e-12);
    let radial = Field::radial(p(5.0, 5.0), Length::mm(2.0), 1.0, 0.0);
    assert_eq!([radial.at(p(5.0, 5.0)), radial.at(p(5.0, 6.0)), radial.at(p(9.0, 9.0))], [1.0, 0.5, 0.0]);
    // A gradient between one point and itself has the first value.
    assert_eq!(Field::linear(p(1.0, 1.0), p(1.0, 1.0), 4.0, 5.0).at(p(2.0, 2.0)), 4.0);
}

#[test]
fn gradients_across_a_box_touch_its_corners() {
    let bounds = rect(10.0, 20.0, 50.0, 40.0);
    let level = Field::linear_across(bounds, Angle::ZERO, 0.0, 1.0);
    assert_eq!([level.at(p(10.0, 0.0)), level.at(p(30.0, 99.0)), level.at(p(50.0, 5.0))], [0.0, 0.5, 1.0]);
    let slanting = Field::linear_across(bounds, Angle::degrees(30.0), 0.0, 1.0);
    assert!(slanting.at(bounds.min) < 1e-12 && slanting.at(bounds.max) > 1.0 - 1e-12);
    assert!(slanting.at(p(11.0, 21.0)) > 0.0 && slanting.at(p(49.0, 39.0)) < 1.0);
    let upwards = Field::linear_across(bounds, Angle::degrees(-90.0), 0.0, 1.0);
    assert!(upwards.at(p(30.0, 40.0)) < 1e-12 && upwards.at(p(30.0, 20.0)) > 1.0 - 1e-12);
}

#[test]
fn functions_hold_at_their_edges() {
    let apply = |function: Function, a: f64| function.apply(a);
    assert_eq!(apply(Function::Sqrt, -1.0), 0.0);
    assert_eq!(apply(Function::Ln, 0.0), f64::NEG_INFINITY);
    assert_eq!(apply(Function::Acos, 1.5), 0.0);
    assert_eq!([2.5, -2.5, 0.499_999_999_999_999_94].map(|a| apply(Function::Round, a)), [3.0, -2.0, 0.0]);
    assert_eq!([-3.0, 0.0, 7.0].map(|a| apply(Function::Sign, a)), [-1.0, 0.0, 1.0]);
    let apply = |operator: Operator, a: f64, b: f64| operator.apply(a, b);
    assert_eq!(apply(Operator::Divide, 1.0, 0.0), 0.0);
    assert_eq!(apply(Operator::Power, -1.0, 0.5), 0.0);
    assert_eq!(
        [(7.0, 3.0), (-7.0, 3.0), (7.0, -3.0), (7.0, 0.0)].map(|(a, b)| apply(Operator::Remainder, a, b)),
        [1.0, 2.0, -2.0, 0.0]
    );
    let apply = |blender: Blender, a: f64, b: f64, c: f64| blender.apply(a, b, c);
    assert_eq!([-1.0, 0.5, 3.0].map(|a| apply(Blender::Clamp, a, 0.0, 2.0)), [0.0, 0.5, 2.0]);
    assert_eq!([0.0, 0.25, 1.0].map(|c| apply(Blender::Mix, 10.0, 20.0, c)), [10.0, 12.5, 20.0]);
    assert_eq!([0.0, 2.0, 3.0, 4.0, 5.0].map(|c| apply(Blender::Smoothstep, 2.0, 4.0, c)), [0.0, 0.0, 0.5, 1.0, 1.0]);
    assert_eq!([1.0, 2.0].map(|c| apply(Blender::Smoothstep, 2.0, 2.0, c)), [0.0, 1.0]);
}

#[test]
fn lightness_is_that_of_the_cie() {
    // Mid grey of photography and sRGB 119 are both L* 49.5 or so; below the knee the curve is straight.
    for (luminance, lightness) in [(0.0, 0.0), (0.001, 0.009_033), (0.18, 0.494_961), (0.5, 0.760_693), (1.0, 1.0)] {
        assert!((Function::Lightness.apply(luminance) - lightness).abs() < 1e-6, "{luminance}");
    }
    let knee = 216.0 / 24389.0;
    assert!((Function::Lightness.apply(knee) - 0.08).abs() < 1e-12);
    assert!((Function::Lightness.apply(knee + 1e-12) - 0.08).abs() < 1e-9);
}

#[test]
fn what_is_the_same_everywhere_is_worked_out_at_once() {
    let two = Field::constant(4.0).map(Function::Sqrt);
    assert_eq!(two.as_constant(), Some(2.0));
    assert_eq!(two.clone().zip(Field::constant(3.0), Operator::Multiply).as_constant(), Some(6.0));
    let field = Field::select(two.zip(Field::constant(2.0), Operator::Equal), x(), Field::constant(0.0));
    assert!(matches!(field.node(), Node::X(_)));
}

#[test]
fn depth_and_cost_count_shared_parts() {
    let mut field = x();
    for _ in 0..40 {
        field = field.clone().zip(field, Operator::Add);
    }
    assert_eq!(field.depth(), 41);
    assert_eq!(field.cost(), (1 << 41) - 1);
}

#[test]
fn noise_stays_in_range_and_is_smooth() {
    let noise = Noise::new(Length::mm(5.0), 3, 42);
    let values: Vec<f64> =
        (0..10_000).map(|i| noise.at(p(f64::from(i % 100) * 0.73, f64::from(i / 100) * 0.73))).collect();
    let mean = values.iter().sum::<f64>() / 1e4;
    let deviation = (values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / 1e4).sqrt();
    assert!((mean - 0.5).abs() < 0.03 && deviation > 0.06, "{mean} {deviation}");
    assert!(values.iter().all(|v| (0.0..=1.0).contains(v)));
    for i in 0..1000 {
        let x = f64::from(i) * 0.031;
        assert!((noise.at(p(x, 3.0)) - noise.at(p(x + 1e-4, 3.0))).abs() < 1e-3);
    }
    // A scene's noise must not change from one release to the next.
    assert_eq!(noise.at(p(1.0, 2.0)), 0.335_191_899_981_769_8);
    assert_ne!(noise.at(p(1.0, 2.0)), Noise::new(Length::mm(5.0), 3, 43).at(p(1.0, 2.0)));
}

#[test]
fn noise_repeats_where_it_is_told_to() {
    let noise = Noise::new(Length::mm(7.0), 4, 1).repeating(Length::mm(40.0), Length::mm(30.0));
    for i in 0..500 {
        let at = p(f64::from(i % 25) * 1.7, f64::from(i / 25) * 1.9);
        let value = noise.at(at);
        for (dx, dy) in [(40.0, 0.0), (0.0, 30.0), (-80.0, 60.0)] {
            assert!((noise.at(p(at.x + dx, at.y + dy)) - value).abs() < 1e-9);
        }
    }
}

#[test]
fn images_are_read_as_linear_light() {
    let rgb = pictures::RgbImage::from_raw(3, 1, vec![255, 0, 0, 0, 255, 0, 188, 188, 188]).unwrap();
    let decoded = Image::decode(&encoded(rgb.clone(), ImageFormat::Png), 100).unwrap();
    assert_eq!((decoded.width, decoded.height), (3, 1));
    for (sample, expected) in decoded.samples.iter().zip([0.2126, 0.7152, 0.5029]) {
        assert!((sample - expected).abs() < 1e-4, "{sample}");
    }
    let red = Image::decode_channel(&encoded(rgb, ImageFormat::Png), Channel::Red, 100).unwrap();
    assert_eq!(red.samples[..2], [1.0, 0.0]);
    // Sixteen bits, and grey.
    let deep = pictures::ImageBuffer::<pictures::Luma<u16>, _>::from_raw(2, 1, vec![65_535, 48_316]).unwrap();
    let decoded = Image::decode(&encoded(deep, ImageFormat::Png), 100).unwrap();
    assert!(decoded.samples[0] == 1.0 && (decoded.samples[1] - 0.5029).abs() < 1e-4);
    // A photograph's file.
    let grey = pictures::GrayImage::from_pixel(16, 8, pictures::Luma([188]));
    let decoded = Image::decode(&encoded(grey, ImageFormat::Jpeg), 1000).unwrap();
    assert_eq!((decoded.width, decoded.height), (16, 8));
    assert!(decoded.samples.iter().all(|sample| (sample - 0.5029).abs() < 0.02));
}

#[test]
fn transparent_pixels_lie_on_white() {
    let pixels = pictures::RgbaImage::from_raw(3, 1, vec![0, 0, 0, 0, 0, 0, 0, 51, 0, 0, 0, 255]).unwrap();
    let bytes = encoded(pixels, ImageFormat::Png);
    let light = Image::decode(&bytes, 100).unwrap();
    for (sample, expected) in light.samples.iter().zip([1.0, 0.8, 0.0]) {
        assert!((sample - expected).abs() < 1e-6);
    }
    let alpha = Image::decode_channel(&bytes, Channel::Alpha, 100).unwrap();
    assert_eq!(alpha.samples, [0.0, 0.2, 1.0]);
}

#[test]
fn bad_images_are_errors_before_memory_is_taken() {
    assert_eq!(Image::decode(b"GIF89a", 100).unwrap_err(), ImageError::UnknownFormat);
    assert_eq!(Image::decode(b"", 100).unwrap_err(), ImageError::UnknownFormat);
    let bytes = encoded(pictures::GrayImage::new(20, 10), ImageFormat::Png);
    assert_eq!(Image::decode(&bytes, 199).unwrap_err(), ImageError::TooLarge { width: 20, height: 10, most: 199 });
    assert!(Image::decode(&bytes, 200).is_ok());
    assert!(matches!(Image::decode(&bytes[..bytes.len() / 2], 200).unwrap_err(), ImageError::Damaged(_)));
    // A head that claims four thousand million pixels, with its checksum.
    let huge = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\xff\xff\0\0\xff\xff\x10\x06\0\0\0";
    let mut huge = huge.to_vec();
    huge.extend(crc(&huge[12..]).to_be_bytes());
    huge.extend(b"\0\0\0\0IDAT\x35\xaf\x06\x1e");
    let most = 400_000_000;
    assert_eq!(Image::decode(&huge, most).unwrap_err(), ImageError::TooLarge { width: 65_535, height: 65_535, most });
}

/// The checksum of PNG chunks.
fn crc(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0u32, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |crc, _| if crc & 1 == 1 { (crc >> 1) ^ 0xedb8_8320 } else { crc >> 1 })
    })
}

#[test]
fn images_are_bilinear_and_extend_their_edges() {
    let image = Arc::new(Image { width: 2, height: 2, samples: vec![0.0, 1.0, 0.5, 0.5] });
    // Twice as wide as high: the image lies in the middle, from x = 10 to 20.
    let field = Field::image(image, rect(5.0, 0.0, 25.0, 10.0));
    assert_eq!(field.at(p(12.5, 2.5)), 0.0);
    assert_eq!(field.at(p(17.5, 2.5)), 1.0);
    assert_eq!(field.at(p(15.0, 2.5)), 0.5);
    assert_eq!(field.at(p(13.75, 2.5)), 0.25);
    assert_eq!(field.at(p(12.5, 5.0)), 0.25);
    assert_eq!(field.at(p(0.0, -9.0)), 0.0);
    assert_eq!(field.at(p(99.0, -9.0)), 1.0);
    assert!(!serde_json::to_string(&field).unwrap().contains("samples"));
}

#[test]
fn masks_are_the_dark_part() {
    // A dark ring of pixels round a bright one, in the corner of a bright page.
    let mut samples = vec![1.0; 36];
    for (column, row) in [(0, 0), (1, 0), (2, 0), (0, 1), (2, 1), (0, 2), (1, 2), (2, 2)] {
        samples[row * 6 + column] = 0.0;
    }
    let image = Image { width: 6, height: 6, samples };
    let region = mask(&image, 0.5, rect(0.0, 0.0, 6.0, 6.0)).unwrap();
    assert_eq!(region.polygons().len(), 1);
    assert_eq!(region.polygons()[0].holes.len(), 1);
    assert_eq!(region.bounds(), rect(0.0, 0.0, 3.0, 3.0));
    assert!(region.contains(p(0.01, 0.01)) && !region.contains(p(1.5, 1.5)));
    // Where the way from dark to bright is cut depends on the threshold.
    let edge = Image { width: 2, height: 1, samples: vec![0.0, 1.0] };
    let dark = |threshold: f64| mask(&edge, threshold, rect(0.0, 0.0, 20.0, 10.0)).unwrap().bounds();
    assert!((dark(0.25).max.x - 7.5).abs() < 1e-6 && (dark(0.75).max.x - 12.5).abs() < 1e-6);
    assert_eq!(dark(2.0), rect(0.0, 0.0, 20.0, 10.0));
    assert_eq!(dark(0.0), Rect::EMPTY);
}

#[test]
fn masks_of_noise_are_refused() {
    // Every second pixel dark, in both ways: four corners round each.
    let checked = |width: u32, height: u32| {
        let dark = |i: u32| if (i % width + i / width).is_multiple_of(2) { 0.0 } else { 1.0 };
        let image = Image { width, height, samples: (0..width * height).map(dark).collect() };
        mask(&image, 0.5, rect(0.0, 0.0, 60.0, 60.0)).map(|region| region.polygons().len())
    };
    assert_eq!(checked(40, 40), Ok(800));
    assert_eq!(checked(1500, 1500), Err(TooDetailed));
}

/// Any field, with operators that may overflow and divide by zero.
fn field() -> impl Strategy<Value = Field> {
    let number = prop_oneof![Just(0.0), Just(-1.0), Just(1e308), -5.0..5.0f64];
    let leaf = prop_oneof![
        number.prop_map(Field::constant),
        Just(x()),
        Just(Field::linear(p(0.0, 0.0), p(0.0, 0.0), 1.0, 2.0)),
        Just(Field::distance(Region::empty())),
    ];
    leaf.prop_recursive(6, 40, 3, |inner| {
        let function = prop::sample::select(vec![
            Function::Negate,
            Function::Not,
            Function::Abs,
            Function::Sin,
            Function::Tan,
            Function::Asin,
            Function::Sqrt,
            Function::Exp,
            Function::Ln,
            Function::Round,
            Function::Lightness,
        ]);
        let operator = prop::sample::select(vec![
            Operator::Add,
            Operator::Subtract,
            Operator::Multiply,
            Operator::Divide,
            Operator::Remainder,
            Operator::Power,
            Operator::Min,
            Operator::Atan2,
            Operator::Less,
        ]);
        let blender = prop::sample::select(vec![Blender::Clamp, Blender::Mix, Blender::Smoothstep]);
        prop_oneof![
            (function, inner.clone()).prop_map(|(function, a)| a.map(function)),
            (operator, inner.clone(), inner.clone()).prop_map(|(operator, a, b)| a.zip(b, operator)),
            (blender, inner.clone(), inner.clone(), inner)
                .prop_map(|(blender, a, b, c)| Field::blend(blender, a, b, c)),
        ]
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn values_are_numbers(field in field(), at in (-10.0..10.0f64, -10.0..10.0f64)) {
        prop_assert!(!field.at(p(at.0, at.1)).is_nan());
    }

    #[test]
    fn masks_agree_with_the_image(samples in prop::collection::vec(0.0..1.0f32, 24), threshold in 0.1..0.9f64) {
        let image = Image { width: 6, height: 4, samples };
        let place = rect(0.0, 0.0, 12.0, 8.0);
        let region = mask(&image, threshold, place).unwrap();
        for row in 0..4 {
            for column in 0..6 {
                let sample = image.sample(column, row);
                if (sample - threshold).abs() > 1e-3 {
                    let at = p(column as f64 * 2.0 + 1.0, row as f64 * 2.0 + 1.0);
                    prop_assert_eq!(region.contains(at), sample < threshold);
                }
            }
        }
    }
}
