use tem00_numerics::{Refusal, check};

use crate::Medium;

/// Material whose scattering and absorption were measured in red, green and blue light.
///
/// Measured on thick samples, some of them food that was fresh; parts of the same name differ. Each
/// of the three values holds for its part of the spectrum: red from 580 to 700 nm, green from
/// 490 nm, blue from 400 nm.
///
/// # References
///
/// - H. W. Jensen, S. R. Marschner, M. Levoy, P. Hanrahan, *A practical model for subsurface light
///   transport*, SIGGRAPH 2001, table 1.
#[derive(Debug, PartialEq)]
pub struct Material {
    /// The name.
    pub name: &'static str,
    /// The refractive index.
    pub refractive_index: f64,
    /// The reduced scattering coefficients µs′ in red, green and blue light, in 1/m.
    pub reduced_scattering: [f64; 3],
    /// The absorption coefficients µa, likewise.
    pub absorption: [f64; 3],
}

impl Material {
    /// All materials that are known by name.
    pub const ALL: [Self; 11] = [
        Self::new("apple", 1.3, [2.29, 2.39, 1.97], [0.0030, 0.0034, 0.046]),
        Self::new("chicken_1", 1.3, [0.15, 0.21, 0.38], [0.015, 0.077, 0.19]),
        Self::new("chicken_2", 1.3, [0.19, 0.25, 0.32], [0.018, 0.088, 0.20]),
        Self::new("cream", 1.3, [7.38, 5.47, 3.15], [0.0002, 0.0028, 0.0163]),
        Self::new("ketchup", 1.3, [0.18, 0.07, 0.03], [0.061, 0.97, 1.45]),
        Self::new("marble", 1.5, [2.19, 2.62, 3.00], [0.0021, 0.0041, 0.0071]),
        Self::new("potato", 1.3, [0.68, 0.70, 0.55], [0.0024, 0.0090, 0.12]),
        Self::new(
            "skim_milk",
            1.3,
            [0.70, 1.22, 1.90],
            [0.0014, 0.0025, 0.0142],
        ),
        Self::new("skin_1", 1.3, [0.74, 0.88, 1.01], [0.032, 0.17, 0.48]),
        Self::new("skin_2", 1.3, [1.09, 1.59, 1.79], [0.013, 0.070, 0.145]),
        Self::new(
            "whole_milk",
            1.3,
            [2.55, 3.21, 3.77],
            [0.0011, 0.0024, 0.014],
        ),
    ];

    /// A row of the table, in 1/mm.
    const fn new(
        name: &'static str,
        refractive_index: f64,
        [r, g, b]: [f64; 3],
        [red, green, blue]: [f64; 3],
    ) -> Self {
        Self {
            name,
            refractive_index,
            reduced_scattering: [1e3 * r, 1e3 * g, 1e3 * b],
            absorption: [1e3 * red, 1e3 * green, 1e3 * blue],
        }
    }

    /// Returns all materials with their names.
    pub fn named() -> [(&'static str, &'static Self); 11] {
        let all = const { &Self::ALL };
        all.each_ref().map(|material| (material.name, material))
    }

    /// Returns the medium in light of a wavelength, in metres.
    ///
    /// # Errors
    ///
    /// Returns an error unless the wavelength is from 400 to 700 nm.
    pub fn medium(&self, wavelength: f64) -> Result<Medium, Refusal> {
        let holds = (400e-9..=700e-9).contains(&wavelength);
        let allowed = "from 400 nm to 700 nm, where the material was measured (in metres)";
        check::that(holds, "wavelength", wavelength, "", allowed)?;
        let band = match wavelength {
            580e-9.. => 0,
            490e-9.. => 1,
            _ => 2,
        };
        Medium::new(
            self.refractive_index,
            self.reduced_scattering[band],
            self.absorption[band],
        )
    }
}

/// Description of a medium: values of its own, and for the others a material.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MediumDescription {
    /// The material, whose values hold where no other is given.
    pub material: Option<&'static Material>,
    /// The transport length ℓ* = 1/µs′, in metres.
    pub transport_length: Option<f64>,
    /// The absorption coefficient µa, in 1/m.
    pub absorption: Option<f64>,
    /// The refractive index; 1.5 without a material.
    pub refractive_index: Option<f64>,
    /// The mean cosine g of the scattering angle.
    pub anisotropy: f64,
}

impl MediumDescription {
    /// Returns the medium in light of a wavelength, in metres.
    ///
    /// # Errors
    ///
    /// Returns an error if a value is out of range or missing, or if the material was not measured
    /// at the wavelength.
    pub fn medium(&self, wavelength: f64) -> Result<Medium, Refusal> {
        let known = self.material.map(|material| material.medium(wavelength));
        let known = known.transpose()?;
        let or = |value: Option<f64>, of: fn(&Medium) -> f64| value.or(known.as_ref().map(of));
        let index = or(self.refractive_index, Medium::refractive_index).unwrap_or(1.5);
        let length = or(self.transport_length, Medium::transport_length).unwrap_or_default();
        let length = check::range("transport_length", length, [1e-8, 1.0], "m")?;
        let absorption = or(self.absorption, Medium::absorption).unwrap_or_default();
        Medium::new(index, 1.0 / length, absorption)?.with_anisotropy(self.anisotropy)
    }
}
