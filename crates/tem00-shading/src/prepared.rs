use core::fmt;
use std::sync::Arc;

use glam::{DVec2, DVec3};
use tem00_camera::Camera;
use tem00_decorrelation::ImagingGeometry;
use tem00_speckle::{Complex, SpeckleStack, StackNeeds, StackPlan};

use crate::{
    BLOCK, Laser, Motion, Pose, SeenPoint, ShadingError, SpeckleShift,
    state::{ReferencePoint, State},
};

/// The speckle of a laser in the image of a camera, ready for the frames that it was prepared for. Clones share the
/// patterns.
#[derive(Clone, Debug)]
pub struct PreparedSpeckle(pub(crate) Arc<Patterns>);

/// The patterns, and what they were chosen for.
#[derive(Debug)]
pub(crate) struct Patterns {
    pub(crate) camera: Camera,
    pub(crate) laser: Laser,
    pub(crate) geometry: ImagingGeometry,
    pub(crate) parts: Vec<Part>,
    pub(crate) needs: StackNeeds,
    pub(crate) plan: StackPlan,
    /// The largest shifts of the poses to either side of the reference, in pupil diameters.
    pub(crate) shifts: [f64; 2],
    pub(crate) farthest: Option<ReferencePoint>,
    pub(crate) points: Vec<(DVec3, DVec3)>,
}

/// A pattern, and its fraction of the light.
#[derive(Clone, Debug)]
pub(crate) struct Part {
    pub fraction: f64,
    pub stack: SpeckleStack,
}

/// The speckle of one body in one frame, which holds on to the patterns.
#[derive(Clone, Debug)]
pub struct SpeckleFrame {
    speckle: Arc<Patterns>,
    state: State,
    side: f64,
    reach: f64,
    /// The place of the body in the patterns, in samples.
    offset: DVec2,
}

/// Positions in a stack: x and y in samples, u in slices.
struct Positions {
    x: [f64; BLOCK],
    y: [f64; BLOCK],
    u: [f64; BLOCK],
}

impl PreparedSpeckle {
    /// Returns the speckle of a body in a frame: once per body and frame.
    ///
    /// # Errors
    ///
    /// Returns an error if the motion shifts the speckle farther than the poses that it was prepared for.
    pub fn frame(&self, motion: &Motion) -> Result<SpeckleFrame, ShadingError> {
        let Self(patterns) = self;
        let frame = self.unchecked(motion)?;
        let seen = frame.state.scouted(&patterns.geometry, &patterns.points);
        let shifts = seen.into_iter().map(|(_, shift)| shift.pupil);
        let shift = shifts.filter(|shift| shift.is_finite()).fold(0.0, f64::max);
        // Of two frames the second has new speckle beyond the reach, whatever it is.
        let held = frame.reach;
        if shift > held && (patterns.needs.frames > 2 || held == 0.0) {
            return Err(ShadingError::BeyondPoses { shift, held });
        }
        Ok(frame)
    }

    /// Writes the factors at points that stood elsewhere in the reference state, for a host that knows no bodies but has
    /// buffers of an image: where the points are, their unit normals, and where they were.
    ///
    /// A point counts as carried along without a turn. Points whose motion is the same, one after the other, are looked up
    /// fastest; those that are not finite have the factor 1.
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
        Ok(SpeckleFrame {
            speckle: Arc::clone(patterns),
            state,
            side,
            reach: patterns.plan.reaches(patterns.shifts)[usize::from(side > 0.0)],
            offset: DVec2::from_array(StackPlan::place(motion.body)) * DVec2::from_array(size),
        })
    }

    /// Returns the imaging geometry on the axis of the camera, with the size of the speckle.
    pub fn geometry(&self) -> &ImagingGeometry {
        &self.0.geometry
    }

    /// Returns the sizes of the patterns.
    pub fn plan(&self) -> &StackPlan {
        &self.0.plan
    }

    /// Returns the bytes that all patterns take.
    pub fn memory_bytes(&self) -> u64 {
        self.0
            .plan
            .memory_bytes()
            .saturating_mul(self.0.parts.len() as u64)
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
            "{} of {width} × {height} samples, {slices} {} ({:.0} MiB): speckle of {:.2} px, the region of {:.0} × {:.0} \
             px repeats nothing, the pupil moves by {:.2} of its diameters in {} frames",
            counted(patterns.parts.len(), "pattern", "patterns"),
            if slices == 1 { "slice" } else { "slices each" },
            self.memory_bytes() as f64 / f64::from(1 << 20),
            patterns.needs.speckle_size,
            patterns.needs.region[0],
            patterns.needs.region[1],
            before + after,
            patterns.needs.frames,
        )
    }
}

fn counted(count: usize, one: &str, more: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { more })
}

impl SpeckleFrame {
    /// Returns the factor by which speckle multiplies the radiance at a point, now, of a surface with a unit normal.
    ///
    /// It is 1 where the camera does not see the point: there is no pattern there. Where it sees it, but the law has no
    /// value, as where the surface is seen edge-on, the speckle is new.
    pub fn factor(&self, point: DVec3, normal: DVec3) -> f64 {
        let mut factor = [1.0];
        self.factors(&[point], &[normal], &mut factor);
        factor[0]
    }

    /// Returns the factor at a point that a camera sample sees at an image point, in pixels with y down: out of focus it
    /// lies beside the one where the centre of the lens sees it.
    pub fn factor_at(&self, pixel: DVec2, point: DVec3, normal: DVec3) -> f64 {
        let seen = SeenPoint {
            pixel,
            position: point,
            normal,
        };
        let mut factor = [1.0];
        self.look_up(&[Some(seen)], &mut factor);
        factor[0]
    }

    /// Writes the factors at many points, with their unit normals: the same bits as [`factor`](Self::factor) one by one.
    ///
    /// Neighbours in the image, one after the other, are looked up fastest.
    ///
    /// # Panics
    ///
    /// Panics unless the slices have the same length.
    pub fn factors(&self, points: &[DVec3], normals: &[DVec3], factors: &mut [f64]) {
        assert!(
            points.len() == factors.len() && normals.len() == factors.len(),
            "{} points and {} normals for {} factors",
            points.len(),
            normals.len(),
            factors.len()
        );
        let mut seen = [None; BLOCK];
        let blocks = points.chunks(BLOCK).zip(normals.chunks(BLOCK));
        for ((points, normals), factors) in blocks.zip(factors.chunks_mut(BLOCK)) {
            for (seen, (&point, &normal)) in seen.iter_mut().zip(points.iter().zip(normals)) {
                *seen = self.state.seen(point, normal);
            }
            self.look_up(&seen[..points.len()], factors);
        }
    }

    /// Returns the mean factor over the pixel about the image of a point: for a host with one sample per pixel, whose
    /// speckle would have too much contrast at a point.
    pub fn average(&self, point: DVec3, normal: DVec3) -> f64 {
        let Some(seen) = self.seen(point, normal) else {
            return 1.0;
        };
        let Positions { x, y, u } = self.positions(&[Some(seen)]);
        let parts = self.speckle.parts.iter();
        let means = parts.map(|Part { fraction, stack }| {
            let pixel = stack.speckle_size() / self.speckle.needs.speckle_size;
            fraction * stack.average_over([x[0], y[0]], [pixel; 2], u[0])
        });
        means.sum()
    }

    /// Returns the complex amplitude of the first pattern, of mean square 1, for a host that adds fields.
    ///
    /// Returns `None` where the camera does not see the point.
    pub fn amplitude(&self, point: DVec3, normal: DVec3) -> Option<Complex<f64>> {
        let seen = self.seen(point, normal)?;
        let Part { stack, .. } = self.speckle.parts.first()?;
        let Positions { x, y, u } = self.positions(&[Some(seen)]);
        Some(stack.amplitude_at(x[0], y[0], u[0]))
    }

    /// Returns what has become of the speckle at a point since the reference state, or `None` where the law has no value.
    pub fn shift(&self, point: DVec3, normal: DVec3) -> Option<SpeckleShift> {
        let mut shift = [None];
        self.shifts(&[point], &[normal], &mut shift);
        shift[0]
    }

    /// Writes what has become of the speckle at many points, `None` where the camera does not see them or the law has no
    /// value: the same bits as [`shift`](Self::shift) one by one.
    ///
    /// # Panics
    ///
    /// Panics unless the slices have the same length.
    pub fn shifts(&self, points: &[DVec3], normals: &[DVec3], shifts: &mut [Option<SpeckleShift>]) {
        assert!(
            points.len() == shifts.len() && normals.len() == shifts.len(),
            "{} points and {} normals for {} shifts",
            points.len(),
            normals.len(),
            shifts.len()
        );
        let seen: Vec<_> = points
            .iter()
            .zip(normals)
            .map(|(&point, &normal)| self.seen(point, normal))
            .collect();
        let anywhere = |point: &Option<SeenPoint>| point.unwrap_or(SeenPoint::ANYWHERE);
        self.state
            .shifts(&self.speckle.geometry, seen.iter().map(anywhere), shifts);
        for (shift, point) in shifts.iter_mut().zip(&seen) {
            *shift = shift.filter(|_| point.is_some());
        }
    }

    fn seen(&self, point: DVec3, normal: DVec3) -> Option<SeenPoint> {
        self.state.seen(point, normal).filter(is_finite)
    }

    /// Looks up a block of points.
    fn look_up(&self, points: &[Option<SeenPoint>], factors: &mut [f64]) {
        let count = points.len();
        factors.fill(0.0);
        let Positions { x, y, u } = self.positions(points);
        for Part { fraction, stack } in &self.speckle.parts {
            let mut intensities = [0.0; BLOCK];
            stack.intensity_batch(
                &x[..count],
                &y[..count],
                &u[..count],
                &mut intensities[..count],
            );
            let pairs = factors.iter_mut().zip(&intensities);
            pairs.for_each(|(factor, intensity)| *factor += fraction * intensity);
        }
        for (factor, point) in factors.iter_mut().zip(points) {
            if !point.as_ref().is_some_and(is_finite) {
                *factor = 1.0;
            }
        }
    }

    /// Finds where points are looked up in the stacks, which are alike; those out of sight anywhere.
    fn positions(&self, points: &[Option<SeenPoint>]) -> Positions {
        let mut positions = Positions {
            x: [0.0; BLOCK],
            y: [0.0; BLOCK],
            u: [0.0; BLOCK],
        };
        let Some(Part { stack, .. }) = self.speckle.parts.first() else {
            return positions;
        };
        let geometry = &self.speckle.geometry;
        let seen = points
            .iter()
            .map(|point| point.filter(is_finite).unwrap_or(SeenPoint::ANYWHERE));
        let mut shifts = [None; BLOCK];
        let shifts = &mut shifts[..points.len()];
        self.state.shifts(geometry, seen.clone(), shifts);
        let per_pixel = geometry.pattern_coordinate(DVec2::ONE, DVec2::ZERO, stack.speckle_size());
        let new = SpeckleShift {
            pupil: f64::INFINITY,
            ..SpeckleShift::default()
        };
        for (i, (point, shift)) in seen.zip(&*shifts).enumerate() {
            let shift = shift.unwrap_or(new);
            let pixel = self.state.perspective().point(point.pixel) - shift.displacement;
            [positions.x[i], positions.y[i]] = (pixel * per_pixel + self.offset).to_array();
            positions.u[i] = shift.pupil;
        }
        let u = &mut positions.u[..points.len()];
        stack.coordinates_within(self.reach, u);
        u.iter_mut().for_each(|u| *u *= self.side);
        positions
    }
}

fn is_finite(point: &SeenPoint) -> bool {
    point.pixel.is_finite() && point.position.is_finite()
}
