//! A rough plate that a source lights directly and by way of a rough wall, seen at one place by an
//! ideal lens.

use core::f64::consts::TAU;

use tem00::{
    coherence::{CellGeometry, DelayedLight},
    wave::{Complex, DVec3, Illumination, RigidMotion, RoughSurface, Scatterer},
};

use super::heights::Random;

/// Distance from the plate to the pupil, in metres.
pub(crate) const DISTANCE: f64 = 0.2;

/// Speckles from the place seen to the last scatterers of the plate; 0.7 % of the light of a point
/// lie beyond.
const REACH: f64 = 30.0;

/// Points of the pupil along its diameter: the image of the lattice repeats after as many speckles.
const PUPIL: i32 = 128;

/// Angle between one point of a sunflower and the next.
const GOLDEN: f64 = 2.399_963_229_728_653;

/// A plate whose place at the origin is seen, and a wall above it.
pub(crate) struct Corner {
    pub(crate) view: CellGeometry,
    pub(crate) wall: Wall,
    /// Distance of a point source from the place seen, in metres; without one the light is
    /// collimated.
    pub(crate) source: Option<f64>,
    /// Scatterers of the plate; of the wall.
    pub(crate) sites: [usize; 2],
}

/// The lit part of a wall.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wall {
    pub(crate) centre: DVec3,
    /// From one edge to the other, or the diameters of a round part.
    pub(crate) sides: [DVec3; 2],
    pub(crate) is_round: bool,
}

impl Wall {
    /// Spreads a unit square evenly over the wall.
    fn point(&self, at: [f64; 2]) -> DVec3 {
        let [x, y] = if self.is_round {
            let (sin, cos) = (TAU * at[1]).sin_cos();
            [cos, sin].map(|direction| 0.5 * at[0].sqrt() * direction)
        } else {
            at.map(|x| x - 0.5)
        };
        self.centre + self.sides[0] * x + self.sides[1] * y
    }
}

/// What scatterers of unit amplitude send to the camera, for each wave number.
pub(crate) struct Waves {
    /// `[wave number][scatterer of the plate]`: light of the source.
    single: Vec<Vec<Complex<f64>>>,
    /// `[wave number][scatterer of the plate, scatterer of the wall]`: light by way of the wall.
    multiple: Vec<Vec<Complex<f64>>>,
}

/// Independent complex Gaussian amplitudes of the scatterers of a wall and of some plates before it.
pub(crate) struct Amplitudes {
    wall: Vec<Complex<f64>>,
    plates: Vec<Vec<Complex<f64>>>,
}

/// Fields at the place seen, `[plate][wave number]`, each of the mean square 1.
pub(crate) struct Fields {
    pub(crate) single: Vec<Vec<Complex<f64>>>,
    pub(crate) multiple: Vec<Vec<Complex<f64>>>,
}

impl Corner {
    pub(crate) fn speckle_size(&self) -> f64 {
        0.5 * self.view.wavelength / self.view.sin_aperture
    }

    fn light(&self, wave_number: f64) -> Illumination {
        let (wavelength, to_source) = (TAU / wave_number, self.view.to_source.normalize());
        match self.source {
            Some(distance) => Illumination::point(wavelength, to_source * distance),
            None => Illumination::plane(wavelength, -to_source),
        }
        .expect("a source")
    }

    /// The path from the source to a place, less that to the place seen.
    pub(crate) fn path_from_source(&self, place: DVec3) -> f64 {
        let to_source = self.view.to_source.normalize();
        match self.source {
            Some(distance) => place.distance(to_source * distance) - distance,
            None => -to_source.dot(place),
        }
    }

    /// Returns scatterers of the plate with the square roots of the areas for which they stand.
    /// They are as dense as the image of a point is bright, so that all count alike.
    fn plate(&self) -> Vec<(DVec3, f64)> {
        let sight = self.view.to_pupil.normalize();
        let (first, second) = sight.any_orthonormal_pair();
        let core = 0.6 * self.speckle_size();
        let last = 1.0 - 1.0_f64.hypot(REACH * self.speckle_size() / core).recip();
        let count = self.sites[0];
        let site = |i: usize| {
            let stretch = (1.0 - last * (i as f64 + 0.5) / count as f64).recip();
            let radius = core * (stretch * stretch - 1.0).sqrt();
            let (sin, cos) = (GOLDEN * i as f64).sin_cos();
            let across = (first * cos + second * sin) * radius;
            let normal = self.view.normal;
            let place = across - sight * (normal.dot(across) / normal.dot(sight));
            (place, stretch.powf(1.5))
        };
        (0..count).map(site).collect()
    }

    /// Returns scatterers that cover the wall evenly.
    pub(crate) fn lit_part(&self) -> Vec<DVec3> {
        let count = self.sites[1];
        let site = |i: usize| {
            let along = (i as f64 + 0.5) / count as f64;
            let turns = GOLDEN / TAU * i as f64;
            self.wall.point([along, turns.fract()])
        };
        (0..count).map(site).collect()
    }

    /// Returns the points of the pupil.
    fn pupil(&self) -> Vec<DVec3> {
        let sight = self.view.to_pupil.normalize();
        let (first, second) = sight.any_orthonormal_pair();
        let diameter = 2.0 * DISTANCE * self.view.sin_aperture;
        let places = || (-PUPIL / 2..PUPIL / 2).map(|i| (f64::from(i) + 0.5) / f64::from(PUPIL));
        let all = places().flat_map(|y| places().map(move |x| [x, y]));
        all.filter(|[x, y]| x.hypot(*y) <= 0.5)
            .map(|[x, y]| sight * DISTANCE + (first * x + second * y) * diameter)
            .collect()
    }

    /// Sums the waves of all scatterers after a motion of plate and wall, with the lens focused on
    /// the place seen.
    pub(crate) fn waves(&self, wave_numbers: &[f64], motion: &RigidMotion) -> Waves {
        let (plate, wall, pupil) = (self.plate(), self.lit_part(), self.pupil());
        let seen = motion.point(DVec3::ZERO);
        let mut waves = Waves {
            single: Vec::new(),
            multiple: Vec::new(),
        };
        for &wave_number in wave_numbers {
            let light = self.light(wave_number);
            // Waves take the same way back: the points of the pupil send out what arrives in phase
            // in focus.
            let focused = |&position: &DVec3| Scatterer {
                position,
                amplitude: turned(-wave_number * position.distance(seen))
                    / light.amplitude_at(position),
            };
            let lens = RoughSurface::from_scatterers(pupil.iter().map(focused).collect());
            let lens = lens.expect("a pupil").lit_by(&light);
            let wall = wall.iter().map(|&place| motion.point(place));
            let lit: Vec<_> = wall
                .map(|place| (place, light.amplitude_at(place)))
                .collect();
            let (mut single, mut multiple) = (Vec::new(), Vec::new());
            for &(place, root_of_area) in &plate {
                let place = motion.point(place);
                let to_camera = root_of_area * lens.field_at(place);
                single.push(to_camera * light.amplitude_at(place));
                multiple.extend(lit.iter().map(|&(from, amplitude)| {
                    let distance = from.distance(place);
                    to_camera * amplitude * turned(wave_number * distance) / distance
                }));
            }
            waves.single.push(unit(single));
            waves.multiple.push(unit(multiple));
        }
        waves
    }

    pub(crate) fn amplitudes(&self, plates: usize, random: &mut Random) -> Amplitudes {
        let mut gaussian = |count| (0..count).map(|_| random.complex_gaussian()).collect();
        Amplitudes {
            wall: gaussian(self.sites[1]),
            plates: (0..plates).map(|_| gaussian(self.sites[0])).collect(),
        }
    }

    /// Sums, in any unit, the waves of the wall on the first plate and those of the plate in the
    /// pupil.
    pub(crate) fn multiple_field(&self, wave_number: f64, of: &Amplitudes) -> Complex<f64> {
        let light = self.light(wave_number);
        let surface = |places: Vec<DVec3>, amplitudes: &[Complex<f64>]| {
            let scatterers = places.into_iter().zip(amplitudes);
            let scatterers = scatterers.map(|(position, &amplitude)| Scatterer {
                position,
                amplitude,
            });
            let surface = RoughSurface::from_scatterers(scatterers.collect());
            surface.expect("a surface").lit_by(&light)
        };
        let (plate, pupil) = (self.plate(), self.pupil());
        let wall = surface(self.lit_part(), &of.wall);
        // The plate is lit by the wall alone.
        let scattered = plate.iter().zip(&of.plates[0]);
        let scattered = scattered.map(|(&(place, root_of_area), amplitude)| {
            1e-6 * amplitude * root_of_area * wall.field_at(place) / light.amplitude_at(place)
        });
        let scattered: Vec<_> = scattered.collect();
        let plate = surface(plate.iter().map(|site| site.0).collect(), &scattered);
        let in_focus =
            |point: &DVec3| turned(-wave_number * point.length()) * plate.field_at(*point);
        pupil.iter().map(in_focus).sum()
    }

    /// Draws paths by way of the wall at random, as a path tracer does.
    pub(crate) fn draw_paths(&self, count: usize, random: &mut Random) -> Vec<DelayedLight> {
        let mut draw = || {
            let place = self.wall.point([random.uniform(), random.uniform()]);
            DelayedLight {
                weight: place.length_squared().recip(),
                delay: self.path_from_source(place) + place.length(),
            }
        };
        (0..count).map(|_| draw()).collect()
    }
}

impl Waves {
    /// Returns the fields of a wall and of the plates before it.
    pub(crate) fn fields(&self, Amplitudes { wall, plates }: &Amplitudes) -> Fields {
        let from_wall = |all: &Vec<Complex<f64>>| {
            let rows = all.chunks_exact(wall.len());
            rows.map(|row| dot(row, wall)).collect::<Vec<_>>()
        };
        let from_wall: Vec<_> = self.multiple.iter().map(from_wall).collect();
        let of_plates = |waves: &[Vec<Complex<f64>>]| {
            let of_plate = |plate: &Vec<_>| waves.iter().map(|waves| dot(waves, plate)).collect();
            plates.iter().map(of_plate).collect()
        };
        Fields {
            single: of_plates(&self.single),
            multiple: of_plates(&from_wall),
        }
    }
}

impl Fields {
    /// Returns intensities of the multiple light, `[wave number][plate]`.
    pub(crate) fn multiple_alone(&self) -> Vec<Vec<f64>> {
        let of_wave_number = |k: usize| self.multiple.iter().map(move |plate| plate[k].norm_sqr());
        (0..self.multiple[0].len())
            .map(|k| of_wave_number(k).collect())
            .collect()
    }

    /// Returns intensities, `[wave number][plate]`, with the multiple light so many times as bright
    /// as the single. What is polarised across the single light, another plate shows.
    pub(crate) fn intensities(&self, ratio: f64, is_depolarised: bool) -> Vec<Vec<f64>> {
        let share = if is_depolarised { 0.5 } else { 1.0 };
        let intensity = |plate: usize, k: usize| {
            let multiple = self.multiple[plate][k] * (share * ratio).sqrt();
            let parallel = (self.single[plate][k] + multiple).norm_sqr();
            let across = self.multiple[(plate + 1) % self.multiple.len()][k];
            parallel + (1.0 - share) * ratio * across.norm_sqr()
        };
        let of_wave_number = |k| {
            (0..self.single.len())
                .map(|plate| intensity(plate, k))
                .collect()
        };
        (0..self.single[0].len()).map(of_wave_number).collect()
    }
}

fn turned(phase: f64) -> Complex<f64> {
    Complex::from_polar(1.0, phase)
}

fn dot(first: &[Complex<f64>], second: &[Complex<f64>]) -> Complex<f64> {
    first.iter().zip(second).map(|(a, b)| a * b).sum()
}

/// Scales amplitudes to the sum 1 of their squares.
fn unit(mut all: Vec<Complex<f64>>) -> Vec<Complex<f64>> {
    let power: f64 = all.iter().map(Complex::norm_sqr).sum();
    for amplitude in &mut all {
        *amplitude /= power.sqrt();
    }
    all
}
