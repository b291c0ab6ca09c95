//! Fate of a laser's light on its way to the camera, found without rendering an image.

use glam::{DVec2, DVec3};
use tem00_camera::{Camera, Ray};
use tem00_geometry::{Hit, Intersector};
use tem00_tracer::{Crop, Laser, Scene, TracerError};

use crate::{
    sampler::even,
    walk::{Carried, Met, Roulette, Visitor, Walk, Walker},
};

/// The number of rays that are followed from each laser, and from the camera.
const RAYS: u32 = 4096;
/// The number of rays of each laser whose path is kept.
const KEPT: usize = 64;
/// The maximum number of mirrors and glass surfaces that a ray is followed over.
const MAX_SPECULAR: u32 = 16;
/// The minimum fraction of a laser's power in the image for the laser to count as seen.
const MIN_FRACTION: f64 = 1e-5;

/// Fate of a laser's light on its way to the camera, in one frame.
///
/// It is found from two sides. Rays drawn from the beam are followed over mirrors and through glass
/// to their first rough surface, and from there directly to the camera. Rays of the camera are
/// followed over mirrors and through glass to their first rough surface, and from there directly to
/// the laser. Light that meets rough surfaces one after the other does not count.
///
/// # Validity
///
/// 4096 rays are followed from either side: light that fewer than one in a thousand of them find
/// may be missed.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct LaserInspection {
    /// The fates of the light, the largest fraction first.
    pub parts: Vec<LightPart>,
    /// The fraction of the laser's power, from 0 to about 1, that falls on surfaces in the image:
    /// rough surfaces seen directly, in mirrors or through glass, and lit directly by the laser.
    pub fraction_in_image: f64,
    /// The vertices of the paths of the first 64 rays, from the aperture to their first rough
    /// surface, or out of the scene.
    pub ways: Vec<Vec<DVec3>>,
}

/// Light of a laser that meets the same fate on the same surface.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct LightPart {
    /// The fate of this light.
    pub fate: LightFate,
    /// The index of the surface that it meets, unless it misses all surfaces.
    pub surface: Option<usize>,
    /// The fraction of the laser's power, from 0 to 1.
    pub fraction: f64,
    /// The middle of the lit points, in metres; the middle of the aperture if the light misses all
    /// surfaces.
    pub centre: DVec3,
    /// The image point of this middle, in pixels; `None` where it has none, as behind the camera.
    pub pixel: Option<DVec2>,
}

/// Fate of light on its way to the camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum LightFate {
    /// The camera sees the lit surface.
    Seen,
    /// The beam meets no rough surface: it leaves the scene, ends on a light or stays among mirrors
    /// and glass.
    Misses,
    /// The beam meets a one-sided surface from behind, which scatters nothing.
    MeetsBack,
    /// The beam lights the side of a surface that faces away from the camera.
    LightsFarSide,
    /// The lit surface lies behind the camera.
    BehindCamera,
    /// The lit surface lies outside the image, or outside its rendered part.
    OutsideImage,
    /// An object stands between the lit surface and the camera: the surface of this index, or a
    /// light for an index beyond the surfaces.
    Hidden {
        /// The index among the surfaces, and the area lights behind them.
        by: usize,
    },
}

impl LaserInspection {
    /// Returns whether the camera sees light of the laser: at least a hundred thousandth of its
    /// power.
    pub fn is_seen(&self) -> bool {
        self.fraction_in_image >= MIN_FRACTION || self.fraction_of(LightFate::Seen) > 0.0
    }

    /// Returns the fraction of the laser's power that meets this fate, from 0 to 1.
    pub fn fraction_of(&self, fate: LightFate) -> f64 {
        let parts = self.parts.iter().filter(|part| part.fate == fate);
        parts.map(|part| part.fraction).sum()
    }
}

/// Returns for each laser the fate of its light in `frame` on the way to the camera. It shows,
/// before anything is rendered, why the image might stay dark.
///
/// # Errors
///
/// Returns an error if the geometry cannot be built, or if an option of the render is out of its
/// range.
pub fn inspect_lasers(scene: &Scene, frame: u32) -> Result<Vec<LaserInspection>, TracerError> {
    let inspector = Inspector {
        scene,
        camera: scene.camera_at(frame),
        area: scene.render.area(&scene.camera)?,
        intersector: Intersector::build(&scene.shapes_at(frame))?,
        far: reach(scene),
    };
    let lasers = scene.lasers.iter().map(|laser| laser.in_frame(frame));
    Ok(lasers.map(|laser| inspector.laser(&laser)).collect())
}

/// Returns a length, in metres, beyond which no part of the scene is seen from any other part.
fn reach(scene: &Scene) -> f64 {
    let bounds = scene.surfaces.iter().map(|surface| surface.shape.bounds());
    let points = bounds
        .flat_map(|(low, high)| [low, high])
        .chain(
            scene
                .lasers
                .iter()
                .map(|laser| laser.description().position),
        )
        .chain([scene.camera.position()]);
    let nothing = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (low, high) = points.fold(nothing, |(low, high), p| (low.min(p), high.max(p)));
    (high - low).length()
}

/// Follows the light in one frame.
struct Inspector<'a> {
    scene: &'a Scene,
    camera: Camera,
    /// The part of the image that is rendered.
    area: Crop,
    intersector: Intersector,
    far: f64,
}

/// The end of a ray.
#[derive(Clone, Copy)]
struct RayEnd {
    /// The rough surface, unless it met none.
    hit: Option<Hit>,
    /// The direction in which it arrived.
    direction: DVec3,
    /// The length of its path, in metres.
    length: f64,
    /// The fraction of its light that is left after mirrors and glass, from 0 to 1.
    weight: f64,
}

/// Rays that are followed over mirrors and through glass to their first rough surfaces.
struct Arrivals {
    rays: Vec<RayEnd>,
    /// The vertices of the paths of the first rays.
    ways: Vec<Vec<DVec3>>,
    far: f64,
}

impl<'a> Visitor<'a> for Arrivals {
    fn meet(&mut self, _: u32, met: &mut Vec<Met<'a>>) {
        for Met { walker, vertex } in &*met {
            let arrival = &mut self.rays[walker.number];
            arrival.hit = (!vertex.is_specular()).then_some(vertex.hit);
            arrival.direction = walker.ray.direction;
            arrival.length += vertex.hit.distance;
            arrival.weight = walker.carries;
            self.turn(walker.number, vertex.hit.position);
        }
        met.retain(|met| met.vertex.is_specular());
    }

    fn lose(&mut self, walker: &Walker, light: Option<&Hit>) {
        self.rays[walker.number].weight = walker.carries;
        let beyond = || walker.ray.origin + self.far * walker.ray.direction;
        let end = light.map_or_else(beyond, |hit| hit.position);
        self.turn(walker.number, end);
    }

    fn direction(&mut self, path: usize, depth: u32) -> [f64; 2] {
        let index = u32::try_from(path).unwrap_or(u32::MAX);
        even(index.wrapping_add((depth - 1).wrapping_mul(RAYS)))
    }

    fn survival(&mut self, _: usize, _: u32) -> f64 {
        0.0
    }
}

impl Arrivals {
    fn turn(&mut self, ray: usize, corner: DVec3) {
        if let Some(way) = self.ways.get_mut(ray) {
            way.push(corner);
        }
    }
}

impl Inspector<'_> {
    fn laser(&self, laser: &Laser) -> LaserInspection {
        let emitted = (0..RAYS).map(|index| {
            let [a, b, c, d, ..] = even::<6>(index);
            laser.sample_ray([a, b, c, d]).ray
        });
        let emitted: Vec<_> = emitted.collect();
        let arrivals = self.follow(&emitted, laser.wavelength());
        let mut parts = Parts::default();
        for ((index, ray), arrival) in (0..).zip(&emitted).zip(&arrivals.rays) {
            let fraction = arrival.weight / f64::from(RAYS);
            match &arrival.hit {
                None => parts.add(LightFate::Misses, None, fraction, ray.origin),
                Some(hit) => {
                    let [.., u, v] = even::<6>(index);
                    let fate = self.fate(hit, arrival.direction, [u, v]);
                    parts.add(fate, Some(hit.surface), fraction, hit.position);
                }
            }
        }
        LaserInspection {
            parts: parts.finish(&self.camera),
            fraction_in_image: self.fraction_in_image(laser),
            ways: arrivals.ways,
        }
    }

    /// Follows rays over mirrors and through glass to their first rough surfaces.
    fn follow(&self, rays: &[Ray], wavelength: f64) -> Arrivals {
        let start = |ray: &Ray| RayEnd {
            hit: None,
            direction: ray.direction,
            length: 0.0,
            weight: 1.0,
        };
        let mut arrivals = Arrivals {
            rays: rays.iter().map(start).collect(),
            ways: rays.iter().take(KEPT).map(|ray| vec![ray.origin]).collect(),
            far: self.far,
        };
        let walk = Walk {
            scene: self.scene,
            intersector: &self.intersector,
            wavelength,
            max_depth: MAX_SPECULAR + 1,
            carried: Carried::Power { start: 1.0 },
            roulette: Roulette { certain: u32::MAX },
        };
        let walkers = rays.iter().enumerate().map(|(number, ray)| {
            // The origin may lie in a surface, as an aperture does in a wall.
            let ray = (self.intersector).ray_from(ray.origin, ray.direction, ray.direction);
            Walker::new(number, ray, 1.0)
        });
        walk.follow(walkers.collect(), &mut arrivals);
        arrivals
    }

    /// Returns the fate of light that arrives at a rough surface in this direction.
    fn fate(&self, hit: &Hit, direction: DVec3, lens: [f64; 2]) -> LightFate {
        let lit_side = -direction.dot(hit.normal);
        let one_sided = self.scene.surfaces[hit.surface].material.is_one_sided();
        if one_sided && lit_side < 0.0 {
            return LightFate::MeetsBack;
        }
        let to_camera = self.camera.position() - hit.position;
        if to_camera.dot(self.camera.axes().z_axis) <= 0.0 {
            return LightFate::BehindCamera;
        }
        if lit_side * to_camera.dot(hit.normal) <= 0.0 {
            return LightFate::LightsFarSide;
        }
        let connection = self.camera.connect(hit.position, lens);
        let is_rendered = |pixel: DVec2| self.area.pixel_at(pixel.into()).is_some();
        let Some(connection) = connection.filter(|found| is_rendered(found.pixel)) else {
            return LightFate::OutsideImage;
        };
        match self.between(hit, connection.lens_point) {
            Some(by) => LightFate::Hidden { by },
            None => LightFate::Seen,
        }
    }

    /// Returns the index of the first shape between a surface point and another point, if any.
    fn between(&self, hit: &Hit, to: DVec3) -> Option<usize> {
        if self.intersector.visible(hit.position, hit.normal, to) {
            return None;
        }
        let direction = (to - hit.position).try_normalize()?;
        let ray = self
            .intersector
            .ray_from(hit.position, hit.normal, direction);
        // A surface that only just hides the point may not be met again: then the surface itself
        // hides it.
        let hiding = self.intersector.intersect(&ray);
        Some(hiding.map_or(hit.surface, |hiding| hiding.surface))
    }

    /// Returns the fraction of the laser's power that falls on surfaces in the image.
    ///
    /// ```text
    /// P = Σ E cos θ_i dA,    dA = Ω r² / cos θ_o       Ω the solid angle of each camera ray
    /// ```
    fn fraction_in_image(&self, laser: &Laser) -> f64 {
        let area = self.area;
        let corner = DVec2::new(area.x as f64, area.y as f64);
        let size = DVec2::new(area.width as f64, area.height as f64);
        let pixels_per_ray = size.x * size.y / f64::from(RAYS);
        let seen = (0..RAYS).map(|index| {
            let [s, t, u, v] = even(index);
            let pixel = corner + DVec2::new(s, t) * size;
            (pixel, self.camera.sample_ray(pixel, [u, v]).ray)
        });
        let (pixels, rays): (Vec<_>, Vec<_>) = seen.unzip();
        let arrivals = self.follow(&rays, laser.wavelength()).rays;
        let powers = pixels.iter().zip(&arrivals).map(|(&pixel, arrival)| {
            let solid_angle = pixels_per_ray * self.camera.solid_angle_per_pixel(pixel);
            solid_angle * self.power_per_solid_angle(laser, arrival)
        });
        let power: f64 = powers.sum();
        power / laser.power()
    }

    /// Returns the power of a laser on the surface that a camera ray meets, per solid angle of the
    /// ray, in W/sr.
    fn power_per_solid_angle(&self, laser: &Laser, seen: &RayEnd) -> f64 {
        let Some(hit) = &seen.hit else {
            return 0.0;
        };
        let Some(light) = laser.next_event(hit.position) else {
            return 0.0;
        };
        let [seen_from, lit_from] = [-seen.direction, light.wi].map(|d| d.dot(hit.normal));
        let front = !self.scene.surfaces[hit.surface].material.is_one_sided() || lit_from > 0.0;
        let lit = front && seen_from * lit_from > 0.0;
        if lit && (self.intersector).visible(hit.position, hit.normal, light.point) {
            let irradiance = light.e_perp * lit_from.abs();
            irradiance * seen.length.powi(2) / seen_from.abs()
        } else {
            0.0
        }
    }
}

/// The sums over rays with the same fate on the same surface.
#[derive(Debug, Default)]
struct Parts(Vec<LightPart>);

impl Parts {
    /// Adds a ray; `centre` is the sum of fraction · point until the end.
    fn add(&mut self, fate: LightFate, surface: Option<usize>, fraction: f64, point: DVec3) {
        let same = |part: &&mut LightPart| (part.fate, part.surface) == (fate, surface);
        match self.0.iter_mut().find(same) {
            Some(part) => {
                part.fraction += fraction;
                part.centre += fraction * point;
            }
            None => self.0.push(LightPart {
                fate,
                surface,
                fraction,
                centre: fraction * point,
                pixel: None,
            }),
        }
    }

    fn finish(mut self, camera: &Camera) -> Vec<LightPart> {
        self.0.retain(|part| part.fraction > 0.0);
        for part in &mut self.0 {
            part.centre /= part.fraction;
            part.pixel = part.surface.and_then(|_| camera.project(part.centre));
        }
        self.0.sort_by(|a, b| b.fraction.total_cmp(&a.fraction));
        self.0
    }
}
