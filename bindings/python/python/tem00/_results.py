"""Results: numbers that carry their standard error, and named tuples.

The arrays of a tuple share their leading axes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

# The package is imported where NumPy is not.
if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from tem00._typing import FloatArray, Values


class Estimate(float):
    """A fitted value, a number like any other, that carries its standard error in the same unit.

    Arithmetic gives plain numbers: how the errors of several estimates go together is not known
    here.

    Parameters
    ----------
    value : float
        Value that fits best.
    standard_error : float
        Standard deviation of the value over repeated measurements, to first order.

    Examples
    --------
    >>> from tem00.beam import Estimate
    >>> radius = Estimate(1.25e-4, 2e-6)
    >>> 2 * radius, radius.standard_error
    (0.00025, 2e-06)
    >>> f"{radius:.3e}"
    '1.250e-04'
    """

    __slots__ = ("_standard_error",)
    _standard_error: float

    def __new__(cls, value: float, standard_error: float) -> Estimate:
        """Return the number with its standard error."""
        self = super().__new__(cls, value)
        self._standard_error = float(standard_error)
        return self

    @property
    def value(self) -> float:
        """Value that fits best, as a plain number."""
        return float(self)

    @property
    def standard_error(self) -> float:
        """Standard deviation of the value over repeated measurements, to first order."""
        return self._standard_error

    def __repr__(self) -> str:
        return f"Estimate(value={float(self)!r}, standard_error={self._standard_error!r})"

    def __str__(self) -> str:
        return f"{float(self)!r} ± {self._standard_error!r}"

    def __getnewargs__(self) -> tuple[float, float]:  # type: ignore[override]
        return float(self), self._standard_error


class SpeckleMotion(NamedTuple):
    """Change of the speckle at one surface point between two states."""

    image_displacement: FloatArray
    """Motion of the image of the surface along b1 and b2, in metres on the sensor, upright."""

    defocus_displacement: FloatArray
    """Additional displacement of the speckle of a point out of focus, in metres on the sensor."""

    speckle_displacement: FloatArray
    """Motion of the speckle in the image, the sum of both, in metres on the sensor."""

    pupil_displacement: FloatArray | None
    """Motion of the speckle field across the pupil along b1 and b2, in metres.

    ``None`` where the pattern is decorrelated, as in a grazing view.
    """

    axial_displacement: float
    """Motion of the surface towards the camera along the optical axis, in metres."""

    correlation: float
    """Correlation of intensity with the pattern before, looked up at ``speckle_displacement``."""


class TestOutcome(NamedTuple):
    """Outcome of a test of a hypothesis."""

    statistic: float
    """The test's statistic: the larger, the further from the hypothesis."""

    p_value: float
    """The probability of a statistic at least as far from the hypothesis, were it true."""


class Ring(NamedTuple):
    """The average of a grid over a ring of lags or frequencies."""

    radius: float
    """Mean distance of the cells from the origin."""

    mean: float
    """Mean of the values."""

    cells: int
    """Number of cells."""


class Singularity(NamedTuple):
    """A phase singularity of a complex field: a zero of intensity around which the phase turns."""

    x: int
    """Column of the cell: the singularity lies between this sample and the next."""

    y: int
    """Row of the cell."""

    charge: int
    """+1 where the phase grows on the way from the x to the y axis, −1 where it falls."""


class NextEvent(NamedTuple):
    """The light that arrives at a point, as one direction and one irradiance.

    For arrays of points all members are arrays, and 0 where no light arrives.
    """

    point: FloatArray
    """Point of the aperture plane that the light seems to come from, shape (..., 3)."""

    distance: Values
    """Distance to ``point``, in metres, shape (...)."""

    wi: FloatArray
    """Unit vector towards the light, against the mean energy flow, shape (..., 3)."""

    e_perp: Values
    """Irradiance of a surface square to ``wi``, in W/m², shape (...)."""


class SampledEvent(NamedTuple):
    """The light that arrives at a point, as a random direction and its density.

    For arrays of points all members are arrays, and 0 where no light arrives.
    """

    point: FloatArray
    """Point of the aperture plane that the ray comes from, shape (..., 3)."""

    distance: Values
    """Distance to ``point``, in metres, shape (...)."""

    wi: FloatArray
    """Unit vector towards the light, shape (..., 3)."""

    value: Values
    """Radiance divided by ``pdf``, in W/m², shape (...)."""

    pdf: Values
    """Probability density of ``wi``, per steradian, shape (...)."""


class ApertureHit(NamedTuple):
    """The light that a ray meets on its way to the aperture.

    For arrays of rays all members are arrays, and 0 where a ray meets none.
    """

    point: FloatArray
    """Point of the aperture plane, shape (..., 3)."""

    distance: Values
    """Distance to ``point``, in metres, shape (...)."""

    radiance: Values
    """Radiance that arrives along the ray, in W/(m² sr), shape (...)."""

    pdf: Values
    """Density with which a sampled next event has this direction, per steradian, shape (...)."""


class RayPdf(NamedTuple):
    """The probability densities of a ray, whose joint density factors in two ways.

    ``position · direction_given_position = direction · position_given_direction``. Bidirectional
    methods want the left side, the right side is what a ray is drawn from. Positions are those on
    the aperture plane.
    """

    position: Values
    """Density of the position, over all directions, per m² of the aperture plane, shape (...)."""

    direction_given_position: Values
    """Density of the direction at this position, per steradian, shape (...)."""

    direction: Values
    """Density of the direction, wherever the ray starts, per steradian, shape (...)."""

    position_given_direction: Values
    """Density of the position among the rays of this direction, shape (...).

    It is per m² of the aperture plane.
    """


class RaySample(NamedTuple):
    """A ray that leaves the aperture, or arrays of them."""

    origin: FloatArray
    """Point of the aperture plane, shape (..., 3)."""

    flux: Values
    """Power the ray stands for, in watts, shape (...).

    It is that of the light, to be divided by the number of rays.
    """

    direction: FloatArray
    """Unit vector along the ray, shape (..., 3)."""

    cos: Values
    """Cosine of the angle between the ray and the axis, shape (...)."""

    pdf: RayPdf
    """Probability densities of the ray."""


class Bounds(NamedTuple):
    """Bounds of a light in space and direction, as a light hierarchy stores them."""

    min: FloatArray
    """Smallest corner of an axis-aligned box around the lit volume, in metres, shape (3,)."""

    max: FloatArray
    """Largest corner of the box, in metres, shape (3,)."""

    axis: FloatArray
    """Unit vector along the axis, shape (3,)."""

    half_angle: float
    """Half-angle, in radians, of the cone about ``axis`` that the light travels in."""


class SliceLaw(NamedTuple):
    """The closed forms of a slice, for look-ups that run where no library can be called.

    With the fraction f of the way between the slices i and i + 1, and fx, fy between samples::

        U = (1 - f) U_i + f U_{i+1} exp(2 pi i (turns[0] x + turns[1] y))
        I = |U|**2 / ((1 - f)**2 v_i + f**2 v_{i+1} + 2 f (1 - f) w_i)
        v = sum of mean_square[ny, nx] s[ny](fy) s[nx](fx)
        w = sum of covariance[ny, nx] s[ny](fy) s[nx](fx)
        s(f) = 1, p, p**2, p**3, o, o p        p = f (1 - f),  o = p (1 - 2 f)

    x and y lie in one period, from 0 to the size.
    """

    mean_square: NDArray[np.float32]
    """Coefficients of the mean square of the interpolated amplitude, shape (4, 4)."""

    covariance: NDArray[np.float32]
    """Coefficients of the covariance with the next slice, shape (6, 6)."""

    turns: FloatArray
    """Turns of phase per sample along x and y, shape (2,).

    They lead from the frame of the next slice to that of this one.
    """


class SpeckleShift(NamedTuple):
    """What has become of the speckle at points since the reference state.

    Where the law has no value, or the camera does not see the point, the speckle is new: ``pupil``
    is infinite and all else 0.
    """

    displacement: FloatArray
    """Displacement of the speckle in the image, in pixels with y down, shape (..., 2)."""

    pupil: Values
    """Displacement of the pupil over the speckle, in its diameters, shape (...)."""

    across: FloatArray
    """The part of it across the line of sight, right and up, in pupil diameters, shape (..., 2)."""

    axial: Values
    """Displacement along the axis, in axial decorrelation lengths, shape (...).

    It is positive towards the camera.
    """

    correlation: Values
    """Correlation of intensity that is left where the speckle has gone, in [0, 1], shape (...)."""


for _module, _classes in (
    ("beam", (ApertureHit, Bounds, Estimate, NextEvent, RayPdf, RaySample, SampledEvent)),
    ("decorrelation", (SpeckleMotion,)),
    ("shading", (SpeckleShift,)),
    ("speckle", (SliceLaw,)),
    ("statistics", (Ring, Singularity, TestOutcome)),
):
    for _class in _classes:
        _class.__module__ = f"tem00.{_module}"
