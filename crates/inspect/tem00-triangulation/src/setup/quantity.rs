use core::fmt;

use tem00_config::{Problem, Section};

use super::{
    QuantityUnit, SetupDescription,
    row::Row,
    unit::{
        DEGREES, ELECTRONS, ELECTRONS_PER_SECOND, GREY_PER_ELECTRON, GREY_VALUES, KELVINS,
        MICROMETRES, MILLIMETRES, MILLIRADIANS, MILLISECONDS, MILLIWATTS, NANOMETRES, PER_KELVIN,
        PER_METRE, PIXELS, PLAIN, RELIEF,
    },
    within,
};
use crate::{SensorDescription, SpectrumForm, TriangulationError};

/// The functions that read and change a field of a description.
macro_rules! field {
    ($($field:ident).+) => { (|d| d.$($field).+, |d| &mut d.$($field).+) };
}

/// The row of a number that describes light below the surface, without a value 0.
macro_rules! below {
    ($field:ident, $min:literal, $max:literal, $allowed:literal) => {
        Row::new(field!(surface.subsurface.$field), &PLAIN)
            .within(
                |d| {
                    let body = &d.surface.subsurface;
                    body.range(body.$field, [$min, $max])
                },
                concat!(
                    $allowed,
                    ", and stated beside `transport_length` or `material`"
                ),
            )
            .written_if(|d| d.surface.subsurface.$field != 0.0)
    };
}

/// Declares the sections of a set-up file, with the keys of no quantity in brackets, and their
/// quantities.
macro_rules! quantities {
    ($($section:ident [$($other:ident),*] {
        $($(#[doc = $page:literal])+ $name:ident: $key:ident = $row:expr;)+
    })+) => {
        /// Quantity of a set-up: one number of a data sheet.
        ///
        /// Each is declared in one row of a table, which readers, writers, searches, budgets and
        /// certificates go through.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum SetupQuantity {
            $($($(#[doc = $page])+ $name,)+)+
        }

        impl SetupQuantity {
            /// List of all quantities, in the order of a set-up file.
            pub const ALL: &[Self] = &[$($(Self::$name),+),+];
            /// The keys of all of them.
            pub(crate) const KEYS: &[&str] = &[$($(stringify!($key)),+),+];
            /// The sections that hold quantities, and all of their keys.
            const SECTIONS: &[(&str, &[&str])] = &[
                $((stringify!($section), &[$(stringify!($key),)+ $(stringify!($other)),*])),+
            ];
        }

        static ROWS: &[Row] = &[$($({
            const ROW: Row = $row;
            ROW.at(stringify!($section), stringify!($key), concat!($($page),+))
        }),+),+];
    };
}

quantities! {
    laser [spectrum, lines] {
        /// length from 100 nm to 100 µm, in vacuum; not stated beside a list of `spectrum`, from
        /// which it follows
        Wavelength: wavelength = Row::new(field!(laser.light.wavelength), &NANOMETRES)
            .within(|_| (100e-9, 100e-6), "from 100 nm to 100 µm (in metres)")
            .or("required").read_with_others().varied(3)
            .written_if(|d| !matches!(d.laser.light.form, SpectrumForm::Peaks(_)));
        /// length, at most a tenth of the wavelength: the full width at half maximum of the
        /// spectrum
        Linewidth: linewidth = Row::new(field!(laser.light.linewidth), &NANOMETRES)
            .or("`0`: light of one wavelength").read_with_others().varied(4)
            .written_if(|d| d.laser.light.linewidth > 0.0).note("full width at half maximum");
        /// angle from 0 to 0.3 rad: the half-angle of the disc from which light reaches the part,
        /// seen from there; the light of its parts does not interfere
        SourceHalfAngle: source_half_angle =
            Row::new(field!(laser.light.source_half_angle), &MILLIRADIANS)
            .or("`0`: a point").read_with_others().varied(5)
            .written_if(|d| d.laser.light.source_half_angle > 0.0);
        /// power in the line, positive, at most 1 kW
        Power: power = Row::new(field!(laser.power), &MILLIWATTS).required("\"5 mW\"").varied(6)
            .within(|_| (f64::MIN_POSITIVE, 1e3), "positive, at most 1000 W (in watts)");
        /// full 1/e² thickness of the line on the part, from 1 µm to 1 m
        LineThickness: line_thickness = Row::new(field!(laser.line_thickness), &MILLIMETRES)
            .within(|_| (1e-6, 1.0), "from 1 µm to 1 m (in metres)")
            .required("\"0.2 mm\"").note("between the points of 1/e², on the part").varied(2);
        /// length of the line on the part, from `line_thickness` to 100 m: the power is spread
        /// evenly along it
        LineLength: line_length = Row::new(field!(laser.line_length), &MILLIMETRES)
            .within(
                |d| (d.laser.line_thickness, 100.0),
                "from the thickness of the line to 100 m (in metres)",
            )
            .required("\"50 mm\"");
        /// length from -1 m to 1 m: how far, along y, the plane of the laser stands beside the
        /// point that the optical axis meets on the reference plane
        LaserOffset: offset = Row::new(field!(laser.offset), &MILLIMETRES)
            .within(|_| (-1.0, 1.0), "from -1 m to 1 m (in metres)")
            .written_if(|d| d.laser.offset != 0.0)
            .note("of the plane of the laser from the optical axis");
        /// angle from -45° to 45°: of the plane of the laser from the upright; positive if it leans
        /// to +y, away from the camera. The angle between the optical axis and the plane of the
        /// laser is then θ + `tilt`, and a pixel sees $\cos(\mathtt{tilt})\sin\theta/\sin(\theta +
        /// \mathtt{tilt})$ times the height
        LaserTilt: tilt = Row::new(field!(laser.tilt), &DEGREES)
            .within(|_| (-0.786, 0.786), "from -45° to 45° (in radians)")
            .written_if(|d| d.laser.tilt != 0.0)
            .note("of the plane of the laser, away from the camera");
    }
    camera [resolution, scheimpflug] {
        /// length from 0.1 mm to 1 m
        FocalLength: focal_length = Row::new(field!(camera.focal_length), &MILLIMETRES)
            .within(|_| (1e-4, 1.0), "from 0.1 mm to 1 m (in metres)")
            .required("\"25 mm\"").varied(9);
        /// number from 0.5 to 1000
        FNumber: f_number = Row::new(field!(camera.f_number), &PLAIN)
            .within(|_| (0.5, 1e3), "from 0.5 to 1000").required("8").varied(0);
        /// length from 0.1 µm to 1 mm
        PixelPitch: pixel_pitch = Row::new(field!(sensor.pixel_pitch), &MICROMETRES)
            .within(|_| (0.1e-6, 1e-3), "from 0.1 µm to 1 mm (in metres)")
            .required("\"3.45 um\"").varied(8);
        /// length from the lens (its entrance pupil) to the line on the part, from 1.001 focal
        /// lengths to 1 km
        Distance: distance = Row::new(field!(camera.distance), &MILLIMETRES)
            .within(
                |d| (1.001 * d.camera.focal_length, 1e3),
                "from 1.001 focal lengths to 1000 m (in metres)",
            )
            .required("\"300 mm\"").note("from the lens to the line").varied(10);
        /// angle θ from 1° to 89°, from the upright; to the plane of the laser if that has no
        /// `tilt`
        Angle: angle = Row::new(field!(camera.angle), &DEGREES)
            // Slightly more than that, to allow for rounding at the ends.
            .within(
                |_| (0.999_999_f64.to_radians(), 89.000_001_f64.to_radians()),
                "from 1° to 89° (in radians)",
            )
            .required("\"30 deg\"").note("between the optical axis and the vertical").varied(1);
        /// number from 0 to the number of rows: the row that the optical axis meets, in pixels
        PrincipalRow: principal_row = Row::new(
                (
                    |d| d.camera.principal_row.unwrap_or_else(|| d.camera.middle_row()),
                    |d| {
                        let middle = d.camera.middle_row();
                        d.camera.principal_row.get_or_insert(middle)
                    },
                ),
                &PIXELS,
            )
            .within(
                |d| (0.0, d.camera.resolution[1] as f64),
                "a row of the image, from 0 to their number",
            )
            .or("the middle").written_if(|d| d.camera.principal_row.is_some())
            .note("that the optical axis meets");
    }
    sensor [bit_depth, serial_number] {
        /// number above 0, at most 1: electrons per photon on the whole pixel, at the wavelength of
        /// the laser
        QuantumEfficiency: quantum_efficiency = Row::new(field!(sensor.quantum_efficiency), &PLAIN)
            .within(|_| (f64::MIN_POSITIVE, 1.0), "above 0 and at most 1")
            .required("0.6").note("at the wavelength of the laser");
        /// duration, positive; in set-up files also `"auto"`, see below
        Exposure: exposure = Row::new(field!(sensor.exposure_time), &MILLISECONDS)
            .within(|_| (f64::MIN_POSITIVE, 1e6), "above 0 and at most 1e6, in seconds")
            .or("required").read_with_others().written_if(|_| false).varied(7);
        /// electrons at saturation, from 1 to 1e9
        FullWell: full_well = Row::new(field!(sensor.full_well), &ELECTRONS)
            .within(|_| (1.0, 1e9), "from 1 to 1e9, in electrons")
            .or("`10500`").note("electrons");
        /// grey value without light, in DN
        BlackLevel: black_level = Row::new(field!(sensor.black_level), &GREY_VALUES)
            .within(
                |d| (0.0, d.sensor.largest_value().next_down()),
                "at least 0 and below the largest grey value, in DN",
            )
            .or("1/64 of the range").written_if(|d| {
                let typical = SensorDescription::typical(d.sensor.bit_depth).black_level;
                d.sensor.black_level.to_bits() != typical.to_bits()
            });
        // After the two quantities from which a gain follows if it is not given.
        /// grey values per electron
        Gain: gain = Row::new(field!(sensor.gain), &GREY_PER_ELECTRON)
            .within(|_| (f64::MIN_POSITIVE, 1e6), "above 0 and at most 1e6, in DN per electron")
            .or("such that the full well is the largest grey value")
            .written_if(|d| d.sensor.gain.to_bits() != d.sensor.filling_gain().to_bits());
        /// electrons, from 0: temporal noise without light
        DarkNoise: dark_noise = Row::new(field!(sensor.dark_noise), &ELECTRONS)
            .within(|_| (0.0, 1e6), "from 0 to 1e6, in electrons").or("`2.3`").note("electrons");
        /// electrons per second, from 0
        DarkCurrent: dark_current = Row::new(field!(sensor.dark_current), &ELECTRONS_PER_SECOND)
            .within(|_| (0.0, 1e12), "from 0 to 1e12, in electrons per second")
            .or("`3`").note("electrons per second");
        // Ten standard deviations below its mean, which no pixel is, the response is still not
        // negative.
        /// from 0 to 0.1: standard deviation of the pixels' responses as a fraction
        Prnu: prnu = Row::new(field!(sensor.prnu), &PLAIN)
            .within(|_| (0.0, 0.1), "from 0 to 0.1, as a fraction").or("`0.005`");
        /// electrons, from 0: standard deviation of the pixels' dark signals
        Dsnu: dsnu = Row::new(field!(sensor.dsnu), &ELECTRONS)
            .within(|_| (0.0, 1e6), "from 0 to 1e6, in electrons").or("`1`").note("electrons");
        /// above 0, at most 1: the part of the pixel, a square about its middle, over which it
        /// integrates; 1 behind microlenses
        FillFactor: fill_factor = Row::new(field!(sensor.fill_factor), &PLAIN)
            .within(|_| (f64::MIN_POSITIVE, 1.0), "above 0 and at most 1").or("`1`")
            .written_if(|d| d.sensor.fill_factor < 1.0);
    }
    surface [patterns, material] {
        /// number above 0, at most 1: of a Lambertian surface, at the wavelength of the laser. For
        /// metal enter the ratio of its radiance towards the camera to that of white paper in the
        /// same light
        Reflectance: reflectance = Row::new(field!(surface.reflectance), &PLAIN)
            .within(|_| (f64::MIN_POSITIVE, 1.0), "positive, at most 1").required("0.5");
        /// from 0 to 1: degree of polarisation of the scattered light; 1 for bare metal, 0 for
        /// paper
        Polarisation: polarisation = Row::new(field!(surface.polarisation), &PLAIN)
            .within(|_| (0.0, 1.0), "from 0 to 1").or("`1`");
        /// length, positive: standard deviation of the height of the relief finer than a resolution
        /// cell, the size of a speckle on the part. It spreads the paths of light that has a
        /// `linewidth`, and does nothing otherwise. Not the Rq of a drawing, which includes waves
        /// up to 0.8 mm long: those longer than a cell only tilt it and do not spread the paths
        RmsHeight: rms_height = Row::new(field!(surface.relief.rms_height), &RELIEF)
            .within(|_| (0.0, 1.0), "from 0 to 1 m, of the relief finer than a resolution cell")
            .or("not known: no spread").read_with_others()
            .written_if(|d| d.surface.relief.rms_height > 0.0)
            .note("of the relief finer than a resolution cell");
        /// length at which the correlation exp(−d²/ℓ²) of these heights falls to 1/e
        CorrelationLength: correlation_length =
            Row::new(field!(surface.relief.correlation_length), &MICROMETRES)
            .within(|_| (0.0, 1.0), "from 0 to 1 m")
            .or("`0`: far below a resolution cell").read_with_others()
            .written_if(|d| d.surface.relief.correlation_length > 0.0);
        /// length from 10 nm to 1 m: the transport length 1/µs′ of light below the surface of
        /// a part that lets light in, such as plastic, marble or skin. The light leaves beside the
        /// line, which is wider and reads too low
        TransportLength: transport_length =
            Row::new(field!(surface.subsurface.transport_length), &MILLIMETRES)
            .within(
                |d| match d.surface.subsurface.transport_length == 0.0 {
                    true => (0.0, 0.0),
                    false => (1e-8, 1.0),
                },
                "from 10 nm to 1 m (in metres)",
            )
            .or("that of the `material`; else no light enters")
            .written_if(|d| d.surface.subsurface.transport_length > 0.0)
            .note("of light below the surface");
        /// number per metre, from 10⁻⁶ to 100 per transport length: absorption coefficient below
        /// the surface
        Absorption: absorption = Row::new(field!(surface.subsurface.absorption), &PER_METRE)
            .within(
                |d| {
                    let body = &d.surface.subsurface;
                    if body.absorption == 0.0 && body.material.is_some() {
                        return (0.0, 0.0);
                    }
                    match body.transport_length > 0.0 {
                        true => (1e-6 / body.transport_length, 1e2 / body.transport_length),
                        false => body.range(body.absorption, [1e-6, 1e10]),
                    }
                },
                "from 1e-6 to 100 per `transport_length` (in 1/m), and stated beside it or a \
                 `material`",
            )
            .or("that of the `material`; else required beside `transport_length`")
            .written_if(|d| d.surface.subsurface.absorption > 0.0)
            .note("per metre, below the surface");
        /// number from 1 to 3, of a part that lets light in
        RefractiveIndex: refractive_index = below!(refractive_index, 1.0, 3.0, "from 1 to 3")
            .or("that of the `material`, else `1.5`");
        /// mean cosine of the scattering angle below the surface, from -0.95 to 0.95: at the same
        /// transport length it hardly moves the line, but widens it
        Anisotropy: anisotropy = below!(anisotropy, -0.95, 0.95, "from -0.95 to 0.95");
        /// number from 0 to 0.5: root mean square slope, along each axis, of the facets of a matt
        /// boundary
        BoundarySlope: boundary_slope = below!(boundary_slope, 0.0, 0.5, "from 0 to 0.5")
            .or("`0`: smooth");
        /// number from 0 to 1: fraction of the light towards the camera that the boundary of a part
        /// that lets light in reflects itself, where the line enters
        SurfaceFraction: surface_fraction = below!(surface_fraction, 0.0, 1.0, "from 0 to 1");
    }
    environment [] {
        /// number of kelvins from -200 to 200: the temperature less that at which the other values
        /// hold
        TemperatureChange: temperature_change =
            Row::new(field!(environment.temperature_change), &KELVINS)
            .within(|_| (-200.0, 200.0), "from -200 to 200 K")
            .note("kelvins since the calibration");
        /// number from -0.001 to 0.001, per kelvin: of the base between camera and laser; it moves
        /// the laser plane away by that part of $L \sin\theta$
        BaseExpansion: base_expansion = Row::new(field!(environment.base_expansion), &PER_KELVIN)
            .within(|_| (-1e-3, 1e-3), "from -0.001 to 0.001 per kelvin").note("per kelvin");
        /// number from -0.001 to 0.001, per kelvin: of the mount between lens and sensor; it
        /// lengthens the image distance
        MountExpansion: mount_expansion =
            Row::new(field!(environment.mount_expansion), &PER_KELVIN)
            .within(|_| (-1e-3, 1e-3), "from -0.001 to 0.001 per kelvin");
    }
}

impl SetupQuantity {
    /// Returns the quantities of a section of a set-up file, in its order.
    pub(crate) fn of_section(section: &str) -> impl Iterator<Item = Self> {
        let all = Self::ALL.iter().copied();
        all.filter(move |quantity| quantity.row().section == section)
    }

    /// Returns all keys of a section of a set-up file that holds quantities.
    pub(crate) fn keys_of_section(section: &str) -> &'static [&'static str] {
        let found = Self::SECTIONS.iter().find(|(name, _)| *name == section);
        found.map_or(&[], |(_, keys)| keys)
    }

    /// Returns the quantities that a search may vary, in the order in which it varies them.
    pub fn varied() -> Vec<Self> {
        let mut varied = Self::ALL.to_vec();
        varied.retain(|quantity| quantity.row().design.is_some());
        varied.sort_by_key(|quantity| quantity.row().design);
        varied
    }

    fn row(self) -> &'static Row {
        &ROWS[self as usize]
    }

    /// Returns whether it describes light from below the surface.
    pub const fn is_subsurface(self) -> bool {
        matches!(
            self,
            Self::TransportLength
                | Self::Absorption
                | Self::RefractiveIndex
                | Self::Anisotropy
                | Self::BoundarySlope
                | Self::SurfaceFraction
        )
    }

    /// Returns the section of a set-up file and the key in it.
    pub fn path(self) -> [&'static str; 2] {
        [self.row().section, self.row().key]
    }

    /// Returns the key in its section of a set-up file.
    pub fn key(self) -> &'static str {
        self.row().key
    }

    /// Returns the unit that it is usually read and written in.
    pub fn unit(self) -> &'static QuantityUnit {
        self.row().unit
    }

    /// Returns the comment next to the key in a written set-up; `None` if the set-up needs no such
    /// key.
    pub(crate) fn note_in(self, description: &SetupDescription) -> Option<&'static str> {
        (self.row().is_written)(description).then_some(self.row().note)
    }

    /// Returns the row of the key in the page of set-up files.
    pub fn documentation(self) -> String {
        let Row {
            key, page, default, ..
        } = self.row();
        format!("| `{key}` |{page} | {default} |")
    }

    /// Returns the value in a set-up, in SI units.
    pub fn value_in(self, description: &SetupDescription) -> f64 {
        (self.row().get)(description)
    }

    /// Changes the value in a set-up, in SI units, whether or not it is possible then. An exposure
    /// that is set is no longer chosen by the light.
    pub fn set(self, description: &mut SetupDescription, value: f64) {
        description.auto_exposure &= self != Self::Exposure;
        *(self.row().field)(description) = value;
    }

    /// Checks that the value in a set-up is in its range.
    pub(crate) fn check(self, description: &SetupDescription) -> Result<(), TriangulationError> {
        let row = self.row();
        within(
            row.key,
            self.value_in(description),
            (row.range)(description),
            row.allowed,
        )
    }

    /// Reads the quantities of a section into a set-up, except for quantities that are read with
    /// other keys.
    pub(crate) fn read_all(
        section: (&str, &Section<'_>),
        description: &mut SetupDescription,
    ) -> Result<(), Problem> {
        let (name, section) = section;
        for quantity in Self::of_section(name) {
            let row = quantity.row();
            let value = match row.example {
                _ if row.is_read_with_others => continue,
                Some(example) => Some(section.required(row.key, example)?),
                None => section.optional(row.key),
            };
            if let Some(value) = value {
                quantity.set(description, value.quantity(row.unit.dimension)?);
            }
        }
        Ok(())
    }
}

impl fmt::Display for SetupQuantity {
    /// Writes the path of the key, as in `camera.angle`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [section, key] = self.path();
        write!(f, "{section}.{key}")
    }
}
