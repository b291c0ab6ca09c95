use glam::DVec2;
use tem00_camera::Camera;
use tem00_numerics::{Grid, cast::to_f32};
use tem00_tracer::{Frame, WHITE_LIGHT_WAVELENGTH};
use tem00_triangulation::Sensor;

/// Electrons that a rendered frame frees in the pixels of a sensor, before any noise.
#[derive(Clone, Debug, PartialEq)]
pub struct Exposure {
    /// The mean number of electrons in each pixel.
    pub electrons: Grid<f32>,
    /// Image without speckle: the mean over all surfaces that look alike.
    pub without_speckle: Grid<f32>,
    /// The part of `without_speckle` that carries speckle.
    pub coherent: Grid<f32>,
    /// The part of `coherent` that met several rough surfaces.
    pub multiple: Grid<f32>,
}

impl Exposure {
    /// Exposes a sensor to a whole rendered frame.
    ///
    /// ```text
    /// E(pixel) = L(pixel) · E/L(pixel)          irradiance on the sensor from radiance
    /// μ_e      = Σ over the sources of η E A t λ / (h c)
    /// ```
    ///
    /// The light of each laser counts at its own wavelength, and the light of other lights at 550
    /// nm, all with the quantum efficiency of the sensor. The frame must have been rendered with
    /// the box filter of the sensitive part of the pixel; its layers are radiances averaged over
    /// it.
    ///
    /// # Panics
    ///
    /// Panics unless the frame is as large as the image of the camera.
    pub fn of_frame(frame: &Frame, camera: &Camera, sensor: &Sensor) -> Self {
        let [width, height] = [camera.width(), camera.height()];
        assert!(
            frame.lights.width() == width && frame.lights.height() == height,
            "a frame of {} × {} pixels for a camera of {width} × {height}",
            frame.lights.width(),
            frame.lights.height()
        );
        let dark = || Grid::filled(width, height, 0.0_f32);
        let mut exposure = Self {
            electrons: dark(),
            without_speckle: dark(),
            coherent: dark(),
            multiple: dark(),
        };
        for y in 0..height {
            for x in 0..width {
                exposure.expose_pixel(frame, (x, y), camera, sensor);
            }
        }
        exposure
    }

    fn expose_pixel(
        &mut self,
        frame: &Frame,
        at: (usize, usize),
        camera: &Camera,
        sensor: &Sensor,
    ) {
        let per_radiance = camera.irradiance_per_radiance(centre(at));
        let electrons = |radiance: f32, wavelength| {
            sensor.electrons(per_radiance * f64::from(radiance), wavelength)
        };
        let lights = electrons(frame.lights[at], WHITE_LIGHT_WAVELENGTH);
        let [mut total, mut mean, mut coherent, mut multiple] = [lights, lights, 0.0, 0.0];
        for laser in &frame.lasers {
            let count = |radiance| electrons(radiance, laser.wavelength);
            let of_several = count(laser.multiple[at]);
            let smooth = count(laser.single[at]) + of_several;
            total += count(laser.radiance[at]);
            mean += smooth;
            coherent += smooth;
            multiple += of_several;
        }
        self.electrons[at] = to_f32(total);
        self.without_speckle[at] = to_f32(mean);
        self.coherent[at] = to_f32(coherent);
        self.multiple[at] = to_f32(multiple);
    }
}

/// The centre of a pixel.
fn centre((x, y): (usize, usize)) -> DVec2 {
    DVec2::new(x as f64 + 0.5, y as f64 + 0.5)
}
