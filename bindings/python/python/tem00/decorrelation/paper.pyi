from typing import ClassVar, final, overload

from tem00._typing import FloatArray, Numbers, Pair, Vector
from tem00.decorrelation import CameraFrame, ImagingGeometry

__all__ = [
    "Emitter",
    "EulerAngles",
    "axial_decorrelation_length",
    "image_displacement",
    "pattern_coordinate",
    "pupil_displacement",
    "relative_pupil_displacement",
    "slice_coordinate",
]

def image_displacement(magnification: float, angles: EulerAngles, a: Vector) -> FloatArray: ...
def pupil_displacement(
    angles: EulerAngles, emitter: Emitter, surface_to_pupil: float, a: Vector
) -> FloatArray | None: ...
def relative_pupil_displacement(camera: Vector, surface: Vector) -> FloatArray: ...
def axial_decorrelation_length(geometry: ImagingGeometry) -> float: ...
@overload
def slice_coordinate(
    geometry: ImagingGeometry,
    pupil_displacement: tuple[float, float],
    axial_displacement: float,
    half_period: int,
) -> float: ...
@overload
def slice_coordinate(
    geometry: ImagingGeometry,
    pupil_displacement: Pair,
    axial_displacement: Numbers,
    half_period: int,
) -> FloatArray: ...
@overload
def pattern_coordinate(
    geometry: ImagingGeometry,
    pixel: tuple[float, float],
    image_displacement: tuple[float, float],
    pattern_speckle_size: float,
) -> list[float]: ...
@overload
def pattern_coordinate(
    geometry: ImagingGeometry,
    pixel: Pair,
    image_displacement: Pair,
    pattern_speckle_size: float,
) -> list[FloatArray]: ...

@final
class EulerAngles:
    def __new__(cls, *, q1: float, q2: float) -> EulerAngles: ...
    @staticmethod
    def between(camera: CameraFrame, normal: Vector) -> tuple[FloatArray, EulerAngles]: ...
    @property
    def q1(self) -> float: ...
    @property
    def q2(self) -> float: ...
    @property
    def camera_axes(self) -> FloatArray: ...
    def __eq__(self, value: object, /) -> bool: ...
    def __ne__(self, value: object, /) -> bool: ...
    __hash__: ClassVar[None]  # type: ignore[assignment]

@final
class Emitter:
    def __new__(cls, *, direction: Vector, distance: float) -> Emitter: ...
    @property
    def direction(self) -> FloatArray: ...
    @property
    def distance(self) -> float: ...
    def __eq__(self, value: object, /) -> bool: ...
    def __ne__(self, value: object, /) -> bool: ...
    __hash__: ClassVar[None]  # type: ignore[assignment]
