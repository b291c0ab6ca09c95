"""Speckle in the light of a laser that is not of one wavelength.

It depends on the tilt and the relief of each surface, which has a pattern of its own.
"""

from __future__ import annotations

from math import ceil
from typing import TYPE_CHECKING, Any, NamedTuple

import drjit as dr
import mitsuba as mi
import numpy as np

from tem00.coherence import ResolutionCell, Spectrum
from tem00.mitsuba.frame import next_event
from tem00.mitsuba.speckle_settings import refused
from tem00.mitsuba.surfaces import surface_finder

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from tem00.mitsuba.surfaces import Surface
    from tem00.speckle import PupilField

    Floats = NDArray[np.float64]

# Rays along each axis of the image that look for the surfaces.
_RAYS = 24
# The spread of the wave number over that which displaces the pupil by its diameter, below which a
# contrast is above 0.999. The same in `tem00 render`.
_NEGLIGIBLE_TILT = 5e-4
# Wave numbers: so many, and so many to a pupil diameter and to a radian of the phases by heights.
_FEWEST_WAVES, _WAVES_PER_DIAMETER, _WAVES_PER_RADIAN = 24, 16, 12
_LEFT_OUT = 5e-4
# A contrast that varies by more over a surface is told.
_VARIATION = 0.05


class LineLight(NamedTuple):
    """The light of a spectral line on a surface.

    ``axis`` is the direction in the image, y up, in which another wave number displaces the pupil;
    ``fractions`` and ``heights`` are those of ``cell.patterns(line)``.
    """

    line: Spectrum
    cell: ResolutionCell
    axis: tuple[float, float]
    fractions: Floats
    heights: Floats

    def pattern(self, fields: Sequence[PupilField], pupil: Floats) -> NDArray[np.float32]:
        """Return the intensity at the samples of a pattern, a mean over the line.

        Parameters
        ----------
        fields
            Independent fields, one for each of the heights.
        pupil
            Displacement of the pupil at the middle of the line, in diameters.
        """
        if len(self.heights) == 0:
            return fields[0].pattern(pupil).values
        z, roots = self.heights.T
        intensity: NDArray[np.float32] = np.zeros(fields[0].size[::-1], dtype=np.float32)
        waves = self._waves()
        for kappa in waves:
            offset = pupil + kappa / self.cell.tilt_wave_number * np.array(self.axis)
            phasors = roots * np.exp(1j * kappa * self.cell.height_factor * z)
            amplitude = sum(
                np.complex64(phasor) * field.field(offset).values
                for phasor, field in zip(phasors, fields, strict=True)
            )
            intensity += np.abs(amplitude) ** 2 / np.float32(len(waves))
        return intensity

    def _waves(self) -> Floats:
        """Return wave numbers of equal power, from that of the middle."""
        ends = self.line.draw(np.array([_LEFT_OUT, 1.0 - _LEFT_OUT]))
        diameters = np.ptp(ends) / self.cell.tilt_wave_number
        if diameters == 0.0:
            return np.zeros(1)
        radians = self.line.effective_spread * self.cell.path_spread
        enough = max(_WAVES_PER_DIAMETER * diameters, _WAVES_PER_RADIAN * radians)
        count = max(_FEWEST_WAVES, ceil(enough))
        return self.line.draw((np.arange(count) + 0.5) / count)


def find_lights(
    scene: mi.Scene, sensor: mi.Sensor, lasers: Sequence[Any], surfaces: Sequence[Surface]
) -> list[list[LineLight | None]]:
    """Return the light of each laser on the surfaces; None is light of one wavelength.

    A surface has the tilt of the middle of those points of it that the camera sees and the laser
    lights.
    """
    lights: list[list[LineLight | None]] = [[None] * len(surfaces) for _ in lasers]
    broad = [number for number, laser in enumerate(lasers) if getattr(laser, "line", None)]
    if not broad:
        return lights
    lens = mi.traverse(sensor)
    if "aperture_radius" not in lens:
        raise refused("linewidth", "needs the lens of a `thinlens`, which blurs a tilt")
    radius = float(dr.slice(lens["aperture_radius"]))
    seen = _Seen(scene, sensor, surfaces)
    for number in broad:
        for index, surface in enumerate(surfaces):
            cells = seen.cells(lasers[number], index, surface.relief, radius)
            lights[number][index] = _light(lasers[number].line, cells, seen.axes)
    return lights


def _light(
    line: Spectrum, cells: list[ResolutionCell], axes: Floats
) -> LineLight | None:
    """Return the light on the middle one of cells, in the order of their tilt."""
    if not cells:
        return None
    cells = sorted(cells, key=lambda cell: float(np.linalg.norm(cell.tilt)))
    few, many = (cells[len(cells) * part // 100].contrast(line) for part in (95, 5))
    if many - few > _VARIATION:
        mi.Log(
            mi.LogLevel.Warn,
            f"speckle: the contrast over a linewidth goes from {few:.2f} to {many:.2f} over a "
            "surface, and is shown as that of its middle: give its parts ids of their own",
        )
    cell = cells[len(cells) // 2]
    fractions, heights = cell.patterns(line)
    tilted = line.effective_spread / cell.tilt_wave_number > _NEGLIGIBLE_TILT
    if not tilted and len(fractions) == len(heights) == 1:
        return None
    x, y = (float(np.dot(axis, cell.tilt)) for axis in axes)
    length = np.hypot(x, y)
    axis = (x / length, y / length) if length > 0.0 else (1.0, 0.0)
    return LineLight(line, cell, axis, fractions, heights)


class _Seen:
    """What the camera sees: points on a lattice over the image.

    ``axes`` are the directions to the right and up in the image.
    """

    def __init__(
        self, scene: mi.Scene, sensor: mi.Sensor, surfaces: Sequence[Surface]
    ) -> None:
        places = (np.arange(_RAYS) + 0.5) / _RAYS
        x, y = (mi.Float(values.ravel()) for values in np.meshgrid(places, places))
        ray, _ = sensor.sample_ray(0.0, 0.0, mi.Point2f(x, y), mi.Point2f(0.5))
        si = scene.ray_intersect(mi.Ray3f(ray))
        find = surface_finder(list(surfaces), scene)
        self._points = si.p
        self._hit = np.array(si.is_valid())
        self._surface = np.array(find(si)) if find else np.zeros(self._hit.size, dtype=int)
        self._normals, self._directions = (np.array(v).T for v in (si.n, ray.d))
        # Rays begin at the near clipping plane.
        pupil = sensor.world_transform().translation()
        self._distances = np.array(dr.norm(si.p - pupil))
        rows = self._directions.reshape(_RAYS, _RAYS, 3)
        middle = _RAYS // 2
        spans = rows[middle, -1] - rows[middle, 0], rows[0, middle] - rows[-1, middle]
        self.axes = np.array([span / np.linalg.norm(span) for span in spans])

    def cells(
        self, laser: Any, surface: int, relief: tuple[float, float], radius: float
    ) -> list[ResolutionCell]:
        """Return the cells of the points of a surface, by its number, that a laser lights."""
        event = next_event(laser.law, laser.frame, self._points)
        source = np.array(event.wi).T
        extent = laser.description.numbers.get("source_half_angle", 0.0)
        facing = -np.sign(np.sum(self._normals * self._directions, axis=1))[:, None] * self._normals
        lit = self._hit & (self._surface == surface) & (np.array(event.e_perp) > 0.0)
        lit &= np.sum(source * facing, axis=1) > 0.0
        return [
            ResolutionCell(
                source[point],
                -self._directions[point],
                facing[point],
                radius / self._distances[point],
                laser.wavelength,
                *relief,
                source_half_angle=np.deg2rad(extent),
            )
            for point in np.flatnonzero(lit)
        ]
