use glam::DVec3;

/// Points of rough surfaces with their motion and light, as one slice of numbers per component.
///
/// All slices are of equal length. Vectors are in world coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldPoints<'a> {
    /// Positions x, y, z in the reference state, in metres.
    pub position: [&'a [f64]; 3],
    /// Surface normals x, y, z of any length, to either side.
    pub normal: [&'a [f64]; 3],
    /// Translations x, y, z of the surface since the reference state, in metres.
    pub motion: [&'a [f64]; 3],
    /// The light on the points.
    pub light: FieldLight<'a>,
}

/// The light on the points of a field, by the curvature of its wavefront there.
///
/// Its direction drops out: only the turn of the direction by a motion counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FieldLight<'a> {
    /// Plane waves.
    Collimated,
    /// Spherical waves that diverge from a point in world coordinates, in metres.
    PointSource(DVec3),
    /// Waves of any curvature tensor K, in 1/m and world coordinates, as slices of its components
    /// xx, xy, xz, yy, yz, zz: see [`Wavefront::curvature`](crate::Wavefront::curvature).
    Curvature([&'a [f64]; 6]),
}

/// Destinations of the results of a [`MotionField`](crate::MotionField), all slices of equal length.
#[derive(Debug, PartialEq)]
pub struct FieldSlices<'a> {
    /// Motion of the speckle in the image along b1 and b2, in metres on the sensor: that of the image
    /// of the surface and, out of focus, what the pupil displacement adds.
    pub speckle_displacement: [&'a mut [f64]; 2],
    /// Motion of the speckle field across the pupil along b1 and b2, in metres; infinite where the
    /// pattern counts as decorrelated because the speckle left the pupil.
    pub pupil_displacement: [&'a mut [f64]; 2],
    /// Correlation of the intensity with the old pattern, in [0, 1]:
    /// [`correlation`](crate::correlation). A stack looks it up at the coordinate where its own path has
    /// that correlation to the first slice.
    pub correlation: &'a mut [f64],
    /// Position at which to look the pattern up, in pattern samples from the optical axis and not
    /// wrapped: the image of the point in the reference state, less what its speckle moves beside the
    /// image out of focus. 0 for a point that the camera cannot see.
    pub pattern_coordinate: [&'a mut [f64]; 2],
}

/// Slices that a point is read from: position, normal, motion, curvature.
pub(super) const INPUTS: usize = 15;
/// Slices that a result is written to, in the order of [`FieldSlices`].
pub(super) const OUTPUTS: usize = 7;

impl<'a> FieldPoints<'a> {
    /// Returns the slices in order; those of the curvature are empty where the light needs none.
    pub(super) fn columns(&self) -> [&'a [f64]; INPUTS] {
        let [px, py, pz] = self.position;
        let [nx, ny, nz] = self.normal;
        let [ax, ay, az] = self.motion;
        let [xx, xy, xz, yy, yz, zz] = match self.light {
            FieldLight::Curvature(tensor) => tensor,
            FieldLight::Collimated | FieldLight::PointSource(_) => [[].as_slice(); 6],
        };
        [px, py, pz, nx, ny, nz, ax, ay, az, xx, xy, xz, yy, yz, zz]
    }

    /// Returns how many of the [`columns`](Self::columns) there are.
    pub(super) const fn column_count(&self) -> usize {
        match self.light {
            FieldLight::Curvature(_) => INPUTS,
            FieldLight::Collimated | FieldLight::PointSource(_) => INPUTS - 6,
        }
    }
}

impl<'a> FieldSlices<'a> {
    /// Returns the slices in order.
    pub(super) fn into_columns(self) -> [&'a mut [f64]; OUTPUTS] {
        let [speckle_x, speckle_y] = self.speckle_displacement;
        let [pupil_x, pupil_y] = self.pupil_displacement;
        let [pattern_x, pattern_y] = self.pattern_coordinate;
        [
            speckle_x,
            speckle_y,
            pupil_x,
            pupil_y,
            self.correlation,
            pattern_x,
            pattern_y,
        ]
    }
}
