"""Common parts of all lights: a frame, the energy flow in it, and the rays, as Dr.Jit expressions.

The functions take and return Dr.Jit arrays of any variant and are recorded into the renderer's own
kernels; nothing here runs once per ray. The formulas are those of the light types of
``tem00.beam``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Protocol, cast

import drjit as dr
import mitsuba as mi

if TYPE_CHECKING:
    from drjit.auto.ad import Float

Pair = tuple["Float", "Float"]


class Flow(NamedTuple):
    """The energy flow ``irradiance * (slope, 1)`` in the frame of the light, for one watt."""

    irradiance: Float
    slope: Pair


class Law(Protocol):
    """The laws of a light in its own frame: +z is the direction of travel, z = 0 the aperture."""

    def flow(self, x: Float, y: Float, z: Float) -> Flow:
        """Return the energy flow, with an irradiance of 0 where no light arrives."""

    def draw(self, u_position: mi.Point2f, u_slope: mi.Point2f) -> tuple[Pair, Pair]:
        """Draw a point of the aperture plane and a slope from uniform variates."""


class Frame(NamedTuple):
    """The aperture's centre and the axes of a light, in world coordinates."""

    origin: mi.Point3f
    ex: mi.Vector3f
    ey: mi.Vector3f
    ez: mi.Vector3f

    def local_from_world(self, p: mi.Point3f) -> tuple[Float, Float, Float]:
        """Return the coordinates of a point in the frame."""
        # Subtract first, then rotate: the difference is exact where the light is near.
        d = mi.Vector3f(p - self.origin)
        return dr.dot(d, self.ex), dr.dot(d, self.ey), dr.dot(d, self.ez)

    def aperture_point(self, position: Pair) -> mi.Point3f:
        """Return a point of the aperture plane in world coordinates."""
        across = self.ex * position[0] + self.ey * position[1]
        return mi.Point3f(self.origin + mi.Point3f(across))

    def direction(self, slope: Pair) -> mi.Vector3f:
        """Return the unit vector of a slope in world coordinates."""
        return (self.ex * slope[0] + self.ey * slope[1] + self.ez) / secant(*slope)


class NextEvent(NamedTuple):
    """The light at a point as one direction, for one watt.

    ``point`` is the point of the aperture plane it seems to come from, ``distance`` the length to
    it, ``wi`` the unit vector towards it, ``e_perp`` the irradiance of a surface square to ``wi``.
    """

    point: mi.Point3f
    distance: Float
    wi: mi.Vector3f
    e_perp: Float


def next_event(law: Law, frame: Frame, p: mi.Point3f) -> NextEvent:
    """Return the light at ``p`` as one direction: that of the mean energy flow."""
    x, y, z = frame.local_from_world(p)
    irradiance, slope = law.flow(x, y, z)
    sec = secant(*slope)
    return NextEvent(
        point=frame.aperture_point((x - slope[0] * z, y - slope[1] * z)),
        distance=z * sec,
        wi=-frame.direction(slope),
        e_perp=irradiance * sec,
    )


def draw_ray(
    law: Law, frame: Frame, u_position: mi.Point2f, u_slope: mi.Point2f
) -> tuple[mi.Point3f, mi.Vector3f]:
    """Draw the origin and the direction of a ray; every ray stands for the same power."""
    position, slope = law.draw(u_position, u_slope)
    return frame.aperture_point(position), frame.direction(slope)


def secant(*slopes: Float) -> Float:
    """Return the length of a ray per distance along the axis, ``sqrt(1 + s**2 + ...)``."""
    return cast("Float", dr.sqrt(sum((slope * slope for slope in slopes), start=1.0)))
