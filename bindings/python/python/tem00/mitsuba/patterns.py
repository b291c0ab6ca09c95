"""The speckle of each laser of a scene: planned, generated, and placed in the image."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import drjit as dr
import mitsuba as mi

from tem00 import ParameterError
from tem00.mitsuba.amplitudes import AmplitudeTable, amplitude_bytes
from tem00.mitsuba.look_up import (
    IntensityTable,
    intensity_bytes,
    intensity_coefficients,
    nodes_per_sample,
)
from tem00.mitsuba.speckle_settings import refused
from tem00.speckle import SlicePath, SpeckleStack, StackNeeds, StackOptions, StackPlan

if TYPE_CHECKING:
    from tem00.mitsuba.speckle_settings import PatternSettings

# Steps of Weyl's sequence: they keep the seeds of the lasers apart. The same in `tem00 render`.
_SEED_STEP = 0x9E37_79B9_7F4A_7C15
# What the library's arguments are called here.
_PROPERTIES = {"size": "pattern_size", "diameter": "pattern_diameter", "image": "speckle_size"}
# The root of x**3 = x + 1: multiples of its powers are far apart (Roberts 2018).
_PLASTIC = 1.324717957244746


class Place(NamedTuple):
    """Place at which the pattern of a laser is looked up.

    ``u`` is the slice coordinate, ``shift`` the motion of the pattern in the image, in pixels, x to
    the right and y down.
    """

    u: float
    shift: tuple[float, float]


class Pattern:
    """The speckle of one laser.

    Parameters
    ----------
    stack
        The stack.
    speckle_size
        The speckle size on the sensor, in pixels.
    offset
        The place in the stack that belongs to the image's corner, in periods along x and y.
    table
        What the look-up reads: the ``"intensity"`` or the ``"amplitude"`` of the stack.
    """

    def __init__(
        self, stack: SpeckleStack, speckle_size: float, offset: tuple[float, float], table: str
    ) -> None:
        self.stack = stack
        self.table = table
        per_sample = nodes_per_sample(stack) if table == "intensity" else 1
        self._nodes_per_pixel = per_sample * stack.speckle_size / speckle_size
        self._offset = offset
        self._u: float | None = None

    def move_to(self, place: Place) -> None:
        """Look the pattern up at another place from now on."""
        if place.u != self._u:
            self._look_up = self._table_at(place.u)
            self._u = place.u
        scale = self._nodes_per_pixel
        periods = self._look_up.columns, self._look_up.rows
        origin = [
            (-sign * scale * shift + offset * period) % period
            for sign, shift, offset, period in zip(
                (1.0, -1.0), place.shift, self._offset, periods, strict=True
            )
        ]
        # Read from memory, so that motion compiles nothing anew. Patterns have y up.
        self._scale = mi.Vector2f(scale, -scale)
        self._origin = mi.Vector2f(*origin)
        dr.make_opaque(self._scale, self._origin)

    def factor(self, film: mi.Point2f) -> mi.Float:
        """Return the intensity at points of the film, in pixels; its mean is 1."""
        x, y = dr.fma(self._scale, film, self._origin)
        return self._look_up.at(x, y)

    def _table_at(self, u: float) -> IntensityTable | AmplitudeTable:
        if self.table == "amplitude":
            return AmplitudeTable(self.stack, u)
        return IntensityTable(intensity_coefficients(self.stack, u))


def generate(
    settings: PatternSettings, speckle_sizes: list[float], image: tuple[int, int]
) -> list[Pattern]:
    """Return the pattern of each laser, by its speckle size in an image of so many pixels."""
    sizes = speckle_sizes
    if settings.file is not None:
        stack = _read(settings.file, settings.memory_bytes)
        table = _table([stack] * len(sizes), settings)
        return [Pattern(stack, size, _place(number), table) for number, size in enumerate(sizes)]
    memory = settings.memory_bytes // max(len(sizes), 1)
    stacks = []
    for number, size in enumerate(sizes):
        plan = _plan(settings, size, image, memory)
        stacks.append(_stack(settings, plan, number, memory))
    table = _table(stacks, settings)
    pairs = zip(stacks, sizes, strict=True)
    return [Pattern(stack, size, (0.0, 0.0), table) for stack, size in pairs]


def _plan(
    settings: PatternSettings, speckle_size: float, image: tuple[int, int], memory: int
) -> StackPlan:
    """Return the sizes of a pattern: what the image needs, or what the scene sets."""
    try:
        needs = StackNeeds(
            image=image,
            region=image,
            speckle_size=speckle_size,
            motion=None,
            frames=1,
            memory_limit=memory,
        )
        plan = StackPlan(needs)
        size, diameter = settings.pattern_size, settings.pattern_diameter
        if size is None and diameter is None:
            return plan
        return plan.with_square(size or 2 * (diameter or 0), diameter or (size or 0) // 2)
    except MemoryError as error:
        raise refused("speckle_size", f"too small for an image of {image}: {error}") from error
    except ParameterError as error:
        raise _renamed(error) from error


def _stack(settings: PatternSettings, plan: StackPlan, number: int, memory: int) -> SpeckleStack:
    """Return the stack that `tem00 render` has for the laser of this number in a still scene."""
    seed = (settings.seed + (number + 1) * _SEED_STEP) % 2**64
    try:
        options = StackOptions(memory_limit=memory)
        return SpeckleStack.generate(plan.field(seed), _path(settings), options)
    except MemoryError as error:
        name = "pattern_size" if settings.path == "still" else "half_period"
        raise refused(name, f"too large: {error}") from error
    except ParameterError as error:
        raise _renamed(error) from error


def _renamed(error: ParameterError) -> ParameterError:
    return refused(_PROPERTIES.get(error.parameter, error.parameter), str(error))


def _path(settings: PatternSettings) -> SlicePath:
    if settings.path == "circle":
        return SlicePath.circle(half_period=settings.half_period)
    if settings.path == "straight":
        return SlicePath.straight(half_period=settings.half_period, length=settings.length)
    return SlicePath.still()


def _read(file: str, memory: int) -> SpeckleStack:
    path = mi.file_resolver().resolve(file)
    try:
        return SpeckleStack.read_from(str(path), memory_limit=memory)
    except OSError as error:
        raise refused("file", f"{path} cannot be read: {error}") from error


def _place(number: int) -> tuple[float, float]:
    return number / _PLASTIC % 1.0, number / _PLASTIC**2 % 1.0


def _table(stacks: list[SpeckleStack], settings: PatternSettings) -> str:
    """Return what tables are made of: what is asked for, or the first that fits the memory."""
    kinds = {"intensity": intensity_bytes, "amplitude": amplitude_bytes}
    asked = list(kinds) if settings.table == "auto" else [settings.table]
    for kind in asked:
        needed = sum(kinds[kind](stack) for stack in stacks)
        if needed <= settings.memory_bytes:
            return kind
    raise refused(
        "speckle_size",
        f"so small that the image holds too many speckles: their table of {kind} would take "
        f"{needed / 2**20:.4g} MiB, and `memory` allows {settings.memory} MiB",
    )
