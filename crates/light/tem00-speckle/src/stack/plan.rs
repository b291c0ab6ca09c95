use tem00_numerics::{cast::to_usize, is_fast_side};

use crate::{PupilField, SlicePath, SpeckleError, SpeckleStack, StackOptions};

/// Requirements of the look-ups on a stack.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StackNeeds {
    /// Width and height of the image, in pixels.
    pub image: [f64; 2],
    /// Width and height of the region that is looked up in any frame, in pixels: the image, and the
    /// parts beyond its edges that motion brings in.
    pub region: [f64; 2],
    /// The speckle size `h = λ d / D` on the sensor, in pixels.
    pub speckle_size: f64,
    /// The largest motion of the pupil over the speckle, in pupil diameters, or `None` if the
    /// speckle never changes.
    pub motion: Option<f64>,
    /// The number of frames among which the speckle is compared.
    pub frames: u32,
    /// The memory limit of the slices, in bytes.
    pub memory_limit: u64,
}

/// Sizes of a stack that does not repeat within the looked-up region and takes no more memory than
/// necessary.
///
/// - The diameter of the pupil field, the number of speckles after which the pattern repeats, is at
///   least the size of the region in speckles along each axis: `C ≥ region / speckle_size`. It is
///   rounded up to the next multiple of 8 without prime factors above 5, and is at least 32. If
///   such a pattern takes too much memory, or exceeds the largest pattern, it covers the image
///   alone without repetition.
/// - The pattern has twice this size, `Q = 2 C`: the Nyquist limit of the intensity.
/// - The slices lie on a straight path. For two frames it is two diameters long: speckle that has
///   left the pupil is new at any look-up. More frames need a path whose end does not overlap its
///   start.
/// - The number of slices per diameter is the largest of 32, 16, 8 or 4 that fits the memory.
///   Blended look-ups exceed the correlation law by up to 0.04, 0.08, 0.14 or 0.23.
///
/// If even this does not fit, the path is shortened: with a path that is too short for the motion,
/// some late frames share their speckle, which [`holds_motion`](Self::holds_motion) reports.
///
/// # Examples
///
/// ```
/// use tem00_speckle::{StackNeeds, StackPlan};
///
/// // A camera of 640 × 480 pixels with speckles of 2.5 pixels; a surface that moves the pupil by a
/// // third of its diameter in 10 frames.
/// let plan = StackPlan::new(&StackNeeds {
///     image: [640.0, 480.0],
///     region: [640.0, 480.0],
///     speckle_size: 2.5,
///     motion: Some(0.33),
///     frames: 10,
///     memory_limit: 256 << 20,
/// })?;
///
/// assert_eq!(plan.diameter(), [256, 192]);
/// assert_eq!(plan.size(), [512, 384]);
/// assert_eq!(plan.path().slice_count(), 64);
/// assert_eq!(plan.memory_bytes(), 96 << 20);
/// # Ok::<(), tem00_speckle::SpeckleError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StackPlan {
    diameter: [usize; 2],
    size: [usize; 2],
    path: SlicePath,
}

/// Numbers of slices per pupil diameter that are tried, the best first.
const SLICES_PER_DIAMETER: [usize; 4] = [32, 16, 8, 4];

/// The longest path that is tried, in pupil diameters: with the fewest slices per diameter it has
/// the largest period.
const LONGEST_PATH: usize = 2 * SlicePath::MAX_HALF_PERIOD / SLICES_PER_DIAMETER[3];

/// The smallest pupil field that is chosen: about 800 phasors.
const SMALLEST_DIAMETER: usize = 32;

impl StackPlan {
    /// Chooses the sizes of a stack: the first of the [candidates](Self::candidates) that fits the
    /// memory.
    ///
    /// # Errors
    ///
    /// Returns an error if a side or the speckle size of `needs` is not positive and finite, or its
    /// motion is negative or not finite, if the image holds more speckles than the largest pattern,
    /// or if even the smallest stack does not fit the memory.
    pub fn new(needs: &StackNeeds) -> Result<Self, SpeckleError> {
        Self::first_within(Self::candidates(needs)?, needs.memory_limit)
    }

    /// Creates a plan from known sizes: the pattern in samples, the pupil in lattice points along
    /// each axis, and the path.
    ///
    /// [`field`](Self::field) returns an error if a pattern cannot have them.
    pub const fn from_sizes(size: [usize; 2], diameter: [usize; 2], path: SlicePath) -> Self {
        Self {
            diameter,
            size,
            path,
        }
    }

    /// Returns the plans for `needs` from the best to the worst, without regard to memory: first
    /// plans that meet all needs with fewer and fewer slices, then plans for the image alone, then
    /// plans with a shorter path.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`new`](Self::new), except for the memory.
    pub fn candidates(needs: &StackNeeds) -> Result<Vec<Self>, SpeckleError> {
        needs.check()?;
        let sizes = needs.sizes();
        let Some(motion) = needs.motion else {
            return Ok(sizes.to_vec());
        };
        let length = if needs.frames <= 2 {
            2
        } else {
            length_for(motion)
        };
        let halved = core::iter::successors(Some(length), |&l| (l > 2).then(|| (l / 2).max(2)));
        let of_length = |length: usize| {
            let paths = SLICES_PER_DIAMETER
                .map(|slices| slices * length / 2)
                .into_iter()
                .filter(|&half_period| half_period <= SlicePath::MAX_HALF_PERIOD)
                .map(move |half_period| SlicePath::Straight {
                    half_period,
                    length,
                });
            sizes
                .into_iter()
                .flat_map(move |size| paths.clone().map(move |path| Self { path, ..size }))
        };
        Ok(halved.flat_map(of_length).collect())
    }

    /// Returns the first of `plans` that takes at most `memory_limit` bytes and has sizes that a
    /// pattern can have.
    ///
    /// # Errors
    ///
    /// Returns an error if there is no such plan: the error of the sizes if a plan fits the memory,
    /// the memory limit otherwise.
    pub fn first_within(
        plans: impl IntoIterator<Item = Self>,
        memory_limit: u64,
    ) -> Result<Self, SpeckleError> {
        let (mut smallest, mut impossible) = (u64::MAX, None);
        for plan in plans {
            let needed = plan.memory_bytes();
            if needed > memory_limit {
                smallest = smallest.min(needed);
                continue;
            }
            match plan.field(0) {
                Ok(_) => return Ok(plan),
                Err(error) => impossible = impossible.or(Some(error)),
            }
        }
        Err(impossible.unwrap_or(SpeckleError::MemoryLimit {
            needed: smallest,
            limit: memory_limit,
        }))
    }

    /// Returns the plan with a square pattern of `size` samples and a pupil of `diameter` lattice
    /// points.
    #[must_use]
    pub const fn with_square(mut self, size: usize, diameter: usize) -> Self {
        self.size = [size; 2];
        self.diameter = [diameter; 2];
        self
    }

    /// Returns the plan with `2 half_period` slices on its path.
    #[must_use]
    pub const fn with_half_period(mut self, half_period: usize) -> Self {
        self.path = match self.path {
            SlicePath::Circle { .. } => SlicePath::Circle { half_period },
            SlicePath::Straight { length, .. } => SlicePath::Straight {
                half_period,
                length,
            },
            SlicePath::Still => SlicePath::Straight {
                half_period,
                length: 2,
            },
        };
        self
    }

    /// Returns the plan with its slices on the circle of Bergmann et al. 2016, M of them per
    /// diameter.
    #[must_use]
    pub const fn on_circle(mut self) -> Self {
        let half_period = match self.path {
            SlicePath::Still => 1,
            SlicePath::Circle { half_period } => half_period,
            SlicePath::Straight {
                half_period,
                length,
            } => 2 * half_period / length,
        };
        self.path = SlicePath::Circle { half_period };
        self
    }

    /// Returns the width and the height of the pattern, in samples.
    pub const fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Returns the diameter of the pupil along each axis, in lattice points: the speckles after
    /// which the pattern repeats.
    pub const fn diameter(&self) -> [usize; 2] {
        self.diameter
    }

    /// Returns the path of the slices.
    pub const fn path(&self) -> SlicePath {
        self.path
    }

    /// Returns the bytes that the slices take.
    pub const fn memory_bytes(&self) -> u64 {
        self.path.memory_bytes(self.size)
    }

    /// Returns [`SlicePath::slices_per_diameter`] of the path.
    pub const fn slices_per_diameter(&self) -> f64 {
        self.path.slices_per_diameter()
    }

    /// Returns [`SlicePath::reach`] of the path.
    pub const fn reach(&self) -> f64 {
        self.path.reach()
    }

    /// Returns the largest motions to either side of the reference that the slices distinguish, in
    /// pupil diameters, for motions whose largest shifts are `shifts`: with motion to both sides,
    /// each side gets its part of the [reach](Self::reach).
    pub fn reaches(&self, shifts: [f64; 2]) -> [f64; 2] {
        let [before, after] = shifts;
        if before == 0.0 || after == 0.0 {
            return [self.reach(); 2];
        }
        shifts.map(|part| self.reach() * part / (before + after))
    }

    /// Returns the position of pattern `number` in a stack that several patterns share, in periods
    /// along x and y. The positions are the points of the sequence of Roberts (2018), far apart
    /// from each other, and the first is the origin.
    pub fn place(number: usize) -> [f64; 2] {
        /// The plastic ratio: the root of x³ = x + 1.
        const PLASTIC: f64 = 1.324_717_957_244_746;
        let number = number as f64;
        [PLASTIC, PLASTIC * PLASTIC].map(|step| (number / step).fract())
    }

    /// Returns whether a pupil diameter has at least 16 slices. From this number on a separate
    /// stack is better than a position in a shared stack with more slices; with fewer slices the
    /// blend exceeds the correlation law by up to 0.11.
    pub fn blends_closely(&self) -> bool {
        self.slices_per_diameter() >= 16.0
    }

    /// Returns whether the pattern does not repeat within the region.
    pub fn holds_region(&self, needs: &StackNeeds) -> bool {
        (0..2).all(|axis| self.diameter[axis] as f64 >= needs.region[axis] / needs.speckle_size)
    }

    /// Returns whether each frame has the speckle of its own motion. With two frames this is always
    /// the case, since speckle beyond the reach is new.
    pub fn holds_motion(&self, needs: &StackNeeds) -> bool {
        needs.frames <= 2 || needs.motion.is_none_or(|motion| motion <= self.reach())
    }

    /// Returns the pupil field of this plan, with the phasors of `seed`.
    ///
    /// # Errors
    ///
    /// Returns an error if its sizes are out of range; the sizes that [`new`](Self::new) chooses
    /// are always in range.
    pub fn field(&self, seed: u64) -> Result<PupilField, SpeckleError> {
        if self.size[0] == self.size[1] {
            return PupilField::new(self.size[0], self.diameter[0], seed);
        }
        let speckle_size = self.size[0] as f64 / self.diameter[0] as f64;
        PupilField::from_speckle_size(self.size, speckle_size, seed)
    }

    /// Generates the stack of this plan from the phasors of `seed`.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`field`](Self::field) and [`SpeckleStack::generate_with`].
    pub fn stack(&self, seed: u64, options: StackOptions) -> Result<SpeckleStack, SpeckleError> {
        SpeckleStack::generate_with(&self.field(seed)?, self.path, options)
    }
}

impl StackNeeds {
    fn check(&self) -> Result<(), SpeckleError> {
        let positive = |x: &f64| x.is_finite() && *x > 0.0;
        for (parameter, lengths) in [
            ("image", &self.image[..]),
            ("region", &self.region),
            ("speckle_size", &[self.speckle_size]),
        ] {
            if let Some(length) = lengths.iter().find(|length| !positive(length)) {
                let allowed = "a positive finite number of pixels";
                return Err(SpeckleError::refused(parameter, *length, allowed));
            }
        }
        match self.motion {
            Some(motion) if !(motion >= 0.0 && motion.is_finite()) => {
                let allowed = "finite and not negative, in pupil diameters";
                Err(SpeckleError::refused("motion", motion, allowed))
            }
            _ => Ok(()),
        }
    }

    /// Returns plans with one slice, for the region and for the image.
    fn sizes(&self) -> [StackPlan; 2] {
        [self.region, self.image].map(|sides| {
            let diameter = sides.map(|side| diameter_for(side / self.speckle_size));
            StackPlan {
                diameter,
                size: diameter.map(|diameter| diameter.saturating_mul(2)),
                path: SlicePath::Still,
            }
        })
    }
}

/// The smallest multiple of 8 without prime factors above 5 that covers `speckles` speckles: a size
/// for which Fourier transforms are fast.
fn diameter_for(speckles: f64) -> usize {
    // The pupil field refuses sizes that are too large.
    let smallest = to_usize(speckles.ceil()).max(SMALLEST_DIAMETER);
    let multiples = smallest.div_ceil(8)..=PupilField::MAX_SIZE / 8;
    multiples
        .map(|multiple| 8 * multiple)
        .find(|&diameter| is_fast_side(diameter))
        .unwrap_or(smallest)
}

/// The length of a straight path, in pupil diameters, whose end does not overlap its start after a
/// motion of `motion` diameters.
fn length_for(motion: f64) -> usize {
    to_usize((1.0 + motion).ceil()).clamp(2, LONGEST_PATH)
}

#[cfg(test)]
mod tests;
