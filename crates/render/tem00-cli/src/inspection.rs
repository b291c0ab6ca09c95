//! Inspection of a scene before it is rendered: the laser light that the camera will see.

mod overview;
mod words;

use std::path::{Path, PathBuf};

use tem00_engine::{LaserInspection, inspect_lasers};
use tem00_report::{args::IndexRange, failure::Failure};
use tem00_tracer::{Scene, TracerError};

/// The maximum number of frames that are inspected.
const MAX_FRAMES: u32 = 8;

/// The light of each laser that reaches the camera, in frames spread over the requested ones.
#[derive(Debug)]
pub struct Inspection<'a> {
    scene: &'a Scene,
    /// The number of each frame, and its lasers.
    frames: Vec<(u32, Vec<LaserInspection>)>,
}

impl<'a> Inspection<'a> {
    /// Inspects frames spread over the requested range.
    ///
    /// # Errors
    ///
    /// Returns an error if the geometry cannot be built.
    pub fn new(scene: &'a Scene, frames: IndexRange) -> Result<Self, TracerError> {
        let frames = spread(frames).map(|frame| Ok((frame, inspect_lasers(scene, frame)?)));
        Ok(Self {
            scene,
            frames: frames.collect::<Result<_, TracerError>>()?,
        })
    }

    /// Returns whether the camera sees each laser in at least one of the frames.
    pub fn sees_all_lasers(&self) -> bool {
        (0..self.scene.lasers.len()).all(|laser| self.is_seen(laser))
    }

    /// Returns the findings for every laser, line by line.
    pub fn lines(&self) -> Vec<String> {
        let lasers = 0..self.scene.lasers.len();
        lasers.flat_map(|laser| self.words(laser)).collect()
    }

    /// Returns the findings for the lasers that the camera does not see in any frame.
    pub fn warnings(&self) -> Vec<String> {
        let lasers = (0..self.scene.lasers.len()).filter(|&laser| !self.is_seen(laser));
        lasers.flat_map(|laser| self.words(laser)).collect()
    }

    /// Draws camera, lasers and parts into NAME.svg in a folder and returns the path. The drawing
    /// shows the first frame in which a laser is not seen, or else the first frame.
    ///
    /// # Errors
    ///
    /// Returns a failure if the file cannot be written.
    pub fn draw(&self, folder: &Path, name: &str) -> Result<PathBuf, Failure> {
        let dark = |(_, lasers): &&(u32, Vec<LaserInspection>)| {
            !lasers.iter().all(LaserInspection::is_seen)
        };
        let frame = self.frames.iter().find(dark).or(self.frames.first());
        if let Some((frame, lasers)) = frame {
            overview::draw(self.scene, *frame, lasers).save(folder, name)?;
        }
        Ok(folder.join(format!("{name}.svg")))
    }

    fn is_seen(&self, laser: usize) -> bool {
        let mut frames = self.frames.iter();
        frames.any(|(_, lasers)| lasers[laser].is_seen())
    }

    fn words(&self, laser: usize) -> Vec<String> {
        let first = |seen: bool| {
            let mut frames = self.frames.iter();
            frames.find(|(_, lasers)| lasers[laser].is_seen() == seen)
        };
        let seen = first(true).map(|(_, lasers)| words::seen(self.scene, laser, &lasers[laser]));
        let mut lines = Vec::from_iter(seen);
        if let Some((frame, lasers)) = first(false) {
            let which = (self.scene.frames > 1).then_some(*frame);
            lines.extend(words::dark(self.scene, laser, which, &lasers[laser]));
        }
        lines
    }
}

/// Returns frames spread over a range, both ends included.
fn spread(IndexRange { first, last }: IndexRange) -> impl Iterator<Item = u32> {
    let steps = (last - first).min(MAX_FRAMES - 1);
    let length = u64::from(last - first);
    (0..=steps).map(move |step| {
        let offset = length * u64::from(step) / u64::from(steps.max(1));
        first + u32::try_from(offset).unwrap_or(0)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_spread_over_the_range() {
        let of = |first, last| spread(IndexRange { first, last }).collect::<Vec<_>>();
        assert_eq!(of(3, 3), [3]);
        assert_eq!(of(0, 2), [0, 1, 2]);
        assert_eq!(of(10, 80), [10, 20, 30, 40, 50, 60, 70, 80]);
        assert_eq!(of(0, u32::MAX).last(), Some(&u32::MAX));
    }
}
