//! Light that is not of one wavelength: described, then asked what it makes of speckle and how to
//! show it.

mod description;

pub use description::*;

use tem00_coherence::{PatternSum, PolychromaticSpeckle, ResolutionCell, Rows, Spectrum};

use crate::{
    numbers::{check_length, check_variate, read_point},
    pointers::{self, borrow},
    status::Status,
};

/// The light of a laser with a linewidth in one resolution cell of a camera. It never changes: any
/// number of threads may ask it at once.
///
/// To show it, draw a wave for each camera sample, and add what it finds in the stacks of pattern j
/// and height h:
///
/// `I = sum_j patterns[j] |sum_h heights[2h + 1] exp(i heights[2h] wave.phase_per_height) U_jh(x, y, u)|^2`
///
/// `U_jh` is `tem00_stack_amplitude` of stacks of one description but their own seeds, on a
/// straight path whose x axis leads along `tilt` in the image. The shift of the wave adds to u:
/// `wave.pupil_shift` times the slices of a diameter, `2 half_period / length`. With 32 of them the
/// contrast is right to 1 %, with 8 it is 4 % too high. Without heights the intensities of one
/// wavelength add, `I = sum_j patterns[j] I_j`.
#[derive(Debug)]
pub struct Bandwidth {
    spectrum: Spectrum,
    cell: ResolutionCell,
    contrast: f64,
    patterns: PatternSum,
}

/// Effect of a linewidth on speckle, and its representation in a renderer.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BandwidthInfo {
    /// Contrast of polarised speckle, from 0 to 1: what is seen, and not the noise of a line.
    pub contrast: f64,
    /// Coherence length in metres; infinite for peaks without a width.
    pub coherence_length: f64,
    /// Unit vector along which the field moves across the pupil where the wave number grows; 0, 0,
    /// 0 without a tilt of the cell.
    pub tilt: [f64; 3],
    /// Difference of wave numbers that moves it by the pupil's diameter, in rad/m; infinite without
    /// a tilt.
    pub tilt_wave_number: f64,
    /// Fractions of the light in patterns whose intensities add: one; or, of heights that dominate
    /// or of the directions of a source, as many as its contrast asks for, at most 1024. They
    /// belong to the handle.
    pub patterns: *const f64,
    /// Number of patterns.
    pub pattern_count: usize,
    /// Heights of the relief in metres whose fields add, each with the root of its fraction of the
    /// light. They belong to the handle.
    pub heights: *const f64,
    /// Number of heights; 0 if each pattern is looked up as in one wavelength.
    pub height_count: usize,
}

/// A wave number drawn from the light.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wave {
    /// The wave number less the mean one, in rad/m.
    pub wave_number: f64,
    /// Displacement of the field across the pupil, along `tilt`, in pupil diameters.
    pub pupil_shift: f64,
    /// Phase per height of the relief, in rad/m.
    pub phase_per_height: f64,
}

impl Bandwidth {
    fn new(spectrum: Spectrum, cell: ResolutionCell) -> Self {
        let speckle = PolychromaticSpeckle {
            spectrum: &spectrum,
            cell: &cell,
        };
        Self {
            contrast: speckle.contrast(),
            patterns: speckle.patterns(|speckle| speckle.contrast().powi(2)),
            spectrum,
            cell,
        }
    }

    const fn speckle(&self) -> PolychromaticSpeckle<'_> {
        PolychromaticSpeckle {
            spectrum: &self.spectrum,
            cell: &self.cell,
        }
    }

    fn info(&self) -> BandwidthInfo {
        BandwidthInfo {
            contrast: self.contrast,
            coherence_length: self.spectrum.coherence_length(),
            tilt: (-self.cell.tilt()).normalize_or_zero().to_array(),
            tilt_wave_number: self.cell.tilt_wave_number(),
            patterns: self.patterns.fractions.as_ptr(),
            pattern_count: self.patterns.fractions.len(),
            heights: self.patterns.heights.as_ptr().cast(),
            height_count: self.patterns.heights.len(),
        }
    }

    fn wave(&self, uniform: f64) -> Wave {
        let wave_number = self.spectrum.draw(uniform);
        Wave {
            wave_number,
            pupil_shift: wave_number / self.cell.tilt_wave_number(),
            phase_per_height: wave_number * self.cell.height_factor(),
        }
    }
}

/// Prepares the light of a laser with a linewidth: in milliseconds, or in seconds for a correlation
/// length of a thousand speckles. One serves all places at which the directions differ by little.
///
/// On failure `*bandwidth` is null.
///
/// # Safety
///
/// The pointers are null or valid, that to peaks for two numbers each.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_bandwidth_create(
    description: *const BandwidthDescription,
    bandwidth: *mut *mut Bandwidth,
) -> Status {
    create!(description: borrow => bandwidth: {
        let spectrum = description.spectrum()?;
        let cell = description.cell(spectrum.wavelength())?;
        Ok(Bandwidth::new(spectrum, cell))
    })
}

/// Frees the light; null is allowed. No thread may be using it, and it must not be used again.
///
/// # Safety
///
/// `bandwidth` is null, or came from `tem00_bandwidth_create` and was not destroyed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_bandwidth_destroy(bandwidth: *mut Bandwidth) {
    // SAFETY: by the contract of this function.
    unsafe { pointers::destroy(bandwidth) };
}

/// Tells what the linewidth makes of speckle, and what stands for it.
///
/// # Safety
///
/// The pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_bandwidth_describe(
    bandwidth: *const Bandwidth,
    info: *mut BandwidthInfo,
) -> Status {
    answer!(bandwidth: borrow => info: bandwidth.info())
}

/// Draws a wave number with a random number from 0 to 1: stratified ones, among the samples of a
/// pixel, leave the least noise.
///
/// # Safety
///
/// The pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_bandwidth_draw(
    bandwidth: *const Bandwidth,
    uniform: f64,
    wave: *mut Wave,
) -> Status {
    answer!(bandwidth: borrow, uniform: check_variate => wave: bandwidth.wave(uniform))
}

/// Computes the covariance of two frames over the square of the mean intensity: what a motion
/// leaves of the contrast squared.
///
/// `displacement` holds the motion of the field between them, in pupil diameters along the tilt and
/// across it. In focus.
///
/// # Safety
///
/// The pointers are null or valid, that to the displacement for two numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_bandwidth_covariance(
    bandwidth: *const Bandwidth,
    displacement: *const f64,
    covariance: *mut f64,
) -> Status {
    answer!(bandwidth: borrow, displacement: read_point =>
        covariance: bandwidth.speckle().covariance(displacement))
}

/// Computes the standard deviation of the position of a laser line over that in light of one
/// wavelength: what counts for its noise, where the contrast does not.
///
/// `row_height` is the height of the rows along which the line is looked for, in speckle sizes: 0
/// for rows finer than a speckle; rows taller than 40 count as tall, and so do round spots.
///
/// # Safety
///
/// The pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_bandwidth_line_noise_ratio(
    bandwidth: *const Bandwidth,
    row_height: f64,
    ratio: *mut f64,
) -> Status {
    answer!(bandwidth: borrow, row_height: check_length => ratio: {
        let thin = row_height <= 0.0;
        let rows = if thin { Rows::Thin } else { Rows::Height(row_height) };
        bandwidth.speckle().line_noise_ratio(rows)
    })
}

#[cfg(test)]
mod tests;
