//! Characteristics of a synthetic sensor, which are known in closed form.

use core::convert::Infallible;

use rand_chacha::ChaCha8Rng;
use rand_core::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use tem00_testkit::{assert_absolute, assert_relative};
use tem00_topography::{
    Artefact, Axis, Characteristics, DVec3, Estimate, Extreme, Field, Options, ProfileSensor,
    Shape, SurfacePoint, characterise,
};

const FIELD: Field = Field {
    width: 48e-3,
    heights: [-6e-3, 6e-3],
    column: 0.05e-3,
    thickness: 0.2e-3,
    groove_depth: 0.1e-3,
};

/// A sensor that errs in ways that are known; lengths in metres.
#[derive(Clone, Copy, Default)]
struct Synthetic {
    /// Heights are measured so much too large.
    gain: f64,
    /// The bend of its response, per metre.
    bend: f64,
    /// The height at the ends of a flat profile.
    sag: f64,
    /// The standard deviation of what stays at a place, and of what changes with each repetition.
    noise: [f64; 2],
    /// The standard deviations of what blurs grooves, along x and y.
    blur: [f64; 2],
    /// Places are measured so far beside.
    shift: [f64; 2],
    /// Everything is measured so much too large, about the middle of a sphere.
    scale: f64,
    seed: u64,
}

impl Synthetic {
    /// The height of grooves after the blur.
    fn surface(&self, artefact: &Artefact, x: f64, y: f64) -> Option<f64> {
        let height = artefact.height(x, y)?;
        let Shape::Grooves {
            across,
            depth,
            grooves,
        } = &artefact.shape
        else {
            return Some(height);
        };
        let (place, blur) = match across {
            Axis::X => (x, self.blur[0]),
            Axis::Y => (y, self.blur[1]),
        };
        if blur == 0.0 {
            return Some(height);
        }
        let side = |wall: f64| 0.5 * libm::erf((place - wall) / (2.0_f64.sqrt() * blur));
        let inside = grooves.iter().map(|groove| {
            let [left, right] = groove.walls().map(side);
            left - right
        });
        Some(-depth * inside.sum::<f64>())
    }

    fn profile(
        &self,
        artefact: &Artefact,
        place: DVec3,
        [still, moving]: [&mut ChaCha8Rng; 2],
    ) -> Vec<SurfacePoint> {
        let point = |column: usize| {
            let (x, y) = ((column as f64 - 479.5) * FIELD.column, -place.y);
            let noise = |rng: &mut ChaCha8Rng, scale: f64| {
                let drawn: f64 = StandardNormal.sample(rng);
                scale * drawn
            };
            let noise = noise(still, self.noise[0]) + noise(moving, self.noise[1]);
            let surface = self.surface(artefact, x, y)?;
            let height = surface + place.z;
            let sag = self.sag * (x / (0.5 * FIELD.width)).powi(2);
            let error = self.gain * height + self.bend * height * height + sag;
            let position = match artefact.shape {
                Shape::Sphere { radius } => {
                    let centre = DVec3::new(0.0, 0.0, -radius);
                    let from = DVec3::new(x, y, surface) - centre;
                    centre + (1.0 + self.scale + noise / radius) * from
                }
                Shape::Flat { .. } | Shape::Grooves { .. } => DVec3::new(
                    x + self.shift[0],
                    y + self.shift[1],
                    surface + error + noise,
                ),
            };
            Some(SurfacePoint { column, position })
        };
        (0..960).filter_map(point).collect()
    }
}

impl ProfileSensor for Synthetic {
    type Error = Infallible;

    fn field(&self) -> Field {
        FIELD
    }

    fn measure(
        &mut self,
        artefact: &Artefact,
        places: &[DVec3],
    ) -> Result<Vec<Vec<SurfacePoint>>, Infallible> {
        let mut profiles = Vec::new();
        for (index, place) in places.iter().enumerate() {
            let is_again = index > 0 && places[index - 1] == *place;
            self.seed += 1;
            let (mut still, mut moving) = (
                ChaCha8Rng::seed_from_u64(1_000_000 + self.seed - u64::from(is_again)),
                ChaCha8Rng::seed_from_u64(self.seed),
            );
            profiles.push(self.profile(artefact, *place, [&mut still, &mut moving]));
        }
        Ok(profiles)
    }
}

fn characteristics(mut sensor: Synthetic) -> Characteristics {
    let Ok(found) = characterise(&mut sensor, Options { repetitions: 16 });
    found
}

/// Within three of its uncertainties, and a part of the truth for what is not chance.
fn is(found: Estimate, truth: f64, part: f64) {
    assert_absolute(
        found.value,
        truth,
        3.0 * found.uncertainty + part * truth.abs(),
    );
}

/// An extreme far above chance, to which chance adds at most what it would make alone.
fn is_extreme(found: Extreme, truth: f64, chance: f64) {
    assert!(found.by_chance < chance * truth, "{found:?}, {truth}");
    let allowed = 3.0 * found.uncertainty + found.by_chance;
    assert_absolute(found.value, truth, allowed);
}

#[test]
fn heights_come_back() {
    let [gain, bend, sag] = [2e-3, 1.5, 40e-6];
    let found = characteristics(Synthetic {
        gain,
        bend,
        sag,
        noise: [20e-6, 0.0],
        ..Synthetic::default()
    });
    let response = found.response.expect("seen");
    // The middle of the range is 0: the parabola has no slope there.
    is(response.amplification, 1.0 + gain, 0.0);
    // Of k² for k = −4 … 4 the mean is 20/3, and the ends are 28/3 away; k = 1 is 1.35 mm.
    let truth = bend * 1.35e-3_f64.powi(2) * 28.0 / 3.0;
    is_extreme(response.linearity, truth, 0.25);
    let flat = found.flat.expect("seen");
    // At 64 places over 0.9 of the profile: from the first, (0.9 · 63/64)², to the middle, (0.9 /
    // 64)².
    let truth = sag * 0.81 * (63.0_f64.powi(2) - 1.0) / 64.0_f64.powi(2);
    is_extreme(flat.flatness, truth, 0.25);
}

#[test]
fn noise_and_form_come_back() {
    let noise = [8e-6, 3e-6];
    let found = characteristics(Synthetic {
        noise,
        scale: 1e-3,
        ..Synthetic::default()
    });
    let flat = found.flat.expect("seen");
    let together = noise[0].hypot(noise[1]);
    is(flat.measurement_noise, together, 0.0);
    is(flat.instrument_noise, noise[1], 0.0);
    // 95 % of normal numbers lie within ± 1.95996 σ; across a tilted plane heights count less, and
    // the interval that is the shortest of 14 000 points is 1 % shorter.
    let slopes = [[0.0, 0.0], [flat.slopes[0], 0.0], [0.0, flat.slopes[1]]];
    for (form, [x, y]) in flat.form.into_iter().zip(slopes) {
        let truth = 2.0 * 1.959_96 * together / x.hypot(y).hypot(1.0);
        is(form, truth, 0.01);
    }
    let sphere = found.sphere.expect("seen");
    is(sphere.size, 1e-3 * sphere.diameter, 0.0);
    is(sphere.form, 2.0 * 1.959_96 * together, 0.01);
    // Means of a hundred points and more leave a tenth of the noise; the range of 25 is 4 of them.
    let min = sphere.form_of_places.value;
    assert!((0.0..together).contains(&min), "{sphere:?}");
}

#[test]
fn grooves_come_back() {
    let blur = [0.09e-3, 0.07e-3];
    let shift = [12e-6, -7e-6];
    let found = characteristics(Synthetic {
        noise: [5e-6, 1e-6],
        blur,
        shift,
        ..Synthetic::default()
    });
    for (result, (blur, shift)) in found.grooves.into_iter().zip(blur.into_iter().zip(shift)) {
        let result = result.expect("seen");
        // The middle of a groove of width w is seen erf(w / √8 s) deep: half at 1.34898 s, nine
        // tenths at 3.28971 s. The parabola between widths leaves 0.3 % and 1 %, the point nearest
        // to the middle as much.
        let resolution = result.resolution.expect("crossed");
        is(resolution, 1.348_98 * blur, 0.01);
        let limit = result.fidelity_limit.expect("crossed");
        is(limit, 3.289_71 * blur, 0.03);
        let mapping = result.mapping.expect("seen");
        is_extreme(mapping, shift.abs(), 0.5);
    }
}

/// A sensor that sees nothing and notes what it was to measure.
struct Blind {
    field: Field,
    asked: Vec<&'static str>,
}

impl Blind {
    fn characterise(width: f64, repetitions: usize) -> (Characteristics, Vec<&'static str>) {
        let mut sensor = Self {
            field: Field { width, ..FIELD },
            asked: Vec::new(),
        };
        let Ok(found) = characterise(&mut sensor, Options { repetitions });
        (found, sensor.asked)
    }
}

impl ProfileSensor for Blind {
    type Error = Infallible;

    fn field(&self) -> Field {
        self.field
    }

    fn measure(
        &mut self,
        artefact: &Artefact,
        places: &[DVec3],
    ) -> Result<Vec<Vec<SurfacePoint>>, Infallible> {
        self.asked.extend(places.iter().map(|_| artefact.name));
        Ok(vec![Vec::new(); places.len()])
    }
}

#[test]
fn what_is_not_seen_has_no_number_and_profiles_are_counted_before() {
    let (found, asked) = Blind::characterise(FIELD.width, 5);
    assert_eq!(
        (found.response, found.flat, found.sphere),
        (None, None, None)
    );
    assert_eq!(found.grooves, [None, None]);
    assert_eq!(asked.len(), Options { repetitions: 5 }.profiles());
}

#[test]
fn a_comb_that_does_not_fit_is_not_measured() {
    // Twelve widths from 16 columns on, each smaller by √2, and 16 columns of land beside each,
    // over nine tenths.
    let widths = 16.0 * (1.0 - 1.0 / 64.0) / (1.0 - 0.5_f64.sqrt());
    let shortest = (widths + 12.0 * 16.0) * FIELD.column / 0.9;
    assert_relative(FIELD.shortest_for_grooves(), shortest, 1e-12);
    for (length, fits) in [(0.999, false), (1.001, true)] {
        let (_, asked) = Blind::characterise(length * shortest, 4);
        assert_eq!(
            asked.contains(&"grooves across the profile"),
            fits,
            "{length}"
        );
    }
}
