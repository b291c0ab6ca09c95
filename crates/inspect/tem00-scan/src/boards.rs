mod render;

use std::sync::Arc;

use glam::{DMat3, DVec2, DVec3};
use tem00_calibration::{BoardSettings, Checkerboard};
use tem00_camera::Camera;
use tem00_geometry::{MeshInstance, Shape, TriangleMesh};
use tem00_numerics::Refusal;
use tem00_tracer::{
    Laser, Light, Material, Relief, RigidMotion, Scene, Surface, SurfaceSpeckle, TracerError,
    Trajectory,
};
use tem00_triangulation::{LaserPlane, TriangulationError, Triangulator};

use crate::{ScanError, laser_plane::plane_of};

/// The tilts of the boards, in radians: 25°, 19° and 13°.
const TILTS: [f64; 3] = [0.436, 0.327, 0.218];

/// The golden ratio less one.
const GOLDEN: f64 = 0.618_033_988_749_895;

/// The turn of the axis of tilt from board to board, in radians: the golden angle, which never
/// repeats.
const TURN: f64 = 2.399_963_229_728_653;

/// Greatest distance of the line from the middle of a board, as a fraction of its height.
const OFF_MIDDLE: f64 = 0.3;

/// Greatest distance of boards before or behind the point where the axis meets the laser plane, as
/// a fraction of the distance.
const MAX_SHIFT: f64 = 0.1;

/// The minimum distance of the squares from the edge of the image, in pixels.
const MARGIN: f64 = 4.0;

/// The reflectances of bright and dark squares: prints are never black.
const REFLECTANCE: [f64; 2] = [0.8, 0.2];

/// A checkerboard in several poses before the camera of a scene, as a user would hold it.
#[derive(Clone, Debug)]
pub struct BoardPlan {
    scene: Scene,
    laser: Laser,
    board: Checkerboard,
    poses: Vec<RigidMotion>,
}

impl BoardPlan {
    /// Plans the poses of a board before the camera of a scene, in the light of its first laser.
    ///
    /// The boards stand about the middle of the image, at different depths, so that their lines
    /// span the laser plane; all but the first are tilted by up to 25° about different axes.
    ///
    /// # Errors
    ///
    /// Returns an error if the scene has no laser, if its plane is not seen in the middle of the
    /// image, or if a board with the requested squares does not lie completely in the image.
    pub fn new(scene: &Scene, settings: &BoardSettings) -> Result<Self, ScanError> {
        let laser = scene.lasers.first().ok_or(TriangulationError::TooFew {
            what: "lasers",
            got: 0,
            needed: 1,
        })?;
        let stage = Stage::new(&scene.camera, laser)?;
        let (board, poses) = match settings.square {
            Some(square) => {
                let board = Checkerboard::new(settings.corners, square)?;
                let poses = stage.poses(&board, settings.boards)?;
                let allowed = "small enough for the whole board to be in the image";
                let refused = || Refusal::new("square_size", square, allowed).in_unit("m");
                (board, poses.ok_or_else(refused)?)
            }
            None => stage.largest(settings)?,
        };
        Ok(Self {
            scene: scene.clone(),
            laser: laser.clone(),
            board,
            poses,
        })
    }

    /// Returns the board.
    pub const fn board(&self) -> &Checkerboard {
        &self.board
    }

    /// Returns the poses of the boards: the motions from the frame of the board to the scene.
    pub fn poses(&self) -> &[RigidMotion] {
        &self.poses
    }

    /// Returns the scene of a board under a point light at the camera, and the scene of the board
    /// under the laser.
    ///
    /// # Errors
    ///
    /// Returns an error if numbers are too large for shapes.
    ///
    /// # Panics
    ///
    /// Panics unless there is such a pose.
    pub fn scenes(&self, pose: usize) -> Result<[Scene; 2], ScanError> {
        let squares = |parity: usize| surface(&self.board, &self.poses[pose], parity);
        let mut lit = self.scene.clone();
        lit.surfaces = vec![squares(0)?, squares(1)?];
        lit.camera_trajectory = Trajectory::default();
        lit.frames = 1;
        lit.reference_frame = 0;
        lit.render.crop = None;
        let mut line = lit.clone();
        lit.lasers.clear();
        lit.lights = vec![Light::point(lit.camera.position(), 1.0)?];
        line.lasers = vec![self.laser.clone().with_trajectory(Trajectory::default())];
        line.lights.clear();
        Ok([lit, line])
    }
}

/// The squares of one parity as a surface; the bright ones have a margin of a square about the
/// board.
fn surface(board: &Checkerboard, pose: &RigidMotion, parity: usize) -> Result<Surface, ScanError> {
    let [columns, rows] = board.corners().map(|corners| corners + 3);
    let is_margin = |i: usize, j: usize| i == 0 || j == 0 || i + 1 == columns || j + 1 == rows;
    let mut vertices = Vec::new();
    let mut triangles = Vec::new();
    for (i, j) in (0..columns).flat_map(|i| (0..rows).map(move |j| (i, j))) {
        let bright = is_margin(i, j) || (i + j) % 2 == 0;
        if bright != (parity == 0) {
            continue;
        }
        // A board of at most 53 squares per side has fewer than 2³² vertices.
        let first = u32::try_from(vertices.len()).unwrap_or(u32::MAX);
        let corner = |di: usize, dj: usize| {
            let [right, up] = [i + di, j + dj].map(|n| n as f64 - 2.0);
            pose.point(board.corner_at(right, up))
        };
        vertices.extend([corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)]);
        triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    }
    let mesh = TriangleMesh::new(vertices, triangles).map_err(|_| TracerError::Direction {
        parameter: "square_size",
        allowed: "neither too small nor too large for a mesh",
    })?;
    Ok(Surface {
        name: ["bright squares", "dark squares"][parity].into(),
        shape: Shape::Mesh(MeshInstance::new(Arc::new(mesh))),
        material: Material::lambertian(REFLECTANCE[parity])?,
        trajectory: Trajectory::default(),
        speckle: SurfaceSpeckle::default(),
        relief: Relief::default(),
    })
}

/// Positions of boards before a camera.
struct Stage {
    camera: Camera,
    plane: LaserPlane,
    /// The point of the laser plane in the middle of the image, in metres.
    middle: DVec3,
    view: DVec3,
    /// The axes of a board that leans half from the camera towards the laser.
    axes: DMat3,
}

impl Stage {
    fn new(camera: &Camera, laser: &Laser) -> Result<Self, ScanError> {
        let plane = plane_of(laser)?;
        let pixel = camera.description().size() / 2.0;
        let unseen = TriangulationError::NotDetermined {
            what: "the laser plane",
            advice: "the middle of the image must see it",
        };
        let seen = Triangulator::new(*camera, plane).point(pixel);
        let middle = seen.ok_or_else(|| unseen.clone())?;
        let view = camera.ray(pixel).direction;
        let description = laser.description();
        let towards = (description.position - description.look_at).normalize_or_zero();
        let normal = (towards - view).try_normalize().ok_or(unseen.clone())?;
        let right = camera.axes().x_axis;
        let right = (right - right.dot(normal) * normal)
            .try_normalize()
            .ok_or(unseen)?;
        Ok(Self {
            camera: *camera,
            plane,
            middle,
            view,
            axes: DMat3::from_cols(right, normal.cross(right), normal),
        })
    }

    /// Returns the poses of a board, or `None` if it does not lie completely in the image in one of
    /// them.
    fn poses(
        &self,
        board: &Checkerboard,
        number: usize,
    ) -> Result<Option<Vec<RigidMotion>>, ScanError> {
        let poses: Result<Vec<_>, _> = (0..number).map(|i| self.pose(board, i)).collect();
        Ok(poses
            .ok()
            .filter(|poses| poses.iter().all(|pose| self.sees(board, pose))))
    }

    fn pose(&self, board: &Checkerboard, number: usize) -> Result<RigidMotion, Refusal> {
        let step = number as f64;
        let angle = TURN * step;
        // The first board is not tilted and stands in the middle. The depths of the others, from −1
        // to 1, go by the multiples of an irrational number.
        let (tilt, depth) = match number {
            0 => (0.0, 0.0),
            _ => (TILTS[number % 3], 2.0 * (GOLDEN * step).fract() - 1.0),
        };
        let tilted = DMat3::from_axis_angle(DVec3::new(angle.cos(), angle.sin(), 0.0), tilt);
        let middle = self.middle + depth * self.largest_shift(board) * self.view;
        let rotation = self.axes * tilted;
        RigidMotion::new(rotation, middle - rotation * board.middle())
    }

    /// Returns how far a board may move along the view until the line leaves its middle.
    fn largest_shift(&self, board: &Checkerboard) -> f64 {
        let normal = self.plane.normal();
        let height = board.square() * (board.corners()[1] - 1) as f64;
        let across = (normal - normal.dot(self.axes.z_axis) * self.axes.z_axis).length();
        let by_line = OFF_MIDDLE * height * across / normal.dot(self.view).abs();
        by_line.min(MAX_SHIFT * self.middle.distance(self.camera.position()))
    }

    /// Returns whether all squares of a board are in the image.
    fn sees(&self, board: &Checkerboard, pose: &RigidMotion) -> bool {
        let [right, up] = board.corners().map(|corners| corners as f64);
        let outline = [(-1.0, -1.0), (right, -1.0), (-1.0, up), (right, up)];
        let size = self.camera.description().size();
        outline.into_iter().all(|(right, up)| {
            let image = self.camera.project(pose.point(board.corner_at(right, up)));
            image.is_some_and(|image| {
                image.cmpgt(DVec2::splat(MARGIN)).all() && image.cmplt(size - MARGIN).all()
            })
        })
    }

    /// Returns the board with the largest squares, in steps of 3 %, that lies completely in the
    /// image in all poses.
    fn largest(
        &self,
        settings: &BoardSettings,
    ) -> Result<(Checkerboard, Vec<RigidMotion>), ScanError> {
        let distance = self.middle.distance(self.camera.position());
        let pitch = self.camera.description().pixel_pitch;
        let width = self.camera.width() as f64 * pitch * distance / self.camera.image_distance();
        let mut square = 2.0 * width / settings.corners[0] as f64;
        for _ in 0..200 {
            let board = Checkerboard::new(settings.corners, square)?;
            if let Some(poses) = self.poses(&board, settings.boards)? {
                return Ok((board, poses));
            }
            square *= 0.97;
        }
        let undetermined = TriangulationError::NotDetermined {
            what: "the size of a board",
            advice: "no board before this camera is whole in its image",
        };
        Err(undetermined.into())
    }
}

#[cfg(test)]
mod tests;
