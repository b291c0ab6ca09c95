"""The laws of a laser line, as Dr.Jit expressions."""

from __future__ import annotations

from math import pi, sqrt
from typing import TYPE_CHECKING, NamedTuple

import drjit as dr

from tem00.mitsuba.frame import Flow, Pair, secant
from tem00.mitsuba.normal import standard_normal
from tem00.mitsuba.profile import Profile
from tem00.mitsuba.spot import Axis

if TYPE_CHECKING:
    import mitsuba as mi
    from drjit.auto.ad import Float


class Line(NamedTuple):
    """A laser line: a beam, fanned out along x from a virtual apex behind the lens.

    ``across`` is the beam radius across the fan, on the slant distance from the apex; with
    ``focus_on_plane`` its waists lie on a plane square to the axis. ``source_radius`` is the radius
    of the apex.
    """

    across: Axis
    profile: Profile
    cutoff: Float
    apex_offset: Float
    source_radius: Float
    focus_on_plane: bool

    def flow(self, x: Float, y: Float, z: Float) -> Flow:
        """Return the energy flow for one watt."""
        in_front = z >= 0.0
        depth = dr.select(in_front, z, 0.0) + self.apex_offset
        u = x / depth
        sec = secant(u)
        axis = self._axis_towards(sec)
        w_sq = axis.radius_sq_at(depth * sec)
        t_sq = y * y / w_sq
        lit = in_front & self.profile.reaches(u, self.cutoff) & (t_sq <= self.cutoff * self.cutoff)
        # Dark points count as points on the axis, so that no derivative is 0 times infinity.
        across = sqrt(2.0 / pi) / dr.sqrt(w_sq) * dr.exp(-2.0 * dr.select(lit, t_sq, 0.0))
        irradiance = self.profile.per_slope(dr.select(lit, u, 0.0)) / depth * across
        slope_y = dr.select(lit, y, 0.0) * axis.growth_at(depth * sec) * sec
        return Flow(dr.select(lit, irradiance, 0.0), (dr.select(lit, u, 0.0), slope_y))

    def draw(self, u_position: mi.Point2f, u_slope: mi.Point2f) -> tuple[Pair, Pair]:
        """Draw a point of the aperture plane and a slope.

        The ray has the slope ``u`` in the fan plane, passes the apex at the distance ``b``, and has
        the slope ``s`` per slant distance across the fan.
        """
        u = self.profile.quantile(u_slope.x)
        b = 0.5 * self.source_radius * standard_normal(u_position.x)
        sec = secant(u)
        along = self.apex_offset * sec + b * u
        from_apex = self._axis_towards(sec)
        # The axis draws where the ray crosses the apex's distance; it is `along` farther here.
        y, s = from_apex.draw(u_position.y, u_slope.y)
        return (self.apex_offset * u + b * sec, y + s * along), (u, s * sec)

    def _axis_towards(self, sec: Float) -> Axis:
        """Return the beam radius across the fan along the rays whose angle has this secant."""
        if self.focus_on_plane:
            return self.across._replace(z0=self.across.z0 * sec)
        return self.across
