use crate::{
    Axis, Field, FlatResult, GrooveResult, ProfileSensor, Response, SphereResult, flat, grooves,
    response, sphere,
};

/// The minimum number of repetitions from which a spread can be estimated.
const MIN_REPETITIONS: usize = 4;

/// Effort of a characterisation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// The number of places at which flats and grooves are measured, at least 4.
    pub repetitions: usize,
}

impl Options {
    /// Returns the number of profiles that are measured.
    pub const fn profiles(self) -> usize {
        let repeated = response::HEIGHTS as usize + flat::PROFILES + 1;
        repeated * self.repetitions + sphere::PROFILES as usize + grooves::PROFILES
    }
}

impl Default for Options {
    fn default() -> Self {
        Self { repetitions: 16 }
    }
}

/// Characteristics of a sensor; `None` where too little of an artefact was seen.
#[derive(Clone, Debug, PartialEq)]
pub struct Characteristics {
    /// Field of measurement of the sensor.
    pub field: Field,
    /// The response to heights.
    pub response: Option<Response>,
    /// Noise, flatness and flat form.
    pub flat: Option<FlatResult>,
    /// Probing size and form.
    pub sphere: Option<SphereResult>,
    /// Resolution, fidelity and mapping, across the profile and across the scan.
    pub grooves: [Option<GrooveResult>; 2],
}

/// Lets a sensor measure a level flat at several heights, flats that are tilted, a sphere, and
/// grooves of falling width along both axes.
///
/// # Errors
///
/// Returns the error of the sensor.
///
/// # Panics
///
/// Panics with fewer than 4 repetitions.
pub fn characterise<S: ProfileSensor>(
    sensor: &mut S,
    options: Options,
) -> Result<Characteristics, S::Error> {
    let Options { repetitions } = options;
    assert!(
        repetitions >= MIN_REPETITIONS,
        "repetitions {repetitions} must be at least {MIN_REPETITIONS}"
    );
    Ok(Characteristics {
        field: sensor.field(),
        response: Response::measure(sensor, repetitions)?,
        flat: FlatResult::measure(sensor, repetitions)?,
        sphere: SphereResult::measure(sensor)?,
        grooves: [
            GrooveResult::measure(sensor, Axis::X, repetitions)?,
            GrooveResult::measure(sensor, Axis::Y, repetitions)?,
        ],
    })
}
