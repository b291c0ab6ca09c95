"""The integrator ``speckle``: paths whose light carries the speckle of its laser."""

from __future__ import annotations

from functools import cache
from math import isfinite, radians, tan
from typing import TYPE_CHECKING, Any, NoReturn

import drjit as dr
import mitsuba as mi

from tem00.mitsuba.film import Exposure
from tem00.mitsuba.laser import COHERENT
from tem00.mitsuba.linewidth import find_lights
from tem00.mitsuba.patterns import Pattern, generate
from tem00.mitsuba.speckle_settings import (
    PatternSettings,
    flag,
    refuse_unknown,
    refused,
    whole,
)
from tem00.mitsuba.surfaces import MOTION, read_surfaces, surface_finder
from tem00.mitsuba.transport import PathTracer

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from tem00._typing import Vector
    from tem00.mitsuba.linewidth import LineLight
    from tem00.mitsuba.surfaces import Surface
    from tem00.mitsuba.transport import Factor
    from tem00.shading import SpeckleFrame
    from tem00._typing import Vector

_ENDLESS = 2**32 - 1


@cache
def speckle_class(variant: str) -> type[mi.Integrator]:
    """Return the class of the integrator in ``variant``, which must be the current one."""

    class Speckle(mi.SamplingIntegrator):
        """A path tracer that multiplies the light of lasers by their speckle.

        Light of an emitter with the private flag bit 0x1000 is multiplied by the intensity of the
        laser's pattern at the place of the camera sample on the film, however many surfaces it
        meets: of one wavelength, it interferes all the same. The pattern is that of the surface
        that is seen. All other light is left alone.
        """

        def __init__(self, props: mi.Properties) -> None:
            super().__init__(props)
            if mi.is_polarized:
                raise RuntimeError(f"speckle: does not follow polarisation, as {variant} asks")
            depth = whole(props, "max_depth", -1, (-1, _ENDLESS))
            self.max_depth = _ENDLESS if depth == -1 else depth
            self.rr_depth = whole(props, "rr_depth", 5, (1, _ENDLESS))
            self.speckle = flag(props, "speckle", True)
            self.hidden = flag(props, "hide_emitters", False)
            self.settings = PatternSettings.read(props)
            self.surfaces, self.places = read_surfaces(props)
            refuse_unknown(props)
            self._made_for: object = None
            self._patterns: list[list[Pattern]] = []

        def traverse(self, cb: mi.TraversalCallback) -> None:
            super().traverse(cb)
            for name, value in self.places.items():
                cb.put(name, value, mi.ParamFlags.NonDifferentiable)

        def parameters_changed(self, keys: Sequence[str] = ()) -> None:
            super().parameters_changed(list(keys))
            for surface in self.surfaces:
                self._place(surface)

        def move(
            self, frame: SpeckleFrame, point: Vector, normal: Vector, shape: str = ""
        ) -> None:
            """Show the speckle of a ``tem00.Speckle`` frame as it has moved at a surface point.

            The point, in metres, and the unit normal are those of now. ``shape`` is the id of a
            shape with a motion of its own; without it all others move.
            """
            prefix = f"{shape}:" if shape else ""
            if not any(
                own.prefix == prefix and bool(own.motion) == bool(shape) for own in self.surfaces
            ):
                raise refused(
                    shape,
                    f"has no motion of its own: give the integrator a property {prefix}{MOTION[0]}",
                )
            shift: Any = frame.shift(point, normal)
            # What has left the pupil is new, however far it has gone.
            pupil = frame.side * min(shift.pupil, _ENDLESS)
            places = {
                prefix + name: mi.Float(float(value))
                for name, value in zip(MOTION, (pupil, *shift.displacement), strict=True)
            }
            self.places = {**places, **self.places}
            mi.traverse(self).update(places)

        def _place(self, surface: Surface) -> tuple[float, tuple[float, float]]:
            """Return the place of a surface; what it does not say is that of all others."""
            values = []
            for name in MOTION:
                own = surface.prefix + name
                given = own if own in self.places else name
                values.append(float(self.places[given][0]))
                if not isfinite(values[-1]):
                    raise refused(given, f"must be a finite number, got {values[-1]}")
            return values[0], (values[1], values[2])

        def render(
            self,
            scene: mi.Scene,
            sensor: int | mi.Sensor = 0,
            seed: int = 0,
            spp: int = 0,
            develop: bool = True,
            evaluate: bool = True,
        ) -> mi.TensorXf:
            if isinstance(sensor, int):
                sensor = scene.sensors()[sensor]
            exposure = Exposure(sensor, seed, spp)
            factor = self._factor(scene, sensor) if self.speckle else None
            for rays in exposure.passes():
                tracer = PathTracer(
                    scene=scene,
                    factor=factor and factor(rays.film),
                    max_depth=self.max_depth,
                    rr_depth=self.rr_depth,
                    meets_light=any(_can_be_met(emitter) for emitter in scene.emitters()),
                    first_surface=self.skip_area_emitters if self.hidden else None,
                    surface_of=surface_finder(self.surfaces, scene) if self.speckle else None,
                )
                walk = tracer.trace(exposure.sampler, rays.ray)
                exposure.add(rays, walk.radiance, walk.hit)
            return exposure.finish(develop, evaluate)

        def sample(self, *arguments: object, **named: object) -> NoReturn:
            """Refuse to serve another integrator: a ray does not say where it meets the film."""
            raise RuntimeError(
                "speckle: cannot stand inside another integrator, such as `aov` or `moment`: it "
                "must know where on the film each ray arrives; render the two one after the other"
            )

        def _factor(self, scene: mi.Scene, sensor: mi.Sensor) -> Callable[[mi.Point2f], Factor]:
            """Return the factor on light from an emitter, for camera samples on the film."""
            lasers = lasers_of(scene)
            alone = len(scene.emitters()) == 1
            lights = find_lights(scene, sensor, lasers, self.surfaces)
            patterns = self._patterns_for(lasers, sensor, lights)

            def at(film: mi.Point2f) -> Factor:
                def factor(
                    emitter: mi.EmitterPtr, seen: mi.UInt32, active: mi.Bool
                ) -> mi.Float:
                    product = mi.Float(1.0)
                    for laser, of_surfaces in zip(lasers, patterns, strict=True):
                        own = active if alone else active & (emitter == mi.EmitterPtr(laser))
                        for index, pattern in enumerate(of_surfaces):
                            chosen = own & (seen == index) if len(of_surfaces) > 1 else own
                            product = dr.select(chosen, pattern.factor(film), product)
                    return product

                return factor

            return at

        def _patterns_for(
            self,
            lasers: list[mi.Emitter],
            sensor: mi.Sensor,
            lights: list[list[LineLight | None]],
        ) -> list[list[Pattern]]:
            """Return the patterns of each laser on the surfaces.

            They are those of the last image where nothing has changed.
            """
            width, height = (int(side) for side in sensor.film().size())
            given = self.settings.speckle_size
            sizes = [given or speckle_size(laser, sensor) for laser in lasers]
            needs = (sizes, width, height, lights)
            if self._made_for != needs:
                self._patterns = generate(
                    self.settings, sizes, (width, height), self.surfaces, lights
                )
                self._made_for = needs
            for number, surface in enumerate(self.surfaces):
                place = self._place(surface)
                for of_surfaces in self._patterns:
                    of_surfaces[number].move_to(*place)
            return self._patterns

        def to_string(self) -> str:
            lines = [f"max_depth = {self.max_depth}", f"speckle = {self.speckle}"]
            lines += [f"{name} = {value}" for name, value in vars(self.settings).items()]
            return "Speckle[\n  " + ",\n  ".join(lines) + "\n]"

    return Speckle


def lasers_of(scene: mi.Scene) -> list[mi.Emitter]:
    """Return the lasers of a scene, in the order in which its dictionary or XML describes them."""
    return [emitter for emitter in scene.emitters() if emitter.flags() & COHERENT]


def speckle_size(laser: mi.Emitter, sensor: mi.Sensor) -> float:
    """Return the speckle size of a laser on the sensor of a thin lens, in pixels.

    ::

        h = wavelength / D * d_PI / pitch        d_PI / pitch = (width / 2) / tan(x_fov / 2)

    Raises
    ------
    tem00.ParameterError
        If the sensor has no lens or the emitter no wavelength.
    """
    lens = mi.traverse(sensor)
    wavelength: float | None = getattr(laser, "wavelength", None)
    if "aperture_radius" not in lens or "x_fov" not in lens:
        raise refused("speckle_size", "required, as the sensor is no `thinlens` that determines it")
    if wavelength is None:
        raise refused("speckle_size", f"required, as {laser.class_name()} has no wavelength")
    diameter = 2.0 * float(dr.slice(lens["aperture_radius"]))
    half_width = 0.5 * float(sensor.film().size()[0])
    distance = half_width / tan(0.5 * radians(float(dr.slice(lens["x_fov"]))))
    return wavelength / diameter * distance


def _can_be_met(emitter: mi.Emitter) -> bool:
    """Tell whether a ray can meet the light of an emitter by chance."""
    return not emitter.flags() & int(mi.EmitterFlags.Delta)
