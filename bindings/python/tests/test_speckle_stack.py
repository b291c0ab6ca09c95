"""Stacks and their look-up against splines of SciPy, sums over the pupil and closed forms."""

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import ndimage, optimize

from tem00.speckle import PupilField, SlicePath, SpeckleStack

SIZE, DIAMETER = 64, 20
CIRCLE = SlicePath.circle(half_period=4)
STRAIGHT = SlicePath.straight(half_period=6, length=3)

# Sums of 16 taps in single precision, 1e-6 of the brightest speckle, whose intensity is 10.
SINGLE = 2e-5


@pytest.fixture(scope="module")
def field() -> PupilField:
    return PupilField(SIZE, DIAMETER, 12)


@pytest.fixture(scope="module")
def stack(field: PupilField) -> SpeckleStack:
    return SpeckleStack.generate(field, CIRCLE)


def points(count: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return places all over the period."""
    rng = np.random.default_rng(3)
    return rng.uniform(0, SIZE, count), rng.uniform(0, SIZE, count)


def spline(
    stack: SpeckleStack, index: int, x: NDArray[np.float64], y: NDArray[np.float64]
) -> NDArray[np.complex128]:
    """Return the spline of the coefficients of a slice, by SciPy."""
    coefficients = stack.coefficients(index).astype(np.complex128)
    return ndimage.map_coordinates(
        coefficients, [y, x], order=3, mode="grid-wrap", prefilter=False
    )


def polynomial(
    table: NDArray[np.float32], x: NDArray[np.float64], y: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return a closed form at the fractions of places, as `SliceLaw` documents it."""

    def shapes(place: NDArray[np.float64]) -> NDArray[np.float64]:
        f = place % 1.0
        p = f * (1 - f)
        o = p * (1 - 2 * f)
        return np.stack([np.ones_like(p), p, p**2, p**3, o, o * p])[: len(table)]

    values: NDArray[np.float64] = np.einsum("yx,yn,xn->n", table, shapes(y), shapes(x))
    return values


def response(place: NDArray[np.float64], k: NDArray[np.int64]) -> NDArray[np.complex128]:
    """Return what the prefiltered cubic B-spline makes of waves, over these, for (place, k)."""
    angle = 2 * np.pi * k / SIZE
    taps = np.arange(-1, 3)
    steps = taps - (place % 1.0)[:, np.newaxis]
    distance = np.abs(steps)
    kernel = np.where(
        distance < 1, (4 - 6 * distance**2 + 3 * distance**3) / 6, (2 - distance) ** 3 / 6
    )
    waves = np.exp(-1j * angle * steps[..., np.newaxis])
    prefilter = np.sinc(k / SIZE) ** -4
    values: NDArray[np.complex128] = np.einsum("pt,ptk->pk", kernel, waves) * prefilter
    return values


def test_look_ups_are_splines_of_the_coefficients(stack: SpeckleStack) -> None:
    x, y = points(300)
    for index in (0, 3, -1):
        square = polynomial(stack.slice_law(index).mean_square, x, y)
        expected = np.abs(spline(stack, index, x, y)) ** 2 / square
        u = index % stack.slice_count
        np.testing.assert_allclose(stack.intensity_at(x, y, u), expected, atol=SINGLE)


def test_look_ups_between_slices_blend_amplitudes(field: PupilField) -> None:
    x, y = points(300)
    for path in (CIRCLE, STRAIGHT):
        stack = SpeckleStack.generate(field, path)
        for index in (0, 2, path.slice_count - 1):
            following = (index + 1) % path.slice_count
            here, there = stack.slice_law(index), stack.slice_law(following)
            f = np.linspace(0.05, 0.95, len(x))
            turns = here.turns[0] * x + here.turns[1] * y
            wave = np.exp(2j * np.pi * turns)
            blend = (1 - f) * spline(stack, index, x, y)
            blend += f * spline(stack, following, x, y) * wave
            square = (1 - f) ** 2 * polynomial(here.mean_square, x, y)
            square += f**2 * polynomial(there.mean_square, x, y)
            square += 2 * f * (1 - f) * polynomial(here.covariance, x, y)
            expected = np.abs(blend) ** 2 / square
            np.testing.assert_allclose(stack.intensity_at(x, y, index + f), expected, atol=SINGLE)


def test_the_closed_forms_are_sums_over_the_pupil(stack: SpeckleStack) -> None:
    k = np.arange(-DIAMETER // 2, DIAMETER // 2 + 1)
    inside = np.hypot(k, k[:, np.newaxis]) <= DIAMETER / 2
    law = stack.slice_law(1)
    x, y = points(50)
    rows, columns = response(y, k), response(x, k)
    power = np.einsum("ni,nj,ij->n", np.abs(rows) ** 2, np.abs(columns) ** 2, inside)
    # Coefficients in single precision; a polynomial that is exact.
    expected = power / inside.sum()
    np.testing.assert_allclose(polynomial(law.mean_square, x, y), expected, atol=1e-6)
    # The same points, seen by the pupil of the next slice.
    shift = -law.turns * SIZE
    both = inside & (np.hypot(k - shift[0], (k - shift[1])[:, np.newaxis]) <= DIAMETER / 2)
    rows = rows * response(y, k - shift[1]).conj()
    columns = columns * response(x, k - shift[0]).conj()
    covariance = np.einsum("ni,nj,ij->n", rows, columns, both).real / inside.sum()
    # A polynomial that leaves 1e-6, without odd terms below 2e-6.
    np.testing.assert_allclose(polynomial(law.covariance, x, y), covariance, atol=4e-6)
    share = np.count_nonzero(both) / np.count_nonzero(inside)
    assert stack.correlation_between(1, 2) == pytest.approx(share**2, abs=1e-12)


def test_slices_are_the_fields_behind_the_displaced_pupil(
    field: PupilField, stack: SpeckleStack
) -> None:
    columns, rows = np.arange(SIZE), np.arange(SIZE)[:, np.newaxis]
    for index in range(stack.slice_count):
        expected = field.pattern(stack.offset(index)).values
        # The spline, made for all places alike, errs by 4.3e-3 of the field at a speckle size of
        # 2 samples and by less at 3.2: twice that of the intensity.
        smooth = stack.intensity_at(columns, rows, index)
        assert np.sqrt(np.mean((smooth - expected) ** 2)) < 2 * 4.3e-3


def test_look_ups_repeat_with_the_size_and_the_slice_count(stack: SpeckleStack) -> None:
    x, y = points(100)
    u = np.linspace(0, 8, 100, endpoint=False)
    here = stack.intensity_at(x, y, u)
    far = stack.intensity_at(x + 3 * SIZE, y - 7 * SIZE, u - 2 * stack.slice_count)
    # The last bits of the coordinates, 1e-14 of a speckle, end in a step of the spline in f32.
    np.testing.assert_allclose(far, here, atol=SINGLE)


def test_arrays_broadcast_and_numbers_stay_numbers(stack: SpeckleStack) -> None:
    x, y = np.arange(3.0), np.arange(2.0)[:, np.newaxis]
    image = stack.intensity_at(x, y, 0.25)
    assert image.shape == (2, 3)
    one = stack.intensity_at(2.0, 1, 0.25)
    assert isinstance(one, float)
    assert one == image[1, 2]
    assert stack.intensity_at([], 0, 0).shape == (0,)


def test_averages_are_integrals_of_look_ups(stack: SpeckleStack) -> None:
    nodes, weights = np.polynomial.legendre.leggauss(40)
    width, height = 7.3, 4.1
    for x, y, u in [(3.0, 60.2, 0.0), (31.5, 12.25, 2.6)]:
        columns = x + 0.5 * width * nodes
        rows = y + 0.5 * height * nodes[:, np.newaxis]
        intensity = stack.intensity_at(columns, rows, u)
        expected = 0.25 * weights @ intensity @ weights
        # Five nodes per speckle leave 4e-5 of the finest fringes, whose amplitude is about 1.
        average = stack.average_over(x, y, (width, height), u)
        assert average == pytest.approx(expected, abs=4e-5 + SINGLE)
    boxes = stack.average_over([3.0, 31.5], [60.2, 12.25], (0.0, 0.0), [0.0, 2.6])
    point = stack.intensity_at([3.0, 31.5], [60.2, 12.25], [0.0, 2.6])
    np.testing.assert_allclose(boxes, point, atol=SINGLE)


def circle_law(s: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the correlation of two pupils on the circle, s = distance / half period."""
    return np.asarray(1 - s - np.sin(np.pi * s) / np.pi) ** 2


def straight_law(rho: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the correlation of two discs rho diameters apart."""
    rho = np.minimum(rho, 1.0)
    return (2 / np.pi * (np.arccos(rho) - rho * np.sqrt(1 - rho**2))) ** 2


def blended(
    law: Callable[[NDArray[np.float64]], NDArray[np.float64]], u: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the correlation of slice 0 with the blend of the slices about u, of norm 1."""
    slices, f = np.floor(u), u - np.floor(u)
    overlap = (1 - f) * np.sqrt(law(slices / 4)) + f * np.sqrt(law((slices + 1) / 4))
    neighbours = np.sqrt(law(np.asarray(0.25)))
    return overlap**2 / ((1 - f) ** 2 + f**2 + 2 * f * (1 - f) * neighbours)


def test_correlations_have_the_closed_forms(field: PupilField, stack: SpeckleStack) -> None:
    u = np.linspace(0, 3.99, 41)
    np.testing.assert_allclose(stack.correlation_at(u), blended(circle_law, u), atol=1e-12)
    straight = SpeckleStack.generate(field, STRAIGHT)
    np.testing.assert_allclose(straight.correlation_at(u), blended(straight_law, u), atol=1e-12)
    for gamma in (0.05, 0.3, 0.8):
        law = lambda u, gamma=gamma: float(blended(circle_law, np.asarray(u))) - gamma  # noqa: E731
        u_of_gamma = optimize.brentq(law, 0, 3.99, xtol=1e-13)
        assert stack.coordinate_of(gamma) == pytest.approx(u_of_gamma, abs=1e-9)
    assert stack.coordinate_of([2.0, 1.0, 0.0, -1.0]).tolist() == [0.0, 0.0, 4.0, 4.0]
    there = straight.coordinate_at([0.3, -0.3])
    np.testing.assert_allclose(
        straight.correlation_at(there), straight_law(np.asarray(0.3)), atol=1e-9
    )
    assert there[0] == -there[1] > 0
