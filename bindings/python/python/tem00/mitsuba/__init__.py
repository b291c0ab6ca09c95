"""The laser light of tem00 in Mitsuba 3.

>>> import mitsuba as mi
>>> mi.set_variant("llvm_ad_rgb")
>>> import tem00.mitsuba
>>> tem00.mitsuba.register()

From then on ``<emitter type="laser">`` can stand in scenes, in every variant that is set later too.
The light is recorded into the renderer's kernels, which only the LLVM and CUDA variants have.
"""

from __future__ import annotations

from functools import cache

import mitsuba as mi
from mitsuba.detail import add_variant_callback

__all__ = ["register"]


def register() -> None:
    """Make the plugins known to Mitsuba, in the current variant and in those set later.

    Calling it again does no harm.

    Raises
    ------
    RuntimeError
        If no variant is set, or if the current one, scalar or spectral, has no plugins.
    """
    variant = mi.variant()
    if variant is None:
        raise RuntimeError("set a variant first, for example mitsuba.set_variant('llvm_ad_rgb')")
    problem = _problem(variant)
    if problem:
        raise RuntimeError(problem)
    _register_in(variant)
    _follow_variants()


@cache
def _follow_variants() -> None:
    add_variant_callback(lambda _old, new: _register_in(new))


def _problem(variant: str) -> str:
    """Return why a variant has no plugins; nothing if it has."""
    if "spectral" in variant:
        return f"a laser line has no spectrum to sample: use an rgb or mono variant, not {variant}"
    if variant.startswith("scalar"):
        return (
            f"the light is recorded into kernels, which {variant} has not: "
            "use an LLVM or CUDA variant, for example llvm_ad_rgb"
        )
    return ""


def _register_in(variant: str) -> None:
    if _problem(variant):
        return
    # Needs a variant, so it cannot stand above.
    from tem00.mitsuba.laser import laser_class
    from tem00.mitsuba.speckle import speckle_class

    mi.register_emitter("laser", laser_class(variant))
    mi.register_integrator("speckle", speckle_class(variant))
