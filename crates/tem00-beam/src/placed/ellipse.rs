//! Ellipses as symmetric positive matrices, and what the normal distribution needs of them.

use core::f64::consts::FRAC_2_PI;

use crate::real::Real;

/// The ellipse `xᵀ M⁻¹ x = 1` as its matrix M of squared radii: four times a covariance.
///
/// A circle of radius w is `xx = yy = w²`, `xy = 0`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipse<T> {
    /// Squared half-width along x.
    pub xx: T,
    /// Mixed term, between −√(xx yy) and √(xx yy).
    pub xy: T,
    /// Squared half-width along y.
    pub yy: T,
    /// Unused, 0. Completes a row of four.
    pub pad: T,
}

impl<T: Real> Ellipse<T> {
    #[inline(always)]
    pub(super) fn new(xx: T, xy: T, yy: T) -> Self {
        Self {
            xx,
            xy,
            yy,
            pad: T::ZERO,
        }
    }

    pub(super) fn to_row(self) -> [T; 4] {
        [self.xx, self.xy, self.yy, self.pad]
    }

    pub(super) fn from_row([xx, xy, yy, pad]: [T; 4]) -> Self {
        Self { xx, xy, yy, pad }
    }

    #[inline(always)]
    pub(super) fn determinant(&self) -> T {
        self.xx * self.yy - self.xy * self.xy
    }

    pub(super) fn inverse(&self) -> Self {
        let det = self.determinant();
        Self::new(self.yy / det, -self.xy / det, self.xx / det)
    }

    /// Returns `tr(adj(A) B)`, the part of `det(A + B)` that is neither det A nor det B.
    #[inline(always)]
    pub(super) fn mixed_determinant(&self, other: &Self) -> T {
        self.yy * other.xx - T::of(2.0) * (self.xy * other.xy) + self.xx * other.yy
    }

    #[inline(always)]
    pub(super) fn plus(&self, other: &Self) -> Self {
        Self::new(self.xx + other.xx, self.xy + other.xy, self.yy + other.yy)
    }

    /// Returns `A M Aᵀ`.
    #[inline(always)]
    pub(super) fn mapped(&self, a: [[T; 2]; 2]) -> Self {
        let [p, q] = self.times_transposed(a);
        Self::new(
            a[0][0] * p[0] + a[0][1] * q[0],
            a[0][0] * p[1] + a[0][1] * q[1],
            a[1][0] * p[1] + a[1][1] * q[1],
        )
    }

    /// Returns `M Aᵀ`, in rows.
    #[inline(always)]
    pub(super) fn times_transposed(&self, a: [[T; 2]; 2]) -> [[T; 2]; 2] {
        [
            [
                self.xx * a[0][0] + self.xy * a[0][1],
                self.xx * a[1][0] + self.xy * a[1][1],
            ],
            [
                self.xy * a[0][0] + self.yy * a[0][1],
                self.xy * a[1][0] + self.yy * a[1][1],
            ],
        ]
    }

    /// Returns the largest squared radius.
    pub(super) fn largest(&self) -> T {
        let half = T::of(0.5);
        let [mean, difference] = [half * (self.xx + self.yy), half * (self.xx - self.yy)];
        mean + (difference * difference + self.xy * self.xy).sqrt()
    }

    pub(super) fn factors(&self) -> Factors<T> {
        self.factors_with(self.determinant())
    }

    /// Factors the matrix whose determinant is known more accurately than from its elements.
    #[inline(always)]
    pub(super) fn factors_with(&self, determinant: T) -> Factors<T> {
        Factors {
            x: self.xx,
            y: determinant / self.xx,
            tilt: self.xy / self.xx,
        }
    }
}

/// The factors of a matrix of squared radii: `M = L diag(x, y) Lᵀ` with `L = ((1, 0), (tilt, 1))`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Factors<T> {
    pub(super) x: T,
    pub(super) y: T,
    tilt: T,
}

impl<T: Real> Factors<T> {
    /// Returns `√det M`.
    #[inline(always)]
    pub(super) fn root_determinant(&self) -> T {
        self.x.sqrt() * self.y.sqrt()
    }

    /// Returns `vᵀ M⁻¹ v`.
    #[inline(always)]
    pub(super) fn norm_sq(&self, v: [T; 2]) -> T {
        let across = v[1] - self.tilt * v[0];
        v[0] * v[0] / self.x + across * across / self.y
    }

    /// Returns `vᵀ M v`.
    pub(super) fn norm_sq_inverse(&self, v: [T; 2]) -> T {
        let along = v[0] + self.tilt * v[1];
        self.x * along * along + self.y * v[1] * v[1]
    }

    /// Returns the diagonal of `M⁻¹`.
    pub(super) fn inverse_diagonal(&self) -> [T; 2] {
        [
            T::ONE / self.x + self.tilt * self.tilt / self.y,
            T::ONE / self.y,
        ]
    }

    /// Returns `M⁻¹ v`.
    #[inline(always)]
    pub(super) fn solve(&self, v: [T; 2]) -> [T; 2] {
        let y = (v[1] - self.tilt * v[0]) / self.y;
        [v[0] / self.x - self.tilt * y, y]
    }

    /// Returns the density at `v` of a normal distribution with the covariance M/4.
    #[inline(always)]
    pub(super) fn density(&self, v: [T; 2]) -> T {
        let peak = T::of(FRAC_2_PI) / self.root_determinant();
        peak * (T::of(-2.0) * self.norm_sq(v)).exp()
    }

    /// Turns two standard normal variates into a vector with the covariance M/4.
    pub(super) fn spread(&self, normals: [T; 2]) -> [T; 2] {
        let half = T::of(0.5);
        let x = half * self.x.sqrt() * normals[0];
        [x, self.tilt * x + half * self.y.sqrt() * normals[1]]
    }

    /// Turns two standard normal variates into a vector with the covariance M⁻¹/4.
    pub(super) fn spread_inverse(&self, normals: [T; 2]) -> [T; 2] {
        let half = T::of(0.5);
        let y = half * normals[1] / self.y.sqrt();
        [half * normals[0] / self.x.sqrt() - self.tilt * y, y]
    }
}
