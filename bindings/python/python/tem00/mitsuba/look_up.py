"""The look-up of speckle as Dr.Jit expressions: a spline of the intensity."""

from __future__ import annotations

from math import ceil, floor
from typing import TYPE_CHECKING, NamedTuple

import drjit as dr
import mitsuba as mi
import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from tem00.mitsuba.linewidth import LineLight
    from tem00.speckle import PupilField, SpeckleStack

    Weights = tuple[mi.Float, mi.Float, mi.Float, mi.Float]

# The fewest nodes of the spline per period of the finest fringes. The intensity has fringes down to
# one speckle size, and the interpolation of its amplitude adds faint ones down to half of that.
# With 8 nodes per speckle the spline errs by 1.1e-4 (rms) and 9e-4 (worst of 20000) of the mean.
_FEWEST_NODES = 7.5
# Eight in the end: the rest is spectra, while the coefficients are made.
_BYTES_PER_NODE = 28
# The nodes before and behind a cell's own that its taps reach.
BEFORE, AFTER = 1, 2
_BITS = 16
_LARGEST = 2**_BITS - 1


class Part(NamedTuple):
    """A pattern in the speckle of a surface: its fraction of the light, and its place in a stack.

    The place is in periods. Light that is not of one wavelength has the pupil ``fields`` of its
    heights, the first that of the stack.
    """

    fraction: float
    stack: SpeckleStack
    offset: tuple[float, float]
    light: LineLight | None = None
    fields: tuple[PupilField, ...] = ()


def intensity_coefficients(parts: Sequence[Part], u: float) -> NDArray[np.float32]:
    """Return the coefficients of the cubic B-spline through the sum of intensities.

    Parameters
    ----------
    parts
        The patterns, of stacks of one size. The place of the first is the origin.
    u
        The slice coordinate.

    Returns
    -------
    NDArray[np.float32]
        Coefficients of shape (rows, columns) over one period, a whole number of them per sample.
    """
    stack, origin = parts[0].stack, np.array(parts[0].offset)
    per_sample = nodes_per_sample(stack)
    columns, rows = (side * per_sample for side in stack.size)
    x = np.arange(columns) / per_sample
    values: NDArray[np.float32] = np.zeros((rows, columns), dtype=np.float32)
    for part in parts:
        if part.light is not None:
            pattern = part.light.pattern(part.fields, pupil_at(part.stack, u))
            values += part.fraction * _upsampled(pattern, per_sample)
            continue
        dx, dy = (part.offset - origin) * stack.size
        # Row by row, so that the coordinates take no memory to speak of.
        for row in range(rows):
            values[row] += part.fraction * part.stack.intensity_at(x + dx, row / per_sample + dy, u)
    return _prefiltered(_prefiltered(values, axis=1), axis=0)


def pupil_at(stack: SpeckleStack, u: float) -> NDArray[np.float64]:
    """Return where on its path the pupil of a slice coordinate stands, in diameters."""
    count = stack.slice_count
    index, f = floor(u) % count, u - floor(u)
    here = np.array(stack.offset(index))
    # From the last slice of a straight path, which closes as the pattern does, the step is that
    # before it.
    first = index - 1 if index + 1 == count > 2 else index
    step = np.subtract(stack.offset((first + 1) % count), stack.offset(first))
    pupil: NDArray[np.float64] = here + f * step
    return pupil


def _upsampled(pattern: NDArray[np.float32], factor: int) -> NDArray[np.float32]:
    """Return a periodic pattern at ``factor`` nodes per sample, by its Fourier series."""
    rows, columns = pattern.shape
    spectrum = np.fft.fft(np.fft.rfft(pattern, axis=1), axis=0)
    # A pattern has no power at half the sampling rate.
    wide = np.zeros((rows * factor, spectrum.shape[1]), dtype=spectrum.dtype)
    half = rows // 2
    wide[:half], wide[-half:] = spectrum[:half], spectrum[-half:]
    fine = np.fft.irfft(np.fft.ifft(wide, axis=0), n=columns * factor, axis=1)
    return (fine * factor**2).astype(np.float32)


def intensity_bytes(stack: SpeckleStack) -> int:
    """Return the memory of a table while it is made."""
    return _BYTES_PER_NODE * stack.size[0] * stack.size[1] * nodes_per_sample(stack) ** 2


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


class IntensityTable:
    """A periodic cubic B-spline of intensities in two dimensions, evaluated inside kernels.

    Coefficients are kept as 16-bit numbers, four neighbours of a row in one word: fetching the taps
    is what a look-up costs. Rounding them moves the values by 1e-4 of 12, a usual range, at most.

    Parameters
    ----------
    coefficients
        Coefficients of shape (rows, columns) over one period.
    """

    def __init__(self, coefficients: NDArray[np.float32]) -> None:
        self.rows, self.columns = coefficients.shape
        lowest, highest = float(coefficients.min()), float(coefficients.max())
        step = (highest - lowest) / _LARGEST or 1.0
        levels = np.rint((coefficients - lowest) / step).astype(np.uint16)
        padded = np.pad(levels, (BEFORE, AFTER), mode="wrap")
        self._words = mi.UInt64(_rows_of_four(padded).ravel())
        self._lowest, self._step = mi.Float(lowest), mi.Float(step)
        dr.make_opaque(self._lowest, self._step)

    def at(self, x: mi.Float, y: mi.Float) -> mi.Float:
        """Return the intensities at x and y, in nodes."""
        column, row = cell_of(x, self.columns), cell_of(y, self.rows)
        # Words begin one node before their cell.
        index = row.node * self.columns + column.node
        weights = cubic_weights(column.fraction)
        total = mi.Float(0.0)
        for tap, weight in enumerate(cubic_weights(row.fraction)):
            word = dr.gather(mi.UInt64, self._words, index + tap * self.columns)
            total = dr.fma(weight, _weighted(word, weights), total)
        # The weights add up to 1, so that the scale can wait until here.
        intensity = dr.fma(self._step, total, self._lowest)
        # The spline swings below dark points by 1e-4 at most.
        return dr.select(intensity > 0.0, intensity, 0.0)


def _rows_of_four(padded: NDArray[np.uint16]) -> NDArray[np.uint64]:
    """Return for each column the word of four neighbours, the first in the lowest bits."""
    neighbours = sliding_window_view(padded, BEFORE + AFTER + 1, axis=1)
    return np.ascontiguousarray(neighbours, dtype="<u2").view("<u8")


def _weighted(word: mi.UInt64, weights: Weights) -> mi.Float:
    """Return the weighted sum of the four numbers of a word."""
    halves = mi.UInt32(word), mi.UInt32(word >> 32)
    total = mi.Float(0.0)
    for half, (first, second) in zip(halves, (weights[:2], weights[2:]), strict=True):
        # Conversions of signed integers are the fast ones.
        total = dr.fma(first, mi.Float(mi.Int32(half & _LARGEST)), total)
        total = dr.fma(second, mi.Float(mi.Int32(half >> _BITS)), total)
    return total


class Cell(NamedTuple):
    """The node before a place and the fraction of the way to the next."""

    node: mi.UInt32
    fraction: mi.Float


def cell_of(place: mi.Float, period: int) -> Cell:
    """Return the cell of a place among nodes that repeat."""
    place = place - period * dr.floor(place * (1.0 / period))
    # Rounding can put the place beside the period, by the last bit.
    node = dr.clip(mi.Int32(dr.floor(place)), 0, period - 1)
    return Cell(mi.UInt32(node), place - mi.Float(node))


def cubic_weights(f: mi.Float) -> Weights:
    """Return the weights of a cubic B-spline: of the node before a cell, its two, and the next."""
    g = 1.0 - f
    inner = tuple(2.0 / 3.0 - 0.5 * t * t * (2.0 - t) for t in (f, g))
    return g * g * g / 6.0, inner[0], inner[1], f * f * f / 6.0
