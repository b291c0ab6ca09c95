"""Nanoseconds per point for the irradiance of a laser spot with NumPy.

The light, the points and their number are those of benches/beam.rs.
"""

import math
import platform
import statistics
import time

import numpy as np

POINTS = 4_096
POWER = 5e-3
WAVELENGTH = 650e-9
WAIST_RADIUS = 50e-6
WAIST_DISTANCE = 0.15
CUTOFF = 4.0


def frame():
    """Returns the origin and the axes x, y, z of the light."""
    ez = np.array([0.3, -0.5, 0.8])
    ez /= np.linalg.norm(ez)
    ey = np.cross(ez, [1.0, 0.2, 0.1])
    ey /= np.linalg.norm(ey)
    return np.array([0.1, -0.2, 0.3]), np.cross(ey, ez), ey, ez


def points():
    """Returns the coordinates x, y, z of the points, each in an array of its own."""
    origin, ex, ey, ez = frame()
    i = np.arange(POINTS)[:, None]

    def spread(step):
        return i * step % 1.0 - 0.5

    local = 4e-3 * spread(0.6180339887) * ex + 4e-3 * spread(0.4142135624) * ey
    p = origin + local + (0.3 + 0.2 * spread(0.7320508076)) * ez
    return [np.ascontiguousarray(p[:, k]) for k in range(3)]


def irradiance(light, x, y, z):
    """Returns the irradiance of a plane square to the axis, in W/m²."""
    origin, ex, ey, ez, power, w0_sq, theta_sq, z0, cutoff_sq = light
    dx, dy, dz = x - origin[0], y - origin[1], z - origin[2]
    u = dx * ex[0] + dy * ex[1] + dz * ex[2]
    v = dx * ey[0] + dy * ey[1] + dz * ey[2]
    w = dx * ez[0] + dy * ez[1] + dz * ez[2]
    w_sq = w0_sq + theta_sq * (w - z0) ** 2
    rho_sq = (u * u + v * v) / w_sq
    value = power / w_sq * np.exp(-2 * rho_sq)
    return np.where((w >= 0) & (rho_sq <= cutoff_sq), value, 0)


def nanoseconds_per_point(dtype):
    """Returns the median time of a call, divided by the number of points."""
    theta = WAVELENGTH / (math.pi * WAIST_RADIUS)
    scalars = 2 * POWER / math.pi, WAIST_RADIUS**2, theta**2, WAIST_DISTANCE, CUTOFF**2
    light = [v.astype(dtype) for v in frame()] + [dtype(s) for s in scalars]
    coordinates = [c.astype(dtype) for c in points()]
    times = []
    for _ in range(301):
        start = time.perf_counter()
        irradiance(light, *coordinates)
        times.append(time.perf_counter() - start)
    lit = np.count_nonzero(irradiance(light, *coordinates)) / POINTS
    return statistics.median(times) / POINTS * 1e9, lit


if __name__ == "__main__":
    print(f"NumPy {np.__version__}, Python {platform.python_version()}")
    for dtype in (np.float64, np.float32):
        result, lit = nanoseconds_per_point(dtype)
        print(f"irradiance, {dtype.__name__}: {result:.2f} ns per point ({lit:.0%} lit)")
