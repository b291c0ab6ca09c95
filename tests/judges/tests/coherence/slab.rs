//! Light that walked through a turbid slab.

use core::f64::consts::{LN_2, TAU};

use tem00::{
    coherence::{DelayedLight, PathPairs, PeakShape, Spectrum},
    wave::{Complex, Estimate},
};

use super::{
    heights::Random,
    sums::{assert_agrees, assert_refutes, for_surfaces},
};

const WAVELENGTH: f64 = 450e-9;

/// Length between two scatterings on average, in metres; in all directions alike.
const MEAN_FREE_PATH: f64 = 1e-3;

/// Thickness in mean free paths.
const THICKNESS: f64 = 10.0;

/// Walks on each side of the pairs of a batch.
const BATCH: usize = 250;
const BATCHES: u64 = 120;

/// Returns the length, in mean free paths, of a random walk through the slab; nothing if it comes
/// back.
fn walk(random: &mut Random) -> Option<f64> {
    let (mut depth, mut length, mut cosine) = (0.0, 0.0, 1.0);
    loop {
        let step = -random.uniform().ln();
        let next = depth + cosine * step;
        if next > THICKNESS {
            return Some(length + (THICKNESS - depth) / cosine);
        }
        if next < 0.0 {
            return None;
        }
        depth = next;
        length += step;
        cosine = 2.0 * random.uniform() - 1.0;
    }
}

/// Returns paths of light that came through.
fn transmitted(count: usize, random: &mut Random) -> Vec<DelayedLight> {
    let mut through = || {
        loop {
            if let Some(length) = walk(random) {
                return length;
            }
        }
    };
    let path = |length| DelayedLight {
        weight: 1.0,
        delay: length * MEAN_FREE_PATH,
    };
    (0..count).map(|_| path(through())).collect()
}

/// |P̂(κ)|² of diffusion, κ per mean free path, between planes of no light 0.71 outside of the
/// slab.
fn diffusion(kappa: f64) -> f64 {
    const OUTSIDE: f64 = 0.71;
    let whole = THICKNESS + 2.0 * OUTSIDE;
    let alpha = Complex::new(0.0, 3.0 * kappa).sqrt();
    let entered = 1.0 + OUTSIDE;
    // sinh aα / sinh wα, without large exponentials.
    let ratio = (-(whole - entered) * alpha).exp() * (1.0 - (-2.0 * entered * alpha).exp())
        / (1.0 - (-2.0 * whole * alpha).exp());
    if kappa == 0.0 {
        1.0
    } else {
        (whole / entered * ratio).norm_sqr()
    }
}

fn line(spread: f64) -> Spectrum {
    let linewidth = spread * (8.0 * LN_2).sqrt() * WAVELENGTH.powi(2) / TAU;
    Spectrum::new(WAVELENGTH, linewidth, PeakShape::Gaussian).expect("a line")
}

#[test]
fn pairs_of_walks_through_a_slab_have_the_coherence_of_diffusion_and_two_moments_have_not() {
    // Contrasts, the roots of c₂₂.
    for (relative, known) in [(0.01, 0.896), (0.03, 0.677), (0.1, 0.407)] {
        let line = line(relative / MEAN_FREE_PATH);
        let law = line.mean_over_pairs(0.01 / MEAN_FREE_PATH, |kappa| {
            diffusion(kappa.abs() * MEAN_FREE_PATH)
        });
        let law = law.sqrt();
        assert!((law - known).abs() < 1e-3, "{law}");
        let batches = for_surfaces(BATCHES, 12, |random| {
            let [sample, other] = [(); 2].map(|()| transmitted(BATCH, random));
            let mut pairs = PathPairs::default();
            pairs.add(&line, &sample, &other);
            let delays = sample.iter().chain(&other).map(|path| path.delay);
            let moments = delays.fold([0.0; 2], |[sum, squares], l| [sum + l, squares + l * l]);
            (pairs.self_coherence().expect("light").sqrt(), moments)
        });
        let contrasts: Vec<f64> = batches.iter().map(|batch| batch.0).collect();
        let walked = Estimate::of_repetitions(&contrasts).expect("batches");
        let name = format!("a line of {relative} over a mean free path");
        assert_agrees(&name, walked, law, 0.005);
        let moment = |i: usize| batches.iter().map(|batch| batch.1[i]).sum::<f64>();
        let count = 2.0 * BATCHES as f64 * BATCH as f64;
        let variance = moment(1) / count - (moment(0) / count).powi(2);
        let of_variance = 1.0 + 4.0 * line.wave_number_spread().powi(2) * variance;
        assert_refutes("two moments", walked, of_variance.powf(-0.25));
    }
}
