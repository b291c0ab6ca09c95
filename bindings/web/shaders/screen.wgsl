// The film on a screen; it follows page.wgsl.

@group(0) @binding(1) var film_: texture_2d<f32>;

/// A pixel of the screen, of which the canvas has as many as the film.
@fragment
fn screen(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
    let place = scene.centre * scene.size + (at.xy - scene.centre * scene.size) / scene.zoom;
    let light = textureLoad(film_, vec2<i32>(clamp(place, vec2<f32>(0.0), scene.size - 1.0)), 0);
    var linear = scene.exposure * (light.x * scene.colour + vec3<f32>(light.z));
    if scene.false_colour > 0.5 {
        linear = heat(scene.exposure * (light.x + light.z));
    }
    // The curve of sRGB (IEC 61966-2-1).
    let bright = clamp(linear, vec3<f32>(0.0), vec3<f32>(1.0));
    let curve = select(
        1.055 * pow(bright, vec3<f32>(1.0 / 2.4)) - 0.055,
        12.92 * bright,
        bright <= vec3<f32>(0.0031308),
    );
    return vec4<f32>(curve, 1.0);
}

/// Black, blue, red, yellow, white, at equal steps.
fn heat(light: f32) -> vec3<f32> {
    let x = 4.0 * clamp(light, 0.0, 1.0);
    return vec3<f32>(
        clamp(x - 1.0, 0.0, 1.0),
        clamp(x - 2.0, 0.0, 1.0),
        clamp(min(x, 2.0 - x), 0.0, 1.0) + clamp(x - 3.0, 0.0, 1.0),
    );
}
