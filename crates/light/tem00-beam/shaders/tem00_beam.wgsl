// Laser spots and laser lines in closed form, for a renderer's own kernels.
//
// Functions and structs only: no bindings, no entry points, no imports, no extensions. Every name
// begins with `tem00_` or `Tem00`; those that end in `_` are not for the caller.
//
// The structs have the layout of the Rust structs of the same names in `f32`, byte for byte, so
// that a placed light may be copied into a uniform or a storage buffer as it is. Points and vectors
// are in world coordinates; lengths share one unit, metres unless you use another throughout.
//
// A surface of normal n at p reflects  f · |n·wi| · V · e_perp, with
//
//     let event = tem00_spot_next_event(light, p);
//
// Nothing arrives where `event.e_perp` is 0: behind the aperture and beyond the cut-off.
//
// Validity: lengths up to 1e9 units. The relative error of the irradiance is about
// 4 ε |p − origin| / w, ε = 1.2e-7, from the rounding of the coordinates, and beyond that the error
// of the device's own exp, sqrt, division and atan, for which WGSL sets wide limits.

/// Squared beam radius along one principal axis: w²(z) = w0_sq + theta_sq (z − z0)².
struct Tem00Axis {
    /// Squared waist radius, in m².
    w0_sq: f32,
    /// Squared divergence half-angle, in rad².
    theta_sq: f32,
    /// Position of the waist, in metres, on the coordinate the light says.
    z0: f32,
    /// Unused, 0.
    pad: f32,
}

/// A Gaussian beam, circular or elliptic, with its waists at z = x.z0 and z = y.z0.
struct Tem00SpotLight {
    /// Centre of the aperture, in metres.
    origin: vec3<f32>,
    /// Power, in watts.
    power: f32,
    /// Unit vector of the local x axis.
    ex: vec3<f32>,
    /// Distance from the axis, in beam radii, beyond which no light arrives.
    cutoff: f32,
    /// Unit vector of the local y axis.
    ey: vec3<f32>,
    /// Wavelength in the medium, in metres.
    wavelength: f32,
    /// Unit vector along the direction of travel.
    ez: vec3<f32>,
    /// Unused, 0.
    pad_ez: f32,
    /// Beam radius along x.
    x: Tem00Axis,
    /// Beam radius along y.
    y: Tem00Axis,
}

/// A laser line. A fan whose profile is a table is dark here: its density is not in the struct.
struct Tem00LineLight {
    /// Centre of the lens, in metres.
    origin: vec3<f32>,
    /// Power, in watts.
    power: f32,
    /// Unit vector along which the fan opens.
    ex: vec3<f32>,
    /// Distance from the fan plane, in beam radii, beyond which no light arrives.
    cutoff: f32,
    /// Unit vector of the normal of the fan plane.
    ey: vec3<f32>,
    /// Distance of the virtual apex behind the lens, in metres.
    apex_offset: f32,
    /// Unit vector along the direction of travel.
    ez: vec3<f32>,
    /// Radius of the virtual apex, in metres.
    source_radius: f32,
    /// Beam radius across the fan, on the slant distance from the virtual apex.
    y: Tem00Axis,
    /// Half-width of the uniform part of the profile, in `variable`.
    flat: f32,
    /// Standard deviation of the Gaussian part of the profile, in `variable`.
    sigma: f32,
    /// What the profile is a density in: 0 the slope tan θ, 1 the angle θ, 2 sin θ, 3 a table.
    variable: f32,
    /// The fraction of the profile that lies within |θ| < π/2.
    mass: f32,
    /// Slope of the nominal edge of the fan, tan(α/2).
    half_slope: f32,
    /// 0: the waists are at the slant distance y.z0; 1: on the plane that far from the apex.
    focus_on_plane: f32,
    /// Wavelength in the medium, in metres.
    wavelength: f32,
    /// Unused, 0.
    pad: f32,
}

/// The light that arrives at a point, as one direction and one irradiance; all 0 where it is dark.
struct Tem00NextEvent {
    /// Point of the aperture plane that the light seems to come from.
    point: vec3<f32>,
    /// Distance to `point`, in metres.
    distance: f32,
    /// Unit vector towards the light, against the mean energy flow.
    wi: vec3<f32>,
    /// Irradiance of a surface square to `wi`, in W/m².
    e_perp: f32,
}

/// Returns the irradiance, in W/m², of a plane through `p` at right angles to the axis.
fn tem00_spot_irradiance(light: Tem00SpotLight, p: vec3<f32>) -> f32 {
    return tem00_spot_flow_(light, tem00_local_(tem00_spot_frame_(light), p)).irradiance;
}

/// Returns the light at `p` as one direction: that of the mean energy flow.
fn tem00_spot_next_event(light: Tem00SpotLight, p: vec3<f32>) -> Tem00NextEvent {
    let frame = tem00_spot_frame_(light);
    let local = tem00_local_(frame, p);
    return tem00_next_event_(frame, local, tem00_spot_flow_(light, local));
}

/// Returns the irradiance, in W/m², of a plane through `p` at right angles to the axis.
fn tem00_line_irradiance(light: Tem00LineLight, p: vec3<f32>) -> f32 {
    return tem00_line_flow_(light, tem00_local_(tem00_line_frame_(light), p)).irradiance;
}

/// Returns the light at `p` as one direction: that of the mean energy flow.
fn tem00_line_next_event(light: Tem00LineLight, p: vec3<f32>) -> Tem00NextEvent {
    let frame = tem00_line_frame_(light);
    let local = tem00_local_(frame, p);
    return tem00_next_event_(frame, local, tem00_line_flow_(light, local));
}

/// The energy flow `irradiance · (slope, 1)` in the frame of the light.
struct Tem00Flow_ {
    slope: vec2<f32>,
    irradiance: f32,
}

/// E = 2 P / (π w_x w_y) · exp(−2 (x²/w_x² + y²/w_y²)), slope (x w_x'/w_x, y w_y'/w_y).
fn tem00_spot_flow_(light: Tem00SpotLight, local: vec3<f32>) -> Tem00Flow_ {
    let wx_sq = tem00_radius_sq_(light.x, local.z);
    let wy_sq = tem00_radius_sq_(light.y, local.z);
    let rho_sq = local.x * local.x / wx_sq + local.y * local.y / wy_sq;
    if local.z < 0.0 || rho_sq > light.cutoff * light.cutoff {
        return Tem00Flow_();
    }
    // 2/π = 0.63662
    let peak = 0.636619772 * light.power / (sqrt(wx_sq) * sqrt(wy_sq));
    let slope = vec2(
        local.x * tem00_growth_(light.x, local.z),
        local.y * tem00_growth_(light.y, local.z),
    );
    return Tem00Flow_(slope, peak * exp(-2.0 * rho_sq));
}

/// Keep this form: multiplied out into powers of z it loses all digits near a tight waist.
fn tem00_radius_sq_(axis: Tem00Axis, z: f32) -> f32 {
    let dz = z - axis.z0;
    return axis.w0_sq + axis.theta_sq * dz * dz;
}

/// Relative growth of the radius, w'/w.
fn tem00_growth_(axis: Tem00Axis, z: f32) -> f32 {
    return axis.theta_sq * (z - axis.z0) / tem00_radius_sq_(axis, z);
}

/// E = P g(u) / Z · √(2/π) / w · exp(−2 y²/w²) with the distance Z from the apex, u = x/Z and
/// w = w(r) at the slant distance r = Z √(1 + u²); slope (u, y √(1 + u²) w'/w).
fn tem00_line_flow_(light: Tem00LineLight, local: vec3<f32>) -> Tem00Flow_ {
    let z = local.z + light.apex_offset;
    let u = local.x / z;
    let fan = tem00_fan_density_(light, u);
    let sec = sqrt(1.0 + u * u);
    var axis = light.y;
    if light.focus_on_plane != 0.0 {
        axis.z0 = light.y.z0 * sec;
    }
    let w_sq = tem00_radius_sq_(axis, z * sec);
    let t_sq = local.y * local.y / w_sq;
    if local.z < 0.0 || fan == 0.0 || t_sq > light.cutoff * light.cutoff {
        return Tem00Flow_();
    }
    // √(2/π) = 0.79788
    let across = 0.797884561 / sqrt(w_sq) * exp(-2.0 * t_sq);
    let slope = vec2(u, local.y * tem00_growth_(axis, z * sec) * sec);
    return Tem00Flow_(slope, light.power * fan / z * across);
}

/// Density g(u) of the power per slope u = tan θ: that per variable v, times dv/du; 0 beyond the
/// cut-off |v| = flat + 2 cutoff sigma.
fn tem00_fan_density_(light: Tem00LineLight, u: f32) -> f32 {
    let sec_sq = 1.0 + u * u;
    var v = u;
    var dv_du = 1.0;
    if light.variable == 1.0 {
        v = atan(u);
        dv_du = 1.0 / sec_sq;
    } else if light.variable == 2.0 {
        v = u / sqrt(sec_sq);
        dv_du = 1.0 / (sec_sq * sqrt(sec_sq));
    }
    if abs(v) > light.flat + 2.0 * light.cutoff * light.sigma || light.variable > 2.0 {
        return 0.0;
    }
    return tem00_profile_(light.flat, light.sigma, abs(v)) * dv_du / light.mass;
}

/// A uniform density on [−flat, flat], convolved with a normal one of standard deviation sigma.
fn tem00_profile_(flat: f32, sigma: f32, v: f32) -> f32 {
    if sigma == 0.0 {
        return 0.5 / flat;
    }
    let t = v / sigma;
    if flat == 0.0 {
        // 1/√(2π) = 0.39894
        return 0.398942280 / sigma * exp(-0.5 * t * t);
    }
    // 1/√2 = 0.70711. The difference of complements keeps its digits in the tail.
    let scale = 0.707106781 / sigma;
    return (tem00_erfc_((v - flat) * scale) - tem00_erfc_((v + flat) * scale)) / (4.0 * flat);
}

/// The complementary error function, with a relative error below 4e-7 + 4e-7 x² in f32.
///
/// For x ≥ 0 it is exp(−x²) t p(t) with t = 1/(1 + 0.3 x). The polynomial p interpolates
/// exp(x²) erfc(x) / t at the nine Chebyshev nodes of 1/4 ≤ t ≤ 1, which is 10 ≥ x ≥ 0, and is
/// off by 2.5e-8 at most. Beyond, erfc is 0 in f32.
fn tem00_erfc_(x: f32) -> f32 {
    let t = 1.0 / (1.0 + 0.3 * abs(x));
    let low = 0.1691730577 + t * (0.1709491199 + t * (0.1467960222 + t * 0.2205391691));
    let high = -0.1069833625
        + t * (0.5645142422 + t * (-0.5261516628 + t * (0.4919342706 - t * 0.1307708773)));
    let tail = t * (low + t * t * t * t * high) * exp(-x * x);
    return select(tail, 2.0 - tail, x < 0.0);
}

struct Tem00Frame_ {
    origin: vec3<f32>,
    ex: vec3<f32>,
    ey: vec3<f32>,
    ez: vec3<f32>,
}

fn tem00_spot_frame_(light: Tem00SpotLight) -> Tem00Frame_ {
    return Tem00Frame_(light.origin, light.ex, light.ey, light.ez);
}

fn tem00_line_frame_(light: Tem00LineLight) -> Tem00Frame_ {
    return Tem00Frame_(light.origin, light.ex, light.ey, light.ez);
}

/// Subtracts first, then rotates: the difference is exact where the light is near.
fn tem00_local_(frame: Tem00Frame_, p: vec3<f32>) -> vec3<f32> {
    let d = p - frame.origin;
    return vec3(dot(d, frame.ex), dot(d, frame.ey), dot(d, frame.ez));
}

fn tem00_next_event_(frame: Tem00Frame_, local: vec3<f32>, flow: Tem00Flow_) -> Tem00NextEvent {
    if !(flow.irradiance > 0.0) {
        return Tem00NextEvent();
    }
    // Length of the ray per distance along the axis.
    let sec = sqrt(1.0 + dot(flow.slope, flow.slope));
    let aperture = local.xy - flow.slope * local.z;
    let along = frame.ex * flow.slope.x + frame.ey * flow.slope.y + frame.ez;
    return Tem00NextEvent(
        frame.origin + (frame.ex * aperture.x + frame.ey * aperture.y),
        local.z * sec,
        -along / sec,
        flow.irradiance * sec,
    );
}
