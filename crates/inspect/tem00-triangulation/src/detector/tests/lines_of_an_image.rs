use tem00_numerics::cast::to_usize;
use tem00_testkit::on_threads;

use super::*;

const SIGMA: f64 = 2.5;
const WINDOW: usize = 25;

/// An image of lines whose positions depend on the column; a line is where its position is a
/// number.
fn image(width: usize, height: usize, lines: &[&dyn Fn(f64) -> Option<f64>]) -> Grid<f32> {
    let columns: Vec<Vec<f32>> = (0..width)
        .map(|x| {
            let positions = lines.iter().filter_map(|line| line(x as f64 + 0.5));
            positions.fold(vec![5.0; height], |sum, position| {
                let line = integrated(height, position, SIGMA);
                sum.iter().zip(line).map(|(a, b)| a + b).collect()
            })
        })
        .collect();
    Grid::from_fn(width, height, |x, y| columns[x][y])
}

fn finder(method: LineMethod, max_lines: usize) -> LineDetector {
    let settings = DetectorSettings {
        method,
        window: WINDOW,
        max_lines,
        ..DetectorSettings::default()
    };
    LineDetector::new(settings).unwrap()
}

/// The positions of a line by column, `None` where it has no point.
fn of_line(points: &[Vec<LinePoint>], line: usize) -> Vec<Option<f64>> {
    let in_column = |column: &Vec<LinePoint>| {
        let mut points = column.iter().filter(|point| point.line == line);
        points.next().map(|point| point.position)
    };
    points.iter().map(in_column).collect()
}

fn count(points: &[Vec<LinePoint>]) -> usize {
    let lines = points.iter().flatten().map(|point| point.line + 1);
    lines.max().unwrap_or(0)
}

#[test]
fn two_lines_keep_their_numbers_though_one_ends() {
    let upper = |x: f64| Some(50.0 + 0.2 * x);
    let lower = |x: f64| (!(60.0..90.0).contains(&x) && x < 150.0).then_some(140.0 - 0.1 * x);
    let image = image(200, 200, &[&upper, &lower]);
    let points = finder(LineMethod::CentreOfGravity, 4).detect(&image);
    assert_eq!(count(&points), 2, "a gap of 30 columns is bridged");
    let (first, second) = (of_line(&points, 0), of_line(&points, 1));
    for x in 0..200 {
        let at = x as f64 + 0.5;
        let near = |found: Option<f64>, position: Option<f64>| match (found, position) {
            (None, None) => true,
            // Rounding of a background of 5 and the light outside of the window, at five σ.
            (Some(found), Some(position)) => (found - position).abs() < 1e-3,
            _ => false,
        };
        assert!(near(first[x], upper(at)), "column {x}: {:?}", points[x]);
        assert!(near(second[x], lower(at)), "column {x}: {:?}", points[x]);
    }
}

#[test]
fn lines_that_cross_go_on_as_they_came() {
    let (down, up) = (
        |x: f64| Some(60.0 + 0.4 * x),
        |x: f64| Some(140.0 - 0.4 * x),
    );
    let image = image(200, 200, &[&down, &up]);
    let points = finder(LineMethod::CentreOfGravity, 2).detect(&image);
    assert_eq!(count(&points), 2, "two lines");
    // Their mean positions are equal but for where they are seen as one: whichever is first.
    let falls = of_line(&points, 0)[0].is_some_and(|position| position < 100.0);
    let (first, second) = (of_line(&points, 0), of_line(&points, 1));
    let (falling, rising) = if falls {
        (first, second)
    } else {
        (second, first)
    };
    for x in (0..200).filter(|x| !(60..140).contains(x)) {
        let at = x as f64 + 0.5;
        for (found, position) in [(falling[x], down(at)), (rising[x], up(at))] {
            let off = (found.unwrap() - position.unwrap()).abs();
            assert!(off < 0.05, "column {x}: {:?}", points[x]);
        }
    }
    let close = points[75].iter().chain(&points[125]);
    let crowded = close.filter(|point| point.validity == Validity::Crowded);
    assert_eq!(crowded.count(), 4, "windows end where the next line begins");
}

/// A number from −½ to ½ for each column, by multiplicative hashing (Knuth, *The Art of Computer
/// Programming*, vol. 3, § 6.4).
fn scatter(x: f64) -> f64 {
    let column = u32::try_from(to_usize(x)).unwrap();
    let hashed = column.wrapping_mul(2_654_435_761).rotate_right(15);
    f64::from(hashed.wrapping_mul(2_654_435_761) >> 16) / 65_536.0 - 0.5
}

#[test]
fn a_line_that_has_ended_takes_no_points_of_one_that_goes_on() {
    // The first ends at column 80; the straight line through its end crosses the second at column
    // 104, for whose points it is within reach from the second column on. Both scatter as lines
    // under speckle do.
    let ended = |x: f64| (x < 80.0).then(|| 60.0 + 0.5 * x + 0.8 * scatter(x));
    for seen_in in [
        |_: f64| true,
        |x: f64| !scatter(7.0 * x).is_sign_positive() || x < 92.0,
    ] {
        let second = |x: f64| (x >= 90.0 && seen_in(x)).then(|| 112.0 + 0.8 * scatter(3.0 * x));
        let image = image(150, 200, &[&ended, &second]);
        let points = finder(LineMethod::CentreOfGravity, 2).detect(&image);
        assert_eq!(count(&points), 2, "two lines");
        for (x, points) in points.iter().enumerate() {
            let at = x as f64 + 0.5;
            let expected: Vec<usize> = [ended(at), second(at)]
                .into_iter()
                .zip(0..)
                .filter_map(|(position, line)| position.map(|_| line))
                .collect();
            let found: Vec<usize> = points.iter().map(|point| point.line).collect();
            assert_eq!(found, expected, "column {x}");
        }
    }
}

#[test]
fn a_step_starts_another_line_and_the_upper_one_comes_first() {
    let step = |x: f64| Some(if x < 80.0 { 120.0 } else { 100.0 });
    let points = finder(LineMethod::CentreOfGravity, 1).detect(&image(150, 200, &[&step]));
    assert_eq!(
        count(&points),
        2,
        "20 pixels are more than a quarter of the window"
    );
    for (x, points) in points.iter().enumerate() {
        assert_eq!(
            points[0].line,
            usize::from(x < 80),
            "the upper part, {x}, first"
        );
    }
    let low = |x: f64| Some(if x < 80.0 { 104.0 } else { 100.0 });
    let points = finder(LineMethod::CentreOfGravity, 1).detect(&image(150, 200, &[&low]));
    assert_eq!(count(&points), 1, "4 pixels are less");
}

#[test]
fn short_lines_come_after_long_ones() {
    let speck = |x: f64| (40.0..45.0).contains(&x).then_some(30.0);
    let line = |_: f64| Some(120.0);
    let points = finder(LineMethod::CentreOfGravity, 3).detect(&image(150, 200, &[&speck, &line]));
    assert_eq!(count(&points), 2, "the line and the speck");
    let is_line = |points: &Vec<LinePoint>| points[points.len() - 1].line == 0;
    assert!(points.iter().all(is_line), "the line");
    assert_eq!(
        (points[42][0].line, points[42].len()),
        (1, 2),
        "the speck above"
    );
}

#[test]
fn steger_follows_slopes_along_their_normal() {
    // A straight line of the slope 0.5 is a ridge wherever one looks: only the step to it errs, by
    // δ³/s² = 0.6³/10.
    let line = |x: f64| Some(40.0 + 0.5 * x);
    let points = finder(LineMethod::Steger { sigma: 2.0 }, 1).detect(&image(120, 160, &[&line]));
    for (x, points) in points.iter().enumerate().skip(8).take(104) {
        let off = points[0].position - line(x as f64 + 0.5).unwrap();
        assert!(off.abs() < 0.02, "column {x}: {off}");
        assert_eq!(points[0].validity, Validity::Valid, "column {x}");
    }
    // A flat one is the same with neighbours and without.
    let image = image(30, 80, &[&|_| Some(40.3)]);
    let detector = finder(LineMethod::Steger { sigma: 2.0 }, 1);
    let column: Vec<f32> = (0..80).map(|y| image[(0, y)]).collect();
    let alone = detector.detect_column(&column)[0].position;
    let among = detector.detect(&image)[13][0].position;
    assert!((alone - among).abs() < 1e-12, "{alone} {among}");
}

#[test]
fn an_image_has_the_same_lines_for_any_number_of_threads() {
    let (upper, lower) = (
        |x: f64| Some(40.0 + 0.1 * x),
        |x: f64| Some(100.0 - 0.1 * x),
    );
    let image = image(90, 140, &[&upper, &lower]);
    for method in methods() {
        let detector = finder(method, 2);
        let with = |threads| on_threads(threads, || detector.detect(&image));
        assert_eq!(with(1), with(7), "{method}");
    }
}
