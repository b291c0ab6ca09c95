use tem00_numerics::cast::to_usize;

use crate::{PupilField, SlicePath, SpeckleError, SpeckleStack, StackOptions};

/// Requirements on a stack: the look-ups that it is for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StackNeeds {
    /// Width and height of the image, in pixels.
    pub image: [f64; 2],
    /// Width and height of all that is looked up in any frame, in pixels: the image, and what lies
    /// beyond its edges if motion brings it in.
    pub region: [f64; 2],
    /// The speckle size `h = λ d / D` on the sensor, in pixels.
    pub speckle_size: f64,
    /// The largest motion of the pupil over the speckle, in its diameters, or `None` if the speckle
    /// never changes.
    pub motion: Option<f64>,
    /// The number of frames among which the speckle is compared.
    pub frames: u32,
    /// The bytes that the slices may take.
    pub memory_limit: u64,
}

/// Sizes of a stack that repeats nothing where it is looked up and takes no more memory than that
/// needs.
///
/// - The diameter of the pupil field is at least the region in speckles, along each axis, for the
///   pattern repeats after so many: `C ≥ region / speckle_size`. It is rounded up to the next
///   multiple of 8 without prime factors above 5, and is at least 32. If that takes too much
///   memory, or more than a pattern can hold, the image alone repeats nothing.
/// - The pattern has twice that size, `Q = 2 C`: the intensity's Nyquist limit.
/// - The slices lie on a straight path. For two frames it is two diameters long: what has left the
///   pupil is new, wherever it is looked up. More frames ask for a path that ends clear of its
///   start.
/// - Their number is the largest of 32, 16, 8 or 4 per diameter that fits the memory. Blended
///   look-ups exceed the correlation law by up to 0.04, 0.08, 0.14 or 0.23.
///
/// What does not fit so is shortened: a path that is too short for the motion gives speckle of some
/// late frames to others, which [`holds_motion`](Self::holds_motion) tells.
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

/// Slices per pupil diameter that are tried, the best first.
const SLICES_PER_DIAMETER: [usize; 4] = [32, 16, 8, 4];

/// The longest path that is tried, in pupil diameters: with the fewest slices it has the largest
/// period.
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
    /// motion negative or not finite, if the image holds more speckles than the largest pattern, or
    /// if not even the smallest stack fits the memory.
    pub fn new(needs: &StackNeeds) -> Result<Self, SpeckleError> {
        Self::first_within(Self::candidates(needs)?, needs.memory_limit)
    }

    /// Creates the plan of known sizes: of the pattern in samples, of the pupil in lattice points
    /// along each axis, and of the path.
    ///
    /// [`field`](Self::field) returns an error if a pattern cannot have them.
    pub const fn from_sizes(size: [usize; 2], diameter: [usize; 2], path: SlicePath) -> Self {
        Self {
            diameter,
            size,
            path,
        }
    }

    /// Returns the plans for `needs` in the order of their worth, whatever memory they take: all
    /// that is asked for with fewer and fewer slices, then for the image alone, then on a shorter
    /// path.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new), the memory aside.
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
    /// Returns an error if there is none: that of the sizes, if a plan fits the memory.
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

    /// Returns the largest motions to either side of the reference that the slices tell apart, in
    /// pupil diameters, for motions of which the largest are `shifts`: where both sides move, each
    /// gets its part of the [reach](Self::reach).
    pub fn reaches(&self, shifts: [f64; 2]) -> [f64; 2] {
        let [before, after] = shifts;
        if before == 0.0 || after == 0.0 {
            return [self.reach(); 2];
        }
        shifts.map(|part| self.reach() * part / (before + after))
    }

    /// Returns the place in a stack of pattern `number` of several that share it, in periods along
    /// x and y: the points of the sequence of Roberts (2018), far apart from each other. The first
    /// is at the origin.
    pub fn place(number: usize) -> [f64; 2] {
        /// The plastic ratio: the root of x³ = x + 1.
        const PLASTIC: f64 = 1.324_717_957_244_746;
        let number = number as f64;
        [PLASTIC, PLASTIC * PLASTIC].map(|step| (number / step).fract())
    }

    /// Returns whether a pupil diameter has the 16 slices from which a stack of one's own is worth
    /// more than a place in one with more slices: the blend between fewer exceeds the correlation
    /// law by up to 0.11.
    pub fn blends_closely(&self) -> bool {
        self.slices_per_diameter() >= 16.0
    }

    /// Returns whether the pattern repeats nothing within the region.
    pub fn holds_region(&self, needs: &StackNeeds) -> bool {
        (0..2).all(|axis| self.diameter[axis] as f64 >= needs.region[axis] / needs.speckle_size)
    }

    /// Returns whether each frame has the speckle of its own motion. With two frames it always has:
    /// speckle beyond the reach is new.
    pub fn holds_motion(&self, needs: &StackNeeds) -> bool {
        needs.frames <= 2 || needs.motion.is_none_or(|motion| motion <= self.reach())
    }

    /// Returns the pupil field of this plan, with the phasors of `seed`.
    ///
    /// # Errors
    ///
    /// Returns an error if its sizes are out of range; those that [`new`](Self::new) chooses never
    /// are.
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
    /// As [`field`](Self::field) and [`SpeckleStack::generate_with`].
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

    /// Returns plans of one slice, for the region and for the image.
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
/// that Fourier transforms like.
fn diameter_for(speckles: f64) -> usize {
    // What is too large is refused by the pupil field.
    let smallest = to_usize(speckles.ceil()).max(SMALLEST_DIAMETER);
    let multiples = smallest.div_ceil(8)..=PupilField::MAX_SIZE / 8;
    multiples
        .map(|multiple| 8 * multiple)
        .find(|&diameter| is_smooth(diameter))
        .unwrap_or(smallest)
}

fn is_smooth(mut number: usize) -> bool {
    for prime in [2, 3, 5] {
        while number.is_multiple_of(prime) {
            number /= prime;
        }
    }
    number == 1
}

/// The length of a straight path, in pupil diameters, that ends clear of its start after a motion
/// of `motion` diameters.
fn length_for(motion: f64) -> usize {
    to_usize((1.0 + motion).ceil()).clamp(2, LONGEST_PATH)
}

#[cfg(test)]
mod tests;
