use glam::DVec3;
use tem00_numerics::cast::to_usize;

use crate::{
    Artefact, Axis, Estimate, Extreme, Field, Groove, ProfileSensor, Shape, SurfacePoint,
    estimate::{expected_maximum, jackknife, mean},
    response::aside,
};

/// The number of widths of grooves, each narrower than the one before by √2.
const WIDTHS: i32 = 12;
/// The widest groove, and the land between grooves, in columns across the profile.
const COLUMNS: [f64; 2] = [16.0, 16.0];
/// Widest groove and land between grooves across the scan, in line thicknesses.
const THICKNESSES: [f64; 2] = [4.0, 8.0];
/// The fraction of the field that a comb may cover.
const PART: f64 = 0.9;
/// The maximum number of copies of a comb side by side.
const MAX_COPIES: usize = 8;
/// The columns that grooves across the scan are averaged over, as a fraction of the profile, and
/// the groups they form.
const LENGTH: f64 = 0.25;
const GROUPS: usize = 16;
/// The response at the resolution.
const HALF: f64 = 0.5;
/// The error of the depth at the fidelity limit.
const FIDELITY: f64 = 0.1;
/// The steps of the scan over one groove.
const STEPS: u32 = 64;
/// The profiles of grooves across the scan: in each and next to it, and over the widest.
pub(crate) const PROFILES: usize = (2 * WIDTHS) as usize + STEPS as usize;

/// Measured depth of grooves of one width.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GrooveResponse {
    /// The width, in metres.
    pub width: f64,
    /// The measured depth in the middle of the groove divided by the true depth.
    pub response: Estimate,
}

/// Results of a comb of grooves of falling width.
#[derive(Clone, Debug, PartialEq)]
pub struct GrooveResult {
    /// The axis that runs across the grooves.
    pub across: Axis,
    /// The true depth, in metres.
    pub depth: f64,
    /// The responses, from the widest groove to the narrowest.
    pub responses: Vec<GrooveResponse>,
    /// The topographic spatial resolution, in metres: the width of groove that is measured with
    /// half of its depth, between neighbouring widths by its logarithm; `None` if no width of the
    /// comb is wider and none narrower.
    pub resolution: Option<Estimate>,
    /// The topography fidelity limit, in metres: the width down to which the depths of all grooves
    /// are right within a tenth; `None` as the resolution.
    pub fidelity_limit: Option<Estimate>,
    /// The mapping deviation along the axis, in metres: the largest error of the place of a wide
    /// groove, half-way between the places at which the profile is half as deep as the groove.
    pub mapping: Option<Extreme>,
}

impl GrooveResult {
    /// Measures grooves across the profile or across the scan; `None` if they are not seen.
    pub(crate) fn measure<S: ProfileSensor>(
        sensor: &mut S,
        across: Axis,
        repetitions: usize,
    ) -> Result<Option<Self>, S::Error> {
        match across {
            Axis::X => Self::across_profile(sensor, repetitions),
            Axis::Y => Self::across_scan(sensor),
        }
    }

    /// Measures grooves that all cross each profile.
    fn across_profile<S: ProfileSensor>(
        sensor: &mut S,
        repetitions: usize,
    ) -> Result<Option<Self>, S::Error> {
        let field = sensor.field();
        let Some(comb) = Comb::across_profile(&field) else {
            return Ok(None);
        };
        let length = 8.0 * (repetitions as f64 + 2.0) * field.thickness;
        let artefact = comb.artefact(&field, [field.width, length]);
        let profiles = sensor.measure(&artefact, &aside(&field, repetitions, 0.0))?;
        let depths = |width: usize, kept: &[usize]| {
            let profile = mean_profile(&profiles, kept);
            let land = comb.land(&profile)?;
            let floors = comb.copies(width).map(|groove| floor(&profile, groove));
            let floors: Vec<f64> = floors.collect::<Option<_>>()?;
            Some((land - mean(&floors)) / field.groove_depth)
        };
        let wide = || comb.copies(0);
        let mapped = |kept: &[usize]| {
            let profile = mean_profile(&profiles, kept);
            let errors = wide().map(|groove| place_error(&profile, groove, field.groove_depth));
            errors.collect::<Option<Vec<f64>>>()
        };
        let mapping = mapping(profiles.len(), wide().count(), mapped);
        Ok(comb.result(&field, profiles.len(), depths, mapping))
    }

    /// The line stands in the middle of one groove after the other; a scan goes over the widest.
    fn across_scan<S: ProfileSensor>(sensor: &mut S) -> Result<Option<Self>, S::Error> {
        let field = sensor.field();
        let comb = Comb::new(Axis::Y, field.thickness, 1);
        let length = comb.length + 2.0 * comb.land;
        let artefact = comb.artefact(&field, [LENGTH * field.width, length]);
        let beside = |groove: &Groove| groove.centre + 0.5 * (groove.width + comb.land);
        let at = |y: f64| DVec3::new(0.0, -y, 0.0);
        let grooves = &comb.grooves;
        let places = grooves
            .iter()
            .flat_map(|g| [at(g.centre), at(beside(g))])
            .collect::<Vec<_>>();
        let heights = by_group(&sensor.measure(&artefact, &places)?);
        let depths = |width: usize, kept: &[usize]| {
            let lands: Vec<f64> = (0..grooves.len())
                .map(|index| Some(mean_of(&heights[2 * index + 1], kept)?.z))
                .collect::<Option<_>>()?;
            let floor = mean_of(&heights[2 * width], kept)?.z;
            Some((mean(&lands) - floor) / field.groove_depth)
        };
        let widest = grooves[0];
        let reach = 0.5 * (widest.width + comb.land);
        let step =
            |k: u32| widest.centre + reach * (2.0 * (f64::from(k) + 0.5) / f64::from(STEPS) - 1.0);
        let scan: Vec<DVec3> = (0..STEPS).map(|k| at(step(k))).collect();
        let scanned = by_group(&sensor.measure(&artefact, &scan)?);
        let mapped = |kept: &[usize]| {
            let means = scanned.iter().filter_map(|groups| mean_of(groups, kept));
            let profile: Vec<(f64, f64)> = means.map(|mean| (mean.y, mean.z)).collect();
            place_error(&profile, &widest, field.groove_depth).map(|error| vec![error])
        };
        let mapping = mapping(GROUPS, 1, mapped);
        Ok(comb.result(&field, GROUPS, depths, mapping))
    }
}

impl Field {
    /// Returns the shortest profile that a comb of grooves of all widths fits into, in metres.
    pub fn shortest_for_grooves(&self) -> f64 {
        Comb::one_across_profile(self).length / PART
    }
}

/// Grooves of falling width side by side, in one or several copies.
struct Comb {
    across: Axis,
    /// The distance of neighbouring grooves' walls, in metres.
    land: f64,
    /// The grooves of the first copy, then the grooves of the next copy.
    grooves: Vec<Groove>,
    /// The length of all copies, in metres.
    length: f64,
}

impl Comb {
    fn new(across: Axis, unit: f64, copies: usize) -> Self {
        let [widest, land] = if across == Axis::X {
            COLUMNS
        } else {
            THICKNESSES
        };
        let land = land * unit;
        let width = |k: i32| unit * widest * libm::exp2(-0.5 * f64::from(k));
        let widths = (0..copies).flat_map(|_| (0..WIDTHS).map(width));
        let length: f64 = widths.clone().map(|width| width + land).sum();
        let mut edge = 0.5 * (land - length);
        let placed = widths.map(|width| {
            let centre = edge + 0.5 * width;
            edge += width + land;
            Groove { centre, width }
        });
        Self {
            across,
            land,
            grooves: placed.collect(),
            length,
        }
    }

    /// Places as many copies as fit into a profile; `None` if none fits.
    fn across_profile(field: &Field) -> Option<Self> {
        let one = Self::one_across_profile(field);
        let room = to_usize(PART * field.width / one.length);
        (room > 0).then(|| Self::new(Axis::X, field.column, room.min(MAX_COPIES)))
    }

    fn one_across_profile(field: &Field) -> Self {
        Self::new(Axis::X, field.column, 1)
    }

    fn artefact(&self, field: &Field, size: [f64; 2]) -> Artefact {
        let name = match self.across {
            Axis::X => "grooves across the profile",
            Axis::Y => "grooves across the scan",
        };
        Artefact {
            name,
            shape: Shape::Grooves {
                across: self.across,
                depth: field.groove_depth,
                grooves: self.grooves.clone(),
            },
            size,
        }
    }

    /// The copies of the groove of one width.
    fn copies(&self, width: usize) -> impl Iterator<Item = &Groove> {
        self.grooves.iter().skip(width).step_by(WIDTHS as usize)
    }

    /// The mean height of the land, away from all walls.
    fn land(&self, profile: &[(f64, f64)]) -> Option<f64> {
        let is_far = |x: f64| {
            let mut walls = self.grooves.iter().flat_map(Groove::walls);
            let inside = |groove: &Groove| 2.0 * (x - groove.centre).abs() < groove.width;
            !self.grooves.iter().any(inside) && walls.all(|wall| (x - wall).abs() > self.land / 3.0)
        };
        let land = profile.iter().filter(|(x, _)| is_far(*x));
        let heights: Vec<f64> = land.map(|(_, z)| *z).collect();
        (!heights.is_empty()).then(|| mean(&heights))
    }

    /// Assembles the results from the responses, a function of the width's number and of the
    /// repetitions that count.
    fn result(
        &self,
        field: &Field,
        repetitions: usize,
        response: impl Fn(usize, &[usize]) -> Option<f64>,
        mapping: Option<Extreme>,
    ) -> Option<GrooveResult> {
        let widths = self.grooves[..WIDTHS as usize].iter();
        let widths: Vec<f64> = widths.map(|groove| groove.width).collect();
        let of_width = |(index, &width): (usize, &f64)| {
            let response = jackknife(repetitions, |kept| response(index, kept))?;
            Some(GrooveResponse { width, response })
        };
        let responses = widths.iter().enumerate().map(of_width);
        let curve = |kept: &[usize]| -> Option<Vec<(f64, f64)>> {
            let points = widths.iter().enumerate();
            points
                .map(|(index, &width)| Some((width, response(index, kept)?)))
                .collect()
        };
        let half = |kept: &[usize]| crossing(&curve(kept)?, |response| response - HALF);
        let right = |response: f64| FIDELITY - (response - 1.0).abs();
        Some(GrooveResult {
            across: self.across,
            depth: field.groove_depth,
            responses: responses.collect::<Option<_>>()?,
            resolution: jackknife(repetitions, half),
            fidelity_limit: jackknife(repetitions, |kept| crossing(&curve(kept)?, right)),
            mapping,
        })
    }
}

/// The width at which a function of the response first turns negative, from the widest on: by the
/// parabola, over the logarithm of the width, through the widths on both sides and a third one.
fn crossing(curve: &[(f64, f64)], margin: impl Fn(f64) -> f64) -> Option<f64> {
    let margins: Vec<f64> = curve.iter().map(|point| margin(point.1)).collect();
    let below = margins.iter().position(|&margin| margin < 0.0)?;
    let above = below.checked_sub(1)?;
    let fall = margins[above] - margins[below];
    let bend = match (margins.get(below + 1), above.checked_sub(1)) {
        (Some(next), _) => 0.5 * (next - 2.0 * margins[below] + margins[above]),
        (None, Some(before)) => 0.5 * (margins[below] - 2.0 * margins[above] + margins[before]),
        (None, None) => 0.0,
    };
    // bend t² − (fall + bend) t + margin = 0, for t from 0 at `above` to 1 at `below`
    let slope = fall + bend;
    let root = (slope * slope - 4.0 * bend * margins[above]).sqrt();
    let part = 2.0 * margins[above] / (slope + root);
    Some(curve[above].0 * libm::pow(curve[below].0 / curve[above].0, part))
}

/// The mean place and height of each column that all kept profiles have, along x.
fn mean_profile(profiles: &[Vec<SurfacePoint>], kept: &[usize]) -> Vec<(f64, f64)> {
    let points = || kept.iter().flat_map(|&r| &profiles[r]);
    let columns = points().map(|point| point.column + 1).max().unwrap_or(0);
    let mut sums = vec![(DVec3::ZERO, 0); columns];
    for point in points() {
        let (sum, count) = &mut sums[point.column];
        *sum += point.position;
        *count += 1;
    }
    sums.retain(|(_, count)| *count == kept.len());
    let mean = |(sum, count): &(DVec3, usize)| (sum.x / *count as f64, sum.z / *count as f64);
    let mut means: Vec<(f64, f64)> = sums.iter().map(mean).collect();
    means.sort_by(|a, b| a.0.total_cmp(&b.0));
    means
}

/// The height of the point nearest to the middle of a groove.
fn floor(profile: &[(f64, f64)], groove: &Groove) -> Option<f64> {
    let apart = |x: f64| (x - groove.centre).abs();
    let nearest = profile
        .iter()
        .min_by(|a, b| apart(a.0).total_cmp(&apart(b.0)))?;
    Some(nearest.1)
}

/// The place of a groove, half-way between the points where the profile is half as deep, minus its
/// true place.
fn place_error(profile: &[(f64, f64)], groove: &Groove, depth: f64) -> Option<f64> {
    let below = |z: f64| z < -HALF * depth;
    let crossed = |a: (f64, f64), b: (f64, f64)| {
        let part = (-HALF * depth - a.1) / (b.1 - a.1);
        a.0 + part * (b.0 - a.0)
    };
    let middle = profile.iter().position(|(x, _)| *x >= groove.centre)?;
    let (left, right) = profile.split_at(middle);
    let fall = left
        .windows(2)
        .rev()
        .find(|pair| !below(pair[0].1) && below(pair[1].1))?;
    let rise = right
        .windows(2)
        .find(|pair| below(pair[0].1) && !below(pair[1].1))?;
    Some(0.5 * (crossed(fall[0], fall[1]) + crossed(rise[0], rise[1])) - groove.centre)
}

fn mapping(
    repetitions: usize,
    grooves: usize,
    errors: impl Fn(&[usize]) -> Option<Vec<f64>>,
) -> Option<Extreme> {
    let largest = |kept: &[usize]| {
        errors(kept)?
            .iter()
            .map(|error| error.abs())
            .reduce(f64::max)
    };
    let found = jackknife(repetitions, largest)?;
    let one = |index: usize| jackknife(repetitions, |kept| errors(kept)?.get(index).copied());
    let variance = |index: usize| one(index).map(|error| error.uncertainty.powi(2));
    let variances: Vec<f64> = (0..grooves).map(variance).collect::<Option<_>>()?;
    Some(Extreme {
        value: found.value,
        uncertainty: found.uncertainty,
        by_chance: mean(&variances).sqrt() * expected_maximum(grooves),
    })
}

/// The mean points of groups of neighbouring columns in each profile; NaN without points.
fn by_group(profiles: &[Vec<SurfacePoint>]) -> Vec<[DVec3; GROUPS]> {
    let columns = || profiles.iter().flatten().map(|point| point.column);
    let first = columns().min().unwrap_or(0);
    let count = columns().max().map_or(1, |last| last - first + 1);
    let means = |profile: &Vec<SurfacePoint>| {
        let mut sums = [(DVec3::ZERO, 0.0); GROUPS];
        for point in profile {
            let (sum, points) = &mut sums[(point.column - first) * GROUPS / count];
            *sum += point.position;
            *points += 1.0;
        }
        sums.map(|(sum, points)| sum / points)
    };
    profiles.iter().map(means).collect()
}

/// The mean over the groups that count; `None` if one has no points.
fn mean_of(groups: &[DVec3; GROUPS], kept: &[usize]) -> Option<DVec3> {
    let sum: DVec3 = kept.iter().map(|&group| groups[group]).sum();
    Some(sum / kept.len() as f64).filter(|mean| mean.is_finite())
}
