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

/// Prints the properties of a camera's speckle that do not need a scene.
///
/// # Errors
///
/// Returns a failure if the lens is impossible, or standard output cannot be written.
pub(crate) fn run(args: &SpeckleArgs, out: &mut impl Write) -> Result<(), Failure> {
    let speckle = Speckle::new(args).map_err(|error| {
        Failure::input(
            error.to_string(),
            "--wavelength, --focal-length, --f-number, --distance and --pupil-magnification make \
             the lens",
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

/// A change that decorrelates speckle, with the amounts after which half of the pattern and nothing
/// of it is left, in SI units.
#[derive(Debug)]
struct Decorrelation {
    by: &'static str,
    words: &'static str,
    /// `None` where the change does not decorrelate the pattern at first order.
    half_and_none: Option<[f64; 2]>,
}

impl Decorrelation {
    fn row(&self) -> [Cell; 3] {
        let amount = |value| match self.by {
            "tilt" => DEGREES.quantity(value),
            _ => length(value),
        };
        let amounts = self
            .half_and_none
            .map(|amounts| amounts.map(|x| Some(amount(x))));
        let [half, none] = amounts.unwrap_or_default().map(Cell::or_dash);
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
            // No value that is printed without a pitch depends on this one.
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
            "Half and none are of the correlation of intensity, in collimated light on a surface \
             that faces the camera. A change of the wavelength also decorrelates what the heights \
             of the surface do to the phase, which is not counted here.",
        );
        report.section("What changes it").table(self.changes());
        let geometry = &self.geometry;
        let section = report.section("Its size").table(self.sizes());
        if let Some(pitch) = args.pixel_pitch {
            let size = geometry.speckle_size() / pitch;
            let contrast = pixel_contrast(size.recip());
            // Light that the surface has depolarised makes two patterns of half the power each.
            let depolarised = contrast * core::f64::consts::FRAC_1_SQRT_2;
            let contrast_of = |value| NUMBER.with_digits(3).quantity(value);
            let [polarised, depolarised] = [contrast, depolarised].map(contrast_of);
            section
                .fact("pixel_pitch", "pixel pitch", length(pitch))
                .fact(
                    "speckle_size_pixels",
                    "size h in pixels",
                    NUMBER.quantity(size),
                )
                .fact("contrast", "contrast in a pixel, polarised", polarised)
                .fact(
                    "contrast_depolarised",
                    "contrast in a pixel, depolarised",
                    depolarised,
                );
        }
        let number = |value| NUMBER.quantity(value);
        let section = report.section("The lens");
        for (key, name, value) in [
            ("wavelength", "wavelength", length(args.wavelength)),
            ("focal_length", "focal length", length(args.focal_length)),
            ("f_number", "f-number", number(args.f_number)),
            ("distance", "distance of the surface", length(args.distance)),
            ("angle", "angle of the light", DEGREES.quantity(args.angle)),
            (
                "pupil_magnification",
                "pupil magnification",
                number(args.pupil_magnification),
            ),
            (
                "magnification",
                "magnification",
                number(geometry.magnification()),
            ),
            (
                "working_f_number",
                "working f-number",
                number(geometry.working_f_number()),
            ),
            (
                "pupil_diameter",
                "pupil diameter",
                length(geometry.pupil_diameter()),
            ),
        ] {
            section.fact(key, name, value);
        }
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
        let [fringes, half] = [
            "size h, the period of the finest fringes",
            "full width at half maximum, 1.03 h",
        ];
        for (key, name, factor) in [
            ("speckle_size", fringes, 1.0),
            ("full_width_at_half_maximum", half, 2.0 * AIRY_HALF_WIDTH),
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

/// Formats a length in the unit that suits it.
fn length(metres: f64) -> Cell {
    Unit::of_length(metres).quantity(metres)
}

/// Returns the changes that decorrelate the speckle of a surface that faces the camera, under
/// collimated light at an angle to the line of sight, in radians.
///
/// Small transverse motions, tilts and wavelength changes shift the speckle field over the pupil in
/// proportion to their size; a motion along the line of sight defocuses the field.
fn decorrelation(
    geometry: &ImagingGeometry,
    angle: f64,
) -> Result<[Decorrelation; 5], tem00_decorrelation::Refusal> {
    let cell = geometry.object_speckle_size();
    let axial = geometry.axial_decorrelation_length();
    let [across, tilt, wavelength] = pupil_shifts(geometry, angle)?;
    let halving = equivalent_pupil_shift(0.5)?;
    // A shift at the level of rounding counts as zero.
    let reach = |shift: f64| (shift > 1e-9).then(|| geometry.pupil_diameter() / shift);
    let sliding = |reach: Option<f64>| reach.map(|reach| [halving * reach, reach]);
    let by_wavelength = reach(wavelength).map(|share| share * geometry.wavelength());
    let in_a_pixel = [AIRY_HALF_WIDTH * cell, AIRY_FIRST_ZERO * cell];
    let along = [equivalent_axial_shift(0.5)? * axial, axial];
    let changes = [
        (
            "across_in_a_pixel",
            "surface across the sight, in a pixel",
            Some(in_a_pixel),
        ),
        (
            "across",
            "surface across the sight, followed",
            sliding(reach(across)),
        ),
        ("along", "surface along the sight", Some(along)),
        ("tilt", "surface tilted", sliding(reach(tilt))),
        ("wavelength", "wavelength", sliding(by_wavelength)),
    ];
    Ok(changes.map(|(by, words, half_and_none)| Decorrelation {
        by,
        words,
        half_and_none,
    }))
}

/// Returns how far the speckle field slides over the pupil: per length across the sight, per radian
/// of tilt, in metres, and per relative change of the wavelength, in metres.
fn pupil_shifts(
    geometry: &ImagingGeometry,
    angle: f64,
) -> Result<[f64; 3], tem00_decorrelation::Refusal> {
    /// Small enough for the first order to hold, large enough against rounding.
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

    /// Returns the amounts that leave half of the pattern, and nothing of it.
    fn half_and_none(speckle: &Speckle, change: &str) -> Option<[f64; 2]> {
        let mut changes = speckle.decorrelation.iter();
        let change = changes.find(|found| found.by == change);
        change.expect("it is listed").half_and_none
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
            let found = |change| half_and_none(&speckle, change).map(|[_, none]| none);
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
            let [half, none] = half_and_none(&speckle, change).expect("lengths");
            assert_relative_eq!(overlap(half / none).powi(2), 0.5, epsilon = 1e-9);
        }
    }
}
