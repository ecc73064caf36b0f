//! The one place where a length becomes text: millimetres in, fixed point with at most four decimals out.
//!
//! Four decimals are a tenth of a micrometre, far below any pen. There is no exponent, no `-0`, no locale and no
//! trailing zero. Callers that add numbers up do so in whole units, so that rounding errors never accumulate.

/// Room that [`put`] needs at most: a sign, twenty digits, a point.
pub(super) const LONGEST: usize = 24;

/// Units in a millimetre.
const PER_MM: f64 = 10_000.0;

/// What is added and taken away again to round a small number to a whole one, halves to even: 1.5 times 2^52, where
/// neighbouring numbers are one apart. It is several times faster than a call of the rounding function where the
/// processor's own instruction may not be assumed.
const ROUNDER: f64 = 6_755_399_441_055_744.0;

/// The largest number of units: 10^11 mm. Lengths beyond it are written as it.
const LARGEST: f64 = 1e15;

/// A length as a whole number of ten-thousandths of a millimetre: the nearest to its exact value, halves to even. What
/// is not a number is 0.
pub(super) fn units(mm: f64) -> i64 {
    let scaled = (mm * PER_MM).clamp(-LARGEST, LARGEST);
    let nearest = (scaled + ROUNDER) - ROUNDER;
    // The product is itself rounded. That matters only within a hair of a half; there the exact remainder decides.
    if (scaled - nearest).abs() < 0.499_999 {
        return nearest as i64;
    }
    let rest = mm.mul_add(PER_MM, -nearest);
    let whole = nearest as i64;
    let odd = whole & 1 != 0;
    if rest > 0.5 || (odd && rest >= 0.5) {
        whole + 1
    } else if rest < -0.5 || (odd && rest <= -0.5) {
        whole - 1
    } else {
        whole
    }
}

/// Every number below a hundred as two digits.
const PAIRS: [[u8; 2]; 100] = {
    let mut pairs = [[b'0'; 2]; 100];
    let mut n = 0;
    while n < 100 {
        pairs[n] = [b'0' + (n / 10) as u8, b'0' + (n % 10) as u8];
        n += 1;
    }
    pairs
};

/// Writes a number of units in millimetres to the beginning of `text`, which has room for [`LONGEST`] bytes, and says
/// how many bytes it took.
#[inline]
pub(super) fn put(units: i64, text: &mut [u8]) -> usize {
    let mut at = 0;
    if units < 0 {
        text[0] = b'-';
        at = 1;
    }
    let magnitude = units.unsigned_abs();
    let (whole, fraction) = (magnitude / 10_000, (magnitude % 10_000) as usize);
    at += put_whole(whole, &mut text[at..]);
    if fraction != 0 {
        let (high, low) = (PAIRS[fraction / 100], PAIRS[fraction % 100]);
        text[at..at + 5].copy_from_slice(&[b'.', high[0], high[1], low[0], low[1]]);
        at += 5;
        while text[at - 1] == b'0' {
            at -= 1;
        }
    }
    at
}

/// Writes a whole number to the beginning of `text` and says how many bytes it took.
#[inline]
fn put_whole(mut n: u64, text: &mut [u8]) -> usize {
    if n < 10 {
        text[0] = b'0' + n as u8;
        return 1;
    }
    if n < 100 {
        text[..2].copy_from_slice(&PAIRS[n as usize]);
        return 2;
    }
    let mut length = 0;
    while n > 0 {
        text[length] = b'0' + (n % 10) as u8;
        n /= 10;
        length += 1;
    }
    text[..length].reverse();
    length
}

/// A number of units as text.
pub(super) fn units_text(units: i64) -> String {
    let mut text = [0; LONGEST];
    let length = put(units, &mut text);
    text[..length].iter().copied().map(char::from).collect()
}

/// A length in millimetres as text.
pub(super) fn text(mm: f64) -> String {
    units_text(units(mm))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// What the standard library says, in the form that is wanted here.
    fn expected(mm: f64) -> String {
        let long = format!("{mm:.4}");
        let short = long.trim_end_matches('0').trim_end_matches('.');
        if short == "-0" { "0".to_owned() } else { short.to_owned() }
    }

    #[test]
    fn ends_and_halves() {
        for (mm, wanted) in [
            (0.0, "0"),
            (-0.0, "0"),
            (-0.000_04, "0"),
            (1.0, "1"),
            (-1.5, "-1.5"),
            (0.000_1, "0.0001"),
            (0.031_25, "0.0312"),
            (0.093_75, "0.0938"),
            (-0.031_25, "-0.0312"),
            (99.999_96, "100"),
            (210.0, "210"),
            (12_345.678_9, "12345.6789"),
            (f64::NAN, "0"),
            (f64::INFINITY, "100000000000"),
            (f64::NEG_INFINITY, "-100000000000"),
        ] {
            assert_eq!(text(mm), wanted);
        }
    }

    proptest! {
        #[test]
        fn agrees_with_the_standard_library(mm in -1e5..1e5f64) {
            prop_assert_eq!(text(mm), expected(mm));
        }

        #[test]
        fn agrees_near_halves(half in -10_000_000i64..10_000_000, ulps in -2i32..=2) {
            let mut mm = (half as f64 + 0.5) / 10_000.0;
            for _ in 0..ulps.abs() {
                mm = if ulps > 0 { mm.next_up() } else { mm.next_down() };
            }
            prop_assert_eq!(text(mm), expected(mm));
        }

        #[test]
        fn reads_back(units in -1_000_000_000_000_000i64..=1_000_000_000_000_000) {
            let written = units_text(units);
            prop_assert!(written.len() <= LONGEST);
            let digits: i128 = written.replace('.', "").parse().unwrap();
            let decimals = written.split_once('.').map_or(0, |(_, d)| d.len() as u32);
            prop_assert_eq!(digits * 10i128.pow(4 - decimals), i128::from(units));
        }
    }
}
