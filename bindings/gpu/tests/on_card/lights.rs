//! Laser spots and laser lines on a card against the lights in double precision.

#[path = "../../../../crates/light/tem00-beam/tests/closed_forms/comparison.rs"]
mod comparison;
#[path = "../../../../crates/light/tem00-beam/tests/closed_forms/samples.rs"]
mod samples;

use core::mem::{offset_of, size_of};

use tem00_beam::{Emitter, LineLight, closed_form::WGSL};
use tem00_gpu::Gpu;

use crate::kernel::evaluate;
use comparison::{Answer, Judge};
use samples::{Sample, lines, single_precision, spots};

/// The numbers of a light, at most, and a point.
const INPUTS: usize = 31;

/// Reads vectors and the parts of lights.
const HOST: &str = "
    fn vector(i: u32) -> vec3<f32> { return vec3(input(i), input(i + 1u), input(i + 2u)); }
    fn axis(i: u32) -> Tem00Axis { return Tem00Axis(input(i), input(i + 1u), input(i + 2u), 0.0); }
";

/// The numbers that all lights begin with.
const BEGINNING: &str = "
    vector(0u), input(3u), vector(4u), input(7u), vector(8u), input(11u), vector(12u), input(15u)";

/// A kind of light: its name in functions and structs, and the rest of its numbers.
struct Kind {
    function: &'static str,
    structure: &'static str,
    rest: &'static str,
}

const SPOT: Kind = Kind {
    function: "spot",
    structure: "Tem00SpotLight",
    rest: "axis(16u), axis(20u)",
};
const LINE: Kind = Kind {
    function: "line",
    structure: "Tem00LineLight",
    rest: "axis(16u), input(20u), input(21u), input(22u), input(23u), input(24u), input(25u), \
        input(26u), 0.0",
};

/// Calls `tem00_<kind>_irradiance` and `tem00_<kind>_next_event` at all points.
fn answers(gpu: &Gpu, kind: &Kind, fields: &[f32], points: &[[f32; 3]]) -> Vec<Answer> {
    let Kind {
        function,
        structure,
        rest,
    } = kind;
    let body = format!(
        "let light = {structure}({BEGINNING}, {rest});
        let p = vector(28u);
        output(0u, tem00_{function}_irradiance(light, p));
        let event = tem00_{function}_next_event(light, p);
        for (var i = 0u; i < 3u; i++) {{
            output(1u + i, event.point[i]);
            output(5u + i, event.wi[i]);
        }}
        output(4u, event.distance);
        output(8u, event.e_perp);"
    );
    let inputs: Vec<[f32; INPUTS]> = points
        .iter()
        .map(|point| {
            let mut input = [0.0; INPUTS];
            input[..fields.len()].copy_from_slice(fields);
            input[28..].copy_from_slice(point);
            input
        })
        .collect();
    let outputs: Vec<[f32; 9]> = evaluate(gpu, &format!("{WGSL}{HOST}"), &body, &inputs);
    outputs
        .into_iter()
        .map(|output| output.map(f64::from))
        .collect()
}

fn agree<L: Emitter>(kind: &Kind, samples: &[Sample<L>]) {
    let gpu = Gpu::new().expect("an adapter");
    for sample in samples {
        let mut judge = Judge::new(sample, f64::from(f32::EPSILON));
        let points: Vec<_> = sample.points.iter().map(|p| single_precision(*p)).collect();
        for (p, answer) in points
            .iter()
            .zip(answers(&gpu, kind, &sample.fields, &points))
        {
            judge.compare(p.map(f64::from), answer);
        }
        judge.finish();
    }
}

#[test]
fn spots_agree_with_the_light_in_double_precision() {
    agree(&SPOT, &spots());
}

#[test]
fn lines_agree_with_the_light_in_double_precision() {
    agree(&LINE, &lines());
}

#[test]
fn a_line_whose_profile_is_a_table_is_dark() {
    let gpu = Gpu::new().expect("an adapter");
    let sample = &lines()[0];
    let mut fields = sample.fields.clone();
    fields[offset_of!(LineLight, variable) / size_of::<f64>()] = 3.0;
    let points: Vec<_> = sample.points.iter().map(|p| single_precision(*p)).collect();
    for (p, answer) in points.iter().zip(answers(&gpu, &LINE, &fields, &points)) {
        assert!(answer.iter().all(|x| x.abs() <= 0.0), "{p:?}: {answer:?}");
    }
}

/// Evaluates points in the same directions as the sample's, up to 1e9 m away.
fn stays_finite<L: Emitter>(gpu: &Gpu, kind: &Kind, samples: &[Sample<L>]) {
    for sample in samples {
        let origin: [f64; 3] = core::array::from_fn(|i| f64::from(sample.fields[i]));
        let far = |p: &[f64; 3], scale: f64| {
            single_precision(core::array::from_fn(|i| {
                origin[i] + scale * (p[i] - origin[i])
            }))
        };
        let points: Vec<_> = sample.points[..200]
            .iter()
            .flat_map(|p| [1e3, 1e6, 1e9].map(|scale| far(p, scale)))
            .collect();
        let mut lit = 0;
        for (p, answer) in points
            .iter()
            .zip(answers(gpu, kind, &sample.fields, &points))
        {
            let finite = answer.iter().all(|x| x.is_finite());
            assert!(finite, "{} at {p:?}: {answer:?}", sample.name);
            lit += usize::from(answer[0] > 0.0);
        }
        assert!(lit >= 100, "{}: {lit} points were lit", sample.name);
    }
}

#[test]
fn far_points_have_finite_answers() {
    let gpu = Gpu::new().expect("an adapter");
    stays_finite(&gpu, &SPOT, &spots());
    stays_finite(&gpu, &LINE, &lines());
}

#[test]
fn the_complementary_error_function_is_as_exact_as_it_says() {
    let gpu = Gpu::new().expect("an adapter");
    let points: Vec<_> = (-1200..=1200_i16).map(|i| [f32::from(i) / 128.0]).collect();
    let values = evaluate(&gpu, WGSL, "output(0u, tem00_erfc_(input(0u)));", &points);
    for ([x], [got]) in points.iter().zip(values) {
        let (x, got) = (f64::from(*x), f64::from(got));
        let expected = libm::erfc(x);
        // Below the smallest normal number the digits run out.
        let tolerance = (4e-7 + 4e-7 * x * x) * expected + f64::from(f32::MIN_POSITIVE);
        let error = (got - expected).abs();
        assert!(error < tolerance, "x = {x}: {got:e}, not {expected:e}");
    }
}
