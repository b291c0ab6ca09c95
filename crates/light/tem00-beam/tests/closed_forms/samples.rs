//! Lights whose fields are in single precision, and points around them.

use tem00_beam::{
    DVec3, Emitter, FanGeometry, FocusCurve, GaussianBeam, LaserLine, LineLight, LineProfile,
    Placement, SpotLight,
};
use tem00_testkit::Numbers;

const PLACEMENT: Placement = Placement {
    origin: DVec3::new(0.11, -0.07, 0.4),
    direction: DVec3::new(0.2, -0.3, -0.9),
    fan_axis: DVec3::new(1.0, 0.4, 0.1),
};

/// Points per light.
const POINTS: usize = 1000;

/// A light in double precision whose fields are those of one in single precision, and points from
/// behind its aperture to 0.6 m before it, within and somewhat beyond the cut-off.
#[derive(Debug)]
pub(crate) struct Sample<L> {
    pub(crate) name: String,
    pub(crate) light: L,
    /// The fields in the order of memory.
    pub(crate) fields: Vec<f32>,
    pub(crate) points: Vec<[f64; 3]>,
}

impl<L: Emitter> Sample<L> {
    /// `local_from` makes a local point at the distance z from two numbers in [−1.1, 1.1), which
    /// stand for the cut-off at ±1.
    fn new(
        name: String,
        light: L,
        rows: &[[f32; 4]],
        local_from: impl Fn(f64, [f64; 2]) -> [f64; 2],
    ) -> Self {
        let mut numbers = Numbers::new(1);
        let mut point = || {
            let z = numbers.between(-0.06, 0.6);
            let cutoffs = core::array::from_fn(|_| numbers.between(-1.1, 1.1));
            let [x, y] = local_from(z, cutoffs);
            core::array::from_fn(|i| {
                let [origin, ex, ey, ez] = [0, 1, 2, 3].map(|row| f64::from(rows[row][i]));
                origin + x * ex + y * ey + z * ez
            })
        };
        Self {
            name,
            light,
            fields: rows.as_flattened().to_vec(),
            points: (0..POINTS).map(|_| point()).collect(),
        }
    }
}

fn beam(waist: f64) -> GaussianBeam {
    GaussianBeam::from_waist(650e-9, waist).unwrap()
}

fn wide<const N: usize>(rows: [[f32; 4]; N]) -> [[f64; 4]; N] {
    rows.map(|row| row.map(f64::from))
}

/// A wide beam, a beam with a tight waist, and an elliptic one with two waists.
pub(crate) fn spots() -> Vec<Sample<SpotLight>> {
    let place =
        |waist, distance| SpotLight::place(&beam(waist), distance, &PLACEMENT, 5e-3).unwrap();
    let mut elliptic = place(30e-6, 0.2);
    elliptic.y = place(90e-6, -0.05).y;
    let lights = [
        ("wide", place(0.3e-3, 0.35)),
        ("tight", place(5e-6, 0.25)),
        ("elliptic", elliptic),
    ];
    let sample = |(name, light): (&str, SpotLight)| {
        let rows = light.to_rows_f32();
        let light = SpotLight::from_rows(wide(rows));
        Sample::new(name.to_owned(), light, &rows, |z, [x, y]| {
            let reach = |axis: tem00_beam::Axis| light.cutoff * axis.radius_sq_at(z).sqrt();
            [x * reach(light.x), y * reach(light.y)]
        })
    };
    lights.map(sample).into()
}

/// All profiles that are not tables, focused on a circle and on a plane.
pub(crate) fn lines() -> Vec<Sample<LineLight>> {
    let profiles = [
        LineProfile::GaussianTan,
        LineProfile::GaussianAngle,
        LineProfile::GaussianSin,
        LineProfile::UniformTan,
        LineProfile::UniformAngle,
        LineProfile::Powell { edge: 0.01 },
        LineProfile::Powell { edge: 0.3 },
    ];
    let curves = [FocusCurve::EqualDistance, FocusCurve::EqualPlane];
    profiles
        .iter()
        .flat_map(|profile| curves.map(|curve| line(profile, curve)))
        .collect()
}

fn line(profile: &LineProfile, focus_curve: FocusCurve) -> Sample<LineLight> {
    let fan = FanGeometry {
        // So wide that the tails in θ and sin θ are truncated.
        fan_angle: 100_f64.to_radians(),
        apex_offset: 3e-3,
        focus_distance: 0.3,
        focus_curve,
    };
    let line = LaserLine::new(beam(60e-6), fan, profile.clone()).unwrap();
    let light = LineLight::place(&line, &PLACEMENT, 5e-3).unwrap();
    let rows = light.to_rows_f32();
    let light = LineLight::from_rows(wide(rows));
    let name = format!("{profile:?}, {focus_curve:?}");
    Sample::new(name, light, &rows, |z, [v, y]| {
        let v = v * (light.flat + 2.0 * light.cutoff * light.sigma);
        let u = if light.variable < 0.5 {
            v
        } else if light.variable < 1.5 {
            v.clamp(-1.55, 1.55).tan()
        } else {
            let sin = v.clamp(-0.999, 0.999);
            sin / (1.0 - sin * sin).sqrt()
        };
        let sec = 1.0_f64.hypot(u);
        let mut axis = light.y;
        if light.focus_on_plane > 0.0 {
            axis.z0 *= sec;
        }
        let from_apex = z + light.apex_offset;
        let reach = light.cutoff * axis.radius_sq_at(from_apex * sec).sqrt();
        [u * from_apex, y * reach]
    })
}

/// The point with its coordinates rounded to single precision.
#[expect(clippy::cast_possible_truncation, reason = "rounding is the purpose")]
pub(crate) fn single_precision(p: [f64; 3]) -> [f32; 3] {
    p.map(|x| x as f32)
}
