"""Objects in Python: views, pickles, threads, plans."""

import gc
import pickle
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from tem00 import speckle
from tem00.speckle import (
    Pupil,
    PupilField,
    SlicePath,
    SpeckleStack,
    StackPlan,
    derived_seed,
)
from tem00.statistics import Contrast, autocovariance

FIELD = PupilField(64, 16, 7)
PLAN = StackPlan(
    image=(640, 480),
    region=(640, 480),
    speckle_size=2.5,
    motion=0.33,
    frames=10,
    memory_limit=256 << 20,
)
SAMPLED = Pupil.sampled(np.ones((4, 4)))
STACK = SpeckleStack.generate(FIELD, SlicePath.circle(half_period=2))
MEASURED = PupilField.from_samples(np.full((40, 40), 1 + 2j), (160, 160), 4.0)

VIEWS: list[Callable[[], tuple[object, NDArray[np.generic] | None]]] = [
    lambda: (pattern := FIELD.pattern(), pattern.values),
    lambda: (amplitude := FIELD.field(), amplitude.values),
    lambda: (
        stack := SpeckleStack.generate(FIELD, SlicePath.circle(half_period=1)),
        stack.coefficients(1),
    ),
    lambda: (MEASURED, MEASURED.samples),
    lambda: (SAMPLED, SAMPLED.values),
]


@pytest.mark.parametrize("make", VIEWS, ids=("pattern", "field", "stack", "samples", "pupil"))
def test_images_are_views_that_nobody_can_write(
    make: Callable[[], tuple[object, NDArray[np.generic] | None]],
) -> None:
    owner, image = make()
    assert image is not None
    assert image.base is owner
    assert image.ndim == 2
    assert image.flags.c_contiguous
    with pytest.raises(ValueError, match="read-only"):
        image[0, 0] = 0
    with pytest.raises(ValueError, match="WRITEABLE"):
        image.flags.writeable = True


def test_numpy_takes_patterns_and_fields_for_their_values() -> None:
    pattern, field = FIELD.pattern(), FIELD.field()
    assert np.shares_memory(np.asarray(pattern), pattern.values)
    assert not np.shares_memory(np.array(pattern), pattern.values)
    np.testing.assert_array_equal(np.asarray(field), field.values)
    assert np.asarray(field, np.complex128).dtype == np.complex128
    assert Contrast.from_samples(np.asarray(pattern)) == Contrast.from_samples(pattern.values)


def test_views_share_their_memory_and_keep_it_alive() -> None:
    pattern = FIELD.pattern()
    image, again = pattern.values, pattern.values
    assert np.shares_memory(image, again)
    before = image.copy()
    del pattern, again
    gc.collect()
    # Another pattern would take the place of one that was given back.
    others = [FIELD.with_seed(seed).pattern() for seed in range(5)]
    np.testing.assert_array_equal(image, before)
    assert len(others) == 5


def test_views_are_given_while_another_thread_reads_them() -> None:
    pattern = PupilField(1024, 256, 1).pattern()
    worker = threading.Thread(target=lambda: autocovariance(pattern.values, "periodic"))
    worker.start()
    while worker.is_alive():
        assert pattern.values.shape == (1024, 1024)
    worker.join()


def resident_bytes() -> int:
    """Return the memory that this process holds, on Linux."""
    status = Path("/proc/self/status").read_text(encoding="ascii")
    line = next(line for line in status.splitlines() if line.startswith("VmRSS"))
    return int(line.split()[1]) * 1024


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="Linux tells its memory there")
def test_views_of_a_large_stack_take_no_memory() -> None:
    stack = SpeckleStack.generate(PupilField(1024, 64, 1), SlicePath.circle(half_period=4))
    assert stack.memory_bytes == 64 << 20
    gc.collect()
    before = resident_bytes()
    views = [stack.coefficients(index) for index in range(8)]
    assert sum(view.nbytes for view in views) == 64 << 20
    # A copy of a single slice would take 8 MiB.
    assert resident_bytes() - before < 4 << 20


PICKLED = [
    FIELD,
    FIELD.with_phasors("gaussian").with_pupil(Pupil.annulus(inner=0.3)),
    PupilField(100, 30, 2**64 - 1),
    PupilField.from_speckle_size((640, 480), 3.3, 7),
    MEASURED.with_pupil(SAMPLED),
    Pupil.circle(),
    Pupil.rectangle(height=0.3),
    Pupil.gaussian(radius=0.5),
    SAMPLED,
    SlicePath.still(),
    SlicePath.circle(half_period=3),
    SlicePath.straight(half_period=8, length=4),
    PLAN,
    PLAN.with_square(64, 16),
    STACK,
    SpeckleStack.generate(FIELD, SlicePath.straight(half_period=2, length=3)),
    SpeckleStack.generate(MEASURED, SlicePath.still()),
]


@pytest.mark.parametrize("thing", PICKLED, ids=repr)
def test_pickles_are_equal_to_what_was_pickled(thing: object) -> None:
    again = pickle.loads(pickle.dumps(thing))
    assert again == thing
    assert repr(again) == repr(thing)
    if "<" not in repr(thing) and "array" not in repr(thing):
        assert eval(repr(thing), vars(speckle)) == thing


def test_pickled_fields_have_the_same_bits_in_another_process() -> None:
    program = (
        "import pickle, sys; field = pickle.load(sys.stdin.buffer); "
        "sys.stdout.buffer.write(field.pattern().values.tobytes())"
    )
    run = [sys.executable, "-c", program]
    other = subprocess.run(run, input=pickle.dumps(FIELD), capture_output=True, check=True)
    assert other.stdout == FIELD.pattern().values.tobytes()


def test_a_field_on_a_closed_lattice_refuses_to_be_pickled() -> None:
    stack = SpeckleStack.generate(FIELD, SlicePath.straight(half_period=2, length=2))
    with pytest.raises(TypeError, match="closed"):
        pickle.dumps(stack.field)


def test_long_work_leaves_the_interpreter_free() -> None:
    field = PupilField(1024, 512, 1)
    done = threading.Event()

    def work() -> None:
        for seed in range(3):
            SpeckleStack.generate(field.with_seed(seed), SlicePath.circle(half_period=2))
        done.set()

    worker = threading.Thread(target=work)
    worker.start()
    turns = 0
    while not done.is_set():
        turns += 1
        time.sleep(1e-3)
    worker.join()
    # With the interpreter held, this thread would have a turn before and after each of three calls
    # of a tenth of a second.
    assert turns > 12


def test_plans_have_the_sizes_of_their_needs() -> None:
    plan = PLAN
    # 640 / 2.5 and 480 / 2.5 speckles, two samples each, and 32 slices per diameter.
    assert (plan.diameter, plan.size) == ((256, 192), (512, 384))
    assert plan.path == SlicePath.straight(half_period=32, length=2)
    assert plan.memory_bytes == 64 * 512 * 384 * 8
    assert (plan.slices_per_diameter, plan.reach) == (32.0, 1.0)
    square = plan.with_square(64, 16)
    assert square.stack(7).size == (64, 64)
    assert square.field(7) == FIELD
    with pytest.raises(MemoryError):
        square.stack(7, 1000)


def test_objects_know_their_equals() -> None:
    assert FIELD == PupilField(64, 16, 7)
    assert FIELD != PupilField(64, 16, 8)
    assert FIELD.pattern() == FIELD.pattern()
    assert STACK.path != SlicePath.still()
    with pytest.raises(AttributeError):
        FIELD.seed = 8  # type: ignore[misc]


def test_seeds_are_steps_of_weyl_and_places_powers_of_the_plastic_number() -> None:
    lasers = [derived_seed(2**64 - 1, "laser", i) for i in range(3)]
    bodies = [derived_seed(2**64 - 1, "body", i) for i in range(3)]
    assert lasers == [((i + 1) * 0x9E3779B97F4A7C15 - 1) % 2**64 for i in range(3)]
    assert bodies == [(i * 0xD1B54A32D192ED03 - 1) % 2**64 for i in range(3)]
    (plastic,) = (root.real for root in np.roots([1, 0, -1, -1]) if abs(root.imag) < 1e-12)
    expected = [3 / plastic % 1, 3 / plastic**2 % 1]
    np.testing.assert_allclose(StackPlan.place(3), expected, rtol=0, atol=1e-12)
    assert StackPlan.place(0) == (0.0, 0.0)
