//! Faces of many corners. The oracle is the area by the shoelace formula: triangles that all turn
//! as the face does and have its area together cover it once.

use core::f64::consts::TAU;

use proptest::prelude::*;

use super::*;

type Outline = Vec<[f64; 2]>;

/// Reads a face whose corners `place` puts into space.
fn read_face(
    outline: &[[f64; 2]],
    place: impl Fn([f64; 2]) -> DVec3,
) -> (TriangleMesh, Vec<String>) {
    let mut text = String::new();
    for &corner in outline {
        let DVec3 { x, y, z } = place(corner);
        text += &format!("v {x} {y} {z}\n");
    }
    let corners: String = (1..=outline.len())
        .map(|corner| format!(" {corner}"))
        .collect();
    text += &format!("f{corners}\n");
    mesh_and_notes(text.as_bytes(), MeshFormat::Obj).unwrap()
}

/// Returns the area along the normal of the triangles, and without regard to how they turn.
fn areas(mesh: &TriangleMesh) -> (DVec3, f64) {
    let areas = triangle_corners(mesh).into_iter();
    let areas = areas.map(|[a, b, c]| 0.5 * (b - a).cross(c - a));
    areas.fold((DVec3::ZERO, 0.0), |(sum, all), area| {
        (sum + area, all + area.length())
    })
}

fn shoelace(outline: &[[f64; 2]]) -> f64 {
    let next = outline.iter().cycle().skip(1);
    let sides = outline.iter().zip(next);
    sides.map(|(a, b)| 0.5 * (a[0] * b[1] - a[1] * b[0])).sum()
}

/// Points at these radii around the origin.
fn star(radii: &[f64]) -> Outline {
    let step = TAU / radii.len() as f64;
    let point = |(i, radius): (usize, &f64)| {
        let (sin, cos) = (step * i as f64).sin_cos();
        [radius * cos, radius * sin]
    };
    radii.iter().enumerate().map(point).collect()
}

/// Teeth on a bar of height 1, from right to left.
fn comb(teeth: u32) -> Outline {
    let tooth = |i| [[f64::from(2 * i + 1), 9.0], [f64::from(2 * i), 1.0]];
    let mut outline = vec![[0.0, 0.0], [f64::from(2 * teeth), 0.0]];
    outline.extend((0..teeth).rev().flat_map(tooth));
    outline
}

/// Reads the corners of an outline: "0 0, 4 -3, 1 0, 4 3".
fn outline(text: &str) -> Outline {
    let corner = |pair: &str| {
        let (x, y) = pair.split_once(' ').unwrap();
        [x, y].map(|number| number.parse().unwrap())
    };
    text.split(", ").map(corner).collect()
}

fn simple_outlines() -> Vec<(&'static str, Outline)> {
    let joined = "0 0, 10 0, 10 10, 0 10, 0 0, 2 2, 2 4, 4 4, 4 2, 2 2";
    let u = "-20 -15, 20 -15, 20 15, 10 15, 10 -5, -10 -5, -10 15, -20 15";
    vec![
        ("dart", outline("0 0, 4 -3, 1 0, 4 3")),
        ("L", outline("0 0, 3 0, 3 1, 1 1, 1 5, 0 5")),
        ("U", outline(u)),
        ("star", star(&[2.0, 1.0].repeat(7))),
        ("gear", star(&[5.0, 5.0, 4.0, 4.0].repeat(50))),
        ("comb", comb(200)),
        (
            "corners on sides",
            outline("0 0, 1 0, 2 0, 2 2, 1 0.5, 0 2, 0 1"),
        ),
        ("first corner again", outline("0 0, 4 -3, 1 0, 4 3, 0 0")),
        (
            "a hole, joined to the rim by a double side",
            outline(joined),
        ),
    ]
}

#[test]
fn faces_that_are_not_convex_cover_their_area_and_no_more() {
    let tilted = |[x, y]: [f64; 2]| x * DVec3::new(0.6, 0.0, 0.8) + y * DVec3::new(0.0, 1.0, 0.0);
    let far = |[x, y]: [f64; 2]| DVec3::new(1e5 + x, 3e5 - y, 7.0);
    let tiny = |[x, y]: [f64; 2]| 1e-200 * DVec3::new(0.0, x, y);
    for (name, outline) in simple_outlines() {
        let area = shoelace(&outline);
        let turned: Outline = outline.iter().rev().copied().collect();
        for (outline, normal) in [(&outline, area.signum()), (&turned, -area.signum())] {
            let (mesh, notes) = read_face(outline, |[x, y]| DVec3::new(x, y, 0.0));
            let (sum, all) = areas(&mesh);
            let (off, turned) = ((all - area.abs()).abs(), (sum.z - normal * all).abs());
            assert!(off < 1e-12 * all, "{name}: {all} is not {area}");
            assert!(turned < 1e-12 * all, "{name} turns {sum}");
            assert_eq!(notes, [""; 0], "{name}");
            for place in [&tilted as &dyn Fn(_) -> _, &far] {
                let (sum, all) = areas(&read_face(outline, place).0);
                // Coordinates of 3e5 are rounded to 6e-11.
                let off = (sum.length() - all).abs().max((all - area.abs()).abs());
                assert!(off < 1e-9 * all, "{name}, moved: {sum}, {all}");
            }
            let (mesh, _) = read_face(outline, tiny);
            let enlarged = triangle_corners(&mesh).into_iter();
            let enlarged = enlarged.map(|t| t.map(|corner| corner * 1e200));
            let areas = enlarged.map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length());
            let off = (areas.sum::<f64>() - area.abs()).abs();
            assert!(off < 1e-12 * area.abs(), "{name}, tiny: {off}");
        }
    }
}

proptest! {
    #[test]
    fn outlines_around_a_point_cover_their_area(
        radii in prop::collection::vec(0.1_f64..10.0, 4..120),
    ) {
        let outline = star(&radii);
        let (mesh, notes) = read_face(&outline, |[x, y]| DVec3::new(x, y, 0.0));
        let (sum, all) = areas(&mesh);
        let expected = shoelace(&outline);
        // A millionth may be covered the wrong way round, and counts twice then.
        prop_assert!((all - expected).abs() < 2.1e-6 * expected, "{all} is not {expected}");
        prop_assert!((sum.z - expected).abs() < 2.1e-6 * expected, "{sum} turns");
        prop_assert!(notes.is_empty(), "{notes:?}");
    }
}

#[test]
fn a_warped_face_that_is_not_convex_keeps_its_outline() {
    // Heights of a tenth of the size: seen along its normal, the face has the area of its outline.
    let (_, outline) = simple_outlines().swap_remove(2);
    let (mesh, notes) = read_face(&outline, |[x, y]| DVec3::new(x, y, 2e-3 * x * y));
    let seen = triangle_corners(&mesh).into_iter();
    let seen: f64 = seen
        .map(|[a, b, c]| 0.5 * (b - a).cross(c - a).z.abs())
        .sum();
    assert!((seen - 800.0).abs() < 1e-9, "{seen}");
    assert_eq!(notes, [""; 0]);
}

#[test]
fn convex_faces_are_halved_as_ever() {
    let rectangle = outline("0 0, 2 0, 2 1, 0 1");
    for (outline, expected) in [
        (rectangle, vec![[0, 1, 2], [0, 2, 3]]),
        (star(&[1.0; 5]), vec![[0, 1, 2], [0, 2, 4], [2, 3, 4]]),
        (
            star(&[1.0; 7]),
            vec![[0, 1, 2], [0, 2, 3], [0, 3, 6], [3, 4, 5], [3, 5, 6]],
        ),
    ] {
        let (mesh, _) = read_face(&outline, |[x, y]| DVec3::new(x, y, x + y));
        assert_eq!(mesh.triangles(), expected);
    }
}

#[test]
fn faces_that_cross_themselves_are_noted() {
    let bow_tie = outline("0 0, 1 1, 1 0, 0 1");
    let uneven = outline("0 0, 2 2, 2 0, 0 1");
    let pentagram = (0..5).map(|i| star(&[1.0; 5])[2 * i % 5]).collect();
    let eight = (0..40).map(|i| {
        let angle = TAU * f64::from(i) / 40.0;
        [angle.sin(), 0.3 + (2.0 * angle).sin()]
    });
    for outline in [bow_tie, uneven, pentagram, eight.collect()] {
        let (mesh, notes) = read_face(&outline, |[x, y]| DVec3::new(x, y, 0.0));
        assert_eq!(notes.len(), 1, "{outline:?}: {notes:?}");
        let told = "faces that cross themselves: 1, the first is face 0 (from 0)";
        assert!(notes[0].starts_with(told), "{notes:?}");
        assert!(!mesh.triangles().is_empty(), "something is left");
    }
}

#[test]
fn a_face_of_too_many_corners_is_refused_unless_it_is_convex() {
    const CORNERS: usize = 40_000;
    let (mesh, _) = read_face(&star(&[1.0; CORNERS]), |[x, y]| DVec3::new(x, y, 0.0));
    assert_eq!(mesh.triangles().len(), CORNERS - 2);
    let vertex = |[x, y]: [f64; 2]| format!("v {x} {y} 0\n");
    let vertices: String = comb(20_000).into_iter().map(vertex).collect();
    let corners: String = (1..=CORNERS + 2).map(|i| format!(" {i}")).collect();
    let text = format!("{vertices}f 1 2 3\nf{corners}\n");
    let expected =
        "face 1 (from 0) is not convex and has 40002 corners: cut it up, at most 32768 are read";
    assert_eq!(complaint("comb.obj", text), expected);
}
