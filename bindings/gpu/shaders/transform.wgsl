// One pass of a Fourier transform over all lines of an array, by Stockham's stages. A workgroup
// transforms BATCH neighbouring sequences of POINTS points in its own memory; a line of more points
// is transformed in two passes. Beside it stand the functions of tem00-speckle, what is written
// (`after`, `finished`), `transform` with its stages, and
//
//     const POINTS: u32 = …;      points of a sequence
//     const BATCH: u32 = …;       sequences of a workgroup
//     const MEMORY: u32 = …;      POINTS · BATCH, up to a multiple of 16
//     const ALONG: bool = …;      whether neighbouring threads work along a sequence, or on
//                                 neighbouring ones

struct Plan {
    /// Points of a line, and how many from the first are not zero.
    length: u32,
    filled: u32,
    /// The product of the points of the passes before.
    done: u32,
    lines: u32,
    /// Where the points lie: of a line, and of one line after the other.
    in_step: u32,
    in_line: u32,
    out_step: u32,
    out_line: u32,
    out_first: u32,
    /// 1 where neighbouring sequences belong to neighbouring lines, 0 where they share one.
    across: u32,
    /// What a finish takes.
    scale: f32,
    pad: u32,
    corner: vec2<u32>,
    size: vec2<u32>,
}

@group(0) @binding(0) var<uniform> plan: Plan;
@group(0) @binding(1) var<storage, read> before: array<vec2<f32>>;

var<workgroup> memory: array<vec2<f32>, MEMORY>;

struct Sequence {
    line: u32,
    /// Its place among the sequences of the line.
    place: u32,
    is_there: bool,
}

fn sequence(number: u32) -> Sequence {
    let in_line = plan.length / POINTS;
    let is_there = number < plan.lines * in_line;
    if plan.across == 1u {
        return Sequence(number % plan.lines, number / plan.lines, is_there);
    }
    return Sequence(number / in_line, number % in_line, is_there);
}

fn loaded(own: Sequence, point: u32) -> vec2<f32> {
    let at = own.place + point * (plan.length / POINTS);
    if !own.is_there || at >= plan.filled {
        return vec2<f32>(0.0);
    }
    let value = before[at * plan.in_step + own.line * plan.in_line];
    if plan.done == 1u {
        return value;
    }
    return tem00_complex_product(value, tem00_twiddle(own.place, point, plan.done, POINTS));
}

fn store(own: Sequence, point: u32, value: vec2<f32>) {
    if own.is_there {
        let to = tem00_stockham(own.place, point, plan.done, POINTS);
        after[plan.out_first + to * plan.out_step + own.line * plan.out_line] =
            finished(value, own.line, to);
    }
}

/// Returns which sequence of the workgroup a thread works on, and which butterfly of it.
fn work(at: u32, butterflies: u32) -> vec2<u32> {
    if ALONG {
        return vec2<u32>(at / butterflies, at % butterflies);
    }
    return vec2<u32>(at % BATCH, at / BATCH);
}

/// Returns where a point lies in the memory: points that sixteen threads read or write together lie
/// in different banks.
fn cell(sequence: u32, point: u32) -> u32 {
    let at = sequence * POINTS + point;
    return at ^ ((at >> 4u) & 15u);
}
