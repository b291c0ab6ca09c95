use core::f64::consts::PI;
use std::sync::LazyLock;

use tem00_numerics::{cast::to_usize, jinc};

/// Values per unit of the distance.
const STEPS: usize = 128;

/// The distance from which on values do not come from the table.
const END: usize = 16;

/// Returns Airy's pattern of the amplitude, squared, at a distance in speckle sizes, within 1e−7.
///
/// ```text
/// (2 J₁(π ρ) / π ρ)²
/// ```
///
/// It is interpolated between four values of a table, in a fifth of the time of the function.
pub(super) fn airy_pattern(distance: f64) -> f64 {
    static TABLE: LazyLock<Vec<f64>> = LazyLock::new(|| {
        // One value lies before the first distance, and two behind the last.
        let steps = (0..STEPS * END + 4).map(|step| step as f64 - 1.0);
        steps.map(|step| exact(step / STEPS as f64)).collect()
    });
    let steps = distance * STEPS as f64;
    let step = to_usize(steps);
    let Some(&[a, b, c, d]) = TABLE.get(step..).and_then(|values| values.first_chunk()) else {
        return exact(distance);
    };
    // Lagrange's polynomial through the values at −1, 0, 1 and 2.
    let t = steps - step as f64;
    let [before, here, next, last] = [t + 1.0, t, t - 1.0, t - 2.0];
    let outer = here * next * (d * before - a * last) / 6.0;
    outer + 0.5 * before * last * (b * next - c * here)
}

fn exact(distance: f64) -> f64 {
    let field = jinc(PI * distance);
    field * field
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_the_function() {
        for i in 0..200_000_u32 {
            let distance = f64::from(i) * 1e-4;
            let error = airy_pattern(distance) - exact(distance);
            assert!(error.abs() < 1e-7, "{distance}: {error:e}");
        }
        assert!(airy_pattern(1e300) < 1e-300, "far away");
    }
}
