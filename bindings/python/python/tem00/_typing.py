"""Types of arguments and results, for annotations."""

from collections.abc import Sequence
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

FloatArray: TypeAlias = NDArray[np.float64]
"""What functions of numbers return for arrays."""

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

Triple: TypeAlias = tuple[Numbers, Numbers, Numbers] | Sequence[Numbers] | FloatArray
"""Three numbers, or three arrays."""

ComplexArray: TypeAlias = NDArray[np.complexfloating] | NDArray[np.floating]
"""An array of complex numbers."""
