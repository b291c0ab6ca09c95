//! Will a broader source help? How much contrast does speckle lose to a linewidth, and how much of
//! its noise a laser line?
//!
//! ```sh
//! cargo run --release --example will_a_broader_source_help
//! ```
//!
//! A laser line along the normal of a surface, seen at 30° to it across the line, by rows finer
//! than a speckle.

#![expect(clippy::print_stdout, reason = "an example prints its answer")]

mod plot;

use std::error::Error;

use kuva::prelude::{LinePlot, Plot};
use tem00::coherence::{
    CellGeometry, DVec3, PeakShape, PolychromaticSpeckle, Refusal, Relief, ResolutionCell, Rows,
    SourceExtent, Spectrum,
};

const LINEWIDTHS: [f64; 7] = [0.1e-9, 1e-9, 2e-9, 5e-9, 10e-9, 20e-9, 40e-9];
const HEIGHTS: [f64; 3] = [0.4e-6, 1.6e-6, 6e-6];
const COLOURS: [&str; 3] = ["steelblue", "darkorange", "seagreen"];
/// The aperture of the tables: half the diameter of the pupil over its distance.
const SIN_APERTURE: f64 = 0.025;

/// A source and what it lights.
#[derive(Clone, Copy)]
struct Case {
    wavelength: f64,
    rms_height: f64,
    sin_aperture: f64,
    linewidth: f64,
    half_angle: f64,
}

/// What is left of a line's speckle.
struct Left {
    contrast: f64,
    /// Standard deviation of the position over that in light of one wavelength.
    noise: f64,
}

impl Case {
    fn left(&self) -> Result<Left, Refusal> {
        let (sin, cos) = 30_f64.to_radians().sin_cos();
        let cell = ResolutionCell::new(CellGeometry {
            to_source: DVec3::Z,
            to_pupil: DVec3::new(sin, 0.0, cos),
            normal: DVec3::Z,
            sin_aperture: self.sin_aperture,
            wavelength: self.wavelength,
        })?
        .with_relief(Relief {
            rms_height: self.rms_height,
            correlation_length: 0.0,
        })?
        .with_source_extent(SourceExtent::disc(self.half_angle)?);
        let line = Spectrum::new(self.wavelength, self.linewidth, PeakShape::Gaussian)?;
        let speckle = PolychromaticSpeckle::new(&line, &cell)?;
        Ok(Left {
            contrast: speckle.contrast(),
            noise: speckle.line_noise_ratio(Rows::Thin),
        })
    }
}

fn row(name: &str, values: impl Iterator<Item = f64>) {
    let values: Vec<String> = values.map(|value| format!("{value:6.3}")).collect();
    println!("{name:<26} |{}", values.join(" "));
}

/// Prints contrast and noise over the linewidths, and returns curves of both.
fn table(wavelength: f64) -> Result<[Vec<Plot>; 2], Refusal> {
    row(
        "linewidth in nm",
        LINEWIDTHS.iter().map(|width| width * 1e9),
    );
    let mut plots = [Vec::new(), Vec::new()];
    for (rms_height, colour) in HEIGHTS.into_iter().zip(COLOURS) {
        let left = |linewidth: f64| {
            let case = Case {
                wavelength,
                rms_height,
                sin_aperture: SIN_APERTURE,
                linewidth,
                half_angle: 0.0,
            };
            case.left()
        };
        let at: Vec<Left> = LINEWIDTHS.into_iter().map(left).collect::<Result<_, _>>()?;
        let name = format!("{:.0} nm, {:.1} µm", wavelength * 1e9, rms_height * 1e6);
        row(
            &format!("{name}, contrast"),
            at.iter().map(|left| left.contrast),
        );
        row(&format!("{name}, noise"), at.iter().map(|left| left.noise));
        let curve: Vec<(f64, Left)> = (0..=80)
            .map(|i| 0.5 * f64::from(i))
            .map(|width| Ok((width, left(width * 1e-9)?)))
            .collect::<Result<_, Refusal>>()?;
        let line = |value: fn(&Left) -> f64| {
            let points = curve.iter().map(|(width, left)| (*width, value(left)));
            let line = LinePlot::new().with_data(points).with_color(colour);
            if wavelength < 500e-9 {
                line.with_legend(&name)
            } else {
                line.with_legend(&name).with_dashed()
            }
        };
        plots[0].push(line(|left| left.contrast).into());
        plots[1].push(line(|left| left.noise).into());
    }
    Ok(plots)
}

/// Returns the noise over the aperture of the camera, for some linewidths at 660 nm, on 1.6 µm.
fn apertures() -> Result<Vec<Plot>, Refusal> {
    let sines = [0.005, 0.01, 0.02, 0.04];
    row("sin u", sines.into_iter());
    let mut plots = Vec::new();
    for (linewidth, colour) in [2e-9, 5e-9, 20e-9].into_iter().zip(COLOURS) {
        let noise = |sin_aperture: f64| {
            let case = Case {
                wavelength: 660e-9,
                rms_height: 1.6e-6,
                sin_aperture,
                linewidth,
                half_angle: 0.0,
            };
            case.left().map(|left| left.noise)
        };
        let name = format!("{:.0} nm", linewidth * 1e9);
        let at: Vec<f64> = sines.into_iter().map(noise).collect::<Result<_, _>>()?;
        row(&format!("660 nm, 1.6 µm, {name}"), at.into_iter());
        let points: Vec<(f64, f64)> = (4..=80)
            .map(|i| 0.0005 * f64::from(i))
            .map(|sine| Ok((sine, noise(sine)?)))
            .collect::<Result<_, Refusal>>()?;
        let line = LinePlot::new().with_data(points).with_color(colour);
        plots.push(line.with_legend(&name).into());
    }
    Ok(plots)
}

/// Prints contrast and noise under sources of a half-angle, over the aperture of the camera.
fn extents() -> Result<(), Refusal> {
    let ratios = [0.25, 0.5, 1.0, 2.0, 4.0];
    row("half-angle over sin u", ratios.into_iter());
    for linewidth in [0.0, 20e-9] {
        let left = |ratio: f64| {
            let case = Case {
                wavelength: 450e-9,
                rms_height: 0.4e-6,
                sin_aperture: SIN_APERTURE,
                linewidth,
                half_angle: ratio * SIN_APERTURE,
            };
            case.left()
        };
        let at: Vec<Left> = ratios.into_iter().map(left).collect::<Result<_, _>>()?;
        let name = format!("450 nm, 0.4 µm, {:.0} nm", linewidth * 1e9);
        row(
            &format!("{name}, contrast"),
            at.iter().map(|left| left.contrast),
        );
        row(&format!("{name}, noise"), at.iter().map(|left| left.noise));
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    println!("Laser along the normal, camera at 30°, sin u = {SIN_APERTURE}; 1 is one wavelength");
    let [mut contrast, mut noise] = table(450e-9)?;
    let red = table(660e-9)?;
    for (all, more) in [&mut contrast, &mut noise].into_iter().zip(red) {
        all.extend(more);
    }
    let over_aperture = apertures()?;
    extents()?;

    let linewidth = "linewidth (nm)";
    let noise_axis = "noise of a line over that in one wavelength";
    for (name, title, axes, plots) in [
        (
            "broader_source_contrast",
            "Contrast of speckle",
            [linewidth, "contrast"],
            contrast,
        ),
        (
            "broader_source_noise",
            "Noise of a laser line",
            [linewidth, noise_axis],
            noise,
        ),
        (
            "broader_source_aperture",
            "Noise of a laser line, 660 nm, 1.6 µm",
            ["aperture of the camera, sin u", noise_axis],
            over_aperture,
        ),
    ] {
        println!("{}", plot::write(name, title, axes, plots)?.display());
    }
    Ok(())
}
