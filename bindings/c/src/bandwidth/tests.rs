//! The functions against the library that they call.
#![expect(clippy::float_cmp, reason = "the same bits are asked for")]

use core::{
    f64::consts::TAU,
    ptr::{null, null_mut},
    slice,
};

use tem00_coherence::{CellGeometry, Relief, SourceExtent};
use tem00_decorrelation::{
    CameraFrame, Configuration, ConfigurationData, DVec3, Illumination, ImagingGeometry,
    PupilDistances, SpeckleMotion,
};

use super::*;
use crate::testing::{Owned, each_is_refused};

/// Head-on under 30°.
const DESCRIPTION: BandwidthDescription = BandwidthDescription {
    wavelength: 450e-9,
    linewidth: 20e-9,
    shape: PeakShape::Gaussian as u32,
    peaks: null(),
    peak_count: 0,
    to_source: [0.0, 0.0, 1.0],
    source_half_angle: 0.0,
    to_pupil: [0.5, 0.0, 0.866_025_403_784_438_6],
    normal: [0.0, 0.0, 1.0],
    sin_aperture: 0.025,
    rms_height: 0.4e-6,
    correlation_length: 0.0,
};

fn made(description: &BandwidthDescription) -> Owned<Bandwidth> {
    Owned::new(tem00_bandwidth_create, description, tem00_bandwidth_destroy)
}

impl Owned<Bandwidth> {
    fn info(&self) -> BandwidthInfo {
        ask!(tem00_bandwidth_describe(self.handle))
    }
}

#[test]
fn answers_are_those_of_the_library() {
    use tem00_coherence::PeakShape as S;
    let peaks = [[448e-9, 1.0], [453e-9, 3.0]];
    let line = |linewidth, shape| Spectrum::new(450e-9, linewidth, shape);
    let two = Spectrum::from_peaks(&peaks);
    let two = two.and_then(|line| line.with_linewidth(1e-9, S::Gaussian));
    let tall_heights = BandwidthDescription {
        shape: PeakShape::Lorentzian as u32,
        to_source: [-0.3, 0.4, 1.0],
        rms_height: 6e-6,
        correlation_length: 5e-6,
        ..DESCRIPTION
    };
    let one_wavelength_of_a_lamp_along_the_normal = BandwidthDescription {
        linewidth: 0.0,
        shape: PeakShape::Rectangular as u32,
        source_half_angle: 0.025,
        to_pupil: [0.0, 0.0, 1.0],
        ..DESCRIPTION
    };
    let two_peaks = BandwidthDescription {
        wavelength: f64::NAN,
        linewidth: 1e-9,
        peaks: peaks.as_ptr().cast(),
        peak_count: 2,
        ..DESCRIPTION
    };
    for (description, line) in [
        (DESCRIPTION, line(20e-9, S::Gaussian)),
        (tall_heights, line(20e-9, S::Lorentzian)),
        (
            one_wavelength_of_a_lamp_along_the_normal,
            line(0.0, S::Rectangular),
        ),
        (two_peaks, two),
    ] {
        let (owned, line, moved) = (made(&description), line.unwrap(), [0.3, 0.1]);
        let cell = cell(&description, line.wavelength());
        let speckle = PolychromaticSpeckle {
            spectrum: &line,
            cell: &cell,
        };
        let (handle, info, draw) = (owned.handle, owned.info(), line.draw(0.2));
        let wave = Wave {
            wave_number: draw,
            pupil_shift: draw / cell.tilt_wave_number(),
            phase_per_height: draw * cell.height_factor(),
        };
        agree! {
            description;
            tem00_bandwidth_covariance(handle, moved.as_ptr()) = speckle.covariance(moved);
            tem00_bandwidth_line_noise_ratio(handle, 0.0) = speckle.line_noise_ratio(Rows::Thin);
            tem00_bandwidth_line_noise_ratio(handle, 3.0) =
                speckle.line_noise_ratio(Rows::Height(3.0));
            tem00_bandwidth_draw(handle, 0.2) = wave;
        }
        let sum = speckle.patterns(|speckle| speckle.contrast().powi(2));
        // SAFETY: they belong to the handle.
        let (patterns, heights) = unsafe {
            (
                slice::from_raw_parts(info.patterns, info.pattern_count),
                slice::from_raw_parts(info.heights.cast::<[f64; 2]>(), info.height_count),
            )
        };
        assert_eq!((patterns, heights), (&*sum.fractions, &*sum.heights));
        assert_eq!(info.contrast, speckle.contrast());
        assert_eq!(info.coherence_length, line.coherence_length());
        assert_eq!(info.tilt_wave_number, cell.tilt_wave_number());
        let tilt = (-cell.tilt()).normalize_or_zero();
        assert_eq!(info.tilt, tilt.to_array());
    }
}

fn cell(description: &BandwidthDescription, wavelength: f64) -> ResolutionCell {
    let cell = ResolutionCell::new(CellGeometry {
        to_source: description.to_source.into(),
        to_pupil: description.to_pupil.into(),
        normal: description.normal.into(),
        sin_aperture: description.sin_aperture,
        wavelength,
    });
    let relief = Relief {
        rms_height: description.rms_height,
        correlation_length: description.correlation_length,
    };
    let extent = SourceExtent::disc(description.source_half_angle).unwrap();
    let cell = cell.unwrap().with_relief(relief).unwrap();
    cell.with_source_extent(extent)
}

#[test]
fn the_field_moves_over_the_pupil_as_a_change_of_wavelength_says() {
    const DISTANCE: f64 = 0.3;
    let owned = made(&BandwidthDescription {
        linewidth: 1e-12,
        to_source: [-0.3, 0.4, 1.0],
        ..DESCRIPTION
    });
    let (info, wave): (_, Wave) = (owned.info(), ask!(tem00_bandwidth_draw(owned.handle, 0.9)));
    let [to_pupil, to_source, normal] =
        [DESCRIPTION.to_pupil, [-0.3, 0.4, 1.0], DESCRIPTION.normal].map(DVec3::from_array);
    let pupil = DISTANCE * to_pupil.normalize();
    let camera = CameraFrame::look_at(pupil, DVec3::ZERO, DVec3::Y).unwrap();
    let mean = Configuration::new(ConfigurationData {
        wavelength: 450e-9,
        point: DVec3::ZERO,
        normal,
        illumination: Illumination::collimated(to_source).unwrap(),
        camera,
        pupil,
    });
    let mean = mean.unwrap();
    let wavelength = TAU / (TAU / 450e-9 + wave.wave_number);
    let other = mean.with_wavelength(wavelength).unwrap();
    let diameter = 2.0 * DESCRIPTION.sin_aperture * DISTANCE;
    let geometry = ImagingGeometry::from_distances(PupilDistances {
        wavelength: 450e-9,
        surface_to_pupil: DISTANCE,
        pupil_to_image: 75e-3,
        pupil_diameter: diameter,
        pixel_pitch: 3e-6,
    });
    let moved = SpeckleMotion::between(&geometry.unwrap(), &mean, &other);
    let [x, y] = (moved.pupil_displacement.unwrap() / diameter).to_array();
    let tilt = wave.pupil_shift * DVec3::from_array(info.tilt);
    for (ours, theirs) in [(tilt.dot(camera.right()), x), (tilt.dot(camera.up()), y)] {
        // The displacement is of first order in the change, which is 1e−6.
        assert!((ours / theirs - 1.0).abs() < 1e-4, "{ours} for {theirs}");
    }
    let phase = mean.height_phase_change(&other).unwrap();
    assert!(
        (wave.phase_per_height.abs() / phase.abs() - 1.0).abs() < 1e-6,
        "{phase}"
    );
}

#[test]
fn senseless_numbers_are_refused_by_name() {
    each_is_refused(
        DESCRIPTION,
        [
            ("wavelength", |d| d.wavelength = f64::NAN),
            ("linewidth", |d| d.linewidth = 50e-9),
            ("shape", |d| d.shape = 3),
            ("peaks", |d| {
                static MANY: [f64; 514] = [1.0; 514];
                (d.peak_count, d.peaks) = (257, MANY.as_ptr());
            }),
            ("to_source", |d| d.to_source = [0.0; 3]),
            ("source_half_angle", |d| d.source_half_angle = 0.4),
            ("to_pupil", |d| d.to_pupil = [0.0, 0.0, -1.0]),
            ("sin_aperture", |d| d.sin_aperture = 2.0),
            ("rms_height", |d| d.rms_height = 0.1),
            ("correlation_length", |d| d.correlation_length = -1.0),
        ],
        // SAFETY: the pointers are valid.
        |wrong, handle| unsafe { tem00_bandwidth_create(wrong, handle) },
    );
    let null_peaks = BandwidthDescription {
        peak_count: 1,
        ..DESCRIPTION
    };
    let (bandwidth, bad) = (made(&DESCRIPTION), [f64::INFINITY, 0.0]);
    let (handle, mut room, mut made) = (bandwidth.handle, [7.0; 3], null_mut());
    let out = room.as_mut_ptr();
    refused! {
        InvalidArgument {
            "uniform" tem00_bandwidth_draw(handle, -0.1, out.cast());
            "uniform" tem00_bandwidth_draw(handle, 1.0, out.cast());
            "uniform" tem00_bandwidth_draw(handle, f64::NAN, out.cast());
            "row_height" tem00_bandwidth_line_noise_ratio(handle, -1.0, out);
            "displacement" tem00_bandwidth_covariance(handle, bad.as_ptr(), out);
        }
        InvalidPointer {
            "peaks" tem00_bandwidth_create(&raw const null_peaks, &raw mut made);
            "info" tem00_bandwidth_describe(handle, null_mut());
            "bandwidth" tem00_bandwidth_draw(null(), 0.5, out.cast());
        }
    }
    assert_eq!(room, [7.0; 3], "nothing is written");
    assert!(made.is_null(), "a bandwidth was made");
}
