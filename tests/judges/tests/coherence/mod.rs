//! Speckle of light of finite bandwidth and of several directions, judged by wave optics from first
//! principles.
//!
//! The judge sums the waves of thousands of scatterers with exact distances, one wavelength and one
//! direction after the other, and adds the intensities of the images. It knows nothing of tilts, overlaps of pupils
//! or path spreads.

mod bench;
mod comparison;
mod contrast;
mod corner;
mod extended_source;
mod grains;
mod heights;
mod line_noise;
mod moving_corner;
mod relief;
mod rendered_corner;
mod several_surfaces;
mod slab;
mod speckle_of_speckle;
mod sums;
