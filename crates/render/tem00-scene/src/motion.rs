use glam::DVec3;
use tem00_config::{ANGLE, NUMBER, Problem, Section, Value, rejected};
use tem00_tracer::{Keyframe, Rotation, Trajectory};

const KEYFRAME_KEYS: &[&str] = &["frame", "displacement", "rotation"];
const ROTATION_KEYS: &[&str] = &["axis", "angle"];

/// Reads the point that a thing turns about: the `default`, in metres, unless it is given.
pub(crate) fn pivot(section: &Section<'_>, default: DVec3) -> Result<DVec3, Problem> {
    section.or("pivot", default, Value::lengths)
}

/// Reads how a thing moves, steadily, through keyframes or not at all, turning about a pivot in
/// metres.
pub(crate) fn trajectory(section: &Section<'_>, pivot: DVec3) -> Result<Trajectory, Problem> {
    let keyframes = section.tables("keyframe", KEYFRAME_KEYS)?;
    let trajectory = if keyframes.is_empty() {
        let displacement = section.or("displacement_per_frame", DVec3::ZERO, Value::lengths)?;
        let rotation = rotation(section, "rotation_per_frame")?;
        Trajectory::turning(pivot, rotation, displacement)
    } else {
        refuse_steady(section)?;
        Trajectory::keyframed(pivot, read_keyframes(&keyframes)?)
    };
    trajectory.map_err(|error| rejected(&error, error.parameter(), &[section]))
}

/// Reads a rotation, `{ axis, angle }`, or none without the key.
pub(crate) fn rotation(section: &Section<'_>, key: &'static str) -> Result<Rotation, Problem> {
    let Some(rotation) = section.table(key, ROTATION_KEYS)? else {
        return Ok(Rotation::NONE);
    };
    Ok(Rotation {
        axis: rotation.required("axis", "[0, 0, 1]")?.direction()?,
        angle: rotation.required("angle", "\"90 deg\"")?.quantity(&ANGLE)?,
    })
}

fn refuse_steady(section: &Section<'_>) -> Result<(), Problem> {
    let steady = ["displacement_per_frame", "rotation_per_frame"];
    match steady.into_iter().find(|key| section.has(key)) {
        None => Ok(()),
        Some(key) => Err(section
            .problem_with(
                key,
                format_args!("`{key}` and `keyframe` both say how it moves: give one of the two"),
            )
            .with_help("a keyframe has `displacement` and `rotation` of its own")),
    }
}

fn read_keyframes(sections: &[Section<'_>]) -> Result<Vec<Keyframe>, Problem> {
    let mut keyframes: Vec<Keyframe> = Vec::new();
    for section in sections {
        let value = section.required("frame", "10")?;
        let frame = value.quantity(&NUMBER)?;
        if let Some(before) = keyframes.last().filter(|before| frame <= before.frame) {
            return Err(value.must_be(format_args!(
                "greater than that of the keyframe before, {}",
                before.frame
            )));
        }
        keyframes.push(Keyframe {
            frame,
            displacement: section.or("displacement", DVec3::ZERO, Value::lengths)?,
            rotation: rotation(section, "rotation")?,
        });
    }
    Ok(keyframes)
}
