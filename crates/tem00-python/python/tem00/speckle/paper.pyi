from typing import SupportsIndex, final, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import PupilField

__all__ = [
    "BilinearStack",
]

@final
class BilinearStack:
    @staticmethod
    def generate(field: PupilField, half_period: SupportsIndex) -> BilinearStack: ...
    @property
    def slice_count(self) -> int: ...
    @property
    def size(self) -> tuple[int, int]: ...
    @overload
    def intensity_at(self, x: float, y: float, u: float) -> float: ...
    @overload
    def intensity_at(
        self, x: ArrayLike, y: ArrayLike, u: ArrayLike
    ) -> NDArray[np.float64]: ...
    @overload
    def contrast_between_samples(self, fx: float, fy: float) -> float: ...
    @overload
    def contrast_between_samples(
        self, fx: ArrayLike, fy: ArrayLike
    ) -> NDArray[np.float64]: ...
    @overload
    def contrast_between_slices(self, index: SupportsIndex, f: float) -> float: ...
    @overload
    def contrast_between_slices(
        self, index: SupportsIndex, f: ArrayLike
    ) -> NDArray[np.float64]: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
