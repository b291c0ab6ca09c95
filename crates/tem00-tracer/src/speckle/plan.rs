use core::fmt;

use glam::DVec2;
use tem00_decorrelation::ImagingGeometry;
use tem00_speckle::{PupilField, SlicePath};

use super::{MovedPoint, SpecklePoint};
use crate::{Formulas, Intersector, Laser, Scene, TracerError};

/// Slices per pupil diameter that are tried, the best first.
///
/// Blending between slices deviates from the correlation law by 0.06 at most with 32 slices per
/// diameter, 0.11 with 16, 0.2 with 8 and 0.4 with 4.
const SLICES_PER_DIAMETER: [usize; 4] = [32, 16, 8, 4];

/// Rays per image side with which the motion in a scene is surveyed.
const SURVEY_POINTS: u32 = 16;

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
    path: SlicePath,
    as_printed: bool,
    chosen: bool,
    seed: u64,
}

/// What the motion in a scene asks of a pattern.
#[derive(Clone, Copy, Debug)]
struct Survey {
    /// The image side plus the largest displacement in the image, in pixels.
    extent: f64,
    /// The largest motion of the pupil over the speckle, in pupil diameters.
    shift: f64,
}

impl SpecklePlan {
    /// Chooses the patterns for a scene.
    ///
    /// The diameter C of the pupil field is at least the image side in speckles, so that nothing
    /// repeats in the image; the size Q is twice that, or more if the motion carries the pupil by
    /// more than its diameter; the number of slices is the largest of a few that fits the memory.
    /// What the scene file sets is kept.
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
        let speckle_size = geometry.speckle_size_in_pixels();
        let settings = scene.speckle;
        let diameter = settings
            .diameter
            .or(settings.size.map(|size| size / 2))
            .unwrap_or_else(|| diameter_for(survey.extent / speckle_size));
        let as_printed = formulas == Formulas::AsPrinted;
        let diameters = if as_printed {
            2
        } else {
            diameters_for(survey.shift)
        };
        let size = settings
            .size
            .unwrap_or_else(|| diameter.saturating_mul(diameters));
        // C ≤ Q/2 and the bounds of both are the pupil field's to check.
        PupilField::new(size, diameter, seed)?;
        let mut plan = Self {
            wavelength: laser.wavelength(),
            speckle_size_in_pixels: speckle_size,
            extent: survey.extent,
            largest_shift: survey.shift,
            size,
            diameter,
            path: SlicePath::Still,
            as_printed,
            chosen: settings.size.is_none() && settings.diameter.is_none(),
            seed,
        };
        plan.path = plan.choose_path(scene, memory)?;
        Ok(plan)
    }

    fn choose_path(&self, scene: &Scene, memory: u64) -> Result<SlicePath, TracerError> {
        let path = |half_period| match self.as_printed {
            true => SlicePath::Circle { half_period },
            false => SlicePath::Straight { half_period },
        };
        let candidates: Vec<_> = match (scene.speckle.half_period, scene.moves()) {
            (Some(half_period), _) => vec![path(half_period)],
            (None, true) => SLICES_PER_DIAMETER
                .iter()
                .map(|slices| path(slices * self.size / (2 * self.diameter)))
                .collect(),
            (None, false) if self.as_printed => vec![path(1)],
            (None, false) => vec![SlicePath::Still],
        };
        let smallest = candidates
            .last()
            .map_or(0, |path| path.memory_bytes(self.size));
        candidates
            .into_iter()
            .find(|path| path.memory_bytes(self.size) <= memory)
            .ok_or(TracerError::PatternMemory {
                needed: smallest,
                allowed: memory,
            })
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
        self.path.memory_bytes(self.size)
    }

    /// Whether the motion carries the pupil round the lattice, back to where it started.
    #[expect(clippy::cast_precision_loss, reason = "sizes are far below 2⁵³")]
    fn speckle_returns(&self) -> bool {
        (1.0 + self.largest_shift) * self.diameter as f64 > self.size as f64
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
            SlicePath::Circle { half_period } | SlicePath::Straight { half_period } => half_period,
        }
    }

    /// Returns the number of slices that a motion of the pupil by its diameter passes.
    #[expect(clippy::cast_precision_loss, reason = "sizes are far below 2⁵³")]
    pub(super) fn slices_per_diameter(&self) -> f64 {
        match self.path {
            SlicePath::Straight { half_period } => {
                (2 * half_period * self.diameter) as f64 / self.size as f64
            }
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
                if self.speckle_returns() {
                    ", within which the first speckle RETURNS"
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

impl Survey {
    /// Follows a few rays in the last frame, in which everything has moved furthest.
    fn new(scene: &Scene, laser: &Laser, geometry: &ImagingGeometry) -> Result<Self, TracerError> {
        let side = scene.camera.width().max(scene.camera.height());
        #[expect(clippy::cast_precision_loss, reason = "an image side is below 2²⁸")]
        let mut survey = Self {
            extent: side as f64,
            shift: 0.0,
        };
        if !scene.moves() {
            return Ok(survey);
        }
        let frame = scene.render.frames - 1;
        let camera = scene.camera_at(frame);
        let intersector = Intersector::build(&scene.shapes_at(frame))?;
        let mut largest = DVec2::ZERO;
        for pixel in survey_pixels(&camera) {
            let Some(hit) = intersector.intersect(&camera.ray(pixel)) else {
                continue;
            };
            let point = SpecklePoint {
                pixel,
                position: hit.position,
                normal: hit.normal,
                surface: hit.surface,
            };
            let before = hit.position - scene.surface_displacement(hit.surface, frame);
            if let Some(reference) = scene.camera.project(before) {
                largest = largest.max((reference - pixel).abs());
            }
            let shift = MovedPoint::new(scene, laser, &point, frame)
                .map_or(1.0, |moved| moved.shift(geometry));
            survey.shift = survey.shift.max(shift);
        }
        survey.extent += largest.max_element();
        Ok(survey)
    }
}

fn survey_pixels(camera: &crate::Camera) -> impl Iterator<Item = DVec2> {
    #[expect(clippy::cast_precision_loss, reason = "an image side is below 2²⁸")]
    let size = DVec2::new(camera.width() as f64, camera.height() as f64);
    let position = |index: u32| (f64::from(index) + 0.5) / f64::from(SURVEY_POINTS);
    (0..SURVEY_POINTS * SURVEY_POINTS).map(move |index| {
        let cell = DVec2::new(
            position(index % SURVEY_POINTS),
            position(index / SURVEY_POINTS),
        );
        cell * size
    })
}

/// The smallest power of two that covers `speckles` speckles.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the cast saturates, and what is too large is rejected by the pupil field"
)]
fn diameter_for(speckles: f64) -> usize {
    let smallest = (speckles.ceil() as usize).max(SMALLEST_DIAMETER);
    smallest.checked_next_power_of_two().unwrap_or(usize::MAX)
}

/// The size of the torus, in pupil diameters, on which a straight path of `shift` diameters ends
/// clear of its start.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the cast saturates, and what is too large is rejected by the pupil field"
)]
fn diameters_for(shift: f64) -> usize {
    ((1.0 + shift).ceil() as usize).max(2)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::parse_scene;

    /// A plate under a collimated spot; `more` is appended to the scene.
    fn scene(displacement: &str, more: &str) -> Scene {
        let text = format!(
            r#"
            [render]
            frames = 2
            [camera]
            position = [0, 0, 0.3]
            resolution = [300, 200]
            [[laser]]
            wavelength = "650 nm"
            power = "1 mW"
            position = [0, 0, 0.2]
            spot = {{ waist_radius = "1 mm" }}
            [[surface]]
            displacement_per_frame = {displacement}
            rectangle = {{ size = [0.04, 0.04] }}
            {more}
            "#
        );
        parse_scene(&text, Path::new(".")).unwrap()
    }

    fn plan(displacement: &str, more: &str) -> Result<PatternPlan, TracerError> {
        let plan = SpecklePlan::new(&scene(displacement, more), Formulas::Derived, 0)?;
        Ok(plan.patterns()[0].clone())
    }

    #[test]
    fn nothing_repeats_within_the_image() {
        let plan = plan("[0, 0, 0]", "").unwrap();
        // h = λ (1 + m) F with m = 1/11, in pixels of 3.45 µm.
        let speckle_size = 650e-9 * 12.0 / 11.0 * 8.0 / 3.45e-6;
        assert!(
            (plan.speckle_size_in_pixels() / speckle_size - 1.0).abs() < 1e-12,
            "{plan}"
        );
        // 300 pixels hold 182.5 speckles: the next power of two is 256.
        assert_eq!((plan.diameter(), plan.size()), (256, 512), "{plan}");
        assert_eq!(plan.path(), SlicePath::Still, "{plan}");
    }

    #[test]
    fn motion_widens_the_pattern_and_asks_for_slices() {
        let plan = plan("[\"4 mm\", 0, 0]", "").unwrap();
        // 4 mm are 105 pixels: 405 pixels hold 246.6 speckles. The pupil of 3.125 mm is left
        // behind, so that the path is three diameters long.
        assert_eq!((plan.diameter(), plan.size()), (256, 768), "{plan}");
        assert!((plan.largest_shift() - 4.0 / 3.125).abs() < 1e-3, "{plan}");
        assert_eq!(
            plan.path(),
            SlicePath::Straight { half_period: 48 },
            "{plan}"
        );
        assert!((plan.slices_per_diameter() - 32.0).abs() < 1e-12, "{plan}");
    }

    #[test]
    fn a_pattern_too_short_for_the_motion_is_said_to_return() {
        let motion = "[\"4 mm\", 0, 0]";
        let chosen = plan(motion, "").unwrap().to_string();
        assert!(!chosen.contains("RETURNS"), "{chosen}");
        let asked = plan(motion, "[speckle]\nsize = 512\ndiameter = 256").unwrap();
        assert!(asked.to_string().contains("RETURNS"), "{asked}");
    }

    #[test]
    fn memory_bounds_the_number_of_slices() {
        let motion = "[\"0.2 mm\", 0, 0]";
        let slices = |memory: &str| {
            let more = format!("[speckle]\nmemory = \"{memory}\"");
            plan(motion, &more).map(|plan| plan.path().slice_count())
        };
        // 512² complex samples are 2 MiB a slice.
        assert_eq!(slices("128 MiB"), Ok(64));
        assert_eq!(slices("127 MiB"), Ok(32));
        assert_eq!(slices("16 MiB"), Ok(8));
        assert_eq!(
            slices("15 MiB"),
            Err(TracerError::PatternMemory {
                needed: 16 << 20,
                allowed: 15 << 20
            })
        );
    }

    #[test]
    fn what_the_scene_asks_for_is_kept_and_said() {
        let plan = plan("[0, 0, 0]", "[speckle]\nsize = 300\ndiameter = 100").unwrap();
        assert_eq!((plan.size(), plan.diameter()), (300, 100), "{plan}");
        let text = plan.to_string();
        assert!(
            text.contains("C = 100, LESS than the 182.5 speckles"),
            "{text}"
        );
        assert!(text.contains("as the scene asks"), "{text}");
    }

    #[test]
    fn printed_formulas_get_the_circle_of_the_paper() {
        let scene = scene("[\"0.2 mm\", 0, 0]", "");
        let plan = SpecklePlan::new(&scene, Formulas::AsPrinted, 0).unwrap();
        let path = plan.patterns()[0].path();
        assert_eq!(path, SlicePath::Circle { half_period: 32 }, "{plan}");
    }

    #[test]
    fn lasers_have_seeds_of_their_own() {
        let second = r#"
            [[laser]]
            wavelength = "532 nm"
            power = "1 mW"
            position = [0.1, 0, 0.2]
            spot = { waist_radius = "1 mm" }
        "#;
        let scene = scene("[0, 0, 0]", second);
        let plan = SpecklePlan::new(&scene, Formulas::Derived, 0).unwrap();
        let [first, second] = plan.patterns() else {
            panic!("two lasers have two patterns");
        };
        assert_ne!(first.seed(), second.seed());
        assert!(second.speckle_size_in_pixels() < first.speckle_size_in_pixels());
    }
}
