use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};

/// The random numbers of one pixel: the same for any number of threads.
#[derive(Clone, Debug)]
pub(crate) struct Sampler {
    generator: ChaCha8Rng,
}

impl Sampler {
    /// Starts the stream `stream` of the seed `seed`.
    pub(crate) fn new(seed: u64, stream: u64) -> Self {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        generator.set_stream(stream);
        Self { generator }
    }

    /// Returns a number in [0, 1) with 53 random bits.
    #[expect(
        clippy::cast_precision_loss,
        reason = "53 bits are exactly representable"
    )]
    pub(crate) fn uniform(&mut self) -> f64 {
        (self.generator.next_u64() >> 11) as f64 * (0.5 * f64::EPSILON)
    }

    /// Returns two numbers in [0, 1).
    pub(crate) fn uniform_2d(&mut self) -> [f64; 2] {
        [self.uniform(), self.uniform()]
    }
}

/// The cells of a pixel in which its samples lie, one in each: `columns · rows` samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Strata {
    pub columns: u32,
    pub rows: u32,
}

impl Strata {
    /// Divides a pixel into `samples` equal cells, as square as the number allows.
    pub(crate) fn new(samples: u32) -> Self {
        let rows = (1..=samples.isqrt().max(1))
            .rev()
            .find(|rows| samples.is_multiple_of(*rows))
            .unwrap_or(1);
        Self {
            columns: samples / rows,
            rows,
        }
    }

    /// Returns the position in the pixel, in [0, 1)², of a point `u` of cell `index`.
    pub(crate) fn position(self, index: u32, u: [f64; 2]) -> [f64; 2] {
        let (column, row) = (index % self.columns, index / self.columns);
        [
            (f64::from(column) + u[0]) / f64::from(self.columns),
            (f64::from(row) + u[1]) / f64::from(self.rows),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_cell_of_the_pixel_gets_one_sample() {
        for samples in [1, 2, 7, 12, 16, 256] {
            let strata = Strata::new(samples);
            assert_eq!(strata.columns * strata.rows, samples);
            let mut area = 0.0;
            for index in 0..samples {
                let [x, y] = strata.position(index, [0.5, 0.5]);
                assert!(
                    (0.0..1.0).contains(&x) && (0.0..1.0).contains(&y),
                    "{x}, {y}"
                );
                area += x + y;
            }
            // The cell centres are symmetric about the middle of the pixel.
            assert!((area / f64::from(samples) - 1.0).abs() < 1e-12, "{samples}");
        }
        assert_eq!(
            Strata::new(256),
            Strata {
                columns: 16,
                rows: 16
            }
        );
    }

    #[test]
    fn streams_of_a_seed_differ_and_repeat() {
        let first = |seed, stream| Sampler::new(seed, stream).uniform().to_bits();
        assert_eq!(first(1, 2), first(1, 2));
        assert_ne!(first(1, 2), first(1, 3));
        assert_ne!(first(1, 2), first(2, 2));
    }
}
