use core::mem::{offset_of, size_of};

use naga::valid::{Capabilities, ValidationFlags, Validator};
use naga::{Module, TypeInner};
use tem00_beam::closed_form::WGSL;
use tem00_beam::{Emitter, LineLight};

use super::comparison::{Answer, Judge};
use super::interpreter::{Value, call, load, type_of};
use super::layouts::{Layout, layouts};
use super::lights::{Sample, astigmatic_beams, lines, single_precision, spots};

fn module() -> Module {
    naga::front::wgsl::parse_str(WGSL)
        .unwrap_or_else(|error| panic!("{}", error.emit_to_string(WGSL)))
}

#[test]
fn the_source_is_valid_without_any_extension() {
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
    let result = validator.validate(&module());
    assert!(result.is_ok(), "{result:?}");
}

#[test]
fn the_source_has_no_bindings_and_a_prefix_on_every_name() {
    let module = module();
    assert!(module.global_variables.is_empty(), "no bindings");
    assert!(module.entry_points.is_empty(), "no entry points");
    for (_, function) in module.functions.iter() {
        let name = function.name.as_deref().unwrap();
        assert!(name.starts_with("tem00_"), "function {name}");
    }
    for name in module.types.iter().filter_map(|(_, ty)| ty.name.as_ref()) {
        assert!(name.starts_with("Tem00"), "struct {name}");
    }
}

fn layout(module: &Module, name: &str) -> Layout {
    match &module.types[type_of(module, name)].inner {
        TypeInner::Struct { members, span } => {
            let fields = members
                .iter()
                .map(|member| (member.name.clone().unwrap(), member.offset as usize));
            (fields.collect(), *span as usize)
        }
        other => panic!("{name} is {other:?}"),
    }
}

#[test]
fn structs_have_the_layout_of_their_counterparts() {
    let module = module();
    for (name, expected) in layouts() {
        assert_eq!(layout(&module, name), expected, "{name}");
    }
}

/// Calls `tem00_<kind>_irradiance` and `tem00_<kind>_next_event`.
fn evaluate(module: &Module, kind: &str, light: &Value, p: [f32; 3]) -> Answer {
    let arguments = [light.clone(), p.as_slice().into()];
    let query = |name: &str| call(module, &format!("tem00_{kind}_{name}"), &arguments).flatten();
    let mut numbers = query("irradiance");
    numbers.extend(query("next_event"));
    core::array::from_fn(|i| f64::from(numbers[i]))
}

fn agree<L: Emitter<f64>>(kind: &str, name: &str, samples: &[Sample<L>]) {
    let module = module();
    for sample in samples {
        let light = load(&module, type_of(&module, name), &sample.fields);
        let mut judge = Judge::new(sample, f64::from(f32::EPSILON));
        for p in &sample.points {
            let p = single_precision(*p);
            judge.compare(p.map(f64::from), evaluate(&module, kind, &light, p));
        }
        judge.finish();
    }
}

#[test]
fn spots_agree_with_the_light_in_double_precision() {
    agree("spot", "Tem00SpotLight", &spots());
}

#[test]
fn astigmatic_beams_agree_with_the_light_in_double_precision() {
    agree("astigmatic", "Tem00AstigmaticLight", &astigmatic_beams());
}

#[test]
fn lines_agree_with_the_light_in_double_precision() {
    agree("line", "Tem00LineLight", &lines());
}

#[test]
fn a_line_whose_profile_is_a_table_is_dark() {
    let module = module();
    let sample = &lines()[0];
    let mut fields = sample.fields.clone();
    let variable = offset_of!(LineLight<f32>, variable) / size_of::<f32>();
    fields[variable] = 3.0;
    let light = load(&module, type_of(&module, "Tem00LineLight"), &fields);
    for p in &sample.points {
        let answer = evaluate(&module, "line", &light, single_precision(*p));
        assert!(answer.iter().all(|x| x.abs() <= 0.0), "{p:?}: {answer:?}");
    }
}

/// Evaluates points in the same directions as the sample's, up to 1e9 m away.
fn stays_finite<L: Emitter<f64>>(kind: &str, name: &str, samples: &[Sample<L>]) {
    let module = module();
    for sample in samples {
        let light = load(&module, type_of(&module, name), &sample.fields);
        let origin: [f64; 3] = core::array::from_fn(|i| f64::from(sample.fields[i]));
        let mut lit = 0;
        for p in &sample.points[..200] {
            for scale in [1e3, 1e6, 1e9] {
                let far = core::array::from_fn(|i| origin[i] + scale * (p[i] - origin[i]));
                let answer = evaluate(&module, kind, &light, single_precision(far));
                let finite = answer.iter().all(|x| x.is_finite());
                assert!(finite, "{} at {far:?}: {answer:?}", sample.name);
                lit += usize::from(answer[0] > 0.0);
            }
        }
        assert!(lit >= 100, "{}: {lit} points were lit", sample.name);
    }
}

#[test]
fn far_points_have_finite_answers() {
    stays_finite("spot", "Tem00SpotLight", &spots());
    stays_finite("astigmatic", "Tem00AstigmaticLight", &astigmatic_beams());
    stays_finite("line", "Tem00LineLight", &lines());
}

#[test]
fn the_complementary_error_function_is_as_exact_as_it_says() {
    let module = module();
    for i in -1200..=1200_i16 {
        let x = f32::from(i) / 128.0;
        let got = call(&module, "tem00_erfc_", &[Value::Number(x)]).flatten()[0];
        let (x, expected) = (f64::from(x), libm::erfc(f64::from(x)));
        // Below the smallest normal number the digits run out.
        let tolerance = (4e-7 + 4e-7 * x * x) * expected + f64::from(f32::MIN_POSITIVE);
        let error = (f64::from(got) - expected).abs();
        assert!(error < tolerance, "x = {x}: {got:e}, not {expected:e}");
    }
}
