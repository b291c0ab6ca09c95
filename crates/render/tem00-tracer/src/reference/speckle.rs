use glam::{DVec2, DVec3};
use tem00_geometry::Intersector;
use tem00_numerics::seed::{Purpose, derived};
use tem00_shading::{Motion, PreparedSpeckle, Speckle, SpeckleFrame};

use crate::{Scene, TracerError};

/// The number of rays along each side of the image that look for the points from which the largest
/// shift of speckle is found.
const SIDE: usize = 16;

/// The speckle of a scene as any host of `tem00-shading` has it: prepared once for each laser and
/// each surface.
#[derive(Clone, Debug)]
pub struct ReferenceSpeckle {
    /// Speckle by laser and surface; `None` for a surface that the camera never sees.
    prepared: Vec<Vec<Option<PreparedSpeckle>>>,
}

impl ReferenceSpeckle {
    /// Generates the patterns of a scene for all of its frames.
    ///
    /// # Errors
    ///
    /// Returns an error if the geometry cannot be built, or if the patterns do not fit the memory
    /// that the scene allows.
    pub fn prepare(scene: &Scene, seed: u64) -> Result<Self, TracerError> {
        let seen = points_seen(scene)?;
        let parts = (scene.lasers.len() * scene.surfaces.len()).max(1) as u64;
        let prepare = |laser: usize, surface: usize| {
            let points = &seen[surface];
            if points.is_empty() {
                return Ok(None);
            }
            let camera = scene.camera_at(scene.reference_frame);
            let light = scene.laser_at(laser, scene.reference_frame);
            let seed = derived(seed, Purpose::Laser, laser as u64);
            let look = &scene.surfaces[surface].speckle;
            let speckle = Speckle::new(&camera, &light, seed)
                .looks(look.patterns as usize)
                .polarisation(look.polarisation)
                .relief(scene.surfaces[surface].relief)
                .within(scene.speckle.memory / parts)
                .for_motions((0..scene.frames).map(|frame| motion(scene, laser, surface, frame)))
                .at_points(points.iter().copied());
            Ok(Some(speckle.prepare()?))
        };
        let of_laser = |laser| {
            let surfaces = 0..scene.surfaces.len();
            surfaces.map(|surface| prepare(laser, surface)).collect()
        };
        let prepared = (0..scene.lasers.len()).map(of_laser);
        Ok(Self {
            prepared: prepared.collect::<Result<_, TracerError>>()?,
        })
    }

    /// Returns the speckle in a frame, by laser and surface.
    pub(super) fn in_frame(
        &self,
        scene: &Scene,
        frame: u32,
    ) -> Result<Vec<Vec<Option<SpeckleFrame>>>, TracerError> {
        let surfaces = |(laser, surfaces): (usize, &Vec<Option<PreparedSpeckle>>)| {
            let frames = surfaces.iter().enumerate().map(|(surface, prepared)| {
                let prepared = prepared.as_ref();
                prepared
                    .map(|prepared| prepared.frame(&motion(scene, laser, surface, frame)))
                    .transpose()
            });
            frames.collect::<Result<_, _>>()
        };
        let lasers = self.prepared.iter().enumerate().map(surfaces);
        Ok(lasers.collect::<Result<_, _>>()?)
    }
}

/// Returns the motion from the reference frame to `frame`. Surfaces with the same trajectory are
/// one body.
fn motion(scene: &Scene, laser: usize, surface: usize, frame: u32) -> Motion {
    let since = |trajectory: &crate::Trajectory| {
        let before = trajectory.pose_at(scene.reference_frame);
        before.inverse().then(&trajectory.pose_at(frame))
    };
    let trajectory = &scene.surfaces[surface].trajectory;
    let mut surfaces = scene.surfaces.iter();
    Motion {
        body: surfaces
            .position(|other| other.trajectory == *trajectory)
            .unwrap_or(surface),
        surface: since(trajectory),
        camera: since(&scene.camera_trajectory),
        laser: since(scene.lasers[laser].trajectory()),
    }
}

/// Returns points of each surface, with their normals, as they stand in the reference frame: the
/// points that the camera sees there or, for a surface that is hidden there, in the first frame
/// that shows it.
fn points_seen(scene: &Scene) -> Result<Vec<Vec<(DVec3, DVec3)>>, TracerError> {
    let mut seen = vec![Vec::new(); scene.surfaces.len()];
    for frame in [scene.reference_frame].into_iter().chain(0..scene.frames) {
        let missing: Vec<_> = seen.iter().map(Vec::is_empty).collect();
        if !missing.contains(&true) {
            break;
        }
        let intersector = Intersector::build(&scene.shapes_at(frame))?;
        let camera = scene.camera_at(frame);
        let size = DVec2::new(camera.width() as f64, camera.height() as f64);
        for cell in 0..SIDE * SIDE {
            let cell = DVec2::new((cell % SIDE) as f64, (cell / SIDE) as f64) + 0.5;
            let ray = camera.ray(cell / SIDE as f64 * size);
            let Some(hit) = intersector.intersect(&ray) else {
                continue;
            };
            if missing.get(hit.surface) != Some(&true) {
                continue;
            }
            let normal = -hit.normal * hit.normal.dot(ray.direction).signum();
            let trajectory = &scene.surfaces[hit.surface].trajectory;
            let back = trajectory.pose_at(frame).inverse();
            let back = back.then(&trajectory.pose_at(scene.reference_frame));
            seen[hit.surface].push((back.point(hit.position), back.direction(normal)));
        }
    }
    Ok(seen)
}
