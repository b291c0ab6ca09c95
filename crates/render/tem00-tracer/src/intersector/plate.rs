use glam::DVec3;
use tem00_camera::Ray;
use tem00_numerics::vectorised;

use super::{
    packet::{LANES, vector},
    primitive::meet_plane,
};
use crate::{Hit, Rectangle};

/// Finds where rays, `LANES` at most, meet a rectangle that is the only shape, by a loop over separate
/// coordinates.
pub(super) fn meet_lone_rectangle(rectangle: &Rectangle, rays: &[Ray], hits: &mut [Option<Hit>]) {
    let (mut origins, mut directions) = ([[0.0; LANES]; 3], [[0.0; LANES]; 3]);
    for (lane, ray) in rays.iter().enumerate() {
        for axis in 0..3 {
            origins[axis][lane] = ray.origin[axis];
            directions[axis][lane] = ray.direction[axis];
        }
    }
    let (mut met, mut points) = ([[0.0; LANES]; 3], [[0.0; LANES]; 3]);
    vectorised(
        #[inline(always)]
        || {
            for lane in 0..LANES {
                let ray = Ray {
                    origin: vector(&origins, lane),
                    direction: vector(&directions, lane),
                };
                let [distance, u, v] = meet_plane(&ray, rectangle);
                let point = rectangle.at(u, v);
                for axis in 0..3 {
                    met[axis][lane] = [distance, u, v][axis];
                    points[axis][lane] = point[axis];
                }
            }
        },
    );
    let normal = rectangle.normal();
    for (lane, hit) in hits.iter_mut().enumerate() {
        let DVec3 {
            x: distance,
            y: u,
            z: v,
        } = vector(&met, lane);
        let is_met = distance > 0.0 && u.abs() <= 1.0 && v.abs() <= 1.0;
        *hit = is_met.then(|| Hit {
            distance,
            position: vector(&points, lane),
            normal,
            shading_normal: normal,
            surface: 0,
        });
    }
}
