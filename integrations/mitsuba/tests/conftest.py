"""The plugins as they are built, in the variant that they are for."""

import os
from pathlib import Path

import mitsuba as mi
import pytest

import tem00.mitsuba

FOLDER = Path(os.environ.get("TEM00_MITSUBA_PLUGINS", Path(__file__).parents[1] / "build"))


@pytest.fixture(scope="session")
def plugin_folder() -> Path:
    """The folder that holds ``plugins/laser.so`` and ``plugins/speckle.so``."""
    if not (FOLDER / "plugins" / "laser.so").exists():
        pytest.fail(f"build the plugins first: there are none in {FOLDER}")
    return FOLDER


@pytest.fixture(autouse=True)
def scalar(plugin_folder: Path) -> None:
    """Set the variant ``scalar_rgb``, in which the plugins are found."""
    mi.set_variant("scalar_rgb")
    tem00.mitsuba.register(plugin_folder)
