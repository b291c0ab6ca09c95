use super::{query::Query, *};

fn intersect_all(intersector: &Intersector, rays: &[Ray]) -> Vec<Option<Hit>> {
    let mut hits = vec![None; rays.len()];
    intersector.intersect_batch(rays, &mut hits);
    hits
}

fn all_visible(intersector: &Intersector, segments: &[Segment]) -> Vec<bool> {
    let mut visible = vec![false; segments.len()];
    intersector.visible_batch(segments, &mut visible);
    visible
}

/// Segments from where rays meet a scene to points around a position.
fn segments(
    intersector: &Intersector,
    rays: &[Ray],
    around: DVec3,
    numbers: &mut Numbers,
) -> Vec<Segment> {
    let hits = rays.iter().filter_map(|ray| intersector.intersect(ray));
    hits.map(|hit| Segment {
        from: hit.position,
        from_normal: hit.normal,
        to: around + 0.3 * anywhere(numbers),
    })
    .collect()
}

#[test]
fn a_batch_of_any_length_is_answered_as_its_rays_are_alone() {
    let mut numbers = Numbers::new(11);
    let mut shapes = mixed_scene();
    shapes.push(soup(3000, 1.0, &mut numbers).into());
    let intersector = build(&shapes);
    let mut rays = rays(3000, 1.0, &mut numbers);
    rays[70].direction = DVec3::NAN;
    rays[71].origin = DVec3::INFINITY;
    rays[72].direction = DVec3::ZERO;
    let alone: Vec<_> = rays.iter().map(|ray| intersector.intersect(ray)).collect();
    assert!(alone.iter().flatten().count() > 1000, "many meet something");
    for length in [0, 1, 2, 63, 64, 65, 200, rays.len()] {
        let hits = intersect_all(&intersector, &rays[..length]);
        assert_eq!(hits, alone[..length], "{length} rays");
    }
    let segments = segments(&intersector, &rays, 0.7 * DVec3::Z, &mut numbers);
    let alone: Vec<_> = segments
        .iter()
        .map(|way| intersector.visible(way.from, way.from_normal, way.to))
        .collect();
    let open = alone.iter().filter(|&&open| open).count();
    assert!(open > 100 && open < alone.len() - 100, "{open} are open");
    for length in [0, 1, 63, 64, 65, 200, segments.len()] {
        let visible = all_visible(&intersector, &segments[..length]);
        assert_eq!(visible, alone[..length], "{length} segments");
    }
}

#[test]
fn every_processor_gives_the_same_answers() {
    let mut numbers = Numbers::new(12);
    let mut shapes = mixed_scene();
    shapes.push(soup(2000, 1.0, &mut numbers).into());
    let widest = build(&shapes);
    let mut narrowest = widest.clone();
    narrowest.level = Level::baseline();
    let rays = rays(2000, 1.0, &mut numbers);
    let [wide, narrow] = [&widest, &narrowest].map(|level| intersect_all(level, &rays));
    assert_eq!(wide, narrow, "hits");
    let segments = segments(&widest, &rays, 0.7 * DVec3::Z, &mut numbers);
    let [wide, narrow] = [&widest, &narrowest].map(|level| all_visible(level, &segments));
    assert_eq!(wide, narrow, "shadows");
}

#[test]
fn batches_find_what_a_search_of_all_triangles_finds_at_any_scale() {
    for (seed, size) in [(1, 1e-9), (2, 1e-3), (3, 1.0), (4, 1e6)] {
        let mut numbers = Numbers::new(seed);
        let shapes = [Shape::from(soup(400, size, &mut numbers))];
        let intersector = build(&shapes);
        let rays = rays(1500, size, &mut numbers);
        let hits = intersect_all(&intersector, &rays);
        assert!(
            hits.iter().flatten().count() > 100,
            "{size:e} m: many meet something"
        );
        for (ray, hit) in rays.iter().zip(hits) {
            let expected = brute_force(&shapes, ray).map(|(distance, _)| distance);
            assert_eq!(hit.map(|hit| hit.distance), expected, "{size:e} m: {ray:?}");
        }
    }
}

#[test]
fn shadows_are_those_of_a_search_of_all_primitives() {
    let mut numbers = Numbers::new(13);
    let mut shapes = mixed_scene();
    shapes.push(soup(300, 1.0, &mut numbers).into());
    let intersector = build(&shapes);
    let primitives: Vec<_> = shapes.iter().flat_map(primitives).collect();
    let rays = rays(2000, 1.0, &mut numbers);
    let mut segments = segments(&intersector, &rays, 0.7 * DVec3::Z, &mut numbers);
    // Some end on a surface, which does not hide its own points.
    let ends: Vec<_> = segments.iter().map(|segment| segment.from).collect();
    for (segment, end) in segments.iter_mut().zip(ends.iter().rev()).step_by(3) {
        segment.to = *end;
    }
    let visible = all_visible(&intersector, &segments);
    for (segment, visible) in segments.iter().zip(visible) {
        let mut query = Shadow::new(segment, intersector.clearance);
        for primitive in &primitives {
            let (body, triangle) = (0, 0);
            query.offer(primitive, query::PrimitiveIndex { body, triangle });
        }
        assert_eq!(visible, !query.hidden, "{segment:?}");
    }
}

#[test]
fn a_segment_to_infinity_ends_behind_everything() {
    let intersector = build(&mixed_scene());
    let sky = |x: f64, direction: DVec3| {
        Segment::to_infinity(DVec3::new(x, 0.0, -0.3), DVec3::Z, direction)
    };
    let up = DVec3::Z;
    let segments = [
        sky(0.0, up),
        sky(0.3, up),
        sky(0.3, -up),
        sky(0.3, DVec3::X),
    ];
    // The ball of 0.1 m hides the sky above the origin; the floor is left at either side.
    let visible = all_visible(&intersector, &segments);
    assert_eq!(
        visible,
        [false, true, true, true],
        "above, beside, below, along"
    );
}

#[test]
#[should_panic(expected = "one hit for each ray")]
fn as_many_hits_as_rays_are_asked_for() {
    let intersector = build(&mixed_scene());
    intersector.intersect_batch(&[ray(DVec3::Z, -DVec3::Z)], &mut []);
}
