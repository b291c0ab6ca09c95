//! What a renderer in JavaScript needs to call the function files itself: their text, lights and stacks.

use glam::DVec3;
use tem00_beam::{GaussianBeam, Placement, SpotLight};
use tem00_speckle::{PupilField, SlicePath, SpeckleStack};
use wasm_bindgen::prelude::{JsError, wasm_bindgen};

/// Returns the functions of lights, speckle and its motion in WGSL.
#[wasm_bindgen]
pub fn functions() -> String {
    [
        tem00_beam::closed_form::WGSL,
        tem00_decorrelation::closed_form::WGSL,
        tem00_speckle::closed_form::WGSL,
    ]
    .join("\n")
}

/// Returns a laser spot from `origin` along `direction`, as the numbers of `Tem00SpotLight`: a beam of this wavelength in metres
/// and this power in watts, with its waist radius at that distance, both in metres.
///
/// # Errors
///
/// Returns an error unless `origin` and `direction` are three numbers each, and where the beam or its place is refused.
#[wasm_bindgen]
pub fn spot(
    wavelength: f64,
    power: f64,
    waist_radius: f64,
    waist_distance: f64,
    origin: &[f64],
    direction: &[f64],
) -> Result<Vec<f32>, JsError> {
    let direction = vector("direction", direction)?;
    let placement = Placement {
        origin: vector("origin", origin)?,
        direction,
        fan_axis: direction.any_orthogonal_vector(),
    };
    let beam = GaussianBeam::from_waist(wavelength, waist_radius)?;
    let light = SpotLight::place(&beam, waist_distance, &placement, power)?.to_f32()?;
    Ok(light.to_rows().as_flattened().to_vec())
}

fn vector(name: &str, numbers: &[f64]) -> Result<DVec3, JsError> {
    let numbers: [f64; 3] = numbers.try_into().map_err(|_| {
        let count = numbers.len();
        JsError::new(&format!("`{name}` has {count} numbers: it must have 3"))
    })?;
    Ok(DVec3::from(numbers))
}

/// A stack made by the library, for look-ups in a shader.
#[wasm_bindgen]
#[derive(Debug)]
pub struct Stack {
    stack: SpeckleStack,
}

#[wasm_bindgen]
impl Stack {
    /// Makes a square pattern of `size` samples with a pupil of `diameter` lattice points from a seed, and as many slices as
    /// twice `half_period`; one, that never changes, for 0.
    ///
    /// # Errors
    ///
    /// Returns an error where the sizes are refused.
    #[wasm_bindgen(constructor)]
    pub fn new(
        size: usize,
        diameter: usize,
        half_period: usize,
        seed: u32,
    ) -> Result<Self, JsError> {
        let field = PupilField::new(size, diameter, u64::from(seed))?;
        let path = match half_period {
            0 => SlicePath::Still,
            half_period => SlicePath::Straight {
                half_period,
                length: 2,
            },
        };
        Ok(Self {
            stack: SpeckleStack::generate(&field, path)?,
        })
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

    /// Returns the number of slices.
    #[wasm_bindgen(getter)]
    pub fn slices(&self) -> usize {
        self.stack.slice_count()
    }
}
