use tem00_statistics::chi_squared;

use super::*;

/// Bins over cos θ and azimuth, and one more for the draws that find no direction.
const RINGS: u32 = 8;
const SECTORS: u32 = 12;

fn bin(wi: DVec3) -> usize {
    let ring = (wi.z.abs() * f64::from(RINGS))
        .floor()
        .min(f64::from(RINGS - 1));
    let turn = (wi.y.atan2(wi.x) / TAU).rem_euclid(1.0);
    let sector = (turn * f64::from(SECTORS))
        .floor()
        .min(f64::from(SECTORS - 1));
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a small whole number"
    )]
    let index = (ring * f64::from(SECTORS) + sector) as usize;
    index
}

/// The probability of every bin, by the midpoint rule on 60 × 60 points in each.
fn expected(material: &Material, wo: DVec3) -> Vec<f64> {
    const POINTS: u32 = 60;
    let mut bins = Vec::new();
    let cell = f64::from(RINGS * POINTS).recip() * TAU / f64::from(SECTORS * POINTS);
    for ring in 0..RINGS {
        for sector in 0..SECTORS {
            let mut sum = 0.0;
            for i in 0..POINTS {
                let z = (f64::from(ring * POINTS + i) + 0.5) / f64::from(RINGS * POINTS);
                for j in 0..POINTS {
                    let azimuth =
                        TAU * (f64::from(sector * POINTS + j) + 0.5) / f64::from(SECTORS * POINTS);
                    let wi = direction(z, azimuth);
                    sum += material.pdf(wo, wi.with_z(wo.z.signum() * wi.z));
                }
            }
            bins.push(sum * cell);
        }
    }
    bins.push(1.0 - bins.iter().sum::<f64>());
    bins
}

#[test]
fn draws_follow_the_pdf() {
    const DRAWS: u32 = 60_000;
    let cases = [
        (Material::lambertian(0.5).unwrap(), direction(0.5, 0.0)),
        (iron(0.3), direction(0.7, 0.4)),
        (iron(0.6), direction(0.2, 2.0)),
        (iron(1.0), direction(1.0, 0.0)),
        (iron(0.5), -direction(0.4, 1.0)),
        (plaster(0.9), direction(0.05, 1.0)),
        (plaster(0.4), -direction(0.6, 4.0)),
        (lacquer(0.3), direction(0.5, 0.7)),
        (lacquer(0.8), -direction(0.1, 3.0)),
        (
            Material::plastic(0.1, 2.0, 0.5).unwrap(),
            direction(0.9, 2.0),
        ),
    ];
    for (seed, (material, wo)) in (1..).zip(cases) {
        let probabilities = expected(&material, wo);
        let mut numbers = Numbers::new(seed);
        let mut observed = vec![0_u64; probabilities.len()];
        for _ in 0..DRAWS {
            let sample = material.sample(wo, numbers.units(), RED);
            observed[sample.map_or(probabilities.len() - 1, |s| bin(s.wi))] += 1;
        }
        let expected: Vec<f64> = probabilities
            .into_iter()
            .map(|probability| probability.max(0.0) * f64::from(DRAWS))
            .collect();
        let outcome = chi_squared(&observed, &expected, 1).unwrap();
        // A correct sampler fails one of the ten tests at a random seed with 1e−3.
        assert!(outcome.p_value > 1e-4, "{material:?}: {outcome:?}");
    }
}
