use core::fmt;
use std::sync::Arc;

use glam::{DVec2, DVec3};
use tem00_decorrelation::ImagingGeometry;
use tem00_speckle::StackPlan;

use crate::{Motion, Pose, ShadingError, SpeckleFrame, patterns::Patterns, state::State};

/// The speckle of a laser in the image of a camera, prepared for a set of frames. Clones share the
/// patterns.
#[derive(Clone, Debug)]
pub struct PreparedSpeckle(pub(crate) Arc<Patterns>);

impl PreparedSpeckle {
    /// Returns the speckle of a body in a frame. Call it once per body and frame.
    ///
    /// Where the law has no value, as after a turn by tens of degrees, the speckle is new, and the
    /// same in all such frames.
    ///
    /// # Errors
    ///
    /// Returns an error if the motion shifts the speckle farther than the poses for which it was
    /// prepared, or violates the condition that [`prepare`](crate::Speckle::prepare) states for a
    /// linewidth.
    pub fn frame(&self, motion: &Motion) -> Result<SpeckleFrame, ShadingError> {
        let Self(patterns) = self;
        let frame = self.unchecked(motion)?;
        let seen = frame.state.scouted(&patterns.geometry, &patterns.points);
        let shifts = seen.into_iter().map(|(_, shift)| shift);
        let shifts = shifts.filter(|shift| shift.pupil.is_finite());
        let farthest = shifts.max_by(|a, b| a.pupil.total_cmp(&b.pupil));
        let shift = farthest.map_or(0.0, |shift| shift.pupil);
        let held = frame.reach;
        // Beyond the reach all frames have the same new speckle, so that only a single one may be
        // there.
        let prepared = patterns.shifts[usize::from(frame.side > 0.0)];
        let is_the_only_one = patterns.needs.frames == 2 && shift.to_bits() == prepared.to_bits();
        if shift > held && !is_the_only_one {
            return Err(ShadingError::BeyondPoses { shift, held });
        }
        farthest.map_or(Ok(()), |shift| frame.check_crossing(&shift))?;
        Ok(frame)
    }

    /// Writes the factors at points that have moved since the reference state, for a host that has
    /// no bodies but image buffers: the positions of the points, their normals, and their
    /// positions in the reference state.
    ///
    /// Each point is treated as translated without rotation. Look-ups are fastest if consecutive
    /// points have the same motion; points that are not finite have the factor 1.
    ///
    /// # Panics
    ///
    /// Panics unless the slices have the same length.
    pub fn factors_since(
        &self,
        previous: &[DVec3],
        points: &[DVec3],
        normals: &[DVec3],
        factors: &mut [f64],
    ) {
        assert_eq!(previous.len(), points.len(), "a previous point for each");
        let moved = |index: usize| points[index] - previous[index];
        let mut rest = 0;
        while rest < points.len() {
            let step = moved(rest);
            let alike = (rest..points.len()).take_while(|&index| moved(index) == step);
            let run = rest..rest + alike.count().max(1);
            let frame = Pose::along(step).map(|pose| self.unchecked(&pose.into()));
            match frame {
                Ok(Ok(frame)) => {
                    let (points, normals) = (&points[run.clone()], &normals[run.clone()]);
                    frame.factors(points, normals, &mut factors[run.clone()]);
                }
                _ => factors[run.clone()].fill(1.0),
            }
            rest = run.end;
        }
    }

    /// The frame of a motion, whether or not the slices hold it.
    fn unchecked(&self, motion: &Motion) -> Result<SpeckleFrame, ShadingError> {
        let Self(patterns) = self;
        let state = State::new((&patterns.camera, &patterns.laser), motion)?;
        let side = state.side(&patterns.geometry, patterns.farthest.as_ref());
        let size = patterns.plan.size().map(|samples| samples as f64);
        let of_waves = patterns.bandwidth.as_ref().map_or(0.0, |b| b.reach);
        let reach = patterns.plan.reaches(patterns.shifts)[usize::from(side > 0.0)];
        Ok(SpeckleFrame {
            speckle: Arc::clone(patterns),
            state,
            side,
            reach: (reach - of_waves).max(0.0),
            offset: DVec2::from_array(StackPlan::place(motion.body * patterns.in_a_stack))
                * DVec2::from_array(size),
        })
    }

    /// Returns the imaging geometry on the axis of the camera, which gives the speckle size.
    pub fn geometry(&self) -> &ImagingGeometry {
        &self.0.geometry
    }

    /// Returns the sizes of the patterns.
    pub fn plan(&self) -> &StackPlan {
        &self.0.plan
    }

    /// Returns the memory of all patterns, in bytes.
    pub fn memory_bytes(&self) -> u64 {
        self.0
            .plan
            .memory_bytes()
            .saturating_mul(self.0.stacks.len() as u64)
    }
}

impl fmt::Display for PreparedSpeckle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let patterns = &self.0;
        let [width, height] = patterns.plan.size();
        let slices = patterns.plan.path().slice_count();
        let [before, after] = patterns.shifts;
        write!(
            f,
            "{} of {width} × {height} samples in {} ({:.0} MiB): speckle of {:.2} px, the region \
             of {:.0} × {:.0} px repeats nothing, ",
            counted(patterns.stacks.len() as u64, "pattern", "patterns"),
            counted(slices as u64, "slice", "slices"),
            self.memory_bytes() as f64 / f64::from(1 << 20),
            patterns.needs.speckle_size,
            patterns.needs.region[0],
            patterns.needs.region[1],
        )?;
        let frames = counted(patterns.needs.frames.into(), "frame", "frames");
        let motion = before + after;
        match patterns.needs.motion {
            Some(_) if motion == 0.0 => {
                write!(
                    f,
                    "the pupil moves farther than the law reaches in {frames}"
                )?;
            }
            _ => write!(
                f,
                "the pupil moves by {motion:.2} of its diameters in {frames}"
            )?,
        }
        patterns.bandwidth.as_ref().map_or(Ok(()), |bandwidth| {
            write!(
                f,
                ", a linewidth that displaces it by up to {:.2} of them among it",
                bandwidth.reach
            )
        })
    }
}

fn counted(count: u64, one: &str, more: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { more })
}
