"""Arrays in and out of beams and lights: shapes, bits, copies and threads."""

import sys
import threading
import time
import tracemalloc
from collections.abc import Callable

import numpy as np
import pytest
from tem00 import ParameterError, beam

LASER = beam.GaussianBeam.from_waist(650e-9, 1e-4)
ELLIPTIC = beam.AstigmaticBeam.from_divergences(650e-9, (1e-3, 2e-3))
PLACEMENT = beam.Placement((0.1, 0.2, 0.3), (0, 0.1, -1), (1, 0, 0))
SPOT = beam.Light.spot(LASER, 0.1, PLACEMENT, 1e-3)
LINE = beam.LaserLine(LASER, beam.FanGeometry(0.5, 2e-3, 0.2), beam.LineProfile.gaussian_tan())
SECTION = LASER.cross_section_at(0.1)

# Functions of three numbers, and the number of components of their values.
QUERIES: dict[str, tuple[Callable[..., object], int]] = {
    "radius": (lambda x, y, z: LASER.radius_at(z), 0),
    "irradiance": (lambda x, y, z: LASER.irradiance_per_watt(x, z), 0),
    "beam flux": (LASER.flux_per_watt, 3),
    "elliptic": (ELLIPTIC.irradiance_per_watt, 0),
    "elliptic radii": (lambda x, y, z: ELLIPTIC.radii_at(z), 2),
    "elliptic flux": (ELLIPTIC.flux_per_watt, 3),
    "line": (LINE.flux_per_watt, 3),
    "line power": (LINE.power_on_length, 0),
    "section": (lambda x, y, z: SECTION.power_in_slit(x, y), 0),
    "light flux": (SPOT.flux, 3),
    "light": (SPOT.irradiance, 0),
}
queries = pytest.mark.parametrize("name", QUERIES)


@queries
def test_arrays_have_the_bits_of_single_numbers(name: str) -> None:
    query, size = QUERIES[name]
    # More than one block of 4096.
    x, y, z = np.random.default_rng(1).normal(0, (2e-4, 2e-4, 0.2), (5000, 3)).T
    whole = np.asarray(query(x, y, z))
    assert whole.shape == (5000, size) if size else (5000,)
    for i in range(0, 5000, 97):
        one = query(float(x[i]), float(y[i]), float(z[i]))
        assert np.array_equal(np.asarray(one), whole[i])


@queries
def test_arguments_broadcast(name: str) -> None:
    query, size = QUERIES[name]
    x = np.linspace(-1e-4, 1e-4, 4)[:, None]
    z = np.linspace(0.1, 0.2, 5)
    wide = [np.ascontiguousarray(a) for a in np.broadcast_arrays(x, 1e-5, z)]
    expected = np.asarray(query(*wide))
    got = np.asarray(query(x, 1e-5, z))
    # A function of fewer arguments has the shape of those that it takes.
    assert np.array_equal(np.broadcast_to(got, expected.shape), expected)
    assert np.asarray(query(x.T[:0], x.T[:0], x.T[:0])).size == 0


@queries
def test_extreme_arguments_give_numbers_or_an_error(name: str) -> None:
    query, _ = QUERIES[name]
    values = (0.0, -0.0, 1e-300, 5e-324, 1e-30, -1.0, 1e30, -1e30, 1.1e30, 1e308, np.nan, np.inf)
    for x in values:
        for y in values[::3]:
            for z in values:
                try:
                    result = np.asarray(query(x, y, z))
                except ParameterError:
                    continue
                assert not np.isnan(result).any(), (x, y, z)


@pytest.mark.parametrize("profile", ["gaussian_tan", "gaussian_sin", "uniform_angle"])
def test_extreme_points_of_lights_give_numbers_or_an_error(profile: str) -> None:
    made = getattr(beam.LineProfile, profile)()
    line = beam.LaserLine(LASER, beam.FanGeometry(3.0, 2e-3, 0.2), made)
    values = (0.0, 1e-300, 1e-30, -1.0, 1e30, -1e30)
    for light in (SPOT, beam.Light.line(line, PLACEMENT, 1e100)):
        x, y, z = (a.ravel() for a in np.meshgrid(values, values, values))
        u = np.array([0.0, np.nextafter(1, 0)])
        d = np.array([0.0, 0, -1])
        event = light.next_event(x, y, z)
        drawn = light.next_event_sampled(x, y, z, u)
        ray = light.sample_ray([0, 0, np.nextafter(1, 0), 0])
        assert drawn is not None
        results = [event.wi, event.e_perp, event.point, drawn.wi, drawn.value, drawn.pdf]
        results += [ray.origin, ray.direction, light.radiance(x, y, z, d)]
        results += [light.ray_pdf(x, y, z, d).position]
        hit = light.hit(x, y, z, -d)
        assert hit is not None
        corners = np.stack((x, y, z), axis=-1)
        results += [hit.radiance, hit.pdf, light.power_bound(corners, corners[::-1])]
        assert all(np.isfinite(np.asarray(result)).all() for result in results)
        for reach in values:
            assert np.isfinite(light.bounds(reach).max).all()


def copied_bytes(x: np.ndarray, y: np.ndarray, z: np.ndarray) -> int:
    """Return the most memory that NumPy took for buffers during a query."""
    tracemalloc.start()
    SPOT.irradiance(x, y, z)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    return peak


def test_contiguous_points_are_not_copied() -> None:
    x, y, z = np.random.default_rng(2).normal(0, 1e-4, (3, 1_000_000))
    # One array takes 8 MB; one that is read backwards has to be copied.
    assert copied_bytes(x, y, z) < 1_000_000 < 8_000_000 <= copied_bytes(x, y[::-1], z)
    result = SPOT.irradiance(x, y, z)
    assert result.base is not None and not result.flags.owndata
    assert result.flags.c_contiguous and result.flags.writeable


def test_vectors_lie_in_the_last_axis_row_by_row() -> None:
    event = SPOT.next_event(np.full((2, 5), 0.1), 0.2, 0.1)
    assert event.wi.shape == event.point.shape == (2, 5, 3)
    assert event.wi.flags.c_contiguous
    assert np.shape(event.e_perp) == np.shape(event.distance) == (2, 5)
    rays = SPOT.sample_ray(np.full((6, 1, 4), 0.5))
    assert rays.origin.shape == (6, 1, 3) and np.shape(rays.cos) == (6, 1)


def test_other_threads_run_during_a_long_query() -> None:
    x = np.full(2_000_000, 1e-5)
    counted, started, stop = [0], threading.Event(), threading.Event()

    def count() -> None:
        started.set()
        while not stop.is_set():
            counted[0] += 1
            time.sleep(0)

    thread = threading.Thread(target=count)
    thread.start()
    started.wait()
    interval = sys.getswitchinterval()
    # From here on a thread has its turn only where another one gives it up: by sleeping, or in the
    # query.
    sys.setswitchinterval(1000)
    before = counted[0]
    SPOT.next_event_sampled(x, 0.2, 0.1, [0.3, 0.6])
    during = counted[0] - before
    sys.setswitchinterval(interval)
    stop.set()
    thread.join()
    assert during > 100
