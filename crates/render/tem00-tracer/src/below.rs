use glam::{DVec2, DVec3};
use tem00_geometry::{Hit, Intersector};
use tem00_numerics::seed::{Purpose, derived, scattered};
use tem00_shading::Laser;
use tem00_translucence::{MAX_ANGLE, Medium, Refusal, SpreadLine};

use crate::Scene;

/// The number of rays along each side of the image that look for the place where a laser lights a
/// surface.
const SIDE: usize = 64;

/// Speckle of the light of a laser from below a translucent surface.
///
/// Its pattern is independent of the pattern of the boundary, and another one in every frame before
/// which camera, laser or surface move. Light of a linewidth lowers its contrast, because paths
/// below the surface differ in length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpeckleBelow {
    contrast: f64,
    /// From the place of a pixel to the place of its factor in the pattern of the boundary, in
    /// pixels.
    displacement: DVec2,
}

impl SpeckleBelow {
    /// Returns the speckle in a frame, by laser and surface; `None` for a surface that is not
    /// translucent.
    ///
    /// # Errors
    ///
    /// Returns an error if the light below a surface cannot be simulated.
    pub fn in_frame(
        scene: &Scene,
        frame: u32,
        intersector: &Intersector,
    ) -> Result<Vec<Vec<Option<Self>>>, Refusal> {
        let of_laser = |laser: usize| {
            let light = scene.laser_at(laser, frame);
            let of_surface = |surface: usize| {
                let Some(medium) = scene.surfaces[surface].material.below() else {
                    return Ok(None);
                };
                let lit = || brightest(scene, frame, intersector, (&light, surface));
                let contrast = match light.spectrum().is_monochromatic() {
                    true => 1.0,
                    false => contrast(medium, &light, lit())?,
                };
                let frame = match scene.speckle_moves(laser, surface) {
                    true => frame,
                    false => scene.reference_frame,
                };
                Ok(Some(Self {
                    contrast,
                    displacement: displacement(scene, frame),
                }))
            };
            (0..scene.surfaces.len()).map(of_surface).collect()
        };
        (0..scene.lasers.len()).map(of_laser).collect()
    }

    /// Returns the point of the image where the factor of a pixel is looked up.
    pub fn pixel(&self, pixel: DVec2) -> DVec2 {
        pixel + self.displacement
    }

    /// Returns the factor of the light from below, from the factor looked up for it.
    pub fn factor(&self, looked_up: f64) -> f64 {
        1.0 + self.contrast * (looked_up - 1.0)
    }
}

/// Returns the displacement of a frame: from a quarter to three quarters of the image, which is far
/// against a grain.
fn displacement(scene: &Scene, frame: u32) -> DVec2 {
    let random = scattered(derived(scene.render.seed, Purpose::Frame, u64::from(frame)));
    let fraction = |bits: u64| 0.25 + 0.5 * (bits as f64 / u64::from(u32::MAX) as f64);
    let size = DVec2::new(scene.camera.width() as f64, scene.camera.height() as f64);
    size * DVec2::new(
        fraction(random >> 32),
        fraction(random & u64::from(u32::MAX)),
    )
}

/// Where a laser lights a surface, and the direction to the camera there.
struct Lit {
    hit: Hit,
    back: DVec3,
}

/// Returns the brightest point that a camera sees on a surface in the light of a laser.
fn brightest(
    scene: &Scene,
    frame: u32,
    intersector: &Intersector,
    (laser, surface): (&Laser, usize),
) -> Option<Lit> {
    let camera = scene.camera_at(frame);
    let size = DVec2::new(camera.width() as f64, camera.height() as f64);
    let mut brightest = None;
    let mut max = -1.0;
    for cell in 0..SIDE * SIDE {
        let cell = DVec2::new((cell % SIDE) as f64, (cell / SIDE) as f64) + 0.5;
        let ray = camera.ray(cell / SIDE as f64 * size);
        let hit = intersector.intersect(&ray);
        let Some(hit) = hit.filter(|hit| hit.surface == surface) else {
            continue;
        };
        let irradiance = laser
            .next_event(hit.position)
            .map_or(0.0, |event| event.e_perp);
        if irradiance > max {
            max = irradiance;
            let back = -ray.direction;
            brightest = Some(Lit { hit, back });
        }
    }
    brightest
}

/// Returns the contrast of the light that leaves within a beam radius of the middle of the line.
fn contrast(medium: &Medium, laser: &Laser, lit: Option<Lit>) -> Result<f64, Refusal> {
    let Some(Lit { hit, back }) = lit else {
        return Ok(1.0);
    };
    let normal = hit.normal * hit.normal.dot(back).signum();
    let source = laser.wave_direction_at(hit.position);
    let angle = |direction: DVec3| normal.dot(direction).clamp(0.0, 1.0).acos().min(MAX_ANGLE);
    let along = |direction: DVec3| direction - normal.dot(direction) * normal;
    // Positive where the laser travels across the surface towards the side of the camera.
    let side = -along(back).dot(along(source)).signum();
    let spread = SpreadLine::new(medium, angle(source), side * angle(back))?;
    let radius = laser.narrow_radius_at(hit.position) / normal.dot(source).max(0.1);
    let window = radius.max(0.05 * medium.transport_length());
    let contrast = spread.contrast(laser.spectrum(), [-window, window]);
    Ok(contrast.unwrap_or(1.0))
}
