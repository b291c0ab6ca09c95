"""From properties to laws: the beam is checked and prepared by ``tem00.beam``, once."""

from __future__ import annotations

from contextlib import contextmanager
from math import radians, tan
from typing import TYPE_CHECKING, Literal, cast

import drjit as dr
import mitsuba as mi
import numpy as np

from tem00 import ParameterError, beam
from tem00.mitsuba.frame import Frame, Law
from tem00.mitsuba.line import Line
from tem00.mitsuba.profile import Angle, Density, Normal, Profile, RolledOff, Sin, Tan, Uniform
from tem00.mitsuba.properties import Description, refused
from tem00.mitsuba.spot import Axis, Spot

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from drjit.auto.ad import Float
    from numpy.typing import NDArray

_FOCUS_CURVES: dict[str, Literal["equal_distance", "equal_plane"]] = {
    "distance": "equal_distance",
    "plane": "equal_plane",
}
_PROFILES = {
    "gaussian": beam.LineProfile.gaussian_tan,
    "gaussian_angle": beam.LineProfile.gaussian_angle,
    "gaussian_sin": beam.LineProfile.gaussian_sin,
    "uniform": beam.LineProfile.uniform_tan,
    "uniform_angle": beam.LineProfile.uniform_angle,
}
_VARIABLES = (Tan(), Angle(), Sin())
# The frame of a scene applies the position; here the light stands at the origin.
_AT_THE_ORIGIN = beam.Placement(
    origin=(0.0, 0.0, 0.0), direction=(0.0, 0.0, 1.0), fan_axis=(1.0, 0.0, 0.0)
)
# Lets the rounding of chains of transforms in single precision pass, and no scaling that is meant.
_RIGID_TOLERANCE = 1e-4


def place(description: Description) -> Law:
    """Return the laws of the described light, its constants rounded to single precision.

    Raises
    ------
    tem00.ParameterError
        If ``tem00.beam`` refuses the beam; the exception names the property.
    """
    if description.shape == "spot":
        return _spot(description.numbers)
    return _line(description)


def frame_of(to_world: mi.AffineTransform4f) -> Frame:
    """Return the frame of a light, with gradients to the transform.

    Raises
    ------
    tem00.ParameterError
        If the transform scales or shears, or is not finite.
    """
    matrix = np.array(dr.detach(to_world.matrix), dtype=np.float64).reshape(4, 4)
    rotation = matrix[:3, :3]
    excess = np.abs(rotation.T @ rotation - np.eye(3)).max()
    if not (excess <= _RIGID_TOLERANCE and np.isfinite(matrix).all()):
        raise refused("to_world", f"must only rotate and translate, got {matrix.tolist()}")
    origin = mi.Point3f(to_world.translation())
    axes = [dr.normalize(to_world @ mi.Vector3f(*unit)) for unit in np.eye(3).tolist()]
    # Read from memory, so that a laser that moves compiles nothing anew.
    dr.make_opaque(origin, *axes)
    return Frame(origin, *axes)


def _spot(numbers: Mapping[str, float]) -> Spot:
    axes = _located(numbers, ""), _located(numbers, "_y")
    with _named({}):
        light = beam.Light.elliptic(
            beam.AstigmaticBeam(*axes), _AT_THE_ORIGIN, numbers["power"]
        )
        rows = light.to_rows()
    return Spot(x=_axis(rows[4]), y=_axis(rows[5]), cutoff=opaque(rows[1][3]))


def _located(numbers: Mapping[str, float], suffix: str) -> beam.LocatedBeam:
    """Return the beam along one axis; what is not given is that of the first."""
    names = ("waist_radius", "m_squared", "waist_distance")
    waist_radius, m_squared, waist_distance = (
        numbers.get(name + suffix, numbers[name]) for name in names
    )
    with _named({name: name + suffix for name in names}):
        focus = _focus(numbers["wavelength"], waist_radius, m_squared)
        return beam.LocatedBeam(focus, waist_distance)


def _focus(wavelength: float, waist_radius: float, m_squared: float) -> beam.GaussianBeam:
    """Return a beam whose lengths are in the unit of the scene, which need not be metres."""
    focus: beam.GaussianBeam = beam.GaussianBeam._restored(  # type: ignore[attr-defined]
        wavelength, waist_radius, m_squared
    )
    return focus


def _line(description: Description) -> Line:
    numbers = description.numbers
    # The waist radius is half the thickness; messages say which value they speak of.
    with _named({"waist_radius": "thickness"}):
        focus = _focus(numbers["wavelength"], 0.5 * numbers["thickness"], numbers["m_squared"])
    fan = _fan(description, focus)
    with _named({}):
        line = beam.LaserLine(focus, fan, _profile(description))
        rows = beam.Light.line(line, _AT_THE_ORIGIN, numbers["power"]).to_rows()
    return Line(
        across=_axis(rows[4]),
        profile=_slope_profile(rows[5]),
        cutoff=opaque(rows[1][3]),
        apex_offset=opaque(rows[2][3]),
        source_radius=opaque(rows[3][3]),
        focus_on_plane=fan.focus_curve == "equal_plane",
    )


def _fan(description: Description, focus: beam.GaussianBeam) -> beam.FanGeometry:
    numbers = description.numbers
    degrees, focus_distance = numbers["fan_angle"], numbers["focus_distance"]
    if not 0.0 < degrees < 180.0:
        raise refused("fan_angle", f"must lie between 0 and 180 degrees, got {degrees}")
    apex_offset = numbers.get("apex_offset")
    if apex_offset is None:
        # A lens that receives a round beam fans it out from a point where it would be this wide.
        with _named({"z": "focus_distance"}):
            apex_offset = focus.radius_at(focus_distance) / tan(0.5 * radians(degrees))
    return beam.FanGeometry(
        fan_angle=radians(degrees),
        apex_offset=apex_offset,
        focus_distance=focus_distance,
        focus_curve=_FOCUS_CURVES[description.choices["focus_curve"]],
    )


def _profile(description: Description) -> beam.LineProfile:
    name = description.choices["profile"]
    if name == "powell":
        return beam.LineProfile.powell(edge=description.numbers["edge"])
    return _PROFILES[name]()


def _slope_profile(row: NDArray[np.float32]) -> Profile:
    flat, sigma, variable, mass = row
    density: Density
    if flat == 0.0:
        density = Normal(opaque(sigma))
    elif sigma == 0.0:
        density = Uniform(opaque(flat))
    else:
        density = RolledOff(opaque(flat), opaque(sigma))
    return Profile(_VARIABLES[round(variable)], density, opaque(mass))


def _axis(row: NDArray[np.float32]) -> Axis:
    return Axis(*(opaque(value) for value in row[:3]))


def opaque(value: float) -> Float:
    """Return a number that kernels read from memory, so that a change compiles nothing anew."""
    return cast("Float", dr.opaque(mi.Float, float(value)))


@contextmanager
def _named(names: Mapping[str, str]) -> Iterator[None]:
    """Let refusals of the library name the property in place of the argument."""
    try:
        yield
    except ParameterError as error:
        name = names.get(error.parameter, error.parameter)
        raise refused(name, str(error)) from None
