// The factor by which speckle multiplies the light of a laser at a hit, for a renderer's own
// kernels:
//
//     radiance += f * abs(dot(n, event.wi)) * event.e_perp * tem00_factor(frame, p, n);
//
// Functions and structs only: no bindings, no entry points, no imports, no extensions; names that
// end in `_` are not for the caller. The function files of tem00-decorrelation and tem00-speckle
// stand beside this one, with the two functions that the second asks of the host.
//
// Validity: that of `SpeckleFrame::factor`, for the cameras that `to_rows` takes, and points in
// metres that are numbers: keep the origin of the world near the scene. A pattern is looked up 4 ε
// of the principal distance beside its place, in its samples, ε = 1.2e-7; the pupil is off as
// `tem00_speckle_motion` says, and by 4 ε L² |a| / z_R² in light of a waist with the Rayleigh range
// z_R.

/// Speckle of one body in one frame: `KernelSpeckle::rows` in the crate, 224 bytes.
///
/// Vectors after the axes have the components right, up and towards the camera, from its pupil.
struct Tem00SpeckleFrame {
    /// Centre of the pupil now, in the world.
    pupil: vec3<f32>,
    /// Reciprocal diameter of the pupil, in 1/m.
    per_pupil_diameter: f32,
    /// Axes of the camera now, in the world.
    right: vec3<f32>,
    /// Reciprocal distance of the surface in focus from the pupil, in 1/m.
    focus_vergence: f32,
    up: vec3<f32>,
    /// Axial decorrelation lengths per change of 1/Z, in metres.
    axial_length: f32,
    towards_camera: vec3<f32>,
    /// Samples of the pattern per slope of the line of sight.
    samples: f32,
    /// Motion of the body since the reference state, relative to the camera: a quaternion, a
    /// translation.
    rotation: vec4<f32>,
    translation: vec3<f32>,
    /// Slices per motion of the pupil by its diameter.
    slices_per_diameter: f32,
    /// That of the laser.
    laser_rotation: vec4<f32>,
    laser_translation: vec3<f32>,
    /// The largest shift that the slices hold, in pupil diameters: less than 0 on one side of the
    /// reference.
    reach: f32,
    /// The laser now: its aperture and its axes.
    aperture: vec3<f32>,
    /// The centre of its wave along x, on its axis; that along y from there: once, and per secant
    /// of the ray.
    centre: f32,
    ex: vec3<f32>,
    centre_across: f32,
    ey: vec3<f32>,
    centre_across_growth: f32,
    ez: vec3<f32>,
    /// 1 for a line, 0 for a spot.
    is_line: f32,
    /// Squares of the Rayleigh ranges along x and y, in m².
    rayleigh_squared: vec2<f32>,
    /// Where the axis of the camera meets the pattern, in samples.
    origin: vec2<f32>,
    /// Width, height and slices of the stack.
    stack: vec4<f32>,
}

/// The speckle at a point.
struct Tem00Speckle {
    /// The place in the pattern, in samples.
    place: vec2<f32>,
    /// Its motion in the image since the reference state, to the right and up, in samples.
    displacement: vec2<f32>,
    /// Coordinate in the stack, in slices.
    slice: f32,
    /// Correlation γ of the intensity with that of the reference state.
    correlation: f32,
    /// Whether the point lies before the lens: behind it there is no pattern.
    seen: bool,
}

/// Returns the factor by which speckle multiplies the radiance at a point, now, of a surface with a
/// normal of any length, to either side: `SpeckleFrame::factor`.
fn tem00_factor(frame: Tem00SpeckleFrame, point: vec3<f32>, normal: vec3<f32>) -> f32 {
    let at = tem00_speckle(frame, point, normal);
    if !at.seen {
        return 1.0;
    }
    let stack = vec4<u32>(frame.stack);
    return tem00_stack_intensity(Tem00Stack(stack.xy, stack.z), at.place.x, at.place.y, at.slice);
}

/// Returns where the speckle of a point is looked up: `SpeckleFrame::shift`.
fn tem00_speckle(frame: Tem00SpeckleFrame, point: vec3<f32>, normal: vec3<f32>) -> Tem00Speckle {
    let camera = mat3x3(frame.right, frame.up, frame.towards_camera);
    let to_pupil = (frame.pupil - point) * camera;
    let backwards = vec4(-frame.rotation.xyz, frame.rotation.w);
    let motion =
        frame.translation - tem00_rotation_change(backwards, -to_pupil - frame.translation);
    let before = to_pupil + motion;
    let outwards = normal * camera;
    let outwards_before = outwards + tem00_rotation_change(backwards, outwards);
    let light = tem00_light_(frame, -to_pupil, motion);
    let moved = tem00_speckle_motion(before, outwards_before, motion, frame.rotation, light);

    var image = to_pupil.xy / -to_pupil.z;
    var displacement = vec2(0.0);
    var shift = 1e18;
    var axial = 0.0;
    if moved.seen {
        // Out of focus the speckle moves beside the image of the point.
        shift = length(moved.pupil_displacement) * frame.per_pupil_diameter;
        let defocus = 0.5 * (moved.per_depth.x + moved.per_depth.y) - frame.focus_vergence;
        let beside = select(vec2(0.0), moved.pupil_displacement * -defocus, shift < 1e9);
        displacement = moved.image_displacement + beside;
        image = moved.image - beside;
        axial = motion.z * moved.per_depth.x * moved.per_depth.y * frame.axial_length;
    }
    let correlation = tem00_correlation(shift, axial);
    // Beyond the first zero a motion along the axis counts by its unit.
    shift = select(shift, max(shift, abs(axial)), abs(axial) >= 1.0);
    let reach = abs(frame.reach);
    let overlap = max(sqrt(correlation), tem00_disc_overlap_(reach));
    let u = tem00_slice_coordinate_(min(shift, reach), overlap, frame.slices_per_diameter);
    return Tem00Speckle(
        frame.origin + frame.samples * image,
        frame.samples * displacement,
        sign(frame.reach) * u,
        correlation,
        to_pupil.z > 0.0,
    );
}

/// The light at a point that lies at `position` after a motion.
fn tem00_light_(
    frame: Tem00SpeckleFrame,
    position: vec3<f32>,
    motion: vec3<f32>,
) -> Tem00LightMotion {
    let axes = mat3x3(frame.ex, frame.ey, frame.ez);
    let turn = tem00_rotation_change(frame.laser_rotation, position - motion);
    let step = (motion - turn - frame.laser_translation) * axes;
    let wave = tem00_wave_(frame, (position - frame.aperture) * axes - step, step);
    let turned = axes * wave.to_source;
    let backwards = vec4(-frame.laser_rotation.xyz, frame.laser_rotation.w);
    let turned_back = tem00_rotation_change(backwards, turned);
    return Tem00LightMotion(turned + turned_back, axes * wave.change - turned_back);
}

/// The light in the axes of the laser at a point that moves by `step` from `local`: against the
/// slopes of the rays, but towards the aperture at the apex of a line and behind it.
fn tem00_wave_(frame: Tem00SpeckleFrame, local: vec3<f32>, step: vec3<f32>) -> Tem00LightMotion {
    let depth = local.z - frame.centre;
    let x = tem00_slope_(vec2(local.x, step.x), vec2(depth, step.z), frame.rayleigh_squared.x);
    // Along a line the wave travels on slant rays.
    let after = x.x + x.y;
    let sec = sqrt(1.0 + frame.is_line * vec2(x.x * x.x, after * after));
    let longer = frame.is_line * x.y * (x.x + after) / (sec.x + sec.y);
    let slant = (depth - frame.centre_across_growth) * sec.x - frame.centre_across;
    let further = step.z * sec.y + (depth - frame.centre_across_growth) * longer;
    let y = tem00_slope_(vec2(local.y, step.y), vec2(slant, further), frame.rayleigh_squared.y);
    var ray = vec3(x.x, y.x * sec.x, 1.0);
    var change = vec3(x.y, y.y * sec.y + y.x * longer, 0.0);
    if frame.is_line > 0.0 && min(depth, depth + step.z) <= 0.0 {
        ray = local;
        change = step;
    }
    let both = vec2(length(ray), length(ray + change));
    if both.x == 0.0 || both.y == 0.0 {
        return Tem00LightMotion();
    }
    let direction = ray / both.x;
    let growth = dot(change, 2.0 * ray + change) / (both.x + both.y);
    return Tem00LightMotion(-direction, (direction * growth - change) / both.y);
}

/// The slope x z / (z² + z_R²) of a ray, and its change: x and z come with theirs.
fn tem00_slope_(x: vec2<f32>, z: vec2<f32>, rayleigh_squared: f32) -> vec2<f32> {
    let after = z.x + z.y;
    let square = z.x * z.x + rayleigh_squared;
    let square_after = after * after + rayleigh_squared;
    let change = z.y * ((rayleigh_squared - z.x * after) / square) / square_after;
    return vec2(x.x * z.x / square, x.y * (after / square_after) + x.x * change);
}

/// The coordinate u ≥ 0, in slices, of a shift of the pupil in its diameters that leaves `overlap`
/// together with what moved along the axis: where the blend of two slices has kept as much, and on
/// along the path once nothing is left. `SpeckleStack::coordinates_within` on a straight path
/// behind a circle.
fn tem00_slice_coordinate_(shift: f32, overlap: f32, per_diameter: f32) -> f32 {
    if shift >= 1.0 {
        return shift * per_diameter;
    }
    var slice = floor(shift * per_diameter);
    var a = tem00_disc_overlap_(slice / per_diameter);
    var b = tem00_disc_overlap_((slice + 1.0) / per_diameter);
    while b > overlap {
        slice += 1.0;
        a = b;
        b = tem00_disc_overlap_((slice + 1.0) / per_diameter);
    }
    // The fraction f where [(1 − f) a + f b] / √(1 − 2 f (1 − f) k) has fallen to `overlap`.
    let k = 1.0 - tem00_disc_overlap_(1.0 / per_diameter);
    let step = b - a;
    let square = k * overlap * overlap;
    let root = overlap * sqrt(max(step * step + 2.0 * k * a * b - (2.0 - k) * square, 0.0));
    let fraction = (a - overlap) * (a + overlap) / max(root - a * step - square, 1e-30);
    return slice + clamp(fraction, 0.0, 1.0);
}
