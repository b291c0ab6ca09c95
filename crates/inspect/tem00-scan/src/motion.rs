use tem00_tracer::{RigidMotion, Scene, Surface, Trajectory};

use crate::ScanError;

/// The moving object in a scan: the part under the line, or the sensor head over the part.
///
/// The head is the camera with its laser. Points that it measures are moved to the place of the
/// part in its description, so that the profiles of all frames fit together.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ScanMotion {
    part: Trajectory,
    head: Trajectory,
    /// The surfaces that belong to the part.
    surfaces: Vec<usize>,
}

impl ScanMotion {
    /// Finds the moving part of a scene: the surface with a given name, or all surfaces that move.
    ///
    /// # Errors
    ///
    /// Returns an error if no surface has the name, if surfaces move differently and none is named,
    /// or if camera and laser do not move as one head.
    pub(crate) fn of_scene(scene: &Scene, surface: Option<&str>) -> Result<Self, ScanError> {
        let surfaces = match surface {
            Some(name) => named(scene, name)?,
            None => moving(scene)?,
        };
        let part = surfaces
            .first()
            .map(|&index| scene.surfaces[index].trajectory.clone());
        let all = || (0..scene.surfaces.len()).collect();
        Ok(Self {
            part: part.unwrap_or_default(),
            head: head(scene)?,
            surfaces: if surfaces.is_empty() { all() } else { surfaces },
        })
    }

    /// Returns the indices of the surfaces that belong to the part; all surfaces of a scene where
    /// none moves.
    pub(crate) fn surfaces(&self) -> &[usize] {
        &self.surfaces
    }

    /// Returns the motion that takes points that the head sees in a frame, in the coordinates of
    /// the head as the scene describes it, to the part as the scene describes it.
    pub(crate) fn to_part(&self, frame: u32) -> RigidMotion {
        let world = self.head.pose_at(frame);
        world.then(&self.part.pose_at(frame).inverse())
    }

    /// Returns the motion of the head from where the scene describes it to a frame.
    pub(crate) fn head_at(&self, frame: u32) -> RigidMotion {
        self.head.pose_at(frame)
    }
}

/// The surface of a name, or its instances.
fn named(scene: &Scene, name: &str) -> Result<Vec<usize>, ScanError> {
    let found = scene.surfaces.iter().position(|s| s.name == name);
    found
        .map(|index| vec![index])
        .ok_or_else(|| ScanError::Scene(format!("no surface of the scene is called \"{name}\"")))
}

/// The surfaces that move, all alike.
fn moving(scene: &Scene) -> Result<Vec<usize>, ScanError> {
    let surfaces = scene.surfaces.iter().enumerate();
    let moving: Vec<(usize, &Surface)> = surfaces
        .filter(|(_, surface)| !surface.trajectory.is_still())
        .collect();
    let Some((_, first)) = moving.first() else {
        return Ok(Vec::new());
    };
    let frames = scene.frames;
    let other = moving
        .iter()
        .find(|(_, surface)| !alike(&surface.trajectory, &first.trajectory, frames));
    match other {
        None => Ok(moving.into_iter().map(|(index, _)| index).collect()),
        Some((_, other)) => Err(ScanError::Scene(format!(
            "the surfaces \"{}\" and \"{}\" move differently: `surface` in [scan] must name the \
             one that is scanned",
            first.name, other.name
        ))),
    }
}

/// The common motion of camera and first laser.
fn head(scene: &Scene) -> Result<Trajectory, ScanError> {
    let Some(laser) = scene.lasers.first() else {
        return Ok(scene.camera_trajectory.clone());
    };
    if alike(laser.trajectory(), &scene.camera_trajectory, scene.frames) {
        return Ok(scene.camera_trajectory.clone());
    }
    Err(ScanError::Scene(
        "camera and laser move differently: in a scan they are one head".to_owned(),
    ))
}

/// Returns whether two motions have the same poses in all frames, to a picometre over a metre.
fn alike(a: &Trajectory, b: &Trajectory, frames: u32) -> bool {
    const CLOSE: f64 = 1e-12;
    a == b
        || (0..frames).all(|frame| {
            let [a, b] = [a, b].map(|trajectory| trajectory.pose_at(frame));
            let turned = a.rotation() - b.rotation();
            let columns = [turned.x_axis, turned.y_axis, turned.z_axis];
            let apart = (a.translation() - b.translation()).length();
            apart < CLOSE && columns.iter().all(|column| column.length() < CLOSE)
        })
}
