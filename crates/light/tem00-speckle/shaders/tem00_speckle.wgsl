// Speckle for a renderer's own kernels: random phasors from seed and lattice point, the parts of a
// Fourier transform, and look-ups in a stack.
//
// Functions and structs only: no bindings, no entry points, no imports, no extensions. Every name
// begins with `tem00_` or `Tem00`; those that end in `_` are not for the caller.
//
// A look-up reads the stack by two functions of the host, over storage buffers or textures as it
// likes:
//
//     fn tem00_stack_coefficient(slice: u32, cell: vec2<u32>) -> vec2<f32>
//         The coefficient at column cell.x of row cell.y of a slice, real and imaginary part:
//         `SpeckleStack::coefficients`.
//     fn tem00_stack_law(slice: u32, row: u32) -> vec4<f32>
//         Row 0 to 13 of the closed forms of a slice: `SliceLaw::rows`.
//
// The intensity has mean 1 and the law of `SpeckleStack::intensity_at`: multiply the irradiance of
// the light by it. Positions x and y count samples, u counts slices; all three are periodic, at any
// whole number that an i32 holds. An f32 of a thousand samples resolves 6e-5 of one, which moves
// the intensity by as much: where that is too coarse, split the coordinates in the host or by
// integers and call `tem00_stack_intensity_at`.
//
// A stack is made by `tem00_phasor`, the factors that `Aperture::factors` has for each column and
// row of the pupil, and a Fourier transform. Stockham's takes a stage for each of the radices 2 to
// 16 whose product is the side of the pattern: thread `own` of length / radix reads the points
// own + r length / radix of a line, multiplies them by `tem00_twiddle`, transforms them by
// `tem00_dft2` to `tem00_dft16`, and writes value r to the point `tem00_stockham` of another array;
// `done` is the product of the radices before. The rows of the pupil go first, zero where the box
// ends, then all columns; `tem00_centring` over the root of the pupil's points makes the amplitude.
//
// Nothing is left to a device's own sine, exponential or logarithm: additions, multiplications,
// divisions, square roots and integers come within a few roundings of the library anywhere.

/// What look-ups know of a stack.
struct Tem00Stack {
    /// The periods along x and y, in samples.
    size: vec2<u32>,
    /// The number of slices, which is the period of u.
    slices: u32,
}

/// Returns the intensity, with mean 1, at (x, y) in samples and u in slices, all finite.
fn tem00_stack_intensity(stack: Tem00Stack, x: f32, y: f32, u: f32) -> f32 {
    let position = vec3<f32>(x, y, u);
    let cell = floor(position);
    let fraction = position - cell;
    return tem00_stack_intensity_at(
        stack, vec2<i32>(cell.xy), fraction.xy, i32(cell.z), fraction.z,
    );
}

/// Returns the intensity at the `fraction`, in [0, 1], of the way from sample `cell` to the next
/// along each axis, and at `slice_fraction` of the way from `slice` to the next. Cells and slices
/// may be any.
fn tem00_stack_intensity_at(
    stack: Tem00Stack,
    cell: vec2<i32>,
    fraction: vec2<f32>,
    slice: i32,
    slice_fraction: f32,
) -> f32 {
    let blend = tem00_stack_blend_(stack, cell, fraction, slice, slice_fraction);
    return dot(blend.amplitude, blend.amplitude) / blend.mean_square;
}

/// Returns the complex amplitude of mean square 1 whose squared magnitude is that intensity, for
/// light whose fields add: `SpeckleStack::amplitude_at`.
fn tem00_stack_amplitude_at(
    stack: Tem00Stack,
    cell: vec2<i32>,
    fraction: vec2<f32>,
    slice: i32,
    slice_fraction: f32,
) -> vec2<f32> {
    let blend = tem00_stack_blend_(stack, cell, fraction, slice, slice_fraction);
    return blend.amplitude / sqrt(blend.mean_square);
}

/// Returns word `word` of the ChaCha8 stream `stream` of `seed`, low halves first: what the phasor
/// at the lattice point (word, stream) is made of, both modulo 2³². Streams from 2³² on are those
/// of the magnitudes.
fn tem00_phasor_word(seed: vec2<u32>, stream: vec2<u32>, word: u32) -> u32 {
    var words = tem00_phasor_words(seed, stream, word / 16u);
    return words[(word / 4u) % 4u][word % 4u];
}

/// Returns the words 16 `block` to 16 `block` + 15 of a stream, four by four.
fn tem00_phasor_words(seed: vec2<u32>, stream: vec2<u32>, block: u32) -> array<vec4<u32>, 4> {
    // "expand 32-byte k", then the key: the seed and "tem00 speckle phasors v1".
    let start = array<vec4<u32>, 4>(
        vec4<u32>(0x61707865u, 0x3320646eu, 0x79622d32u, 0x6b206574u),
        vec4<u32>(seed, 0x306d6574u, 0x70732030u),
        vec4<u32>(0x6c6b6365u, 0x68702065u, 0x726f7361u, 0x31762073u),
        vec4<u32>(block, 0u, stream),
    );
    var state = start;
    for (var i = 0u; i < 4u; i += 1u) {
        state = tem00_quarters_(state);
        // The diagonals become columns, and columns again.
        state = array<vec4<u32>, 4>(state[0], state[1].yzwx, state[2].zwxy, state[3].wxyz);
        state = tem00_quarters_(state);
        state = array<vec4<u32>, 4>(state[0], state[1].wxyz, state[2].zwxy, state[3].yzwx);
    }
    return array<vec4<u32>, 4>(
        state[0] + start[0],
        state[1] + start[1],
        state[2] + start[2],
        state[3] + start[3],
    );
}

/// Returns exp(2πi · word / 2³²), within 1.2e-7.
fn tem00_unit_phasor(word: u32) -> vec2<f32> {
    // The nearest quarter turn and the angle from it, in [−π/4, π/4), of which sine and cosine are
    // Taylor's series.
    let quarter = (word + 0x20000000u) >> 30u;
    let a = 1.4629180792671596e-9 * f32(bitcast<i32>(word - (quarter << 30u)));
    let a2 = a * a;
    let sine = a
        - a * a2 * (1.0 / 6.0 - a2 * (1.0 / 120.0 - a2 * (1.0 / 5040.0 - a2 * (1.0 / 362880.0))));
    let cosine = 1.0 - a2 * (0.5 - a2 * (1.0 / 24.0 - a2 * (1.0 / 720.0 - a2 * (1.0 / 40320.0))));
    let phasor = select(vec2<f32>(cosine, sine), vec2<f32>(sine, cosine), (quarter & 1u) == 1u);
    // The real part is negative in the quarters 1 and 2, the imaginary part in 2 and 3.
    let negative = (vec2<u32>(quarter + 1u, quarter) & vec2<u32>(2u)) != vec2<u32>(0u);
    return select(phasor, -phasor, negative);
}

/// Returns √(−ln((word + ½) / 2³²)), whose square is exponential with mean 1.
fn tem00_rayleigh_magnitude(word: u32) -> f32 {
    if word >= 0x80000000u {
        // −ln(1 − x) = 2 artanh(x / (2 − x)), from the exact distance x from 1.
        let x = (f32(~word) + 0.5) * 2.3283064365386963e-10;
        return sqrt(2.0 * tem00_artanh_(x / (2.0 - x)));
    }
    // m · 2ⁿ with m in [√½, √2).
    let bits = bitcast<u32>(f32(word) + 0.5) - 0x3f3504f3u;
    let m = bitcast<f32>((bits & 0x007fffffu) + 0x3f3504f3u);
    let exponent = f32((bitcast<i32>(bits) >> 23u) - 32);
    return sqrt(-0.6931471805599453 * exponent - 2.0 * tem00_artanh_((m - 1.0) / (m + 1.0)));
}

/// Returns the phasor at the lattice point `k`: of magnitude 1, or circular Gaussian of mean
/// square 1.
fn tem00_phasor(seed: vec2<u32>, k: vec2<i32>, gaussian: bool) -> vec2<f32> {
    let at = bitcast<vec2<u32>>(k);
    let phasor = tem00_unit_phasor(tem00_phasor_word(seed, vec2<u32>(at.y, 0u), at.x));
    if !gaussian {
        return phasor;
    }
    return tem00_rayleigh_magnitude(tem00_phasor_word(seed, vec2<u32>(at.y, 1u), at.x)) * phasor;
}

/// Returns the point of a lattice that closes after `period` points, below 2³¹, nearest to the
/// origin; 0 stands for 2³² points, after which phasors repeat by themselves.
fn tem00_lattice_nearest(k: i32, period: u32) -> i32 {
    if period == 0u {
        return k;
    }
    let point = tem00_wrapped_(k, period);
    return i32(point) - select(0, i32(period), point >= period - point);
}

/// Returns `count` / `period` turns in units of 2⁻³², within two of them, for count < period ≤ 2²².
fn tem00_turns(count: u32, period: u32) -> u32 {
    let unit = 0xffffffffu / period;
    let rest = 0u - unit * period;
    return count * unit + u32(f32(count) * f32(rest) / f32(period));
}

/// Returns exp(−2πi (`own` mod `done`) r / (`done` · `radix`)): what the thread `own` of a stage
/// multiplies its value r by.
fn tem00_twiddle(own: u32, r: u32, done: u32, radix: u32) -> vec2<f32> {
    return tem00_unit_phasor(0u - tem00_turns(own % done * r, done * radix));
}

/// Returns the point of the line that the thread `own` of a stage writes its value r to.
fn tem00_stockham(own: u32, r: u32, done: u32, radix: u32) -> u32 {
    let angle = own % done;
    return (own - angle) * radix + angle + r * done;
}

/// Returns exp(−2πi corner · cell / size): what moves a pupil whose box was at the corner of the
/// array, and begins at `corner` modulo `size` from its centre, to zero frequency.
fn tem00_centring(corner: vec2<u32>, cell: vec2<u32>, size: vec2<u32>) -> vec2<f32> {
    let turns = vec2<u32>(corner.x * cell.x % size.x, corner.y * cell.y % size.y);
    return tem00_unit_phasor(0u - tem00_turns(turns.x, size.x) - tem00_turns(turns.y, size.y));
}

/// Returns Σ v[j] exp(−2πi j k / 2), and so on for 3 to 16 values.
fn tem00_dft2(v: array<vec2<f32>, 2>) -> array<vec2<f32>, 2> {
    return array<vec2<f32>, 2>(v[0] + v[1], v[0] - v[1]);
}

fn tem00_dft3(v: array<vec2<f32>, 3>) -> array<vec2<f32>, 3> {
    let sum = v[1] + v[2];
    let middle = v[0] - 0.5 * sum;
    let side = 0.8660254037844386 * tem00_turned_back_(v[1] - v[2]);
    return array<vec2<f32>, 3>(v[0] + sum, middle + side, middle - side);
}

fn tem00_dft4(v: array<vec2<f32>, 4>) -> array<vec2<f32>, 4> {
    let a = v[0] + v[2];
    let b = v[0] - v[2];
    let c = v[1] + v[3];
    let d = tem00_turned_back_(v[1] - v[3]);
    return array<vec2<f32>, 4>(a + c, b + d, a - c, b - d);
}

fn tem00_dft5(v: array<vec2<f32>, 5>) -> array<vec2<f32>, 5> {
    let cosine = vec2<f32>(0.30901699437494745, -0.8090169943749475);
    let sine = vec2<f32>(0.9510565162951535, 0.5877852522924731);
    let outer = v[1] + v[4];
    let inner = v[2] + v[3];
    let outer_side = tem00_turned_back_(v[1] - v[4]);
    let inner_side = tem00_turned_back_(v[2] - v[3]);
    let a = v[0] + cosine.x * outer + cosine.y * inner;
    let b = v[0] + cosine.y * outer + cosine.x * inner;
    let c = sine.x * outer_side + sine.y * inner_side;
    let d = sine.y * outer_side - sine.x * inner_side;
    return array<vec2<f32>, 5>(v[0] + outer + inner, a + c, b + d, b - d, a - c);
}

fn tem00_dft8(v: array<vec2<f32>, 8>) -> array<vec2<f32>, 8> {
    let half = 0.7071067811865476;
    let even = tem00_dft4(array<vec2<f32>, 4>(v[0], v[2], v[4], v[6]));
    let odd = tem00_dft4(array<vec2<f32>, 4>(v[1], v[3], v[5], v[7]));
    let b = half * (odd[1] + tem00_turned_back_(odd[1]));
    let c = tem00_turned_back_(odd[2]);
    let d = half * (tem00_turned_back_(odd[3]) - odd[3]);
    return array<vec2<f32>, 8>(
        even[0] + odd[0], even[1] + b, even[2] + c, even[3] + d,
        even[0] - odd[0], even[1] - b, even[2] - c, even[3] - d,
    );
}

fn tem00_dft16(v: array<vec2<f32>, 16>) -> array<vec2<f32>, 16> {
    let c = 0.9238795325112867;
    let s = 0.3826834323650898;
    let half = 0.7071067811865476;
    let even = tem00_dft8(array<vec2<f32>, 8>(v[0], v[2], v[4], v[6], v[8], v[10], v[12], v[14]));
    let odd = tem00_dft8(array<vec2<f32>, 8>(v[1], v[3], v[5], v[7], v[9], v[11], v[13], v[15]));
    let a = tem00_complex_product(odd[1], vec2<f32>(c, -s));
    let b = half * (odd[2] + tem00_turned_back_(odd[2]));
    let d = tem00_complex_product(odd[3], vec2<f32>(s, -c));
    let e = tem00_turned_back_(odd[4]);
    let f = tem00_complex_product(odd[5], vec2<f32>(-s, -c));
    let g = half * (tem00_turned_back_(odd[6]) - odd[6]);
    let h = tem00_complex_product(odd[7], vec2<f32>(-c, -s));
    return array<vec2<f32>, 16>(
        even[0] + odd[0], even[1] + a, even[2] + b, even[3] + d,
        even[4] + e, even[5] + f, even[6] + g, even[7] + h,
        even[0] - odd[0], even[1] - a, even[2] - b, even[3] - d,
        even[4] - e, even[5] - f, even[6] - g, even[7] - h,
    );
}

/// Returns the product of two complex numbers.
fn tem00_complex_product(a: vec2<f32>, b: vec2<f32>) -> vec2<f32> {
    return vec2<f32>(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x);
}

/// −i z.
fn tem00_turned_back_(z: vec2<f32>) -> vec2<f32> {
    return vec2<f32>(z.y, -z.x);
}

/// An amplitude and its expected square.
struct Tem00Blend_ {
    amplitude: vec2<f32>,
    mean_square: f32,
}

/// The sample below and the fraction from it for which taps stand.
struct Tem00Place_ {
    cell: vec2<u32>,
    fraction: vec2<f32>,
}

fn tem00_stack_blend_(
    stack: Tem00Stack,
    cell: vec2<i32>,
    fraction: vec2<f32>,
    slice: i32,
    slice_fraction: f32,
) -> Tem00Blend_ {
    let place = Tem00Place_(
        vec2<u32>(tem00_wrapped_(cell.x, stack.size.x), tem00_wrapped_(cell.y, stack.size.y)),
        fraction,
    );
    let here = tem00_wrapped_(slice, stack.slices);
    let own = tem00_slice_(stack, here, place);
    if stack.slices == 1u || slice_fraction <= 0.0 {
        return own;
    }
    let next = tem00_slice_(stack, select(here + 1u, 0u, here + 1u == stack.slices), place);
    let join = tem00_stack_law(here, 13u);
    let turn = tem00_unit_phasor(tem00_join_phase_(stack, join.xy, place));
    let turned = tem00_complex_product(turn, next.amplitude);
    let f = slice_fraction;
    let g = 1.0 - f;
    let both = tem00_covariance_(here, join.z != 0.0, place.fraction);
    return Tem00Blend_(
        g * own.amplitude + f * turned,
        g * g * own.mean_square + f * f * next.mean_square + 2.0 * f * g * both,
    );
}

fn tem00_slice_(stack: Tem00Stack, slice: u32, place: Tem00Place_) -> Tem00Blend_ {
    let p = place.fraction * (1.0 - place.fraction);
    let square = mat4x4<f32>(
        tem00_stack_law(slice, 0u),
        tem00_stack_law(slice, 1u),
        tem00_stack_law(slice, 2u),
        tem00_stack_law(slice, 3u),
    );
    let mean_square = dot(square * tem00_powers_(p.y), tem00_powers_(p.x));
    return Tem00Blend_(tem00_interpolated_(stack, slice, place), mean_square);
}

/// The covariance of the amplitudes of a slice and the next; the odd shapes vanish behind a
/// symmetric pupil.
fn tem00_covariance_(slice: u32, odd: bool, fraction: vec2<f32>) -> f32 {
    let p = fraction * (1.0 - fraction);
    let x = tem00_powers_(p.x);
    let y = tem00_powers_(p.y);
    let even = mat4x4<f32>(
        tem00_stack_law(slice, 4u),
        tem00_stack_law(slice, 5u),
        tem00_stack_law(slice, 6u),
        tem00_stack_law(slice, 7u),
    );
    var sum = dot(even * y, x);
    if odd {
        let o = p * (1.0 - 2.0 * fraction);
        let ox = vec2<f32>(o.x, o.x * p.x);
        let oy = vec2<f32>(o.y, o.y * p.y);
        sum +=
            oy.x * dot(tem00_stack_law(slice, 8u), x) + oy.y * dot(tem00_stack_law(slice, 9u), x);
        // Two rows of the odd shapes of x in each: those of 1 and p, of p² and p³, and of the odd
        // shapes of y.
        sum += dot(tem00_stack_law(slice, 10u), vec4<f32>(y.x * ox, y.y * ox));
        sum += dot(tem00_stack_law(slice, 11u), vec4<f32>(y.z * ox, y.w * ox));
        sum += dot(tem00_stack_law(slice, 12u), vec4<f32>(oy.x * ox, oy.y * ox));
    }
    return sum;
}

fn tem00_powers_(p: f32) -> vec4<f32> {
    return vec4<f32>(1.0, p, p * p, p * p * p);
}

/// −step · r / Q turns in units of 2⁻³²: that of the sample by whole numbers, that of the fraction
/// small.
fn tem00_join_phase_(stack: Tem00Stack, step: vec2<f32>, place: Tem00Place_) -> u32 {
    let whole = vec2<u32>(
        tem00_wrapped_(i32(step.x), stack.size.x) * place.cell.x % stack.size.x,
        tem00_wrapped_(i32(step.y), stack.size.y) * place.cell.y % stack.size.y,
    );
    let turns = tem00_turns(whole.x, stack.size.x) + tem00_turns(whole.y, stack.size.y);
    let small = dot(step / vec2<f32>(stack.size), place.fraction);
    // Half the units, so that half a turn fits.
    return 0u - turns - (bitcast<u32>(i32((small - round(small)) * 2147483648.0)) << 1u);
}

fn tem00_interpolated_(stack: Tem00Stack, slice: u32, place: Tem00Place_) -> vec2<f32> {
    let cell = place.cell;
    let next = vec2<u32>(
        select(cell.x + 1u, 0u, cell.x + 1u == stack.size.x),
        select(cell.y + 1u, 0u, cell.y + 1u == stack.size.y),
    );
    let f = place.fraction;
    let columns = tem00_around_(cell.x, next.x, stack.size.x);
    let rows = tem00_around_(cell.y, next.y, stack.size.y);
    let x = tem00_cubic_weights_(f.x);
    let y = tem00_cubic_weights_(f.y);
    return y.x * tem00_row_(slice, rows.x, columns, x) + y.y * tem00_row_(slice, rows.y, columns, x)
        + y.z * tem00_row_(slice, rows.z, columns, x) + y.w * tem00_row_(slice, rows.w, columns, x);
}

/// The four samples on the torus about the way from `cell` to `next`.
fn tem00_around_(cell: u32, next: u32, size: u32) -> vec4<u32> {
    return vec4<u32>(
        select(cell - 1u, size - 1u, cell == 0u),
        cell,
        next,
        select(next + 1u, 0u, next + 1u == size),
    );
}

fn tem00_row_(slice: u32, row: u32, columns: vec4<u32>, weights: vec4<f32>) -> vec2<f32> {
    return weights.x * tem00_stack_coefficient(slice, vec2<u32>(columns.x, row))
        + weights.y * tem00_stack_coefficient(slice, vec2<u32>(columns.y, row))
        + weights.z * tem00_stack_coefficient(slice, vec2<u32>(columns.z, row))
        + weights.w * tem00_stack_coefficient(slice, vec2<u32>(columns.w, row));
}

/// The cubic B-spline at the four samples about the fraction `f` between the second and the third.
fn tem00_cubic_weights_(f: f32) -> vec4<f32> {
    let g = 1.0 - f;
    return vec4<f32>(
        (1.0 / 6.0) * g * g * g,
        2.0 / 3.0 - 0.5 * f * f * (2.0 - f),
        2.0 / 3.0 - 0.5 * g * g * (2.0 - g),
        (1.0 / 6.0) * f * f * f,
    );
}

/// n modulo `period`, in [0, period).
fn tem00_wrapped_(n: i32, period: u32) -> u32 {
    let rest = n % i32(period);
    return u32(select(rest, rest + i32(period), rest < 0));
}

/// artanh s for |s| ≤ 1/3 by its series, whose first term left out is 2e-10 of it.
fn tem00_artanh_(s: f32) -> f32 {
    let s2 = s * s;
    let tail = 1.0 / 9.0
        + s2 * (1.0 / 11.0 + s2 * (1.0 / 13.0 + s2 * (1.0 / 15.0 + s2 * (1.0 / 17.0))));
    return s + s * s2 * (1.0 / 3.0 + s2 * (0.2 + s2 * (1.0 / 7.0 + s2 * tail)));
}

fn tem00_quarters_(state: array<vec4<u32>, 4>) -> array<vec4<u32>, 4> {
    var a = state[0] + state[1];
    var d = tem00_turned_(state[3] ^ a, 16u);
    var c = state[2] + d;
    var b = tem00_turned_(state[1] ^ c, 12u);
    a += b;
    d = tem00_turned_(d ^ a, 8u);
    c += d;
    b = tem00_turned_(b ^ c, 7u);
    return array<vec4<u32>, 4>(a, b, c, d);
}

fn tem00_turned_(x: vec4<u32>, bits: u32) -> vec4<u32> {
    return (x << vec4<u32>(bits)) | (x >> vec4<u32>(32u - bits));
}
