"""Arguments that are refused: the exception names them, their value and what is allowed."""

from collections.abc import Callable

import numpy as np
import pytest

import tem00
from tem00.speckle import (
    Pupil,
    PupilField,
    SlicePath,
    SpecklePattern,
    SpeckleStack,
    StackPlan,
    derived_seed,
    incoherent_fractions,
)

FIELD = PupilField(64, 16, 7)
STACK = SpeckleStack.generate(FIELD, SlicePath.circle(half_period=2))
MEASURED = PupilField.from_samples(np.ones((40, 40)), (160, 160), 4.0)


def plan(**changes: object) -> StackPlan:
    """Return a plan for needs with another value."""
    needs: dict[str, object] = {
        "image": (64, 48),
        "region": (64, 48),
        "speckle_size": 2.5,
        "motion": 0.33,
        "frames": 10,
        "memory_limit": 2**30,
    }
    return StackPlan(**(needs | changes))  # type: ignore[arg-type]


REFUSED: list[tuple[Callable[[], object], str, str]] = [
    (lambda: PupilField(-1, 16, 0), "size", "-1"),
    (lambda: PupilField(2**20, 16, 0), "size", "32768"),
    (lambda: PupilField(64, 33, 0), "diameter", "33"),
    (lambda: PupilField(64, 16, 2**64), "seed", "18446744073709551616"),
    (lambda: PupilField.from_speckle_size((64, 64), 1.5, 0), "speckle_size", "1.5"),
    (lambda: PupilField.from_speckle_size((64, 64), np.nan, 0), "speckle_size", "NaN"),
    (lambda: PupilField.from_samples([[np.inf]], (64, 64), 4.0), "samples", "finite"),
    (lambda: PupilField.from_samples(np.ones((0, 4)), (64, 64), 4.0), "samples", "0"),
    (lambda: PupilField.from_samples(np.ones(4), (64, 64), 4.0), "samples", "[4]"),
    (lambda: FIELD.with_phasors("round"), "phasors", "'round'"),  # type: ignore[arg-type]
    (lambda: FIELD.with_pupil(Pupil.annulus(inner=0.99)), "pupil", "49"),
    (lambda: FIELD.pattern((np.inf, 0.0)), "offset", "inf"),
    (lambda: FIELD.field((0.0, 0.0), np.nan), "defocus", "NaN"),
    (lambda: FIELD.amplitude_correlation(0.0, np.inf), "y", "inf"),
    (lambda: Pupil.annulus(inner=1.0), "inner", "1"),
    (lambda: Pupil.rectangle(height=0.0), "height", "0"),
    (lambda: Pupil.gaussian(radius=-1.0), "radius", "-1"),
    (lambda: Pupil.circle().overlap(np.nan, 0.0), "x", "NaN"),
    (lambda: Pupil.sampled(np.array([[2j]])), "amplitude", "2"),
    (lambda: Pupil.sampled(np.zeros((4, 4))), "amplitude", "0"),
    (lambda: PupilField.from_samples(np.zeros((40, 40)), (160, 160), 4.0), "samples", "0"),
    (lambda: SlicePath.circle(half_period=0), "half_period", "0"),
    (lambda: SlicePath.straight(half_period=4, length=1), "length", "1"),
    (lambda: STACK.coefficients(4), "index", "4"),
    (lambda: STACK.slice_law(-5), "index", "-5"),
    (lambda: STACK.offset(10**30), "index", "1" + 30 * "0"),
    (lambda: STACK.correlation_between(0, np.nan), "v", "NaN"),
    (lambda: STACK.intensity_at([0.0, np.nan], 0.0, 0.0), "x", "NaN"),
    (lambda: STACK.intensity_at(0.0, 0.0, np.inf), "u", "inf"),
    (lambda: STACK.intensity_at([0.0, 1.0], [0.0, 1.0, 2.0], 0.0), "y", "3"),
    (lambda: STACK.average_over(0.0, 0.0, (1.0, -2.0), 0.0), "size", "-2"),
    (lambda: STACK.correlation_at(np.nan), "distance", "NaN"),
    (lambda: STACK.coordinate_of(np.nan), "correlation", "NaN"),
    (lambda: plan(image=(0.0, 1.0)), "image", "0"),
    (lambda: plan(region=(1.0, np.inf)), "region", "inf"),
    (lambda: plan(speckle_size=-2.0), "speckle_size", "-2"),
    (lambda: plan(motion=np.nan), "motion", "NaN"),
    (lambda: plan(frames=2**32), "frames", "4294967296"),
    (lambda: plan().with_square(64, 33), "diameter", "33"),
    (lambda: StackPlan.place(-1), "number", "-1"),
    (lambda: derived_seed(1, "lamp", 0), "purpose", "'lamp'"),  # type: ignore[arg-type]
    (lambda: derived_seed(2**64, "body", 0), "seed", str(2**64)),
    (lambda: STACK.coordinate_at(np.nan), "shift", "NaN"),
    (lambda: incoherent_fractions(0, 1.0, [1.0]), "patterns", "0"),
    (lambda: incoherent_fractions(1, 1.0, [1.0, -1.5]), "weights", "-1.5"),
    (lambda: incoherent_fractions(1, 1.5, [1.0]), "polarisation", "1.5"),
    (lambda: MEASURED.independent(2), "field", "seed"),
    (lambda: FIELD.independent(0), "patterns", "0"),
    (lambda: SpecklePattern.weighted_mean([1.0], []), "patterns", "0"),
    (lambda: FIELD.pattern(image_drift=(2e6, 0.0)), "image_drift", "2000000"),
    (lambda: FIELD.pattern(pupil_drift=(0.0, 129.0)), "pupil_drift", "129"),
]


@pytest.mark.parametrize(("call", "parameter", "value"), REFUSED)
def test_errors_name_the_argument_and_its_value(
    call: Callable[[], object], parameter: str, value: str
) -> None:
    with pytest.raises(tem00.ParameterError) as caught:
        call()
    assert caught.value.parameter == parameter
    assert value in str(caught.value)


TOO_LARGE: list[Callable[[], object]] = [
    lambda: SpeckleStack.generate(
        PupilField(2**15, 8, 0), SlicePath.circle(half_period=2**15)
    ),
    lambda: plan(memory_limit=1000),
    lambda: STACK.intensity_at(
        np.zeros((10**6, 1, 1)), np.zeros((1, 10**6, 1)), np.zeros((1, 1, 100))
    ),
]


@pytest.mark.parametrize("call", TOO_LARGE)
def test_what_memory_cannot_hold_is_a_memory_error(call: Callable[[], object]) -> None:
    with pytest.raises(MemoryError):
        call()


WRONG_TYPES: list[Callable[[], object]] = [
    lambda: PupilField(64.0, 16, 0),  # type: ignore[arg-type]
    lambda: PupilField.from_speckle_size(64, 4.0, 0),  # type: ignore[arg-type]
    lambda: STACK.intensity_at("1", 0.0, 0.0),  # type: ignore[arg-type]
    lambda: SpecklePattern.weighted_mean([1.0], [FIELD]),  # type: ignore[list-item]
    lambda: FIELD.with_pupil(SlicePath.still()),  # type: ignore[arg-type]
]


@pytest.mark.parametrize("call", WRONG_TYPES)
def test_arguments_of_another_type_are_type_errors(call: Callable[[], object]) -> None:
    with pytest.raises(TypeError):
        call()


def test_errors_of_patterns_come_through_their_mean() -> None:
    with pytest.raises(ZeroDivisionError):
        SpecklePattern.weighted_mean(
            [1.0], (PupilField(1 // side, 16, 0).pattern() for side in [0])
        )
    patterns = (PupilField(side, 16, 0).pattern() for side in [64, 128])
    with pytest.raises(tem00.ParameterError, match="all of one size, got 128") as caught:
        SpecklePattern.weighted_mean([1.0, 1.0], patterns)
    assert caught.value.parameter == "patterns"
