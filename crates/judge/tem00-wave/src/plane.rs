use core::ops::Range;

use glam::DVec3;
use tem00_numerics::check;

use crate::{
    Refusal,
    length::{LENGTHS, checked_length, checked_position},
};

/// Points on a plane at which a field is computed: a lattice, optionally behind a round stop.
///
/// Sample `(x, y)` lies at `centre + (x − ⌊width/2⌋) steps[0] + (y − ⌊height/2⌋) steps[1]`. The
/// steps need not be perpendicular.
///
/// # Examples
///
/// ```
/// use tem00_wave::{DVec3, SamplePlane};
///
/// let steps = [DVec3::X * 1e-3, DVec3::Y * 1e-3];
/// let plane = SamplePlane::new(DVec3::Z, steps, [5, 5])?;
/// assert_eq!(plane.point(4, 2), DVec3::new(2e-3, 0.0, 1.0));
///
/// // Of a square of 5 × 5, a disc of radius 2.5 steps leaves out the corners.
/// assert_eq!(plane.within(2.5e-3)?.open_samples(), 21);
/// # Ok::<(), tem00_wave::Refusal>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SamplePlane {
    centre: DVec3,
    steps: [DVec3; 2],
    samples: [usize; 2],
    radius: Option<f64>,
}

impl SamplePlane {
    /// Creates a plane of samples from its centre and its steps, in metres, and the number of
    /// samples along each step.
    ///
    /// # Errors
    ///
    /// Returns an error if a component of the centre is not finite or above 10 km, if a step is not
    /// between 1 pm and 10 km long, or if the number of samples is zero or above 2²⁸.
    pub fn new(centre: DVec3, steps: [DVec3; 2], samples: [usize; 2]) -> Result<Self, Refusal> {
        const MAX: usize = 1 << 28;
        let count = samples[0].checked_mul(samples[1]);
        let holds = count.is_some_and(|count| (1..=MAX).contains(&count));
        let count = samples[0] as f64 * samples[1] as f64;
        check::that(holds, "samples", count, "", "from 1 to 2²⁸ in all")?;
        for step in steps {
            let holds = LENGTHS.contains(&step.length());
            let allowed = "from 1e-12 to 1e4 long, in metres";
            check::that(holds, "steps", step.to_array(), "", allowed)?;
        }
        Ok(Self {
            centre: checked_position(centre, "centre")?,
            steps,
            samples,
            radius: None,
        })
    }

    /// A plane inside a stop, created from numbers that were checked before.
    pub(crate) const fn stopped(
        centre: DVec3,
        steps: [DVec3; 2],
        samples: [usize; 2],
        radius: f64,
    ) -> Self {
        Self {
            centre,
            steps,
            samples,
            radius: Some(radius),
        }
    }

    /// Returns the same samples behind a round stop about the centre; outside of its radius, in
    /// metres, the field is zero.
    ///
    /// # Errors
    ///
    /// Returns an error if the radius is not between 1 pm and 10 km.
    pub fn within(self, radius: f64) -> Result<Self, Refusal> {
        Ok(Self {
            radius: Some(checked_length(radius, "radius")?),
            ..self
        })
    }

    /// Returns the same samples about another centre, which was checked before.
    pub(crate) const fn about(self, centre: DVec3) -> Self {
        Self { centre, ..self }
    }

    /// Returns the number of samples along each step.
    pub const fn samples(&self) -> [usize; 2] {
        self.samples
    }

    /// Returns the steps between neighbouring samples, in metres.
    pub const fn steps(&self) -> [DVec3; 2] {
        self.steps
    }

    /// Returns the position of sample `(x, y)`, in metres.
    pub fn point(&self, x: usize, y: usize) -> DVec3 {
        self.centre + self.offset(x, y)
    }

    /// Returns the number of samples inside the stop.
    pub fn open_samples(&self) -> usize {
        (0..self.samples[1])
            .map(|y| self.open_in_row(y).len())
            .sum()
    }

    /// Vector from the centre to the sample `(x, y)`, in metres.
    pub(crate) fn offset(&self, x: usize, y: usize) -> DVec3 {
        let from_middle = |i: usize, n: usize| i as f64 - (n / 2) as f64;
        from_middle(x, self.samples[0]) * self.steps[0]
            + from_middle(y, self.samples[1]) * self.steps[1]
    }

    /// The samples of row `y` inside the stop. They are a range, since a stop is convex.
    pub(crate) fn open_in_row(&self, y: usize) -> Range<usize> {
        let columns = 0..self.samples[0];
        let Some(radius) = self.radius else {
            return columns;
        };
        let is_open = |&x: &usize| self.offset(x, y).length() <= radius;
        match columns.clone().find(is_open) {
            Some(first) => first..columns.rev().find(is_open).map_or(first, |last| last + 1),
            None => 0..0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stop_opens_the_samples_within_its_radius() {
        let steps = [DVec3::new(1.0, 0.2, 0.0), DVec3::new(-0.3, 0.9, 0.0)];
        let plane = SamplePlane::new(DVec3::ONE, steps, [31, 24])
            .and_then(|plane| plane.within(7.5))
            .expect("a plane");
        let mut open = 0;
        for y in 0..24 {
            for x in 0..31 {
                let inside = plane.point(x, y).distance(DVec3::ONE) <= 7.5;
                assert_eq!(plane.open_in_row(y).contains(&x), inside, "({x}, {y})");
                open += usize::from(inside);
            }
        }
        assert_eq!(plane.open_samples(), open);
        assert_eq!(plane.point(15, 12), DVec3::ONE);
    }
}
