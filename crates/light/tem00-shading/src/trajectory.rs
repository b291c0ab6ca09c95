use glam::{DMat3, DQuat, DVec3};
use tem00_decorrelation::RigidMotion;
use tem00_numerics::{Refusal, check};

use crate::ShadingError;

/// Motion of an object from frame to frame.
///
/// The pose of a frame takes the object from its position in the scene description to its position
/// in the frame: a rotation by R about a pivot P of the scene description, and then a displacement
/// d.
///
/// ```text
/// x' = R (x − P) + P + d
/// ```
///
/// In a steady motion angle and displacement grow in proportion to the frame number, from zero in
/// frame 0; the pivot moves with the object. Between keyframes the displacement changes at a
/// constant rate and the rotation at a constant rate about one axis; before the first and after the
/// last keyframe the object is at rest.
///
/// # Examples
///
/// A turntable that turns by 1° per frame, and a turntable that has made one turn in frame 10:
///
/// ```
/// use glam::DVec3;
/// use tem00_shading::{Keyframe, Rotation, Trajectory};
///
/// let degree = Rotation { axis: DVec3::Z, angle: 1_f64.to_radians() };
/// let steady = Trajectory::turning(DVec3::ZERO, degree, DVec3::ZERO)?;
/// let quarter = steady.pose_at(90).point(DVec3::X);
/// assert!((quarter - DVec3::Y).length() < 1e-15);
///
/// let turned = Rotation { axis: DVec3::Z, angle: 360_f64.to_radians() };
/// let last = Keyframe { rotation: turned, ..Keyframe::unmoved(10.0) };
/// let keyframes = [Keyframe::unmoved(0.0), last];
/// let turning = Trajectory::keyframed(DVec3::ZERO, keyframes)?;
/// let half = turning.pose_at(5).point(DVec3::X);
/// assert!((half + DVec3::X).length() < 1e-15);
/// # Ok::<(), tem00_shading::ShadingError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Trajectory {
    pivot: DVec3,
    path: Path,
}

/// A rotation about an axis through a pivot, right-handed.
///
/// The angle may exceed a full turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rotation {
    /// The direction of the axis, of any length.
    pub axis: DVec3,
    /// The angle, in radians.
    pub angle: f64,
}

impl Rotation {
    /// No rotation.
    pub const NONE: Self = Self {
        axis: DVec3::Z,
        angle: 0.0,
    };
}

impl Default for Rotation {
    fn default() -> Self {
        Self::NONE
    }
}

/// Pose of an object at one time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Keyframe {
    /// The time, in frames; fractions are allowed.
    pub frame: f64,
    /// The displacement from the position in the scene description, in metres.
    pub displacement: DVec3,
    /// The rotation from the orientation in the scene description.
    pub rotation: Rotation,
}

impl Keyframe {
    /// Returns the keyframe at which an object is in the pose of the scene description.
    pub const fn unmoved(frame: f64) -> Self {
        Self {
            frame,
            displacement: DVec3::ZERO,
            rotation: Rotation::NONE,
        }
    }
}

#[derive(Clone, Debug, PartialEq)]
enum Path {
    /// Displacement in metres and rotation about a unit axis, both per frame.
    Steady {
        displacement: DVec3,
        rotation: Rotation,
    },
    /// At least one keyframe, in the order of time, with unit axes.
    Keyframes(Vec<Keyframe>),
}

impl Trajectory {
    /// Creates a steady motion without rotation, `displacement` metres from each frame to the next.
    ///
    /// # Errors
    ///
    /// Returns an error if the displacement, or its sum over 2³² frames, is not finite.
    pub fn steady(displacement: DVec3) -> Result<Self, ShadingError> {
        check_steps(displacement)?;
        Ok(Self {
            pivot: DVec3::ZERO,
            path: Path::Steady {
                displacement,
                rotation: Rotation::NONE,
            },
        })
    }

    /// Creates a steady motion that also turns: by `rotation` from each frame to the next about a
    /// pivot in the scene description, in metres, and by `displacement` metres.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`steady`](Self::steady), and an error if the pivot is not finite, if
    /// the axis is zero or not finite, or if the angle, or its sum over 2³² frames, is not finite.
    pub fn turning(
        pivot: DVec3,
        rotation: Rotation,
        displacement: DVec3,
    ) -> Result<Self, ShadingError> {
        check_finite("pivot", pivot * ROOM, "a finite point")?;
        let rotation = checked(rotation, ROOM * f64::from(u32::MAX))?;
        if rotation.angle == 0.0 {
            // Motions without rotation do not depend on the pivot.
            return Self::steady(displacement);
        }
        check_steps(displacement)?;
        Ok(Self {
            pivot,
            path: Path::Steady {
                displacement,
                rotation,
            },
        })
    }

    /// Creates a motion through keyframes, whose rotations are about one pivot in the scene
    /// description, in metres.
    ///
    /// Between two rotations about the same axis the angle changes steadily, through whole turns if
    /// necessary. Between other rotations the object turns through the smallest angle.
    ///
    /// # Errors
    ///
    /// Returns an error if there are no keyframes, if their frames do not increase, if an axis is
    /// zero, or if a number is not finite.
    pub fn keyframed(
        pivot: DVec3,
        keyframes: impl IntoIterator<Item = Keyframe>,
    ) -> Result<Self, ShadingError> {
        check_finite("pivot", pivot * ROOM, "a finite point")?;
        let keyframes: Vec<_> = keyframes
            .into_iter()
            .map(|keyframe| {
                check_finite(
                    "displacement",
                    keyframe.displacement * ROOM,
                    "a finite displacement",
                )?;
                let rotation = checked(keyframe.rotation, ROOM)?;
                Ok(Keyframe {
                    rotation,
                    ..keyframe
                })
            })
            .collect::<Result<_, ShadingError>>()?;
        if keyframes.is_empty() {
            return Err(ShadingError::Missing("a keyframe in a motion by keyframes"));
        }
        check_order(&keyframes)?;
        Ok(Self {
            pivot,
            path: Path::Keyframes(keyframes),
        })
    }

    /// Returns the pose in `frame`.
    pub fn pose_at(&self, frame: u32) -> RigidMotion {
        self.pose(f64::from(frame))
    }

    /// Returns whether the pose is the same in every frame.
    pub fn is_still(&self) -> bool {
        match &self.path {
            Path::Steady {
                displacement,
                rotation,
            } => *displacement == DVec3::ZERO && rotation.angle == 0.0,
            Path::Keyframes(keyframes) => keyframes.windows(2).all(|pair| {
                let turns = between(&pair[0].rotation, &pair[1].rotation);
                pair[0].displacement == pair[1].displacement && turns.angle == 0.0
            }),
        }
    }

    /// Returns the keyframes, in the order of time; empty for a steady motion.
    pub fn keyframes(&self) -> &[Keyframe] {
        match &self.path {
            Path::Steady { .. } => &[],
            Path::Keyframes(keyframes) => keyframes,
        }
    }

    /// The pose at a time in frames.
    fn pose(&self, time: f64) -> RigidMotion {
        match &self.path {
            Path::Steady {
                displacement,
                rotation,
            } => {
                let turned = quaternion(rotation.axis, rotation.angle * time);
                self.placed(turned, *displacement * time)
            }
            Path::Keyframes(keyframes) => {
                // The last keyframe up to now, and the next.
                let next = keyframes.partition_point(|keyframe| keyframe.frame <= time);
                let here = &keyframes[next.saturating_sub(1)];
                let start = quaternion(here.rotation.axis, here.rotation.angle);
                let Some(there) = keyframes.get(next).filter(|_| next > 0) else {
                    return self.placed(start, here.displacement);
                };
                let part = (time - here.frame) / (there.frame - here.frame);
                let turn = between(&here.rotation, &there.rotation);
                self.placed(
                    quaternion(turn.axis, turn.angle * part) * start,
                    here.displacement + (there.displacement - here.displacement) * part,
                )
            }
        }
    }

    /// A rotation about the pivot, and then a displacement.
    fn placed(&self, rotation: DQuat, displacement: DVec3) -> RigidMotion {
        let rotation = DMat3::from_quat(rotation);
        // An object that does not turn keeps its position to the last bit for any pivot.
        let kept = if rotation == DMat3::IDENTITY {
            DVec3::ZERO
        } else {
            self.pivot - rotation * self.pivot
        };
        // Neither can fail: the constructors have checked all numbers.
        RigidMotion::new(rotation, kept + displacement).unwrap_or_default()
    }
}

impl Default for Trajectory {
    fn default() -> Self {
        Self {
            pivot: DVec3::ZERO,
            path: Path::Steady {
                displacement: DVec3::ZERO,
                rotation: Rotation::NONE,
            },
        }
    }
}

/// Numbers that stay finite when multiplied by this factor leave room for their sums and
/// differences.
const ROOM: f64 = 8.0;

/// The rotation that leads from one rotation to another: about their common axis, or else through
/// the smallest angle.
fn between(from: &Rotation, to: &Rotation) -> Rotation {
    let (a, b) = (from, to);
    if a.angle == 0.0 || a.axis == b.axis {
        return Rotation {
            axis: b.axis,
            angle: b.angle - a.angle,
        };
    }
    if b.angle == 0.0 || a.axis == -b.axis {
        return Rotation {
            axis: a.axis,
            angle: -b.angle - a.angle,
        };
    }
    let [start, end] = [a, b].map(|r| quaternion(r.axis, r.angle));
    let turn = end * start.conjugate();
    // Of the two quaternions of a rotation the one with the positive real part turns less.
    let turn = if turn.w < 0.0 { -turn } else { turn };
    let sine = turn.xyz();
    match sine.try_normalize() {
        Some(axis) => Rotation {
            axis,
            angle: 2.0 * libm::atan2(sine.length(), turn.w),
        },
        None => Rotation::NONE,
    }
}

/// A rotation about a unit axis.
///
/// The sine comes from a library, so that a pose has the same bits on every processor.
fn quaternion(axis: DVec3, angle: f64) -> DQuat {
    let (sin, cos) = libm::sincos(0.5 * angle);
    DQuat::from_xyzw(sin * axis.x, sin * axis.y, sin * axis.z, cos)
}

/// The rotation with a unit axis; its angle must stay finite when multiplied by `count`.
fn checked(rotation: Rotation, count: f64) -> Result<Rotation, ShadingError> {
    if !(rotation.angle * count).is_finite() {
        let allowed = "finite (in radians), and so must what it adds up to";
        return Err(Refusal::new("angle", rotation.angle, allowed).into());
    }
    let wrong = || Refusal::new("axis", rotation.axis.to_array(), "a direction");
    let axis = rotation.axis.try_normalize().ok_or_else(wrong)?;
    Ok(Rotation { axis, ..rotation })
}

/// Checks a displacement per frame.
fn check_steps(displacement: DVec3) -> Result<(), ShadingError> {
    check_finite(
        "displacement_per_frame",
        displacement * (ROOM * f64::from(u32::MAX)),
        "a finite displacement",
    )
}

fn check_finite(
    parameter: &'static str,
    vector: DVec3,
    allowed: &'static str,
) -> Result<(), ShadingError> {
    Ok(check::that(
        vector.is_finite(),
        parameter,
        vector.to_array(),
        "",
        allowed,
    )?)
}

/// Checks that keyframes have finite times that increase.
fn check_order(keyframes: &[Keyframe]) -> Result<(), ShadingError> {
    let mut last = f64::NEG_INFINITY;
    for keyframe in keyframes {
        let holds = keyframe.frame.is_finite() && keyframe.frame > last;
        let allowed = "finite and later than that of the keyframe before";
        check::that(holds, "frame", keyframe.frame, "", allowed)?;
        last = keyframe.frame;
    }
    Ok(())
}

#[cfg(test)]
mod tests;
