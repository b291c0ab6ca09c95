"""The properties of the integrator ``speckle``, read and named in errors."""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import partial
from math import isfinite
from typing import TYPE_CHECKING

from tem00.mitsuba import properties
from tem00.mitsuba.properties import choice

if TYPE_CHECKING:
    import mitsuba as mi

PATHS = ("still", "straight", "circle")
TABLES = ("auto", "intensity", "amplitude")
_LARGEST_SEED = 2**63 - 1
_LARGEST_SIDE = 2**15
_SMALLEST_DIAMETER = 8
_MEBIBYTE = 2**20

# The exception that refuses a property.
refused = partial(properties.refused, plugin="speckle")


@dataclass(frozen=True)
class PatternSettings:
    """Settings of the patterns; see the documentation of the integrator for the properties."""

    speckle_size: float | None
    seed: int
    pattern_size: int | None
    pattern_diameter: int | None
    path: str
    half_period: int
    length: int
    memory: int
    table: str

    @property
    def memory_bytes(self) -> int:
        """Memory of the patterns of all lasers, and as much again for their tables."""
        return self.memory * _MEBIBYTE

    @classmethod
    def read(cls, props: mi.Properties) -> PatternSettings:
        """Read the properties."""
        return cls(
            speckle_size=_speckle_size(props),
            seed=whole(props, "seed", 0, (0, _LARGEST_SEED)),
            pattern_size=_side(props, "pattern_size", 2 * _SMALLEST_DIAMETER),
            pattern_diameter=_side(props, "pattern_diameter", _SMALLEST_DIAMETER),
            path=choice(props, "path", PATHS),
            half_period=whole(props, "half_period", 64, (1, _LARGEST_SIDE)),
            length=whole(props, "length", 2, (1, _LARGEST_SIDE)),
            memory=whole(props, "memory", 1024, (1, 2**20)),
            table=choice(props, "table", TABLES),
        )


def whole(props: mi.Properties, name: str, default: int, allowed: tuple[int, int]) -> int:
    """Read a whole number."""
    value = props.get(name, default)
    low, high = allowed
    if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
        raise refused(name, f"must be a whole number from {low} to {high}, got {value!r}")
    return value


def number(props: mi.Properties, name: str, default: float) -> float:
    """Read a finite number."""
    value = props.get(name, default)
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not isfinite(value):
        raise refused(name, f"must be a finite number, got {value!r}")
    return float(value)


def flag(props: mi.Properties, name: str, default: bool) -> bool:
    """Read a truth value."""
    value = props.get(name, default)
    if not isinstance(value, bool):
        raise refused(name, f"must be true or false, got {value!r}")
    return value


def refuse_unknown(props: mi.Properties) -> None:
    """Refuse properties that nobody asked for."""
    unknown = props.unqueried()
    if unknown:
        names = (
            "max_depth, rr_depth, hide_emitters, speckle, "
            "pupil_shift, shift_x, shift_y, patterns, polarisation, rms_height, "
            "correlation_length (also of one shape, as `id:patterns`)"
        )
        known = ", ".join([names, *(field.name for field in fields(PatternSettings))])
        raise refused(unknown[0], f"no property of this integrator; those are {known}")


def _speckle_size(props: mi.Properties) -> float | None:
    if "speckle_size" not in props:
        return None
    size = number(props, "speckle_size", 0.0)
    if size <= 0.0:
        raise refused("speckle_size", f"must be positive (in pixels), got {size:g}")
    return size


def _side(props: mi.Properties, name: str, smallest: int) -> int | None:
    largest = smallest * (_LARGEST_SIDE // (2 * _SMALLEST_DIAMETER))
    return whole(props, name, 0, (smallest, largest)) if name in props else None
