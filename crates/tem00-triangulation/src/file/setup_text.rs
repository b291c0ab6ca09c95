use core::fmt::Write;

use crate::{LineMethod, SetupDescription};

impl SetupDescription {
    /// Returns the text of a set-up file with this description, in SI units. Every number in it reads
    /// back as the same bits.
    ///
    /// What is left out is the saturation of the detector: a set-up takes it from its sensor.
    pub fn to_toml(&self) -> String {
        let (laser, camera, sensor) = (&self.laser, &self.camera, &self.sensor);
        let [width, height] = camera.resolution;
        let mut text = Sections(String::new());
        text.section("laser")
            .number("wavelength", laser.wavelength)
            .number("power", laser.power)
            .number("line_width", laser.line_width)
            .number("line_length", laser.line_length);
        text.section("camera")
            .number("focal_length", camera.focal_length)
            .number("f_number", camera.f_number)
            .number("pixel_pitch", sensor.pixel_pitch)
            .value("resolution", format_args!("[{width}, {height}]"))
            .number("distance", camera.distance)
            .number("angle", camera.angle)
            .value("scheimpflug", camera.scheimpflug);
        text.section("sensor")
            .number("quantum_efficiency", sensor.quantum_efficiency)
            .number("exposure", sensor.exposure_time)
            .value("bit_depth", sensor.bit_depth)
            .number("gain", sensor.gain)
            .number("black_level", sensor.black_level)
            .number("full_well", sensor.full_well)
            .number("dark_noise", sensor.dark_noise)
            .number("dark_current", sensor.dark_current)
            .number("prnu", sensor.prnu)
            .number("dsnu", sensor.dsnu)
            .number("fill_factor", sensor.fill_factor)
            .value("serial_number", sensor.serial_number);
        text.section("surface")
            .number("reflectance", self.surface.reflectance)
            .value("patterns", self.surface.patterns)
            .number("polarisation", self.surface.polarisation);
        text.detector(self);
        text.section("calibration")
            .number("uncertainty", self.calibration_uncertainty);
        text.section("average")
            .value("columns", self.average.columns)
            .value("frames", self.average.frames)
            .value("independent_speckle", self.average.independent_speckle);
        text.0
    }
}

/// Text that grows section by section.
struct Sections(String);

impl Sections {
    fn section(&mut self, name: &str) -> &mut Self {
        let gap = if self.0.is_empty() { "" } else { "\n" };
        self.add(format_args!("{gap}[{name}]"))
    }

    /// A number with as many digits as it takes to read it back.
    fn number(&mut self, key: &str, value: f64) -> &mut Self {
        let plain = value == 0.0 || (1e-3..1e6).contains(&value.abs());
        if plain {
            self.value(key, value)
        } else {
            self.value(key, format_args!("{value:e}"))
        }
    }

    fn value(&mut self, key: &str, value: impl core::fmt::Display) -> &mut Self {
        self.add(format_args!("{key} = {value}"))
    }

    fn add(&mut self, line: core::fmt::Arguments<'_>) -> &mut Self {
        // Writing to memory does not fail.
        let _ = writeln!(self.0, "{line}");
        self
    }

    fn detector(&mut self, description: &SetupDescription) {
        let detector = &description.detector;
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
                section.number("sigma", sigma);
            }
            _ => {}
        }
        section
            .value("window", detector.window)
            .number("least_peak", detector.least_peak)
            .value("most_lines", detector.most_lines);
    }
}
