use glam::DVec3;
use tem00_numerics::check;
use tem00_triangulation::TriangulationError;

use crate::height_map::check_pitch;

/// Settings by which the frames of a scene become the map of a part.
#[derive(Clone, Debug, PartialEq)]
pub struct ScanSettings {
    /// The name of the surface whose motion is removed from the points; `None` for the surfaces
    /// that move.
    pub surface: Option<String>,
    /// The direction in which heights are counted, of length 1: in the world, as the part stands in
    /// its description.
    pub height: DVec3,
    /// The side of a square cell of the height map, in metres; `None` for a map of columns by
    /// profiles.
    pub pitch: Option<f64>,
    /// The numbers of profiles and points that are averaged.
    pub average: Averaging,
    /// The format of the raw frames.
    pub raw: RawFormat,
}

/// Numbers of profiles, and of points of a profile, that are averaged into one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Averaging {
    /// The number of frames, one after the other, at least 1.
    pub frames: u32,
    /// The number of columns, side by side, at least 1.
    pub columns: usize,
}

/// Format in which raw frames are kept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RawFormat {
    /// Portable network graphics.
    #[default]
    Png,
    /// Tagged image file format.
    Tiff,
}

impl Default for Averaging {
    fn default() -> Self {
        Self {
            frames: 1,
            columns: 1,
        }
    }
}

impl ScanSettings {
    /// Checks the settings that do not depend on a scene.
    pub(super) fn check(&self) -> Result<(), TriangulationError> {
        for (parameter, count) in [
            ("frames", self.average.frames as usize),
            ("columns", self.average.columns),
        ] {
            check::that(
                count > 0,
                parameter,
                count,
                "",
                "at least 1 to average over",
            )?;
        }
        if !self.height.is_normalized() {
            return Err(TriangulationError::Direction {
                parameter: "height",
                allowed: "a direction of length 1",
            });
        }
        self.pitch.map_or(Ok(()), check_pitch)
    }
}

impl Default for ScanSettings {
    fn default() -> Self {
        Self {
            surface: None,
            height: DVec3::Z,
            pitch: None,
            average: Averaging::default(),
            raw: RawFormat::default(),
        }
    }
}
