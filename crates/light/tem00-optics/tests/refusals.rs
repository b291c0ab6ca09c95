//! Arguments that constructors refuse, by name.

use core::f64::consts::FRAC_PI_2;

use tem00_beam::{AstigmaticBeam, GaussianBeam, LocatedBeam};
use tem00_optics::{
    AbcdMatrix, CausticFit, ComplexBeamParameter, CrossSection, KnifeEdgeFit, RadiusErrors,
    ThickLens, through_axes, through_lens,
};
use tem00_testkit::refuses;

const NAN: f64 = f64::NAN;
const INFINITE: f64 = f64::INFINITY;
const RED: f64 = 650e-9;

fn located(wavelength: f64) -> LocatedBeam {
    let beam = GaussianBeam::from_waist(wavelength, 1e-4).unwrap();
    LocatedBeam::new(beam, 0.0).unwrap()
}

#[test]
fn optical_elements() {
    refuses!(length = -0.1 => AbcdMatrix::free_space(length); length: [NAN, INFINITE, 2e30, -2e30]);
    refuses!(f = -0.1 => AbcdMatrix::thin_lens(f);
        f as "focal_length": [0.0, -1e-31, 1e31, NAN, INFINITE]);
    refuses!(curvature = -4.0 => AbcdMatrix::curved_mirror(curvature);
        curvature: [NAN, INFINITE, 2e30, -2e30]);
    refuses!(curvature = 1.0, angle = 1.5 => AbcdMatrix::tilted_mirror(curvature, angle);
        curvature: [NAN, -INFINITE, 2e30],
        angle as "angle_of_incidence": [FRAC_PI_2, -FRAC_PI_2, 3.0, 7.0, NAN, INFINITE],
    );
    refuses!(before = 1.0, after = 1.5, curvature = 1.0
        => AbcdMatrix::curved_interface(before, after, curvature);
        before as "index": [0.0, -1.5, 1e-4, 1e4, NAN, INFINITE],
        after as "index": [0.0, -1.5, 1e-4, 1e4, NAN, INFINITE],
        curvature: [NAN, INFINITE, 2e30],
    );
    refuses!(index = 1.5, gradient = 0.0, length = 1.0
        => AbcdMatrix::grin_rod(index, gradient, length);
        index: [0.0, 1e4, NAN],
        gradient: [-1.0, 2e30, NAN, INFINITE],
        length: [2e30, NAN, -INFINITE],
    );
    let lens = ThickLens {
        index: 1.5,
        front_curvature: 0.0,
        back_curvature: 0.0,
        thickness: 0.0,
    };
    refuses!(lens = lens => AbcdMatrix::thick_lens(&lens);
        lens.thickness: [-1.0, 2e30, NAN, INFINITE],
        lens.index: [0.0],
        lens.front_curvature as "curvature": [NAN],
        lens.back_curvature as "curvature": [INFINITE],
    );
    refuses!(entries = [1.0, 0.0, 0.5, 1.0]
        => { let [a, b, c, d] = entries; AbcdMatrix::new(a, b, c, d) };
        entries as "matrix": [[1.0, 0.0, NAN, 1.0], [INFINITE, 0.0, 0.0, 1.0]],
        entries as "determinant": [
            [1.0, 0.0, 0.0, 0.0],
            [-1.0, 0.0, 0.0, 1.0],
            [1e200, 0.0, 0.0, 1e200],
        ],
    );
    let glass = AbcdMatrix::flat_interface(1.0, 1.5).unwrap();
    let round = AstigmaticBeam::stigmatic(located(RED));
    refuses!(y = glass => through_axes(&round, [glass, y]);
        y as "determinant": [AbcdMatrix::identity()]);
    // A cone of 5/9.
    let wide = LocatedBeam::new(GaussianBeam::from_waist(RED, 5e-3).unwrap(), 0.0).unwrap();
    refuses!(f = 11e-3 => through_lens(&wide, f);
        f as "waist_radius": [9e-3], f as "focal_length": [0.0]);
}

#[test]
fn complex_parameters() {
    refuses!(z = -1.0, z_r = 1.0 => ComplexBeamParameter::new(z, z_r);
        z as "waist_distance": [NAN, INFINITE, 2e30],
        z_r as "rayleigh_range": [0.0, -1.0, 1e101, NAN, INFINITE],
    );
    refuses!(radius = 1e-3, curvature = 0.0, wavelength = 1e-6 =>
        ComplexBeamParameter::from_radius_and_curvature(radius, curvature, wavelength);
        radius: [0.0, -1.0, 1e101, NAN, INFINITE],
        curvature: [NAN, INFINITE, 2e30],
        wavelength: [0.0, -1.0, 1e101, NAN, INFINITE],
    );
    let q = ComplexBeamParameter::new(0.0, 1.0).unwrap();
    refuses!(wavelength = 1e-6 => q.radius(wavelength);
        wavelength: [0.0, -1.0, 1e101, NAN, INFINITE]);
    refuses!(m_squared = 1.0 => q.to_located_beam(1e-6, m_squared);
        m_squared: [0.99, -1.0, NAN, INFINITE]);
}

#[test]
fn measurements() {
    refuses!(radii = [1e-3, 1e-3] => CrossSection::new(radii);
        radii as "radius": [[0.0, 1.0], [1.0, -1.0], [1e31, 1.0], [NAN, 1.0], [1.0, INFINITE]]);
    let spot = CrossSection::new([1e-3, 2e-3]).unwrap();
    refuses!(fraction = 0.0 => spot.circle_radius(fraction);
        fraction: [-0.1, 1.0, 1.5, NAN, INFINITE]);

    const Z: [f64; 5] = [-2.0, -1.0, 0.0, 1.0, 2.0];
    const W: [f64; 5] = [2e-3, 1.4e-3, 1e-3, 1.41e-3, 2e-3];
    let with = |mut list: [f64; 5], value| {
        list[2] = value;
        list.to_vec()
    };
    refuses!(wavelength = RED, z = Z.to_vec(), radii = W.to_vec(), errors = W.to_vec() =>
        CausticFit::with_errors(wavelength, &z, &radii, RadiusErrors::Known(&errors));
        wavelength: [0.0, -1.0, NAN],
        z as "positions must be from -1e30 m to 1e30 m": [with(Z, NAN), with(Z, 2e30)],
        radii as "at index 2": [with(W, NAN), with(W, INFINITE), with(W, -1.0), with(W, 0.0)],
        errors as "at index 2": [with(W, NAN), with(W, INFINITE), with(W, -1.0), with(W, 0.0)],
        errors as "5 positions and 4 values": [W[1..].to_vec()],
        radii as "5 positions and 4 values": [W[1..].to_vec()],
        z as "positions must differ": [vec![1.0; 5]],
        radii as "do not determine": [vec![1e-3; 5]],
    );
    refuses!(count = 4 => CausticFit::new(RED, &Z[..count], &W[..count]);
        count as "at least 4 points, got 3": [3]);

    const P: [f64; 5] = [0.0, 0.1, 1.0, 1.9, 2.0];
    refuses!(x = Z.to_vec(), powers = P.to_vec() => KnifeEdgeFit::new(&x, &powers);
        x as "at index 2": [with(Z, NAN), with(Z, INFINITE), with(Z, -2e30)],
        powers as "at index 2": [with(P, NAN), with(P, INFINITE), with(P, -2e30)],
        x as "4 positions and 5 values": [Z[1..].to_vec()],
        x as "positions must differ": [vec![1.0; 5]],
        powers as "does not change": [vec![2.0; 5]],
        powers as "do not determine": [vec![0.0, 0.0, 0.0, 1.0, 1.0]],
    );
    refuses!(count = 4 => KnifeEdgeFit::new(&Z[..count], &P[..count]);
        count as "at least 4 points, got 3": [3]);
    refuses!(count = 5 => KnifeEdgeFit::with_background(&Z[..count], &P[..count]);
        count as "at least 5 points, got 4": [4]);
}
