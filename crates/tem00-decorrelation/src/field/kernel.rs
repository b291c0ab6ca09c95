//! The laws at one point, and a loop over many points that fills the vector units.

use glam::{DVec2, DVec3};
use tem00_numerics::vectorised;

use super::MotionField;
use super::slices::{FieldLight, FieldPoints, FieldSlices, INPUTS, OUTPUTS};
use crate::{GRAZING_COSINE, correlation};

/// Number of points that are worked on at a time, in arrays that no other memory overlaps.
const BLOCK: usize = 32;

/// The columns of a block of points.
type Block<const COLUMNS: usize> = [[f64; BLOCK]; COLUMNS];

/// A surface point, its motion and its light.
pub(super) struct Point {
    position: DVec3,
    normal: DVec3,
    motion: DVec3,
    /// The components of K: xx, xy, xz, and yy, yz, zz.
    curvature: [DVec3; 2],
}

impl Point {
    #[inline(always)]
    fn of(block: &Block<INPUTS>, i: usize) -> Self {
        let [px, py, pz, nx, ny, nz, ax, ay, az, xx, xy, xz, yy, yz, zz] = block;
        Self {
            position: DVec3::new(px[i], py[i], pz[i]),
            normal: DVec3::new(nx[i], ny[i], nz[i]),
            motion: DVec3::new(ax[i], ay[i], az[i]),
            curvature: [
                DVec3::new(xx[i], xy[i], xz[i]),
                DVec3::new(yy[i], yz[i], zz[i]),
            ],
        }
    }
}

/// Change of the speckle at a point.
struct Outcome {
    speckle_displacement: DVec2,
    pupil_displacement: DVec2,
    correlation: f64,
    pattern_coordinate: DVec2,
}

impl Outcome {
    #[inline(always)]
    fn put(&self, block: &mut Block<OUTPUTS>, i: usize) {
        let [speckle_x, speckle_y, pupil_x, pupil_y, correlation, x, y] = block;
        speckle_x[i] = self.speckle_displacement.x;
        speckle_y[i] = self.speckle_displacement.y;
        pupil_x[i] = self.pupil_displacement.x;
        pupil_y[i] = self.pupil_displacement.y;
        correlation[i] = self.correlation;
        x[i] = self.pattern_coordinate.x;
        y[i] = self.pattern_coordinate.y;
    }
}

/// Plane waves do not turn.
#[inline(always)]
fn collimated(_: &Point, _: DVec3) -> Option<DVec3> {
    None
}

/// K a = (a − l (l·a))/R for a source at `source`.
#[inline(always)]
fn spherical(source: DVec3, point: &Point, a: DVec3) -> Option<DVec3> {
    let to_source = source - point.position;
    let squared = to_source.length_squared();
    Some((a - to_source * (to_source.dot(a) / squared)) / squared.sqrt())
}

/// K a for the tensor that came with the point.
#[inline(always)]
fn curved(point: &Point, a: DVec3) -> Option<DVec3> {
    let [first, rest] = point.curvature;
    Some(DVec3::new(
        first.dot(a),
        first.y * a.x + rest.x * a.y + rest.y * a.z,
        first.z * a.x + rest.y * a.y + rest.z * a.z,
    ))
}

impl MotionField {
    /// Works out displacements, correlation and coordinates at many points.
    ///
    /// Few points at a time waste time: they are taken in blocks of 32.
    ///
    /// # Panics
    ///
    /// Panics unless all slices of `points` and `out` are of equal length.
    pub fn evaluate(&self, points: &FieldPoints<'_>, out: FieldSlices<'_>) {
        let columns = points.columns();
        let columns = &columns[..points.column_count()];
        let out = out.into_columns();
        let len = out[0].len();
        assert!(
            columns.iter().all(|column| column.len() == len)
                && out.iter().all(|column| column.len() == len),
            "all slices must be of equal length, got {:?} and {:?}",
            columns
                .iter()
                .map(|column| column.len())
                .collect::<Vec<_>>(),
            out.each_ref().map(|column| column.len()),
        );
        vectorised(
            #[inline(always)]
            || match points.light {
                FieldLight::Collimated => self.run(columns, out, collimated),
                FieldLight::PointSource(source) => {
                    self.run(columns, out, |point, a| spherical(source, point, a));
                }
                FieldLight::Curvature(_) => self.run(columns, out, curved),
            },
        );
    }

    /// Works through all points, with the turn of the illumination by a motion, K a, as a function.
    #[inline(always)]
    fn run(
        &self,
        columns: &[&[f64]],
        mut out: [&mut [f64]; OUTPUTS],
        turn: impl Fn(&Point, DVec3) -> Option<DVec3>,
    ) {
        let mut block = [[0.0; BLOCK]; INPUTS];
        let mut results = [[0.0; BLOCK]; OUTPUTS];
        let len = out[0].len();
        for start in (0..len).step_by(BLOCK) {
            for (column, source) in block.iter_mut().zip(columns) {
                load(column, &source[start..]);
            }
            // A last block with fewer points works on leftovers too, so that all go the same way.
            for i in 0..BLOCK {
                let outcome = self.outcome(&Point::of(&block, i), &turn);
                outcome.put(&mut results, i);
            }
            for (target, column) in out.iter_mut().zip(&results) {
                store(&mut target[start..], column);
            }
        }
    }

    /// Works out a point without a branch.
    #[inline(always)]
    fn outcome(&self, point: &Point, turn: impl Fn(&Point, DVec3) -> Option<DVec3>) -> Outcome {
        let to_pupil = self.setup.pupil_centre - point.position;
        let distance_squared = to_pupil.length_squared();
        let sight = Sight::new(self.in_camera(to_pupil));
        let motion = self.in_camera(point.motion + self.seen);
        let seen = sight.project(motion);
        let image = seen * (self.signed_principal_distance * sight.per_depth);
        let reference = self.image_at(&sight);
        let visible = (sight.depth > GRAZING_COSINE * distance_squared.sqrt())
            & is_finite(image)
            & is_finite(reference);

        let (mut pupil, mut known) = (seen, visible);
        if let Some(turn) = turn(point, point.motion + self.within_illumination) {
            let along = turn.dot(to_pupil);
            let facing = point.normal.dot(to_pupil);
            let grazing = GRAZING_COSINE * GRAZING_COSINE * distance_squared;
            let in_surface = along == 0.0;
            let turned = turn - point.normal * select(in_surface, 0.0, along / facing);
            pupil += sight.project(self.in_camera(turned * distance_squared.sqrt()));
            known &= in_surface | (facing * facing > grazing * point.normal.length_squared());
        }
        let defocus = sight.per_depth - self.per_surface_to_pupil;
        let beside = pupil * (-self.signed_principal_distance * defocus);
        known &= is_finite(pupil) & is_finite(image + beside);

        let shift = pupil.length_squared().sqrt() * self.per_pupil_diameter;
        let axial = motion.z * (sight.per_depth * sight.per_depth) * self.per_axial_length;
        let left = select(known, correlation(shift, axial), 0.0);
        let image = either(visible, image, DVec2::ZERO);
        let beside = either(known, beside, DVec2::ZERO);
        Outcome {
            speckle_displacement: image + beside,
            pupil_displacement: either(known, pupil, DVec2::INFINITY),
            correlation: left,
            pattern_coordinate: (either(visible, reference, DVec2::ZERO) - beside)
                * self.samples_per_metre,
        }
    }

    /// The image of a point, in metres from the optical axis.
    #[inline(always)]
    fn image_at(&self, sight: &Sight) -> DVec2 {
        sight.slope * -self.signed_principal_distance
    }

    /// Returns where to look up the pattern of a point at rest, in pattern samples from the optical axis:
    /// at its image, or `None` if the camera cannot see it.
    ///
    /// It is what [`evaluate`](Self::evaluate) returns for a point that has not moved.
    pub fn pattern_coordinate(&self, position: DVec3) -> Option<DVec2> {
        let to_pupil = self.setup.pupil_centre - position;
        let sight = Sight::new(self.in_camera(to_pupil));
        let coordinate = self.image_at(&sight) * self.samples_per_metre;
        let visible = sight.depth > GRAZING_COSINE * to_pupil.length();
        (visible && coordinate.is_finite()).then_some(coordinate)
    }

    /// Returns the components of a vector along b1, b2 and b3.
    #[inline(always)]
    fn in_camera(&self, vector: DVec3) -> DVec3 {
        let camera = &self.setup.camera;
        DVec3::new(
            vector.dot(camera.right()),
            vector.dot(camera.up()),
            vector.dot(camera.towards_camera()),
        )
    }
}

/// A line of sight in the frame of the camera.
struct Sight {
    depth: f64,
    per_depth: f64,
    slope: DVec2,
}

impl Sight {
    #[inline(always)]
    fn new(to_pupil: DVec3) -> Self {
        let per_depth = 1.0 / to_pupil.z;
        Self {
            depth: to_pupil.z,
            per_depth,
            slope: DVec2::new(to_pupil.x * per_depth, to_pupil.y * per_depth),
        }
    }

    /// Projects a vector in the frame of the camera along the line of sight onto the pupil.
    #[inline(always)]
    fn project(&self, vector: DVec3) -> DVec2 {
        DVec2::new(
            vector.x - self.slope.x * vector.z,
            vector.y - self.slope.y * vector.z,
        )
    }
}

#[inline(always)]
fn select(condition: bool, yes: f64, no: f64) -> f64 {
    if condition { yes } else { no }
}

#[inline(always)]
fn either(condition: bool, yes: DVec2, no: DVec2) -> DVec2 {
    DVec2::new(
        select(condition, yes.x, no.x),
        select(condition, yes.y, no.y),
    )
}

#[inline(always)]
fn is_finite(v: DVec2) -> bool {
    (v.x.abs() <= f64::MAX) & (v.y.abs() <= f64::MAX)
}

/// Copies the beginning of `source`, up to a block.
#[inline(always)]
fn load(column: &mut [f64; BLOCK], source: &[f64]) {
    match source.first_chunk() {
        Some(whole) => *column = *whole,
        None => column[..source.len()].copy_from_slice(source),
    }
}

/// Copies a block to the beginning of `target`, up to its end.
#[inline(always)]
fn store(target: &mut [f64], column: &[f64; BLOCK]) {
    match target.first_chunk_mut() {
        Some(whole) => *whole = *column,
        None => target.copy_from_slice(&column[..target.len()]),
    }
}
