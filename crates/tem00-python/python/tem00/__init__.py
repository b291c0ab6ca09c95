"""Physics of laser light: Gaussian beams, laser lines, speckle and its decorrelation.

All quantities are in SI units and radians. Arguments that may be arrays broadcast together as in
NumPy; numbers give numbers, arrays give arrays of the common shape.
"""

import sys

from tem00 import _tem00
from tem00._tem00 import (
    ParameterError,
    __version__,
    beam,
    decorrelation,
    speckle,
    statistics,
)

for _module in (beam, decorrelation, speckle, statistics):
    sys.modules[f"tem00.{_module.__name__.rsplit('.', 1)[-1]}"] = _module

__all__ = [
    "ParameterError",
    "__version__",
    "beam",
    "decorrelation",
    "speckle",
    "statistics",
]
