//! A rough plate without edges, seen in many wavelengths by an ideal lens.

use core::f64::consts::TAU;

use tem00::{
    coherence::{CellGeometry, PeakShape, Spectrum},
    numerics::{Fft2, Grid},
    wave::{Complex, DVec3, Illumination, RoughSurface, Scatterer},
};

use super::heights::{Heights, Random};

/// Distance from the plate to the pupil, in metres.
pub(crate) const DISTANCE: f64 = 0.5;

/// A plate and its camera.
///
/// The pupil is a lattice of points so far apart that the image repeats with the period of the
/// patch, and wave numbers are as many whole steps apart as the paths across the patch make whole
/// periods. So no wave sees an edge: even a patch of 24 speckles with edges would lack 1 % of the
/// light and have 1 % too much contrast. The lattice has another offset for each surface, so that
/// it counts areas rightly on average.
pub(crate) struct Bench {
    pub(crate) view: CellGeometry,
    /// Speckles after which the patch repeats, along the gradient of the paths and across it.
    size: [usize; 2],
    heights: Heights,
    pub(crate) axes: [DVec3; 2],
    /// Difference of neighbouring wave numbers, in rad/m.
    pub(crate) step: f64,
}

/// What a camera does with the light: where its pupil stands, in diameters along both axes, and how
/// far behind the plane of focus the plate is, in metres.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct View {
    pub(crate) pupil: [f64; 2],
    pub(crate) defocus: f64,
}

/// A plane wave.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Light {
    pub(crate) to_source: DVec3,
    pub(crate) wave_number: f64,
}

impl Bench {
    /// A bench of a camera that sees paths of different lengths over the plate.
    pub(crate) fn new(view: CellGeometry, size: [usize; 2], heights: Heights) -> Self {
        Self::with_step(view, size, heights, 0.0)
    }

    /// A bench with a step of the wave numbers where the paths over the plate are equally long.
    pub(crate) fn with_step(
        view: CellGeometry,
        size: [usize; 2],
        heights: Heights,
        step: f64,
    ) -> Self {
        let to_pupil = view.to_pupil.normalize();
        let any = to_pupil.any_orthonormal_pair();
        let mut bench = Self {
            view,
            size,
            heights,
            axes: any.into(),
            step,
        };
        let gradient = bench.path_gradient();
        if gradient.length() > 1e-6 {
            let along = gradient.normalize();
            bench.axes = [along, to_pupil.cross(along)];
            bench.step = TAU / (gradient.length() * bench.period(0));
        }
        bench
    }

    /// The change of the path from the source over the plate to the pupil, per length on the object
    /// across the view.
    fn path_gradient(&self) -> DVec3 {
        let source = self.view.to_source.normalize();
        let path = |across: DVec3| {
            let point = self.on_plate(across);
            -source.dot(point) + point.distance(self.pupil_centre())
        };
        let change = |axis: DVec3| (path(axis * 1e-6) - path(axis * -1e-6)) / 2e-6;
        self.axes.iter().map(|&axis| axis * change(axis)).sum()
    }

    /// The point of the plate that is seen at an offset across the line of sight.
    pub(crate) fn on_plate(&self, across: DVec3) -> DVec3 {
        let (normal, sight) = (self.view.normal, self.view.to_pupil.normalize());
        across - sight * (normal.dot(across) / normal.dot(sight))
    }

    fn pupil_centre(&self) -> DVec3 {
        self.view.to_pupil.normalize() * DISTANCE
    }

    pub(crate) fn speckle_size(&self) -> f64 {
        0.5 * self.view.wavelength / self.view.sin_aperture
    }

    pub(crate) fn period(&self, axis: usize) -> f64 {
        self.size[axis] as f64 * self.speckle_size()
    }

    /// Columns and rows of the images, two to a speckle.
    pub(crate) fn pixels(&self) -> [usize; 2] {
        self.size.map(|size| 2 * size)
    }

    /// Scatterers on a lattice, of independent complex Gaussian amplitudes where heights do not
    /// make the phases, times a factor by the place along the gradient, in speckles from the
    /// middle.
    pub(crate) fn surface(&self, random: &mut Random, lit: impl Fn(f64) -> f64) -> RoughSurface {
        let density = self.heights.sites_per_speckle();
        let [columns, rows] = self.size.map(|size| size * density);
        let heights = self.heights.over([columns, rows], density, random);
        let mut scatterers = Vec::new();
        for (site, heights) in heights.iter().enumerate() {
            let from_middle =
                |i: usize, count: usize| (i as f64 + 0.5 - 0.5 * count as f64) / density as f64;
            let at = [
                from_middle(site % columns, columns),
                from_middle(site / columns, rows),
            ];
            let across = (self.axes[0] * at[0] + self.axes[1] * at[1]) * self.speckle_size();
            let brightness = lit(at[0]);
            scatterers.extend(heights.iter().map(|&height| Scatterer {
                position: self.on_plate(across) + self.view.normal * height,
                amplitude: brightness
                    * match self.heights {
                        Heights::Alone { .. } => Complex::new(1.0, 0.0),
                        _ => random.complex_gaussian(),
                    },
            }));
        }
        RoughSurface::from_scatterers(scatterers).expect("a surface")
    }

    /// The intensities of a surface in views of it, for wave numbers up to `steps` steps off:
    /// `[view][wave number][pixel]`.
    pub(crate) fn images(
        &self,
        surface: &RoughSurface,
        steps: i32,
        views: &[View],
        random: &mut Random,
    ) -> Vec<Vec<Vec<f64>>> {
        let light = |step| Light {
            to_source: self.view.to_source,
            wave_number: self.wave_number(f64::from(step)),
        };
        let lights: Vec<_> = (-steps..=steps).map(light).collect();
        self.images_in(surface, &lights, views, random)
    }

    /// The wave number so many steps off.
    pub(crate) fn wave_number(&self, steps: f64) -> f64 {
        TAU / self.view.wavelength + steps * self.step
    }

    /// The intensities of a surface in views of it, for any lights: `[view][light][pixel]`.
    pub(crate) fn images_in(
        &self,
        surface: &RoughSurface,
        lights: &[Light],
        views: &[View],
        random: &mut Random,
    ) -> Vec<Vec<Vec<f64>>> {
        let offset = [random.uniform() - 0.5, random.uniform() - 0.5];
        let mut images = vec![Vec::new(); views.len()];
        let [columns, rows] = self.pixels();
        let transform = Fft2::new(columns, rows)
            .expect("a transform")
            .on_one_thread();
        for light in lights {
            let field = self.field(surface, light, views, offset);
            for (image, view) in images.iter_mut().zip(views) {
                image.push(self.image(&field, light.wave_number, view, &transform));
            }
        }
        images
    }

    /// The waves at the points of the pupil lattice that any view needs.
    fn field(
        &self,
        surface: &RoughSurface,
        light: &Light,
        views: &[View],
        offset: [f64; 2],
    ) -> Vec<Sample> {
        let wavelength = TAU / light.wave_number;
        let light = Illumination::plane(wavelength, -light.to_source).expect("a plane wave");
        let lit = surface.lit_by(&light);
        let diameter = 2.0 * DISTANCE * self.view.sin_aperture;
        let spacing = [0, 1].map(|axis| wavelength * DISTANCE / self.period(axis) / diameter);
        let mut samples = Vec::new();
        let reach = [0, 1].map(|axis| (1.2 / spacing[axis]).ceil());
        let along = |axis: usize| {
            let reach = reach[axis];
            (0..)
                .map(move |i| f64::from(i) - reach)
                .take_while(move |i| *i <= reach)
        };
        for (i, j) in along(1).flat_map(|j| along(0).map(move |i| (i, j))) {
            let at = [(i + offset[0]) * spacing[0], (j + offset[1]) * spacing[1]];
            if !views.iter().any(|view| view.is_open(at)) {
                continue;
            }
            let point =
                self.pupil_centre() + (self.axes[0] * at[0] + self.axes[1] * at[1]) * diameter;
            samples.push(Sample {
                index: [i, j],
                at,
                point,
                field: lit.field_at(point),
            });
        }
        samples
    }

    /// The Fourier transform of the field in the pupil, with the paths to the point in focus taken
    /// off.
    fn image(&self, field: &[Sample], wave_number: f64, view: &View, transform: &Fft2) -> Vec<f64> {
        let focus = self.view.to_pupil.normalize() * view.defocus;
        let size = self.pixels();
        let mut pupil = Grid::filled(size[0], size[1], Complex::new(0.0_f32, 0.0));
        let mut open = 0.0;
        for sample in field.iter().filter(|sample| view.is_open(sample.at)) {
            let turns = wave_number / TAU * (sample.point.distance(focus) - DISTANCE);
            let value = sample.field * Complex::from_polar(1.0, -TAU * turns.fract());
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "the transform works in f32, and on indices modulo its size"
            )]
            {
                let [i, j] = [0, 1].map(|k| sample.index[k].rem_euclid(size[k] as f64) as usize);
                pupil[(i, j)] = Complex::new(value.re as f32, value.im as f32);
            }
            open += 1.0;
        }
        let image = transform.forward(&pupil, |_, _, value: Complex<f32>| {
            f64::from(value.norm_sqr()) / open
        });
        image.values().to_vec()
    }
}

struct Sample {
    index: [f64; 2],
    /// In diameters of the pupil.
    at: [f64; 2],
    point: DVec3,
    field: Complex<f64>,
}

impl View {
    fn is_open(&self, at: [f64; 2]) -> bool {
        (at[0] - self.pupil[0]).hypot(at[1] - self.pupil[1]) <= 0.5
    }
}

/// A camera and a source in one plane, by their angles in degrees, with sin u = 0.025.
pub(crate) fn plane_of_incidence(incidence: f64, observation: f64) -> CellGeometry {
    let direction = |degrees: f64| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        DVec3::new(sin, 0.0, cos)
    };
    CellGeometry {
        to_source: direction(incidence),
        to_pupil: direction(observation),
        normal: DVec3::Z,
        sin_aperture: 0.025,
        wavelength: 450e-9,
    }
}

/// A spectrum as the judge has it, fractions of the power at the wave numbers of a bench, and as
/// the judged.
pub(crate) struct BenchSpectrum {
    pub(crate) name: &'static str,
    pub(crate) weights: Vec<f64>,
    pub(crate) line: Spectrum,
}

impl BenchSpectrum {
    /// Returns the mean of images of all wave numbers.
    pub(crate) fn mix(&self, images: &[Vec<f64>]) -> Vec<f64> {
        let mut sum = vec![0.0; images[0].len()];
        for (image, weight) in images.iter().zip(&self.weights) {
            if *weight > 0.0 {
                for (sum, value) in sum.iter_mut().zip(image) {
                    *sum += weight * value;
                }
            }
        }
        sum
    }

    /// A Gaussian line by its full width, in metres.
    pub(crate) fn gaussian(wavelength: f64, step: f64, steps: i32, linewidth: f64) -> Self {
        let line = Spectrum::new(wavelength, linewidth, PeakShape::Gaussian);
        let full = TAU * linewidth / wavelength.powi(2);
        let spread = full / (8.0 * core::f64::consts::LN_2).sqrt() / step;
        Self {
            name: "gaussian",
            weights: weights(steps, |i| (-0.5 * (i / spread).powi(2)).exp()),
            line: line.expect("a line"),
        }
    }
}

/// Returns fractions of the power from a shape over the numbers of steps.
pub(crate) fn weights(steps: i32, shape: impl Fn(f64) -> f64) -> Vec<f64> {
    let values: Vec<f64> = (-steps..=steps).map(|i| shape(f64::from(i))).collect();
    let total: f64 = values.iter().sum();
    values.iter().map(|value| value / total).collect()
}
