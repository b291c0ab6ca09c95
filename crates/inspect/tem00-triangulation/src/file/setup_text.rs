use core::fmt::{Display, Write};

use tem00_coherence::{PeakShape, SpectrumForm};
use tem00_config::{LENGTH, NUMBER};

use crate::{
    Averages, DetectorSettings, LineMethod, SensorDescription, SetupDescription, SetupEnvironment,
    SetupQuantity,
};

impl SetupDescription {
    /// Returns the text of a set-up file with this description, as a person would write it: with
    /// units, and without values that equal their defaults. Every number in it reads back as the
    /// same bits.
    ///
    /// The saturation of the detector is left out as well: a set-up takes it from its sensor.
    pub fn to_toml(&self) -> String {
        let mut text = Sections(String::new());
        for section in ["laser", "camera", "sensor", "surface"] {
            text.section(section).quantities(section, self);
        }
        text.detector(&self.detector);
        if self.calibration_uncertainty > 0.0 {
            let uncertainty = LENGTH.text(self.calibration_uncertainty, "um");
            text.section("calibration")
                .value("uncertainty", uncertainty)
                .note("standard uncertainty of a height");
        }
        if self.environment != SetupEnvironment::default() {
            text.section("environment").quantities("environment", self);
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
    /// Writes the quantities of a section, and behind some of them its other keys.
    fn quantities(&mut self, section: &str, description: &SetupDescription) {
        for quantity in SetupQuantity::of_section(section) {
            if let Some(note) = quantity.note_in(description) {
                let unit = quantity.unit();
                let value = quantity.value_in(description);
                let text = unit.dimension.text(value, unit.symbol);
                self.value(quantity.key(), text).note(note);
            }
            self.others_behind(quantity, description);
        }
    }

    fn others_behind(&mut self, quantity: SetupQuantity, description: &SetupDescription) {
        let SetupDescription { camera, sensor, .. } = description;
        match quantity {
            SetupQuantity::SourceHalfAngle => self.spectrum(description),
            SetupQuantity::PixelPitch => {
                let [width, height] = camera.resolution;
                self.value("resolution", format_args!("[{width}, {height}]"))
                    .note("columns, rows");
            }
            SetupQuantity::PrincipalRow if camera.scheimpflug => {
                self.value("scheimpflug", true).note("the sensor is tilted");
            }
            SetupQuantity::Exposure => {
                let unit = quantity.unit();
                let time = unit.dimension.text(sensor.exposure_time, unit.symbol);
                if description.auto_exposure {
                    self.value("exposure", "\"auto\"")
                        .note(time.trim_matches('"'));
                } else {
                    self.value("exposure", time);
                }
                self.value("bit_depth", sensor.bit_depth);
            }
            SetupQuantity::FillFactor
                if sensor.serial_number != SensorDescription::default().serial_number =>
            {
                self.value("serial_number", sensor.serial_number);
            }
            SetupQuantity::Reflectance => {
                self.value("patterns", description.surface.patterns)
                    .note("independent speckle patterns that add up");
            }
            SetupQuantity::CorrelationLength => {
                if let Some(material) = description.surface.subsurface.material {
                    self.value("material", format_args!("\"{}\"", material.name));
                }
            }
            _ => {}
        }
    }

    fn spectrum(&mut self, description: &SetupDescription) {
        let light = &description.laser.light;
        if let SpectrumForm::Peaks(peaks) = &light.form {
            let pair = |&[wavelength, power]: &[f64; 2]| {
                let wavelength = LENGTH.text(wavelength, "nm");
                format!("[{wavelength}, {}]", NUMBER.text(power, ""))
            };
            let pairs: Vec<String> = peaks.iter().map(pair).collect();
            self.value("spectrum", format_args!("[{}]", pairs.join(", ")));
        }
        if light.linewidth > 0.0 {
            match light.form {
                SpectrumForm::Peak(PeakShape::Lorentzian) => {
                    self.value("spectrum", "\"lorentzian\"")
                }
                SpectrumForm::Peak(PeakShape::Rectangular) => {
                    self.value("spectrum", "\"rectangular\"")
                }
                SpectrumForm::Comb(lines) => {
                    self.value("spectrum", "\"comb\"").value("lines", lines)
                }
                _ => self,
            };
        }
    }

    fn detector(&mut self, detector: &DetectorSettings) {
        let section = self.section("detector");
        section.value("method", format_args!("\"{}\"", detector.method.name()));
        match detector.method {
            LineMethod::ThresholdedCentreOfGravity { threshold } => {
                section.value("threshold", NUMBER.text(threshold, ""));
            }
            LineMethod::BlaisRioux { order } => {
                section.value("order", order.taps());
            }
            LineMethod::Steger { sigma } => {
                section
                    .value("sigma", NUMBER.text(sigma, ""))
                    .note("pixels");
            }
            _ => {}
        }
        section
            .value("window", detector.window)
            .note("pixels")
            .value("min_peak", NUMBER.text(detector.min_peak, ""))
            .note("grey values")
            .value("max_lines", detector.max_lines);
    }

    fn section(&mut self, name: &str) -> &mut Self {
        let gap = if self.0.is_empty() { "" } else { "\n" };
        self.add(format_args!("{gap}[{name}]"))
    }

    fn value(&mut self, key: &str, value: impl Display) -> &mut Self {
        self.add(format_args!("{key} = {value}"))
    }

    /// A comment at the end of the last line.
    fn note(&mut self, comment: &str) -> &mut Self {
        if comment.is_empty() {
            return self;
        }
        self.0.truncate(self.0.trim_end().len());
        self.add(format_args!(" # {comment}"))
    }

    fn add(&mut self, line: core::fmt::Arguments<'_>) -> &mut Self {
        // Writing to memory does not fail.
        let _ = writeln!(self.0, "{line}");
        self
    }
}
