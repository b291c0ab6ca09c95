use glam::DMat3;
use glam::{DVec2, DVec3};
use tem00_triangulation::PositionNoise;

use crate::{
    frame::{IndirectLight, MeasuredFrame, MeasuredPoint},
    settings::Averaging,
};

/// Averages the profiles of consecutive frames, and neighbouring columns of them, into one.
///
/// Each mean takes the valid points of its columns and frames, the brightest of several in a
/// column, as [`mean_point`] does.
pub(crate) fn averaged_profile(
    frames: &[MeasuredFrame],
    averaging: Averaging,
    correlation: impl Fn(i64, u32) -> f64,
) -> Vec<MeasuredPoint> {
    let block = |point: &MeasuredPoint| point.seen.column / averaging.columns;
    let mut members: Vec<Member<'_>> = frames
        .iter()
        .flat_map(|frame| brightest_points(frame).map(|point| (frame.frame, point)))
        .collect();
    members.sort_by_key(|(frame, point)| (block(point), *frame, point.seen.column));
    members
        .chunk_by(|(_, a), (_, b)| block(a) == block(b))
        .filter_map(|members| mean_point(members, &correlation))
        .collect()
}

/// A point and the frame it was seen in.
type Member<'a> = (u32, &'a MeasuredPoint);

/// Returns the valid points of a frame, the brightest of several in a column.
fn brightest_points(frame: &MeasuredFrame) -> impl Iterator<Item = &MeasuredPoint> {
    let columns = frame.points.chunk_by(|a, b| a.seen.column == b.seen.column);
    columns.filter_map(|points| {
        let valid = points.iter().filter(|point| point.is_valid());
        valid.max_by(|a, b| a.seen.reflectance.total_cmp(&b.seen.reflectance))
    })
}

/// Returns the mean of points, each with the frame it was seen in, or `None` without any.
///
/// `correlation` gives the correlation, by speckle, of the line's position in columns that lie so
/// many columns apart, the second in a frame so many frames after the first. The mean carries the
/// uncertainty of a mean of correlated numbers:
///
/// ```text
/// speckle          Σ u_a u_b ρ_ab / n²      ρ the correlation of the speckle between columns and
///                                           frames, between frames at least 0
/// shot, dark, …    Σ u_a² / n²              new in every column and frame
/// PRNU, DSNU       the same pixels in every frame: only columns average
/// ```
///
/// A pattern that has moved across the line by about its width moves it the other way: the law has
/// ρ < 0 for such frames, and a mean over them is better than a mean over as many independent
/// patterns. The uncertainty does not rely on this, since the motion would have to be known to a
/// fraction of the line's width.
///
/// Its other values are means, too, or the values of the middle point.
pub fn mean_point(
    members: &[(u32, &MeasuredPoint)],
    correlation: impl Fn(i64, u32) -> f64,
) -> Option<MeasuredPoint> {
    let (_, middle) = members.get(members.len() / 2)?;
    let count = members.len() as f64;
    let points = || members.iter().map(|(_, point)| *point);
    let mut mean = **middle;
    mean.position = points().map(|point| point.position).sum::<DVec3>() / count;
    mean.per_pixel = points().map(|point| point.per_pixel).sum::<DVec3>() / count;
    let seen = &mut mean.seen;
    seen.pixel = points().map(|point| point.seen.pixel).sum::<DVec2>() / count;
    seen.width = points().map(|point| point.seen.width).sum::<f64>() / count;
    seen.reflectance = points().map(|point| point.seen.reflectance).sum::<f64>() / count;
    seen.point.position = points().map(|p| p.seen.point.position).sum::<DVec3>() / count;
    mean.calibration = points().fold(DMat3::ZERO, |sum, p| sum + p.calibration) * count.recip();
    mean.noise = mean_noise(members, correlation);
    // An error that neighbours and frames share.
    mean.indirect = IndirectLight {
        fraction: points().map(|point| point.indirect.fraction).sum::<f64>() / count,
        shift: points().map(|point| point.indirect.shift).sum::<f64>() / count,
        alone: points().any(|point| point.indirect.alone),
    };
    let deviation = mean.position_uncertainty();
    let along = mean.per_pixel.length();
    mean.seen.point.uncertainty = deviation * points().map(seen_per_pixel).sum::<DVec3>() / count;
    mean.seen.point.along = deviation * along;
    Some(mean)
}

/// Displacement of the point, before it is brought to the part, per pixel of line displacement.
fn seen_per_pixel(point: &MeasuredPoint) -> DVec3 {
    point.per_pixel.length() * point.seen.point.direction.abs()
}

/// The noise of the mean of the positions of several points.
fn mean_noise(members: &[Member<'_>], correlation: impl Fn(i64, u32) -> f64) -> PositionNoise {
    let squared_count = (members.len() as f64).powi(2);
    let mut sum = PositionNoise::default();
    for (_, point) in members {
        sum.shot += point.noise.shot;
        sum.dark += point.noise.dark;
        sum.quantisation += point.noise.quantisation;
    }
    for (frame_a, a) in members {
        for (frame_b, b) in members {
            let columns = signed_distance(a, b);
            let (one, other) = (&a.noise, &b.noise);
            let apart = if frame_b >= frame_a {
                columns
            } else {
                -columns
            };
            let later = frame_a.abs_diff(*frame_b);
            let law = correlation(apart, later);
            let rho = if later == 0 { law } else { law.max(0.0) };
            sum.speckle += rho * (one.speckle * other.speckle).sqrt();
            if columns == 0 {
                sum.prnu += (one.prnu * other.prnu).sqrt();
                sum.dsnu += (one.dsnu * other.dsnu).sqrt();
            }
        }
    }
    sum.speckle = sum.speckle.max(0.0);
    sum.scaled(1.0 / squared_count)
}

/// Number of columns by which the second point lies to the right of the first.
fn signed_distance(a: &MeasuredPoint, b: &MeasuredPoint) -> i64 {
    let column = |point: &MeasuredPoint| i64::try_from(point.seen.column).unwrap_or(i64::MAX);
    column(b) - column(a)
}
