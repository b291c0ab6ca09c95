//! Straight rays, drawn from the phase-space density, carry the beam: its radius, its curvature and
//! its irradiance on any surface; and evaluation, sampling and densities agree.
//!
//! All seeds are fixed. A correct sampler fails a single test with a probability of about 1e−4,
//! stated where it is used.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tem00_beam::{
    AstigmaticBeam, DVec3, Emitter, FanGeometry, FocusCurve, GaussianBeam, LaserLine, LineLight,
    LineProfile, LocatedBeam, Placement, RaySample, SpotLight, TabulatedLineLight,
};

use crate::lines::{profiles, slopes};

const WAVELENGTH: f64 = 650e-9;
const POWER: f64 = 5e-3;
/// Standard normal variates exceed this magnitude with probability 1e−4.
const SIGMAS: f64 = 3.9;

/// A frame in general position.
fn placement() -> Placement {
    Placement {
        origin: DVec3::new(0.1, -0.2, 0.3),
        direction: DVec3::new(0.3, -0.5, 0.8),
        fan_axis: DVec3::new(1.0, 0.2, 0.1),
    }
}

fn spot(waist: f64, m_squared: f64, waist_distance: f64) -> (GaussianBeam, SpotLight) {
    let beam = GaussianBeam::from_waist(WAVELENGTH, waist)
        .and_then(|beam| beam.with_m_squared(m_squared))
        .expect("a valid beam");
    let light = SpotLight::place(&beam, waist_distance, &placement(), POWER);
    (beam, light.expect("a valid light"))
}

/// A fan of 30° from an apex 2 mm behind the lens, in focus at 0.2 m.
const FAN: FanGeometry = FanGeometry {
    fan_angle: 0.523_598_775_598_298_8,
    apex_offset: 2e-3,
    focus_distance: 0.2,
    focus_curve: FocusCurve::EqualDistance,
};

fn line(profile: LineProfile, fan: FanGeometry) -> LaserLine {
    let focus = GaussianBeam::from_waist(WAVELENGTH, 50e-6).expect("a valid beam");
    LaserLine::new(focus, fan, profile).expect("a valid line")
}

/// Lines of every profile, with each of the two curves of focus.
fn lines(fan: FanGeometry) -> impl Iterator<Item = LaserLine> {
    let curves = [FocusCurve::EqualDistance, FocusCurve::EqualPlane];
    curves.into_iter().flat_map(move |focus_curve| {
        let fan = FanGeometry { focus_curve, ..fan };
        profiles(fan.fan_angle).map(|profile| line(profile, fan))
    })
}

/// Places a line as the light that its profile needs.
fn place(line: &LaserLine) -> Box<dyn Emitter + '_> {
    match line.profile() {
        LineProfile::Tabulated(_) => {
            Box::new(TabulatedLineLight::place(line, &placement(), POWER).expect("a valid light"))
        }
        _ => Box::new(LineLight::place(line, &placement(), POWER).expect("a valid light")),
    }
}

/// The local axes of all lights.
fn line_axes() -> [DVec3; 3] {
    let ez = placement().direction.normalize();
    let ey = ez.cross(placement().fan_axis).normalize();
    [ey.cross(ez), ey, ez]
}

fn rng() -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(2016)
}

fn rays(light: &dyn Emitter, count: usize) -> Vec<RaySample> {
    let mut rng = rng();
    (0..count).map(|_| light.sample_ray(rng.random())).collect()
}

/// The local axes of a light, as rows.
fn axes(ex: [f64; 3], ey: [f64; 3], ez: [f64; 3]) -> [DVec3; 3] {
    [ex, ey, ez].map(DVec3::from)
}

/// World coordinates of a point given in the frame of the light.
fn world(axes: [DVec3; 3], local: DVec3) -> [f64; 3] {
    let [ex, ey, ez] = axes;
    (placement().origin + local.x * ex + local.y * ey + local.z * ez).to_array()
}

/// The position and slope of a ray, in the frame of the light, at the distance z.
fn crossing(axes: [DVec3; 3], ray: &RaySample, z: f64) -> (DVec3, DVec3) {
    let rotate = |v: DVec3| DVec3::new(v.dot(axes[0]), v.dot(axes[1]), v.dot(axes[2]));
    let origin = rotate(DVec3::from(ray.origin) - placement().origin);
    let direction = rotate(DVec3::from(ray.direction));
    let slope = direction / direction.z;
    (origin + slope * (z - origin.z), slope)
}

#[test]
fn rays_of_a_spot_reproduce_radius_and_curvature() {
    const COUNT: usize = 100_000;
    let n = COUNT as f64;
    for m_squared in [1.0, 3.0] {
        let (beam, light) = spot(50e-6, m_squared, 0.15);
        let axes = axes(light.ex, light.ey, light.ez);
        let rays = rays(&light, COUNT);
        for z in [0.0, 0.1, 0.15, 0.2, 1.0] {
            let sums = rays.iter().fold([0.0; 5], |mut sums, ray| {
                let (p, s) = crossing(axes, ray, z);
                for (sum, term) in sums
                    .iter_mut()
                    .zip([p.x, p.y, p.x * p.x, p.y * p.y, p.x * s.x])
                {
                    *sum += term;
                }
                sums
            });
            let [x, y, xx, yy, xs] = sums.map(|sum| sum / n);
            let from_waist = z - 0.15;
            let sigma = 0.5 * beam.radius_at(from_waist);
            for mean in [x, y] {
                assert!(
                    mean.abs() < SIGMAS * sigma / n.sqrt(),
                    "M² = {m_squared}, z = {z}: mean {mean:e}"
                );
            }
            // The variance of n normal variates has a relative deviation of √(2/n).
            for variance in [xx, yy] {
                let ratio = variance / (sigma * sigma) - 1.0;
                assert!(
                    ratio.abs() < SIGMAS * (2.0 / n).sqrt(),
                    "M² = {m_squared}, z = {z}: variance off by {ratio:e}"
                );
            }
            // The slope at a given x is spread by w₀ δ / 2w about x / R.
            let spread = 0.5 * beam.waist_radius() * beam.divergence() / beam.radius_at(from_waist);
            let curvature = xs / xx;
            let error = curvature - beam.curvature_at(from_waist);
            assert!(
                error.abs() < SIGMAS * spread / (sigma * n.sqrt()),
                "M² = {m_squared}, z = {z}: 1/R off by {error:e}"
            );
        }
    }
}

#[test]
fn rays_of_a_line_reproduce_its_thickness() {
    const COUNT: usize = 50_000;
    let n = COUNT as f64;
    for line in lines(FAN) {
        let light = place(&line);
        let rays = rays(&*light, COUNT);
        for r in [0.01, 0.202, 0.5] {
            // On the cylinder of slant distance r from the virtual apex, in units of σ = w/2.
            let mean_square: f64 = rays
                .iter()
                .map(|ray| {
                    let (p, s) = crossing(line_axes(), ray, 0.0);
                    let sigma = 0.5
                        * line
                            .focus()
                            .radius_at(r - line.waist_slant_distance_at(s.x));
                    let along = r / 1_f64.hypot(s.x) - FAN.apex_offset;
                    let y = p.y + s.y * along;
                    (y / sigma).powi(2) / n
                })
                .sum();
            assert!(
                (mean_square - 1.0).abs() < SIGMAS * (2.0 / n).sqrt(),
                "{line:?}, r = {r}: {mean_square}"
            );
        }
    }
}

#[test]
fn rays_of_a_wide_fan_pass_apex_and_waist_within_diffraction() {
    const COUNT: usize = 50_000;
    let n = COUNT as f64;
    let fan = FanGeometry {
        fan_angle: 120_f64.to_radians(),
        apex_offset: 0.3,
        ..FAN
    };
    for line in lines(fan) {
        let light = place(&line);
        let [mut at_apex, mut at_waist] = [0.0; 2];
        for ray in rays(&*light, COUNT) {
            let (p, s) = crossing(line_axes(), &ray, 0.0);
            let sec = 1_f64.hypot(s.x);
            let b = (p.x - fan.apex_offset * s.x) / sec;
            let along = (p.x * s.x + fan.apex_offset) / sec;
            let y = p.y + s.y / sec * (line.waist_slant_distance_at(s.x) - along);
            at_apex += (2.0 * b / line.source_radius()).powi(2) / n;
            at_waist += (2.0 * y / line.focus().waist_radius()).powi(2) / n;
        }
        for mean_square in [at_apex, at_waist] {
            assert!(
                (mean_square - 1.0).abs() < SIGMAS * (2.0 / n).sqrt(),
                "{line:?}: {at_apex}, {at_waist}"
            );
        }
    }
}

/// The value that χ² with `freedom` degrees exceeds with probability 1e−4 (Wilson and Hilferty
/// 1931).
fn chi_square_limit(freedom: f64) -> f64 {
    const QUANTILE: f64 = 3.719;
    let spread = 2.0 / (9.0 * freedom);
    freedom * (1.0 - spread + QUANTILE * spread.sqrt()).powi(3)
}

/// Bins on each side of a rectangle, points of the quadrature on each side of a bin, and rays.
const BINS: usize = 16;
const FINE: usize = 12;
const RAYS: usize = 60_000;

/// χ² of samples (s, t) in bins up to ±`half`, against their probability density, and the number of
/// bins that count: those that expect ten samples.
fn chi_square(
    samples: impl ExactSizeIterator<Item = [f64; 2]>,
    density: impl Fn(f64, f64) -> f64,
    half: [f64; 2],
) -> (f64, f64) {
    let count = samples.len() as f64;
    let mut counts = vec![0.0; BINS * BINS];
    let bin = |s: f64, half: f64| {
        let t = (s / half + 1.0) * 0.5 * BINS as f64;
        (0..BINS).find(|&bin| (bin as f64..(bin + 1) as f64).contains(&t))
    };
    for [s, t] in samples {
        if let (Some(i), Some(j)) = (bin(s, half[0]), bin(t, half[1])) {
            counts[i * BINS + j] += 1.0;
        }
    }
    let [a, b] = half.map(|half| 2.0 * half / (BINS * FINE) as f64);
    let at = |i: usize, j: usize| {
        density(
            (i as f64 + 0.5) * a - half[0],
            (j as f64 + 0.5) * b - half[1],
        )
    };
    let expected = |bin: usize| {
        let (i, j) = (bin / BINS * FINE, bin % BINS * FINE);
        let cells = (i..i + FINE).flat_map(|i| (j..j + FINE).map(move |j| (i, j)));
        cells.map(|(i, j)| at(i, j)).sum::<f64>() * a * b * count
    };
    let terms: Vec<f64> = (0..BINS * BINS)
        .map(|bin| (counts[bin], expected(bin)))
        .filter(|&(_, expected)| expected > 10.0)
        .map(|(count, expected)| (count - expected).powi(2) / expected)
        .collect();
    (terms.iter().sum(), terms.len() as f64)
}

/// χ² of rays that hit a tilted rectangle, in bins, against next-event irradiance in the same bins.
///
/// `half` are the half-sizes of the rectangle in the local directions `along` and `across`.
fn chi_square_on_surface(
    light: &dyn Emitter,
    centre: DVec3,
    [along, across]: [DVec3; 2],
    half: [f64; 2],
) -> (f64, f64) {
    let axes = line_axes();
    let normal = along.cross(across);
    let rays = rays(light, RAYS);
    let hits = rays.iter().map(|ray| {
        let (p, s) = crossing(axes, ray, 0.0);
        let hit = p + s * (normal.dot(centre - p) / normal.dot(s)) - centre;
        [hit.dot(along), hit.dot(across)]
    });
    let world_normal = DVec3::from(world_direction(axes, normal));
    let irradiance = |s: f64, t: f64| {
        let p = centre + along * s + across * t;
        light.next_event(world(axes, p)).map_or(0.0, |event| {
            event.e_perp * DVec3::from(event.wi).dot(world_normal).abs()
        })
    };
    chi_square(hits, |s, t| irradiance(s, t) / POWER, half)
}

#[test]
fn rays_of_a_spot_reproduce_the_irradiance_of_a_tilted_surface() {
    let (beam, light) = spot(5e-6, 1.0, 0.02);
    let tilt = 60_f64.to_radians();
    let along = DVec3::new(tilt.cos(), 0.0, tilt.sin());
    let w = beam.radius_at(0.03);
    let centre = DVec3::new(0.0, 0.0, 0.05);
    let half = [3.0 * w, 1.6 * w];
    let (chi_square, bins) = chi_square_on_surface(&light, centre, [along, DVec3::Y], half);
    assert!(bins > 100.0, "{bins} bins");
    assert!(
        chi_square < chi_square_limit(bins),
        "{chi_square}, {bins} bins"
    );
}

/// An elliptic beam with M² in one axis, turned, and its light.
fn elliptic() -> (AstigmaticBeam, SpotLight) {
    let axis = |waist, m_squared, waist_distance| {
        LocatedBeam::new(spot(waist, m_squared, 0.0).0, waist_distance).expect("a valid beam")
    };
    let beam = AstigmaticBeam::new(axis(30e-6, 1.0, 0.05), axis(60e-6, 1.6, -0.02))
        .and_then(|beam| beam.with_rotation(0.4))
        .expect("a valid beam");
    let light = SpotLight::place_astigmatic(&beam, &placement(), POWER);
    (beam, light.expect("a valid light"))
}

#[test]
fn rays_of_an_elliptic_beam_reproduce_the_irradiance_of_tilted_surfaces() {
    let tilt = 60_f64.to_radians();
    let along = DVec3::new(tilt.cos(), 0.0, tilt.sin());
    let (beam, light) = elliptic();
    for z in [0.01, 0.05, 0.3] {
        let centre = DVec3::new(0.0, 0.0, z);
        let [a, b] = beam.radii_at(z);
        let w = (a * b).sqrt();
        let half = [3.0 * w, 1.6 * w];
        let (chi_square, bins) = chi_square_on_surface(&light, centre, [along, DVec3::Y], half);
        assert!(bins > 60.0, "z = {z}: {bins} bins");
        assert!(
            chi_square < chi_square_limit(bins),
            "{beam:?}, z = {z}: {chi_square}, {bins} bins"
        );
    }
}

#[test]
fn rays_of_beams_have_the_density_of_their_directions() {
    let (round, round_light) = spot(20e-6, 1.3, 0.1);
    let (elliptic, elliptic_light) = elliptic();
    let divergences = elliptic.axes().map(|axis| axis.beam().divergence());
    for ([a, b], light) in [
        ([round.divergence(); 2], round_light),
        (divergences, elliptic_light),
    ] {
        let half = [1.2 * (a * b).sqrt(); 2];
        let (chi_square, bins) = chi_square_of_directions(&light, half);
        assert!(bins > 100.0, "{bins} bins");
        assert!(
            chi_square < chi_square_limit(bins),
            "{half:?}: {chi_square}, {bins} bins"
        );
    }
}

#[test]
fn rays_of_a_line_reproduce_the_irradiance_of_tilted_surfaces() {
    let tilt = 50_f64.to_radians();
    let along = DVec3::new(tilt.cos(), 0.0, tilt.sin());
    for line in lines(FAN) {
        let light = place(&line);
        for z in [0.02, 0.2, 0.4] {
            let centre = DVec3::new(0.0, 0.0, z);
            let half = [line.half_length_at(z), 2.0 * line.half_thickness_at(z)];
            let (chi_square, bins) =
                chi_square_on_surface(&*light, centre, [along, DVec3::Y], half);
            assert!(bins > 100.0, "{bins} bins");
            assert!(
                chi_square < chi_square_limit(bins),
                "{line:?}, z = {z}: {chi_square}, {bins} bins"
            );
        }
    }
}

/// χ² of the slopes of rays, in bins up to `half`, against the density of their directions.
fn chi_square_of_directions(light: &dyn Emitter, half: [f64; 2]) -> (f64, f64) {
    let rays = rays(light, RAYS);
    let slopes = rays.iter().map(|ray| {
        let (_, slope) = crossing(line_axes(), ray, 0.0);
        [slope.x, slope.y]
    });
    // dω = cos³ ds_x ds_y
    let density = |s: f64, t: f64| {
        let slope = DVec3::new(s, t, 1.0);
        let direction = world_direction(line_axes(), slope.normalize());
        let pdf = light.ray_pdf(placement().origin.to_array(), direction);
        pdf.direction * slope.length().powi(-3)
    };
    chi_square(slopes, density, half)
}

#[test]
fn rays_of_a_line_have_the_density_of_their_directions() {
    for line in lines(FAN) {
        let light = place(&line);
        // Bins of slope that end at the edges of the top hats, where their density jumps.
        let half = [
            4.0 / 3.0 * line.half_slope(),
            1.2 * line.focus().divergence(),
        ];
        let (chi_square, bins) = chi_square_of_directions(&*light, half);
        assert!(bins > 100.0, "{bins} bins");
        assert!(
            chi_square < chi_square_limit(bins),
            "{line:?}: {chi_square}, {bins} bins"
        );
    }
}

/// ∫∫ f over the slopes about `centre`, within nine `sigma`, with the solid angle
/// `dω = cos³ ds_x ds_y`. The argument of `f` is the unit direction in the frame of the light.
fn integrate_over_slopes(f: impl Fn(DVec3) -> f64, centre: [f64; 2], sigma: [f64; 2]) -> f64 {
    const INTERVALS: i32 = 72;
    let [h_x, h_y] = sigma.map(|sigma| 0.25 * sigma);
    let steps = || -INTERVALS / 2..=INTERVALS / 2;
    steps()
        .flat_map(|i| steps().map(move |j| (i, j)))
        .map(|(i, j)| {
            let slope = DVec3::new(
                centre[0] + f64::from(i) * h_x,
                centre[1] + f64::from(j) * h_y,
                1.0,
            );
            f(slope.normalize()) * slope.length().powi(-3)
        })
        .sum::<f64>()
        * h_x
        * h_y
}

fn world_direction(axes: [DVec3; 3], d: DVec3) -> [f64; 3] {
    (d.x * axes[0] + d.y * axes[1] + d.z * axes[2]).to_array()
}

#[test]
fn radiance_of_a_spot_integrates_to_the_irradiance() {
    for m_squared in [1.0, 3.0] {
        let (beam, light) = spot(50e-6, m_squared, 0.15);
        let axes = axes(light.ex, light.ey, light.ez);
        for z in [0.001, 0.14, 0.4] {
            let w = beam.radius_at(z - 0.15);
            let local = DVec3::new(0.5 * w, -0.7 * w, z);
            let p = world(axes, local);
            let curvature = beam.curvature_at(z - 0.15);
            let spread = 0.5 * beam.waist_radius() * beam.divergence() / w;
            let sum = integrate_over_slopes(
                |d| light.radiance(p, world_direction(axes, d)) * d.z,
                [local.x * curvature, local.y * curvature],
                [spread; 2],
            );
            let error = sum / light.irradiance(p) - 1.0;
            // Rounding of world coordinates: 1e−16 m beside beam radii of 1e−4 m.
            assert!(error.abs() < 1e-10, "M² = {m_squared}, z = {z}: {error:e}");
        }
    }
}

#[test]
fn radiance_of_a_line_integrates_to_the_irradiance() {
    for line in lines(FAN) {
        let light = place(&line);
        for (u, z) in [(0.0, 0.1), (0.2, 0.19), (-0.25, 0.4)] {
            let sec = 1_f64.hypot(u);
            let r = (z + FAN.apex_offset) * sec;
            let from_waist = r - line.waist_slant_distance_at(u);
            let w = line.focus().radius_at(from_waist);
            let local = DVec3::new(u * (z + FAN.apex_offset), 0.6 * w, z);
            let p = world(line_axes(), local);
            let slope_y = local.y * line.focus().curvature_at(from_waist) * sec;
            let spread_x = 0.5 * line.source_radius() / r * sec * sec;
            let spread_y = 0.5 * line.focus().waist_radius() * line.focus().divergence() / w * sec;
            let sum = integrate_over_slopes(
                |d| light.radiance(p, world_direction(line_axes(), d)) * d.z,
                [u, slope_y],
                [spread_x, spread_y],
            );
            let error = sum / light.irradiance(p) - 1.0;
            // The closed form neglects (w_b / r)² = 6e−11 and smaller, times the curvature of the
            // profile, 1e2; coordinates of 0.5 m are rounded to 1e−16 m beside w_b = 8e−7 m.
            assert!(error.abs() < 2e-8, "{line:?}, u = {u}: {error:e}");
        }
    }
}

#[test]
fn radiance_times_cosine_over_densities_is_the_power() {
    let (_, spot) = spot(50e-6, 1.3, 0.15);
    let lasers: Vec<LaserLine> = lines(FAN).collect();
    let lights = lasers.iter().map(place).chain([Box::new(spot) as _]);
    for light in lights {
        for ray in rays(&*light, 1000) {
            let pdf = light.ray_pdf(ray.origin, ray.direction);
            // Rounding of world coordinates, 1e−16 m, beside a source of 4e−7 m, five σ out.
            let tolerance = 1e-8;
            assert!(
                (pdf.position_given_direction / ray.pdf.position_given_direction - 1.0).abs()
                    < tolerance,
                "{ray:?}: {pdf:?}"
            );
            assert!(
                (pdf.direction / ray.pdf.direction - 1.0).abs() < tolerance,
                "{ray:?}: {pdf:?}"
            );
            let radiance = light.radiance(ray.origin, ray.direction);
            let flux = radiance * ray.cos / (ray.pdf.position_given_direction * ray.pdf.direction);
            assert!((flux / ray.flux - 1.0).abs() < tolerance, "{ray:?}: {flux}");
        }
    }
}

#[test]
fn direction_density_integrates_to_one() {
    let (beam, light) = spot(5e-6, 2.0, 0.0);
    let local = axes(light.ex, light.ey, light.ez);
    let origin = light.origin;
    let sigma = 0.5 * beam.divergence();
    let density = |d| light.ray_pdf(origin, world_direction(local, d)).direction;
    let sum = integrate_over_slopes(density, [0.0; 2], [sigma; 2]);
    assert!((sum - 1.0).abs() < 1e-12, "{sum}");
}

#[test]
fn direction_density_of_a_line_integrates_to_one() {
    const INTERVALS: i32 = 72;
    for line in lines(FAN) {
        let light = place(&line);
        let mut sum = 0.0;
        for (u, du) in slopes(&line) {
            // The slope across is s sec θ, s normal.
            let h = 0.125 * line.focus().divergence() * 1_f64.hypot(u);
            for i in -INTERVALS / 2..=INTERVALS / 2 {
                let slope = DVec3::new(u, f64::from(i) * h, 1.0);
                let direction = world_direction(line_axes(), slope.normalize());
                let pdf = light.ray_pdf(placement().origin.to_array(), direction);
                sum += pdf.direction * slope.length().powi(-3) * h * du;
            }
        }
        // The rule along the fan errs by 1e−9.
        assert!((sum - 1.0).abs() < 1e-8, "{line:?}: {sum}");
    }
}

#[test]
fn position_density_integrates_to_one_over_the_aperture() {
    const INTERVALS: i32 = 72;
    let (u, s): (f64, f64) = (0.2, 1e-3);
    let direction = world_direction(line_axes(), DVec3::new(u, s, 1.0).normalize());
    for line in lines(FAN) {
        let light = place(&line);
        // The rays of one direction: a patch of the apex, projected on to the lens.
        let sec = 1_f64.hypot(u);
        let h = [0.25 * 0.5 * line.source_radius() * sec, 0.25 * 25e-6];
        let along = FAN.apex_offset * sec;
        let y = s / sec * (along - line.waist_slant_distance_at(u));
        let centre = DVec3::new(u * FAN.apex_offset, y, 0.0);
        let mut sum = 0.0;
        for i in -INTERVALS / 2..=INTERVALS / 2 {
            for j in -INTERVALS / 2..=INTERVALS / 2 {
                let offset = DVec3::new(f64::from(i) * h[0], f64::from(j) * h[1], 0.0);
                let p = world(line_axes(), centre + offset);
                sum += light.ray_pdf(p, direction).position_given_direction * h[0] * h[1];
            }
        }
        assert!((sum - 1.0).abs() < 1e-9, "{line:?}: {sum}");
    }
}

/// The mean and the standard error of the reflected radiance (for f = 1) by sampled next events.
fn sampled_mean(light: &dyn Emitter, p: [f64; 3], n: DVec3) -> (f64, f64) {
    const COUNT: usize = 20_000;
    let mut rng = rng();
    let (mut sum, mut squares) = (0.0, 0.0);
    for _ in 0..COUNT {
        let event = light
            .next_event_sampled(p, rng.random())
            .expect("the point is lit");
        let term = event.value * DVec3::from(event.wi).dot(n);
        sum += term;
        squares += term * term;
    }
    let mean = sum / COUNT as f64;
    let variance = squares / COUNT as f64 - mean * mean;
    (mean, (variance / COUNT as f64).sqrt())
}

fn check_sampled_mean(light: &dyn Emitter, local: DVec3) {
    let [ex, ey, ez] = line_axes();
    let p = world(line_axes(), local);
    let n = (ex * 0.3 + ey * 0.8 - ez * 0.4).normalize();
    let delta = light.next_event(p).expect("the point is lit");
    let expected = delta.e_perp * DVec3::from(delta.wi).dot(n);
    let (mean, error) = sampled_mean(light, p, n);
    // The line's closed form is off by (w_b / r)² = 6e−11, far below the standard error.
    assert!(
        (mean - expected).abs() < SIGMAS * error,
        "{mean} ± {error}, expected {expected}"
    );
    assert!(error < 0.01 * expected, "the test must be sharp: {error}");
}

#[test]
fn sampled_next_events_average_to_the_delta_form() {
    let (beam, spot) = spot(5e-6, 1.0, 0.02);
    let w = beam.radius_at(0.03);
    check_sampled_mean(&spot, DVec3::new(0.7 * w, 0.4 * w, 0.05));
    for line in lines(FAN) {
        let thickness = line.half_thickness_at(0.1);
        check_sampled_mean(&*place(&line), DVec3::new(0.02, thickness, 0.1));
    }
}

fn check_sampled_values(light: &dyn Emitter, local: DVec3) {
    let mut rng = rng();
    let p = world(line_axes(), local);
    for _ in 0..1000 {
        let event = light
            .next_event_sampled(p, rng.random())
            .expect("the point is lit");
        let travel = (-DVec3::from(event.wi)).to_array();
        let radiance = light.radiance(p, travel);
        // Rounding of world coordinates, 1e−16 m, beside a source of 4e−7 m, five σ out.
        assert!(
            (event.value * event.pdf / radiance - 1.0).abs() < 1e-8,
            "{event:?}: {radiance}"
        );
        let pdf = light.next_event_pdf(p, event.wi);
        assert!((pdf / event.pdf - 1.0).abs() < 1e-8, "{event:?}: {pdf}");
        // The point and the distance describe the same ray.
        let back = DVec3::from(p) + DVec3::from(event.wi) * event.distance;
        let miss = back.distance(DVec3::from(event.point));
        assert!(miss < 1e-15, "{event:?}: {miss:e}");
    }
}

#[test]
fn sampled_value_is_radiance_over_density() {
    let (beam, spot) = spot(5e-6, 1.0, 0.02);
    check_sampled_values(&spot, DVec3::new(beam.radius_at(0.03), 0.0, 0.05));
    for line in lines(FAN) {
        let point = DVec3::new(0.0265, line.half_thickness_at(0.1), 0.1);
        check_sampled_values(&*place(&line), point);
    }
}

#[test]
fn sampled_slopes_have_the_conditional_spread() {
    const COUNT: usize = 20_000;
    let (beam, light) = spot(50e-6, 1.0, 0.15);
    let axes = axes(light.ex, light.ey, light.ez);
    let z = 0.3;
    let w = beam.radius_at(z - 0.15);
    let x = 0.8 * w;
    let p = world(axes, DVec3::new(x, 0.0, z));
    let mut rng = rng();
    let slopes: Vec<f64> = (0..COUNT)
        .map(|_| {
            let event = light
                .next_event_sampled(p, rng.random())
                .expect("the point is lit");
            let wi = DVec3::from(event.wi);
            wi.dot(axes[0]) / wi.dot(axes[2])
        })
        .collect();
    let n = COUNT as f64;
    let mean = slopes.iter().sum::<f64>() / n;
    let variance = slopes.iter().map(|s| (s - mean).powi(2)).sum::<f64>() / n;
    let sigma = 0.5 * beam.waist_radius() * beam.divergence() / w;
    let expected = x * beam.curvature_at(z - 0.15);
    assert!(
        (mean - expected).abs() < SIGMAS * sigma / n.sqrt(),
        "{mean:e}, expected {expected:e}"
    );
    let ratio = variance / (sigma * sigma) - 1.0;
    assert!(ratio.abs() < SIGMAS * (2.0 / n).sqrt(), "{ratio:e}");
}

#[test]
fn uniforms_at_their_ends_give_finite_rays() {
    let (_, spot) = spot(50e-6, 1.0, 0.15);
    let lasers: Vec<LaserLine> = lines(FAN).collect();
    let lights = lasers.iter().map(place).chain([Box::new(spot) as _]);
    let last = 1.0 - f64::EPSILON / 2.0;
    for light in lights {
        for bits in 0..16 {
            let u = core::array::from_fn(|i| if bits >> i & 1 == 0 { 0.0 } else { last });
            let ray = light.sample_ray(u);
            let direction = DVec3::from(ray.direction);
            assert!(DVec3::from(ray.origin).is_finite(), "{ray:?}");
            assert!((direction.length() - 1.0).abs() < 1e-15, "{ray:?}");
            assert!(
                ray.pdf.position_given_direction > 0.0 && ray.pdf.direction > 0.0,
                "{ray:?}"
            );
        }
    }
}
