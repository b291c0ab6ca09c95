// Motion and change of speckle at a surface point between two states of a scene, of any size: the
// law that `tem00_factor` of tem00-shading looks up by.
//
// Functions and structs only: no bindings, no entry points, no imports, no extensions; names that
// end in `_` are not for the caller.
//
// Vectors have the components right, up and towards the camera, in the axes of a camera that stands
// still: motions are relative to it. Lengths are in metres. A rotation is a unit quaternion x, y,
// z, w, (0, 0, 0, 1) for none.
//
// Validity: lengths from 1e-9 m to 1e9 m. No difference of near-equal numbers is formed: with the
// distance L to the pupil, the angle φ by which the light turns and the motion a, displacements in
// the pupil are off by about 4 ε (|a| + L φ), ε = 1.2e-7. Positions enter at second order only. γ
// is off by 1e-5 at worst. A cosine below 2⁻¹² counts as grazing.

/// Direction of the light at a point, as the part, the light and the camera move.
struct Tem00LightMotion {
    /// Unit vector to the source before; 0 where the light comes from no direction.
    to_source: vec3<f32>,
    /// The unit vector after, less that before.
    change: vec3<f32>,
}

/// Change of the speckle at a point.
struct Tem00SpeckleMotion {
    /// Image of the point before, in principal distances: slopes of the line of sight.
    image: vec2<f32>,
    /// Its motion.
    image_displacement: vec2<f32>,
    /// Motion of the speckle field across the pupil, in metres; 1e18 in both where it is
    /// decorrelated.
    pupil_displacement: vec2<f32>,
    /// 1/Z before and after, with the depth Z before the pupil plane, in 1/m.
    per_depth: vec2<f32>,
    /// Whether the point was in sight and is.
    seen: bool,
}

/// Returns by how much a rotation changes a vector, (R − 1) v: without cancellation where it is
/// small.
fn tem00_rotation_change(rotation: vec4<f32>, v: vec3<f32>) -> vec3<f32> {
    return 2.0 * cross(rotation.xyz, rotation.w * v + cross(rotation.xyz, v));
}

/// Returns the motion of the speckle of a surface point whose surroundings turn by `rotation` while
/// it moves by `motion`.
///
/// `to_pupil` leads from the point to the centre of the pupil, before; the normal, before, may be
/// of any length and to either side. The pattern is decorrelated where the point is out of sight,
/// before or after, seen edge-on, lit from its other side or from no direction.
fn tem00_speckle_motion(
    to_pupil: vec3<f32>,
    normal: vec3<f32>,
    motion: vec3<f32>,
    rotation: vec4<f32>,
    light: Tem00LightMotion,
) -> Tem00SpeckleMotion {
    let distance = length(to_pupil);
    let turn = tem00_turn_of_sight_(to_pupil / distance, normalize(normal), rotation, light);
    let depth = to_pupil.z - motion.z;
    let grazing = 0.000244140625 * distance;
    let image = to_pupil.xy / -to_pupil.z;
    var moved = Tem00SpeckleMotion(
        image,
        (motion.xy + image * motion.z) / depth,
        vec2(1e18),
        vec2(1.0 / to_pupil.z, 1.0 / depth),
        min(to_pupil.z, depth) > grazing,
    );
    // The field leaves along d + turn and meets the pupil at Π (a + L turn).
    let leaving = to_pupil + distance * turn.change;
    if moved.seen && turn.known && leaving.z > grazing {
        let shift = motion + distance * turn.change;
        moved.pupil_displacement = shift.xy - leaving.xy * (shift.z / leaving.z);
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

struct Tem00Turn_ {
    change: vec3<f32>,
    known: bool,
}

/// The change of the direction d in which the field leaves: the surface turns it with itself and
/// keeps the part along itself of the sum of both directions.
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

/// The overlap of two discs `shift` diameters apart, ε √ε S(ε) with ε = 1 − shift. The polynomial S
/// interpolates at seven Chebyshev nodes and is off by 2.6e-8 of itself.
fn tem00_disc_overlap_(shift: f32) -> f32 {
    let e = max(1.0 - shift, 0.0);
    let high = -0.00298959028 + e * (-0.0011628799 + e * (0.000234018973 - e * 0.00034074443));
    let series = 1.200421739 + e * (-0.180061752 + e * (-0.0161007661 + e * high));
    return min(e * sqrt(e) * series, 1.0);
}

/// The factor by which a shift along the axis, of at most one length, reduces the correlation at
/// the peak beside a shift of the pupil. It is analytic in s and x²: a polynomial at 12 × 12 points
/// of Chebyshev in 2 s − 1 and y = 2 x² − 1, off by 5e-6, without the terms below 4e-7.
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
