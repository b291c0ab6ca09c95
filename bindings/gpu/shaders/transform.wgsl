// One stage of Stockham's Fourier transform, of all lines of an array at once. Before it stand the functions of
// tem00-speckle, a finish and
//
//     const RADIX: u32 = …;       2, 3, 4, 5, 8 or 16
//     fn butterfly(v: array<vec2<f32>, RADIX>) -> array<vec2<f32>, RADIX> { return dft16(v); }

struct Stage {
    /// Points of a line, and how many from the first are not zero.
    length: u32,
    filled: u32,
    /// The product of the radices of the stages before.
    done: u32,
    lines: u32,
    /// Where the points lie: of a line, and of one line after the other.
    in_step: u32,
    in_line: u32,
    out_step: u32,
    out_line: u32,
    out_first: u32,
    /// 1 where neighbouring threads work on neighbouring lines, 0 where they work along one.
    across: u32,
    /// What a finish takes.
    scale: f32,
    pad: u32,
    corner: vec2<u32>,
    size: vec2<u32>,
}

@group(0) @binding(0) var<uniform> stage: Stage;
@group(0) @binding(1) var<storage, read> before: array<vec2<f32>>;

@compute @workgroup_size(64)
fn transform(@builtin(global_invocation_id) id: vec3<u32>) {
    let across = stage.across == 1u;
    let line = select(id.y, id.x, across);
    let own = select(id.x, id.y, across);
    let apart = stage.length / RADIX;
    if line >= stage.lines || own >= apart {
        return;
    }
    let angle = own % stage.done;
    var v: array<vec2<f32>, RADIX>;
    for (var r = 0u; r < RADIX; r += 1u) {
        let point = own + r * apart;
        if point < stage.filled {
            let turns = tem00_turns(angle * r, stage.done * RADIX);
            v[r] = tem00_complex_product(before[point * stage.in_step + line * stage.in_line], tem00_unit_phasor(0u - turns));
        }
    }
    v = butterfly(v);
    let first = (own - angle) * RADIX + angle;
    for (var r = 0u; r < RADIX; r += 1u) {
        let point = first + r * stage.done;
        after[stage.out_first + point * stage.out_step + line * stage.out_line] = finished(v[r], line, point);
    }
}

/// −i z.
fn turned_back(z: vec2<f32>) -> vec2<f32> {
    return vec2<f32>(z.y, -z.x);
}

fn dft2(v: array<vec2<f32>, 2>) -> array<vec2<f32>, 2> {
    return array<vec2<f32>, 2>(v[0] + v[1], v[0] - v[1]);
}

fn dft3(v: array<vec2<f32>, 3>) -> array<vec2<f32>, 3> {
    let sum = v[1] + v[2];
    let middle = v[0] - 0.5 * sum;
    let side = 0.8660254037844386 * turned_back(v[1] - v[2]);
    return array<vec2<f32>, 3>(v[0] + sum, middle + side, middle - side);
}

fn dft4(v: array<vec2<f32>, 4>) -> array<vec2<f32>, 4> {
    let a = v[0] + v[2];
    let b = v[0] - v[2];
    let c = v[1] + v[3];
    let d = turned_back(v[1] - v[3]);
    return array<vec2<f32>, 4>(a + c, b + d, a - c, b - d);
}

fn dft5(v: array<vec2<f32>, 5>) -> array<vec2<f32>, 5> {
    let cosine = vec2<f32>(0.30901699437494745, -0.8090169943749475);
    let sine = vec2<f32>(0.9510565162951535, 0.5877852522924731);
    let outer = v[1] + v[4];
    let inner = v[2] + v[3];
    let outer_side = turned_back(v[1] - v[4]);
    let inner_side = turned_back(v[2] - v[3]);
    let a = v[0] + cosine.x * outer + cosine.y * inner;
    let b = v[0] + cosine.y * outer + cosine.x * inner;
    let c = sine.x * outer_side + sine.y * inner_side;
    let d = sine.y * outer_side - sine.x * inner_side;
    return array<vec2<f32>, 5>(v[0] + outer + inner, a + c, b + d, b - d, a - c);
}

fn dft8(v: array<vec2<f32>, 8>) -> array<vec2<f32>, 8> {
    let half = 0.7071067811865476;
    let even = dft4(array<vec2<f32>, 4>(v[0], v[2], v[4], v[6]));
    let odd = dft4(array<vec2<f32>, 4>(v[1], v[3], v[5], v[7]));
    let b = half * (odd[1] + turned_back(odd[1]));
    let c = turned_back(odd[2]);
    let d = half * (turned_back(odd[3]) - odd[3]);
    return array<vec2<f32>, 8>(
        even[0] + odd[0], even[1] + b, even[2] + c, even[3] + d,
        even[0] - odd[0], even[1] - b, even[2] - c, even[3] - d,
    );
}

fn dft16(v: array<vec2<f32>, 16>) -> array<vec2<f32>, 16> {
    var even = dft8(array<vec2<f32>, 8>(v[0], v[2], v[4], v[6], v[8], v[10], v[12], v[14]));
    var odd = dft8(array<vec2<f32>, 8>(v[1], v[3], v[5], v[7], v[9], v[11], v[13], v[15]));
    var out: array<vec2<f32>, 16>;
    for (var k = 0u; k < 8u; k += 1u) {
        let side = tem00_complex_product(odd[k], tem00_unit_phasor(0u - (k << 28u)));
        out[k] = even[k] + side;
        out[k + 8u] = even[k] - side;
    }
    return out;
}
