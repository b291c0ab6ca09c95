use std::sync::Arc;

use glam::{DVec2, DVec3};
use tem00_decorrelation::Illumination;
use tem00_numerics::Refusal;
use tem00_speckle::{Complex, StackPlan};

use crate::{
    BLOCK, Bandwidth, SeenPoint, ShadingError, SpeckleShift,
    patterns::{Field, Part, Patterns},
    state::State,
};

/// The speckle of one body in one frame. It keeps the patterns alive.
#[derive(Clone, Debug)]
pub struct SpeckleFrame {
    pub(crate) speckle: Arc<Patterns>,
    pub(crate) state: State,
    pub(crate) side: f64,
    pub(crate) reach: f64,
    /// The position of the body in the patterns, in samples.
    pub(crate) offset: DVec2,
}

/// Positions in a stack: x and y in samples, u in slices.
struct Positions {
    x: [f64; BLOCK],
    y: [f64; BLOCK],
    u: [f64; BLOCK],
    /// The change of the phase with the height of the relief, in radians per metre.
    phase_per_height: [f64; BLOCK],
}

/// The light for which points are looked up.
#[derive(Clone, Copy)]
struct Light<'a> {
    /// The quantile of the wave number in the laser's line.
    wave: f64,
    /// Wave that illuminates the point, if the light does not come directly from the laser.
    lit_by: Option<&'a Illumination>,
}

impl Light<'_> {
    const fn of(wave: f64) -> Self {
        Self { wave, lit_by: None }
    }
}

/// The number of points that sample a pixel in light with a linewidth, each with its own wave
/// number.
const POINTS: usize = 64;

/// The largest error of the correlation of two frames in light with a linewidth.
const MAX_ERROR: f64 = 0.05;

impl SpeckleFrame {
    /// Returns the factor by which speckle multiplies the radiance at a point of a surface in this
    /// frame, given its normal of any length.
    ///
    /// The factor is 1 where the camera does not see the point. Where the camera sees the point but
    /// the law has no value, as for a surface seen edge-on, the speckle is new.
    pub fn factor(&self, point: DVec3, normal: DVec3) -> f64 {
        let mut factor = [1.0];
        self.factors(&[point], &[normal], &mut factor);
        factor[0]
    }

    /// Returns the factor at a point that the laser does not light directly, as over mirrors and
    /// lenses: [`Wavefront::from_differentials`](crate::Wavefront::from_differentials) computes the
    /// wave from rays that a host has traced. `light` is the light in the reference state, and
    /// moves with the laser.
    pub fn factor_under(&self, light: &Illumination, point: DVec3, normal: DVec3) -> f64 {
        let mut factor = [1.0];
        self.look_up(Some(light), &[self.seen(point, normal)], &mut factor);
        factor[0]
    }

    /// Returns the factor at a point that a camera sample sees at an image point, in pixels with y
    /// down. Out of focus this image point differs from the one at which the centre of the lens
    /// sees the point.
    pub fn factor_at(&self, pixel: DVec2, point: DVec3, normal: DVec3) -> f64 {
        let seen = SeenPoint {
            pixel,
            position: point,
            normal: normal.normalize_or_zero(),
        };
        let mut factor = [1.0];
        self.look_up(None, &[Some(seen)], &mut factor);
        factor[0]
    }

    /// Writes the factors at many points, with their normals; the bits are the same as from
    /// [`factor`](Self::factor) one by one.
    ///
    /// Look-ups are fastest if consecutive points are neighbours in the image.
    ///
    /// # Panics
    ///
    /// Panics unless the slices have the same length.
    pub fn factors(&self, points: &[DVec3], normals: &[DVec3], factors: &mut [f64]) {
        self.in_blocks(points, normals, factors, |seen, factors| {
            self.look_up(None, seen, factors);
        });
    }

    /// Passes points as the camera sees them to `answer`, block by block, with the slots for their
    /// answers.
    fn in_blocks<T>(
        &self,
        points: &[DVec3],
        normals: &[DVec3],
        answers: &mut [T],
        answer: impl Fn(&[Option<SeenPoint>], &mut [T]),
    ) {
        assert!(
            points.len() == answers.len() && normals.len() == answers.len(),
            "{} points and {} normals for {} answers",
            points.len(),
            normals.len(),
            answers.len()
        );
        let mut seen = [None; BLOCK];
        let blocks = points.chunks(BLOCK).zip(normals.chunks(BLOCK));
        for ((points, normals), answers) in blocks.zip(answers.chunks_mut(BLOCK)) {
            for (seen, (&point, &normal)) in seen.iter_mut().zip(points.iter().zip(normals)) {
                *seen = self.seen(point, normal);
            }
            answer(&seen[..points.len()], answers);
        }
    }

    /// Returns the factor at a point in light of one wave number of the laser's line, the quantile
    /// `wave` between 0 and 1: for a renderer that draws a wave number for each of its samples.
    ///
    /// [`factor`](Self::factor) averages over enough wave numbers, at most 64, to bring contrasts
    /// within 1 %, and its cost grows with their number. In light of one wavelength both are the
    /// same.
    pub fn factor_in_wave(&self, point: DVec3, normal: DVec3, wave: f64) -> f64 {
        let mut factor = [1.0];
        self.look_up_in(Light::of(wave), &[self.seen(point, normal)], &mut factor);
        factor[0]
    }

    /// Returns the mean factor over the pixel about the image of a point, for a host with one
    /// sample per pixel: the factor at a single point would have too much contrast. In light with a
    /// linewidth it is the mean of 64 points, each with its own wave number.
    pub fn average(&self, point: DVec3, normal: DVec3) -> f64 {
        let Some(seen) = self.seen(point, normal) else {
            return 1.0;
        };
        if self.speckle.bandwidth.is_some() {
            return self.average_over_waves(&seen);
        }
        let Positions { x, y, u, .. } = self.positions(Light::of(0.5), &[Some(seen)]);
        let mean = |field: &Field| {
            let stack = &self.speckle.stacks[field.stack];
            let pixel = stack.speckle_size() / self.speckle.needs.speckle_size;
            let place = DVec2::new(x[0], y[0]) + field.offset;
            stack.average_over(place.to_array(), [pixel; 2], u[0])
        };
        let parts = self.speckle.parts.iter();
        let means = parts.map(|part| part.fraction * part.fields.iter().map(mean).sum::<f64>());
        means.sum()
    }

    /// The mean over points across the pixel, with wave numbers across the line.
    fn average_over_waves(&self, seen: &SeenPoint) -> f64 {
        let mut sum = 0.0;
        for index in 0..POINTS {
            let place = DVec2::from_array(StackPlan::place(index)) - 0.5;
            let point = SeenPoint {
                pixel: seen.pixel + place,
                ..*seen
            };
            let mut factor = [1.0];
            let wave = (index as f64 + 0.5) / POINTS as f64;
            self.look_up_in(Light::of(wave), &[Some(point)], &mut factor);
            sum += factor[0];
        }
        sum / POINTS as f64
    }

    /// Returns the complex amplitude of the first pattern, of mean square 1, for a host that adds
    /// fields. The light has the median wave number of the laser's line.
    ///
    /// Returns `None` where the camera does not see the point.
    pub fn amplitude(&self, point: DVec3, normal: DVec3) -> Option<Complex<f64>> {
        let seen = self.seen(point, normal)?;
        let part = self.speckle.parts.first()?;
        let positions = self.positions(Light::of(0.5), &[Some(seen)]);
        Some(self.amplitude_of(part, &positions, 0))
    }

    /// Returns the change of the speckle at a point since the reference state, or `None` where the
    /// law has no value.
    pub fn shift(&self, point: DVec3, normal: DVec3) -> Option<SpeckleShift> {
        let mut shift = [None];
        self.shifts(&[point], &[normal], &mut shift);
        shift[0]
    }

    /// Writes the change of the speckle at many points, `None` where the camera does not see them
    /// or the law has no value; the bits are the same as from [`shift`](Self::shift) one by one.
    ///
    /// # Panics
    ///
    /// Panics unless the slices have the same length.
    pub fn shifts(&self, points: &[DVec3], normals: &[DVec3], shifts: &mut [Option<SpeckleShift>]) {
        let geometry = &self.speckle.geometry;
        self.in_blocks(points, normals, shifts, |seen, shifts| {
            let points = seen.iter();
            let points = points.map(|point| point.unwrap_or(SeenPoint::ANYWHERE));
            self.state.shifts(geometry, points, shifts);
            for (shift, point) in shifts.iter_mut().zip(seen) {
                *shift = shift.filter(|_| point.is_some());
            }
        });
    }

    /// Returns the side of the reference state on which the speckle is: 1, or −1 if the pupil has
    /// moved over the speckle in the direction opposite to the frame with the largest motion.
    pub const fn side(&self) -> f64 {
        self.side
    }

    fn seen(&self, point: DVec3, normal: DVec3) -> Option<SeenPoint> {
        self.state.seen(point, normal).filter(is_finite)
    }

    /// Looks up a block of points in all light of the laser.
    fn look_up(
        &self,
        light: Option<&Illumination>,
        points: &[Option<SeenPoint>],
        factors: &mut [f64],
    ) {
        let of = |wave: f64| Light {
            wave,
            lit_by: light,
        };
        self.look_up_in(of(0.5 / self.speckle.waves as f64), points, factors);
        for index in 1..self.speckle.waves {
            let mut of_wave = [0.0; BLOCK];
            let of_wave = &mut of_wave[..points.len()];
            let wave = (index as f64 + 0.5) / self.speckle.waves as f64;
            self.look_up_in(of(wave), points, of_wave);
            let pairs = factors.iter_mut().zip(&*of_wave);
            pairs.for_each(|(mean, factor)| *mean += (factor - *mean) / (index + 1) as f64);
        }
    }

    /// Looks up a block of points in light of one wave number.
    fn look_up_in(&self, light: Light<'_>, points: &[Option<SeenPoint>], factors: &mut [f64]) {
        let count = points.len();
        factors.fill(0.0);
        let positions = self.positions(light, points);
        for part in &self.speckle.parts {
            let mut intensities = [0.0; BLOCK];
            let intensities = &mut intensities[..count];
            match part.fields.as_slice() {
                [Field { stack, offset }] => {
                    let Positions { x, y, u, .. } = &positions;
                    let [x, y] =
                        [(x, offset.x), (y, offset.y)].map(|(at, by)| at.map(|at| at + by));
                    let stack = &self.speckle.stacks[*stack];
                    stack.intensity_batch(&x[..count], &y[..count], &u[..count], intensities);
                }
                _ => {
                    for (i, intensity) in intensities.iter_mut().enumerate() {
                        *intensity = self.amplitude_of(part, &positions, i).norm_sqr();
                    }
                }
            }
            let pairs = factors.iter_mut().zip(&*intensities);
            pairs.for_each(|(factor, intensity)| *factor += part.fraction * intensity);
        }
        for (factor, point) in factors.iter_mut().zip(points) {
            if !point.as_ref().is_some_and(is_finite) {
                *factor = 1.0;
            }
        }
    }

    /// The sum of the fields of a pattern at a position.
    fn amplitude_of(&self, part: &Part, at: &Positions, index: usize) -> Complex<f64> {
        let (x, y, u) = (at.x[index], at.y[index], at.u[index]);
        let fields = part.fields.iter().zip(self.speckle.heights());
        let fields = fields.map(|(Field { stack, offset }, [height, root])| {
            let stack = &self.speckle.stacks[*stack];
            let (x, y) = (x + offset.x, y + offset.y);
            let phase = at.phase_per_height[index] * height - stack.ramp_at(x, y, u);
            stack.amplitude_at(x, y, u) * Complex::cis(phase) * root
        });
        fields.sum()
    }

    /// Finds the look-up positions of points, which are the same in all stacks; points out of sight
    /// get an arbitrary position.
    fn positions(&self, light: Light<'_>, points: &[Option<SeenPoint>]) -> Positions {
        let mut positions = Positions {
            x: [0.0; BLOCK],
            y: [0.0; BLOCK],
            u: [0.0; BLOCK],
            phase_per_height: [0.0; BLOCK],
        };
        let Some(stack) = self.speckle.stacks.first() else {
            return positions;
        };
        let geometry = &self.speckle.geometry;
        let seen = points
            .iter()
            .map(|point| point.filter(is_finite).unwrap_or(SeenPoint::ANYWHERE));
        let mut shifts = [None; BLOCK];
        let shifts = &mut shifts[..points.len()];
        match light.lit_by {
            Some(light) => {
                for (shift, point) in shifts.iter_mut().zip(seen.clone()) {
                    *shift = self.state.shift_under(light, geometry, point);
                }
            }
            None => self.state.shifts(geometry, seen.clone(), shifts),
        }
        let per_pixel = geometry.pattern_coordinate(DVec2::ONE, DVec2::ZERO, stack.speckle_size());
        let new = SpeckleShift {
            pupil: f64::INFINITY,
            ..SpeckleShift::default()
        };
        for (i, (point, shift)) in seen.clone().zip(&*shifts).enumerate() {
            let shift = shift.unwrap_or(new);
            let pixel = self.state.perspective().point(point.pixel) - shift.displacement;
            [positions.x[i], positions.y[i]] = (pixel * per_pixel).to_array();
            positions.u[i] = shift.pupil;
        }
        let u = &mut positions.u[..points.len()];
        stack.coordinates_within(self.reach, u);
        u.iter_mut().for_each(|u| *u *= self.side);
        if let Some(bandwidth) = &self.speckle.bandwidth {
            for (i, point) in seen.enumerate() {
                self.displace(&mut positions, i, &point, (bandwidth, light.wave));
            }
        }
        let [x0, y0] = self.offset.to_array();
        positions.x[..points.len()]
            .iter_mut()
            .for_each(|x| *x += x0);
        positions.y[..points.len()]
            .iter_mut()
            .for_each(|y| *y += y0);
        positions
    }

    /// Displaces a position by the displacement of the speckle for a wave number of the line, in
    /// slices along the axis of the bandwidth.
    fn displace(
        &self,
        positions: &mut Positions,
        i: usize,
        point: &SeenPoint,
        (bandwidth, wave): (&Bandwidth, f64),
    ) {
        let Some(stack) = self.speckle.stacks.first() else {
            return;
        };
        let law = self.state.spectral_law(&self.speckle.geometry);
        let kappa = self.speckle.laser.spectrum().draw(wave);
        let shift = law.shift(point, kappa).unwrap_or_default();
        let beside = self.speckle.geometry.pattern_coordinate(
            shift.displacement,
            DVec2::ZERO,
            stack.speckle_size(),
        );
        let place = DVec2::new(positions.x[i], positions.y[i]) - beside;
        let axis = bandwidth.axis;
        [positions.x[i], positions.y[i]] = [axis.dot(place), axis.perp().dot(place)];
        let along = bandwidth.stretch * shift.along(axis);
        positions.u[i] += stack.path().slices_per_diameter() * along;
        positions.phase_per_height[i] = shift.phase_per_height;
    }

    /// Checks that slices along one line hold the correlation of the frame with the reference in
    /// light with a linewidth.
    pub(crate) fn check_crossing(&self, shift: &SpeckleShift) -> Result<(), ShadingError> {
        let Some(bandwidth) = &self.speckle.bandwidth else {
            return Ok(());
        };
        let line = self.speckle.laser.spectrum();
        let axis = bandwidth.axis;
        let covariance = |shift: DVec2| bandwidth.covariance(line, shift, axis);
        let held = covariance(self.side * shift.pupil * axis);
        let error = (held - covariance(shift.pupil_vector())) / covariance(DVec2::ZERO);
        if error.abs() <= MAX_ERROR {
            return Ok(());
        }
        let allowed = "along the displacement of the pupil by other wavelengths: an error of at \
                       most 0.05 of the correlation of two frames";
        Err(Refusal::new("motion", error, allowed).into())
    }
}

fn is_finite(point: &SeenPoint) -> bool {
    point.pixel.is_finite() && point.position.is_finite()
}
