"""The look-up of speckle as Dr.Jit expressions: the amplitudes of a stack."""

from __future__ import annotations

from math import floor, pi
from typing import TYPE_CHECKING

import drjit as dr
import mitsuba as mi
import numpy as np

from tem00.mitsuba.look_up import AFTER, BEFORE, Cell, cell_of, cubic_weights

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from tem00.mitsuba.look_up import Weights
    from tem00.speckle import SpeckleStack

    Complex = tuple[mi.Float, mi.Float]

_BITS = 16
_LARGEST = 2 ** (_BITS - 1) - 1
_BYTES_PER_SAMPLE = 4
# The shapes 1, p, p**2 and p**3 of `SliceLaw`. Its odd ones, behind asymmetric pupils, add 1e-5 at
# most.
_SHAPES = 4


def amplitude_bytes(stack: SpeckleStack) -> int:
    """Return the memory of a table: of one slice, or of the two about a coordinate."""
    slices = min(stack.slice_count, 2)
    return _BYTES_PER_SAMPLE * slices * stack.size[0] * stack.size[1]


class AmplitudeTable:
    """The intensities of a stack at a slice coordinate, from amplitudes, evaluated inside kernels.

    The formulas are those of `SliceLaw`. Coefficients are kept as pairs of 16-bit numbers: rounding
    them moves an intensity I by 1e-4 sqrt(I) at most.

    Parameters
    ----------
    stack
        The stack, which repeats after ``stack.size`` samples.
    u
        The slice coordinate.
    """

    def __init__(self, stack: SpeckleStack, u: float) -> None:
        self.columns, self.rows = stack.size
        count = stack.slice_count
        index, f = floor(u) % count, u - floor(u)
        following = (index + 1) % count
        self._slices = [_Slice(stack.coefficients(index), 1.0 - f if count > 1 else 1.0)]
        if count > 1:
            self._slices.append(_Slice(stack.coefficients(following), f))
        # Of the slices between which a stack has no other: the phase from one to the next.
        turns = stack.slice_law(index).turns
        steps = np.rint(turns * stack.size).astype(np.int64) % stack.size
        self._turns = mi.Vector2f(*turns.tolist())
        self._steps = mi.UInt32(int(steps[0])), mi.UInt32(int(steps[1]))
        self._law = [[mi.Float(term) for term in row] for row in _blended_law(stack, index, f)]
        dr.make_opaque(self._turns, self._steps, self._law)

    def at(self, x: mi.Float, y: mi.Float) -> mi.Float:
        """Return the intensities at x and y, in samples."""
        column, row = cell_of(x, self.columns), cell_of(y, self.rows)
        weights = tuple(cubic_weights(cell.fraction) for cell in (column, row))
        index = row.node * (BEFORE + self.columns + AFTER) + column.node
        real, imaginary = self._slices[0].at(index, *weights)
        for following in self._slices[1:]:
            a, b = following.at(index, *weights)
            sine, cosine = dr.sincos(self._phase(column, row))
            real += cosine * a - sine * b
            imaginary += cosine * b + sine * a
        return (real * real + imaginary * imaginary) / self._mean_square(column, row)

    def _phase(self, column: Cell, row: Cell) -> mi.Float:
        """Return the phase from the frame of the next slice to that of this one.

        At the samples it is a whole number of turns over the period.
        """
        turns = dr.fma(self._turns.x, column.fraction, self._turns.y * row.fraction)
        pairs = ((column.node, self._steps[0], self.columns), (row.node, self._steps[1], self.rows))
        for node, step, period in pairs:
            turns += mi.Float(mi.Int32(node * step % period)) * (1.0 / period)
        return 2.0 * pi * (turns - dr.round(turns))

    def _mean_square(self, column: Cell, row: Cell) -> mi.Float:
        along_x, along_y = _shapes(column.fraction), _shapes(row.fraction)
        total = mi.Float(0.0)
        for shape, terms in zip(along_y, self._law, strict=True):
            products = [term * other for term, other in zip(terms, along_x, strict=True)]
            total = dr.fma(shape, sum(products[1:], start=products[0]), total)
        return total


class _Slice:
    """The coefficients of a slice, real and imaginary part in one word, and its weight."""

    def __init__(self, coefficients: NDArray[np.complex64], weight: float) -> None:
        padded = np.pad(coefficients, (BEFORE, AFTER), mode="wrap")
        self._stride = padded.shape[1]
        parts = padded.view(np.float32)
        step = float(np.abs(parts).max()) / _LARGEST
        self._words = mi.UInt32(np.rint(parts / step).astype(np.int16).view(np.uint32).ravel())
        self._scale = mi.Float(weight * step)
        dr.make_opaque(self._scale)

    def at(self, index: mi.UInt32, along_x: Weights, along_y: Weights) -> Complex:
        """Return the amplitude in the cell whose first tap has the index."""
        real, imaginary = mi.Float(0.0), mi.Float(0.0)
        for row, outer in enumerate(along_y):
            for column, inner in enumerate(along_x):
                offset = row * self._stride + column
                word = mi.Int32(dr.gather(mi.UInt32, self._words, index + offset))
                weight = outer * inner
                real = dr.fma(weight, mi.Float((word << _BITS) >> _BITS), real)
                imaginary = dr.fma(weight, mi.Float(word >> _BITS), imaginary)
        return self._scale * real, self._scale * imaginary


def _blended_law(stack: SpeckleStack, index: int, f: float) -> NDArray[np.float64]:
    """Return the coefficients of the mean squared amplitude between a slice and the next."""
    count = stack.slice_count
    own, following = stack.slice_law(index), stack.slice_law((index + 1) % count)
    if count == 1:
        return own.mean_square.astype(np.float64)
    law = (1.0 - f) ** 2 * own.mean_square + f**2 * following.mean_square
    law += 2.0 * f * (1.0 - f) * own.covariance[:_SHAPES, :_SHAPES]
    return law.astype(np.float64)


def _shapes(f: mi.Float) -> list[mi.Float]:
    p = f * (1.0 - f)
    return [mi.Float(1.0), p, p * p, p * p * p]
