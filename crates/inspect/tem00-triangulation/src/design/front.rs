/// Returns the points that no other point betters: none has less of the first number without also
/// having less of the second (Pareto's front of "less of the first, more of the second").
///
/// The indices come in the order of the first number; of equal points the first represents all.
/// Points with a NaN are on no front.
///
/// # Examples
///
/// ```
/// use tem00_triangulation::pareto_front;
///
/// // Uncertainty in µm, and depth of field in mm.
/// let points = [[3.0, 2.0], [5.0, 8.0], [4.0, 1.0], [6.0, 8.0]];
/// assert_eq!(pareto_front(&points), [0, 1]);
/// ```
pub fn pareto_front(points: &[[f64; 2]]) -> Vec<usize> {
    let comparable = |&index: &usize| !points[index].iter().any(|number| number.is_nan());
    let mut order: Vec<usize> = (0..points.len()).filter(comparable).collect();
    // By the first number, then by the second from the greatest, then by position.
    order.sort_by(|&a, &b| {
        let [x, y] = [points[a], points[b]];
        x[0].total_cmp(&y[0]).then(y[1].total_cmp(&x[1]))
    });
    let mut max = f64::NEG_INFINITY;
    let mut front: Vec<usize> = Vec::new();
    for index in order {
        if front.is_empty() || points[index][1] > max {
            max = points[index][1];
            front.push(index);
        }
    }
    front
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Returns true if `a` is nowhere worse than `b` and somewhere better.
    fn betters(a: [f64; 2], b: [f64; 2]) -> bool {
        a[0] <= b[0] && a[1] >= b[1] && (a[0] < b[0] || a[1] > b[1])
    }

    fn same(a: [f64; 2], b: [f64; 2]) -> bool {
        a.map(f64::to_bits) == b.map(f64::to_bits)
    }

    proptest! {
        /// Few values, so that many points agree in a number.
        #[test]
        fn a_front_is_what_nothing_betters(points in prop::collection::vec(
            (0..6_i8, 0..6_i8).prop_map(|(x, y)| [f64::from(x), f64::from(y)]), 0..40)) {
            let front = pareto_front(&points);
            for &index in &front {
                let bettered = points.iter().any(|&other| betters(other, points[index]));
                prop_assert!(!bettered, "{:?} is on the front", points[index]);
            }
            for (index, &point) in points.iter().enumerate() {
                let reached = front
                    .iter()
                    .any(|&f| same(points[f], point) || betters(points[f], point));
                prop_assert!(reached, "{point:?} at {index} is bettered or on the front");
            }
            for pair in front.windows(2) {
                let [a, b] = [points[pair[0]], points[pair[1]]];
                prop_assert!(a[0] < b[0] && a[1] < b[1], "{a:?}, {b:?} rise");
            }
        }
    }

    #[test]
    fn nan_is_on_no_front() {
        let points = [
            [f64::NAN, 1.0],
            [1.0, f64::INFINITY],
            [0.5, f64::NAN],
            [2.0, 5.0],
        ];
        assert_eq!(pareto_front(&points), [1]);
    }
}
