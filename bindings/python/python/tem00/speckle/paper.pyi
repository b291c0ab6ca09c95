from typing import SupportsIndex, final, overload

from tem00._typing import FloatArray, Numbers

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
        self, x: Numbers, y: Numbers, u: Numbers
    ) -> FloatArray: ...
    @overload
    def contrast_between_samples(self, fx: float, fy: float) -> float: ...
    @overload
    def contrast_between_samples(
        self, fx: Numbers, fy: Numbers
    ) -> FloatArray: ...
    @overload
    def contrast_between_slices(self, index: SupportsIndex, f: float) -> float: ...
    @overload
    def contrast_between_slices(
        self, index: SupportsIndex, f: Numbers
    ) -> FloatArray: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
