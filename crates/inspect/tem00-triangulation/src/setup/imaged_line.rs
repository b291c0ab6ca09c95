use core::f64::consts::{LN_2, PI, SQRT_2};
use std::sync::Arc;

use glam::DVec3;
use tem00_camera::Camera;
use tem00_coherence::{CellGeometry, PolychromaticSpeckle, ResolutionCell, Rows, Spectrum};
use tem00_decorrelation::ImagingGeometry;
use tem00_statistics::laws::{defocused_line_centroid_deviation, imaged_line_power_contrast};
use tem00_translucence::SpreadLine;

use super::{
    SetupDescription,
    line_profile::{LensedLine, LineProfile},
    subsurface::{PixelSpread, SpreadLight},
};
use crate::Sensor;

/// The step in height, as a fraction of the distance, of central differences: they err by its
/// square.
const STEP: f64 = 1e-5;

/// The image of the line on a flat surface.
///
/// Its profile along a column is the Gaussian of the line, blurred by the image that the lens makes
/// of a point, in or out of focus, whose wings fall as 1/y²: outside of ±Y lie 4h/(π³Y) of the
/// light. The squares of the contributions to its width add:
///
/// ```text
/// W² = W_line² + W_lens² + b² + W_body²
/// W_line   the projection of the line on the part, m · line_thickness √(1 + z²/z_R²) · cos θ to
///          first order
/// W_lens   = 4√2 h / π, the Gaussian of the same curvature as the peak of the lens's Airy disc
/// b        = D s |1/Z_focus − 1/Z|, the diameter of the disc of defocus, whose 4σ across is b
/// W_body   by light from below the surface: what the width of the Gaussian with the full width at
///          half maximum of the whole profile has more
/// ```
///
/// Light from below the surface spreads the line to one side; the profile has its whole shape.
///
/// The line has its waist on the reference plane, with the Rayleigh range `z_R = π w₀²/λ`, w₀ being
/// half its thickness. Z is the depth of the surface before the lens, `Z_focus` the depth in focus
/// at this image point, s the depth of the sensor behind the lens, D the diameter of the pupil and
/// h = λ s / D the speckle size. Across the disc of defocus 4σ = b.
#[derive(Clone, Debug, PartialEq)]
pub struct ImagedLine {
    /// The position along the middle column, in pixels, y down.
    pub position: f64,
    /// The full width between the points of 1/e², in pixels, as of a Gaussian.
    pub width: f64,
    /// The contribution of the thickness of the line itself to the width, in pixels.
    pub projected_thickness: f64,
    /// The contribution of diffraction at the pupil to the width, in pixels.
    pub diffraction_width: f64,
    /// The contribution of defocus to the width, in pixels.
    pub blur: f64,
    /// The contribution of light from below the surface to the width, in pixels.
    pub subsurface_width: f64,
    /// The speckle size along the rows and along the columns, in pixels: a sensor that is tilted
    /// stretches the speckle along its columns.
    pub speckle_size: [f64; 2],
    /// The change of the height per pixel that the line moves in the image, in metres.
    pub height_per_pixel: f64,
    /// The irradiance on the sensor along the crest of the line, in W/m².
    pub peak_irradiance: f64,
    /// The mean number of electrons that the light frees in a column.
    pub column_electrons: f64,
    /// The height of the sensitive part of a pixel, in pixels.
    pub sensitive_height: f64,
    /// Effect of the linewidth and of the extent of the source on speckle.
    pub bandwidth: BandwidthEffect,
    /// Light from below the surface, and the pixels in a metre across the line on the part.
    spread: Option<(Arc<SpreadLine>, f64)>,
    /// The place of the crest beside the line as it enters, in pixels.
    crest: f64,
}

/// Effect of the linewidth and of the extent of the source on the speckle of a line, relative to a
/// point source of one wavelength.
///
/// # Validity
///
/// The effect follows [`PolychromaticSpeckle`], with the surface square to the light, as everywhere
/// in a set-up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BandwidthEffect {
    /// The ratio of the contrast in a point. Pixels larger than a speckle lose less than this.
    pub contrast: f64,
    /// The ratio of the standard deviation of the position of the line, over the columns that are
    /// averaged.
    pub line_noise_ratio: f64,
    /// The ratio of the standard deviation of the position of a round spot.
    pub spot_noise_ratio: f64,
}

impl BandwidthEffect {
    /// No effect: a point source of one wavelength.
    pub const NONE: Self = Self {
        contrast: 1.0,
        line_noise_ratio: 1.0,
        spot_noise_ratio: 1.0,
    };

    /// Returns the effect together with another that leaves a contrast: both average over the same
    /// wave numbers, so that together they leave no more than the smaller of the two.
    fn at_most(self, contrast: f64) -> Self {
        Self {
            contrast: self.contrast.min(contrast),
            line_noise_ratio: self.line_noise_ratio.min(contrast),
            spot_noise_ratio: self.spot_noise_ratio.min(contrast),
        }
    }

    /// Returns the effect for a resolution cell and rows of a height in speckle sizes.
    fn new(spectrum: &Spectrum, cell: &ResolutionCell, rows: f64) -> Self {
        if spectrum.is_monochromatic() && cell.source_extent().is_point() {
            return Self::NONE;
        }
        let speckle = PolychromaticSpeckle { spectrum, cell };
        Self {
            contrast: speckle.contrast(),
            line_noise_ratio: speckle.line_noise_ratio(Rows::Height(rows)),
            spot_noise_ratio: speckle.line_noise_ratio(Rows::Tall),
        }
    }
}

impl ImagedLine {
    /// Returns the image at a height, or `None` if the camera does not see the line.
    pub(super) fn at(
        description: &SetupDescription,
        camera: &Camera,
        spread: Option<&SpreadLight>,
        height: f64,
    ) -> Option<Self> {
        let laser = &description.laser;
        let pitch = description.sensor.pixel_pitch;
        let row = |beside: f64, height: f64| {
            let point = description.laser_point_at(height) + beside * DVec3::Y;
            camera.project(point).map(|pixel| pixel.y)
        };
        let thickness = description.line_thickness_at(height)?;
        let half = 0.5 * thickness;
        let across = row(-half, height)? - row(half, height)?;
        let projected_thickness = across.abs();
        let contrast = spread.map(|spread| spread.contrast);
        let spread = spread.map(|spread| (Arc::clone(&spread.line), across / thickness));
        let step = STEP * description.camera.distance;
        let moved = row(0.0, height - step)? - row(0.0, height + step)?;
        let pixel = camera.project(description.laser_point_at(height))?;
        let geometry = camera
            .imaging_geometry_at(pixel, laser.light.wavelength)
            .ok()?;
        let stretch = 1.0 / camera.description().tilt.angle.cos();
        let speckle = geometry.speckle_size() / pitch;
        let diffraction_width = 4.0 * SQRT_2 / PI * speckle * stretch;
        let depth = depth(description, height);
        let defocus = geometry.defocus_at(depth).abs();
        let disc = geometry.pupil_diameter() * geometry.principal_distance() * defocus;
        let blur = disc * stretch / pitch;
        // A smaller blur is rounding of a line in focus.
        let blur = if blur < 1e-9 { 0.0 } else { blur };
        let width = projected_thickness.hypot(diffraction_width).hypot(blur);
        let on_part = laser.power / laser.line_length * (8.0 / PI).sqrt() / thickness;
        let radiance = description.surface.reflectance * on_part / PI;
        // Of a line as it is on the part; the lens spreads what a column gets.
        let unwidened = radiance * camera.irradiance_per_radiance(pixel);
        let column = unwidened * projected_thickness * (PI / 8.0).sqrt();
        let sensor = Sensor::new(description.sensor).ok()?;
        let mut line = Self {
            position: pixel.y,
            width,
            projected_thickness,
            diffraction_width,
            blur,
            subsurface_width: 0.0,
            speckle_size: [speckle, speckle * stretch],
            height_per_pixel: 2.0 * step / moved,
            peak_irradiance: 0.0,
            column_electrons: sensor.electrons(column, laser.light.wavelength),
            sensitive_height: 2.0 * sensor.sensitive_half_width(),
            bandwidth: BandwidthEffect::new(
                &laser.light.spectrum().ok()?,
                &resolution_cell(description, camera, height, &geometry)?,
                f64::from(description.average.columns) / speckle,
            ),
            spread,
            crest: 0.0,
        };
        if let Some(contrast) = contrast {
            line.bandwidth = line.bandwidth.at_most(contrast);
            line.widen();
        }
        line.peak_irradiance = column * line.profile_over(0.0, 0.0).at(line.crest);
        (depth > 0.0 && line.height_per_pixel.is_finite()).then_some(line)
    }

    /// Returns the mean number of electrons that light frees in the pixel of a column that begins
    /// at `start`, in pixels, if the line is at `centre`: the mean of the line over the sensitive
    /// part of the pixel, of the height a about its middle.
    ///
    /// ```text
    /// n = N ∫ exp(−π² W_line² f²/8) T(f) sinc(π a f) cos(2π f (y − c)) df
    /// ```
    ///
    /// with N electrons in the column, the transfer function T of the lens in or out of focus, and
    /// the middle y of the pixel.
    pub fn pixel_electrons(&self, start: f64, centre: f64) -> f64 {
        let distance = start + 0.5 - centre;
        self.column_electrons * self.profile(distance.abs()).at(distance)
    }

    /// Returns the profile in pixels, for positions up to `reach` from the middle of the line.
    pub(crate) fn profile(&self, reach: f64) -> LineProfile {
        self.profile_over(self.sensitive_height, reach)
    }

    /// Returns the standard deviation, in pixels, that fully developed speckle gives the mean
    /// position over `columns` neighbouring columns, each the centre of gravity of all light in it.
    ///
    /// To first order in the fluctuations except for defocus, which moves a line by the mean place
    /// of its light in the pupil: a column's power divides that.
    pub(crate) fn centroid_deviation(&self, columns: u32) -> f64 {
        let [along, across] = self.speckle_size;
        let column = self.sensitive_height / along;
        let row_height = column + (f64::from(columns) - 1.0) / along;
        let radius = 0.5 * self.projected_thickness / across;
        let deviation = |blur| defocused_line_centroid_deviation(radius, row_height, blur);
        let in_focus = deviation(0.0);
        if self.blur == 0.0 {
            return across * in_focus;
        }
        let by_defocus = deviation(self.blur / across).powi(2) - in_focus.powi(2);
        let power = 1.0 + imaged_line_power_contrast(radius, column).powi(2);
        across * in_focus.hypot((by_defocus / power).max(0.0).sqrt())
    }

    fn profile_over(&self, pixel: f64, reach: f64) -> LineProfile {
        let line = LensedLine {
            width: self.projected_thickness,
            blur: self.blur,
            speckle_size: self.speckle_size[1],
            pixel,
        };
        LineProfile::new(&line, &self.pixel_spread(), reach)
    }

    /// Returns the spread of the line by light from below the surface.
    pub(crate) fn pixel_spread(&self) -> PixelSpread {
        let spread = self.spread.as_ref();
        spread.map_or_else(PixelSpread::default, |(line, scale)| {
            PixelSpread::new(line, *scale)
        })
    }

    /// Returns whether light from below the surface is part of the line.
    pub(crate) const fn is_spread(&self) -> bool {
        self.spread.is_some()
    }

    /// Widens the line by light from below the surface.
    fn widen(&mut self) {
        let (profile, step) = (self.profile(0.0), 0.01 * self.width);
        self.crest = profile.crest(step);
        let half = profile.width_at_half(self.crest, step);
        // Of a Gaussian the width at half maximum is √(ln 2/2) of the width at 1/e².
        let width = (half / (0.5 * LN_2).sqrt()).max(self.width);
        self.subsurface_width = ((width - self.width) * (width + self.width)).sqrt();
        self.width = width;
    }

    /// Returns the mean number of electrons that light frees in the brightest pixel, for a line in
    /// the middle of it.
    pub(super) fn peak_electrons(&self) -> f64 {
        self.pixel_electrons(-0.5, -self.crest)
    }
}

/// Returns the depth of the line at a height before the pupil, along the optical axis.
fn depth(description: &SetupDescription, height: f64) -> f64 {
    let (sin, cos) = description.camera.angle.sin_cos();
    description.camera.distance + description.laser_point_at(height).y * sin - height * cos
}

/// Returns the resolution cell of the camera on the surface at a height.
pub(super) fn resolution_cell(
    description: &SetupDescription,
    camera: &Camera,
    height: f64,
    geometry: &ImagingGeometry,
) -> Option<ResolutionCell> {
    let laser = &description.laser;
    let to_pupil = camera.position() - description.laser_point_at(height);
    let distance = to_pupil.length();
    let depth = depth(description, height);
    let in_focus = (depth.recip() - geometry.defocus_at(depth)).recip();
    let cell = ResolutionCell::new(CellGeometry {
        to_source: DVec3::new(0.0, libm::sin(laser.tilt), libm::cos(laser.tilt)),
        to_pupil,
        normal: DVec3::Z,
        sin_aperture: 0.5 * geometry.pupil_diameter() / distance,
        wavelength: description.laser.light.wavelength,
    });
    // The plane in focus is the one at this image point; a distance of less than a nanometre from
    // it is rounding.
    let defocus = in_focus - depth;
    let defocus = if defocus.abs() < 1e-9 { 0.0 } else { defocus };
    let relief = description.surface.relief;
    cell.ok()?
        .with_relief(relief)
        .ok()?
        .with_defocus(defocus)
        .ok()?
        .with_source_extent(description.laser.light.extent().ok()?)
        .into()
}
