"""Paths from the camera, with a factor on the light of some emitters."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import drjit as dr
import mitsuba as mi

if TYPE_CHECKING:
    from collections.abc import Callable

    # The factor on light from an emitter, where active, by the number of the surface that is seen.
    Factor = Callable[[mi.EmitterPtr, mi.UInt32, mi.Bool], mi.Float]
    # The number of the surface that rays have met.
    SurfaceOf = Callable[[mi.SurfaceInteraction3f], mi.UInt32]
    # The first surface along rays that is no emitter: scene, rays, whether coherent, active.
    FirstSurface = Callable[[mi.Scene, mi.Ray3f, bool, mi.Bool], mi.PreliminaryIntersection3f]


@dataclass
class Walk:
    """Paths on their way, side by side.

    ``depth`` counts the surfaces met and ``eta`` is the product of the refractive indices passed.
    ``previous`` is the point that the ray left and ``pdf`` the density of its direction, per
    steradian, where it was not ``specular``. ``seen`` is the number of the surface that has
    scattered the light into the camera, once it is ``known``: mirrors before it show it.
    """

    ray: mi.Ray3f
    radiance: mi.Spectrum
    throughput: mi.Spectrum
    eta: mi.Float
    depth: mi.UInt32
    specular: mi.Bool
    pdf: mi.Float
    previous: mi.Interaction3f
    seen: mi.UInt32
    known: mi.Bool
    hit: mi.Bool
    active: mi.Bool

    @classmethod
    def from_camera(cls, ray: mi.Ray3f) -> Walk:
        """Start along camera rays."""
        return cls(
            ray=mi.Ray3f(ray),
            radiance=mi.Spectrum(0.0),
            throughput=mi.Spectrum(1.0),
            eta=mi.Float(1.0),
            depth=mi.UInt32(0),
            specular=mi.Bool(True),
            pdf=mi.Float(1.0),
            previous=dr.zeros(mi.Interaction3f),
            seen=mi.UInt32(0),
            known=mi.Bool(False),
            hit=mi.Bool(False),
            active=mi.Bool(True),
        )


class PathTracer(NamedTuple):
    """The rules by which paths are followed.

    Depths count as in Mitsuba's ``path``: the segments between camera and emitter, 2 for direct
    light. ``surface_of`` numbers the surfaces that are told apart. ``meets_light`` says that rays
    can meet emitters, which delta emitters are not. ``first_surface`` finds what the camera sees
    where emitters are hidden from it.
    """

    scene: mi.Scene
    factor: Factor | None
    max_depth: int
    rr_depth: int
    meets_light: bool
    first_surface: FirstSurface | None
    surface_of: SurfaceOf | None

    def trace(self, sampler: mi.Sampler, ray: mi.Ray3f) -> Walk:
        """Follow paths to their ends."""
        walk = Walk.from_camera(ray)
        if self.max_depth == 2 and not self.meets_light:
            si = self._arrive(walk)
            self._connect(walk, si, sampler)
            return walk
        end: Walk = self._walk(walk, sampler)
        return end

    @dr.syntax
    def _walk(self, walk: Walk, sampler: mi.Sampler) -> Walk:
        while walk.active:
            si = self._arrive(walk)
            if dr.hint(self.meets_light, mode="scalar"):
                self._take_emission(walk, si)
            walk.active &= si.is_valid() & (walk.depth + 1 < self.max_depth)
            self._connect(walk, si, sampler)
            self._scatter(walk, si, sampler)
        return walk

    def _arrive(self, walk: Walk) -> mi.SurfaceInteraction3f:
        """Find the surfaces that the rays meet."""
        at_camera = walk.depth == 0
        hidden = walk.active & at_camera if self.first_surface else mi.Bool(False)
        pi = self.scene.ray_intersect_preliminary(
            walk.ray, coherent=at_camera, active=walk.active & ~hidden
        )
        if self.first_surface:
            pi = dr.select(hidden, self.first_surface(self.scene, walk.ray, True, hidden), pi)
        si = pi.compute_surface_interaction(walk.ray, mi.RayFlags.All, walk.active)
        walk.hit |= walk.active & si.is_valid()
        return si

    def _take_emission(self, walk: Walk, si: mi.SurfaceInteraction3f) -> None:
        """Add the light of emitters that rays meet by chance."""
        emitter = si.emitter(self.scene)
        active = walk.active & (emitter != None)  # noqa: E711
        if self.first_surface:
            active &= walk.depth > 0
        ds = mi.DirectionSample3f(self.scene, si, walk.previous)
        by_chance = active & ~walk.specular
        by_event = self.scene.pdf_emitter_direction(walk.previous, ds, by_chance)
        weight = dr.select(by_chance, _power_heuristic(walk.pdf, by_event), 1.0)
        walk.radiance += walk.throughput * emitter.eval(si, active) * weight

    def _connect(
        self, walk: Walk, si: mi.SurfaceInteraction3f, sampler: mi.Sampler
    ) -> None:
        """Add the light of an emitter at the surfaces: next event."""
        bsdf = si.bsdf()
        rough = walk.active & si.is_valid() & mi.has_flag(bsdf.flags(), mi.BSDFFlags.Smooth)
        ds, light = self.scene.sample_emitter_direction(si, sampler.next_2d(), True, rough)
        lit = rough & (ds.pdf != 0.0)
        wo = si.to_local(ds.d)
        if self.meets_light:
            value, pdf = bsdf.eval_pdf(mi.BSDFContext(), si, wo, lit)
            light *= dr.select(ds.delta, 1.0, _power_heuristic(ds.pdf, pdf))
        else:
            value = bsdf.eval(mi.BSDFContext(), si, wo, lit)
        if self.factor is not None:
            light *= self.factor(ds.emitter, self._seen(walk, si), lit)
        walk.radiance += dr.select(lit, walk.throughput * value * light, 0.0)

    def _seen(self, walk: Walk, si: mi.SurfaceInteraction3f) -> mi.UInt32:
        """Return the number of the surface that is seen if these scatter."""
        if self.surface_of is None:
            return walk.seen
        return dr.select(walk.known, walk.seen, self.surface_of(si))

    def _scatter(
        self, walk: Walk, si: mi.SurfaceInteraction3f, sampler: mi.Sampler
    ) -> None:
        """Send the paths on in directions drawn from the materials, or end them."""
        sample, weight = si.bsdf().sample(
            mi.BSDFContext(), si, sampler.next_1d(), sampler.next_2d(), walk.active
        )
        walk.throughput *= weight
        walk.eta *= sample.eta
        walk.specular = mi.has_flag(sample.sampled_type, mi.BSDFFlags.Delta)
        walk.seen = self._seen(walk, si)
        walk.known |= ~walk.specular
        walk.pdf = sample.pdf
        walk.previous = mi.Interaction3f(si)
        walk.ray = si.spawn_ray(si.to_world(sample.wo))
        walk.depth[si.is_valid()] += 1
        walk.active &= dr.any(walk.throughput != 0.0)
        self._end_by_chance(walk, sampler)

    def _end_by_chance(self, walk: Walk, sampler: mi.Sampler) -> None:
        """End long and dark paths without bias; glass makes a path dark only for a while."""
        power = dr.max(walk.throughput) * walk.eta * walk.eta
        # Not `dr.minimum`, which LLVM 19 fails to compile here.
        survival = dr.select(power < 0.95, power, 0.95)
        chance = sampler.next_1d()
        tested = walk.active & (walk.depth >= self.rr_depth)
        walk.throughput[tested] = walk.throughput / survival
        walk.active &= ~tested | (chance < survival)


def _power_heuristic(own: mi.Float, other: mi.Float) -> mi.Float:
    """Return the weight of the first of two ways to find light: the power heuristic, exponent 2."""
    square = own * own
    total = square + other * other
    return dr.select(total > 0.0, square / total, 0.0)
