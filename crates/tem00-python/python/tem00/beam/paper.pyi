from collections.abc import Sequence
from typing import ClassVar, final, overload

from tem00._typing import FloatArray, Numbers, RealArray, Vector
from tem00.beam import GaussianBeam, LineLight, SpotLight

__all__ = [
    "DiscConeRay",
    "DiscConeSampler",
    "PrintedEvent",
    "PrintedFan",
    "line_next_event",
    "lost_by_cone",
    "lost_by_fan_cone",
    "modified_divergence",
    "radiance",
    "spot_next_event",
    "streamline_point",
]

_Values = float | FloatArray
_Vectors = Vector | Sequence[Sequence[float]]

@final
class DiscConeRay:
    def __new__(
        cls,
        origin: FloatArray,
        direction: FloatArray,
        pdf_position: _Values,
        pdf_direction: _Values,
    ) -> DiscConeRay: ...
    def __getnewargs__(self) -> tuple[object, ...]: ...
    @property
    def origin(self) -> FloatArray: ...
    @property
    def direction(self) -> FloatArray: ...
    @property
    def pdf_position(self) -> _Values: ...
    @property
    def pdf_direction(self) -> _Values: ...

@final
class DiscConeSampler:
    @staticmethod
    def new(beam: GaussianBeam, waist_distance: float, l: float) -> DiscConeSampler: ...
    def sample(self, u: _Vectors) -> DiscConeRay: ...
    @property
    def half_angle(self) -> float: ...
    @property
    def aperture_radius(self) -> float: ...
    def __eq__(self, value: object, /) -> bool: ...
    def __ne__(self, value: object, /) -> bool: ...
    __hash__: ClassVar[None]  # type: ignore[assignment]

@final
class PrintedEvent:
    def __new__(
        cls,
        point: FloatArray,
        distance: _Values,
        wi: FloatArray,
        radiance: _Values,
    ) -> PrintedEvent: ...
    def __getnewargs__(self) -> tuple[object, ...]: ...
    @property
    def point(self) -> FloatArray: ...
    @property
    def distance(self) -> _Values: ...
    @property
    def wi(self) -> FloatArray: ...
    @property
    def radiance(self) -> _Values: ...

@final
class PrintedFan:
    @staticmethod
    def new(focus: GaussianBeam, fan_angle: float, focus_distance: float) -> PrintedFan: ...
    @overload
    def irradiance_per_watt(self, x: float, y: float, z: float) -> float: ...
    @overload
    def irradiance_per_watt(self, x: Numbers, y: Numbers, z: Numbers) -> FloatArray: ...
    @overload
    def power_per_watt(self, z: float) -> float: ...
    @overload
    def power_per_watt(self, z: RealArray) -> FloatArray: ...
    def __eq__(self, value: object, /) -> bool: ...
    def __ne__(self, value: object, /) -> bool: ...
    __hash__: ClassVar[None]  # type: ignore[assignment]

def line_next_event(
    light: LineLight, x: Numbers, y: Numbers, z: Numbers, n: _Vectors
) -> PrintedEvent | None: ...

@overload
def lost_by_cone(l: float) -> float: ...
@overload
def lost_by_cone(l: RealArray) -> FloatArray: ...

@overload
def lost_by_fan_cone(l: float) -> float: ...
@overload
def lost_by_fan_cone(l: RealArray) -> FloatArray: ...

@overload
def modified_divergence(beam: GaussianBeam, l: float) -> float: ...
@overload
def modified_divergence(beam: GaussianBeam, l: RealArray) -> FloatArray: ...

@overload
def radiance(irradiance: float, cos_surface: float) -> float | None: ...
@overload
def radiance(irradiance: Numbers, cos_surface: Numbers) -> FloatArray | None: ...

def spot_next_event(
    light: SpotLight, x: Numbers, y: Numbers, z: Numbers, n: _Vectors
) -> PrintedEvent | None: ...

def streamline_point(
    beam: GaussianBeam, x: Numbers, y: Numbers, z: Numbers, aperture_z: Numbers
) -> FloatArray: ...
