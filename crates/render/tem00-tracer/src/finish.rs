use core::f64::consts::FRAC_PI_2;

use crate::Metal;

/// A process that finishes metal, and the roughness that it leaves.
///
/// The ranges are typical values and not measurements: they hold for the process as it is usually
/// run, not for a part. The arithmetic mean deviation Ra says how high a surface is, not how steep:
/// the roughness α of a material, which makes the width of its lobe, does not follow from it.
/// Neither does the lay that a tool leaves.
///
/// # Examples
///
/// ```
/// use tem00_tracer::{FinishingProcess, Metal};
///
/// let (milling, metal) = FinishingProcess::of_surface("milled steel").ok_or("no such surface")?;
/// assert_eq!(metal, Metal::Iron);
/// // From 0.8 µm to 6.3 µm, in the geometric middle 2.24 µm.
/// assert!((milling.rms_height() - 2.814e-6).abs() < 1e-9);
/// # Ok::<(), &str>(())
/// ```
///
/// # References
///
/// - E. Oberg et al., *Machinery's Handbook*, 25th edition, 1996, p. 708, *Surface Roughness
///   Produced by Common Production Methods*: a drawn chart, whose ranges of average application are
///   read as they are listed in *Surface Finish (machining)*, calqlata.com, and *Surface Finish*,
///   meadinfo.org, 2009.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct FinishingProcess {
    /// The name of the finish that it leaves: "milled".
    pub name: &'static str,
    /// The minimum and the maximum usual arithmetic mean deviation Ra of the profile, in metres.
    pub mean_deviation: [f64; 2],
}

const fn process(name: &'static str, min: f64, max: f64) -> FinishingProcess {
    FinishingProcess {
        name,
        mean_deviation: [min, max],
    }
}

impl FinishingProcess {
    /// List of all processes, the roughest first.
    pub const ALL: [Self; 15] = [
        process("hot-rolled", 12.5e-6, 25e-6),
        process("sand-cast", 12.5e-6, 25e-6),
        process("forged", 3.2e-6, 12.5e-6),
        process("sawn", 1.6e-6, 25e-6),
        process("planed", 1.6e-6, 12.5e-6),
        process("drilled", 1.6e-6, 6.3e-6),
        process("milled", 0.8e-6, 6.3e-6),
        process("turned", 0.4e-6, 6.3e-6),
        process("reamed", 0.8e-6, 3.2e-6),
        process("cold-rolled", 0.8e-6, 3.2e-6),
        process("ground", 0.1e-6, 1.6e-6),
        process("honed", 0.1e-6, 0.8e-6),
        process("polished", 0.1e-6, 0.4e-6),
        process("lapped", 0.05e-6, 0.4e-6),
        process("superfinished", 0.05e-6, 0.2e-6),
    ];

    /// Returns the process and the metal of a surface by its name, such as "milled steel": the
    /// process, and a [metal by its name](Metal::NAMED). Steel without further words is iron, which
    /// reflects much alike.
    pub fn of_surface(name: &str) -> Option<(Self, Metal)> {
        let (process, metal) = name.split_once(' ')?;
        let process = Self::ALL.into_iter().find(|known| known.name == process)?;
        let metal = metal.replace(' ', "_");
        let mut metals = Metal::NAMED.iter();
        let metal = match metal.as_str() {
            "steel" => Metal::Iron,
            metal => metals.find(|(name, _)| *name == metal)?.1,
        };
        Some((process, metal))
    }

    /// Returns the rms height of a surface in the geometric middle of the range, in metres.
    ///
    /// ```text
    /// σ_h = √(π/2) Ra      of Gaussian heights, whose mean deviation is √(2/π) σ_h
    /// ```
    pub fn rms_height(&self) -> f64 {
        let [min, max] = self.mean_deviation;
        FRAC_PI_2.sqrt() * (min * max).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn surfaces_are_known_by_process_and_metal() {
        let metal = |name| FinishingProcess::of_surface(name).map(|(_, metal)| metal);
        assert_eq!(metal("ground stainless steel"), Some(Metal::StainlessSteel));
        assert_eq!(metal("cold-rolled brass"), Some(Metal::Brass));
        assert_eq!(metal("turned steel"), Some(Metal::Iron));
        for unknown in [
            "",
            "steel",
            "milled",
            "milled  steel",
            "milled wood",
            "Milled steel",
        ] {
            assert_eq!(metal(unknown), None, "{unknown}");
        }
    }

    #[test]
    fn the_mean_deviation_of_gaussian_heights_is_the_middle_of_the_range() {
        // The mean of |h| over a Gaussian, by the midpoint rule over ± 8 σ.
        let mean_deviation = |sigma: f64| {
            let density = |t: f64| (-0.5 * t * t).exp() / core::f64::consts::TAU.sqrt();
            let steps = 100_000;
            let step = 16.0 / f64::from(steps);
            let at = |i: i32| (f64::from(i) + 0.5) * step - 8.0;
            sigma
                * (0..steps)
                    .map(|i| at(i).abs() * density(at(i)) * step)
                    .sum::<f64>()
        };
        for process in FinishingProcess::ALL {
            let [min, max] = process.mean_deviation;
            assert!(min < max, "{process:?}");
            let ra = mean_deviation(process.rms_height());
            // As far from either end, as a ratio.
            assert!((ra / min / (max / ra) - 1.0).abs() < 1e-6, "{process:?}");
        }
    }
}
