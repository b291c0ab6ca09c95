use tem00_numerics::disc_overlap;
use tem00_testkit::assert_absolute;

use super::*;
use crate::{
    CellGeometry, DVec3, PeakShape, PolychromaticSpeckle, Relief, ResolutionCell, SourceExtent,
    Spectrum,
};

const KERNELS: [LagKernel; 3] = [
    LagKernel::CONTRAST,
    LagKernel { contrast_like: 0.4 },
    LagKernel { contrast_like: 0.0 },
];

/// The largest difference between the table and integrals over lags, for many phases and
/// displacements.
fn largest_error(kernel: LagKernel, length: f64) -> f64 {
    let table = table::Table::new(kernel, length);
    let mut largest: f64 = 0.0;
    for phase in [0.03, 0.4, 1.1, 3.3, 7.0, 30.0, 200.0] {
        for shift in [0.0, 0.004, 0.07, 0.33, 0.77, 0.99, 1.01, 1.2, 2.9, 20.0] {
            let exact = by_lags(kernel, length, [phase, shift]);
            largest = largest.max((table.at(phase, shift) - exact).abs());
        }
    }
    largest
}

#[test]
fn the_table_holds_the_integrals() {
    for kernel in KERNELS {
        for length in [0.01, 0.3, 1.0, 4.0, 25.0] {
            let error = largest_error(kernel, length);
            assert!(error < 1e-6, "{kernel:?} {length}: {error:e}");
        }
        // Beyond the longest length the loss agrees, but not its dependence on phases and
        // displacements.
        for length in [33.0, 70.0] {
            let error = largest_error(kernel, length);
            assert!(error < 3e-3, "{kernel:?} {length}: {error:e}");
        }
    }
}

#[test]
fn an_endless_relief_spreads_no_paths() {
    for kernel in KERNELS {
        for length in [1e6, 1e15, 1e300] {
            let table = table::Table::new(kernel, length);
            for (phase, shift) in [(0.3, 0.0), (2.0, 0.4), (20.0, 0.9), (3.0, 1.2)] {
                let all = kernel.transform(shift) * (1.0 - (-f64::powi(phase, 2)).exp());
                // 4/π² of a speckle's light lies farther than a lag, in speckles, from its middle.
                assert_absolute(table.at(phase, shift), all, 2e-5);
            }
        }
    }
}

/// Sums over both directions of the light, each with all lags.
#[test]
fn two_directions_and_a_relief_are_their_sum() {
    let cell = ResolutionCell::new(CellGeometry {
        to_source: DVec3::new(0.3, 0.1, 1.0),
        to_pupil: DVec3::new(-0.2, 0.0, 1.0),
        normal: DVec3::Z,
        sin_aperture: 0.02,
        wavelength: 650e-9,
    });
    let relief = Relief {
        rms_height: 2e-6,
        correlation_length: 8e-6,
    };
    let cell = cell.unwrap().with_relief(relief).unwrap();
    let spectrum = Spectrum::new(650e-9, 8e-9, PeakShape::Gaussian).unwrap();
    let other = cell.source() + DVec3::new(0.0, 0.013, 0.0);
    let list = [(cell.source(), 1.0), (other, 2.0)];
    let extent = SourceExtent::directions(&list).unwrap();
    let (mut sum, wave_number) = (0.0, spectrum.wave_number());
    let tilt = cell.tilt_wave_number();
    extent.for_each_difference(cell.source(), 1.0, |change, share| {
        let (moved, heights) = cell.change_with_source(change);
        sum += share
            * spectrum.mean_over_pairs(cell.scale(), |kappa| {
                let shift = (wave_number * moved.x + kappa / tilt).hypot(wave_number * moved.y);
                let phase = (kappa + wave_number * heights) * cell.path_spread();
                let dense = disc_overlap(shift).powi(2) * (-phase * phase).exp();
                let length = cell.correlation_length();
                dense + by_lags(LagKernel::CONTRAST, length, [phase.abs(), shift])
            });
    });
    let cell = &cell.with_source_extent(extent);
    let found = PolychromaticSpeckle {
        spectrum: &spectrum,
        cell,
    }
    .contrast()
    .powi(2);
    assert!((found - sum).abs() < 2e-6, "{found} {sum}");
}

/// The number of all terms that are summed, for any relief.
#[test]
fn the_work_is_bounded() {
    for length in [1e-300, 1e-3, 1.0, 32.0, 1e5, f64::MAX] {
        let (sums, cells) = table::Table::new(LagKernel::CONTRAST, length).size();
        assert!(
            sums < 5_000_000 && cells < 2_100,
            "{length:e}: {sums} {cells}"
        );
    }
}
