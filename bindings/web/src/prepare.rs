//! Data for a JavaScript renderer that calls the function files itself: their text, a light, frames
//! and a stack.

use glam::DVec3;
use tem00_camera::{Camera, CameraDescription};
use tem00_coherence::Spectrum;
use tem00_numerics::cast::to_usize;
use tem00_shading::{BeamShape, Laser, LaserDescription, PlacedLight, Pose};
use tem00_speckle::{SpeckleStack, StackOptions, StackPlan};
use wasm_bindgen::prelude::{JsError, wasm_bindgen};

use crate::{code::FUNCTIONS, speckle};

/// The bytes that the slices may take.
const MEMORY: u64 = 32 << 20;

/// Returns the functions of lights, of the factor of a hit and what this calls in WGSL.
#[wasm_bindgen]
pub fn functions() -> String {
    FUNCTIONS.concat() + tem00_speckle::closed_form::WGSL
}

/// A laser spot and its speckle in the image of a camera, all lengths in metres.
#[wasm_bindgen]
#[derive(Debug)]
pub struct SpotSpeckle {
    camera: Camera,
    laser: Laser,
    plan: StackPlan,
    stack: SpeckleStack,
}

#[wasm_bindgen]
impl SpotSpeckle {
    /// Makes the speckle of a `beam` from `origin` that is in focus at `target`, on a part in the
    /// image of a `lens` at `eye` that looks at `look_at`, with y up, and is in focus there.
    ///
    /// The beam has a wavelength, a power in watts and a waist radius; the lens a focal length, an
    /// f-number, a field of view from edge to edge in degrees, and as many pixels along each edge.
    ///
    /// # Errors
    ///
    /// Returns an error where an array has another length, or the beam, the camera or the memory is
    /// refused.
    #[wasm_bindgen(constructor)]
    pub fn new(
        beam: &[f64],
        origin: &[f64],
        target: &[f64],
        lens: &[f64],
        eye: &[f64],
        look_at: &[f64],
        seed: u32,
    ) -> Result<Self, JsError> {
        let [wavelength, power, waist_radius] = numbers("beam", beam)?;
        let [focal_length, f_number, field_of_view, pixels] = numbers("lens", lens)?;
        let [origin, target] = [vector("origin", origin)?, vector("target", target)?];
        let [eye, look_at] = [vector("eye", eye)?, vector("look_at", look_at)?];
        let laser = Laser::new(LaserDescription {
            spectrum: Spectrum::monochromatic(wavelength)?,
            power,
            position: origin,
            look_at: target,
            line_direction: (target - origin).any_orthogonal_vector(),
            shape: BeamShape::Spot {
                waist_radius: [waist_radius; 2],
                waist_distance: [origin.distance(target); 2],
                m_squared: [1.0; 2],
            },
        })?;
        let focus_distance = eye.distance(look_at);
        let image_distance = focal_length * focus_distance / (focus_distance - focal_length);
        let edge = 2.0 * image_distance * (0.5 * field_of_view).to_radians().tan();
        let camera = Camera::new(CameraDescription {
            position: eye,
            look_at,
            focal_length,
            f_number,
            focus_distance,
            pixel_pitch: edge / pixels,
            resolution: [to_usize(pixels); 2],
            ..CameraDescription::default()
        })?;
        let geometry = camera.imaging_geometry(wavelength)?;
        let plan = speckle::plan([pixels; 2], &geometry, MEMORY)?;
        let stack = plan.stack(seed.into(), StackOptions::default())?;
        Ok(Self {
            camera,
            laser,
            plan,
            stack,
        })
    }

    /// Returns the light as the numbers of `Tem00SpotLight`.
    ///
    /// # Errors
    ///
    /// Returns an error if a number overflows in single precision.
    pub fn light(&self) -> Result<Vec<f32>, JsError> {
        let PlacedLight::Spot(light) = self.laser.placed() else {
            return Ok(Vec::new());
        };
        Ok(light.to_rows_f32().as_flattened().to_vec())
    }

    /// Returns the speckle of a part that has moved by `step`, as the numbers of
    /// `Tem00SpeckleFrame`.
    ///
    /// # Errors
    ///
    /// Returns an error unless `step` is three finite numbers.
    pub fn frame(&self, step: &[f64]) -> Result<Vec<f32>, JsError> {
        let pose = Pose::along(vector("step", step)?)?;
        let rows = speckle::frame(&self.camera, &self.laser, pose, &self.plan)?;
        Ok(rows.as_flattened().to_vec())
    }

    /// Returns the coefficients of all slices, row by row: real and imaginary parts.
    pub fn coefficients(&self) -> Vec<f32> {
        let slices = (0..self.stack.slice_count()).map(|slice| self.stack.coefficients(slice));
        let values = slices.flat_map(|slice| slice.values());
        values.flat_map(|value| [value.re, value.im]).collect()
    }

    /// Returns the laws of all slices, 14 rows of four numbers each.
    pub fn laws(&self) -> Vec<f32> {
        let rows = |slice| self.stack.slice_law(slice).rows(self.stack.size());
        let rows = (0..self.stack.slice_count()).flat_map(rows);
        rows.flatten().collect()
    }

    /// Returns the samples along an edge of the pattern.
    #[wasm_bindgen(getter)]
    pub fn size(&self) -> usize {
        self.stack.size()[0]
    }
}

fn vector(name: &str, values: &[f64]) -> Result<DVec3, JsError> {
    numbers(name, values).map(DVec3::from_array)
}

fn numbers<const N: usize>(name: &str, values: &[f64]) -> Result<[f64; N], JsError> {
    values.try_into().map_err(|_| {
        let count = values.len();
        JsError::new(&format!("`{name}` has {count} numbers: it must have {N}"))
    })
}
