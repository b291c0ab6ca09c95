use core::fmt::Write;

use tem00_coherence::{LaserLight, LineShape, Relief, Spectrum};
use tem00_config::{ANGLE, DURATION, Dimension, LENGTH, NUMBER, POWER};

use crate::{
    Averages, DetectorSettings, LineMethod, SensorDescription, SetupDescription, SetupEnvironment,
    SetupSurface,
};

impl SetupDescription {
    /// Returns the text of a set-up file with this description, as a person would write it: with units, and
    /// without what is as it is by default. Every number in it reads back as the same bits.
    ///
    /// What is left out as well is the saturation of the detector: a set-up takes it from its sensor.
    pub fn to_toml(&self) -> String {
        let mut text = Sections(String::new());
        text.laser(self);
        text.camera(self);
        text.sensor(self);
        text.surface(&self.surface);
        text.detector(&self.detector);
        if self.calibration_uncertainty > 0.0 {
            text.section("calibration")
                .length("uncertainty", self.calibration_uncertainty, "um")
                .note("standard uncertainty of a height");
        }
        let environment = &self.environment;
        if *environment != SetupEnvironment::default() {
            text.section("environment")
                .number("temperature_change", environment.temperature_change)
                .note("kelvins since the calibration")
                .number("base_expansion", environment.base_expansion)
                .note("per kelvin")
                .number("mount_expansion", environment.mount_expansion);
        }
        if self.average != Averages::default() {
            text.section("average")
                .value("columns", self.average.columns)
                .value("frames", self.average.frames)
                .value("independent_speckle", self.average.independent_speckle);
        }
        text.0
    }
}

/// Text that grows section by section.
struct Sections(String);

impl Sections {
    fn laser(&mut self, description: &SetupDescription) {
        let laser = &description.laser;
        self.section("laser")
            .light(&laser.light)
            .quantity("power", laser.power, (&POWER, "mW"))
            .length("line_thickness", laser.line_thickness, "mm")
            .note("between the points of 1/e², on the part")
            .length("line_length", laser.line_length, "mm");
        if laser.offset != 0.0 {
            self.length("offset", laser.offset, "mm")
                .note("of the plane of the laser from the optical axis");
        }
        if laser.tilt != 0.0 {
            self.quantity("tilt", laser.tilt, (&ANGLE, "deg"))
                .note("of the plane of the laser, away from the camera");
        }
    }

    fn light(&mut self, light: &LaserLight) -> &mut Self {
        if let Spectrum::Peaks(peaks) = &light.spectrum {
            let pair = |&[wavelength, power]: &[f64; 2]| {
                let wavelength = LENGTH.text(wavelength, "nm");
                format!("[{wavelength}, {}]", NUMBER.text(power, ""))
            };
            let pairs: Vec<String> = peaks.iter().map(pair).collect();
            self.value("spectrum", format_args!("[{}]", pairs.join(", ")));
        } else {
            self.length("wavelength", light.wavelength, "nm");
        }
        if light.linewidth > 0.0 {
            self.length("linewidth", light.linewidth, "nm")
                .note("full width at half maximum");
        }
        if light.source_half_angle > 0.0 {
            let angle = light.source_half_angle;
            self.quantity("source_half_angle", angle, (&ANGLE, "mrad"));
        }
        match light.spectrum {
            Spectrum::Peak(LineShape::Lorentzian) if light.linewidth > 0.0 => {
                self.value("spectrum", "\"lorentzian\"")
            }
            Spectrum::Peak(LineShape::Rectangular) if light.linewidth > 0.0 => {
                self.value("spectrum", "\"rectangular\"")
            }
            Spectrum::Comb(lines) if light.linewidth > 0.0 => {
                self.value("spectrum", "\"comb\"").value("lines", lines)
            }
            _ => self,
        }
    }

    fn camera(&mut self, description: &SetupDescription) {
        let camera = &description.camera;
        let [width, height] = camera.resolution;
        self.section("camera")
            .length("focal_length", camera.focal_length, "mm")
            .number("f_number", camera.f_number)
            .length("pixel_pitch", description.sensor.pixel_pitch, "um")
            .value("resolution", format_args!("[{width}, {height}]"))
            .note("columns, rows")
            .length("distance", camera.distance, "mm")
            .note("from the lens to the line")
            .quantity("angle", camera.angle, (&ANGLE, "deg"))
            .note("between the optical axis and the upright");
        if let Some(row) = camera.principal_row {
            self.number("principal_row", row)
                .note("that the optical axis meets");
        }
        if camera.scheimpflug {
            self.value("scheimpflug", true).note("the sensor is tilted");
        }
    }

    fn sensor(&mut self, description: &SetupDescription) {
        let sensor = &description.sensor;
        let typical = SensorDescription::typical(sensor.bit_depth);
        let (bits, black, well) = (sensor.bit_depth, sensor.black_level, sensor.full_well);
        let filling = SensorDescription::filling_gain(bits, black, well);
        let time = DURATION.text(sensor.exposure_time, "ms");
        self.section("sensor")
            .number("quantum_efficiency", sensor.quantum_efficiency)
            .note("at the wavelength of the laser");
        if description.auto_exposure {
            let time = time.trim_matches('"');
            self.value("exposure", "\"auto\"").note(time);
        } else {
            self.value("exposure", time);
        }
        self.value("bit_depth", sensor.bit_depth)
            .number("full_well", sensor.full_well)
            .note("electrons")
            .unless("black_level", sensor.black_level, typical.black_level)
            .unless("gain", sensor.gain, filling)
            .number("dark_noise", sensor.dark_noise)
            .note("electrons")
            .number("dark_current", sensor.dark_current)
            .note("electrons per second")
            .number("prnu", sensor.prnu)
            .number("dsnu", sensor.dsnu)
            .note("electrons")
            .unless("fill_factor", sensor.fill_factor, typical.fill_factor);
        if sensor.serial_number != typical.serial_number {
            self.value("serial_number", sensor.serial_number);
        }
    }

    fn surface(&mut self, surface: &SetupSurface) {
        self.section("surface")
            .number("reflectance", surface.reflectance)
            .value("patterns", surface.patterns)
            .note("independent speckle patterns that add up")
            .number("polarisation", surface.polarisation);
        self.relief(surface.relief);
    }

    fn relief(&mut self, relief: Relief) {
        if relief.rms_height > 0.0 {
            self.length("rms_height", relief.rms_height, "um")
                .note("of the relief finer than a resolution cell");
        }
        if relief.correlation_length > 0.0 {
            self.length("correlation_length", relief.correlation_length, "um");
        }
    }

    fn detector(&mut self, detector: &DetectorSettings) {
        let section = self.section("detector");
        section.value("method", format_args!("\"{}\"", detector.method.name()));
        match detector.method {
            LineMethod::ThresholdedCentreOfGravity { threshold } => {
                section.number("threshold", threshold);
            }
            LineMethod::BlaisRioux { order } => {
                section.value("order", order.taps());
            }
            LineMethod::Steger { sigma } => {
                section.number("sigma", sigma).note("pixels");
            }
            _ => {}
        }
        section
            .value("window", detector.window)
            .note("pixels")
            .number("min_peak", detector.min_peak)
            .note("grey values")
            .value("max_lines", detector.max_lines);
    }

    fn section(&mut self, name: &str) -> &mut Self {
        let gap = if self.0.is_empty() { "" } else { "\n" };
        self.add(format_args!("{gap}[{name}]"))
    }

    fn length(&mut self, key: &str, value: f64, usual: &str) -> &mut Self {
        self.quantity(key, value, (&LENGTH, usual))
    }

    /// A quantity with its unit, if that is short the `usual` one.
    fn quantity(
        &mut self,
        key: &str,
        value: f64,
        (dimension, usual): (&Dimension, &str),
    ) -> &mut Self {
        self.value(key, dimension.text(value, usual))
    }

    fn number(&mut self, key: &str, value: f64) -> &mut Self {
        self.quantity(key, value, (&NUMBER, ""))
    }

    /// A number that is not the default.
    fn unless(&mut self, key: &str, value: f64, default: f64) -> &mut Self {
        if value.to_bits() == default.to_bits() {
            return self;
        }
        self.number(key, value)
    }

    fn value(&mut self, key: &str, value: impl core::fmt::Display) -> &mut Self {
        self.add(format_args!("{key} = {value}"))
    }

    /// A comment at the end of the last line.
    fn note(&mut self, comment: &str) -> &mut Self {
        self.0.truncate(self.0.trim_end().len());
        self.add(format_args!(" # {comment}"))
    }

    fn add(&mut self, line: core::fmt::Arguments<'_>) -> &mut Self {
        // Writing to memory does not fail.
        let _ = writeln!(self.0, "{line}");
        self
    }
}
