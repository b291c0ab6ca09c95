//! What a relief costs that is not finer than a speckle.

use tem00::coherence::{PolychromaticSpeckle, Relief, ResolutionCell};

use super::{
    bench::{Bench, BenchSpectrum, View, plane_of_incidence},
    heights::Heights,
    sums::{Moments, assert_agrees, contrast, for_surfaces},
};

/// Contrast of a Gaussian line of 5 nm on a relief of 6.4 µm, head-on: as of 20 nm on 1.6 µm.
#[test]
fn relief_as_long_as_a_speckle_spreads_fewer_paths() {
    let rms = 6.4e-6;
    for length in [0.5, 1.0, 2.0, 4.0] {
        let head_on = plane_of_incidence(0.0, 0.0);
        let heights = Heights::Correlated { rms, length };
        let bench = Bench::with_step(head_on, [16, 16], heights, 3.25e4);
        let spectrum = BenchSpectrum::gaussian(bench.view.wavelength, bench.step, 7, 5e-9);
        let surfaces = for_surfaces(44, 7, |random| {
            let surface = bench.surface(random, |_| 1.0);
            let images = &bench.images(&surface, 7, &[View::default()], random)[0];
            Moments::new(&spectrum.mix(images), images)
        });
        let relief = Relief {
            rms_height: rms,
            correlation_length: length * bench.speckle_size(),
        };
        let cell = ResolutionCell::new(head_on).and_then(|cell| cell.with_relief(relief));
        let law = PolychromaticSpeckle {
            spectrum: &spectrum.line,
            cell: &cell.expect("a cell"),
        };
        let waves = contrast(&surfaces);
        assert_agrees(&format!("ℓ = {length} h"), waves, law.contrast(), 0.01);
    }
}
