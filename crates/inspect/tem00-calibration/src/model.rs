use glam::{DMat3, DVec2, DVec3};
use nalgebra::DVector;
use tem00_camera::{Camera, CameraDescription, RadialDistortion};

use crate::{
    CameraModel,
    perturbation::{INTRINSICS, focal_length, tilt_of},
};

/// Position and attitude of a board in the axes of the camera: to the right, down, along the view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pose {
    pub rotation: DMat3,
    pub translation: DVec3,
}

impl Pose {
    pub(super) fn point(&self, on_board: DVec3) -> DVec3 {
        self.rotation * on_board + self.translation
    }

    /// Turns the board about its origin by a vector in the axes of the camera, and moves it.
    fn stepped(&self, step: &[f64]) -> Self {
        let turn = DVec3::from_slice(step);
        let rotation = DMat3::from_quat(glam::DQuat::from_scaled_axis(turn)) * self.rotation;
        Self {
            rotation,
            translation: self.translation + DVec3::from_slice(&step[3..]),
        }
    }
}

/// The camera in its own axes, by its parameters, and the boards before it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct State {
    /// The first of the [`PARAMETERS`](crate::PARAMETERS).
    pub intrinsics: [f64; INTRINSICS],
    pub poses: Vec<Pose>,
}

/// Corners in images and on the board, and which parameters of the camera are estimated.
#[derive(Clone, Debug)]
pub(super) struct Bundle<'a> {
    pub model: &'a CameraModel,
    /// The positions of the parameters of the camera that are estimated.
    pub free: Vec<usize>,
    /// The corners on the board, in metres.
    pub board: &'a [DVec3],
    /// The corners in the images, in pixels.
    pub images: Vec<&'a [DVec2]>,
}

/// Focus distance used while the sharpness of the image does not matter, in metres.
const FOCUS: f64 = 1.0;

impl CameraModel {
    /// Returns the camera in its own axes, sharp at `focus_distance`, or `None` if it is not
    /// possible.
    pub(super) fn camera(
        &self,
        intrinsics: &[f64; INTRINSICS],
        focus_distance: f64,
    ) -> Option<Camera> {
        let [image_distance, x, y, right, up, k1, k2, k3] = *intrinsics;
        Camera::new(CameraDescription {
            position: DVec3::ZERO,
            look_at: focus_distance * DVec3::Z,
            up: -DVec3::Y,
            focal_length: focal_length(image_distance, focus_distance),
            f_number: self.f_number,
            focus_distance,
            pixel_pitch: self.pixel_pitch,
            resolution: self.resolution,
            principal_point: Some(DVec2::new(x, y)),
            tilt: tilt_of(DVec2::new(right, up)),
            distortion: RadialDistortion { k1, k2, k3 },
            depth_of_field: true,
        })
        .ok()
    }

    /// Returns the middle of the image, in pixels.
    pub(super) fn middle(&self) -> DVec2 {
        DVec2::new(self.resolution[0] as f64, self.resolution[1] as f64) / 2.0
    }
}

impl Bundle<'_> {
    /// Returns the camera of a state, in its own axes.
    pub(super) fn camera(&self, state: &State) -> Option<Camera> {
        self.model.camera(&state.intrinsics, FOCUS)
    }

    /// Returns the state changed by a step: a vector, while a state holds rotations, which are
    /// none.
    pub(super) fn stepped(&self, state: &State, step: &[f64]) -> State {
        let mut next = state.clone();
        for (&parameter, by) in self.free.iter().zip(step) {
            next.intrinsics[parameter] += by;
        }
        let of_poses = step[self.free.len()..].chunks_exact(6);
        for (pose, step) in next.poses.iter_mut().zip(of_poses) {
            *pose = pose.stepped(step);
        }
        next
    }

    /// Returns the residuals of all corners, or `None` for a state that is not possible.
    pub(super) fn residuals(&self, state: &State) -> Option<DVector<f64>> {
        let camera = self.camera(state)?;
        let mut residuals = Vec::with_capacity(2 * self.board.len() * self.images.len());
        for (image, pose) in self.images.iter().zip(&state.poses) {
            for (seen, &corner) in image.iter().zip(self.board) {
                let difference = camera.project(pose.point(corner))? - *seen;
                residuals.extend(difference.to_array());
            }
        }
        Some(DVector::from_vec(residuals))
    }

    /// Returns the steps by which derivatives are taken.
    pub(super) fn increments(&self, state: &State) -> Vec<f64> {
        let image_distance = state.intrinsics[0];
        // The largest tangent in the image, at which distortion shows most.
        let reach = self.model.middle().length() * self.model.pixel_pitch / image_distance;
        let increment = |parameter: &usize| match parameter {
            0 => 1e-5 * image_distance,
            1 | 2 => 1e-2,
            3 | 4 => 1e-5,
            5 => 1e-4 / reach.powi(2),
            6 => 1e-4 / reach.powi(4),
            _ => 1e-4 / reach.powi(6),
        };
        let of_pose = |pose: &Pose| {
            let shift = 1e-5 * pose.translation.length();
            [1e-5, 1e-5, 1e-5, shift, shift, shift]
        };
        let camera = self.free.iter().map(increment);
        camera.chain(state.poses.iter().flat_map(of_pose)).collect()
    }
}
