from __future__ import annotations

from tem00 import beam as beam
from tem00 import coherence as coherence
from tem00 import decorrelation as decorrelation
from tem00 import shading as shading
from tem00 import speckle as speckle
from tem00 import statistics as statistics

__all__ = [
    "ParameterError",
    "__version__",
    "beam",
    "coherence",
    "decorrelation",
    "inspect",
    "main",
    "shading",
    "speckle",
    "statistics",
]

__version__: str

def main() -> int: ...
def inspect() -> int: ...

class ParameterError(ValueError):
    """A parameter lies outside what is allowed."""

    parameter: str
