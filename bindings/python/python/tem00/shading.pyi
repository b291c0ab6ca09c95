from __future__ import annotations

from collections.abc import Sequence
from typing import SupportsIndex, final
import numpy as np
from numpy.typing import NDArray
from tem00._results import SpeckleShift as SpeckleShift
from tem00.beam import Light, LineProfile, NextEvent
from tem00.coherence import Spectrum
from tem00.decorrelation import RigidMotion
from tem00._typing import Counts, FloatArray, Numbers, Values, Vector, Vectors

__all__ = [
    "Camera",
    "Laser",
    "Speckle",
    "SpeckleFrame",
    "SpeckleShift",
]


@final
class Camera:
    def __new__(
        cls,
        *,
        position: Vector | None = None,
        look_at: Vector | None = None,
        up: Vector | None = None,
        focal_length: float = ...,
        f_number: float = ...,
        focus_distance: float = ...,
        pixel_pitch: float = ...,
        resolution: Counts | None = None,
        principal_point: Vector | None = None,
        tilt: Vector | None = None,
        distortion: Vector | None = None,
        depth_of_field: bool = ...,
    ) -> Camera: ...
    def ray(self, pixels: Vectors) -> tuple[FloatArray, FloatArray]: ...
    def project(self, points: Vectors) -> FloatArray: ...
    @property
    def position(self) -> FloatArray: ...
    @property
    def resolution(self) -> tuple[int, int]: ...
    @property
    def focal_length(self) -> float: ...
    @property
    def f_number(self) -> float: ...
    def __eq__(self, value: object, /) -> bool: ...
    def __ne__(self, value: object, /) -> bool: ...
    def __hash__(self) -> int: ...

@final
class Laser:
    @staticmethod
    def spot(
        wavelength: float | Spectrum,
        waist_radius: Numbers,
        *,
        origin: Vector,
        target: Vector,
        line_direction: Vector | None = None,
        power: float = ...,
        focused_at: float | None = None,
        m_squared: float = ...,
        source_half_angle: float = ...,
    ) -> Laser: ...
    @staticmethod
    def line(
        wavelength: float | Spectrum,
        thickness: float,
        fan_angle: float,
        *,
        origin: Vector,
        target: Vector,
        line_direction: Vector | None = None,
        profile: LineProfile | None = None,
        power: float = ...,
        focused_at: float | None = None,
        m_squared: float = ...,
        source_half_angle: float = ...,
    ) -> Laser: ...
    def next_event(self, points: Vectors) -> NextEvent: ...
    @property
    def light(self) -> Light: ...
    @property
    def wavelength(self) -> float: ...
    @property
    def power(self) -> float: ...
    def __eq__(self, value: object, /) -> bool: ...
    def __ne__(self, value: object, /) -> bool: ...
    def __hash__(self) -> int: ...

@final
class Speckle:
    def __new__(
        cls,
        camera: Camera,
        laser: Laser,
        seed: SupportsIndex,
        *,
        poses: Sequence[RigidMotion] | None = None,
        camera_poses: Sequence[RigidMotion] | None = None,
        laser_poses: Sequence[RigidMotion] | None = None,
        at_points: tuple[Vectors, Vectors] | Sequence[Vectors] | None = None,
        memory: SupportsIndex | None = None,
        looks: SupportsIndex | None = None,
        polarisation: float = ...,
        rms_height: float = ...,
        correlation_length: float = ...,
    ) -> Speckle: ...
    def frame(
        self,
        surface: RigidMotion | None = None,
        camera: RigidMotion | None = None,
        laser: RigidMotion | None = None,
        body: SupportsIndex | None = None,
    ) -> SpeckleFrame: ...
    def factors_since(self, previous: Vectors, points: Vectors, normals: Vectors) -> Values: ...
    @property
    def memory_bytes(self) -> int: ...
    @property
    def speckle_size(self) -> float: ...

@final
class SpeckleFrame:
    def factor(self, points: Vectors, normals: Vectors) -> Values: ...
    def factor_at(self, pixels: Vectors, points: Vectors, normals: Vectors) -> Values: ...
    def factor_in_wave(self, points: Vectors, normals: Vectors, wave: Numbers) -> Values: ...
    def average(self, points: Vectors, normals: Vectors) -> Values: ...
    def amplitude(self, points: Vectors, normals: Vectors) -> complex | NDArray[np.complex128]: ...
    def shift(self, points: Vectors, normals: Vectors) -> SpeckleShift: ...
    @property
    def side(self) -> float: ...
    @property
    def poses(self) -> tuple[RigidMotion, RigidMotion, RigidMotion]: ...
    @property
    def body(self) -> int: ...

