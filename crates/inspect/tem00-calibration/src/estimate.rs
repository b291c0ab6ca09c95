use glam::{DMat3, DVec2, DVec3};
use nalgebra::DMatrix;
use tem00_camera::Camera;
use tem00_decorrelation::RigidMotion;
use tem00_numerics::Grid;

use crate::{
    Calibration, CalibrationCovariance, CalibrationQuality, CameraModel, Checkerboard, PARAMETERS,
    corners::find_corners,
    covariance::COUNT,
    least_squares::{Solution, minimise},
    model::{Bundle, Pose, State},
    perturbation::INTRINSICS,
    plane_fit::{FittedPlane, correlation_factor, without_outliers},
    start::{starts, tilted},
};
use tem00_triangulation::{LaserPlane, LinePoint, TriangulationError, Validity};

/// The minimum number of boards.
const MIN_BOARDS: usize = 3;

/// View of one board by a camera: image points, in pixels.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BoardView {
    /// The inner corners, row by row from the upper left, as
    /// [`Checkerboard::points`] has them.
    pub corners: Vec<DVec2>,
    /// The laser line on the board in the same pose. Points beyond the board are left out. It may
    /// be empty.
    pub line: Vec<DVec2>,
}

impl BoardView {
    /// Finds a board in its image. `line` holds the points of each column of the image of the same
    /// board under the laser, if there is one: of each column the point with the highest peak is
    /// taken, if it is valid.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`find_corners`].
    pub fn find(
        lit: &Grid<f32>,
        line: &[Vec<LinePoint>],
        board: &Checkerboard,
    ) -> Result<Self, TriangulationError> {
        let brightest = |(column, found): (usize, &Vec<LinePoint>)| {
            let valid = found
                .iter()
                .filter(|point| point.validity == Validity::Valid);
            let point = valid.max_by(|one, two| one.peak.total_cmp(&two.peak))?;
            Some(DVec2::new(column as f64 + 0.5, point.position))
        };
        Ok(Self {
            corners: find_corners(lit, board)?,
            line: line.iter().enumerate().filter_map(brightest).collect(),
        })
    }
}

/// Estimates camera and laser plane from views of a checkerboard.
///
/// The camera and the poses of the boards minimise the sum of squared distances of the corners from
/// their expected positions. The laser plane minimises the sum of squared distances from the points
/// where the lines of sight to the laser line meet the boards. The scatter of both gives the
/// covariance of all parameters: the scatter of the corners through the poses into the plane, and
/// the scatter of the line, whose neighbouring points are correlated.
///
/// The world is the frame of the first board: heights are counted from it.
///
/// # Validity
///
/// The covariance describes random errors in the images, to first order, with the size that the
/// residuals show. It does not include a board that is not flat, a wrong square or a lens with
/// other than radial distortion, nor the effect of uneven light and bent edges on corners, see
/// [`find_corners`]: these errors are common to a whole board, and the residuals hardly show them.
///
/// # Errors
///
/// Returns an error if the model is not possible, if there are fewer than three boards or a board
/// has another number of corners, or if the boards or the lines on them do not determine camera or
/// plane.
///
/// # References
///
/// - Z. Zhang, *A Flexible New Technique for Camera Calibration*, 2000.
pub fn calibrate(
    board: &Checkerboard,
    views: &[BoardView],
    model: &CameraModel,
) -> Result<Calibration, TriangulationError> {
    model.check()?;
    check_views(board, views)?;
    let points = board.points();
    let images = views.iter().map(|view| view.corners.as_slice()).collect();
    let mut bundle = Bundle {
        model,
        free: vec![0, 1, 2],
        board: &points,
        images,
    };
    let pinhole = best_pinhole(&bundle)?;
    let start = if model.tilted {
        bundle.free = vec![0, 3, 4];
        tilted(model, &pinhole)
    } else {
        pinhole
    };
    bundle.free.extend(5..5 + model.radial);
    let solution = minimise(&bundle, start)?;
    let lines = Lines::new(&bundle, &solution.state, board, views)?;
    assemble(&bundle, &solution, &lines)
}

fn check_views(board: &Checkerboard, views: &[BoardView]) -> Result<(), TriangulationError> {
    if views.len() < MIN_BOARDS {
        return Err(TriangulationError::TooFew {
            what: "boards",
            got: views.len(),
            needed: MIN_BOARDS,
        });
    }
    let whole = |view: &&BoardView| {
        let positions = view.corners.iter().chain(&view.line);
        view.corners.len() == board.corner_count() && positions.into_iter().all(|p| p.is_finite())
    };
    match views.iter().find(|view| !whole(view)) {
        None => Ok(()),
        Some(view) => Err(TriangulationError::NoBoard {
            corners: board.corners(),
            found: view.corners.len(),
        }),
    }
}

/// Returns the best camera without distortion, from any start.
fn best_pinhole(bundle: &Bundle<'_>) -> Result<State, TriangulationError> {
    let starts = starts(bundle.model, bundle.board, &bundle.images)?;
    let found = starts
        .into_iter()
        .filter_map(|start| minimise(bundle, start).ok());
    let best = found.min_by(|one, two| one.sum.total_cmp(&two.sum));
    best.map(|solution| solution.state)
        .ok_or(TriangulationError::NotDetermined {
            what: "the image distance",
            advice: "tilt the boards by 15° to 30° about different axes",
        })
}

/// The image points of the laser line on the boards that make the plane.
struct Lines {
    /// Corner positions of each board.
    positions: Vec<Vec<DVec2>>,
    plane: FittedPlane,
    covariance: [[f64; 4]; 4],
    outliers: usize,
    rms: f64,
}

impl Lines {
    fn new(
        bundle: &Bundle<'_>,
        state: &State,
        board: &Checkerboard,
        views: &[BoardView],
    ) -> Result<Self, TriangulationError> {
        let camera = bundle.camera(state).ok_or(OUTSIDE)?;
        let mut positions: Vec<Vec<DVec2>> = Vec::new();
        for (view, pose) in views.iter().zip(&state.poses) {
            let on_board = |position: &DVec2| {
                board
                    .contains(pose, on_plane(&camera, pose, *position)?)
                    .then_some(*position)
            };
            positions.push(view.line.iter().filter_map(on_board).collect());
        }
        let points = points_of(&camera, state, &positions).ok_or(OUTSIDE)?;
        let (plane, counts) = without_outliers(&points)?;
        let mut counts = counts.into_iter();
        let before = points.len();
        for positions in &mut positions {
            positions.retain(|_| counts.next().unwrap_or(false));
        }
        let points = points_of(&camera, state, &positions).ok_or(OUTSIDE)?;
        let sum: f64 = points.iter().map(|&p| plane.distance(p).powi(2)).sum();
        let mut distances = points.iter().map(|&p| plane.distance(p));
        let runs: Vec<Vec<f64>> = positions
            .iter()
            .map(|run| distances.by_ref().take(run.len()).collect())
            .collect();
        let freedom = points.len().saturating_sub(3).max(1) as f64;
        let variance = sum / freedom * correlation_factor(&runs);
        Ok(Self {
            covariance: plane.covariance(&points, variance).ok_or(OUTSIDE)?,
            positions,
            plane,
            outliers: before - points.len(),
            rms: (sum / points.len() as f64).sqrt(),
        })
    }

    /// Returns the changes of the normal and the offset of the plane from one state to another.
    fn change(&self, bundle: &Bundle<'_>, state: &State) -> Option<[f64; 4]> {
        let points = points_of(&bundle.camera(state)?, state, &self.positions)?;
        let plane = FittedPlane::through(&points)
            .ok()?
            .towards(self.plane.normal);
        let DVec3 { x, y, z } = plane.normal - self.plane.normal;
        Some([x, y, z, -plane.distance(self.plane.middle)])
    }
}

const OUTSIDE: TriangulationError = TriangulationError::NotDetermined {
    what: "the laser plane",
    advice: "the line must lie on the boards and be seen by the camera",
};

impl Checkerboard {
    /// Returns true if a point, in the axes of the camera, lies on the squares of a board in a
    /// pose. The outer half of the outermost squares does not count.
    fn contains(&self, pose: &Pose, point: DVec3) -> bool {
        let on_board = pose.rotation.transpose() * (point - pose.translation) / self.square();
        let within = |x: f64, corners: usize| x > -0.5 && x < corners as f64 - 0.5;
        within(on_board.x, self.corners()[0]) && within(on_board.y, self.corners()[1])
    }
}

/// Returns the point where the line of sight of an image point meets a board, in the axes of the
/// camera.
fn on_plane(camera: &Camera, pose: &Pose, position: DVec2) -> Option<DVec3> {
    let direction = camera.ray(position).direction;
    let normal = pose.rotation.z_axis;
    let distance = normal.dot(pose.translation) / normal.dot(direction);
    (distance > 0.0 && distance.is_finite()).then(|| distance * direction)
}

/// Returns the points of the line on all boards, in the axes of the camera.
fn points_of(camera: &Camera, state: &State, positions: &[Vec<DVec2>]) -> Option<Vec<DVec3>> {
    let of_board = |(pose, positions): (&Pose, &Vec<DVec2>)| {
        let point = |position: &DVec2| on_plane(camera, pose, *position);
        positions.iter().map(point).collect::<Option<Vec<_>>>()
    };
    let boards: Option<Vec<_>> = state.poses.iter().zip(positions).map(of_board).collect();
    boards.map(|boards| boards.concat())
}

fn assemble(
    bundle: &Bundle<'_>,
    solution: &Solution,
    lines: &Lines,
) -> Result<Calibration, TriangulationError> {
    let state = &solution.state;
    let depths = state.poses.iter().map(|pose| pose.translation.z);
    let mean_depth = depths.sum::<f64>() / state.poses.len() as f64;
    let focus = bundle.model.focus_distance(state.intrinsics[0], mean_depth);
    let camera = bundle
        .model
        .camera(&state.intrinsics, focus)
        .ok_or(OUTSIDE)?;
    let to_board = to_board(&state.poses[0])?;
    let plane = LaserPlane::new(
        to_board.point(lines.plane.middle),
        to_board.direction(lines.plane.normal),
    )?;
    let rows = covariance(bundle, solution, lines).ok_or(OUTSIDE)?;
    let corners = bundle.board.len() * bundle.images.len();
    let quality = CalibrationQuality {
        boards: bundle.images.len(),
        corners,
        rms_reprojection: (solution.sum / corners as f64).sqrt(),
        line_points: lines.positions.iter().map(Vec::len).sum(),
        outliers: lines.outliers,
        rms_plane: lines.rms,
    };
    Calibration::exact(camera.moved(&to_board), plane)
        .with_covariance(CalibrationCovariance::new(DVec3::ZERO, &rows)?)
        .map(|calibration| calibration.with_quality(quality))
}

/// Returns the motion that takes the axes of the camera to the axes of a board.
fn to_board(pose: &Pose) -> Result<RigidMotion, TriangulationError> {
    let rotation: DMat3 = pose.rotation.transpose();
    RigidMotion::new(rotation, -(rotation * pose.translation)).map_err(|_| OUTSIDE)
}

/// Returns the covariance of the [`PARAMETERS`]: the covariance of the fit of the corners,
/// propagated into the plane, and the covariance of the line.
fn covariance(
    bundle: &Bundle<'_>,
    solution: &Solution,
    lines: &Lines,
) -> Option<[[f64; PARAMETERS.len()]; PARAMETERS.len()]> {
    let increments = bundle.increments(&solution.state);
    let mut map = DMatrix::zeros(COUNT, increments.len());
    let free = bundle.free.len();
    for (i, &parameter) in bundle.free.iter().enumerate() {
        map[(parameter, i)] = 1.0;
    }
    for i in 0..6 {
        map[(INTRINSICS + i, free + i)] = 1.0;
    }
    for (i, &increment) in increments.iter().enumerate() {
        let changed = |by: f64| {
            let mut step = vec![0.0; increments.len()];
            step[i] = by;
            lines.change(bundle, &bundle.stepped(&solution.state, &step))
        };
        let (more, less) = changed(increment).zip(changed(-increment))?;
        for k in 0..4 {
            map[(INTRINSICS + 6 + k, i)] = (more[k] - less[k]) / (2.0 * increment);
        }
    }
    let mut sum = &map * &solution.covariance * map.transpose();
    for (i, row) in lines.covariance.iter().enumerate() {
        for (j, covariance) in row.iter().enumerate() {
            sum[(INTRINSICS + 6 + i, INTRINSICS + 6 + j)] += covariance;
        }
    }
    let symmetric = |i: usize, j: usize| 0.5 * (sum[(i, j)] + sum[(j, i)]);
    Some(core::array::from_fn(|i| {
        core::array::from_fn(|j| symmetric(i, j))
    }))
}

#[cfg(test)]
mod tests;
