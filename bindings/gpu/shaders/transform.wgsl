// One stage of Stockham's Fourier transform, of all lines of an array at once. Beside it stand the functions of
// tem00-speckle, what is written (`after`, `finished`) and
//
//     const RADIX: u32 = …;       2, 3, 4, 5, 8 or 16
//     fn butterfly(v: array<vec2<f32>, RADIX>) -> array<vec2<f32>, RADIX> { return tem00_dft16(v); }

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
    var v: array<vec2<f32>, RADIX>;
    for (var r = 0u; r < RADIX; r += 1u) {
        let point = own + r * apart;
        if point < stage.filled {
            let twiddle = tem00_twiddle(own, r, stage.done, RADIX);
            v[r] = tem00_complex_product(before[point * stage.in_step + line * stage.in_line], twiddle);
        }
    }
    v = butterfly(v);
    for (var r = 0u; r < RADIX; r += 1u) {
        let point = tem00_stockham(own, r, stage.done, RADIX);
        after[stage.out_first + point * stage.out_step + line * stage.out_line] = finished(v[r], line, point);
    }
}
