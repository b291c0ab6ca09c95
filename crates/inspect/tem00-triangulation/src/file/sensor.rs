#[cfg(test)]
mod tests;

use tem00_config::{DURATION, Document, Problem, Section, Value};

use crate::{Sensor, SensorDescription, SetupDescription, SetupQuantity};

/// Reads the section `[sensor]` of a file; the pixel pitch, in metres, stands in `[camera]`.
///
/// `quantum_efficiency` and `exposure` are required. Other missing values are those of
/// [`SensorDescription::typical`]; a missing gain makes a full well the largest grey value.
///
/// # Errors
///
/// Returns a problem, placed in the file, if the section is missing or describes no sensor.
pub fn read_sensor(
    document: &Document<'_>,
    pixel_pitch: f64,
) -> Result<SensorDescription, Problem> {
    let (description, auto) = read_sensor_or_auto(document, pixel_pitch)?;
    match auto {
        None => Ok(description),
        Some(value) => Err(value.must_be("a duration").with_help(
            "\"auto\" is for set-up files: of a scene the light is known only when it is rendered. \
             `tem00-inspect budget` of the set-up tells the time that it chooses",
        )),
    }
}

/// Reads the section `[sensor]` of a set-up file, in which the exposure may be "auto": that value
/// is returned, too, and the exposure time is the typical one.
pub(super) fn read_sensor_or_auto<'a>(
    document: &Document<'a>,
    pixel_pitch: f64,
) -> Result<(SensorDescription, Option<Value<'a>>), Problem> {
    let section = document
        .table("sensor", SetupQuantity::keys_of_section("sensor"))?
        .ok_or_else(|| {
            Problem::new("the file needs a sensor: a section [sensor]").with_help(
                "for example `quantum_efficiency = 0.6` and `exposure = \"2 ms\"` below `[sensor]`",
            )
        })?;
    let exposure = section.required("exposure", "\"2 ms\"")?;
    let auto = exposure.string().is_ok_and(|text| text == "auto");
    let mut description = description(&section, pixel_pitch)?;
    if !auto {
        description.exposure_time = exposure.positive(&DURATION)?;
    }
    match Sensor::new(description) {
        Ok(_) => Ok((description, auto.then_some(exposure))),
        Err(error) => Err(section.problem_with(error.parameter().unwrap_or_default(), &error)),
    }
}

fn description(section: &Section<'_>, pixel_pitch: f64) -> Result<SensorDescription, Problem> {
    let bit_depth = section.or("bit_depth", 12, |value| value.integer(8..=16))?;
    // From 8 to 16.
    let typical = SensorDescription::typical(u32::try_from(bit_depth).unwrap_or(0));
    let mut setup = SetupDescription {
        sensor: SensorDescription {
            pixel_pitch,
            serial_number: section.or("serial_number", 0, |value| {
                value.integer(0..=u64::from(u32::MAX))
            })?,
            ..typical
        },
        ..SetupDescription::default()
    };
    SetupQuantity::read_all(("sensor", section), &mut setup)?;
    if !section.has("gain") {
        setup.sensor.gain = setup.sensor.filling_gain();
    }
    Ok(setup.sensor)
}
