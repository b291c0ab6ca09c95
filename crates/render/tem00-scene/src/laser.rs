use core::f64::consts::PI;
use core::ops::Bound;

use glam::DVec3;
use tem00_beam::{AngularProfile, FanGeometry, FocusCurve, GaussianBeam, LineProfile};
use tem00_config::{
    ANGLE, Choice, Document, LENGTH, NUMBER, POWER, Problem, Section, Value, read_laser_light,
    rejected,
};
use tem00_tracer::{BeamShape, Laser, LaserDescription};

use crate::motion::{pivot, trajectory};
use crate::placement::{Placement, across};

const KEYS: &[&str] = &[
    "wavelength",
    "linewidth",
    "spectrum",
    "lines",
    "source_half_angle",
    "power",
    "position",
    "look_at",
    "line_direction",
    "displacement_per_frame",
    "rotation_per_frame",
    "pivot",
    "keyframe",
    "spot",
    "line",
];
const SPOT_KEYS: &[&str] = &["waist_radius", "waist_distance", "m_squared"];
const LINE_KEYS: &[&str] = &[
    "fan_angle",
    "thickness",
    "focus_distance",
    "focus_curve",
    "apex_offset",
    "profile",
    "edge",
    "m_squared",
];
const SHAPES: &[Choice] = &[("spot", SPOT_KEYS), ("line", LINE_KEYS)];
const PROFILES: &[(&str, LineProfile)] = &[
    ("gaussian", LineProfile::GaussianTan),
    ("gaussian_angle", LineProfile::GaussianAngle),
    ("gaussian_sin", LineProfile::GaussianSin),
    ("uniform", LineProfile::UniformTan),
    ("uniform_angle", LineProfile::UniformAngle),
    ("powell", LineProfile::Powell { edge: 0.05 }),
];

const TABLE_KEYS: &[&str] = &["angles", "powers"];
const FOCUS_CURVES: &[(&str, FocusCurve)] = &[
    ("distance", FocusCurve::EqualDistance),
    ("plane", FocusCurve::EqualPlane),
];

pub(crate) fn read(root: &Document<'_>) -> Result<Vec<Laser>, Problem> {
    let sections = root.tables("laser", KEYS)?;
    if sections.is_empty() {
        return Err(Problem::new("the scene needs a laser: a section [[laser]]"));
    }
    sections.iter().map(laser).collect()
}

fn laser(section: &Section<'_>) -> Result<Laser, Problem> {
    let light = read_laser_light(section, &(10e-9..=1e-3, "from 10 nm to 1 mm"))?;
    let spectrum = light
        .spectrum()
        .map_err(|error| rejected(&error, Some(error.parameter()), &[section]))?;
    let source_extent = light
        .extent()
        .map_err(|error| rejected(&error, Some(error.parameter()), &[section]))?;
    let wavelength = spectrum.wavelength();
    let placement = Placement::read(section)?;
    let axis = placement.axis();
    let (kind, beam) = section.one_of("shape", SHAPES)?;
    let shape = match kind {
        "spot" => spot(&beam, axis.length())?,
        _ => line(&beam, axis.length(), wavelength)?,
    };
    let sideways = across(axis, DVec3::X, DVec3::Y);
    let description = LaserDescription {
        spectrum,
        power: section.required("power", "\"5 mW\"")?.positive(&POWER)?,
        position: placement.position,
        look_at: placement.look_at,
        line_direction: section.or("line_direction", sideways, Value::direction)?,
        shape,
    };
    let laser = Laser::new(description)
        .map_err(|error| rejected(&error, error.parameter(), &[&beam, section]))?;
    let pivot = pivot(section, placement.position)?;
    let laser = laser.with_source_extent(source_extent);
    Ok(laser.with_trajectory(trajectory(section, pivot)?))
}

/// Reads a beam, round or elliptic, with its waists at `distance` unless they are given.
fn spot(section: &Section<'_>, distance: f64) -> Result<BeamShape, Problem> {
    Ok(BeamShape::Spot {
        waist_radius: along_and_across(
            &section.required("waist_radius", "\"0.5 mm\"")?,
            |value| value.positive(&LENGTH),
        )?,
        waist_distance: section.or("waist_distance", [distance; 2], |value| {
            along_and_across(value, |value| value.quantity(&LENGTH))
        })?,
        m_squared: section.or("m_squared", [1.0; 2], |value| {
            along_and_across(value, m_squared)
        })?,
    })
}

/// Reads one value for both axes of a spot, or a list of one for each.
fn along_and_across<'a>(
    value: &Value<'a>,
    read: impl Fn(&Value<'a>) -> Result<f64, Problem>,
) -> Result<[f64; 2], Problem> {
    if value.is_list() {
        let [along, across] = value.elements("one value, or a list [along, across] of two")?;
        Ok([read(&along)?, read(&across)?])
    } else {
        read(value).map(|both| [both; 2])
    }
}

/// Reads a laser line, with its focus at `distance` unless it is given.
fn line(section: &Section<'_>, distance: f64, wavelength: f64) -> Result<BeamShape, Problem> {
    let fan_angle = section.required("fan_angle", "\"30 deg\"")?.within(
        &ANGLE,
        (Bound::Excluded(0.0), Bound::Excluded(PI)),
        "greater than 0° and less than 180°",
    )?;
    let thickness = section.required("thickness", "\"0.2 mm\"")?;
    let waist_radius = thickness.positive(&LENGTH)? / 2.0;
    let m_squared = section.or("m_squared", 1.0, m_squared)?;
    let focus_distance = section.or("focus_distance", distance, |value| value.quantity(&LENGTH))?;
    let focus = GaussianBeam::from_waist(wavelength, waist_radius)
        .and_then(|beam| beam.with_m_squared(m_squared))
        .map_err(|error| {
            thickness
                .problem(error)
                .with_help("the waist radius of a line is half its thickness")
        })?;
    // A lens that receives a round beam fans it out from a point where it would be this wide.
    let apex_offset = focus.radius_at(focus_distance) / (0.5 * fan_angle).tan();
    Ok(BeamShape::Line {
        waist_radius,
        m_squared,
        fan: FanGeometry {
            fan_angle,
            apex_offset: section.or("apex_offset", apex_offset, |value| value.positive(&LENGTH))?,
            focus_distance,
            focus_curve: section.or("focus_curve", FocusCurve::default(), |value| {
                value.one_of(FOCUS_CURVES)
            })?,
        },
        profile: profile(section)?,
    })
}

fn m_squared(value: &Value<'_>) -> Result<f64, Problem> {
    value.within(&NUMBER, 1.0.., "1 or greater")
}

fn profile(section: &Section<'_>) -> Result<LineProfile, Problem> {
    let profile = section.or("profile", LineProfile::GaussianTan, |value| {
        if value.is_table() {
            table(section).map(LineProfile::Tabulated)
        } else {
            value.one_of(PROFILES)
        }
    })?;
    match (profile, section.optional("edge")) {
        (profile, None) => Ok(profile),
        (LineProfile::Powell { .. }, Some(edge)) => Ok(LineProfile::Powell {
            edge: edge.within(&NUMBER, 1e-6..=1.0, "from 1e-6 to 1")?,
        }),
        (_, Some(edge)) => Err(edge
            .problem("`edge` belongs to the profile \"powell\"")
            .with_help("write `profile = \"powell\"` as well")),
    }
}

/// Reads the power per angle of a data sheet.
fn table(section: &Section<'_>) -> Result<AngularProfile, Problem> {
    let Some(table) = section.table("profile", TABLE_KEYS)? else {
        return Err(section.problem("the profile needs a table"));
    };
    let angles = table.required("angles", "[\"-30 deg\", 0, \"30 deg\"]")?;
    let powers = table.required("powers", "[0.8, 1, 0.8]")?;
    let angles = angles.list("a list of angles")?;
    let powers = powers.list("a list of numbers")?;
    let radians: Result<Vec<f64>, Problem> =
        angles.iter().map(|angle| angle.quantity(&ANGLE)).collect();
    let relative: Result<Vec<f64>, Problem> =
        powers.iter().map(|power| power.quantity(&NUMBER)).collect();
    AngularProfile::new(&radians?, &relative?).map_err(|error| {
        let list = if error.parameter == "angles" {
            &angles
        } else {
            &powers
        };
        match error.index.and_then(|index| list.get(index)) {
            Some(value) => value.problem(error),
            None => table.problem(error),
        }
    })
}
