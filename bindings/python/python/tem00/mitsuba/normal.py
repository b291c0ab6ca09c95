"""The normal distribution and the complementary error function, as Dr.Jit expressions."""

from __future__ import annotations

from math import pi, sqrt
from typing import TYPE_CHECKING

import drjit as dr

if TYPE_CHECKING:
    from drjit.auto.ad import Float

# Half the spacing of the uniform variates that samplers give in single precision.
_HALF_SPACING = 2.0**-25


def normal_density(x: Float, sigma: Float) -> Float:
    """Return the density of a normal variate of mean 0."""
    t = x / sigma
    return dr.exp(-0.5 * t * t) / (sqrt(2.0 * pi) * sigma)


def interior(u: Float) -> Float:
    """Move a uniform variate of [0, 1) off the ends."""
    return dr.clip(u, _HALF_SPACING, 1.0 - 2.0 * _HALF_SPACING)


def standard_normal(u: Float) -> Float:
    """Return the standard normal variate below which the fraction ``u`` lies."""
    return sqrt(2.0) * dr.erfinv(2.0 * interior(u) - 1.0)


def erfc(x: Float) -> Float:
    """Return the complementary error function, with a relative error below ``4e-7 (1 + x**2)``.

    For x >= 0 it is ``exp(-x**2) t p(t)`` with ``t = 1 / (1 + 0.3 x)``. The polynomial p
    interpolates ``exp(x**2) erfc(x) / t`` at the nine Chebyshev nodes of 1/4 <= t <= 1, which is
    10 >= x >= 0. Beyond, erfc is 0 in single precision.
    """
    t = 1.0 / (1.0 + 0.3 * dr.abs(x))
    low = 0.1691730577 + t * (0.1709491199 + t * (0.1467960222 + t * 0.2205391691))
    high = -0.1069833625 + t * (
        0.5645142422 + t * (-0.5261516628 + t * (0.4919342706 - t * 0.1307708773))
    )
    tail = t * (low + t * t * t * t * high) * dr.exp(-x * x)
    return dr.select(x < 0.0, 2.0 - tail, tail)
