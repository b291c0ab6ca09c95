use glam::{DMat3, DQuat, DVec2, DVec3};
use nalgebra::{DMatrix, DVector, Matrix3};

use crate::{
    CameraModel,
    homography::homography,
    model::{Pose, State},
};
use tem00_triangulation::TriangulationError;

/// Returns states to start from, none of which needs to be near: a pinhole without distortion by
/// two conditions on the map of each board to its image, once with the principal point and once in
/// the middle, and the focal length of the data sheet.
///
/// ```text
/// h₁ᵀ B h₂ = 0,  h₁ᵀ B h₁ = h₂ᵀ B h₂      B = (1 0 −u; 0 1 −v; −u −v u² + v² + f²)
/// ```
///
/// `h` are the columns of the map, `(u, v)` the principal point and `f` the image distance in
/// pixels. The pixels are square, so that B has three unknowns instead of five.
///
/// # References
///
/// - Z. Zhang, *A Flexible New Technique for Camera Calibration*, 2000, eq. (3), (4) and appendix
///   C.
pub(super) fn starts(
    model: &CameraModel,
    board: &[DVec3],
    images: &[&[DVec2]],
) -> Result<Vec<State>, TriangulationError> {
    let plane: Vec<_> = board.iter().map(|corner| corner.truncate()).collect();
    let (middle, scale) = (model.middle(), model.middle().length());
    let map = |image: &&[DVec2]| {
        let scaled: Vec<_> = image
            .iter()
            .map(|corner| (corner - middle) / scale)
            .collect();
        homography(&plane, &scaled).ok_or(TriangulationError::NotDetermined {
            what: "the position of a board",
            advice: "its corners must not lie on one line",
        })
    };
    let maps: Vec<_> = images.iter().map(map).collect::<Result<_, _>>()?;
    let pinholes = [
        with_principal_point(&maps),
        in_the_middle(&maps),
        from_data_sheet(model, scale),
    ];
    let states = pinholes.into_iter().flatten().filter_map(|pinhole| {
        let poses = maps
            .iter()
            .map(|map| pose(map, &pinhole))
            .collect::<Option<_>>()?;
        let principal = middle + scale * pinhole.principal;
        let image_distance = pinhole.distance * scale * model.pixel_pitch;
        Some(State {
            intrinsics: [
                image_distance,
                principal.x,
                principal.y,
                0.0,
                0.0,
                0.0,
                0.0,
                0.0,
            ],
            poses,
        })
    });
    Ok(states.collect())
}

/// A camera without distortion, in units of half the diagonal of the image from its middle.
#[derive(Clone, Copy, Debug)]
struct Pinhole {
    distance: f64,
    principal: DVec2,
}

/// The two conditions on one map: coefficients of u, v and u² + v² + f², and the negative constant.
fn conditions(map: &DMat3) -> [[f64; 4]; 2] {
    let (a, b) = (map.x_axis, map.y_axis);
    let scale = 1.0 / (a.truncate().length_squared() + b.truncate().length_squared());
    [
        [
            -(a.x * b.z + a.z * b.x),
            -(a.y * b.z + a.z * b.y),
            a.z * b.z,
            -(a.x * b.x + a.y * b.y),
        ],
        [
            -2.0 * (a.x * a.z - b.x * b.z),
            -2.0 * (a.y * a.z - b.y * b.z),
            a.z * a.z - b.z * b.z,
            b.truncate().length_squared() - a.truncate().length_squared(),
        ],
    ]
    .map(|condition| condition.map(|c| scale * c))
}

fn with_principal_point(maps: &[DMat3]) -> Option<Pinhole> {
    let rows: Vec<_> = maps.iter().flat_map(conditions).collect();
    let matrix = DMatrix::from_fn(rows.len(), 3, |i, j| rows[i][j]);
    let right = DVector::from_fn(rows.len(), |i, _| rows[i][3]);
    let found = matrix.svd(true, true).solve(&right, 0.0).ok()?;
    let principal = DVec2::new(found[0], found[1]);
    pinhole(found[2] - principal.length_squared(), principal)
}

fn in_the_middle(maps: &[DMat3]) -> Option<Pinhole> {
    let rows = maps.iter().flat_map(conditions);
    let (above, below) = rows.fold((0.0, 0.0), |(above, below), row| {
        (above + row[2] * row[3], below + row[2] * row[2])
    });
    pinhole(above / below, DVec2::ZERO)
}

/// The image distance is about the focal length where the object is far.
fn from_data_sheet(model: &CameraModel, scale: f64) -> Option<Pinhole> {
    let distance = model.focal_length? / (model.pixel_pitch * scale);
    pinhole(distance * distance, DVec2::ZERO)
}

fn pinhole(squared_distance: f64, principal: DVec2) -> Option<Pinhole> {
    let possible = squared_distance > 0.0 && squared_distance.is_finite();
    (possible && principal.is_finite()).then(|| Pinhole {
        distance: squared_distance.sqrt(),
        principal,
    })
}

/// Returns the pose of a board before a pinhole, from its map to the image.
fn pose(map: &DMat3, pinhole: &Pinhole) -> Option<Pose> {
    let sight = |image: DVec3| {
        ((image.truncate() - image.z * pinhole.principal) / pinhole.distance).extend(image.z)
    };
    let columns = [map.x_axis, map.y_axis, map.z_axis].map(sight);
    let length = 0.5 * (columns[0].length() + columns[1].length());
    // The board stands before the camera.
    let [right, up, translation] = columns.map(|column| column / length.copysign(columns[2].z));
    let rotation = nearest_rotation(DMat3::from_cols(right, up, right.cross(up)))?;
    translation.is_finite().then_some(Pose {
        rotation,
        translation,
    })
}

/// Returns the rotation nearest to a matrix, by its singular vectors.
fn nearest_rotation(matrix: DMat3) -> Option<DMat3> {
    if !matrix.is_finite() {
        return None;
    }
    let svd = Matrix3::from_fn(|i, j| matrix.col(j)[i]).svd(true, true);
    let rotation = svd.u? * svd.v_t?;
    let column = |j: usize| DVec3::new(rotation[(0, j)], rotation[(1, j)], rotation[(2, j)]);
    let rotation = DMat3::from_cols(column(0), column(1), column(2));
    (rotation.determinant() > 0.0).then_some(rotation)
}

/// Returns a pinhole with a principal point off the middle as a pinhole whose axis meets the middle
/// of a tilted sensor: both make the same images.
///
/// ```text
/// tan τ = |d| / c      d from the middle to the principal point, c the image distance
/// ```
///
/// The sensor stays where it is; the axis and the axes of the camera turn to its middle.
pub(super) fn tilted(model: &CameraModel, state: &State) -> State {
    let [distance, x, y, ..] = state.intrinsics;
    let offset = (DVec2::new(x, y) - model.middle()) * model.pixel_pitch;
    let angle = offset.length().atan2(distance);
    let towards = DVec2::new(-offset.y, -offset.x).normalize_or_zero();
    let axis = DVec3::new(-offset.x, -offset.y, distance);
    let turn = DMat3::from_quat(DQuat::from_rotation_arc(axis.normalize(), DVec3::Z));
    let tilt = angle * towards;
    let mut intrinsics = state.intrinsics;
    let middle = model.middle();
    intrinsics[..5].copy_from_slice(&[axis.length(), middle.x, middle.y, tilt.x, tilt.y]);
    let turned = |pose: &Pose| Pose {
        rotation: turn * pose.rotation,
        translation: turn * pose.translation,
    };
    State {
        intrinsics,
        poses: state.poses.iter().map(turned).collect(),
    }
}
