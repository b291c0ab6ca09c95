use super::lattice::Lattice;

/// The maximum number of lattices over which a mean is taken, out of all from which pixels draw.
const LATTICES: usize = 8;

/// Returns the mean of a function of the displacement between two samples of a pixel, in pixels:
/// over all pairs of samples, each sample with itself included, and over all pixels.
///
/// The mean of the autocovariance of a pattern is the variance of the pixels of a render, each of
/// which is the mean of `samples_per_pixel` samples.
///
/// # Panics
///
/// Panics if `samples_per_pixel` is 0.
///
/// # Examples
///
/// With four samples, one in four pairs is a sample with itself:
///
/// ```
/// use tem00_engine::mean_over_sample_displacements;
///
/// let together = |[x, y]: [f64; 2]| if x.hypot(y) < 1e-9 { 1.0 } else { 0.0 };
/// assert!((mean_over_sample_displacements(4, together) - 0.25).abs() < 1e-12);
/// ```
pub fn mean_over_sample_displacements(samples_per_pixel: u32, f: impl Fn([f64; 2]) -> f64) -> f64 {
    let count = samples_per_pixel;
    assert!(count > 0, "a pixel needs a sample");
    let lattices = Lattice::good(count);
    let lattices = lattices.iter().step_by(lattices.len().div_ceil(LATTICES));
    let (mut sum, mut pixels) = (0.0, 0.0);
    for lattice in lattices {
        sum += f([0.0; 2]);
        for index in 1..count {
            let [x, y] = lattice
                .column_and_row(index, count)
                .map(|columns| along(columns, count));
            let of_y = |x: f64| y.iter().map(|(y, weight)| weight * f([x, *y])).sum::<f64>();
            sum += x.iter().map(|(x, weight)| weight * of_y(*x)).sum::<f64>();
        }
        pixels += 1.0;
    }
    sum / (pixels * f64::from(count))
}

/// Returns the displacements, with their weights, along one axis of two samples whose columns are
/// `columns` apart on the torus.
///
/// Both samples lie anywhere in their columns. Neighbouring columns mirror each other in pairs, of
/// which `count` columns have `count / 2`.
fn along(columns: u32, count: u32) -> Vec<(f64, f64)> {
    let n = f64::from(count);
    // Columns of many samples are too narrow for their inside to matter.
    let nodes: u32 = if count < 32 { 16 } else { 2 };
    let mirrored = f64::from(count / 2) / (n - 1.0);
    let apart = f64::from(columns);
    let parts = [(apart, 1.0 - apart / n), (apart - n, apart / n)];
    let places = |(apart, part): (f64, f64)| {
        let mirrored = if apart.abs() < 1.5 { mirrored } else { 0.0 };
        (0..nodes).map(move |node| {
            let step = 2.0 / f64::from(nodes);
            let within = step * (f64::from(node) + 0.5) - 1.0;
            let density = 0.5 * mirrored + (1.0 - mirrored) * (1.0 - within.abs());
            ((apart + within) / n, part * step * density)
        })
    };
    parts.into_iter().flat_map(places).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampler::{Sequence, Stream, pixel_key};

    #[test]
    fn displacements_are_those_of_the_samples_that_pixels_get() {
        const PIXELS: u32 = 4000;
        for count in [1, 2, 3, 4, 7, 16, 64] {
            let sequence = Sequence::new(count);
            for size in [0.1, 0.4, 1.6] {
                // A smooth autocovariance, as speckle has.
                let law = |[x, y]: [f64; 2]| (-(x * x + y * y) / (size * size)).exp();
                let of_pixel = |pixel: u32| {
                    let first = Stream {
                        key: pixel_key(3, [0, pixel.into(), 0]),
                        level: 0,
                        index: 0,
                    };
                    let mut places = vec![[0.0; 2]; count as usize];
                    sequence.positions(first, &mut places);
                    let pairs = places
                        .iter()
                        .flat_map(|a| places.iter().map(move |b| [a[0] - b[0], a[1] - b[1]]));
                    pairs.map(law).sum::<f64>() / f64::from(count * count)
                };
                let values: Vec<f64> = (0..PIXELS).map(of_pixel).collect();
                let moments = tem00_statistics::Moments::from_samples(&values).unwrap();
                let expected = mean_over_sample_displacements(count, law);
                let error = (moments.mean() - expected).abs();
                // Two nodes leave (1/64)²/12 of the second derivative, 4/h², times what is not of a
                // sample with itself.
                let tolerance = 4.0 * moments.standard_error() + 2e-3 * expected;
                assert!(
                    error < tolerance,
                    "{count}, {size}: {} {expected}",
                    moments.mean()
                );
            }
        }
    }
}
