from __future__ import annotations

from typing import Final

__all__ = [
    "C_HEADER",
    "WGSL",
]

WGSL: Final[str]
C_HEADER: Final[str]
