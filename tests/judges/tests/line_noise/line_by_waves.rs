//! The line of a set-up, as a camera sees waves of a rough surface.

use tem00::{
    numerics::cast::to_usize,
    triangulation::{DetectorSettings, ImagedLine, LineDetector, LinePoint, Setup},
    wave::{
        Amplitudes, Arrangement, Camera, DVec2, DVec3, FanDescription, Grid, Illumination,
        ImageSampling, ImageWindow, Lens, PatchDescription, RoughSurface, Roughness,
    },
};

/// Pixels along each side of an image.
pub(super) const PIXELS: usize = 56;

/// Least number of samples of a speckle along each side.
const SAMPLES_PER_SPECKLE: f64 = 4.5;

/// Speckles at each end of the line that are not looked at.
const END: f64 = 3.0;

/// The distance at which waves see the part, whatever that of the set-up: magnification, speckle
/// size and blur make the image.
const DISTANCE: f64 = 0.3;

/// What is judged: the line of a set-up at a height.
pub(super) struct Judged {
    pub line: ImagedLine,
    pitch: f64,
    wavelength: f64,
    detector: LineDetector,
}

impl Judged {
    pub(super) fn new(setup: &Setup, height: f64) -> Self {
        let d = setup.description();
        let detector = LineDetector::new(DetectorSettings {
            min_peak: 0.0,
            saturation: f64::INFINITY,
            ..*setup.detector().settings()
        });
        Self {
            line: setup.line_at(height).expect("a line"),
            pitch: d.sensor.pixel_pitch,
            wavelength: d.laser.light.wavelength,
            detector: detector.expect("a detector"),
        }
    }

    /// Pixels at each end of the line that are not looked at.
    pub(super) fn ends(&self) -> usize {
        whole(END * self.line.speckle_size[0] + 0.5 * self.line.blur)
    }

    /// Returns how far the detector finds lines from where they are, in pixels, column by column of
    /// each image.
    pub(super) fn deviations(&self, images: &[(Grid<f32>, f64)]) -> Vec<Vec<f64>> {
        let of_image = |(columns, middle): &(Grid<f32>, f64)| {
            let brightest = |points: Vec<LinePoint>| {
                let best = points.into_iter().max_by(|a, b| a.peak.total_cmp(&b.peak));
                best.expect("a line").position - middle
            };
            let found = self.detector.detect(columns).into_iter();
            found.map(brightest).collect()
        };
        images.iter().map(of_image).collect()
    }
}

/// A camera that sees such a line, from above, as wide, as far out of focus and with speckle as
/// large.
pub(super) struct Waves {
    window: ImageWindow,
    light: Illumination,
    patch: PatchDescription,
    samples: usize,
    end: usize,
}

impl Waves {
    fn of(judged: &Judged) -> Self {
        let Judged {
            line,
            pitch,
            wavelength,
            ..
        } = judged;
        let pupil_diameter = 3e-3;
        let [_, speckle] = line.speckle_size;
        let pupil_to_image = speckle * pitch * pupil_diameter / wavelength;
        // b = D s |1/Z_focus − 1/Z|
        let defocus = line.blur * pitch / (pupil_diameter * pupil_to_image);
        let lens = Lens {
            pupil_diameter,
            focus_distance: (DISTANCE.recip() + defocus).recip(),
            pupil_to_image,
        };
        let eye = DVec3::new(0.0, 0.0, DISTANCE);
        let camera = Camera::look_at([eye, DVec3::ZERO], DVec3::X, lens).expect("a camera");
        let samples = whole(SAMPLES_PER_SPECKLE / speckle);
        let sampling = ImageSampling {
            wavelength: *wavelength,
            centre: DVec2::ZERO,
            step: pitch / samples as f64,
            samples: PIXELS * samples,
        };
        // On the part, in units of a pixel.
        let pixel = pitch * DISTANCE / pupil_to_image;
        let radius = 0.5 * line.projected_thickness;
        let light = Illumination::fan(&FanDescription {
            wavelength: *wavelength,
            apex: DVec3::Z,
            direction: DVec3::NEG_Z,
            opening: DVec3::Y,
            half_angle: 0.1,
            waist_radius: radius * pixel,
            waist_distance: 1.0,
        });
        // Independent scatterers so close that the squared pupil function does not see their
        // lattice, out to 1e-4 of the irradiance.
        let [across, along] = [4.4 * radius, PIXELS as f64 + line.blur];
        let spacing = [(0.5 * radius).min(0.75 * speckle), 0.8 * speckle];
        Self {
            window: ImageWindow::new(&camera, &sampling).expect("a window"),
            light: light.expect("a line"),
            patch: PatchDescription {
                centre: DVec3::ZERO,
                normal: DVec3::Z,
                along: DVec3::X,
                size: [across * pixel, along * pixel],
                scatterers: [whole(across / spacing[0]), whole(along / spacing[1])],
                arrangement: Arrangement::Lattice,
                roughness: Roughness::FullyDeveloped(Amplitudes::ComplexGaussian),
                seed: 0,
            },
            samples,
            end: judged.ends(),
        }
    }

    /// Returns so many images, each with the place of its line.
    pub(super) fn images(judged: &Judged, count: u64) -> Vec<(Grid<f32>, f64)> {
        let waves = Self::of(judged);
        (0..count).map(|seed| waves.columns(seed)).collect()
    }

    /// Returns what pixels see of one surface, with the line along the rows, and its place across
    /// them.
    ///
    /// `seed` moves the pixels by samples, too.
    fn columns(&self, seed: u64) -> (Grid<f32>, f64) {
        let surface = RoughSurface::patch(&PatchDescription { seed, ..self.patch });
        let lit = surface.expect("a surface").lit_by(&self.light);
        let image = self.window.image(&lit).intensity();
        let phase = usize::try_from(seed).expect("a small number") % self.samples;
        let pixel = |x: usize, y: usize| {
            let samples = (0..self.samples * self.samples).map(|i| {
                let (column, row) = (i % self.samples, i / self.samples);
                let row = (self.samples * y + row + phase) % image.height();
                image[(self.samples * (x + self.end) + column, row)]
            });
            samples.sum::<f32>()
        };
        let columns = Grid::from_fn(PIXELS - 2 * self.end, PIXELS, pixel);
        // Sample i is the middle of the i-th part of the column.
        let middle = (image.height() / 2 - phase) as f64 + 0.5;
        (columns, middle / self.samples as f64)
    }
}

/// Returns the whole number from a small one on.
fn whole(number: f64) -> usize {
    to_usize(number.ceil())
}
