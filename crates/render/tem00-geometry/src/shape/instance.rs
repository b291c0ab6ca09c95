use std::sync::{Arc, OnceLock};

use glam::{DMat3, DVec3};
use tem00_decorrelation::RigidMotion;

use crate::{Refusal, TriangleMesh, hierarchy::MeshHierarchy, mesh};

/// A placed mesh: scaled, turned and moved.
///
/// ```text
/// x = s R p + t        p: point of the mesh
/// ```
///
/// An instance that is placed or moved anew shares the mesh, and with it the hierarchy that finds
/// where rays meet it.
///
/// # Examples
///
/// A mesh in millimetres, seen in metres from behind:
///
/// ```
/// use std::{f64::consts::PI, sync::Arc};
///
/// use glam::DVec3;
/// use tem00_decorrelation::RigidMotion;
/// use tem00_geometry::{MeshInstance, TriangleMesh};
///
/// let corners = vec![DVec3::ZERO, 20.0 * DVec3::X, 20.0 * DVec3::Y];
/// let mesh = Arc::new(TriangleMesh::new(corners, vec![[0, 1, 2]])?);
/// let turn = RigidMotion::about(DVec3::ZERO, DVec3::Y, PI)?;
/// let instance = MeshInstance::new(mesh).placed(1e-3, &turn)?;
///
/// assert!(instance.point(20.0 * DVec3::X).abs_diff_eq(-0.02 * DVec3::X, 1e-17));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct MeshInstance {
    mesh: Arc<TriangleMesh>,
    /// Built when a ray first asks for it.
    hierarchy: Arc<OnceLock<MeshHierarchy>>,
    scale: f64,
    rotation: DMat3,
    translation: DVec3,
}

impl PartialEq for MeshInstance {
    fn eq(&self, other: &Self) -> bool {
        self.mesh == other.mesh
            && self.scale == other.scale
            && self.rotation == other.rotation
            && self.translation == other.translation
    }
}

impl MeshInstance {
    /// Places a mesh at the coordinates of its vertices.
    pub fn new(mesh: Arc<TriangleMesh>) -> Self {
        Self {
            mesh,
            hierarchy: Arc::default(),
            scale: 1.0,
            rotation: DMat3::IDENTITY,
            translation: DVec3::ZERO,
        }
    }

    /// Returns the instance scaled about the origin by a dimensionless factor and then moved.
    ///
    /// # Errors
    ///
    /// Returns an error if the scale is not positive and finite.
    pub fn placed(&self, scale: f64, motion: &RigidMotion) -> Result<Self, Refusal> {
        if !(scale > 0.0 && scale.is_finite()) {
            return Err(Refusal::new("scale", scale, "positive and finite"));
        }
        Ok(Self {
            scale: scale * self.scale,
            translation: scale * self.translation,
            ..self.clone()
        }
        .moved(motion))
    }

    /// Returns the instance after a rigid motion.
    #[must_use]
    pub fn moved(&self, motion: &RigidMotion) -> Self {
        Self {
            rotation: motion.rotation() * self.rotation,
            translation: motion.point(self.translation),
            ..self.clone()
        }
    }

    /// Returns the mesh at the coordinates of its vertices.
    pub const fn mesh(&self) -> &Arc<TriangleMesh> {
        &self.mesh
    }

    /// Returns the position of a point of the mesh in the world, in metres.
    #[inline]
    pub fn point(&self, point: DVec3) -> DVec3 {
        self.rotation * (self.scale * point) + self.translation
    }

    /// Returns a direction of the mesh in the world; its length does not change.
    pub fn direction(&self, direction: DVec3) -> DVec3 {
        self.rotation * direction
    }

    /// Returns the hierarchy that finds where rays meet the triangles.
    pub(crate) fn hierarchy(&self) -> &MeshHierarchy {
        if let Some(hierarchy) = self.hierarchy.get() {
            return hierarchy;
        }
        // This is not done inside `get_or_init`: a thread that waits there for others to finish
        // their part may take up work that asks for the same hierarchy, and would wait for itself.
        let corners = |triangle| self.mesh.corners(triangle);
        let hierarchy = MeshHierarchy::build(self.mesh.triangles().len(), corners);
        self.hierarchy.get_or_init(|| hierarchy)
    }

    /// Returns the corners of a triangle, in metres.
    #[inline(always)]
    pub(crate) fn corners(&self, triangle: usize) -> [DVec3; 3] {
        let [a, b, c] = self.mesh.corners(triangle);
        [self.point(a), self.point(b), self.point(c)]
    }

    /// Returns the normal with which a triangle scatters light where its corners have `weights`,
    /// given its own normal.
    pub(crate) fn shading_normal(&self, triangle: usize, weights: DVec3, normal: DVec3) -> DVec3 {
        let interpolated = self.mesh.interpolated_normal(triangle, weights);
        let interpolated =
            interpolated.and_then(|interpolated| self.direction(interpolated).try_normalize());
        mesh::shading_normal(normal, interpolated)
    }

    /// Returns the rotation R from the mesh to the world.
    pub(crate) const fn rotation(&self) -> DMat3 {
        self.rotation
    }

    /// Returns the factor s from lengths of the mesh to metres.
    pub const fn scale(&self) -> f64 {
        self.scale
    }

    /// Returns the box around the placed box of the mesh.
    pub(crate) fn bounds(&self) -> (DVec3, DVec3) {
        let (low, high) = self.mesh.bounds();
        (0..8)
            .map(|corner| {
                let pick = |axis: usize| if corner >> axis & 1 == 0 { low } else { high }[axis];
                self.point(DVec3::new(pick(0), pick(1), pick(2)))
            })
            .fold(
                (DVec3::INFINITY, DVec3::NEG_INFINITY),
                |(low, high), corner| (low.min(corner), high.max(corner)),
            )
    }
}

impl From<TriangleMesh> for MeshInstance {
    fn from(mesh: TriangleMesh) -> Self {
        Self::new(Arc::new(mesh))
    }
}

#[cfg(test)]
mod tests {
    use core::f64::consts::FRAC_PI_2;

    use super::*;

    fn triangle() -> MeshInstance {
        let corners = vec![DVec3::ZERO, DVec3::X, 2.0 * DVec3::Y];
        TriangleMesh::new(corners, vec![[0, 1, 2]]).unwrap().into()
    }

    #[test]
    fn placements_follow_each_other() {
        let turn = RigidMotion::about(DVec3::X, DVec3::Z, FRAC_PI_2).unwrap();
        let shift = RigidMotion::along(DVec3::new(0.5, 0.0, 0.25)).unwrap();
        let once = triangle().placed(0.5, &turn).unwrap();
        let twice = once.placed(4.0, &shift).unwrap();
        // (0, 2, 0) halves to (0, 1, 0), which turns about x = 1 to (0, −1, 0).
        for (placed, expected) in [(once, -DVec3::Y), (twice, DVec3::new(0.5, -4.0, 0.25))] {
            let point = placed.point(2.0 * DVec3::Y);
            assert!(point.abs_diff_eq(expected, 2e-15), "{point}");
        }
    }

    #[test]
    fn bounds_hold_every_corner_and_are_tight_where_nothing_turns() {
        let bounds = (DVec3::ZERO, DVec3::new(1.0, 2.0, 0.0));
        assert_eq!(triangle().bounds(), bounds, "as it is");
        let turn = RigidMotion::about(DVec3::ONE, DVec3::new(1.0, 2.0, 3.0), 1.0).unwrap();
        let placed = triangle().placed(3.0, &turn).unwrap();
        let (low, high) = placed.bounds();
        for vertex in placed.mesh().vertices() {
            let point = placed.point(*vertex);
            // The corners of the box are rounded as the vertices are.
            let slack = 4e-15;
            let inside = (point - low).min(high - point).min_element();
            assert!(inside > -slack, "{point} beyond {low}, {high}");
        }
    }

    #[test]
    fn impossible_scales_are_refused() {
        for scale in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let result = triangle().placed(scale, &RigidMotion::IDENTITY);
            assert_eq!(result.unwrap_err().parameter, "scale", "{scale}");
        }
    }
}
