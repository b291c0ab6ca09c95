//! `tem00 speckle`: the size of the speckle behind a lens, and what changes it.

use std::io::Write;

use serde::Serialize;
use tem00_decorrelation::{
    CameraFrame, Configuration, ConfigurationData, DVec2, DVec3, DecorrelationError, Focus,
    Illumination, ImagingGeometry, RigidMotion, RigidMotions, ThickLensData,
    equivalent_axial_shift, equivalent_pupil_shift,
};
use tem00_statistics::{AIRY_FIRST_ZERO, AIRY_HALF_WIDTH, pixel_contrast};

use crate::{
    args::SpeckleArgs,
    failure::Failure,
    table::{rounded, write_columns},
};

/// Prints what is known of the speckle of a camera without a scene.
///
/// # Errors
///
/// Returns a failure if there is no such lens, or nobody to print for.
pub(crate) fn run(args: &SpeckleArgs, out: &mut impl Write) -> Result<(), Failure> {
    let speckle = Speckle::new(args).map_err(|error| {
        Failure::input(
            error.to_string(),
            "--wavelength, --focal-length, --f-number, --distance and --pupil-magnification make the lens",
        )
    })?;
    let printed = if args.json {
        let text = serde_json::to_string_pretty(&speckle)
            .map_err(|error| Failure::running(error.to_string()))?;
        writeln!(out, "{text}")
    } else {
        speckle.print(out)
    };
    printed.map_err(|error| Failure::stdout(&error))
}

/// What a lens says of its speckle, in SI units.
#[derive(Debug, Serialize)]
struct Speckle {
    wavelength: f64,
    focal_length: f64,
    f_number: f64,
    distance: f64,
    pupil_magnification: f64,
    angle: f64,
    magnification: f64,
    working_f_number: f64,
    pupil_diameter: f64,
    /// On the sensor and on the surface.
    sensor: Size,
    surface: Size,
    pixel: Option<Pixel>,
    decorrelation: Vec<Decorrelation>,
}

/// How large speckle is, in metres.
#[derive(Debug, Serialize)]
struct Size {
    /// The period of the finest fringes, h.
    speckle_size: f64,
    /// The full width of the autocovariance at half its maximum, 1.03 h.
    full_width_at_half_maximum: f64,
    /// The lag at which the autocovariance first vanishes, 1.22 h.
    first_zero: f64,
}

impl Size {
    fn new(speckle_size: f64) -> Self {
        Self {
            speckle_size,
            full_width_at_half_maximum: 2.0 * AIRY_HALF_WIDTH * speckle_size,
            first_zero: AIRY_FIRST_ZERO * speckle_size,
        }
    }
}

/// What a square pixel without gaps sees of the speckle.
#[derive(Debug, Serialize)]
struct Pixel {
    pitch: f64,
    speckle_size_in_pixels: f64,
    /// The contrast of polarised light, and of light that the surface has depolarised.
    contrast: f64,
    contrast_depolarised: f64,
}

impl Pixel {
    fn new(pitch: f64, speckle_size: f64) -> Self {
        let contrast = pixel_contrast(pitch / speckle_size);
        Self {
            pitch,
            speckle_size_in_pixels: speckle_size / pitch,
            contrast,
            // Two patterns of half the power each.
            contrast_depolarised: contrast * core::f64::consts::FRAC_1_SQRT_2,
        }
    }
}

/// How much of a change leaves half the pattern, and how much none, in SI units.
#[derive(Debug, Serialize)]
struct Decorrelation {
    by: Change,
    /// `None` where the change does not decorrelate the pattern at first order.
    half: Option<f64>,
    none: Option<f64>,
}

/// What changes the speckle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
enum Change {
    /// The surface moves across the line of sight, and a pixel stays where it is.
    AcrossInAPixel,
    /// The same, and the image of the surface is followed.
    Across,
    /// The surface moves along the line of sight.
    Along,
    /// The surface tilts about an axis across the plane of light and sight.
    Tilt,
    /// The wavelength changes.
    Wavelength,
}

impl Change {
    const fn words(self) -> &'static str {
        match self {
            Self::AcrossInAPixel => "surface across the sight, in a pixel",
            Self::Across => "surface across the sight, followed",
            Self::Along => "surface along the sight",
            Self::Tilt => "surface tilted",
            Self::Wavelength => "wavelength",
        }
    }

    fn text(self, value: Option<f64>) -> String {
        match value {
            None => "-".into(),
            Some(angle) if self == Self::Tilt => {
                format!("{}°", rounded(angle.to_degrees(), 4))
            }
            Some(value) => length(value),
        }
    }
}

impl Speckle {
    fn new(args: &SpeckleArgs) -> Result<Self, DecorrelationError> {
        let geometry = ImagingGeometry::from_thick_lens(ThickLensData {
            wavelength: args.wavelength,
            focal_length: args.focal_length,
            f_number: args.f_number,
            pupil_magnification: args.pupil_magnification,
            focus: Focus::SurfaceToPupil(args.distance),
            // Nothing that is told without a pitch depends on it.
            pixel_pitch: args.pixel_pitch.unwrap_or(args.wavelength),
        })?;
        let h = geometry.speckle_size();
        Ok(Self {
            wavelength: args.wavelength,
            focal_length: args.focal_length,
            f_number: args.f_number,
            distance: args.distance,
            pupil_magnification: args.pupil_magnification,
            angle: args.angle,
            magnification: geometry.magnification(),
            working_f_number: geometry.working_f_number(),
            pupil_diameter: geometry.pupil_diameter(),
            sensor: Size::new(h),
            surface: Size::new(geometry.object_speckle_size()),
            pixel: args.pixel_pitch.map(|pitch| Pixel::new(pitch, h)),
            decorrelation: decorrelation(&geometry, args.angle)?,
        })
    }

    fn print(&self, out: &mut impl Write) -> std::io::Result<()> {
        writeln!(
            out,
            "{}, f = {}, f/{}, {} from the surface: magnification {}, working f-number {}, pupil {}\n",
            length(self.wavelength),
            length(self.focal_length),
            rounded(self.f_number, 4),
            length(self.distance),
            rounded(self.magnification, 4),
            rounded(self.working_f_number, 4),
            length(self.pupil_diameter),
        )?;
        let line = |cells: [&str; 3]| cells.map(String::from).to_vec();
        let row = |name: &str, size: fn(&Size) -> f64| {
            let [sensor, surface] = [&self.sensor, &self.surface].map(|of| length(size(of)));
            line([name, &sensor, &surface])
        };
        let mut lines = vec![
            line(["speckle", "on the sensor", "on the surface"]),
            row("size h, the period of the finest fringes", |size| {
                size.speckle_size
            }),
            row("full width at half maximum, 1.03 h", |size| {
                size.full_width_at_half_maximum
            }),
            row("first zero of the autocovariance, 1.22 h", |size| {
                size.first_zero
            }),
        ];
        if let Some(pixel) = &self.pixel {
            let name = format!("h in pixels of {}", length(pixel.pitch));
            let size = rounded(pixel.speckle_size_in_pixels, 4);
            lines.push(line([&name, &size, ""]));
            let contrast = rounded(pixel.contrast, 3);
            let half = format!("{}, depolarised", rounded(pixel.contrast_depolarised, 3));
            lines.push(line(["contrast in a pixel, polarised", &contrast, &half]));
        }
        write_columns(&lines, out)?;
        writeln!(out)?;
        let mut lines = vec![line(["change", "half is left at", "none is left at"])];
        for Decorrelation { by, half, none } in &self.decorrelation {
            lines.push(line([by.words(), &by.text(*half), &by.text(*none)]));
        }
        write_columns(&lines, out)?;
        writeln!(
            out,
            "\nCollimated light at {}° to the sight, on a surface that faces the camera. Half and none \
             are of the correlation of intensity. A change of the wavelength also decorrelates what the \
             heights of the surface do to the phase, which is not counted here.",
            rounded(self.angle.to_degrees(), 4)
        )
    }
}

/// Returns what decorrelates the speckle of a surface that faces the camera, under collimated light at
/// an angle to the line of sight, in radians.
///
/// Across, tilt and wavelength slide the speckle field over the pupil, in proportion while they are
/// small; along the sight the field is defocused.
fn decorrelation(
    geometry: &ImagingGeometry,
    angle: f64,
) -> Result<Vec<Decorrelation>, DecorrelationError> {
    let cell = geometry.object_speckle_size();
    let axial = geometry.axial_decorrelation_length();
    let [across, tilt, wavelength] = pupil_shifts(geometry, angle)?;
    let sliding = |by: Change, pupil_shift: f64| {
        // What rounding leaves of a shift is none.
        let reach = (pupil_shift > 1e-9).then(|| geometry.pupil_diameter() / pupil_shift);
        Decorrelation {
            by,
            half: reach.map(|reach| equivalent_pupil_shift(0.5) * reach),
            none: reach,
        }
    };
    let mut wavelength = sliding(Change::Wavelength, wavelength);
    for length in [&mut wavelength.half, &mut wavelength.none] {
        *length = length.map(|share| share * geometry.wavelength());
    }
    Ok(vec![
        Decorrelation {
            by: Change::AcrossInAPixel,
            half: Some(AIRY_HALF_WIDTH * cell),
            none: Some(AIRY_FIRST_ZERO * cell),
        },
        sliding(Change::Across, across),
        Decorrelation {
            by: Change::Along,
            half: Some(equivalent_axial_shift(0.5) * axial),
            none: Some(axial),
        },
        sliding(Change::Tilt, tilt),
        wavelength,
    ])
}

/// Returns how far the speckle field slides over the pupil: per length across the sight, per radian of
/// tilt, in metres, and per relative change of the wavelength, in metres.
fn pupil_shifts(geometry: &ImagingGeometry, angle: f64) -> Result<[f64; 3], DecorrelationError> {
    /// Small enough for the first order, large enough for rounding.
    const STEP: f64 = 1e-6;
    let pupil = geometry.surface_to_pupil() * DVec3::Z;
    let (sine, cosine) = angle.sin_cos();
    let before = Configuration::new(ConfigurationData {
        wavelength: geometry.wavelength(),
        point: DVec3::ZERO,
        normal: DVec3::Z,
        illumination: Illumination::collimated(DVec3::new(sine, 0.0, cosine))?,
        camera: CameraFrame::look_at(pupil, DVec3::ZERO, DVec3::Y)?,
        pupil,
    })?;
    let moved = |surface: RigidMotion| {
        before.moved(&RigidMotions {
            surface,
            ..RigidMotions::default()
        })
    };
    let shift = |after: &Configuration, step: f64| {
        let shift = before.pupil_point_after(after, DVec2::ZERO);
        shift.map_or(0.0, |shift| shift.length() / step)
    };
    let across = STEP * geometry.surface_to_pupil();
    Ok([
        shift(&moved(RigidMotion::along(across * DVec3::X)?)?, across),
        shift(
            &moved(RigidMotion::about(DVec3::ZERO, DVec3::Y, STEP)?)?,
            STEP,
        ),
        shift(
            &before.with_wavelength((1.0 + STEP) * geometry.wavelength())?,
            STEP,
        ),
    ])
}

/// Writes a length with four digits, in the unit that suits it.
fn length(metres: f64) -> String {
    let (unit, size) = match metres {
        long if long >= 1.0 => ("m", 1.0),
        long if long >= 1e-3 => ("mm", 1e-3),
        long if long >= 1e-6 => ("µm", 1e-6),
        _ => ("nm", 1e-9),
    };
    format!("{} {unit}", rounded(metres / size, 4))
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;

    /// A 25 mm lens at f/8, 300 mm from the surface, at 650 nm: D = 3.125 mm.
    fn args(angle: f64) -> SpeckleArgs {
        SpeckleArgs {
            wavelength: 650e-9,
            focal_length: 25e-3,
            f_number: 8.0,
            distance: 0.3,
            pixel_pitch: Some(3.45e-6),
            pupil_magnification: 1.0,
            angle,
            json: false,
        }
    }

    /// Returns what leaves nothing of the pattern.
    fn none(speckle: &Speckle, change: Change) -> Option<f64> {
        let mut changes = speckle.decorrelation.iter();
        changes
            .find(|found| found.by == change)
            .expect("it is listed")
            .none
    }

    #[test]
    fn lengths_of_decorrelation_are_those_of_the_grating_equation() {
        // A grating of the spatial frequency sin θ / λ sends light at the angle θ along the normal.
        // Tilted by α, it turns that light by (1 + cos θ) α; another wavelength by sin θ Δλ/λ; and
        // a translation takes the collimated light along. L times the turn crosses the pupil of D.
        let (d, l, lambda) = (3.125e-3, 0.3, 650e-9);
        for degrees in [0.0, 30.0, 60.0_f64] {
            let theta = degrees.to_radians();
            let speckle = Speckle::new(&args(theta)).expect("a lens");
            let found = |change| none(&speckle, change);
            let close = |found: Option<f64>, expected: f64| {
                assert_relative_eq!(found.expect("a length"), expected, max_relative = 2e-6);
            };
            close(found(Change::Across), d);
            close(found(Change::Tilt), d / (l * (1.0 + theta.cos())));
            close(found(Change::Along), 8.0 * lambda * (l / d).powi(2));
            match found(Change::Wavelength) {
                None => assert!(degrees == 0.0, "{degrees}°"),
                length => close(length, lambda * d / (l * theta.sin())),
            }
        }
    }

    #[test]
    fn half_is_left_where_the_overlap_of_discs_has_the_square_one_half() {
        let speckle = Speckle::new(&args(0.0)).expect("a lens");
        let overlap = |s: f64| core::f64::consts::FRAC_2_PI * (s.acos() - s * (1.0 - s * s).sqrt());
        for change in [Change::Across, Change::Tilt] {
            let mut found = speckle.decorrelation.iter();
            let found = found.find(|found| found.by == change).expect("listed");
            let shift = found.half.expect("a length") / found.none.expect("a length");
            assert_relative_eq!(overlap(shift).powi(2), 0.5, epsilon = 1e-9);
        }
    }

    #[test]
    fn lengths_are_written_in_the_unit_that_suits() {
        for (metres, text) in [
            (0.3, "300 mm"),
            (5.672_7e-6, "5.673 µm"),
            (650e-9, "650 nm"),
            (2.0, "2 m"),
            (3.125e-3, "3.125 mm"),
        ] {
            assert_eq!(length(metres), text);
        }
    }
}
