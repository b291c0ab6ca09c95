"""The look-up of speckle as Dr.Jit expressions: a spline of the intensity."""

from __future__ import annotations

from math import ceil
from typing import TYPE_CHECKING, NamedTuple

import drjit as dr
import mitsuba as mi
import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from tem00.speckle import SpeckleStack

# The fewest nodes of the spline per period of the finest fringes. The intensity has fringes down to
# one speckle size, and the interpolation of its amplitude adds faint ones down to half of that: with
# 8 nodes per speckle the spline errs by 1.1e-4 (rms) and 9e-4 (worst of 20000 points) of the mean.
_FEWEST_NODES = 7.5
# The ends of a period that the taps of the last cells reach.
_BEFORE, _AFTER = 1, 2


def intensity_coefficients(stack: SpeckleStack, u: float) -> NDArray[np.float32]:
    """Return the coefficients of the cubic B-spline through the intensities of a stack.

    Parameters
    ----------
    stack
        The stack, which repeats after ``stack.size`` samples.
    u
        The slice coordinate.

    Returns
    -------
    NDArray[np.float32]
        Coefficients of shape (rows, columns) over one period, a whole number of them per sample.
    """
    per_sample = nodes_per_sample(stack)
    columns, rows = (side * per_sample for side in stack.size)
    x = np.arange(columns) / per_sample
    values = np.empty((rows, columns), dtype=np.float32)
    # Row by row, so that the coordinates take no memory to speak of.
    for row in range(rows):
        values[row] = stack.intensity_at(x, row / per_sample, u)
    return _prefiltered(_prefiltered(values, axis=1), axis=0)


def nodes_per_sample(stack: SpeckleStack) -> int:
    """Return the number of spline nodes for each sample of a stack, along each axis."""
    finest = stack.speckle_size / (1.0 + _longest_step(stack))
    return max(1, ceil(_FEWEST_NODES / finest))


def _longest_step(stack: SpeckleStack) -> float:
    """Return how far the pupils of neighbouring slices stand apart, in diameters.

    Between two slices fringes are finer than a speckle: both pupils together are wider than one.
    """
    offsets = np.array([stack.offset(index) for index in range(stack.slice_count)])
    steps = np.diff(offsets, axis=0)
    return float(np.hypot(*steps.T).max(initial=0.0))


def _prefiltered(values: NDArray[np.float32], axis: int) -> NDArray[np.float32]:
    """Divide the spectrum along an axis by that of the spline at its nodes: 1/6, 2/3, 1/6."""
    length = values.shape[axis]
    response = (2.0 + np.cos(2.0 * np.pi * np.fft.rfftfreq(length))) / 3.0
    shape = (-1, 1) if axis == 0 else (1, -1)
    spectrum = np.fft.rfft(values, axis=axis) / response.reshape(shape)
    return np.fft.irfft(spectrum, n=length, axis=axis).astype(np.float32)


class SplineTable:
    """A periodic cubic B-spline in two dimensions, evaluated inside kernels.

    Parameters
    ----------
    coefficients
        Coefficients of shape (rows, columns) over one period.
    """

    def __init__(self, coefficients: NDArray[np.float32]) -> None:
        self.rows, self.columns = coefficients.shape
        padded = np.pad(coefficients, (_BEFORE, _AFTER), mode="wrap")
        self._pitch = padded.shape[1]
        self._values = mi.Float(padded.ravel())

    def at(self, x: mi.Float, y: mi.Float) -> mi.Float:
        """Return the values at x and y, in nodes."""
        along_x, along_y = _taps(x, self.columns), _taps(y, self.rows)
        corner = along_y.cell * self._pitch + along_x.cell
        total = mi.Float(0.0)
        for row, weight in enumerate(along_y.weights):
            first = corner + row * self._pitch
            along_row = mi.Float(0.0)
            for column, tap in enumerate(along_x.weights):
                value = dr.gather(mi.Float, self._values, first + column)
                along_row = dr.fma(tap, value, along_row)
            total = dr.fma(weight, along_row, total)
        return total


class _Taps(NamedTuple):
    """The first of four taps in the padded table, and their weights."""

    cell: mi.UInt32
    weights: tuple[mi.Float, mi.Float, mi.Float, mi.Float]


def _taps(place: mi.Float, period: int) -> _Taps:
    place = place - period * dr.floor(place * (1.0 / period))
    # Just below zero the remainder rounds to the period itself.
    cell = dr.clip(dr.floor(place), 0.0, period - 1.0)
    f = place - cell
    g = 1.0 - f
    inner = tuple(2.0 / 3.0 - 0.5 * t * t * (2.0 - t) for t in (f, g))
    return _Taps(mi.UInt32(cell), (g * g * g / 6.0, inner[0], inner[1], f * f * f / 6.0))
