//! The irradiance over a plane across a beam.

use pyo3::prelude::*;
use tem00_optics as physics;

use super::map::{LIMIT, coordinate};
use crate::{arrays::Floats, error::OrRaise};

class! {
    /// The irradiance of a Gaussian beam of 1 W over a plane across it.
    ///
    /// The principal axes of the distribution are x and y, its centre is the origin. Powers are
    /// fractions of the whole, from 0 to 1; an aperture of negative size holds nothing.
    ///
    /// Parameters
    /// ----------
    /// radii : (float, float)
    ///     Principal radii (1/e²) along x and y, in metres, from 1e-30 to 1e30.
    "tem00.beam" CrossSection(physics::CrossSection): Copy
}

impl CrossSection {
    /// The cross-section of a beam that has radii at a coordinate `z`.
    pub(super) fn at(
        name: &'static str,
        z: f64,
        radii: impl Fn(f64) -> [f64; 2],
    ) -> PyResult<physics::CrossSection> {
        let section = physics::CrossSection::new(radii(coordinate(name, z)?));
        section.or_raise_renamed(&["radius"], name)
    }
}

methods! {
    impl CrossSection as this: this.0;

    make new(radii: [f64; 2]) =
        physics::CrossSection::new(radii).or_raise_renamed(&["radius"], "radii");

    /// Return the radius of the centred circle that holds a fraction of the power, in metres.
    ///
    /// Parameters
    /// ----------
    /// fraction : float or array_like
    ///     Fraction of the power, in [0, 1).
    ///
    /// Returns
    /// -------
    /// float or ndarray
    ///     Radius in metres, in the shape of ``fraction``.
    try_map circle_radius(fraction);

    /// Principal radii (1/e²), in metres, shape (2,).
    get radii -> Floats;

    /// Full widths at half maximum along x and y, in metres, shape (2,).
    get fwhm -> Floats;

    /// D4σ widths along x and y, in metres, shape (2,).
    get d4_sigma -> Floats;

    /// Distances, in metres, shape (2,), by which a knife edge moves along x and y between the
    /// positions that leave 10 % and 90 % of the power.
    get knife_edge_width -> Floats;

    /// Effective area ``π w_x w_y``, in m².
    get effective_area -> f64;

    /// Return the irradiance per watt of beam power, in 1/m².
    ///
    /// Parameters
    /// ----------
    /// x, y : float or array_like
    ///     Coordinates along the principal axes, in metres; they broadcast together.
    map irradiance_per_watt(x, y) = this.0.irradiance_per_watt([x, y]);

    /// Return the fraction of the power within a centred circle.
    ///
    /// Parameters
    /// ----------
    /// radius : float or array_like
    ///     Radius of the circle, in metres.
    map power_in_circle(radius);

    /// Return the fraction of the power that passes a slit across x.
    ///
    /// Parameters
    /// ----------
    /// centre, width : float or array_like
    ///     Middle of the slit on x and its full width, in metres; they broadcast together.
    map power_in_slit(centre, width);

    /// Return the fraction of the power that passes a knife edge across x.
    ///
    /// Parameters
    /// ----------
    /// position : float or array_like
    ///     Place of the edge on x, in metres; it covers everything below.
    map power_past_knife_edge(position);

    /// Return the fraction of the power within a rectangle.
    ///
    /// Parameters
    /// ----------
    /// centre : array_like, shape (..., 2)
    ///     Centre of the rectangle, in metres.
    /// size : array_like, shape (..., 2)
    ///     Full lengths of its sides along x and y, in metres.
    ///
    /// Returns
    /// -------
    /// float or ndarray
    ///     Fraction from 0 to 1, in the common shape of the leading axes.
    over power_in_rectangle(centre: 2, size: 2) -> [] =
        |[x, y, size @ ..]| [this.0.power_in_rectangle([x, y], size)];

    made_by new(radii);
}
