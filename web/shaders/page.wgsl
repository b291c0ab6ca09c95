// A part under a laser, as a camera sees it: a film of light with and without speckle, and the film on a screen.
// In front of it stand the function files of beam, decorrelation and speckle, and the bindings of the stack.

struct Scene {
    line: Tem00LineLight,
    spot: Tem00SpotLight,
    imaging: Tem00Imaging,
    /// Centre of the pupil, in metres, and the slope of a ray per pixel from the axis.
    eye: vec4<f32>,
    /// The rotation of the part since the reference state, and its translation, in metres.
    rotation: vec4<f32>,
    shift: vec4<f32>,
    boxes: array<array<vec4<f32>, 2>, 4>,
    sphere: vec4<f32>,
    /// Irradiance of the lamp in W/m², whether the light is a spot, whether there is speckle, whether as printed.
    lamp: f32,
    spot_light: f32,
    speckle: f32,
    printed: f32,
    /// Width and height in pixels, boxes, samples of the pattern per pixel.
    size: vec2<f32>,
    boxes_used: f32,
    per_pixel: f32,
    /// Slices up to the first without correlation, and camera samples along a side of a pixel.
    overlaps_used: f32,
    samples: f32,
    /// From light to the screen: exposure, zoom, colours, the centre of the zoom, and the colour of the laser.
    exposure: f32,
    zoom: f32,
    centre: vec2<f32>,
    false_colour: f32,
    pad: f32,
    colour: vec4<f32>,
}

@group(0) @binding(0) var<uniform> scene: Scene;
@group(0) @binding(2) var<storage, read> overlaps: array<vec2<f32>>;

fn tem00_slice_overlaps(slice: u32) -> vec2<f32> { return overlaps[slice]; }

struct Hit {
    distance: f32,
    normal: vec3<f32>,
}

const FAR = 1e9;

/// The nearest point of the part on a ray in the frame of the part.
fn nearest(origin: vec3<f32>, direction: vec3<f32>) -> Hit {
    var hit = Hit(FAR, vec3<f32>(0.0));
    for (var i = 0u; i < u32(scene.boxes_used); i++) {
        let a = (scene.boxes[i][0].xyz - origin) / direction;
        let b = (scene.boxes[i][1].xyz - origin) / direction;
        let entry = min(a, b);
        let exit = max(a, b);
        let start = max(max(entry.x, entry.y), entry.z);
        if start > 1e-6 && start < min(min(exit.x, exit.y), exit.z) && start < hit.distance {
            let side = select(vec3<f32>(0.0), vec3<f32>(1.0), entry == vec3<f32>(start));
            hit = Hit(start, -sign(direction) * side);
        }
    }
    let radius = scene.sphere.w;
    if radius > 0.0 {
        let from_centre = origin - scene.sphere.xyz;
        let along = dot(from_centre, direction);
        let across = from_centre - along * direction;
        let inside = radius * radius - dot(across, across);
        if inside > 0.0 {
            let start = -along - sqrt(inside);
            if start > 1e-6 && start < hit.distance {
                hit = Hit(start, (from_centre + start * direction) / radius);
            }
        }
    }
    return hit;
}

fn rotated(v: vec3<f32>) -> vec3<f32> { return v + tem00_rotation_change(scene.rotation, v); }
fn rotated_back(v: vec3<f32>) -> vec3<f32> {
    return v + tem00_rotation_change(vec4<f32>(-scene.rotation.xyz, scene.rotation.w), v);
}

fn laser_at(p: vec3<f32>) -> Tem00NextEvent {
    if scene.spot_light > 0.5 { return tem00_spot_next_event(scene.spot, p); }
    return tem00_line_next_event(scene.line, p);
}

/// Light with speckle, light without it, the light of the lamp, and the correlation with the reference state, seen at a
/// place of the image in pixels, from the upper left corner.
fn seen(pixel: vec2<f32>) -> vec4<f32> {
    let image = (pixel - 0.5 * scene.size) * vec2<f32>(1.0, -1.0);
    let slope = image * scene.eye.w;
    let camera = scene.imaging;
    let direction = normalize(slope.x * camera.right + slope.y * camera.up - camera.towards_camera);
    let hit = nearest(rotated_back(scene.eye.xyz - scene.shift.xyz), rotated_back(direction));
    if hit.distance >= FAR { return vec4<f32>(0.0, 0.0, 0.0, 1.0); }

    let p = scene.eye.xyz + hit.distance * direction;
    let normal = rotated(hit.normal);
    let lamp = 0.318309886 * scene.lamp * (0.4 + 0.6 * max(0.0, dot(normal, vec3<f32>(0.48, -0.36, 0.8))));
    let event = laser_at(p);
    let cosine = dot(normal, event.wi);
    if event.e_perp <= 0.0 || cosine <= 0.0 { return vec4<f32>(0.0, 0.0, lamp, 1.0); }
    let outside = p + 2e-6 * normal;
    if nearest(rotated_back(outside - scene.shift.xyz), rotated_back(event.wi)).distance < event.distance {
        return vec4<f32>(0.0, 0.0, lamp, 1.0);
    }
    // The paper divides by the cosine, and so creates light on tilted surfaces.
    let flow = select(cosine, 1.0, scene.printed > 0.5);
    let radiance = 0.8 * 0.318309886 * event.e_perp * flow;
    let speckle = speckle_at(image, rotated_back(p - scene.shift.xyz), hit.normal);
    return vec4<f32>(radiance * speckle.x, radiance, lamp, speckle.y);
}

/// The turn of the light by a motion, from the curvature of its wavefront: that of a beam, 1/R(z) along each axis.
fn wave_at(p: vec3<f32>, motion: vec3<f32>) -> Tem00LightMotion {
    let towards = laser_at(p).wi;
    if dot(towards, towards) == 0.0 { return tem00_collimated(towards); }
    if scene.spot_light > 0.5 {
        let z = dot(p - scene.spot.origin, scene.spot.ez);
        let along = scene.spot.ex - towards * dot(towards, scene.spot.ex);
        return tem00_wavefront(towards, tensor(towards, along, curvature(scene.spot.x, z), curvature(scene.spot.y, z)), motion);
    }
    // In the plane of the fan the waves spread from its apex.
    let from_apex = p - scene.line.origin + scene.line.ez * scene.line.apex_offset;
    let slant = length(from_apex - scene.line.ey * dot(from_apex, scene.line.ey));
    let across = curvature(scene.line.y, slant);
    return tem00_wavefront(towards, tensor(towards, cross(scene.line.ey, towards), 1.0 / slant, across), motion);
}

/// The curvature of a beam at the distance z from where its waist is counted.
fn curvature(axis: Tem00Axis, z: f32) -> f32 {
    let beyond = z - axis.z0;
    return axis.theta_sq * beyond / (axis.w0_sq + axis.theta_sq * beyond * beyond);
}

/// The tensor of a wave from `towards` with one curvature along an axis across it, and one along the other.
fn tensor(towards: vec3<f32>, axis: vec3<f32>, first: f32, second: f32) -> mat3x3<f32> {
    let a = normalize(axis);
    let b = cross(towards, a);
    return first * mat3x3<f32>(a * a.x, a * a.y, a * a.z) + second * mat3x3<f32>(b * b.x, b * b.y, b * b.z);
}

/// The intensity of the speckle, and its correlation with the reference state, at a place of the image in pixels from the
/// axis, where a point of the part is seen that lay at `p` with this normal in the reference state.
fn speckle_at(image: vec2<f32>, p: vec3<f32>, normal: vec3<f32>) -> vec2<f32> {
    if scene.speckle < 0.5 { return vec2<f32>(1.0); }
    let motion = tem00_rotation_change(scene.rotation, p) + scene.shift.xyz;
    let light = wave_at(p, motion);
    let moved = tem00_speckle_motion(scene.imaging, scene.eye.xyz - p, normal, motion, scene.rotation, light);
    let u = tem00_slice_coordinate(moved.correlation, u32(scene.overlaps_used));
    // The paper moves the pattern against the image.
    let sense = select(-1.0, 1.0, scene.printed > 0.5);
    let place = image * scene.per_pixel + sense * scene.imaging.samples_per_metre * moved.speckle_displacement;
    return vec2<f32>(tem00_stack_intensity(tem00_stack, place.x, place.y, u), moved.correlation);
}

@vertex
fn corner(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

/// A pixel of the film: the mean of its samples.
@fragment
fn film(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
    let pixel = floor(at.xy);
    let samples = u32(scene.samples);
    var sum = vec4<f32>(0.0);
    for (var y = 0u; y < samples; y++) {
        for (var x = 0u; x < samples; x++) {
            sum += seen(pixel + (vec2<f32>(f32(x), f32(y)) + 0.5) / scene.samples);
        }
    }
    return sum / (scene.samples * scene.samples);
}
