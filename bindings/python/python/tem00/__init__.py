"""Physics of laser light: Gaussian beams, laser lines, speckle and its decorrelation.

All quantities are in SI units and radians. Arguments that may be arrays broadcast together as in
NumPy; numbers give numbers, arrays give arrays of the common shape.
"""

import sys
from importlib.machinery import ModuleSpec
from types import BuiltinFunctionType, ModuleType

from tem00 import _tem00
from tem00._tem00 import (
    ParameterError,
    __version__,
    beam,
    coherence,
    decorrelation,
    shading,
    speckle,
    statistics,
)


def _register(module: ModuleType, name: str) -> None:
    """Make a module of the extension, and what is inside, importable under a name."""
    module.__name__ = name
    # Tools that look a module up by its name ask for how it was found.
    module.__spec__ = ModuleSpec(name, None)
    sys.modules[name] = module
    for short, inner in list(vars(module).items()):
        if isinstance(inner, ModuleType):
            _register(inner, f"{name}.{short}")
        elif isinstance(inner, BuiltinFunctionType):
            inner.__module__ = name


for _short in ("beam", "coherence", "decorrelation", "shading", "speckle", "statistics"):
    _register(getattr(_tem00, _short), f"tem00.{_short}")

Camera = shading.Camera
Laser = shading.Laser
Pose = decorrelation.RigidMotion
Speckle = shading.Speckle

__all__ = [
    "Camera",
    "Laser",
    "ParameterError",
    "Pose",
    "Speckle",
    "__version__",
    "beam",
    "coherence",
    "decorrelation",
    "shading",
    "speckle",
    "statistics",
]


def __dir__() -> list[str]:
    return __all__
