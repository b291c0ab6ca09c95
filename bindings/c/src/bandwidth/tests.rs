//! The functions against the library that they call.
#![expect(clippy::float_cmp, reason = "the same bits are asked for")]

use core::{f64::consts::TAU, ptr, slice};

use tem00_decorrelation::{
    CameraFrame, Configuration, ConfigurationData, DVec3, Illumination, ImagingGeometry,
    PupilDistances, SpeckleMotion,
};

use super::*;
use crate::{
    status::Status,
    testing::{each_is_refused, last_parameter, number_is_refused, pointer_is_refused},
};

/// Head-on under 30°.
const DESCRIPTION: BandwidthDescription = BandwidthDescription {
    wavelength: 450e-9,
    linewidth: 20e-9,
    shape: LineShape::Gaussian as u32,
    peaks: ptr::null(),
    peak_count: 0,
    to_source: [0.0, 0.0, 1.0],
    source_half_angle: 0.0,
    to_pupil: [0.5, 0.0, 0.866_025_403_784_438_6],
    normal: [0.0, 0.0, 1.0],
    sin_aperture: 0.025,
    rms_height: 0.4e-6,
    correlation_length: 0.0,
};

/// A handle that frees itself.
struct Owned(*mut Bandwidth);

impl Drop for Owned {
    fn drop(&mut self) {
        // SAFETY: it was created by the interface and is not used again.
        unsafe { tem00_bandwidth_destroy(self.0) };
    }
}

fn create(description: &BandwidthDescription) -> (Status, Owned) {
    let mut handle = ptr::null_mut();
    // SAFETY: the pointers are valid.
    let status = unsafe { tem00_bandwidth_create(description, &raw mut handle) };
    (status, Owned(handle))
}

fn made(description: &BandwidthDescription) -> Owned {
    let (status, owned) = create(description);
    assert_eq!(status, Status::Ok, "{}", last_parameter());
    owned
}

/// Asks the interface, which must succeed.
fn answer<R>(mut result: R, question: impl FnOnce(*mut R) -> Status) -> R {
    let status = question(&raw mut result);
    assert_eq!(status, Status::Ok, "{}", last_parameter());
    result
}

const NO_WAVE: Wave = Wave {
    wave_number: f64::NAN,
    pupil_shift: f64::NAN,
    phase_per_height: f64::NAN,
};

impl Owned {
    fn info(&self) -> BandwidthInfo {
        // SAFETY: the handle is valid.
        let unknown = unsafe { &*self.0 }.info();
        // SAFETY: the handle is valid.
        answer(unknown, |info| unsafe {
            tem00_bandwidth_describe(self.0, info)
        })
    }

    fn draw(&self, uniform: f64) -> Wave {
        // SAFETY: the handle is valid.
        answer(NO_WAVE, |wave| unsafe {
            tem00_bandwidth_draw(self.0, uniform, wave)
        })
    }

    fn covariance(&self, displacement: [f64; 2]) -> f64 {
        // SAFETY: the pointers are valid.
        answer(f64::NAN, |covariance| unsafe {
            tem00_bandwidth_covariance(self.0, displacement.as_ptr(), covariance)
        })
    }

    fn line_noise_ratio(&self, row_height: f64) -> f64 {
        // SAFETY: the handle is valid.
        answer(f64::NAN, |ratio| unsafe {
            tem00_bandwidth_line_noise_ratio(self.0, row_height, ratio)
        })
    }

    fn patterns(&self) -> &[f64] {
        let info = self.info();
        // SAFETY: they belong to the handle.
        unsafe { slice::from_raw_parts(info.patterns, info.pattern_count) }
    }

    fn heights(&self) -> &[[f64; 2]] {
        let info = self.info();
        // SAFETY: they belong to the handle.
        unsafe { slice::from_raw_parts(info.heights.cast(), info.height_count) }
    }
}

#[test]
fn answers_are_those_of_the_library() {
    let owned = made(&DESCRIPTION);
    let line = SpectralLine::new(450e-9, 20e-9, tem00_coherence::LineShape::Gaussian).unwrap();
    let cell = DESCRIPTION.cell(450e-9).unwrap();
    let speckle = PolychromaticSpeckle {
        line: &line,
        cell: &cell,
    };
    let info = owned.info();
    assert_eq!(info.contrast, speckle.contrast());
    assert_eq!(info.coherence_length, line.coherence_length());
    assert_eq!(info.tilt_wave_number, cell.tilt_wave_number());
    assert_eq!(owned.covariance([0.3, 0.1]), speckle.covariance([0.3, 0.1]));
    assert_eq!(
        owned.line_noise_ratio(0.0),
        speckle.line_noise_ratio(Rows::Thin)
    );
    let tall = speckle.line_noise_ratio(Rows::Height(3.0));
    assert_eq!(owned.line_noise_ratio(3.0), tall);
    let wave = owned.draw(0.2);
    assert_eq!(wave.wave_number, line.draw(0.2));
    assert_eq!(wave.pupil_shift, line.draw(0.2) / cell.tilt_wave_number());
    assert_eq!(wave.phase_per_height, line.draw(0.2) * cell.height_factor());
    assert_eq!(owned.patterns(), [1.0], "the tilt and few heights");
    let fractions: f64 = owned.heights().iter().map(|height| height[1].powi(2)).sum();
    assert!((fractions - 1.0).abs() < 1e-12, "{fractions}");
}

#[test]
fn heights_that_dominate_are_modes() {
    let rough = BandwidthDescription {
        rms_height: 6e-6,
        ..DESCRIPTION
    };
    let owned = made(&rough);
    assert!(owned.heights().is_empty(), "{:?}", owned.heights());
    let squares: f64 = owned
        .patterns()
        .iter()
        .map(|fraction| fraction.powi(2))
        .sum();
    let ratio = squares.sqrt() / owned.info().contrast;
    // Modes of together 1e−4 of the light are left out.
    assert!((ratio - 1.0).abs() < 0.01, "{ratio}");
}

#[test]
fn the_field_moves_over_the_pupil_as_a_change_of_wavelength_says() {
    const DISTANCE: f64 = 0.3;
    let owned = made(&BandwidthDescription {
        linewidth: 1e-12,
        to_source: [-0.3, 0.4, 1.0],
        ..DESCRIPTION
    });
    let (info, wave) = (owned.info(), owned.draw(0.9));
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
fn the_extent_of_a_source_is_patterns() {
    let wide = made(&BandwidthDescription {
        source_half_angle: 0.025,
        ..DESCRIPTION
    });
    let squares = |owned: &Owned| owned.patterns().iter().map(|part| part * part).sum::<f64>();
    let point = made(&DESCRIPTION);
    assert_eq!(wide.heights(), point.heights());
    let ratio = (wide.info().contrast / point.info().contrast).powi(2);
    assert!(
        ratio < 0.5 && (squares(&wide) / ratio - 1.0).abs() < 1e-3,
        "{ratio}"
    );
}

#[test]
fn one_wavelength_is_one_height_without_a_phase() {
    let owned = made(&BandwidthDescription {
        linewidth: 0.0,
        ..DESCRIPTION
    });
    let wave = owned.draw(0.9);
    assert_eq!([wave.pupil_shift, wave.phase_per_height], [0.0; 2]);
    assert_eq!(owned.patterns(), [1.0]);
    assert_eq!(owned.heights().len(), 1);
    assert!(
        (owned.info().contrast - 1.0).abs() < 1e-12,
        "{:?}",
        owned.info()
    );
    let along_normal = BandwidthDescription {
        to_pupil: [0.0, 0.0, 1.0],
        ..DESCRIPTION
    };
    let info = made(&along_normal).info();
    assert_eq!(
        (info.tilt, info.tilt_wave_number),
        ([0.0; 3], f64::INFINITY)
    );
}

#[test]
fn peaks_are_a_line() {
    let peaks = [[448e-9, 1.0], [453e-9, 3.0]];
    let description = BandwidthDescription {
        wavelength: f64::NAN,
        linewidth: 1e-9,
        peaks: peaks.as_ptr().cast(),
        peak_count: 2,
        ..DESCRIPTION
    };
    let line = SpectralLine::from_peaks(&peaks).unwrap();
    let line = line.with_linewidth(1e-9, tem00_coherence::LineShape::Gaussian);
    let info = made(&description).info();
    assert_eq!(info.coherence_length, line.unwrap().coherence_length());
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
        |wrong| {
            let (status, owned) = create(wrong);
            assert!(owned.0.is_null(), "{wrong:?} made a bandwidth");
            status
        },
    );
    let null = BandwidthDescription {
        peak_count: 1,
        ..DESCRIPTION
    };
    pointer_is_refused("peaks", create(&null).0);
    let owned = made(&DESCRIPTION);
    // SAFETY: the handle is valid, and null is allowed.
    unsafe {
        let mut wave = NO_WAVE;
        for uniform in [-0.1, 1.0, f64::NAN] {
            let status = tem00_bandwidth_draw(owned.0, uniform, &raw mut wave);
            number_is_refused("uniform", status);
        }
        let status = tem00_bandwidth_line_noise_ratio(owned.0, -1.0, &raw mut wave.pupil_shift);
        number_is_refused("row_height", status);
        let bad = [f64::INFINITY, 0.0];
        let status = tem00_bandwidth_covariance(owned.0, bad.as_ptr(), &raw mut wave.pupil_shift);
        number_is_refused("displacement", status);
        assert!(wave.pupil_shift.is_nan(), "nothing is written");
        pointer_is_refused("info", tem00_bandwidth_describe(owned.0, ptr::null_mut()));
        let bandwidth = tem00_bandwidth_draw(ptr::null(), 0.5, &raw mut wave);
        pointer_is_refused("bandwidth", bandwidth);
        tem00_bandwidth_destroy(ptr::null_mut());
    }
}

#[test]
fn threads_may_share_a_bandwidth() {
    fn is_shared<T: Send + Sync>() {}
    is_shared::<Bandwidth>();
}
