"""The plugins as they are built, in the variant that they are for."""

import os
from pathlib import Path

import mitsuba as mi
import pytest

FOLDER = Path(os.environ.get("TEM00_MITSUBA_PLUGINS", Path(__file__).parents[1] / "build"))


@pytest.fixture(scope="session")
def plugin_folder() -> Path:
    """The folder that holds ``plugins/laser.so`` and ``plugins/speckle.so``."""
    if not (FOLDER / "plugins" / "laser.so").exists():
        pytest.fail(f"build the plugins first: there are none in {FOLDER}")
    return FOLDER


@pytest.fixture(autouse=True)
def scalar(plugin_folder: Path) -> None:
    """Set the variant ``scalar_rgb`` and let Mitsuba find the plugins."""
    mi.set_variant("scalar_rgb")
    if str(plugin_folder) not in map(str, mi.file_resolver()):
        mi.file_resolver().append(str(plugin_folder))
