// Motion and change of speckle at a surface point, for a renderer's own kernels.
//
// Functions and structs only: no bindings, no entry points, no imports, no extensions. Every name
// begins with `tem00_` or `Tem00`; those that end in `_` are not for the caller.
//
// The law is that between two states of a scene, of any size: `SpeckleMotion::between` of the crate,
// with the correlation that belongs to the displacement that it returns. The camera stands still:
// motions are relative to it, so for a camera that moves by c give the motion a − c.
//
// A part turns about a pivot and slides, under a point source. A kernel that sees its point `seen`, of
// the normal `n`, takes both back to where they were, and asks for the motion from there:
//
//     let turned = seen - translation - pivot;
//     let backwards = vec4(-rotation.xyz, rotation.w);
//     let change = tem00_rotation_change(backwards, turned);
//     let p = pivot + turned + change;
//     let normal = n + tem00_rotation_change(backwards, n);
//     let motion = translation - change;
//     let light = tem00_point_source(source - p, motion);
//     let moved = tem00_speckle_motion(imaging, pupil_centre - p, normal, motion, rotation, light);
//     let u = tem00_slice_coordinate(moved.correlation, entries);
//     // … the intensity of the stack at moved.pattern_coordinate, u
//
// The host defines one function, a table of the stack's overlaps, `SlicePath::overlaps`:
//
//     fn tem00_slice_overlaps(slice: u32) -> vec2<f32> { return table[slice]; }
//
// Lengths are in metres, vectors in world coordinates. A rotation is a unit quaternion x, y, z, w,
// (0, 0, 0, 1) for none.
//
// Validity: lengths from 1e-9 m to 1e9 m. No difference of near-equal numbers is formed: with the
// distance L to the pupil, the angle φ by which the light turns and the motion a, displacements in the
// pupil are off by about 4 ε (|a| + L φ), ε = 1.2e-7, which is 7e-8 of the pupil diameter in rms and 5e-7
// at worst while the speckle stays in the pupil, however far away that is; γ is off by 1e-5 at worst. Positions enter at second order only.
// Pattern coordinates are off by 4 ε of the principal distance in samples. A cosine below 2⁻¹² counts as
// grazing.

/// Camera and pattern that all points share: `MotionField::to_rows` in the crate.
struct Tem00Imaging {
    /// Unit vector to the right in the pupil plane.
    right: vec3<f32>,
    /// Length of the image of a unit tangent, in metres: positive if the image is upright.
    signed_principal_distance: f32,
    /// Unit vector up in the pupil plane.
    up: vec3<f32>,
    /// Reciprocal distance of the surface in focus from the pupil, in 1/m.
    per_surface_to_pupil: f32,
    /// Unit vector along the optical axis, from the scene towards the camera.
    towards_camera: vec3<f32>,
    /// Reciprocal diameter of the pupil, in 1/m.
    per_pupil_diameter: f32,
    /// Reciprocal axial decorrelation length at a depth of 1 m, in 1/m.
    per_axial_length: f32,
    /// Samples of the pattern per metre on the sensor.
    samples_per_metre: f32,
    /// Unused, 0.
    pad: vec2<f32>,
}

/// Direction of the light at a point, as the part and the camera move.
struct Tem00LightMotion {
    /// Unit vector to the source before; 0 where the light comes from no direction.
    to_source: vec3<f32>,
    /// The unit vector after, less that before.
    change: vec3<f32>,
}

/// Change of the speckle at a point.
struct Tem00SpeckleMotion {
    /// Motion of the speckle in the image to the right and up, in metres on the sensor.
    speckle_displacement: vec2<f32>,
    /// Motion of the speckle field across the pupil, in metres; 1e18 in both where it is decorrelated.
    pupil_displacement: vec2<f32>,
    /// Where to look the pattern up, in samples from the optical axis, not wrapped: at the image that the
    /// point had before, less what out of focus the speckle moves beside it.
    pattern_coordinate: vec2<f32>,
    /// Correlation γ of the intensity with the pattern before, in [0, 1].
    correlation: f32,
}

/// Collimated light from the direction `to_source`, a unit vector.
fn tem00_collimated(to_source: vec3<f32>) -> Tem00LightMotion {
    return Tem00LightMotion(to_source, vec3(0.0));
}

/// Light from a point, `to_source` away, of which the surface moves away by `motion`.
fn tem00_point_source(to_source: vec3<f32>, motion: vec3<f32>) -> Tem00LightMotion {
    let since = to_source - motion;
    let lengths = vec2(length(to_source), length(since));
    if lengths.x == 0.0 || lengths.y == 0.0 {
        return Tem00LightMotion();
    }
    let direction = to_source / lengths.x;
    let shorter = dot(motion, to_source + since) / (lengths.x + lengths.y);
    return Tem00LightMotion(direction, (direction * shorter - motion) / lengths.y);
}

/// A wave from the direction `to_source`, a unit vector, with the symmetric curvature tensor K, in
/// 1/m and with K `to_source` = 0, through which the surface moves by `motion`.
///
/// The change is that of l − K (I − ζ K)⁻¹ a, ζ = l·a, of unit length. Of the two curvatures K has their
/// sum and product.
fn tem00_wavefront(
    to_source: vec3<f32>,
    curvature: mat3x3<f32>,
    motion: vec3<f32>,
) -> Tem00LightMotion {
    let along = dot(to_source, motion);
    let across = motion - to_source * along;
    let diagonal = vec3(curvature[0].x, curvature[1].y, curvature[2].z);
    let mixed = vec3(curvature[1].z, curvature[2].x, curvature[0].y);
    let sum = diagonal.x + diagonal.y + diagonal.z;
    let product = dot(diagonal, diagonal.yzx) - dot(mixed, mixed);
    let determinant = 1.0 - along * (sum - along * product);
    if determinant == 0.0 {
        return Tem00LightMotion();
    }
    let oblique = (curvature * across - across * (along * product)) / determinant;
    let slope = oblique - to_source * dot(to_source, oblique);
    let squared = dot(slope, slope);
    let sec = sqrt(1.0 + squared);
    return Tem00LightMotion(to_source, -(slope + to_source * (squared / (1.0 + sec))) / sec);
}

/// Returns by how much a rotation changes a vector, (R − 1) v: without cancellation where it is small.
fn tem00_rotation_change(rotation: vec4<f32>, v: vec3<f32>) -> vec3<f32> {
    return 2.0 * cross(rotation.xyz, rotation.w * v + cross(rotation.xyz, v));
}

/// Returns the motion of the speckle of a surface point whose surroundings turn by `rotation` while it
/// moves by `motion`.
///
/// `to_pupil` leads from the point to the centre of the pupil, before; the normal, before, may be of any
/// length and to either side. Where the point is out of sight, before or after, seen edge-on, lit from
/// its other side or from no direction, the pattern is decorrelated: γ = 0.
fn tem00_speckle_motion(
    imaging: Tem00Imaging,
    to_pupil: vec3<f32>,
    normal: vec3<f32>,
    motion: vec3<f32>,
    rotation: vec4<f32>,
    light: Tem00LightMotion,
) -> Tem00SpeckleMotion {
    let distance = length(to_pupil);
    let turn = tem00_turn_of_sight_(to_pupil / distance, normalize(normal), rotation, light);
    let sight = tem00_in_camera_(imaging, to_pupil);
    let step = tem00_in_camera_(imaging, motion);
    let depth = sight.z - step.z;
    let grazing = 0.000244140625 * distance;
    let c = imaging.signed_principal_distance;

    // The image of the point before, and its motion.
    var moved = Tem00SpeckleMotion(vec2(0.0), vec2(1e18), vec2(0.0), 0.0);
    if sight.z > grazing {
        let before = sight.xy / -sight.z;
        moved.pattern_coordinate = (c * imaging.samples_per_metre) * before;
        if depth > grazing {
            moved.speckle_displacement = (c / depth) * (step.xy + before * step.z);
        }
    }
    // The field leaves along d + turn and meets the pupil at Π (a + L turn).
    let leaving = sight + distance * tem00_in_camera_(imaging, turn.change);
    if min(sight.z, depth) > grazing && turn.known && leaving.z > grazing {
        let shift = step + distance * tem00_in_camera_(imaging, turn.change);
        let pupil = shift.xy - leaving.xy * (shift.z / leaving.z);
        let defocus = 0.5 * (1.0 / sight.z + 1.0 / depth) - imaging.per_surface_to_pupil;
        let beside = (-c * defocus) * pupil;
        moved.speckle_displacement += beside;
        moved.pattern_coordinate -= imaging.samples_per_metre * beside;
        moved.pupil_displacement = pupil;
        moved.correlation = tem00_correlation(
            length(pupil) * imaging.per_pupil_diameter,
            step.z / (sight.z * depth) * imaging.per_axial_length,
        );
    }
    return moved;
}

/// Returns the correlation of the intensity left by a shift in the pupil, in its diameters, and one
/// along the axis, in axial decorrelation lengths, at the displacement of the peak: within 1e-5 of
/// `CorrelationLaw::AtPeak`. From one length on the speckle is new, and its revivals are left out.
fn tem00_correlation(pupil_shift: f32, axial_shift: f32) -> f32 {
    let overlap = tem00_disc_overlap_(pupil_shift);
    // A point at rest keeps all: below, less is lost than the polynomial is off by.
    if abs(axial_shift) < 0.001 {
        return overlap * overlap;
    }
    if abs(axial_shift) >= 1.0 {
        return 0.0;
    }
    return overlap * overlap * tem00_axial_loss_(pupil_shift, axial_shift);
}

/// Returns the coordinate u of a stack where γ with its first slice has fallen to `correlation`, from
/// the number of entries that `tem00_slice_overlaps` has; 0 for a still stack, which has one.
///
/// An entry is the overlap of its slice with the first and that with the next. Between two slices the
/// blend of both has γ, exactly. Near γ = 1, u is as inexact as γ makes it: u² is linear in 1 − γ.
fn tem00_slice_coordinate(correlation: f32, entries: u32) -> f32 {
    let overlap = sqrt(clamp(correlation, 0.0, 1.0));
    var here = tem00_slice_overlaps(0u);
    if overlap >= 1.0 {
        return 0.0;
    }
    for (var slice = 1u; slice < entries; slice++) {
        let next = tem00_slice_overlaps(slice);
        if next.x <= overlap {
            return f32(slice - 1u) + tem00_blend_fraction_(here.x, next.x, here.y, overlap);
        }
        here = next;
    }
    return f32(entries - 1u);
}

/// The fraction f of the way between two slices where
/// [(1 − f) a + f b] / √(1 − 2 f (1 − f) (1 − ρ)) has fallen to g.
fn tem00_blend_fraction_(a: f32, b: f32, between: f32, g: f32) -> f32 {
    let step = b - a;
    let k = 1.0 - between;
    let half_slope = a * step + k * g * g;
    let inner = step * step + 2.0 * k * a * b - k * (1.0 + between) * g * g;
    let root = g * sqrt(max(inner, 0.0));
    // Of the two forms of the solution, the one whose terms do not cancel.
    if half_slope > 0.0 {
        return clamp((root + half_slope) / (2.0 * k * g * g - step * step), 0.0, 1.0);
    }
    return clamp((a - g) * (a + g) / max(root - half_slope, 1e-30), 0.0, 1.0);
}

struct Tem00Turn_ {
    change: vec3<f32>,
    known: bool,
}

/// The change of the direction d in which the field leaves: the surface turns it with itself and keeps
/// the part along itself of the sum of both directions.
fn tem00_turn_of_sight_(
    d: vec3<f32>,
    n: vec3<f32>,
    rotation: vec4<f32>,
    light: Tem00LightMotion,
) -> Tem00Turn_ {
    // The light as the surface sees it: Rᵀ l' − l = Rᵀ (l' − l − (R − 1) l).
    let apart = light.change - tem00_rotation_change(rotation, light.to_source);
    let seen = apart + tem00_rotation_change(vec4(-rotation.xyz, rotation.w), apart);
    let across = seen - n * dot(n, seen);
    let side = dot(n, d);
    let gain = dot(across, 2.0 * d - across);
    let rest = side * side + gain;
    let lit_before = dot(n, light.to_source);
    let lit_side = lit_before * (lit_before + dot(n, seen));
    let lit = dot(light.to_source, light.to_source) > 0.0 && lit_side >= 0.0;
    if !(rest > 0.0 && abs(side) > 0.000244140625 && lit) {
        return Tem00Turn_(vec3(0.0), false);
    }
    let along = gain / (side + sign(side) * sqrt(rest));
    let turned = n * along - across;
    return Tem00Turn_(turned + tem00_rotation_change(rotation, d + turned), true);
}

/// The components of a vector to the right, up and towards the camera.
fn tem00_in_camera_(imaging: Tem00Imaging, v: vec3<f32>) -> vec3<f32> {
    return vec3(dot(v, imaging.right), dot(v, imaging.up), dot(v, imaging.towards_camera));
}

/// The overlap of two discs `shift` diameters apart, ε √ε S(ε) with ε = 1 − shift. The polynomial S
/// interpolates at seven Chebyshev nodes and is off by 2.6e-8 of itself.
fn tem00_disc_overlap_(shift: f32) -> f32 {
    let e = max(1.0 - shift, 0.0);
    let high = -0.00298959028 + e * (-0.0011628799 + e * (0.000234018973 - e * 0.00034074443));
    let series = 1.200421739 + e * (-0.180061752 + e * (-0.0161007661 + e * high));
    return min(e * sqrt(e) * series, 1.0);
}

/// The factor by which a shift along the axis, of at most one length, reduces the correlation at the
/// peak beside a shift of the pupil. It is analytic in s and x²: a polynomial at 12 × 12 points of
/// Chebyshev in 2 s − 1 and y = 2 x² − 1, off by 5e-6, without the terms below 4e-7.
fn tem00_axial_loss_(pupil_shift: f32, axial_shift: f32) -> f32 {
    let s = 2.0 * min(pupil_shift, 1.0) - 1.0;
    let y = 2.0 * axial_shift * axial_shift - 1.0;
    let h0 = 0.0012024302 + y * (-8.8752116e-05 + y * 9.3782137e-07);
    let r0 = 0.62068749 + y * (-0.2919744 + y * (0.074432172 + y * (-0.011613575 + y * h0)));
    let h1 = -0.0056056506 + y * (0.00049462001 + y * -9.0709625e-05);
    let r1 = 0.45676002 + y * (0.25300381 + y * (-0.15784718 + y * (0.039717246 + y * h1)));
    let h2 = 0.0089158677 + y * (-0.0011505843 + y * 0.00021562462);
    let r2 = -0.0042983028 + y * (0.092223518 + y * (0.049554646 + y * (-0.036695935 + y * h2)));
    let h3 = -0.0044317078 + y * (0.0015897731 + y * 0.00024874261);
    let r3 = 0.081860915 + y * (0.069602184 + y * (-0.0068180789 + y * (-0.00030982899 + y * h3)));
    let h4 = -0.0012839859 + y * (-0.00044097457 + y * -0.00044544908);
    let r4 = -0.047809243 + y * (0.076287746 + y * (0.11326177 + y * (-0.012049094 + y * h4)));
    let h5 = -0.0020582564 + y * (-0.0020773748 + y * -0.00052538409);
    let r5 = -0.11246607 + y * (-0.18040673 + y * (-0.022781922 + y * (0.044537619 + y * h5)));
    let h6 = 0.0084281135 + y * (0.00061834819 + y * 0.00060291798);
    let r6 = -0.006757109 + y * (-0.048433729 + y * (-0.069533713 + y * (-0.019626798 + y * h6)));
    let h7 = -0.0069309566 + y * 0.003222883;
    let r7 = 0.0024638339 + y * (0.015453163 + y * (0.016230771 + y * (-0.006715273 + y * h7)));
    let h8 = 0.0017545421 + y * -0.0021717304;
    let r8 = 0.0013149447 + y * (-0.0062658317 + y * (-0.0089969635 + y * (0.0026958757 + y * h8)));
    let r9 = 0.0085233906 + y * (0.018415019 + y * (0.0069222022 + y * -0.0030895129));
    let r10 = 0.0010120218 + y * (0.0055337124 + y * (0.0077429349 + y * 0.0031543532));
    let r11 = -0.001291819 + y * (-0.0034385144 + y * -0.0021619061);
    let high = r6 + s * (r7 + s * (r8 + s * (r9 + s * (r10 + s * r11))));
    return clamp(r0 + s * (r1 + s * (r2 + s * (r3 + s * (r4 + s * (r5 + s * high))))), 0.0, 1.0);
}
