// Fills the box of an aperture with the values that it selects from the lattice:
// `tem00_speckle::Aperture`.

struct Place {
    /// Lattice point of the first column and row.
    start: vec2<i32>,
    /// Points after which the lattice closes; 0 for 2³².
    period: vec2<u32>,
    /// Columns and rows.
    extent: vec2<u32>,
    seed: vec2<u32>,
    /// 1 for circular Gaussian phasors.
    gaussian: u32,
    /// 1 if there is a transmission for each point.
    weighted: u32,
}

@group(0) @binding(0) var<uniform> place: Place;
/// For each row: from and to where the pupil is open, and from and to where closed in its midst.
@group(0) @binding(1) var<storage, read> spans: array<vec4<u32>>;
/// A factor for each column, then for each row.
@group(0) @binding(2) var<storage, read> factors: array<vec2<f32>>;
@group(0) @binding(3) var<storage, read> weights: array<vec2<f32>>;
@group(0) @binding(4) var<storage, read_write> values: array<vec2<f32>>;

/// A thread makes the phasors of one block of sixteen words.
@compute @workgroup_size(8, 8)
fn fill(@builtin(global_invocation_id) id: vec3<u32>) {
    let first = 16 * i32(id.x) - (place.start.x & 15);
    let row = id.y;
    if row >= place.extent.y || first >= i32(place.extent.x) {
        return;
    }
    let ky = bitcast<u32>(tem00_lattice_nearest(place.start.y + i32(row), place.period.y));
    // None yet: there are 2²⁸.
    var block = 0xffffffffu;
    var phases: array<vec4<u32>, 4>;
    var magnitudes: array<vec4<u32>, 4>;
    for (var i = 0; i < 16; i += 1) {
        let column = u32(first + i);
        // Those before the first are the largest as unsigned numbers.
        if column >= place.extent.x {
            continue;
        }
        let at = row * place.extent.x + column;
        if !is_open(spans[row], column) {
            values[at] = vec2<f32>(0.0);
            continue;
        }
        let word = bitcast<u32>(tem00_lattice_nearest(place.start.x + i32(column), place.period.x));
        // Where the lattice closes the words run on in another block.
        if word / 16u != block {
            block = word / 16u;
            phases = tem00_phasor_words(place.seed, vec2<u32>(ky, 0u), block);
            if place.gaussian == 1u {
                magnitudes = tem00_phasor_words(place.seed, vec2<u32>(ky, 1u), block);
            }
        }
        var value = tem00_unit_phasor(phases[(word / 4u) % 4u][word % 4u]);
        if place.gaussian == 1u {
            value *= tem00_rayleigh_magnitude(magnitudes[(word / 4u) % 4u][word % 4u]);
        }
        if place.weighted == 1u {
            value = tem00_complex_product(value, weights[at]);
        }
        let factor = tem00_complex_product(factors[column], factors[place.extent.x + row]);
        values[at] = tem00_complex_product(value, factor);
    }
}

fn is_open(span: vec4<u32>, column: u32) -> bool {
    let open = span.x <= column && column < span.y;
    return open && !(span.z <= column && column < span.w);
}
