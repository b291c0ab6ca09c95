//! Random phasors, from seed and lattice point.

use core::f64::consts::TAU;

use rand_chacha::{
    ChaCha8Rng,
    rand_core::{Rng, SeedableRng},
};
use tem00_gpu::Gpu;
use tem00_speckle::closed_form::WGSL;

use crate::kernel::evaluate;

/// The hooks of a stack, which nothing here looks at.
const NO_STACK: &str = "
    fn tem00_stack_coefficient(slice: u32, cell: vec2<u32>) -> vec2<f32> { return vec2<f32>(0.0); }
    fn tem00_stack_law(slice: u32, row: u32) -> vec4<f32> { return vec4<f32>(0.0); }
";

const SEED: u64 = 0x0123_4567_89ab_cdef;

/// Words of all sizes, the ends and the quarter turns among them.
fn words() -> Vec<u32> {
    let ends = [
        0,
        1,
        2,
        1 << 23,
        1 << 29,
        1 << 30,
        3 << 29,
        1 << 31,
        3 << 30,
    ];
    let near = ends
        .iter()
        .flat_map(|&word: &u32| [word.wrapping_sub(1), word, word + 1]);
    let mut generator = ChaCha8Rng::seed_from_u64(1);
    near.chain((0..50_000).map(|_| generator.next_u32()))
        .collect()
}

fn on_card<const INPUTS: usize, const OUTPUTS: usize>(
    body: &str,
    inputs: &[[u32; INPUTS]],
) -> Vec<[f32; OUTPUTS]> {
    let gpu = Gpu::new().expect("an adapter");
    let bits: Vec<_> = inputs
        .iter()
        .map(|input| input.map(f32::from_bits))
        .collect();
    let source = format!(
        "{WGSL}{NO_STACK}
        fn word(i: u32) -> u32 {{ return bitcast<u32>(input(i)); }}"
    );
    evaluate(&gpu, &source, body, &bits)
}

/// A whole number from its halves, the upper first.
fn joined([high, low]: [f32; 2]) -> f64 {
    65_536.0 * f64::from(high) + f64::from(low)
}

#[test]
fn words_are_those_of_chacha8() {
    let mut key = [0; 32];
    key[..8].copy_from_slice(&SEED.to_le_bytes());
    key[8..].copy_from_slice(b"tem00 speckle phasors v1");
    let mut generator = ChaCha8Rng::from_seed(key);
    let mut at = |stream: [u32; 2], word: u32| {
        generator.set_stream(u64::from(stream[0]) | u64::from(stream[1]) << 32);
        generator.set_word_pos(u128::from(word));
        generator.next_u32()
    };
    let mut inputs = Vec::new();
    for word in words().into_iter().take(2_000) {
        inputs.push([word.rotate_left(7), 0, word]);
        inputs.push([word, 1, word.reverse_bits()]);
    }
    // Halves travel as bits of numbers, of which a device may flush or quiet some.
    let body = format!(
        "let seed = vec2<u32>({}u, {}u);
        let got = tem00_phasor_word(seed, vec2<u32>(word(0), word(1)), word(2));
        output(0, f32(got >> 16u));
        output(1, f32(got & 0xffffu));",
        SEED & 0xffff_ffff,
        SEED >> 32
    );
    let halves: Vec<[f32; 2]> = on_card(&body, &inputs);
    for ([low, high, word], got) in inputs.into_iter().zip(halves) {
        let error = joined(got) - f64::from(at([low, high], word));
        assert!(
            error.abs() < 0.5,
            "word {word} of stream {low} + {high} · 2³²: off by {error}"
        );
    }
}

#[test]
fn phasors_have_the_angle_and_the_logarithm_of_their_word() {
    let words: Vec<_> = words().into_iter().map(|word| [word]).collect();
    let body = "let z = tem00_unit_phasor(word(0)); output(0, z.x); output(1, z.y);
        output(2, tem00_rayleigh_magnitude(word(0)));";
    let phasors: Vec<[f32; 3]> = on_card(body, &words);
    for ([word], got) in words.into_iter().zip(phasors) {
        let [x, y, magnitude] = got.map(f64::from);
        let (sin, cos) = (TAU * f64::from(word) / 4_294_967_296.0).sin_cos();
        let error = (x - cos).hypot(y - sin);
        assert!(error < 1.2e-7, "{error:e} at {word:#x}");
        // −ln(1 − x) from the distance to 1, which 1 − x would round.
        let above = (f64::from(!word) + 0.5) / 4_294_967_296.0;
        let error = (magnitude / (-(-above).ln_1p()).sqrt() - 1.0).abs();
        assert!(error < 2e-7, "magnitude: {error:e} at {word:#x}");
    }
}

#[test]
fn shares_of_a_turn_are_as_exact_as_their_units() {
    let mut inputs = Vec::new();
    for period in [1, 2, 3, 250, 2_048, 6_250, 24_000, 32_768, 3_999_971] {
        inputs.extend((0..1_000).map(|i| [(i * 7_919_u32) % period, period]));
        inputs.push([period - 1, period]);
    }
    let body = "let turns = tem00_turns(word(0), word(1));
        output(0, f32(turns >> 16u)); output(1, f32(turns & 0xffffu));";
    let halves: Vec<[f32; 2]> = on_card(body, &inputs);
    for ([count, period], [high, low]) in inputs.into_iter().zip(halves) {
        let got = joined([high, low]);
        let expected = f64::from(count) / f64::from(period) * 4_294_967_296.0;
        assert!((got - expected).abs() < 2.0, "{count} of {period}: {got}");
    }
}

#[test]
fn lattices_close_about_their_origin() {
    let points = [0, 1, 5, 6, 11, 12, 13, -1, -6, -7, i32::MAX, i32::MIN];
    let inputs: Vec<_> = points
        .iter()
        .flat_map(|k: &i32| [0, 12, 13, 1 << 30].map(|period| [k.cast_unsigned(), period]))
        .collect();
    let body = "let k = tem00_lattice_nearest(bitcast<i32>(word(0)), word(1));
        output(0, f32(k & 0xffff)); output(1, f32(k >> 16u));";
    let halves: Vec<[f32; 2]> = on_card(body, &inputs);
    for ([k, period], [low, high]) in inputs.into_iter().zip(halves) {
        let k = i64::from(k.cast_signed());
        let side = if period == 0 {
            1 << 32
        } else {
            i64::from(period)
        };
        let point = k.rem_euclid(side);
        let expected = if point < side - point {
            point
        } else {
            point - side
        };
        let error = joined([high, low]) - expected as f64;
        assert!(error.abs() < 0.5, "{k} of {period}: off by {error}");
    }
}
