use core::fmt;

use tem00_speckle::{SlicePath, SpeckleError, StackNeeds, StackPlan};

use super::survey::Survey;
use crate::{Formulas, Laser, Scene, SpeckleSettings, TracerError};

/// The speckle patterns that a scene needs, chosen from its camera, image and motion.
///
/// Its `Display` is one line per laser that states the choice and its reason.
#[derive(Clone, Debug, PartialEq)]
pub struct SpecklePlan {
    patterns: Vec<PatternPlan>,
}

/// The pattern of one laser: sizes, path of the slices, and why.
#[derive(Clone, Debug, PartialEq)]
pub struct PatternPlan {
    wavelength: f64,
    /// What the image and the motion ask for, whether it fits or not.
    needs: StackNeeds,
    stack: StackPlan,
    as_printed: bool,
    chosen: bool,
    seed: u64,
}

impl SpecklePlan {
    /// Chooses the patterns for a scene.
    ///
    /// Each is the [`StackPlan`] for the image, the part of the scene that moves into it, and the
    /// longest way by which the frames carry the pupil. What the scene file sets is kept. What the
    /// motion asks for beyond the memory is left out, and said so.
    ///
    /// # Errors
    ///
    /// Returns an error if C exceeds Q/2, if the imaging geometry is not possible, or if the
    /// patterns do not fit the memory that the scene allows.
    pub fn new(scene: &Scene, formulas: Formulas, seed: u64) -> Result<Self, TracerError> {
        let memory = scene.speckle.memory / scene.lasers.len().max(1) as u64;
        let patterns = scene.lasers.iter().zip(1_u64..);
        let patterns = patterns
            .map(|(laser, number)| {
                // Weyl steps keep the seeds of the lasers apart from each other and from the
                // camera's.
                let seed = seed.wrapping_add(number.wrapping_mul(0x9e37_79b9_7f4a_7c15));
                PatternPlan::new(scene, laser, formulas, seed, memory)
            })
            .collect::<Result<_, _>>()?;
        Ok(Self { patterns })
    }

    /// Returns the patterns, in the order of the lasers.
    pub fn patterns(&self) -> &[PatternPlan] {
        &self.patterns
    }
}

impl fmt::Display for SpecklePlan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, pattern) in self.patterns.iter().enumerate() {
            if index > 0 {
                writeln!(f)?;
            }
            write!(f, "laser {index}: {pattern}")?;
        }
        Ok(())
    }
}

impl PatternPlan {
    fn new(
        scene: &Scene,
        laser: &Laser,
        formulas: Formulas,
        seed: u64,
        memory: u64,
    ) -> Result<Self, TracerError> {
        let geometry = scene.camera.imaging_geometry(laser.wavelength())?;
        let survey = Survey::new(scene, laser, &geometry)?;
        let needs = StackNeeds {
            image: survey.image.to_array(),
            region: survey.region.to_array(),
            speckle_size: geometry.speckle_size_in_pixels(),
            motion: scene.moves().then_some(survey.shift),
            frames: scene.render.frames,
            memory_limit: memory,
        };
        let as_printed = formulas == Formulas::AsPrinted;
        let asked = StackPlan::candidates(&needs)?.into_iter().map(|plan| {
            let plan = as_asked(plan, &scene.speckle);
            if as_printed { plan.on_circle() } else { plan }
        });
        let stack = StackPlan::first_within(asked, memory).map_err(|error| match error {
            SpeckleError::MemoryLimit { needed, limit } => TracerError::PatternMemory {
                needed,
                allowed: limit,
            },
            other => other.into(),
        })?;
        Ok(Self {
            wavelength: laser.wavelength(),
            needs,
            stack,
            as_printed,
            chosen: scene.speckle.size.is_none() && scene.speckle.diameter.is_none(),
            seed,
        })
    }

    /// Returns the sizes of the stack.
    pub const fn stack(&self) -> &StackPlan {
        &self.stack
    }

    /// Returns the speckle size in the image, in pixels.
    pub const fn speckle_size_in_pixels(&self) -> f64 {
        self.needs.speckle_size
    }

    /// Returns the largest motion of the pupil over the speckle that the scene asks for, in pupil
    /// diameters.
    pub fn largest_shift(&self) -> f64 {
        self.needs.motion.unwrap_or(0.0)
    }

    pub(super) const fn seed(&self) -> u64 {
        self.seed
    }

    pub(super) const fn is_as_printed(&self) -> bool {
        self.as_printed
    }

    pub(super) const fn half_period(&self) -> usize {
        match self.stack.path() {
            SlicePath::Still => 1,
            SlicePath::Circle { half_period } | SlicePath::Straight { half_period, .. } => {
                half_period
            }
        }
    }
}

/// The plan with what the scene file sets.
fn as_asked(plan: StackPlan, settings: &SpeckleSettings) -> StackPlan {
    let plan = match (settings.size, settings.diameter) {
        (None, None) => plan,
        (Some(size), None) => plan.with_square(size, size / 2),
        (None, Some(diameter)) => plan.with_square(diameter.saturating_mul(2), diameter),
        (Some(size), Some(diameter)) => plan.with_square(size, diameter),
    };
    match settings.half_period {
        Some(half_period) => plan.with_half_period(half_period),
        None => plan,
    }
}

impl fmt::Display for PatternPlan {
    #[expect(clippy::cast_precision_loss, reason = "shown to three digits")]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { stack, needs, .. } = self;
        let [width, height] = needs.region;
        write!(
            f,
            "speckles of {:.3} pixels at {:.1} nm; C = {}, {} the {:.1} × {:.1} speckles ({width:.0} \
             × {height:.0} pixels) of the image{}; Q = {}; ",
            needs.speckle_size,
            self.wavelength * 1e9,
            Sides(stack.diameter()),
            if stack.holds_region(needs) {
                "at least"
            } else {
                "LESS than"
            },
            width / needs.speckle_size,
            height / needs.speckle_size,
            if self.chosen {
                ""
            } else {
                ", as the scene asks"
            },
            Sides(stack.size()),
        )?;
        match needs.motion {
            None => write!(f, "one slice, since nothing moves; ")?,
            Some(motion) => write!(
                f,
                "{} slices for a motion of up to {motion:.2} pupil diameters{}; ",
                stack.path().slice_count(),
                // No memory gives the circle of the printed formulas more than one diameter.
                if self.as_printed || stack.holds_motion(needs) {
                    ""
                } else {
                    ", MORE than the slices hold: frames beyond share their speckle"
                }
            )?,
        }
        let mebibytes = stack.memory_bytes() as f64 / f64::from(1 << 20);
        write!(f, "{mebibytes:.1} MiB")
    }
}

/// One number for a square, two for other patterns.
struct Sides([usize; 2]);

impl fmt::Display for Sides {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [width, height] = self.0;
        match width == height {
            true => write!(f, "{width}"),
            false => write!(f, "{width} × {height}"),
        }
    }
}

#[cfg(test)]
mod tests;
