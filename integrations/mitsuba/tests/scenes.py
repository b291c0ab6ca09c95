"""A plate before a camera, in metres and watts."""

from typing import Any

import mitsuba as mi
import numpy as np
import numpy.typing as npt

Scene = dict[str, Any]
Image = npt.NDArray[np.float64]

WAVELENGTH = 650e-9
POWER = 5e-3
REFLECTANCE = 0.8
FOV = 5.0
"""Full horizontal field of view, in degrees."""
DISTANCE = 0.3
"""From the camera to the plate."""
WIDTH, HEIGHT = 48, 32


def looking(origin: list[float], target: list[float], up: list[float]) -> Any:
    """Return a frame at `origin` that looks at `target`."""
    return mi.ScalarTransform4f().look_at(origin, target, up)


def spot(**changes: Any) -> Scene:
    """Return a laser 30° from the normal of the plate, whose spot is wider than the picture."""
    return {
        "type": "laser",
        "wavelength": WAVELENGTH,
        "power": POWER,
        "waist_radius": 20e-3,
        "to_world": looking([0.1, 0, 0.1732], [0, 0, 0], [0, 1, 0]),
    } | changes


def camera(kind: str = "perspective", samples: int = 1, **changes: Any) -> Scene:
    """Return a camera that looks down on the plate, x to the right and y up."""
    film = {
        "type": "hdrfilm",
        "width": WIDTH,
        "height": HEIGHT,
        "rfilter": {"type": "box"},
        "component_format": "float32",
    }
    return {
        "type": kind,
        "fov": FOV,
        "near_clip": 0.01,
        "to_world": looking([0, 0, DISTANCE], [0, 0, 0], [0, 1, 0]),
        "film": film | changes.pop("film", {}),
        "sampler": {"type": "independent", "sample_count": samples},
    } | changes


def plate() -> Scene:
    """Return a white plate in the plane z = 0, 0.2 m wide."""
    reflectance = {"type": "rgb", "value": REFLECTANCE}
    return {
        "type": "rectangle",
        "to_world": mi.ScalarTransform4f().scale(0.1),
        "bsdf": {"type": "diffuse", "reflectance": reflectance},
    }


def scene(integrator: Scene, **parts: Any) -> Any:
    """Return the plate under a laser, unless `parts` says otherwise."""
    standard: Scene = {"sensor": camera(), "plate": plate(), "laser": spot()}
    described = {"type": "scene", "integrator": integrator} | standard | parts
    return mi.load_dict({name: part for name, part in described.items() if part is not None})


def render(integrator: Scene, seed: int = 0, **parts: Any) -> Image:
    """Return the first channel of a picture, [row, column], in W/(m² sr)."""
    picture: Image = np.array(mi.render(scene(integrator, **parts), seed=mi.UInt32(seed)))
    return picture[:, :, 0].astype(float)
