"""The laws of a Gaussian beam, circular or elliptic, as Dr.Jit expressions."""

from __future__ import annotations

from math import pi
from typing import TYPE_CHECKING, NamedTuple

import drjit as dr

from tem00.mitsuba.frame import Flow, Pair
from tem00.mitsuba.normal import standard_normal

if TYPE_CHECKING:
    import mitsuba as mi
    from drjit.auto.ad import Float


class Axis(NamedTuple):
    """The beam radius along one axis: ``w(z)**2 = w0_sq + theta_sq * (z - z0)**2``.

    The sum is kept in this form: multiplied out into powers of z it loses all digits of single
    precision near a tight waist.
    """

    w0_sq: Float
    theta_sq: Float
    z0: Float

    def radius_sq_at(self, z: Float) -> Float:
        """Return the squared beam radius."""
        dz = z - self.z0
        return self.w0_sq + self.theta_sq * dz * dz

    def growth_at(self, z: Float) -> Float:
        """Return the relative growth of the radius with z."""
        return self.theta_sq * (z - self.z0) / self.radius_sq_at(z)

    def draw(self, u_waist: Float, u_slope: Float) -> Pair:
        """Draw the position on the plane z = 0 and the slope of a ray."""
        slope = 0.5 * dr.sqrt(self.theta_sq) * standard_normal(u_slope)
        waist = 0.5 * dr.sqrt(self.w0_sq) * standard_normal(u_waist)
        return waist - slope * self.z0, slope


class Spot(NamedTuple):
    """A Gaussian beam with its waists at ``z = x.z0`` and ``z = y.z0``, dark beyond the cut-off."""

    x: Axis
    y: Axis
    cutoff: Float

    def flow(self, x: Float, y: Float, z: Float) -> Flow:
        """Return the energy flow for one watt."""
        wx_sq, wy_sq = self.x.radius_sq_at(z), self.y.radius_sq_at(z)
        rho_sq = x * x / wx_sq + y * y / wy_sq
        lit = (z >= 0.0) & (rho_sq <= self.cutoff * self.cutoff)
        peak = (2.0 / pi) / (dr.sqrt(wx_sq) * dr.sqrt(wy_sq))
        # Dark points count as points on the axis, so that no derivative is 0 times infinity.
        irradiance = peak * dr.exp(-2.0 * dr.select(lit, rho_sq, 0.0))
        slope_x = dr.select(lit, x, 0.0) * self.x.growth_at(z)
        slope_y = dr.select(lit, y, 0.0) * self.y.growth_at(z)
        return Flow(dr.select(lit, irradiance, 0.0), (slope_x, slope_y))

    def draw(self, u_position: mi.Point2f, u_slope: mi.Point2f) -> tuple[Pair, Pair]:
        """Draw a point of the aperture plane and a slope."""
        x, slope_x = self.x.draw(u_position.x, u_slope.x)
        y, slope_y = self.y.draw(u_position.y, u_slope.y)
        return (x, y), (slope_x, slope_y)
