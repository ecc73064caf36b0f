//! How alike two pictures are to the eye: structural similarity (Wang, Bovik, Sheikh and Simoncelli, "Image quality
//! assessment: from error visibility to structural similarity", 2004).
//!
//! In: two pictures in 8-bit grey, equally large. Windows are Gaussian of deviation 1.5, 11 x 11 pixels, and moments are
//! those of the window as a distribution, without a sample's correction. The mean is taken over the windows that lie
//! wholly in the picture, as scikit-image does for the same parameters.

use rayon::prelude::*;

/// Pixels that a window reaches to each side.
const REACH: usize = 5;

/// The width and height of a window in pixels: no picture may be smaller.
pub const WINDOW: usize = 2 * REACH + 1;

/// The window's deviation in pixels.
const SIGMA: f64 = 1.5;

/// The greatest value.
const MOST: f64 = 255.0;

/// What keeps quotients of dark windows finite: (0.01 L)^2.
const C1: f64 = (0.01 * MOST) * (0.01 * MOST);

/// The same for even ones: (0.03 L)^2.
const C2: f64 = (0.03 * MOST) * (0.03 * MOST);

/// A picture in 8-bit grey.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Grey {
    /// Pixels in a row.
    pub width: usize,
    /// Row by row from the top left.
    pub data: Vec<u8>,
}

impl Grey {
    fn height(&self) -> usize {
        self.data.len() / self.width.max(1)
    }
}

/// The structural similarity of two pictures, in [-1, 1]: 1 where they are the same. None where they are not equally large
/// or smaller than a window.
#[must_use]
pub fn ssim(a: &Grey, b: &Grey) -> Option<f64> {
    let (width, height) = (a.width, a.height());
    if b.width != width || b.data.len() != a.data.len() || width < WINDOW || height < WINDOW {
        return None;
    }
    let window = window();
    // Every row of windows by itself; the sums are added in the order of the rows, whatever the threads.
    let rows: Vec<f64> =
        (0..height - 2 * REACH).into_par_iter().map(|top| row(a, b, top, &window).iter().sum::<f64>()).collect();
    let windows = (width - 2 * REACH) * (height - 2 * REACH);
    Some(rows.iter().sum::<f64>() / windows as f64)
}

/// The window's weights along one side; they add up to 1.
fn window() -> [f64; WINDOW] {
    let weights: [f64; WINDOW] = std::array::from_fn(|i| {
        let off = i as f64 - REACH as f64;
        libm::exp(-off * off / (2.0 * SIGMA * SIGMA))
    });
    let all: f64 = weights.iter().sum();
    weights.map(|weight| weight / all)
}

/// The similarity of every window whose first row is `top`.
fn row(a: &Grey, b: &Grey, top: usize, window: &[f64; WINDOW]) -> Vec<f64> {
    let width = a.width;
    // Moments of columns first, then of windows.
    let mut columns = vec![[0.0; 5]; width];
    for (i, weight) in window.iter().enumerate() {
        let from = (top + i) * width;
        let (ours, theirs) = (&a.data[from..from + width], &b.data[from..from + width]);
        for (column, (&x, &y)) in columns.iter_mut().zip(ours.iter().zip(theirs)) {
            let (x, y) = (f64::from(x), f64::from(y));
            for (sum, value) in column.iter_mut().zip([x, y, x * x, y * y, x * y]) {
                *sum += weight * value;
            }
        }
    }
    columns
        .windows(WINDOW)
        .map(|columns| {
            let mut moments = [0.0; 5];
            for (column, weight) in columns.iter().zip(window) {
                moments.iter_mut().zip(column).for_each(|(sum, value)| *sum += weight * value);
            }
            let [x, y, xx, yy, xy] = moments;
            let (variance, other, covariance) = (xx - x * x, yy - y * y, xy - x * y);
            ((2.0 * x * y + C1) * (2.0 * covariance + C2)) / ((x * x + y * y + C1) * (variance + other + C2))
        })
        .collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn grey(width: usize, height: usize, value: impl Fn(usize, usize) -> u8) -> Grey {
        let value = &value;
        Grey { width, data: (0..height).flat_map(|y| (0..width).map(move |x| value(x, y))).collect() }
    }

    /// What scikit-image 0.26 says of the same pictures.
    #[test]
    fn pictures_are_as_alike_as_scikit_image_finds() {
        let stripes = grey(40, 30, |x, y| if (x + 2 * y) % 7 < 3 { 20 } else { 235 });
        let shifted = grey(40, 30, |x, y| if (x + 2 * y + 1) % 7 < 3 { 20 } else { 235 });
        let ramp = grey(40, 30, |x, y| (x * 5 + y) as u8);
        assert!(
            (ssim(&stripes, &shifted).unwrap() - 0.418_144_633_163_812_45).abs() < 1e-6,
            "{:?}",
            ssim(&stripes, &shifted)
        );
        assert!(
            (ssim(&stripes, &ramp).unwrap() - 0.004_549_245_270_111_344).abs() < 1e-6,
            "{:?}",
            ssim(&stripes, &ramp)
        );
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]

        #[test]
        fn similarity_is_even_handed_and_one_of_equals(a in prop::collection::vec(any::<u8>(), 13 * 12), b in prop::collection::vec(any::<u8>(), 13 * 12)) {
            let (a, b) = (Grey { width: 13, data: a }, Grey { width: 13, data: b });
            prop_assert!((ssim(&a, &a).unwrap() - 1.0).abs() < 1e-12);
            let found = ssim(&a, &b).unwrap();
            prop_assert_eq!(Some(found), ssim(&b, &a));
            prop_assert!((-1.0..=1.0).contains(&found));
        }
    }

    #[test]
    fn pictures_must_fit() {
        let (small, wide) = (grey(10, 30, |_, _| 0), grey(30, 11, |_, _| 0));
        assert_eq!((ssim(&small, &small), ssim(&wide, &small)), (None, None));
        assert_eq!(ssim(&wide, &wide), Some(1.0));
        assert_eq!(ssim(&grey(0, 0, |_, _| 0), &grey(0, 0, |_, _| 0)), None);
    }
}
