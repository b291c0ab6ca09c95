"""The laser light of tem00 in Mitsuba 3.

>>> import mitsuba as mi
>>> mi.set_variant("llvm_ad_rgb")
>>> import tem00.mitsuba
>>> tem00.mitsuba.register()

From then on ``<emitter type="laser">`` can stand in scenes, in every variant that is set later too.
The light is recorded into the renderer's kernels, which only the LLVM and CUDA variants have. In
``scalar_rgb`` a plugin in C++ does the same, which is built apart from this package.
"""

from __future__ import annotations

import os
from functools import cache
from pathlib import Path
from typing import Any

import mitsuba as mi
from mitsuba.detail import add_variant_callback

__all__ = ["register"]

_FOLDER_VARIABLE = "TEM00_MITSUBA_PLUGINS"


def register(plugin_folder: str | os.PathLike[str] | None = None) -> None:
    """Make the plugins known to Mitsuba, in the current variant and in those set later.

    Calling it again does no harm.

    Parameters
    ----------
    plugin_folder
        Where the C++ plugins for ``scalar_rgb`` were built: the folder that holds
        ``plugins/laser.so``. By default the value of the environment variable
        ``TEM00_MITSUBA_PLUGINS``. No other variant needs it.

    Raises
    ------
    RuntimeError
        If no variant is set, or if the current one has no plugins: a scalar one without the folder,
        or a spectral one.
    FileNotFoundError
        If the folder holds no plugins.
    """
    variant = mi.variant()
    if variant is None:
        raise RuntimeError("set a variant first, for example mitsuba.set_variant('llvm_ad_rgb')")
    folder = plugin_folder or os.environ.get(_FOLDER_VARIABLE)
    if folder is not None:
        _append(Path(folder).resolve())
    problem = _problem(variant)
    if problem:
        raise RuntimeError(problem)
    _register_in(variant)
    _follow_variants()


@cache
def _follow_variants() -> None:
    add_variant_callback(lambda _old, new: _register_in(new))


@cache
def _append(folder: Path) -> None:
    """Let Mitsuba find the C++ plugins."""
    if not any((folder / "plugins").glob("laser.*")):
        raise FileNotFoundError(f"{folder} holds no plugins/laser.so")
    # The stubs of Mitsuba do not know this function.
    file_resolver: Any = mi.file_resolver
    file_resolver().append(str(folder))
    _folders.append(folder)


_folders: list[Path] = []


def _problem(variant: str) -> str:
    """Return why a variant has no plugins; nothing if it has."""
    if "spectral" in variant:
        return f"a laser line has no spectrum to sample: use an rgb or mono variant, not {variant}"
    if variant.startswith("scalar") and not _folders:
        return (
            f"{variant} needs the C++ plugins: build integrations/mitsuba and give the folder to "
            f"tem00.mitsuba.register(plugin_folder=...) or in {_FOLDER_VARIABLE}"
        )
    return ""


def _register_in(variant: str) -> None:
    # In scalar variants Mitsuba finds the C++ plugins itself, in the folder.
    if variant.startswith("scalar") or _problem(variant):
        return
    # Needs a variant, so it cannot stand above.
    from tem00.mitsuba.laser import laser_class
    from tem00.mitsuba.speckle import speckle_class

    mi.register_emitter("laser", laser_class(variant))
    mi.register_integrator("speckle", speckle_class(variant))
