"""The properties of a ``laser`` in a scene, read and named in errors."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import mitsuba as mi

from tem00 import ParameterError
from tem00.coherence import Spectrum

SHAPES = ("spot", "line")
FOCUS_CURVES = ("distance", "plane")
# Metres per unit of length.
UNITS = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6}
SPECTRA = ("gaussian", "lorentzian", "rectangular", "comb")
PROFILES = ("gaussian", "gaussian_angle", "gaussian_sin", "uniform", "uniform_angle", "powell")

_COMMON = ("wavelength", "power")
# What passes for the wavelength of a laser, in metres.
_WAVELENGTHS = (1e-9, 1e-3)
_REQUIRED = {
    "spot": (*_COMMON, "waist_radius"),
    "line": (*_COMMON, "fan_angle", "thickness", "focus_distance"),
}
_OPTIONAL = {
    "spot": (
        "waist_distance",
        "m_squared",
        "waist_radius_y",
        "waist_distance_y",
        "m_squared_y",
    ),
    "line": ("apex_offset", "edge", "m_squared"),
}
_MOST_LINES = 256
# The most that the law of extended sources allows is 0.3 rad.
_MOST_HALF_ANGLE = 17.0
_SPECTRUM = ("linewidth", "lines", "source_half_angle")
_CHOICES: dict[str, dict[str, tuple[str, ...]]] = {
    "spot": {"spectrum": SPECTRA},
    "line": {"spectrum": SPECTRA, "focus_curve": FOCUS_CURVES, "profile": PROFILES},
}
_DEFAULTS = {
    "spot": {"waist_distance": 0.0, "m_squared": 1.0},
    "line": {"m_squared": 1.0},
}


def refused(name: str, why: str, plugin: str = "laser") -> ParameterError:
    """Return the exception that refuses the property ``name``."""
    error = ParameterError(f"{plugin}: {name}: {why}")
    error.parameter = name
    return error


@dataclass
class Description:
    """Description of the beam of a laser in a scene.

    ``numbers`` are the properties that are numbers, in the units of the scene and in degrees, and
    ``choices`` those that are words. Properties that follow from others are absent unless given.
    ``unit`` is the scene's unit of length.
    """

    shape: str
    numbers: dict[str, float]
    choices: dict[str, str]
    unit: str

    @property
    def per_square_metre(self) -> float:
        """The factor from watts per squared unit of length to watts per square metre."""
        return UNITS[self.unit] ** -2


def read(props: mi.Properties) -> Description:
    """Read all properties of the beam; every other name is an error."""
    shape = choice(props, "shape", SHAPES)
    known = (*_REQUIRED[shape], *_OPTIONAL[shape], *_SPECTRUM)
    for name in _REQUIRED[shape]:
        if name not in props:
            raise refused(name, f"required for the shape {shape!r}")
    numbers = dict(_DEFAULTS[shape])
    numbers.update({name: _number(props, name) for name in known if name in props})
    choices = {name: choice(props, name, words) for name, words in _CHOICES[shape].items()}
    if "edge" in numbers and choices["profile"] != "powell":
        raise refused("edge", "belongs to the profile 'powell'")
    if choices.get("profile") == "powell":
        numbers.setdefault("edge", 0.05)
    if "lines" in numbers and choices["spectrum"] != "comb":
        raise refused("lines", "belongs to the spectrum 'comb'")
    return Description(shape, numbers, choices, _unit(props, numbers["wavelength"]))


def laser_spectrum(description: Description) -> Spectrum | None:
    """Return the spectrum in the scene's unit; None is light of one wavelength from a point."""
    numbers = description.numbers
    wavelength, linewidth = numbers["wavelength"], numbers.get("linewidth", 0.0)
    spectrum = description.choices["spectrum"]
    half_angle = numbers.get("source_half_angle", 0.0)
    if not 0.0 <= half_angle <= _MOST_HALF_ANGLE:
        raise refused(
            "source_half_angle",
            f"must be from 0 to {_MOST_HALF_ANGLE:g} degrees, got {half_angle:g}",
        )
    try:
        if spectrum == "comb":
            count = numbers.get("lines", 0.0)
            if count != int(count) or not 1 <= count <= _MOST_LINES:
                raise refused(
                    "lines", f"must be a whole number from 1 to {_MOST_LINES}, got {count:g}"
                )
            return Spectrum.comb(wavelength, linewidth, int(count))
        if linewidth == half_angle == 0.0:
            return None
        make = Spectrum if spectrum == "gaussian" else getattr(Spectrum, spectrum)
        line: Spectrum = make(wavelength, linewidth)
    except ParameterError as error:
        raise refused("linewidth", str(error)) from error
    return line


def _unit(props: mi.Properties, wavelength: float) -> str:
    """Read the unit of length, in which the wavelength must be that of light."""
    if "unit" not in props:
        # Whoever keeps to a unit of their own gets light per area of that unit.
        return "m"
    unit = choice(props, "unit", tuple(UNITS))
    metres = wavelength * UNITS[unit]
    low, high = _WAVELENGTHS
    if metres > 0.0 and not low <= metres <= high:
        why = f"must lie between {low:g} and {high:g} m, got {wavelength:g} {unit}"
        raise refused("wavelength", f"{why}: all lengths are in the unit of the scene")
    return unit


def read_color(props: mi.Properties) -> tuple[float, float, float]:
    """Read the colour that multiplies the light, white by default."""
    color: Any = props.get("color", None)
    if color is None:
        return 1.0, 1.0, 1.0
    try:
        red, green, blue = (float(channel) for channel in color)
    except (TypeError, ValueError):
        raise refused("color", f"must be an rgb value, got {color}") from None
    return red, green, blue


def read_to_world(props: mi.Properties) -> mi.AffineTransform4f:
    """Read the transform from the light's frame to the world, the identity by default."""
    to_world: Any = props.get("to_world", mi.ScalarAffineTransform4f())
    return mi.AffineTransform4f(to_world.matrix)


def refuse_unknown(props: mi.Properties, shape: str) -> None:
    """Refuse properties that nobody asked for."""
    unknown = [name for name in props.unqueried() if name != "sampling_weight"]
    if unknown:
        own = (*_REQUIRED[shape], *_OPTIONAL[shape], *_SPECTRUM, *_CHOICES[shape])
        known = (*own, "color", "to_world", "unit")
        names = ", ".join(sorted(known))
        raise refused(unknown[0], f"no property of the shape {shape!r}; those are {names}")


def _number(props: mi.Properties, name: str) -> float:
    value = props[name]
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise refused(name, f"must be a number, got {value!r}")
    return float(value)


def choice(props: mi.Properties, name: str, words: tuple[str, ...]) -> str:
    """Read a word; the first one is the default."""
    value = props.get(name, words[0])
    if value not in words:
        listed = ", ".join(repr(word) for word in words)
        raise refused(name, f"must be one of {listed}, got {value!r}", props.plugin_name())
    return str(value)
