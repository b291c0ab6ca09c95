//! `tem00 speckle`: the size of the speckle behind a lens, and what changes it.

use std::io::Write;

use tem00_decorrelation::{
    CameraFrame, Configuration, ConfigurationData, DVec2, DVec3, Focus, Illumination,
    ImagingGeometry, RigidMotion, RigidMotions, ThickLensData, equivalent_axial_shift,
    equivalent_pupil_shift,
};
use tem00_report::{
    failure::Failure,
    report::{
        Cell, Column, Report, Table, Unit,
        units::{DEGREES, NUMBER},
    },
};
use tem00_statistics::{
    laws::{AIRY_FIRST_ZERO, AIRY_HALF_WIDTH},
    pixel_contrast,
};

use crate::args::SpeckleArgs;

/// Prints what is known of the speckle of a camera without a scene.
///
/// # Errors
///
/// Returns a failure if the lens is impossible, or standard output cannot be written.
pub(crate) fn run(args: &SpeckleArgs, out: &mut impl Write) -> Result<(), Failure> {
    let speckle = Speckle::new(args).map_err(|error| {
        Failure::input(
            error.to_string(),
            "--wavelength, --focal-length, --f-number, --distance and --pupil-magnification make the lens",
        )
    })?;
    speckle.report(args).print(args.json, &[], out)
}

/// The speckle of a lens.
#[derive(Debug)]
struct Speckle {
    geometry: ImagingGeometry,
    decorrelation: [Decorrelation; 5],
}

/// A change that decorrelates speckle, and its amounts that leave half of the pattern and none, in SI units.
#[derive(Debug)]
struct Decorrelation {
    by: &'static str,
    words: &'static str,
    /// `None` where the change does not decorrelate the pattern at first order.
    half: Option<f64>,
    none: Option<f64>,
}

impl Decorrelation {
    fn row(&self) -> [Cell; 3] {
        let amount = |value| match self.by {
            "tilt" => DEGREES.quantity(value),
            _ => length(value),
        };
        let [half, none] = [self.half, self.none].map(|value| Cell::or_dash(value.map(amount)));
        [Cell::new(self.by, self.words), half, none]
    }
}

impl Speckle {
    fn new(args: &SpeckleArgs) -> Result<Self, tem00_decorrelation::Refusal> {
        let geometry = ImagingGeometry::from_thick_lens(ThickLensData {
            wavelength: args.wavelength,
            focal_length: args.focal_length,
            f_number: args.f_number,
            pupil_magnification: args.pupil_magnification,
            focus: Focus::SurfaceToPupil(args.distance),
            // Nothing that is told without a pitch depends on it.
            pixel_pitch: args.pixel_pitch.unwrap_or(args.wavelength),
        })?;
        Ok(Self {
            decorrelation: decorrelation(&geometry, args.angle)?,
            geometry,
        })
    }

    fn report(&self, args: &SpeckleArgs) -> Report {
        let mut report = Report::new("The speckle of a lens");
        report.verdict(
            "Half and none are of the correlation of intensity, in collimated light on a surface that faces the \
             camera. A change of the wavelength also decorrelates what the heights of the surface do to the \
             phase, which is not counted here.",
        );
        report.section("What changes it").table(self.changes());
        let section = report.section("Its size").table(self.sizes());
        if let Some(pitch) = args.pixel_pitch {
            let size = self.geometry.speckle_size() / pitch;
            let contrast = pixel_contrast(size.recip());
            // Light that the surface has depolarised makes two patterns of half the power each.
            let depolarised = contrast * core::f64::consts::FRAC_1_SQRT_2;
            let contrast_of = |value| NUMBER.with_digits(3).quantity(value);
            section
                .fact("pixel_pitch", "pixel pitch", length(pitch))
                .fact(
                    "speckle_size_pixels",
                    "size h in pixels",
                    NUMBER.quantity(size),
                )
                .fact(
                    "contrast",
                    "contrast in a pixel, polarised",
                    contrast_of(contrast),
                )
                .fact(
                    "contrast_depolarised",
                    "contrast in a pixel, depolarised",
                    contrast_of(depolarised),
                );
        }
        let geometry = &self.geometry;
        report
            .section("The lens")
            .fact("wavelength", "wavelength", length(args.wavelength))
            .fact("focal_length", "focal length", length(args.focal_length))
            .fact("f_number", "f-number", NUMBER.quantity(args.f_number))
            .fact("distance", "distance of the surface", length(args.distance))
            .fact("angle", "angle of the light", DEGREES.quantity(args.angle))
            .fact(
                "pupil_magnification",
                "pupil magnification",
                NUMBER.quantity(args.pupil_magnification),
            )
            .fact(
                "magnification",
                "magnification",
                NUMBER.quantity(geometry.magnification()),
            )
            .fact(
                "working_f_number",
                "working f-number",
                NUMBER.quantity(geometry.working_f_number()),
            )
            .fact(
                "pupil_diameter",
                "pupil diameter",
                length(geometry.pupil_diameter()),
            );
        report
    }

    /// The size on the sensor and on the surface.
    fn sizes(&self) -> Table {
        let columns = [
            Column::new("quantity", "speckle"),
            Column::new("sensor", "on the sensor"),
            Column::new("surface", "on the surface"),
        ];
        let mut table =
            Table::new("Speckle on the sensor and on the surface", columns).under("sizes");
        let sizes = [
            self.geometry.speckle_size(),
            self.geometry.object_speckle_size(),
        ];
        for (key, name, factor) in [
            (
                "speckle_size",
                "size h, the period of the finest fringes",
                1.0,
            ),
            (
                "full_width_at_half_maximum",
                "full width at half maximum, 1.03 h",
                2.0 * AIRY_HALF_WIDTH,
            ),
            (
                "first_zero",
                "first zero of the autocovariance, 1.22 h",
                AIRY_FIRST_ZERO,
            ),
        ] {
            let [sensor, surface] = sizes.map(|size| length(factor * size));
            table.row([Cell::new(key, name), sensor, surface]);
        }
        table
    }

    fn changes(&self) -> Table {
        let columns = [
            Column::new("by", "change"),
            Column::new("half", "half is left at"),
            Column::new("none", "none is left at"),
        ];
        let mut table = Table::new("What decorrelates the speckle", columns).under("decorrelation");
        for change in &self.decorrelation {
            table.row(change.row());
        }
        table
    }
}

/// A length in the unit that suits it.
fn length(metres: f64) -> Cell {
    Unit::of_length(metres).quantity(metres)
}

/// Returns what decorrelates the speckle of a surface that faces the camera, under collimated light at
/// an angle to the line of sight, in radians.
///
/// Across, tilt and wavelength slide the speckle field over the pupil, in proportion while they are
/// small; along the sight the field is defocused.
fn decorrelation(
    geometry: &ImagingGeometry,
    angle: f64,
) -> Result<[Decorrelation; 5], tem00_decorrelation::Refusal> {
    let cell = geometry.object_speckle_size();
    let axial = geometry.axial_decorrelation_length();
    let [across, tilt, wavelength] = pupil_shifts(geometry, angle)?;
    let halving = equivalent_pupil_shift(0.5)?;
    // What rounding leaves of a shift is none.
    let reach = |shift: f64| (shift > 1e-9).then(|| geometry.pupil_diameter() / shift);
    let change = |by, words, half, none| Decorrelation {
        by,
        words,
        half,
        none,
    };
    let sliding = |by, words, reach: Option<f64>| {
        change(by, words, reach.map(|reach| halving * reach), reach)
    };
    let by_wavelength = reach(wavelength).map(|share| share * geometry.wavelength());
    let along = equivalent_axial_shift(0.5)? * axial;
    Ok([
        change(
            "across_in_a_pixel",
            "surface across the sight, in a pixel",
            Some(AIRY_HALF_WIDTH * cell),
            Some(AIRY_FIRST_ZERO * cell),
        ),
        sliding(
            "across",
            "surface across the sight, followed",
            reach(across),
        ),
        change("along", "surface along the sight", Some(along), Some(axial)),
        sliding("tilt", "surface tilted", reach(tilt)),
        sliding("wavelength", "wavelength", by_wavelength),
    ])
}

/// Returns how far the speckle field slides over the pupil: per length across the sight, per radian of
/// tilt, in metres, and per relative change of the wavelength, in metres.
fn pupil_shifts(
    geometry: &ImagingGeometry,
    angle: f64,
) -> Result<[f64; 3], tem00_decorrelation::Refusal> {
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
    fn none(speckle: &Speckle, change: &str) -> Option<f64> {
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
            close(found("across"), d);
            close(found("tilt"), d / (l * (1.0 + theta.cos())));
            close(found("along"), 8.0 * lambda * (l / d).powi(2));
            match found("wavelength") {
                None => assert!(degrees == 0.0, "{degrees}°"),
                length => close(length, lambda * d / (l * theta.sin())),
            }
        }
    }

    #[test]
    fn half_is_left_where_the_overlap_of_discs_has_the_square_one_half() {
        let speckle = Speckle::new(&args(0.0)).expect("a lens");
        let overlap = |s: f64| core::f64::consts::FRAC_2_PI * (s.acos() - s * (1.0 - s * s).sqrt());
        for change in ["across", "tilt"] {
            let mut found = speckle.decorrelation.iter();
            let found = found.find(|found| found.by == change).expect("listed");
            let shift = found.half.expect("a length") / found.none.expect("a length");
            assert_relative_eq!(overlap(shift).powi(2), 0.5, epsilon = 1e-9);
        }
    }
}
