use core::f64::consts::PI;

use tem00_config::ConfigError;
use tem00_testkit::rows;

use super::*;
use crate::{
    file::tests::{PLAIN, changed},
    parse_setup, parse_setup_with,
};

fn read(design: &str) -> Result<DesignSearch, ConfigError> {
    let text = changed(PLAIN, &[("exposure", "1e-3")]) + design;
    let read =
        |document: &Document<'_>, setup: &crate::Setup| read_design(document, setup.description());
    parse_setup_with(&text, read).map(|(_, search)| search)
}

#[test]
fn lists_and_ranges_are_read_with_their_units() {
    let search = read(
        r#"
        [design]
        objective = "expanded_uncertainty"
        max_setups = 100
        [design.vary]
        f_number = { from = 4, to = 16, steps = 3, scale = "log" }
        angle = ["30 deg", 1]
        exposure = { from = "1 ms", to = "2 ms", steps = 2 }
        [design.require]
        range = "20 mm"
        power = "5 mW"
        "#,
    )
    .unwrap();
    assert_eq!(search.count(), 12);
    let question = search.question();
    assert_eq!(question.objective, Objective::ExpandedUncertainty);
    let values = |index: usize| question.sweeps[index].values();
    assert!((values(0)[1] - 8.0).abs() < 1e-14, "{:?}", values(0));
    assert_eq!(values(1), [PI / 6.0, 1.0]);
    assert_eq!(values(2), [1e-3, 2e-3]);
    let bounds: Vec<_> = question
        .constraints
        .iter()
        .map(|constraint| (constraint.figure, constraint.bound))
        .collect();
    let expected = [
        (DesignFigure::Range, 20e-3),
        (DesignFigure::Power, 5e-3),
        (DesignFigure::Saturation, 0.9),
        (DesignFigure::GrainSaturation, 1.0),
        (DesignFigure::Signal, 10.0),
    ];
    assert_eq!(bounds, expected);
}

#[test]
fn what_cannot_be_is_refused_where_it_stands() {
    let table = r#"
        => no section [design] => -
        [design]\n => [design.vary] => 1:1
        [design.vary]\n => varied => 1:1
        [design.vary]\nf_numbr = [1]\n => did you mean `f_number` => 2:1
        [design.vary]\nline_width = [1e-4]\n => did you mean `line_thickness` => 2:1
        [design.vary]\nf_number = 8\n => a list of values => 2:12
        [design.vary]\nf_number = []\n => a list of values => 2:12
        [design.vary]\nangle = ["3 mm"]\n => an angle => 2:10
        [design.vary]\nangle = [1, -1]\n => positive => 2:13
        [design.vary]\nf_number = { from = 4, steps = 3 }\n => `to` => 2:12
        [design.vary]\nf_number = { from = 4, to = 8, steps = 1 }\n => from 2 to => 2:40
        [design.vary]\nf_number = { from = 4, to = 8, steps = 3, scale = "lin" }\n => did you mean "linear" => 2:51
        [design]\nmax_setups = 3\n[design.vary]\nf_number = [1, 2, 3, 4]\n => got 4 => 3:1
        [design.vary]\nf_number = [8]\n[design.require]\nrange = "-1 mm"\n => positive => 4:9
        [design.vary]\nf_number = [8]\n[design.require]\nrang = 1\n => did you mean `range` => 4:1
    "#;
    let before = PLAIN.lines().count();
    for [text, expected, position] in rows(table) {
        let error = read(&text).unwrap_err();
        let message = format!("{error} {}", error.help().unwrap_or_default());
        assert!(message.contains(&expected), "{text}: {message}");
        let found = error
            .line_column()
            .map(|(line, column)| format!("{}:{column}", line - before));
        assert_eq!(found.unwrap_or("-".into()), position, "{text}: {message}");
    }
}

#[test]
fn every_set_up_of_a_search_can_be_written_and_read_back() {
    let text = "[design.vary]\nf_number = { from = 4, to = 16, steps = 3, scale = \"log\" }\n\
                angle = { from = 0.3, to = 1, steps = 4 }\nwavelength = [405e-9, 650e-9]\n";
    let search = read(text).unwrap();
    for index in 0..search.count() {
        let description = search.description(index);
        let setup = parse_setup(&description.to_toml()).unwrap();
        assert_eq!(setup.description(), &description, "set-up {index}");
    }
}
