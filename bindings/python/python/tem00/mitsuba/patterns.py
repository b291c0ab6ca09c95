"""The speckle of each laser of a scene: planned, generated, and placed in the image."""

from __future__ import annotations

from functools import cache
from math import ceil
from typing import TYPE_CHECKING

import drjit as dr
import mitsuba as mi

from tem00 import ParameterError
from tem00.mitsuba.amplitudes import AmplitudeTable, amplitude_bytes
from tem00.mitsuba.look_up import (
    IntensityTable,
    Part,
    intensity_bytes,
    intensity_coefficients,
    nodes_per_sample,
)
from tem00.mitsuba.speckle_settings import refused
from tem00.speckle import SlicePath, SpeckleStack, StackPlan, derived_seed

if TYPE_CHECKING:
    from collections.abc import Sequence

    from tem00.mitsuba.linewidth import LineLight
    from tem00.mitsuba.speckle_settings import PatternSettings
    from tem00.mitsuba.surfaces import Surface
    from tem00.speckle import PupilField

# Look-ups of amplitudes are written out in the kernel.
_MOST_LOOK_UPS = 16
# What the library's arguments are called here.
_PROPERTIES = {"size": "pattern_size", "diameter": "pattern_diameter", "image": "speckle_size"}


class Pattern:
    """The speckle of one laser on a surface.

    Parameters
    ----------
    parts
        The patterns that add up, of stacks of one size.
    speckle_size
        The speckle size on the sensor, in pixels.
    table
        What the look-up reads: the ``"intensity"`` of all or the ``"amplitude"`` of each.
    """

    def __init__(self, parts: Sequence[Part], speckle_size: float, table: str) -> None:
        self.parts, self.table = parts, table
        self.stack = parts[0].stack
        per_sample = nodes_per_sample(self.stack) if table == "intensity" else 1
        self._nodes_per_pixel = per_sample * self.stack.speckle_size / speckle_size
        self._u: float | None = None

    def move_to(self, pupil: float, shift: tuple[float, float]) -> None:
        """Look the pattern up at another place from now on.

        Parameters
        ----------
        pupil
            Motion of the pupil over the speckle, in its diameters.
        shift
            Motion of the pattern in the image, in pixels, x to the right and y down.
        """
        u = self.stack.coordinate_at(pupil)
        if u != self._u:
            self._tables = self._tables_at(u)
            self._u = u
        scale = self._nodes_per_pixel
        # Read from memory, so that motion compiles nothing anew. Patterns have y up.
        self._scale = mi.Vector2f(scale, -scale)
        pairs = zip(self._tables, self.parts, strict=False)
        self._origins = [self._origin(table, part.offset, shift) for table, part in pairs]
        dr.make_opaque(self._scale, self._origins)

    def factor(self, film: mi.Point2f) -> mi.Float:
        """Return the intensity at points of the film, in pixels; its mean is 1."""
        if len(self._tables) == 1:
            return self._tables[0].at(*dr.fma(self._scale, film, self._origins[0]))
        total = mi.Float(0.0)
        for part, table, origin in zip(self.parts, self._tables, self._origins, strict=True):
            total += part.fraction * table.at(*dr.fma(self._scale, film, origin))
        return total

    def _tables_at(self, u: float) -> Sequence[IntensityTable | AmplitudeTable]:
        if self.table == "amplitude":
            return [AmplitudeTable(part.stack, u) for part in self.parts]
        return [IntensityTable(intensity_coefficients(self.parts, u))]

    def _origin(
        self,
        table: IntensityTable | AmplitudeTable,
        offset: tuple[float, float],
        shift: tuple[float, float],
    ) -> mi.Vector2f:
        """Return the place in a table that belongs to the image's corner, in nodes."""
        scale, periods = self._nodes_per_pixel, (table.columns, table.rows)
        axes = zip((1.0, -1.0), shift, offset, periods, strict=True)
        places = [(-sign * scale * move + at * period) % period for sign, move, at, period in axes]
        return mi.Vector2f(*places)


def generate(
    settings: PatternSettings,
    speckle_sizes: list[float],
    image: tuple[int, int],
    surfaces: list[Surface],
    lights: list[list[LineLight | None]] | None = None,
) -> list[list[Pattern]]:
    """Return the patterns of each laser on the surfaces, by its speckle size.

    The sizes are those in an ``image`` of so many pixels. ``lights`` are those of each laser on
    each surface, by default of one wavelength.
    """
    lasers = len(speckle_sizes)
    lights = lights or [[None] * len(surfaces)] * lasers
    memory = settings.memory_bytes // max(lasers, 1)
    plans = [_plan(settings, size, image, memory) for size in speckle_sizes]
    motions = 1 + max(surface.motion for surface in surfaces)
    fields = [_fields(settings.seed, plan, number, motions) for number, plan in enumerate(plans)]
    of_lasers = [
        _parts(settings, of_motions, memory, list(zip(surfaces, of_laser, strict=True)))
        for of_motions, of_laser in zip(fields, lights, strict=True)
    ]
    speckles = [parts for laser in of_lasers for parts in laser]
    table = _table(speckles, settings)
    if table == "amplitude":
        _check_look_ups(speckles, surfaces * lasers)
    return [
        [Pattern(parts, size, table) for parts in laser]
        for laser, size in zip(of_lasers, speckle_sizes, strict=True)
    ]


def _fields(seed: int, plan: StackPlan, laser: int, motions: int) -> list[PupilField]:
    """Return the fields of the laser of this number for each motion.

    The first is that of `tem00 render` in a still scene.
    """
    first = derived_seed(seed, "laser", laser)
    return [plan.field(derived_seed(first, "body", motion)) for motion in range(motions)]


def _parts(
    settings: PatternSettings,
    fields: list[PupilField],
    memory: int,
    lit: list[tuple[Surface, LineLight | None]],
) -> list[list[Part]]:
    """Return the patterns of a laser on each surface.

    They are in stacks of their own where ``memory`` bytes hold them. ``fields`` are those of the
    laser for each motion, ``lit`` the surfaces with their light.
    """
    surfaces = [surface for surface, _ in lit]
    counts = _counts([(surface, _stacks_of(surface, light)) for surface, light in lit])
    try:
        path = _path(settings)
        needed = path.memory_bytes(fields[0].size) * sum(counts)
        if needed > memory:
            _refuse_lines(
                [[light for _, light in lit]],
                f"needs {sum(counts)} stacks of speckle, {needed / 2**20:.4g} MiB, and `memory` "
                f"allows {memory / 2**20:.4g} MiB for each laser",
            )
            return _places_in(_stack(settings, fields[0], memory), surfaces)
        independent = [
            field.independent(count) for field, count in zip(fields, counts, strict=True)
        ]
    except ParameterError as error:
        raise _renamed(error) from error

    @cache
    def stack_of(motion: int, index: int) -> SpeckleStack:
        return _stack(settings, independent[motion][index], memory)

    return [
        [
            Part(fraction, stack_of(surface.motion, first), (0.0, 0.0), light, heights)
            for fraction, first, heights in _fields_of(surface, light, independent[surface.motion])
        ]
        for surface, light in lit
    ]


def _stacks_of(surface: Surface, light: LineLight | None) -> int:
    """Return the number of independent patterns of a surface."""
    if light is None:
        return len(surface.fractions)
    return len(surface.fractions) * len(light.fractions) * max(len(light.heights), 1)


def _fields_of(
    surface: Surface, light: LineLight | None, fields: Sequence[PupilField]
) -> list[tuple[float, int, tuple[PupilField, ...]]]:
    """Return the fraction of each pattern, the number of its first field, and its fields."""
    modes: Sequence[float] = (1.0,) if light is None else light.fractions.tolist()
    fractions = [own * mode for own in surface.fractions for mode in modes]
    each = _stacks_of(surface, light) // len(fractions)
    return [
        (fraction, each * index, tuple(fields[each * index : each * (index + 1)]))
        for index, fraction in enumerate(fractions)
    ]


def _refuse_lines(lights: list[list[LineLight | None]], why: str) -> None:
    if any(light is not None for of_laser in lights for light in of_laser):
        raise refused("linewidth", why)


def _places_in(stack: SpeckleStack, surfaces: list[Surface]) -> list[list[Part]]:
    """Return the patterns on each surface as places far apart in one stack."""
    counts = _counts([(surface, len(surface.fractions)) for surface in surfaces])
    return [
        [
            Part(fraction, stack, StackPlan.place(sum(counts[: surface.motion]) + index))
            for index, fraction in enumerate(surface.fractions)
        ]
        for surface in surfaces
    ]


def _counts(surfaces: list[tuple[Surface, int]]) -> list[int]:
    """Return the number of patterns for each motion, from those of each surface."""
    counts = [1] * (1 + max(surface.motion for surface, _ in surfaces))
    for surface, patterns in surfaces:
        counts[surface.motion] = max(counts[surface.motion], patterns)
    return counts


def _plan(
    settings: PatternSettings, speckle_size: float, image: tuple[int, int], memory: int
) -> StackPlan:
    """Return the sizes of a pattern: what the image needs, or what the scene sets."""
    try:
        plan = StackPlan(
            image=image,
            region=image,
            speckle_size=speckle_size,
            motion=None,
            frames=1,
            memory_limit=memory,
        )
        size, diameter = settings.pattern_size, settings.pattern_diameter
        if size is None and diameter is None:
            return plan
        return plan.with_square(size or 2 * (diameter or 0), diameter or (size or 0) // 2)
    except MemoryError as error:
        raise refused("speckle_size", f"too small for an image of {image}: {error}") from error
    except ParameterError as error:
        raise _renamed(error) from error


def _stack(settings: PatternSettings, field: PupilField, memory: int) -> SpeckleStack:
    try:
        return SpeckleStack.generate(field, _path(settings), memory)
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


def _table(speckles: list[list[Part]], settings: PatternSettings) -> str:
    """Return what tables are made of: what is asked for, or the first that fits the memory."""
    needs = {"intensity": _intensity_bytes(speckles), "amplitude": _amplitude_bytes(speckles)}
    asked = list(needs) if settings.table == "auto" else [settings.table]
    if any(part.light for parts in speckles for part in parts):
        if settings.table == "amplitude":
            raise refused(
                "table",
                "must be auto or intensity for a `linewidth`, got 'amplitude', which is of one "
                "wavelength",
            )
        asked = ["intensity"]
    for kind in asked:
        if needs[kind] <= settings.memory_bytes:
            return kind
    raise refused(
        "speckle_size",
        f"so small that the image holds too many speckles: their table of {kind} would take "
        f"{needs[kind] / 2**20:.4g} MiB, and `memory` allows {settings.memory} MiB",
    )


def _check_look_ups(speckles: list[list[Part]], surfaces: list[Surface]) -> None:
    """Refuse more look-ups of amplitudes than a kernel holds, on the surface of each speckle."""
    for parts, surface in zip(speckles, surfaces, strict=True):
        if len(parts) > _MOST_LOOK_UPS:
            memory = ceil(_intensity_bytes(speckles) / 2**20)
            raise refused(
                f"{surface.prefix}patterns",
                f"must need {_MOST_LOOK_UPS} look-ups of amplitudes at most, got {len(parts)}, two "
                "to a pattern where `polarisation` is below 1: each is written out in the kernel. "
                "A table of intensities looks up their "
                f'sum: it needs a `memory` of {memory}, and `table` "intensity" or "auto"',
            )


def _intensity_bytes(speckles: list[list[Part]]) -> int:
    return sum(intensity_bytes(parts[0].stack) for parts in speckles)


def _amplitude_bytes(speckles: list[list[Part]]) -> int:
    return sum(amplitude_bytes(part.stack) for parts in speckles for part in parts)
