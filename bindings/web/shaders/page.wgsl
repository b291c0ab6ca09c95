// A part under a laser, as a camera sees it: a film of light with and without speckle, and the film
// on a screen. In front of it stand the function files of beam, decorrelation, shading and speckle,
// and the bindings of the stack.

struct Scene {
    line: Tem00LineLight,
    spot: Tem00SpotLight,
    frame: Tem00SpeckleFrame,
    /// The rotation of the part since the reference state, and its translation, in metres.
    rotation: vec4<f32>,
    shift: vec4<f32>,
    boxes: array<array<vec4<f32>, 2>, 4>,
    sphere: vec4<f32>,
    /// Irradiance of the lamp in W/m², whether there is speckle, whether as printed, whether in
    /// false colour.
    lamp: f32,
    speckle: f32,
    printed: f32,
    false_colour: f32,
    /// Width and height in pixels, boxes, the slope of a ray per pixel from the axis.
    size: vec2<f32>,
    boxes_used: f32,
    slope: f32,
    /// From light to the screen: the centre of the zoom, exposure, zoom, and the colour of the
    /// laser.
    centre: vec2<f32>,
    exposure: f32,
    zoom: f32,
    colour: vec3<f32>,
    /// Camera samples along a side of a pixel.
    samples: f32,
}

@group(0) @binding(0) var<uniform> scene: Scene;

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
    if scene.frame.is_line > 0.5 { return tem00_line_next_event(scene.line, p); }
    return tem00_spot_next_event(scene.spot, p);
}

/// Light with speckle, light without it, the light of the lamp, and the correlation with the
/// reference state, seen at a place of the image in pixels, from the upper left corner.
fn seen(pixel: vec2<f32>) -> vec4<f32> {
    let slope = (pixel - 0.5 * scene.size) * vec2<f32>(scene.slope, -scene.slope);
    let camera = scene.frame;
    let direction = normalize(slope.x * camera.right + slope.y * camera.up - camera.towards_camera);
    let hit = nearest(rotated_back(camera.pupil - scene.shift.xyz), rotated_back(direction));
    if hit.distance >= FAR { return vec4<f32>(0.0, 0.0, 0.0, 1.0); }

    let p = camera.pupil + hit.distance * direction;
    let normal = rotated(hit.normal);
    let facing = max(0.0, dot(normal, vec3<f32>(0.48, -0.36, 0.8)));
    let lamp = 0.318309886 * scene.lamp * (0.4 + 0.6 * facing);
    let event = laser_at(p);
    let cosine = dot(normal, event.wi);
    if event.e_perp <= 0.0 || cosine <= 0.0 { return vec4<f32>(0.0, 0.0, lamp, 1.0); }
    let outside = p + 2e-6 * normal;
    let blocker = nearest(rotated_back(outside - scene.shift.xyz), rotated_back(event.wi));
    if blocker.distance < event.distance {
        return vec4<f32>(0.0, 0.0, lamp, 1.0);
    }
    // The paper divides by the cosine, and so creates light on tilted surfaces.
    let flow = select(cosine, 1.0, scene.printed > 0.5);
    let radiance = 0.8 * 0.318309886 * event.e_perp * flow;
    let speckle = speckle_at(p, normal);
    return vec4<f32>(radiance * speckle.x, radiance, lamp, speckle.y);
}

/// The intensity of the speckle at a point, and its correlation with the reference state.
fn speckle_at(p: vec3<f32>, normal: vec3<f32>) -> vec2<f32> {
    if scene.speckle < 0.5 { return vec2<f32>(1.0); }
    let at = tem00_speckle(scene.frame, p, normal);
    // The paper moves the pattern against the image.
    let place = at.place + select(0.0, 2.0, scene.printed > 0.5) * at.displacement;
    let intensity = tem00_stack_intensity(tem00_stack, place.x, place.y, at.slice);
    return vec2<f32>(intensity, at.correlation);
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
