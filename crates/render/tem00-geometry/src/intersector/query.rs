use glam::DVec3;
use tem00_camera::Ray;

use super::primitive::Primitive;
use crate::Segment;

/// Index of a primitive in a scene: the index of the body, and the index of the triangle in it.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub(super) struct PrimitiveIndex {
    pub body: u32,
    pub triangle: u32,
}

/// Question about a ray; answered in double precision.
pub(super) trait Query {
    /// True if any primitive in the way decides.
    const ANY: bool;

    fn ray(&self) -> &Ray;

    /// Returns the distance beyond which nothing matters, in metres.
    fn end(&self) -> f64;

    /// Considers a primitive that the ray may meet.
    fn offer(&mut self, primitive: &Primitive, index: PrimitiveIndex);

    /// Records that something is in the way, well before the end.
    fn settle(&mut self);

    /// Returns whether the answer is known.
    fn is_over(&self) -> bool;
}

/// Query for the first primitive that the ray meets.
#[derive(Clone, Debug)]
pub(super) struct Nearest {
    ray: Ray,
    pub best: Option<(f64, PrimitiveIndex)>,
}

impl Nearest {
    pub(super) const fn new(ray: Ray) -> Self {
        Self { ray, best: None }
    }
}

impl Query for Nearest {
    const ANY: bool = false;

    #[inline(always)]
    fn ray(&self) -> &Ray {
        &self.ray
    }

    #[inline(always)]
    fn end(&self) -> f64 {
        self.best.map_or(f64::INFINITY, |(distance, _)| distance)
    }

    #[inline(always)]
    fn offer(&mut self, primitive: &Primitive, index: PrimitiveIndex) {
        if let Some(distance) = primitive.distance(&self.ray) {
            let candidate = (distance, index);
            if self.best.is_none_or(|best| candidate < best) {
                self.best = Some(candidate);
            }
        }
    }

    #[inline(always)]
    fn settle(&mut self) {}

    #[inline(always)]
    fn is_over(&self) -> bool {
        false
    }
}

/// Query whether any primitive stands in the way.
#[derive(Clone, Debug)]
pub(super) struct Shadow {
    ray: Ray,
    length: f64,
    clearance: f64,
    pub hidden: bool,
}

impl Shadow {
    /// Asks about a segment in a scene where computed points are off their surface by `clearance`,
    /// in metres.
    pub(super) fn new(segment: &Segment, clearance: f64) -> Self {
        let Segment {
            from,
            from_normal,
            to,
        } = *segment;
        let side = from_normal.dot(to - from);
        let away = if side < 0.0 { -clearance } else { clearance };
        let origin = from + away * from_normal;
        let way = to - origin;
        let length = way.length();
        // Nothing is between a point and itself: a direction that is not finite meets nothing.
        let direction = way / length;
        Self {
            ray: Ray { origin, direction },
            length,
            clearance,
            hidden: false,
        }
    }
}

impl Query for Shadow {
    const ANY: bool = true;

    #[inline(always)]
    fn ray(&self) -> &Ray {
        &self.ray
    }

    #[inline(always)]
    fn end(&self) -> f64 {
        self.length
    }

    /// A primitive stands in the way unless the ray ends on it.
    #[inline(always)]
    fn offer(&mut self, primitive: &Primitive, _: PrimitiveIndex) {
        let Some(distance) = primitive.distance(&self.ray) else {
            return;
        };
        if distance >= self.length {
            return;
        }
        // The height of the ray's end beyond the primitive's tangent plane; negative if it ends
        // before.
        let direction = self.ray.direction;
        let height = |normal: DVec3| (self.length - distance) * normal.dot(direction).abs();
        let met = primitive.point_and_normal(&self.ray);
        self.hidden |= met.is_some_and(|(_, normal)| height(normal) > self.clearance);
    }

    #[inline(always)]
    fn settle(&mut self) {
        self.hidden = true;
    }

    #[inline(always)]
    fn is_over(&self) -> bool {
        self.hidden
    }
}
