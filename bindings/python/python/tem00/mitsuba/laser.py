"""The emitter ``laser``: a placed spot or line of ``tem00.beam`` as a Mitsuba plugin."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any, cast

import drjit as dr
import mitsuba as mi

from tem00.mitsuba.frame import draw_ray, next_event
from tem00.mitsuba.placing import frame_of, opaque, place
from tem00.mitsuba.properties import (
    read,
    read_color,
    read_to_world,
    refuse_unknown,
    refused,
    laser_spectrum,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from drjit.auto.ad import Bool, Float
    from tem00.mitsuba.frame import NextEvent

# A private flag, above those of Mitsuba: the light of this emitter is coherent.
COHERENT = 0x1000


@cache
def laser_class(variant: str) -> type[mi.Emitter]:
    """Return the class of the emitter in ``variant``, which must be the current one."""

    class Laser(mi.Emitter):
        """A laser that lights each point from one direction, that of the mean energy flow.

        Attributes
        ----------
        wavelength : float
            Wavelength, in the scene's unit of length.
        line : Spectrum or None
            Spectrum in that unit; None is light of one wavelength.
        """

        def __init__(self, props: mi.Properties) -> None:
            # All that can fail comes before the base class, which enters the emitter into the list
            # of those that kernels call.
            self.description = read(props)
            numbers = self.description.numbers
            self.numbers = {name: opaque(value) for name, value in numbers.items()}
            self.color = mi.Color3f(*read_color(props))
            self.to_world = read_to_world(props)
            refuse_unknown(props, self.description.shape)
            self._prepare()
            super().__init__(props)
            self.m_flags = int(mi.EmitterFlags.DeltaPosition) | COHERENT

        def _prepare(self) -> None:
            self.wavelength = self.description.numbers["wavelength"]
            self.law = place(self.description)
            self.line = laser_spectrum(self.description)
            self.frame = frame_of(self.to_world)
            dr.make_opaque(self.color, self.numbers)
            _check_color(self.color)

        def traverse(self, cb: mi.TraversalCallback) -> None:
            super().traverse(cb)
            cb.put("to_world", self.to_world, mi.ParamFlags.Differentiable)
            cb.put("color", self.color, mi.ParamFlags.Differentiable)
            for name, value in self.numbers.items():
                cb.put(name, value, _flags_of(name))

        def parameters_changed(self, keys: Sequence[str] = ()) -> None:
            super().parameters_changed(list(keys))
            for name in self.numbers.keys() & set(keys or self.numbers):
                self.description.numbers[name] = float(dr.detach(self.numbers[name])[0])
            self._prepare()

        def _spectrum(self, scale: Float | float, active: Bool | bool) -> mi.Spectrum:
            color = self.color if mi.is_rgb else mi.luminance(self.color)
            power = self.numbers["power"] * self.description.per_square_metre
            value = mi.UnpolarizedSpectrum(color) * (power * scale)
            return _depolarized(dr.select(active, value, 0.0))

        def sample_direction(
            self, it: mi.Interaction3f, sample: mi.Point2f, active: Bool | bool = True
        ) -> tuple[mi.DirectionSample3f, mi.Spectrum]:
            event = next_event(self.law, self.frame, it.p)
            # A density of 0 spares the shadow ray.
            active &= event.e_perp > 0.0
            ds = self._direction_sample(event)
            ds.time = it.time
            ds.pdf = dr.select(active, 1.0, 0.0)
            return ds, self._spectrum(event.e_perp, active)

        def _direction_sample(self, event: NextEvent) -> Any:
            ds: Any = dr.zeros(mi.DirectionSample3f)
            ds.p = event.point
            ds.n = self.frame.ez
            ds.d = event.wi
            ds.dist = event.distance
            ds.delta = True
            ds.emitter = mi.EmitterPtr(self)
            return ds

        def pdf_direction(
            self, it: mi.Interaction3f, ds: mi.DirectionSample3f, active: Bool | bool = True
        ) -> Float:
            return _number(0.0)

        def eval_direction(
            self, it: mi.Interaction3f, ds: mi.DirectionSample3f, active: Bool | bool = True
        ) -> mi.Spectrum:
            event = next_event(self.law, self.frame, it.p)
            return self._spectrum(event.e_perp, active & (event.e_perp > 0.0))

        def sample_ray(
            self,
            time: Float,
            sample1: Float,
            sample2: mi.Point2f,
            sample3: mi.Point2f,
            active: Bool | bool = True,
        ) -> tuple[mi.Ray3f, mi.Spectrum]:
            origin, direction = draw_ray(self.law, self.frame, sample3, sample2)
            return mi.Ray3f(origin, direction, time), self._spectrum(1.0, active)

        def sample_position(
            self, time: Float, sample: mi.Point2f, active: Bool | bool = True
        ) -> tuple[mi.PositionSample3f, Float]:
            ps: Any = dr.zeros(mi.PositionSample3f)
            ps.p = self.frame.origin
            ps.n = self.frame.ez
            ps.time = time
            ps.pdf = 1.0
            ps.delta = True
            return ps, _number(1.0)

        def pdf_position(self, ps: mi.PositionSample3f, active: Bool | bool = True) -> Float:
            return _number(0.0)

        def sample_wavelengths(
            self, si: mi.SurfaceInteraction3f, sample: Float, active: Bool | bool = True
        ) -> tuple[Any, mi.Spectrum]:
            return mi.Color0f(), self._spectrum(1.0, active)

        def eval(self, si: mi.SurfaceInteraction3f, active: Bool | bool = True) -> mi.Spectrum:
            return _depolarized(mi.UnpolarizedSpectrum(0.0))

        def bbox(self) -> mi.ScalarBoundingBox3f:
            origin = mi.ScalarPoint3f(*(dr.detach(x)[0] for x in self.frame.origin))
            return mi.ScalarBoundingBox3f(origin, origin)

        def to_string(self) -> str:
            properties = {"shape": self.description.shape, **self.description.choices}
            properties |= {name: f"{x:.7g}" for name, x in self.description.numbers.items()}
            properties["unit"] = self.description.unit
            lines = ",\n".join(f"  {name} = {value}" for name, value in properties.items())
            return f"Laser[\n{lines}\n]"

    return Laser


def _flags_of(name: str) -> mi.ParamFlags:
    flags = mi.ParamFlags
    return flags.Differentiable if name == "power" else flags.NonDifferentiable


def _number(value: float) -> Float:
    return cast("Float", mi.Float(value))


def _depolarized(value: mi.UnpolarizedSpectrum) -> mi.Spectrum:
    # The same type, but in polarised variants.
    return mi.depolarizer(cast("mi.Spectrum", value))


def _check_color(color: mi.Color3f) -> None:
    channels = [dr.detach(channel)[0] for channel in color]
    if not all(0.0 <= channel < float("inf") for channel in channels):
        raise refused("color", f"must be finite and not negative, got {channels}")
