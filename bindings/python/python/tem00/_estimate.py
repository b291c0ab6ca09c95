"""Numbers that carry their standard error."""

from __future__ import annotations


class Estimate(float):
    """A fitted value, a number like any other, that carries its standard error in the same unit.

    Arithmetic gives plain numbers: how the errors of several estimates go together is not known here.

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


Estimate.__module__ = "tem00.beam"
