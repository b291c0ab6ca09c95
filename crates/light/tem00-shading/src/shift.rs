//! Displacement and correlation of the speckle of many points of a body, in loops that fill vector
//! units.

use glam::{DVec2, DVec3};
use tem00_decorrelation::{
    ChangedPoint, ImagingGeometry, PointChange, RigidChange, add_axial_shifts,
};
use tem00_numerics::vectorised;

use crate::{
    Laser, Perspective,
    laser::{WaveFrame, WaveShape},
};

/// The number of points that are computed together.
pub const BLOCK: usize = 64;

/// Number of points that share vector instructions: a partial block is extended to a multiple of
/// it.
const LANES: usize = 8;

/// A point of a surface, and the image point at which it is seen.
///
/// The point need not lie on the chief ray of its pixel: out of focus it is seen next to the chief
/// ray, and in a mirror elsewhere. Its speckle is assumed to move as the point would move if seen
/// directly, which in a plane mirror is correct except for the reflection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeenPoint {
    /// The image point of the sample, in pixels with y down.
    pub pixel: DVec2,
    /// The point of the surface, in metres.
    pub position: DVec3,
    /// The unit normal, to either side.
    pub normal: DVec3,
}

impl SeenPoint {
    /// Placeholder in a block for a point that is not seen.
    pub(crate) const ANYWHERE: Self = Self {
        pixel: DVec2::ZERO,
        position: DVec3::ZERO,
        normal: DVec3::ZERO,
    };
}

/// Kind of light whose speckle is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LightPath {
    /// Light directly from the laser.
    Direct,
    /// Light that keeps its phases on the surface under any motion of the laser.
    Carried,
}

/// Motion of the speckle of a point since the reference frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SpeckleShift {
    /// The displacement of the speckle in the image in perspective, in pixels with y down.
    pub displacement: DVec2,
    /// The displacement of the pupil over the speckle, in pupil diameters, never negative: the
    /// lateral displacement that leaves the same correlation as the lateral and the axial
    /// displacement together. Infinite where the speckle is new.
    pub pupil: f64,
    /// The displacement across the line of sight, to the right and up, in pupil diameters.
    pub across: DVec2,
    /// The displacement along the axis, in axial decorrelation lengths: positive where the point
    /// has approached.
    pub axial: f64,
}

impl SpeckleShift {
    /// Returns the displacement of the pupil as a vector, to the right and up, in pupil diameters;
    /// a displacement without a direction points to the right.
    pub fn pupil_vector(&self) -> DVec2 {
        self.pupil * self.across.try_normalize().unwrap_or(DVec2::X)
    }

    /// Returns the path of the pupil over the speckle: across it, in pupil diameters, and along the
    /// axis, in axial decorrelation lengths. Paths on opposite sides of the reference have a
    /// negative scalar product.
    pub const fn pupil_path(&self) -> DVec3 {
        DVec3::new(self.across.x, self.across.y, self.axial)
    }
}

/// The law by which the speckle of the points of one body moves and changes in the light of one
/// laser.
#[derive(Clone, Copy, Debug)]
pub struct SpeckleLaw<'a> {
    /// The motion of body and camera since the reference frame.
    pub change: &'a RigidChange,
    /// The laser in the reference frame and in the current frame.
    pub lasers: [&'a Laser; 2],
    /// The image in the current frame.
    pub perspective: &'a Perspective,
    /// The camera's imaging geometry on the axis, in the light of the laser.
    pub geometry: &'a ImagingGeometry,
}

impl SpeckleLaw<'_> {
    /// Writes the change of the speckle at points, `None` where a frame does not see them; the bits
    /// are the same as one by one.
    ///
    /// # Panics
    ///
    /// Panics if there are fewer points than shifts.
    pub fn shifts(
        &self,
        path: LightPath,
        points: impl IntoIterator<Item = SeenPoint>,
        shifts: &mut [Option<SpeckleShift>],
    ) {
        let shared = self.shared(path);
        let [_, now] = self.lasers;
        let shape = now.wave_shape();
        let mut points = points.into_iter();
        let mut block = Block::new();
        let mut changes = Changes::new();
        for shifts in shifts.chunks_mut(BLOCK) {
            let count = shifts.len();
            self.fill(&mut block, points.by_ref().take(count));
            assert_eq!(block.count, count, "a point for each shift");
            shared.changes(&block, &shape, &mut changes);
            add_axial_shifts(count, &mut changes.pupil, &changes.axial);
            for (index, shift) in shifts.iter_mut().enumerate() {
                *shift = changes.shift(index);
            }
        }
    }

    /// Returns the change of the speckle of a point that is lit from the unit vectors `to_source`,
    /// in the reference frame and in the current frame, or `None` where the law has no value.
    pub fn shift_under(&self, to_source: [DVec3; 2], point: SeenPoint) -> Option<SpeckleShift> {
        let shared = self.shared(LightPath::Direct);
        let focus_vergence = self.perspective.focus_vergence(self.geometry, point.pixel);
        let changed = self.change.at(&ChangedPoint {
            position: point.position,
            normal: point.normal,
            to_source,
        });
        let mut changes = Changes::new();
        shared.put(&changed, focus_vergence, 0, &mut changes);
        add_axial_shifts(1, &mut changes.pupil, &changes.axial);
        changes.shift(0)
    }

    fn shared(&self, path: LightPath) -> Shared<'_> {
        let diameter = self.geometry.pupil_diameter();
        let [_, now] = self.lasers;
        Shared {
            law: self.change,
            lasers: self.lasers.map(Laser::wave_frame),
            is_carried: path == LightPath::Carried,
            pixels_per_tangent: self.geometry.principal_distance() / self.geometry.pixel_pitch(),
            per_diameter: diameter.recip(),
            axial_length: 0.125 * diameter * diameter / now.wavelength(),
        }
    }

    fn fill(&self, block: &mut Block, points: impl Iterator<Item = SeenPoint>) {
        block.count = 0;
        for (i, point) in points.enumerate() {
            block.count = i + 1;
            for axis in 0..3 {
                block.position[axis][i] = point.position[axis];
                block.normal[axis][i] = point.normal[axis];
            }
            let vergence = self.perspective.focus_vergence(self.geometry, point.pixel);
            block.focus_vergence[i] = vergence;
        }
    }
}

/// Quantities common to all points of a surface.
struct Shared<'a> {
    law: &'a RigidChange,
    /// The laser in the reference frame and in the current frame.
    lasers: [WaveFrame; 2],
    is_carried: bool,
    pixels_per_tangent: f64,
    per_diameter: f64,
    /// The axial displacement per change of 1/Z, in axial decorrelation lengths.
    axial_length: f64,
}

/// A block of points, component by component.
struct Block {
    count: usize,
    position: [[f64; BLOCK]; 3],
    normal: [[f64; BLOCK]; 3],
    focus_vergence: [f64; BLOCK],
}

/// Displacements of the speckle at the points of a block.
struct Changes {
    displacement: [[f64; BLOCK]; 2],
    across: [[f64; BLOCK]; 2],
    /// Displacement across the pupil, in pupil diameters; infinite where the theory has no value.
    pupil: [f64; BLOCK],
    /// Displacement along the axis, in axial decorrelation lengths.
    axial: [f64; BLOCK],
}

impl Block {
    #[inline(always)] // It is filled in place.
    const fn new() -> Self {
        Self {
            count: 0,
            position: [[0.0; BLOCK]; 3],
            normal: [[0.0; BLOCK]; 3],
            focus_vergence: [0.0; BLOCK],
        }
    }
}

impl Shared<'_> {
    /// Computes the changes at the points of a block.
    fn changes(&self, block: &Block, shape: &WaveShape, changes: &mut Changes) {
        vectorised(
            #[inline(always)]
            || match shape {
                WaveShape::Spot(wave) => {
                    self.run(block, |local| wave.slopes(local), changes);
                }
                WaveShape::Line(wave) => {
                    self.run(block, |local| wave.slopes(local), changes);
                }
            },
        );
    }

    #[inline(always)]
    fn run(&self, block: &Block, slopes: impl Fn([f64; 3]) -> [f64; 2], changes: &mut Changes) {
        let end = block.count.next_multiple_of(LANES).min(BLOCK);
        let ([px, py, pz], [nx, ny, nz]) = (&block.position, &block.normal);
        for i in 0..end {
            let position = DVec3::new(px[i], py[i], pz[i]);
            let [before, now] = &self.lasers;
            let source = before.direction_to_source(self.law.origin(position), &slopes);
            let direct = now.direction_to_source(position, &slopes);
            let carried = self.law.turned(source);
            let point = self.law.at(&ChangedPoint {
                position,
                normal: DVec3::new(nx[i], ny[i], nz[i]),
                to_source: [source, if self.is_carried { carried } else { direct }],
            });
            self.put(&point, block.focus_vergence[i], i, changes);
        }
    }

    /// Adds the displacement of the pattern by defocus to the image of the point:
    /// `∓ C A (W + W') / 2`.
    #[inline(always)]
    fn put(&self, point: &PointChange, focus_vergence: f64, i: usize, changes: &mut Changes) {
        let [before, now] = point.per_depth;
        let defocus = 0.5 * (before + now) - focus_vergence;
        let pupil = point.pupil_displacement;
        let is_known = pupil.x <= f64::MAX;
        let beside = |of_pupil: f64| if is_known { of_pupil * defocus } else { 0.0 };
        let tangents = point.tangent_displacement;
        changes.displacement[0][i] = (tangents.x - beside(pupil.x)) * self.pixels_per_tangent;
        changes.displacement[1][i] = (tangents.y - beside(pupil.y)) * self.pixels_per_tangent;
        changes.across[0][i] = pupil.x * self.per_diameter;
        changes.across[1][i] = pupil.y * self.per_diameter;
        changes.pupil[i] = pupil.length_squared().sqrt() * self.per_diameter;
        changes.axial[i] = (now - before) * self.axial_length;
    }
}

impl Changes {
    #[inline(always)] // It is filled in place.
    const fn new() -> Self {
        Self {
            displacement: [[0.0; BLOCK]; 2],
            across: [[0.0; BLOCK]; 2],
            pupil: [0.0; BLOCK],
            axial: [0.0; BLOCK],
        }
    }

    /// The shift of a point, or `None` where it has no value.
    #[inline]
    fn shift(&self, index: usize) -> Option<SpeckleShift> {
        // Of references: by value, both arrays would be copied for each point.
        let at = |[x, y]: &[[f64; BLOCK]; 2]| DVec2::new(x[index], y[index]);
        let displacement = at(&self.displacement) * DVec2::new(1.0, -1.0);
        let pupil = self.pupil[index];
        displacement.is_finite().then_some(SpeckleShift {
            displacement,
            pupil: if pupil.is_finite() {
                pupil
            } else {
                f64::INFINITY
            },
            across: at(&self.across),
            axial: self.axial[index],
        })
    }
}
