use glam::{DMat3, DVec2, DVec3};
use tem00_decorrelation::{CameraFrame, ImagingGeometry};

/// The sine of the smallest angle between two directions for which a common normal is computed: the
/// square root of the rounding unit.
const SMALLEST_SINE: f64 = 1.0 / 67_108_864.0;

/// The two angles, in radians, by which the paper relates the camera to the surface: `q1` about n2,
/// then `q2` about the new first axis.
///
/// ```text
/// b1 = ( cos q1,          0,      −sin q1         )
/// b2 = ( sin q1 sin q2,   cos q2,  cos q1 sin q2  )      in (n1, n2, n3)
/// b3 = ( sin q1 cos q2,  −sin q2,  cos q1 cos q2  )
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EulerAngles {
    /// Rotation about the second axis of the surface, in radians.
    pub q1: f64,
    /// Rotation about the first axis of the intermediate system, in radians.
    pub q2: f64,
}

impl EulerAngles {
    /// Returns the angles between a surface and a camera, and the axes n1, n2, n3 of the surface as
    /// the columns of a matrix, so that its transpose takes world vectors to surface coordinates.
    ///
    /// Two angles cannot express every rotation. The axes in the surface are free, however, and
    /// there is a choice for which two suffice: n2 perpendicular to both the normal and b1, on the
    /// side that keeps q1 within ±90°.
    ///
    /// Returns `None` if the normal is zero or not finite.
    pub fn between(camera: &CameraFrame, normal: DVec3) -> Option<(DMat3, Self)> {
        let n3 = normal.try_normalize()?;
        let across = n3.cross(camera.right());
        let n2 = if across.length() > SMALLEST_SINE {
            across.normalize()
        } else {
            camera.up()
        };
        let n1 = n2.cross(n3);
        let (b1, b2, b3) = (camera.right(), camera.up(), camera.towards_camera());
        let angles = Self {
            q1: (-b1.dot(n3)).atan2(b1.dot(n1)),
            q2: (-b3.dot(n2)).atan2(b2.dot(n2)),
        };
        Some((DMat3::from_cols(n1, n2, n3), angles))
    }

    /// Returns the axes b1, b2, b3 of the camera in surface coordinates as the columns of a matrix.
    pub fn camera_axes(&self) -> DMat3 {
        let (s1, c1) = self.q1.sin_cos();
        let (s2, c2) = self.q2.sin_cos();
        DMat3::from_cols(
            DVec3::new(c1, 0.0, -s1),
            DVec3::new(s1 * s2, c2, c1 * s2),
            DVec3::new(s1 * c2, -s2, c1 * c2),
        )
    }
}

/// Position of the light source in the description of the paper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Emitter {
    /// Unit vector from the surface to the laser emitter, in surface coordinates.
    pub direction: DVec3,
    /// Distance `d_SL` from the surface to the emitter, in metres; infinite for collimated light.
    ///
    /// The printed pair is correct if this is the radius of the *wavefront*. For a Gaussian beam
    /// distance and radius may differ by any factor and in sign, and a laser line has two radii.
    pub distance: f64,
}

/// Returns the displacement of the speckle on the sensor, in metres, for the object displacement
/// `a`, in metres and surface coordinates: eq. (5) as printed.
///
/// ```text
///           ⎛ cos q1         0        sin q1        ⎞
/// a_I = −m  ⎜                                       ⎟ a
///           ⎝ sin q1 sin q2  cos q2   cos q1 sin q2 ⎠
/// ```
///
/// The rows of a rotation are orthogonal; the printed rows are not, unless q1 or q2 is zero: the
/// entry at the top right must be −sin q1. The error is `2 m |a_z sin q1|` along b1. At q1 = 30°
/// the displacement for a motion along the normal has the wrong direction.
pub fn image_displacement(magnification: f64, angles: EulerAngles, a: DVec3) -> DVec2 {
    let (s1, c1) = angles.q1.sin_cos();
    let (s2, c2) = angles.q2.sin_cos();
    let first = DVec3::new(c1, 0.0, s1);
    let second = DVec3::new(s1 * s2, c2, c1 * s2);
    DVec2::new(first.dot(a), second.dot(a)) * -magnification
}

/// Returns the displacement `a_P^S` of the speckle across the pupil, in metres, for the object
/// displacement `a`, in metres and surface coordinates, at the distance `surface_to_pupil`, in
/// metres: the pair of §6.4 as printed, after Sjödahl 1995.
///
/// It is correct where the line of sight is the optical axis and the emitter's distance is the
/// radius of a spherical wavefront; the test suite compares it with the general law. Off the axis
/// it uses b3 as the direction to the pupil, and neglects that a motion along b3 then has a lateral
/// component. Returns `None` where the printed fractions have no value, at grazing view.
pub fn pupil_displacement(
    angles: EulerAngles,
    emitter: Emitter,
    surface_to_pupil: f64,
    a: DVec3,
) -> Option<DVec2> {
    let (s1, c1) = angles.q1.sin_cos();
    let (s2, c2) = angles.q2.sin_cos();
    let ls = emitter.direction;
    let l = angles.camera_axes().z_axis;
    let (d_sl, d_sp) = (emitter.distance, surface_to_pupil);
    // The two brackets of the pair; the second occurs in both components.
    let first = a.x * ((ls.x * ls.x - 1.0) / d_sl + (l.x * l.x - 1.0) / d_sp)
        + a.y * (ls.x * ls.y / d_sl + l.x * l.y / d_sp)
        + a.z * (ls.x * ls.z / d_sl + l.x * l.z / d_sp);
    let second = a.x * (ls.x * ls.y / d_sl + l.x * l.y / d_sp)
        + a.y * ((ls.y * ls.y - 1.0) / d_sl + (l.y * l.y - 1.0) / d_sp)
        + a.z * (ls.y * ls.z / d_sl + l.y * l.z / d_sp);
    let displacement = DVec2::new(
        -d_sp / c1 * first + d_sp * (s1 * s2) / (c1 * c2) * second,
        -d_sp / c2 * second,
    );
    displacement.is_finite().then_some(displacement)
}

/// Returns the sum `a_P^C + a_P^S` of a camera motion in the pupil plane and the displacement of
/// the speckle there, both in metres, as §6.4 combines them.
///
/// If both are displacements in one frame, a camera that moves *with* the speckle must see no
/// change: the sign of the camera motion must be negative.
pub fn relative_pupil_displacement(camera: DVec2, surface: DVec2) -> DVec2 {
    camera + surface
}

/// Returns the axial displacement `d_z⁰ = λ [2 (1 + 1/m) F]²`, in metres, at which §6.4 considers
/// the pattern decorrelated.
///
/// By the formula of Li and Chiang the correlation at this displacement is `(2/π)² = 0.405`; the
/// first zero lies at twice this length. `(1 + 1/m) F` equals `L/D` for a thin lens only; in
/// general `L/D` is `(1/m_p + 1/m) F`, with the pupil magnification `m_p`.
pub fn axial_decorrelation_length(geometry: &ImagingGeometry) -> f64 {
    let object_side = 2.0 * (1.0 + 1.0 / geometry.magnification()) * geometry.f_number();
    geometry.wavelength() * object_side * object_side
}

/// Returns the slice coordinate of §6.4 in a stack of 2 · `half_period` slices, without wrapping.
///
/// ```text
/// u = (|a_P| / D + d_z / d_z⁰) M
/// ```
///
/// `pupil_displacement` and `axial_displacement` are in metres. On a circular stack the error of γ
/// is up to 0.195 for motion in the plane (at `|a_P|` = 0.273 D) and up to 0.790 for motion along
/// the axis (at `d_z` = 0.431 `d_z⁰`). Since `d_z` has a sign, one motion can undo the
/// decorrelation by the other, and since u is not limited to M, large motions bring the old pattern
/// back.
pub fn slice_coordinate(
    geometry: &ImagingGeometry,
    pupil_displacement: DVec2,
    axial_displacement: f64,
    half_period: usize,
) -> f64 {
    let in_plane = pupil_displacement.length() / geometry.pupil_diameter();
    let axial = axial_displacement / axial_decorrelation_length(geometry);
    (in_plane + axial) * half_period as f64
}

/// Returns the pattern coordinate of §6.3, in pattern samples, without wrapping.
///
/// ```text
/// c = (h_p / h) a_I + (h_p / h_I) t
/// ```
///
/// The arguments are as for [`ImagingGeometry::pattern_coordinate`]. With `pixel` and
/// `image_displacement` in the same axes the pattern moves by `−a_I`. The sign is correct only if
/// `image_displacement` is measured on the inverted sensor and `pixel` is a position on an upright
/// screen.
pub fn pattern_coordinate(
    geometry: &ImagingGeometry,
    pixel: DVec2,
    image_displacement: DVec2,
    pattern_speckle_size: f64,
) -> DVec2 {
    let samples_per_metre = pattern_speckle_size / geometry.speckle_size();
    let samples_per_pixel = pattern_speckle_size / geometry.speckle_size_in_pixels();
    image_displacement * samples_per_metre + pixel * samples_per_pixel
}

#[cfg(test)]
mod tests;
