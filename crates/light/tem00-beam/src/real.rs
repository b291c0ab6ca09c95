mod exponential;

/// A floating-point type of the renderer face: `f32` or `f64`.
///
/// The trait is sealed.
pub trait Real: sealed::Scalar {}

impl Real for f32 {}
impl Real for f64 {}

pub(crate) mod sealed {
    use core::fmt::Debug;
    use core::ops::{Add, Div, Mul, Neg, Sub};

    use crate::real::exponential::{exp_f32, exp_f64};

    /// The operations a placed light needs of its scalar.
    #[expect(unnameable_types, reason = "it seals `Real`")]
    pub trait Scalar:
        Copy
        + Debug
        + PartialEq
        + PartialOrd
        + Send
        + Sync
        + Add<Output = Self>
        + Sub<Output = Self>
        + Mul<Output = Self>
        + Div<Output = Self>
        + Neg<Output = Self>
        + 'static
    {
        const ZERO: Self;
        const ONE: Self;
        /// Half the spacing of uniform variates in [0, 1) of this type.
        const HALF_SPACING: f64;
        /// Rounds a double-precision number.
        fn of(x: f64) -> Self;
        /// Widens to double precision, without loss.
        fn wide(self) -> f64;
        fn sqrt(self) -> Self;
        /// Returns the exponential, within 1.5 units of the last place; 0 where it is hardly normal.
        fn exp(self) -> Self;
        fn abs(self) -> Self;
        /// Returns `other` if it is smaller.
        #[inline(always)]
        fn smaller(self, other: Self) -> Self {
            if other < self { other } else { self }
        }
        /// Returns `other` if it is larger.
        #[inline(always)]
        fn larger(self, other: Self) -> Self {
            if other > self { other } else { self }
        }
        /// Returns the number itself if `condition` holds, and 0 if not.
        #[inline(always)]
        fn only_if(self, condition: bool) -> Self {
            if condition { self } else { Self::ZERO }
        }
    }

    impl Scalar for f32 {
        const ZERO: Self = 0.0;
        const ONE: Self = 1.0;
        const HALF_SPACING: f64 = (Self::EPSILON / 4.0) as f64;

        #[expect(clippy::cast_possible_truncation, reason = "rounding is the purpose")]
        #[inline(always)]
        fn of(x: f64) -> Self {
            x as Self
        }
        #[inline(always)]
        fn wide(self) -> f64 {
            f64::from(self)
        }
        #[inline(always)]
        fn sqrt(self) -> Self {
            self.sqrt()
        }
        #[inline(always)]
        fn exp(self) -> Self {
            exp_f32(self)
        }
        #[inline(always)]
        fn abs(self) -> Self {
            self.abs()
        }
    }

    impl Scalar for f64 {
        const ZERO: Self = 0.0;
        const ONE: Self = 1.0;
        const HALF_SPACING: Self = Self::EPSILON / 4.0;

        #[inline(always)]
        fn of(x: f64) -> Self {
            x
        }
        #[inline(always)]
        fn wide(self) -> f64 {
            self
        }
        #[inline(always)]
        fn sqrt(self) -> Self {
            self.sqrt()
        }
        #[inline(always)]
        fn exp(self) -> Self {
            exp_f64(self)
        }
        #[inline(always)]
        fn abs(self) -> Self {
            self.abs()
        }
    }
}
