use core::fmt;

use tem00_speckle::{PupilField, SlicePath};

use super::survey::Survey;
use crate::{Formulas, Laser, Scene, SpeckleSettings, TracerError};

/// Slices per pupil diameter that are tried, the best first.
///
/// Blending between slices deviates from the correlation law by less than 0.06 with 32 slices per
/// diameter, 0.11 with 16, 0.2 with 8 and 0.4 with 4.
const SLICES_PER_DIAMETER: [usize; 4] = [32, 16, 8, 4];

/// The longest path that is tried, in pupil diameters: with the fewest slices it has the largest
/// period.
const LONGEST_PATH: usize = 2 * SlicePath::MAX_HALF_PERIOD / SLICES_PER_DIAMETER[3];

/// The smallest pupil field that is chosen without being asked: about 800 phasors.
const SMALLEST_DIAMETER: usize = 32;

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
    speckle_size_in_pixels: f64,
    extent: f64,
    largest_shift: f64,
    size: usize,
    diameter: usize,
    /// Pupil diameters along the path of the slices.
    length: usize,
    path: SlicePath,
    frames: u32,
    as_printed: bool,
    chosen: bool,
    seed: u64,
}

impl SpecklePlan {
    /// Chooses the patterns for a scene.
    ///
    /// The diameter C of the pupil field is at least the image side in speckles, so that nothing
    /// repeats in the image; the size Q is twice that; the path of the slices is as long as the way
    /// by which several frames carry the pupil; their number is the largest of a few that fits the
    /// memory.
    /// What the scene file sets is kept. What the motion asks for beyond the memory is left out, and
    /// said so.
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
        let mut plan = Self {
            wavelength: laser.wavelength(),
            speckle_size_in_pixels: geometry.speckle_size_in_pixels(),
            extent: survey.extent,
            largest_shift: survey.shift,
            size: 0,
            diameter: 0,
            length: 2,
            path: SlicePath::Still,
            frames: scene.render.frames,
            as_printed: formulas == Formulas::AsPrinted,
            chosen: scene.speckle.size.is_none() && scene.speckle.diameter.is_none(),
            seed,
        };
        let candidates = plan.sizes(&scene.speckle, &survey);
        let mut smallest = u64::MAX;
        for &(diameter, length) in &candidates {
            (plan.diameter, plan.length) = (diameter, length);
            plan.size = scene.speckle.size.unwrap_or(diameter.saturating_mul(2));
            for path in plan.paths(scene) {
                plan.path = path;
                smallest = smallest.min(plan.memory_bytes());
                if plan.memory_bytes() <= memory
                    && PupilField::new(plan.size, diameter, seed).is_ok()
                {
                    return Ok(plan);
                }
            }
        }
        // C ≤ Q/2 and the bounds of both are the pupil field's to check.
        PupilField::new(plan.size, plan.diameter, seed)?;
        Err(TracerError::PatternMemory {
            needed: smallest,
            allowed: memory,
        })
    }

    /// Returns the pairs of C and the length of the path that are tried, the best first.
    ///
    /// A field that covers only the image lets places share their speckle in different frames; a path
    /// that is too short lets whole frames do so, and is the last resort.
    fn sizes(&self, settings: &SpeckleSettings, survey: &Survey) -> Vec<(usize, usize)> {
        // Two frames need no third place on the lattice: whatever is new is new to the first.
        let length = if self.as_printed || self.frames <= 2 {
            2
        } else {
            length_for(survey.shift)
        };
        let asked = settings.diameter.or(settings.size.map(|size| size / 2));
        let whole = diameter_for(survey.extent / self.speckle_size_in_pixels);
        let image = diameter_for(survey.side / self.speckle_size_in_pixels);
        let halved = core::iter::successors(Some(length), |&l| (l > 2).then(|| (l / 2).max(2)));
        halved
            .flat_map(|length| [(whole, length), (image, length)])
            .map(|(diameter, length)| (asked.unwrap_or(diameter), length))
            .collect()
    }

    /// Returns the paths that are tried at the chosen C and Q, the best first.
    fn paths(&self, scene: &Scene) -> Vec<SlicePath> {
        let path = |half_period| match self.as_printed {
            true => SlicePath::Circle { half_period },
            false => SlicePath::Straight {
                half_period,
                length: self.length,
            },
        };
        match (scene.speckle.half_period, scene.moves()) {
            (Some(half_period), _) => vec![path(half_period)],
            (None, true) => SLICES_PER_DIAMETER
                .iter()
                .map(|slices| slices.saturating_mul(self.length) / 2)
                .filter(|&half_period| half_period <= SlicePath::MAX_HALF_PERIOD)
                .map(path)
                .collect(),
            (None, false) if self.as_printed => vec![path(1)],
            (None, false) => vec![SlicePath::Still],
        }
    }

    /// Returns the size Q of the pattern, in samples.
    pub const fn size(&self) -> usize {
        self.size
    }

    /// Returns the diameter C of the pupil field, in samples.
    pub const fn diameter(&self) -> usize {
        self.diameter
    }

    /// Returns the path of the slices.
    pub const fn path(&self) -> SlicePath {
        self.path
    }

    /// Returns the speckle size in the image, in pixels.
    pub const fn speckle_size_in_pixels(&self) -> f64 {
        self.speckle_size_in_pixels
    }

    /// Returns the largest motion of the pupil over the speckle that the scene asks for, in pupil
    /// diameters.
    pub const fn largest_shift(&self) -> f64 {
        self.largest_shift
    }

    /// Returns the memory that the slices take, in bytes.
    pub const fn memory_bytes(&self) -> u64 {
        self.path.memory_bytes([self.size; 2])
    }

    /// Returns the largest shift that the slices hold, in pupil diameters: the length of their path
    /// less the diameter of the pupil itself.
    #[expect(clippy::cast_precision_loss, reason = "lengths are far below 2⁵³")]
    pub(super) const fn reach(&self) -> f64 {
        (self.length - 1) as f64
    }

    /// Whether some of the later frames have moved beyond the reach, and so share their speckle. The
    /// circle of the printed formulas has no reach, whatever the memory.
    fn later_frames_share(&self) -> bool {
        self.frames > 2 && !self.as_printed && self.largest_shift > self.reach()
    }

    pub(super) const fn seed(&self) -> u64 {
        self.seed
    }

    pub(super) const fn is_as_printed(&self) -> bool {
        self.as_printed
    }

    pub(super) const fn half_period(&self) -> usize {
        match self.path {
            SlicePath::Still => 1,
            SlicePath::Circle { half_period } | SlicePath::Straight { half_period, .. } => {
                half_period
            }
        }
    }

    /// Returns the number of slices that a motion of the pupil by its diameter passes.
    #[expect(clippy::cast_precision_loss, reason = "sizes are far below 2⁵³")]
    pub(super) fn slices_per_diameter(&self) -> f64 {
        match self.path {
            SlicePath::Straight {
                half_period,
                length,
            } => (2 * half_period) as f64 / length as f64,
            SlicePath::Still | SlicePath::Circle { .. } => self.half_period() as f64,
        }
    }
}

impl fmt::Display for PatternPlan {
    #[expect(clippy::cast_precision_loss, reason = "shown to three digits")]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { size, diameter, .. } = self;
        let speckles = self.extent / self.speckle_size_in_pixels;
        write!(
            f,
            "speckles of {:.3} pixels at {:.1} nm; ",
            self.speckle_size_in_pixels,
            self.wavelength * 1e9
        )?;
        let relation = if *diameter as f64 >= speckles {
            "at least"
        } else {
            "LESS than"
        };
        write!(
            f,
            "C = {diameter}, {relation} the {speckles:.1} speckles ({:.0} pixels) of the image{}; Q = {size}; ",
            self.extent,
            if self.chosen {
                ""
            } else {
                ", as the scene asks"
            }
        )?;
        match self.path {
            SlicePath::Still => write!(f, "one slice, since nothing moves; ")?,
            _ => write!(
                f,
                "{} slices for a motion of up to {:.2} pupil diameters{}; ",
                self.path.slice_count(),
                self.largest_shift,
                if self.later_frames_share() {
                    ", MORE than the slices hold: frames beyond share their speckle"
                } else {
                    ""
                }
            )?,
        }
        write!(
            f,
            "{:.1} MiB",
            self.memory_bytes() as f64 / f64::from(1 << 20)
        )
    }
}

/// The smallest multiple of 8 without prime factors above 5 that covers `speckles` speckles: a size
/// that Fourier transforms like.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the cast saturates, and what is too large is rejected by the pupil field"
)]
fn diameter_for(speckles: f64) -> usize {
    let smallest = (speckles.ceil() as usize).max(SMALLEST_DIAMETER);
    let multiples = smallest.div_ceil(8)..=PupilField::MAX_SIZE / 8;
    multiples
        .map(|multiple| 8 * multiple)
        .find(|&diameter| is_smooth(diameter))
        .unwrap_or(smallest)
}

fn is_smooth(mut number: usize) -> bool {
    for prime in [2, 3, 5] {
        while number.is_multiple_of(prime) {
            number /= prime;
        }
    }
    number == 1
}

/// The length of a straight path, in pupil diameters, that ends clear of its start after a motion of
/// `shift` diameters.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the cast saturates"
)]
fn length_for(shift: f64) -> usize {
    ((1.0 + shift).ceil() as usize).clamp(2, LONGEST_PATH)
}

#[cfg(test)]
mod tests;
