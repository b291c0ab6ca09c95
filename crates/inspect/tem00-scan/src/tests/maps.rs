use ply_rs_bw::{parser::Parser, ply::DefaultElement, ply::Property};
use tem00_numerics::Grid;

use super::*;
use crate::testing::doubtful;

#[test]
fn a_map_of_profiles_has_holes_where_nothing_is_valid() {
    let profiles = [
        vec![point(0, 1e-3 * DVec3::Z), doubtful(2, 5e-3 * DVec3::Z)],
        vec![point(1, 2e-3 * DVec3::Z)],
    ];
    let map = HeightMap::of_profiles(&profiles, DVec3::Z, [3, 1]);
    let holes: Vec<bool> = map.heights.values().iter().map(|h| h.is_nan()).collect();
    assert_eq!(holes, [false, true, true, true, false, true]);
    assert_eq!(map.heights[(1, 1)], 2e-3);
    assert_absolute(map.holes(), 4.0 / 6.0, 1e-15);
    let quantised = QuantisedGrid::new(&map.heights).unwrap();
    let integers = quantised.integers.values();
    assert_eq!(integers, [1, 0, 0, 0, u16::MAX, 0], "holes are 0");
    for (&integer, &height) in integers.iter().zip(map.heights.values()) {
        let back = quantised.offset + quantised.scale * f64::from(integer);
        // Half a step of 1 mm / 65534, and the rounding of f32.
        assert!(
            height.is_nan() || (back - f64::from(height)).abs() < 0.8e-8,
            "{back}"
        );
    }
}

#[test]
fn where_nothing_is_valid_there_is_no_height_and_no_scale() {
    let profiles = [vec![], vec![doubtful(2, 5e-3 * DVec3::Z)]];
    let map = HeightMap::of_profiles(&profiles, DVec3::Z, [3, 1]);
    assert_eq!(map.holes(), 1.0);
    assert_eq!(map.range(), None);
    assert_eq!(QuantisedGrid::new(&map.heights), None);
}

#[test]
fn equal_values_are_quantised_exactly() {
    let flat = QuantisedGrid::new(&Grid::filled(2, 1, 0.25)).unwrap();
    assert_eq!(flat.integers.values(), [1, 1]);
    assert_eq!(flat.offset + flat.scale, 0.25);
}

#[test]
fn a_map_of_the_part_has_square_cells() {
    let at = |x: f64, y: f64, z: f64| point(0, 1e-3 * DVec3::new(x, y, z));
    let profiles = [
        vec![at(0.0, 0.0, 1.0), at(0.4, 0.3, 3.0)],
        vec![at(2.2, 0.8, 7.0)],
    ];
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    let map = HeightMap::of_points(&profiles, axes, 1e-3).unwrap();
    assert_eq!((map.heights.width(), map.heights.height()), (3, 2));
    assert_eq!(map.heights[(0, 0)], 2e-3, "the mean of two");
    assert_eq!(map.heights[(2, 1)], 7e-3);
    assert_absolute(map.holes(), 4.0 / 6.0, 1e-15);
    assert!(HeightMap::of_points(&[], axes, 1e-3).is_err(), "nothing");
    refuses!(pitch = 1e-3 => HeightMap::of_points(&profiles, axes, pitch);
        pitch: [1e-12, 0.0, -1.0, f64::NAN, f64::INFINITY],
    );
}

/// Profiles that are a whole number of parts of a pitch apart fall into rows evenly, wherever the
/// part stands and however their places were rounded.
#[test]
fn rows_of_a_map_have_equally_many_profiles() {
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    for (step, count) in [
        (3e-4, 30),
        (1e-4, 200),
        (2.2e-4, 61),
        (1e-3 / 3.0, 97),
        (7e-6, 1000),
    ] {
        for offset in [0.0, -4.35e-3, 0.1, -1.0 / 3.0] {
            let sum = |k: usize| (0..k).fold(offset, |y, _| y + step);
            let roundings: [&dyn Fn(usize) -> f64; 3] = [
                &|k| offset + k as f64 * step,
                &|k| offset - (count - 1 - k) as f64 * step,
                &sum,
            ];
            let ways = roundings
                .iter()
                .flat_map(|place| [1, 2, 3].map(|steps| (place, steps)));
            for (place, steps) in ways {
                let at = |k| vec![point(0, DVec3::new(0.0, place(k), k as f64))];
                let profiles: Vec<_> = (0..count).map(at).collect();
                let map = HeightMap::of_points(&profiles, axes, step * steps as f64).unwrap();
                // The first row begins half a pitch below the first profile.
                let row = |k: usize| (2 * k + steps) / (2 * steps);
                let rows = row(count - 1) + 1;
                let mean = |r| {
                    let of_row: Vec<usize> = (0..count).filter(|&k| row(k) == r).collect();
                    of_row.iter().sum::<usize>() as f32 / of_row.len() as f32
                };
                let expected: Vec<f32> = (0..rows).map(mean).collect();
                assert_eq!(map.heights.values(), expected, "{step} m from {offset} m");
            }
        }
    }
}

#[test]
fn point_clouds_are_read_by_another_program() {
    let position = DVec3::new(1e-3, -2e-3, 0.123_456_789_012_345);
    let profiles = [vec![], vec![point(4, position), doubtful(5, DVec3::ONE)]];
    let mut file = Vec::new();
    write_ply(&profiles, &mut file).unwrap();
    let ply = Parser::<DefaultElement>::new()
        .read_ply(&mut file.as_slice())
        .unwrap();
    let [vertex] = &ply.payload["vertex"][..] else {
        panic!("one valid point");
    };
    assert!(matches!(vertex["z"], Property::Double(z) if z == position.z));
    assert!(matches!(vertex["frame"], Property::Int(1)));
    let sigma = 1e-5 * (0.04_f64 + 0.0025 + 0.01).sqrt();
    for name in ["sigma_z", "sigma"] {
        let Property::Float(found) = vertex[name] else {
            panic!("{name} is a float");
        };
        assert_relative(found.into(), sigma, 1e-6);
    }
}
