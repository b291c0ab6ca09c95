"""The surfaces that the integrator ``speckle`` tells apart: their patterns and their motion."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import drjit as dr
import mitsuba as mi

from tem00.mitsuba.speckle_settings import number, refused, whole
from tem00.speckle import incoherent_fractions

if TYPE_CHECKING:
    from collections.abc import Callable

MOTION = ("pupil_shift", "shift_x", "shift_y")
_MIXTURE = ("patterns", "polarisation")
_RELIEF = ("rms_height", "correlation_length")
_MOST_PATTERNS = 1024


@dataclass(frozen=True)
class Surface:
    """A shape with properties of its own, or all others.

    ``prefix`` begins the names of its properties: ``"gear:"`` of the shape with the id ``gear``,
    nothing of all others. ``fractions`` are those of the light in each of its patterns. Surfaces of
    one ``motion`` share patterns. ``relief`` is the rms height finer than a resolution cell, and
    its correlation length, in the unit of the scene.
    """

    prefix: str
    fractions: tuple[float, ...]
    motion: int
    relief: tuple[float, float] = (0.0, 0.0)


def read_surfaces(props: mi.Properties) -> tuple[list[Surface], dict[str, mi.Float]]:
    """Read all surfaces, that of the other shapes first, and their motion's parameters by name."""
    names = [*MOTION, *(name for name in props.keys() if name.rpartition(":")[2] in MOTION)]
    places = {name: mi.Float(number(props, name, 0.0)) for name in dict.fromkeys(names)}
    surfaces: list[Surface] = []
    motions = 0
    for prefix in _prefixes(props):
        own = bool(prefix) and any(prefix + name in places for name in MOTION)
        motions += own
        motion = motions if own else 0
        surfaces.append(Surface(prefix, _fractions(props, prefix), motion, _relief(props, prefix)))
    return surfaces, places


def surface_finder(
    surfaces: list[Surface], scene: mi.Scene
) -> Callable[[mi.SurfaceInteraction3f], mi.UInt32] | None:
    """Return what tells the number of the surface that rays have met, if there is more than one."""
    shapes = {shape.id(): shape for shape in scene.shapes()}
    for surface in surfaces[1:]:
        if surface.prefix[:-1] not in shapes:
            known = ", ".join(sorted(filter(None, shapes))) or "none"
            raise refused(
                surface.prefix[:-1],
                f"no shape has this id; those that shapes have are {known} (Mitsuba merges shapes "
                "of one material, unless the scene is loaded with optimize=False)",
            )
    own = [mi.ShapePtr(shapes[surface.prefix[:-1]]) for surface in surfaces[1:]]

    def find(si: mi.SurfaceInteraction3f) -> mi.UInt32:
        index = mi.UInt32(0)
        for position, shape in enumerate(own, start=1):
            index = dr.select(si.shape == shape, position, index)
        return index

    return find if own else None


def _prefixes(props: mi.Properties) -> list[str]:
    """Return how the names of properties begin, in the order of the scene."""
    known = {*MOTION, *_MIXTURE, *_RELIEF}
    names = [name.rpartition(":") for name in props.keys()]
    return list(
        dict.fromkeys(["", *(id + ":" for id, colon, name in names if colon and name in known)])
    )


def _fractions(props: mi.Properties, prefix: str) -> tuple[float, ...]:
    """Return the fractions of light in each pattern.

    What a shape does not say is that of all others.
    """
    patterns, polarisation = 1, 1.0
    for start in dict.fromkeys(("", prefix)):
        patterns = whole(props, f"{start}patterns", patterns, (1, _MOST_PATTERNS))
        polarisation = number(props, f"{start}polarisation", polarisation)
        if not 0.0 <= polarisation <= 1.0:
            raise refused(f"{start}polarisation", f"must be from 0 to 1, got {polarisation:g}")
    return tuple(incoherent_fractions(patterns, polarisation, [1.0]).tolist())


def _relief(props: mi.Properties, prefix: str) -> tuple[float, float]:
    """Return the rms height and its correlation length.

    What a shape does not say is that of all others.
    """
    lengths = []
    for name in _RELIEF:
        length = 0.0
        for start in dict.fromkeys(("", prefix)):
            length = number(props, start + name, length)
            if length < 0.0:
                raise refused(start + name, f"must not be negative, got {length:g}")
        lengths.append(length)
    return lengths[0], lengths[1]
