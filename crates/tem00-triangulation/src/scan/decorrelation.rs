use tem00_decorrelation::{
    CameraFrame, Configuration, ConfigurationData, Illumination, ImageOrientation, RigidMotion,
    RigidMotions, SpeckleMotion,
};
use tem00_tracer::Scene;

use super::average::SpeckleCorrelation;
use crate::{DVec2, DVec3};

/// A point of a surface whose speckle is followed from frame to frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpeckleWitness {
    /// The index of the surface in the scene.
    pub surface: usize,
    /// Where the point is in the first of the frames, in metres.
    pub position: DVec3,
    /// The unit normal there.
    pub normal: DVec3,
}

/// How speckle has changed from one frame to another: it has moved, and only a part of it is left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpeckleChange {
    /// How far the pattern has moved in the image, in pixels to the right and down.
    pub displacement: DVec2,
    /// The correlation of what is left, from 0 to 1.
    pub correlation: f64,
}

impl SpeckleChange {
    /// Nothing has changed.
    pub const NONE: Self = Self {
        displacement: DVec2::ZERO,
        correlation: 1.0,
    };

    /// Another pattern.
    pub const ALL: Self = Self {
        displacement: DVec2::ZERO,
        correlation: 0.0,
    };

    /// Returns what becomes of the speckle of the first laser at a point between two frames, by the law
    /// of its motion and decorrelation; another pattern where the law has no value.
    ///
    /// A head that moves over a still part changes speckle as the part does that moves under it.
    ///
    /// # Panics
    ///
    /// Panics unless the scene has the surface.
    pub fn between(scene: &Scene, witness: &SpeckleWitness, [from, to]: [u32; 2]) -> Self {
        Self::law(scene, witness, [from, to]).unwrap_or(Self::ALL)
    }

    fn law(scene: &Scene, witness: &SpeckleWitness, [from, to]: [u32; 2]) -> Option<Self> {
        let laser = scene.lasers.first()?;
        let camera = scene.camera_at(from);
        let geometry = camera.imaging_geometry(laser.wavelength()).ok()?;
        // The phase of the light at a point follows from its direction alone.
        let light = |frame: u32, point: DVec3| {
            Illumination::collimated(laser.at(frame).wave_direction_at(point)?).ok()
        };
        let before = Configuration::new(ConfigurationData {
            wavelength: laser.wavelength(),
            point: witness.position,
            normal: witness.normal,
            illumination: light(from, witness.position)?,
            camera: CameraFrame::from_axes(camera.axes()).ok()?,
            pupil: camera.position(),
        })
        .ok()?;
        let step = |motion: &tem00_tracer::Trajectory| {
            motion.pose_at(from).inverse().then(&motion.pose_at(to))
        };
        let surface = step(&scene.surfaces[witness.surface].trajectory);
        let now = before
            .moved(&RigidMotions {
                surface,
                camera: step(&scene.camera_trajectory),
                source: RigidMotion::IDENTITY,
            })
            .ok()?;
        let now = now.with_illumination(light(to, surface.point(witness.position))?);
        let motion = SpeckleMotion::between(
            &geometry,
            &before,
            &now.ok()?,
            ImageOrientation::ScreenUpright,
        );
        let moved = motion.speckle_displacement() / geometry.pixel_pitch();
        let change = Self {
            displacement: DVec2::new(moved.x, -moved.y),
            correlation: motion.correlation,
        };
        (change.displacement.is_finite() && change.correlation.is_finite()).then_some(change)
    }
}

/// The correlation of a line's place over columns, for each number of frames between.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameCorrelation {
    /// By number of frames, then by columns, from −reach to reach.
    tables: Vec<Vec<f64>>,
}

impl FrameCorrelation {
    /// Keeps correlations: for each number of frames those of columns from −n to n apart.
    ///
    /// # Panics
    ///
    /// Panics unless each table has an odd length.
    pub fn new(tables: Vec<Vec<f64>>) -> Self {
        assert!(
            tables.iter().all(|table| table.len() % 2 == 1),
            "a table of columns from −n to n has an odd length"
        );
        Self { tables }
    }

    /// Returns the number of profiles of independent speckle that a mean over so many frames is worth: from
    /// 1 to their number.
    ///
    /// ```text
    /// N_eff = N² / Σ max(0, ρ(|a − b|))
    /// ```
    ///
    /// As in a [mean](crate::averaged_profile), nothing is counted on frames that err the opposite way.
    pub fn effective_frames(&self, frames: u32) -> f64 {
        let pairs = (1..frames).map(|later| {
            let pairs = f64::from(frames - later);
            2.0 * pairs * self.between(0, later).max(0.0)
        });
        let sum = f64::from(frames) * self.between(0, 0) + pairs.sum::<f64>();
        f64::from(frames) * f64::from(frames) / sum.max(1.0)
    }
}

impl SpeckleCorrelation for FrameCorrelation {
    fn between(&self, columns: i64, later: u32) -> f64 {
        let table = usize::try_from(later).ok().and_then(|n| self.tables.get(n));
        let Some(table) = table else { return 0.0 };
        let middle = i64::try_from(table.len() / 2).unwrap_or(i64::MAX);
        let index = usize::try_from(columns.saturating_add(middle)).ok();
        index.and_then(|i| table.get(i)).copied().unwrap_or(0.0)
    }
}
