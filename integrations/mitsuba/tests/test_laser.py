"""The emitter `laser` against closed forms, the library and Mitsuba's own light transport."""

from typing import Any

import mitsuba as mi
import numpy as np
import numpy.typing as npt
import pytest
import scenes
from scenes import POWER, WAVELENGTH, Scene

Array = npt.NDArray[np.float64]

ROUNDING = 2.0**-23
"""Relative error of a result that has been rounded to single precision, twice over."""


def line(**changes: Any) -> Scene:
    """Return a laser line along x, 0.2 m above the plate."""
    return {
        "type": "laser",
        "shape": "line",
        "wavelength": WAVELENGTH,
        "power": POWER,
        "fan_angle": 30.0,
        "thickness": 0.4e-3,
        "focus_distance": 0.2,
        "to_world": scenes.looking([0, 0.1, 0.1732], [0, 0, 0], [0, 0.866, -0.5]),
    } | changes


def frame(laser: Any) -> tuple[Array, Array]:
    """Return the origin of a laser, and its axes as the rows of a matrix."""
    matrix = np.array(mi.traverse(laser)["to_world"].matrix, dtype=float)
    return matrix[:3, 3], matrix[:3, :3].T


def events(laser: Any, points: Array) -> tuple[Array, Array, Array]:
    """Return the irradiance across the light, the direction to it and the distance at points."""
    interaction = mi.SurfaceInteraction3f()
    drawn = []
    for point in points:
        interaction.p = point
        drawn.append(laser.sample_direction(interaction, [0.5, 0.5]))
    e_perp = np.array([weight[0] if sample.pdf > 0 else 0.0 for sample, weight in drawn])
    direction = np.array([np.array(sample.d) for sample, _ in drawn], dtype=float)
    distance = np.array([sample.dist for sample, _ in drawn])
    return e_perp, direction, distance


def points_in(laser: Any, half_width: list[float], seed: int = 1) -> Array:
    """Return random points 0.05 to 0.35 m before the laser, exact in single precision."""
    rng = np.random.default_rng(seed)
    origin, axes = frame(laser)
    along = rng.uniform(0.05, 0.35, 300)
    across = rng.uniform(-1, 1, (300, 2)) * half_width
    local = np.column_stack([across, along])
    return (origin + local @ axes).astype(np.float32).astype(float)


@pytest.mark.parametrize(
    ("properties", "axes_of_beam"),
    [
        ({"waist_radius": 0.4e-3}, [(0.4e-3, 0.0, 1.0)] * 2),
        ({"waist_radius": 50e-6, "waist_distance": 0.2, "m_squared": 1.3},
         [(50e-6, 0.2, 1.3)] * 2),
        ({"waist_radius": 60e-6, "waist_distance": 0.15, "waist_radius_y": 0.3e-3,
          "waist_distance_y": 0.25, "m_squared_y": 2.0},
         [(60e-6, 0.15, 1.0), (0.3e-3, 0.25, 2.0)]),
    ],
)
def test_a_spot_is_a_gaussian_beam(
    properties: Scene, axes_of_beam: list[tuple[float, float, float]]
) -> None:
    laser = mi.load_dict(scenes.spot(**properties))
    points = points_in(laser, [1e-3, 1e-3])
    origin, axes = frame(laser)
    x, y, z = ((points - origin) @ axes.T).T

    # Siegman 1986, ch. 17: w² = w0² + θ² (z − z0)², and the flux follows the wavefront.
    peak, slopes = 2 * POWER / np.pi, []
    exponent = np.zeros_like(z)
    for across, (waist, z0, quality) in zip((x, y), axes_of_beam, strict=True):
        divergence = quality * WAVELENGTH / (np.pi * waist)
        squared = waist**2 + (divergence * (z - z0)) ** 2
        peak = peak / np.sqrt(squared)
        exponent -= 2 * across**2 / squared
        slopes.append(across * divergence**2 * (z - z0) / squared)
    secant = np.sqrt(1 + slopes[0] ** 2 + slopes[1] ** 2)
    flux = peak * np.exp(exponent) * secant
    toward = -np.column_stack([slopes[0], slopes[1], np.ones_like(z)]) / secant[:, None]

    e_perp, direction, distance = events(laser, points)
    lit = e_perp > 0
    # The cut-off lies at four radii, beyond which e⁻³² is left.
    assert np.all(flux[~lit] <= peak[~lit] * np.exp(-31.9))
    assert np.count_nonzero(lit) > 100
    # The axes of the frame are rounded to 6e-8, their error times the distance shifts the beam.
    np.testing.assert_allclose(e_perp[lit], flux[lit], rtol=1e-3)
    np.testing.assert_allclose(direction[lit], (toward @ axes)[lit], atol=4 * ROUNDING)
    np.testing.assert_allclose(distance[lit], (z * secant)[lit], rtol=4 * ROUNDING)


@pytest.mark.parametrize("tilt", [0.0, 40.0, 75.0])
@pytest.mark.parametrize("shape", ["spot", "line"])
def test_a_plane_receives_the_power_whatever_its_tilt(shape: str, tilt: float) -> None:
    upright = scenes.looking([0, 0, 0.2], [0, 0, 0], [0, 1, 0])
    described = {
        "spot": scenes.spot(to_world=upright, waist_radius=0.5e-3, waist_distance=0.1),
        "line": line(to_world=upright, thickness=1e-3),
    }[shape]
    laser = mi.load_dict(described)
    # The rule of rectangles on a Gaussian is exact to e^(−π² w² / (2 h²)): w / h is 1.9 and more.
    half_x, half_y, count_x, count_y = {"spot": (3e-3, 3e-3, 60, 60),
                                        "line": (0.16, 2.5e-3, 40, 60)}[shape]
    cos, sin = np.cos(np.radians(tilt)), np.sin(np.radians(tilt))
    # The plane is turned about x, along the line: what falls on it is longer by 1 / cos across.
    u = (np.arange(count_x) + 0.5) / count_x * 2 * half_x - half_x
    v = ((np.arange(count_y) + 0.5) / count_y * 2 * half_y - half_y) / cos
    grid_u, grid_v = (values.ravel() for values in np.meshgrid(u, v))
    points = np.column_stack([grid_u, grid_v * cos, grid_v * sin])
    e_perp, direction, _ = events(laser, points)
    received = np.sum(e_perp * (direction @ [0, -sin, cos])) * (u[1] - u[0]) * (v[1] - v[0])
    print("DEV", received / POWER - 1)
    assert received == pytest.approx(POWER, rel=1e-4)
