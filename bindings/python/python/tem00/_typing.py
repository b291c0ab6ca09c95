"""Types of arguments and results, for annotations."""

from collections.abc import Callable, Sequence
from typing import Literal, SupportsIndex, TypeAlias

import numpy as np
from numpy.typing import NDArray

FloatArray: TypeAlias = NDArray[np.float64]
"""Result of functions of numbers, for arrays."""

RealArray: TypeAlias = (
    NDArray[np.floating] | NDArray[np.integer] | Sequence[float] | Sequence[Sequence[float]]
)
"""An array of real numbers, or a list of them."""

Numbers: TypeAlias = float | RealArray
"""A number or an array of real numbers."""

Vector: TypeAlias = NDArray[np.floating] | NDArray[np.integer] | Sequence[float]
"""The components of a vector."""

Pair: TypeAlias = tuple[Numbers, Numbers] | Sequence[Numbers] | FloatArray
"""Two numbers, or two arrays."""

ComplexArray: TypeAlias = NDArray[np.complexfloating] | NDArray[np.floating]
"""An array of complex numbers."""

Vectors: TypeAlias = Vector | Sequence[Sequence[float]]
"""Vectors in the last axis of an array."""

Table: TypeAlias = NDArray[np.floating] | Sequence[Sequence[float]]
"""Rows of numbers."""

Counts: TypeAlias = tuple[SupportsIndex, SupportsIndex] | Sequence[SupportsIndex]
"""A width and a height, or any two counts."""

Values: TypeAlias = float | FloatArray
"""A number, or an array where an argument is one."""

Cumulative: TypeAlias = Callable[[FloatArray], RealArray]
"""A distribution function."""

Boundary: TypeAlias = Literal["periodic", "finite"]
Dtype: TypeAlias = Literal["float64", "float32"] | type[np.float64] | type[np.float32]
Errors: TypeAlias = Literal["relative", "equal"] | Vector
FocusCurve: TypeAlias = Literal["equal_distance", "equal_plane"]
Phasors: TypeAlias = Literal["unit", "gaussian"]
Purpose: TypeAlias = Literal["laser", "body"]
