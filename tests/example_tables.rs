//! The CSV files that instruments write are read as they were meant, or refused.

#[path = "../examples/table/mod.rs"]
mod table;

use table::{parse, range, read};

/// Returns the columns of a table that is valid.
fn columns(text: &str) -> [Vec<f64>; 2] {
    parse(text).unwrap_or_else(|error| panic!("{text:?}: {error}"))
}

#[test]
fn all_common_separators_give_the_same_columns() {
    let expected = [vec![1.5, 2.0], vec![0.25, -3.0]];
    for text in [
        "1.5,0.25\n2,-3\n",
        "mm,mW\n1.5, 0.25\n\n2, -3",
        "mm;mW\r\n1,5;0,25\r\n2;-3\r\n",
        "1,5\t0,25\t7\n2,0\t-3\t8\n",
        "\u{feff}1.5,0.25\n# paused\n2,-3\n",
    ] {
        assert_eq!(columns(text), expected, "{text:?}");
    }
}

#[test]
fn what_is_no_row_of_numbers_is_refused_by_its_line() {
    for (text, line) in [
        ("1,2\n3\n", "2: "),
        ("mm,mW\n\n1,2\n3,nan\n", "4: "),
        ("1,oops\n1,2\n", "1: "),
        ("1,inf\n", "1: "),
        ("mm,mW\nmm,mW\n", "2: "),
    ] {
        let error = parse(text).expect_err(text);
        assert!(error.starts_with(line), "{text:?}: {error}");
        assert!(error.contains("two finite numbers"), "{text:?}: {error}");
    }
}

#[test]
fn a_failure_prints_its_message_and_no_struct() {
    let failure = read("no such file.csv").expect_err("it is not there");
    let printed = format!("{failure:?}");
    assert!(printed.starts_with("no such file.csv: "), "{printed}");
}

#[test]
fn a_range_does_not_depend_on_the_order() {
    for values in [[1.0, 2.0, 7.0], [7.0, 1.0, 2.0], [2.0, 7.0, 1.0]] {
        assert!(
            range(&values)
                .iter()
                .zip([1.0, 7.0])
                .all(|(a, b)| a.total_cmp(&b).is_eq()),
            "{values:?}"
        );
    }
}
