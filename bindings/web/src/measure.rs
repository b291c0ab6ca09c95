//! Speckle measured in the frame, beside what theory says of the same samples.

use tem00_statistics::airy_autocovariance;
use wasm_bindgen::prelude::wasm_bindgen;

/// Camera samples along each side of a pixel: the film averages them as a sensor its area.
pub const SAMPLES: u32 = 3;

/// Contrast and size of the speckle on the lit pixels of a frame.
#[wasm_bindgen]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// Standard deviation over mean of the speckle in the lit pixels.
    pub contrast: f64,
    /// Theoretical contrast for the speckle size of the lens.
    pub contrast_in_theory: f64,
    /// Speckle size, in pixels: that whose neighbouring pixels are as much alike as those of the
    /// frame.
    pub size: f64,
    /// Theoretical speckle size, λ d / D.
    pub size_in_theory: f64,
    /// Correlation with the part at rest, in the mean over the lit pixels, by theory.
    pub correlation: f64,
    /// The lit pixels.
    pub pixels: u32,
}

/// Measures the speckle on a film of `width` pixels a row: light with speckle, light without, light
/// of the lamp, correlation.
///
/// Pixels count that have at least a tenth of the brightest one's light. Returns `None` where fewer
/// than 200 do: of so few nothing can be said.
pub fn measure(film: &[[f32; 4]], width: usize, size_in_theory: f64) -> Option<Measured> {
    let brightest = film.iter().fold(0.0_f32, |max, pixel| max.max(pixel[1]));
    let is_lit = |pixel: &[f32; 4]| pixel[1] >= 0.1 * brightest && pixel[1] > 0.0;
    let factor = |pixel: &[f32; 4]| is_lit(pixel).then(|| f64::from(pixel[0] / pixel[1]));
    let factors: Vec<Option<f64>> = film.iter().map(factor).collect();
    let lit: Vec<f64> = factors.iter().copied().flatten().collect();
    if lit.len() < 200 {
        return None;
    }
    let mean = lit.iter().sum::<f64>() / lit.len() as f64;
    let variance = lit.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / lit.len() as f64;
    // Neighbours in a row; the last pixel of a row has none.
    let pairs = factors.chunks(width).flat_map(|row| row.windows(2));
    let product = |pair: &[Option<f64>]| Some((pair[0]? - mean) * (pair[1]? - mean));
    let products: Vec<f64> = pairs.filter_map(product).collect();
    let likeness = products.iter().sum::<f64>() / products.len() as f64 / variance;
    let [at_rest, _] = covariances(size_in_theory);
    let correlations = film.iter().filter(|pixel| is_lit(pixel));
    let correlation = correlations.map(|pixel| f64::from(pixel[3])).sum::<f64>() / lit.len() as f64;
    Some(Measured {
        contrast: variance.sqrt() / mean,
        contrast_in_theory: at_rest.sqrt(),
        size: size_of(likeness),
        size_in_theory,
        correlation,
        pixels: u32::try_from(lit.len()).unwrap_or(u32::MAX),
    })
}

/// The variance of a pixel, the mean of its samples, and its covariance with the next one, for a
/// speckle size in pixels.
fn covariances(size: f64) -> [f64; 2] {
    let place = |i: u32| (f64::from(i) + 0.5) / f64::from(SAMPLES);
    let offsets: Vec<f64> = (0..SAMPLES)
        .flat_map(|i| (0..SAMPLES).map(move |j| place(i) - place(j)))
        .collect();
    let count = (offsets.len() * offsets.len()) as f64;
    [0.0, 1.0].map(|lag| {
        let terms = offsets.iter().flat_map(|x| {
            offsets
                .iter()
                .map(move |y| airy_autocovariance((x + lag).hypot(*y) / size))
        });
        terms.sum::<f64>() / count
    })
}

/// The speckle size whose neighbouring pixels correlate so, by bisection; 0 or infinite beyond 0.3
/// to 30 pixels.
fn size_of(likeness: f64) -> f64 {
    let of = |size: f64| {
        let [variance, next] = covariances(size);
        next / variance
    };
    let [mut low, mut high] = [0.3_f64, 30.0];
    if likeness < of(low) {
        return 0.0;
    }
    if likeness > of(high) {
        return f64::INFINITY;
    }
    for _ in 0..40 {
        let middle = (low * high).sqrt();
        if of(middle) < likeness {
            low = middle;
        } else {
            high = middle;
        }
    }
    (low * high).sqrt()
}

/// The root of the mean square and the largest of the differences between the speckle of two films,
/// where both are lit.
pub fn difference(a: &[[f32; 4]], b: &[[f32; 4]]) -> [f64; 2] {
    let factor = |pixel: &[f32; 4]| f64::from(pixel[0] / pixel[1]);
    let lit = a.iter().zip(b).filter(|(a, b)| a[1] > 0.0 && b[1] > 0.0);
    let [count, squares, largest] =
        lit.fold([0.0, 0.0, 0.0_f64], |[count, squares, largest], (a, b)| {
            let apart = (factor(a) - factor(b)).abs();
            [count + 1.0, squares + apart * apart, largest.max(apart)]
        });
    [(squares / count).sqrt(), largest]
}
