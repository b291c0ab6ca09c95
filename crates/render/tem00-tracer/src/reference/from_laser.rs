//! Light that a laser sends through mirrors and glass, which no path from the camera finds:
//! followed from the laser, one path at a time, and connected to the camera at each rough surface.

use core::sync::atomic::{AtomicBool, Ordering};

use glam::DVec3;
use tem00_camera::Ray;
use tem00_geometry::Hit;
use tem00_numerics::cast::to_f32;
use tem00_numerics::parallel;

use super::{CERTAIN_SURFACES, Random, Reference};
use crate::{Crop, Frame, LocalFrame, Material, RenderError};

/// The number of independent groups of paths, whose scatter gives the variance.
const GROUPS: usize = 64;

/// Contribution of light paths to one pixel, or to the camera as a whole.
struct Splat {
    pixel: usize,
    /// In W/(m² sr), of light that has met one rough surface or more, and with its speckle.
    single: f64,
    multiple: f64,
    radiance: f64,
    /// The power on the first rough surface, in watts.
    power: f64,
}

/// Sums over the paths of a laser in one pixel; of the radiance, and of the squares of the
/// radiances of groups.
#[derive(Clone, Copy, Default)]
struct Sums {
    single: f64,
    multiple: f64,
    radiance: [f64; 2],
}

/// Returns the variance of a sum over groups, from the sum and the sum of the squares.
fn variance([sum, squares]: [f64; 2]) -> f64 {
    let groups = GROUPS as f64;
    groups / (groups - 1.0) * (squares - sum * sum / groups).max(0.0)
}

/// Light at a surface: the direction in which it came, and its power in watts.
struct Arrival<'a> {
    hit: Hit,
    material: &'a Material,
    direction: DVec3,
    flux: f64,
    rough: u32,
}

impl Reference<'_> {
    /// Adds the light that is followed from the lasers to their layers.
    pub(super) fn add_light_from_lasers(
        &self,
        area: Crop,
        frame: &mut Frame,
        progress: &(dyn Fn(u64) + Sync),
        cancel: &AtomicBool,
    ) -> Result<(), RenderError> {
        let pixels = (self.camera.width() * self.camera.height()) as u64;
        let per_group =
            (pixels * u64::from(self.options.samples_per_pixel)).div_ceil(GROUPS as u64);
        for (laser, layers) in frame.lasers.iter_mut().enumerate() {
            let groups = parallel::map(GROUPS, |group| {
                if cancel.load(Ordering::Relaxed) {
                    return Err(RenderError::Cancelled);
                }
                let indices = [
                    u64::from(self.frame),
                    u64::MAX,
                    (laser * GROUPS + group) as u64,
                ];
                let mut random = Random::new(self.options.seed, indices);
                let mut splats = Vec::new();
                for _ in 0..per_group {
                    self.follow(laser, area, &mut random, &mut splats);
                }
                progress(per_group);
                Ok(splats)
            });
            let groups: Vec<_> = groups.into_iter().collect::<Result<_, _>>()?;
            let paths = (GROUPS as u64 * per_group) as f64;
            let mut sums = vec![Sums::default(); area.width * area.height];
            let mut power = [0.0; 2];
            for splats in &groups {
                let mut of_group = vec![0.0; sums.len()];
                for splat in splats {
                    let sums = &mut sums[splat.pixel];
                    sums.single += splat.single / paths;
                    sums.multiple += splat.multiple / paths;
                    of_group[splat.pixel] += splat.radiance / paths;
                }
                for (sums, radiance) in sums.iter_mut().zip(of_group) {
                    sums.radiance[0] += radiance;
                    sums.radiance[1] += radiance * radiance;
                }
                let of_group = splats.iter().map(|splat| splat.power / paths).sum::<f64>();
                power = [power[0] + of_group, power[1] + of_group * of_group];
            }
            for (pixel, sums) in sums.iter().enumerate() {
                let at = [pixel % area.width, pixel / area.width].into();
                layers.single[at] += to_f32(sums.single);
                layers.multiple[at] += to_f32(sums.multiple);
                layers.radiance[at] += to_f32(sums.radiance[0]);
                layers.variance[at] += to_f32(variance(sums.radiance));
            }
            layers.power_on_target += power[0];
            layers.power_error = layers.power_error.hypot(variance(power).sqrt());
        }
        Ok(())
    }

    /// Follows one path of light.
    fn follow(&self, laser: usize, area: Crop, random: &mut Random, splats: &mut Vec<Splat>) {
        let source = &self.lasers[laser];
        let [a, b] = [random.pair(), random.pair()];
        let sent = source.sample_ray([a[0], a[1], b[0], b[1]]);
        let (mut flux, mut rough) = (sent.flux, 0);
        // The aperture may lie in a surface.
        let Ray { origin, direction } = sent.ray;
        let mut ray = self.intersector.ray_from(origin, direction, direction);
        for depth in 1..=self.options.max_depth.unwrap_or(u32::MAX) {
            let Some(hit) = self.intersector.intersect(&ray) else {
                return;
            };
            let Some(surface) = self.scene.surfaces.get(hit.surface) else {
                return;
            };
            // Paths from the camera find the light that meets a rough surface first.
            if depth == 1 && self.finds_lasers() && !surface.material.is_specular() {
                return;
            }
            let arrival = Arrival {
                hit,
                material: &surface.material,
                direction: ray.direction,
                flux,
                rough,
            };
            if !surface.material.is_specular() {
                splats.extend(self.splat(laser, &arrival, area, random));
            }
            // Choose where the light continues.
            let axes = LocalFrame::from_normal(hit.shading_normal);
            let back = axes.to_local(-ray.direction);
            let wavelength = source.wavelength();
            let Some(drawn) = arrival.material.sample(back, random.pair(), wavelength) else {
                return;
            };
            let out = axes.to_world(drawn.wi);
            flux *= drawn.weight * drawn.eta_squared * arrival.adjoint(out, [back.z, drawn.wi.z]);
            if depth > CERTAIN_SURFACES {
                let survival = (flux / source.power()).min(0.95);
                if random.number() >= survival {
                    return;
                }
                flux /= survival;
            }
            if flux <= 0.0 {
                return;
            }
            rough += u32::from(!drawn.specular);
            ray = self.intersector.ray_from(hit.position, hit.normal, out);
        }
    }

    /// Returns the contribution of the light at a rough surface to the pixel that sees it through a
    /// drawn point of the lens.
    fn splat(
        &self,
        laser: usize,
        arrival: &Arrival<'_>,
        area: Crop,
        random: &mut Random,
    ) -> Option<Splat> {
        let (position, surface) = (arrival.hit.position, arrival.hit.surface);
        let seen = self.camera.connect(position, random.pair())?;
        let pixel = area.pixel_at(seen.pixel.into())?;
        let out = (seen.lens_point - position).try_normalize()?;
        if !self
            .intersector
            .visible(position, arrival.hit.normal, seen.lens_point)
        {
            return None;
        }
        let axes = LocalFrame::from_normal(arrival.hit.normal_seen_from(out));
        let [wo, back] = [out, -arrival.direction].map(|v| axes.to_local(v));
        let bsdf = arrival
            .material
            .evaluate(wo, back, self.lasers[laser].wavelength());
        let scattered = bsdf * wo.z.abs() * arrival.adjoint(out, [back.z, wo.z]);
        let radiance = arrival.flux * scattered * seen.importance;
        let normal = axes.normal() * axes.normal().dot(out).signum();
        let factor = self.factor(laser, surface, seen.pixel, position, normal);
        let is_single = arrival.rough == 0;
        let is_lit = -arrival.direction.dot(arrival.hit.normal) * out.dot(arrival.hit.normal) > 0.0;
        Some(Splat {
            pixel,
            single: if is_single { radiance } else { 0.0 },
            multiple: if is_single { 0.0 } else { radiance },
            radiance: radiance * factor,
            power: if is_single && is_lit {
                arrival.flux
            } else {
                0.0
            },
        })
    }
}

impl Arrival<'_> {
    /// Returns the gain over scattering with the normal of the surface itself, which makes light
    /// carry as much as a path from the camera finds: E. Veach, 1997, § 5.3. `shaded` are the
    /// cosines with the normal of the shading.
    fn adjoint(&self, out: DVec3, shaded: [f64; 2]) -> f64 {
        let back = -self.direction.dot(self.hit.normal);
        let out = out.dot(self.hit.normal);
        let agree = shaded[0] * back > 0.0 && shaded[1] * out > 0.0;
        if agree {
            (shaded[0] / back) * (out / shaded[1])
        } else {
            0.0
        }
    }
}
