use core::{
    f64::consts::PI,
    sync::atomic::{AtomicUsize, Ordering},
};

use super::*;

const ZERO: Complex<f32> = Complex::new(0.0, 0.0);

/// Values without structure: a multiplicative walk, in [−½, ½).
fn aperture(width: usize, height: usize) -> Grid<Complex<f32>> {
    let walk = |i: usize| {
        let i = u32::try_from(i).unwrap();
        let value = (i.wrapping_mul(2_654_435_769) >> 8) as f32 / 16_777_216.0;
        value - 0.5
    };
    Grid::from_fn(width, height, |x, y| {
        Complex::new(walk(2 * (y * width + x) + 1), walk(2 * (y * width + x) + 2))
    })
}

/// The definition, in `f64`.
fn naive(width: usize, height: usize, aperture: &Grid<Complex<f32>>) -> Grid<Complex<f64>> {
    let wave = |n: usize, length: usize| {
        Complex::from_polar(1.0, -2.0 * PI * (n % length) as f64 / length as f64)
    };
    Grid::from_fn(width, height, |kx, ky| {
        let mut sum = Complex::new(0.0, 0.0);
        for (n, row) in aperture.rows().enumerate() {
            for (m, x) in row.iter().enumerate() {
                let x = Complex::new(f64::from(x.re), f64::from(x.im));
                sum += x * wave(m * kx, width) * wave(n * ky, height);
            }
        }
        sum
    })
}

fn norm(values: impl Iterator<Item = f64>) -> f64 {
    values.sum::<f64>().sqrt()
}

#[test]
fn transform_is_the_definition_for_any_size() {
    for (width, height, aperture_width, aperture_height) in [
        (1, 1, 1, 1),
        (2, 2, 1, 1),
        (2, 2, 2, 1),
        (8, 8, 4, 4),
        (8, 8, 5, 5),
        (16, 16, 9, 9),
        (32, 32, 17, 17),
        (64, 48, 33, 19),
        (48, 64, 17, 64),
        (12, 30, 4, 7),
        (7, 13, 3, 5),
        (31, 17, 31, 17),
        (36, 36, 10, 9),
        (100, 1, 20, 1),
        (1, 100, 1, 49),
        (45, 40, 16, 37),
        (600, 1, 301, 1),
        (1, 1_200, 1, 590),
    ] {
        let input = aperture(aperture_width, aperture_height);
        let expected = naive(width, height, &input);
        let transform =
            Fft2::with_aperture(width, height, aperture_width, aperture_height).unwrap();
        let got = transform.forward(&input, |_, _, value| value);
        let error = norm(
            got.values()
                .iter()
                .zip(expected.values())
                .map(|(g, e)| (f64::from(g.re) - e.re).powi(2) + (f64::from(g.im) - e.im).powi(2)),
        );
        let size = norm(expected.values().iter().map(Complex::norm_sqr));
        // Higham 2002, theorem 24.2: log₂ n · 7 u in norm for powers of two, with u = 2⁻²⁴;
        // other lengths take three transforms of up to four times the length.
        let levels = ((width * height) as f64).log2() + 4.0;
        let tolerance = 3.0 * levels * 7.0 * 2.0_f64.powi(-24);
        assert!(
            error <= tolerance * size,
            "{aperture_width} × {aperture_height} in {width} × {height}: {:e}",
            error / size
        );
    }
}

#[test]
fn the_mean_square_of_the_transform_is_the_sum_of_the_squares() {
    for (size, aperture_size) in [(256, 129), (250, 100), (127, 50)] {
        let input = aperture(aperture_size, aperture_size);
        let transform = Fft2::with_aperture(size, size, aperture_size, aperture_size).unwrap();
        let squares = transform.forward(&input, |_, _, value| f64::from(value.norm_sqr()));
        let sum: f64 = input.values().iter().map(|x| f64::from(x.norm_sqr())).sum();
        let mean = squares.values().iter().sum::<f64>() / (size * size) as f64;
        // Rounding errors of 2⁻²⁴ times a few per level are random over 10⁴ values.
        assert!((mean / sum - 1.0).abs() < 1e-6, "{size}: {mean} for {sum}");
    }
}

#[test]
fn finish_sees_every_frequency_once() {
    for (width, height, aperture) in [(24, 20, 12), (30, 21, 10), (11, 9, 8)] {
        let transform = Fft2::with_aperture(width, height, aperture, aperture).unwrap();
        let input = Grid::filled(aperture, aperture, ZERO);
        let places = transform.forward(&input, |x, y, _| (x, y));
        assert_eq!(places, Grid::from_fn(width, height, |x, y| (x, y)));
    }
}

/// The memory comes from the transform before, larger or smaller.
#[test]
fn an_aperture_made_on_the_way_gives_the_same_bits() {
    let mut scratch = Fft2Scratch::default();
    for (width, height) in [(1, 1), (61, 45), (64, 8), (150, 9), (12, 5)] {
        let input = aperture(width, height);
        let transform = Fft2::with_aperture(2 * width, 2 * height, width, height).unwrap();
        let filled = Grid::from_fn(width, height, |_, _| AtomicUsize::new(0));
        let mut output = Grid::filled(2 * width, 2 * height, ZERO);
        let fill = |columns: Range<usize>, y, values: &mut [_]| {
            assert!(
                columns.start.is_multiple_of(8) && columns.len() <= 64,
                "a piece of {columns:?}"
            );
            for (x, value) in columns.zip(values) {
                *value = input[(x, y)];
                filled[(x, y)].fetch_add(1, Ordering::Relaxed);
            }
        };
        transform.forward_from(fill, &mut output, &mut scratch, |_, _, value| value);
        assert_eq!(output, transform.forward(&input, |_, _, value| value));
        let once = filled
            .values()
            .iter()
            .all(|n| n.load(Ordering::Relaxed) == 1);
        assert!(once, "{width} × {height}: every place once");
    }
}

#[cfg(feature = "parallel")]
#[test]
fn the_result_is_the_same_bits_for_any_number_of_threads() {
    let input = aperture(61, 45);
    let transform = Fft2::with_aperture(120, 90, 61, 45).unwrap();
    let with_threads = |threads| {
        tem00_testkit::on_threads(threads, || transform.forward(&input, |_, _, value| value))
    };
    assert_eq!(with_threads(1), with_threads(3));
}

#[cfg(feature = "parallel")]
#[test]
fn a_transform_on_one_thread_stays_there() {
    let input = aperture(61, 45);
    let transform = Fft2::with_aperture(120, 90, 61, 45).unwrap();
    let alone = transform.clone().on_one_thread();
    // A test does not run on a thread of a pool, so that shared work has to leave it.
    let pooled = |transform: &Fft2| {
        let threads = transform.forward(&input, |_, _, _| rayon::current_thread_index());
        threads
            .values()
            .iter()
            .filter(|thread| thread.is_some())
            .count()
    };
    assert_eq!((pooled(&alone), pooled(&transform)), (0, 120 * 90));
    let values = |transform: &Fft2| transform.forward(&input, |_, _, value| value);
    assert_eq!(values(&alone), values(&transform));
}

/// The serial loop and the threads cut the work into the same pieces, and each piece is computed
/// alone: the test compares one piece computed together with all the others and without them.
#[test]
fn a_column_is_the_same_bits_alone() {
    let input = aperture(40, 24);
    let wide = Fft2::with_aperture(80, 48, 40, 24).unwrap();
    let mut other = input.clone();
    for y in 0..24 {
        for x in 0..16 {
            other[(x, y)] = ZERO;
        }
    }
    let spectra = |aperture: &Grid<Complex<f32>>| {
        let mut scratch = Fft2Scratch::default();
        let mut output = Grid::filled(80, 48, ZERO);
        let copy = |columns: Range<usize>, y, values: &mut [_]| {
            values.copy_from_slice(&aperture.row(y)[columns]);
        };
        wide.forward_from(copy, &mut output, &mut scratch, |_, _, value| value);
        aligned(&mut scratch.blocks, 48 * 40)[48 * 16..].to_vec()
    };
    assert_eq!(spectra(&input), spectra(&other));
}

#[test]
fn sizes_without_a_transform_are_refused() {
    assert!(matches!(Fft2::new(0, 4), Err(Fft2Error::Empty)), "width 0");
    assert!(
        matches!(Fft2::with_aperture(4, 4, 1, 0), Err(Fft2Error::Empty)),
        "aperture height 0"
    );
    assert!(
        matches!(
            Fft2::with_aperture(8, 8, 9, 4),
            Err(Fft2Error::Aperture { .. })
        ),
        "an aperture wider than the array"
    );
}

#[test]
#[should_panic(expected = "aperture and plan differ in size")]
fn an_aperture_of_another_size_panics() {
    let transform = Fft2::with_aperture(8, 8, 4, 4).unwrap();
    let _ = transform.forward(&aperture(4, 5), |_, _, value| value);
}
