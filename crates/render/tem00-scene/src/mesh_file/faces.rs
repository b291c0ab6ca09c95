use earcut::Earcut;
use glam::{DMat3, DVec3};

use super::error::{MeshFileError, wrong};

/// The maximum number of corners of a face that is not convex: the time to cut it up grows with
/// their square.
const MAX_CORNERS: usize = 1 << 15;

/// The fraction of the area of a face that its triangles may cover the wrong way round: coordinates
/// in single precision are not exact.
const TOLERANCE: f64 = 1e-6;

/// Faces of any number of corners, one after the other.
#[derive(Debug)]
pub(super) struct Faces<T> {
    corners: Vec<T>,
    ends: Vec<usize>,
}

/// The triangles of all faces, and findings about the other faces.
#[derive(Debug)]
pub(super) struct Cut<T> {
    pub(super) triangles: Vec<[T; 3]>,
    /// The number of faces with fewer than three corners.
    pub(super) flat: usize,
    /// The faces that cross themselves, counted from 0.
    pub(super) crossing: Vec<usize>,
}

impl<T> Default for Faces<T> {
    fn default() -> Self {
        Self {
            corners: Vec::new(),
            ends: Vec::new(),
        }
    }
}

impl<T: Copy> Faces<T> {
    pub(super) fn push(&mut self, corners: impl IntoIterator<Item = T>) {
        self.corners.extend(corners);
        self.ends.push(self.corners.len());
    }

    /// Returns the corners of each face.
    pub(super) fn iter(&self) -> impl Iterator<Item = &[T]> {
        let starts = core::iter::once(&0).chain(&self.ends);
        starts
            .zip(&self.ends)
            .map(|(&start, &end)| &self.corners[start..end])
    }

    /// Cuts all faces into triangles; `position` says where a corner is.
    ///
    /// A face without area stays as one triangle without area.
    pub(super) fn cut(&self, position: impl Fn(T) -> DVec3) -> Result<Cut<T>, MeshFileError> {
        let mut cut = Cut {
            triangles: Vec::new(),
            flat: 0,
            crossing: Vec::new(),
        };
        let mut cutter = Cutter::default();
        for (index, corners) in self.iter().enumerate() {
            match *corners {
                [] | [_] | [_, _] => cut.flat += 1,
                [a, b, c] => cut.triangles.push([a, b, c]),
                _ => {
                    cutter.points.clear();
                    let points = corners.iter().map(|&corner| position(corner));
                    cutter.points.extend(points);
                    let crosses = cutter
                        .cut()
                        .map_err(|TooManyCorners| too_many(index, corners))?;
                    cut.crossing.extend(crosses.then_some(index));
                    let triangles = cutter.triangles.iter();
                    cut.triangles
                        .extend(triangles.map(|t| t.map(|i| corners[i as usize])));
                }
            }
        }
        Ok(cut)
    }
}

fn too_many<T>(face: usize, corners: &[T]) -> MeshFileError {
    let got = corners.len();
    wrong(format!(
        "face {face} (from 0) is not convex and has {got} corners: cut it up, at most \
         {MAX_CORNERS} are read"
    ))
}

/// A face is not convex and has more corners than are read.
struct TooManyCorners;

/// Cuts one face after the other, with room for the next.
#[derive(Default)]
struct Cutter {
    /// The corners.
    points: Vec<DVec3>,
    /// The triangles of the last face, as indices of its corners.
    triangles: Vec<[u32; 3]>,
    ears: Vec<u32>,
    earcut: Earcut<f64>,
}

impl Cutter {
    /// Cuts the face with the corners `points`, and returns whether it crosses itself.
    ///
    /// Triangles that all have the orientation of the face cover it once. Repeated halving gives
    /// such triangles in a convex face, and keeps them as wide as the corners allow: a fan around
    /// one corner would make slivers, which overlap so much that no hierarchy of boxes separates
    /// them. Other faces are cut by their ears, in the plane that their corners are closest to.
    fn cut(&mut self) -> Result<bool, TooManyCorners> {
        let count = u32::try_from(self.points.len()).map_err(|_| TooManyCorners)?;
        self.triangles.clear();
        halve([0, count - 1], &mut self.triangles);
        if !self.scale() {
            return Ok(false);
        }
        let areas = self.triangles.iter().map(|&t| self.area(t));
        let (sum, all) = areas.fold((DVec3::ZERO, 0.0), |(sum, all), area| {
            (sum + area, all + area.length())
        });
        if all == 0.0 {
            self.triangles.truncate(1);
            return Ok(false);
        }
        if sum.length() <= TOLERANCE * all {
            return Ok(true);
        }
        let normal = sum.normalize();
        let signed = self.triangles.iter().map(|&t| self.area(t).dot(normal));
        if signed.map(|area| (-area).max(0.0)).sum::<f64>() > TOLERANCE * sum.length() {
            if self.points.len() > MAX_CORNERS {
                return Err(TooManyCorners);
            }
            let ears = self.ears(normal);
            let covered = ears.iter().map(|&t| self.area(t).dot(normal));
            if (covered.sum::<f64>() - sum.length()).abs() > TOLERANCE * sum.length() {
                return Ok(true);
            }
            self.triangles = ears;
        }
        let mut triangles = core::mem::take(&mut self.triangles);
        triangles.retain(|&t| self.area(t) != DVec3::ZERO);
        self.triangles = triangles;
        Ok(false)
    }

    /// Multiplies the points by a power of two, so that areas neither overflow nor vanish; returns
    /// whether all points are finite.
    fn scale(&mut self) -> bool {
        let first = self.points[0];
        let offsets = self.points.iter().map(|&point| (point - first).abs());
        let extent = offsets.map(DVec3::max_element).fold(0.0, f64::max);
        let scale = (-extent.log2().floor()).clamp(-1000.0, 1000.0).exp2();
        for point in &mut self.points {
            *point *= scale;
        }
        self.points.iter().all(|point| point.is_finite())
    }

    /// Returns twice the area of a triangle, along its normal.
    fn area(&self, triangle: [u32; 3]) -> DVec3 {
        let [a, b, c] = triangle.map(|corner| self.points[corner as usize]);
        (b - a).cross(c - a)
    }

    /// Returns the ears of the face, cut off one after the other in the plane across its normal and
    /// turned as it is: if it crosses itself they cover more or less than its area.
    fn ears(&mut self, normal: DVec3) -> Vec<[u32; 3]> {
        let (right, up) = normal.any_orthonormal_pair();
        let to_plane = DMat3::from_cols(right, up, normal).transpose();
        let flat: Vec<[f64; 2]> = self
            .points
            .iter()
            .map(|&point| (to_plane * (point - self.points[0])).truncate().to_array())
            .collect();
        self.earcut.earcut_slice::<u32>(&flat, &[], &mut self.ears);
        let (ears, _) = self.ears.as_chunks::<3>();
        let turned = |&[a, b, c]: &[u32; 3]| {
            if self.area([a, b, c]).dot(normal) < 0.0 {
                [a, c, b]
            } else {
                [a, b, c]
            }
        };
        ears.iter().map(turned).collect()
    }
}

/// Halves a polygon of consecutive corners by chords, again and again.
fn halve([first, last]: [u32; 2], triangles: &mut Vec<[u32; 3]>) {
    if last - first > 1 {
        let middle = first + (last - first).div_ceil(2);
        halve([first, middle], triangles);
        triangles.push([first, middle, last]);
        halve([middle, last], triangles);
    }
}

/// Returns the triangles of a strip: each has two corners of the last, and all turn the same way.
pub(super) fn strip(corners: &[u32]) -> impl Iterator<Item = [u32; 3]> {
    let windows = corners.windows(3).enumerate();
    windows.map(|(index, corners)| match corners {
        &[a, b, c] if index % 2 == 0 => [a, b, c],
        corners => [corners[0], corners[2], corners[1]],
    })
}
