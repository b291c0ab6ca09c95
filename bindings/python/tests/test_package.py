"""The package as such: arrays in and out, errors, threads, pickles."""

import copy
import importlib
import pickle
import threading
import tracemalloc
from collections.abc import Callable

import numpy as np
import pytest
import tem00
from tem00 import decorrelation as dc
from tem00 import statistics as st
from tem00.beam import AstigmaticBeam
from tem00.speckle import PupilField


def test_every_module_can_be_imported_by_its_name() -> None:
    for name in ("statistics", "decorrelation"):
        module = importlib.import_module(f"tem00.{name}")
        assert module.__name__ == f"tem00.{name}"


def test_names_of_the_package_are_those_it_offers() -> None:
    assert dir(tem00) == sorted(tem00.__all__)


def test_numbers_give_a_float_and_arrays_an_array_of_their_shape() -> None:
    assert type(st.exponential_density(1.0)) is float
    assert type(st.exponential_density(np.float64(1.0))) is float
    assert type(st.exponential_density(1)) is float
    for shape in ((1,), (2, 3), (0,), (0, 4), (2, 1, 1, 3)):
        result = st.exponential_density(np.ones(shape))
        assert result.shape == shape
        assert result.dtype == np.float64


def test_arrays_of_any_real_type_and_layout_are_read_alike() -> None:
    x = np.arange(24.0).reshape(4, 6)
    expected = np.exp(-x)
    swapped = x.astype(">f8")
    packed = np.zeros(24, dtype=[("flag", "i1"), ("x", "f8")])
    packed["x"] = x.ravel()
    # exp of both libraries is good to an ulp or two.
    for same in (x, np.asfortranarray(x), swapped, x.astype(np.float32), x.astype(np.int16)):
        np.testing.assert_allclose(st.exponential_density(same), expected, rtol=1e-15)
    np.testing.assert_allclose(
        st.exponential_density(packed["x"]), expected.ravel(), rtol=1e-15
    )
    np.testing.assert_allclose(
        st.exponential_density(x[::-1, ::2]), expected[::-1, ::2], rtol=1e-15
    )
    np.testing.assert_allclose(st.exponential_density(x.tolist()), expected, rtol=1e-15)


@pytest.mark.parametrize(
    ("first", "second"),
    [((4, 1), (1, 5)), ((5000,), ()), ((), (3, 3)), ((70, 1, 90), (70, 1)), ((0, 1), (1, 3))],
)
def test_arguments_broadcast_as_in_numpy(first: tuple[int, ...], second: tuple[int, ...]) -> None:
    random = np.random.default_rng(1)
    law = st.JointIntensity(0.6)
    a, b = random.exponential(size=first), random.exponential(size=second)
    whole = [np.ascontiguousarray(x) for x in np.broadcast_arrays(a, b)]
    result = law.conditional_density(a, b)
    np.testing.assert_array_equal(result, law.conditional_density(*whole))
    one_by_one = [
        law.conditional_density(float(i), float(g)) for i, g in zip(*map(np.ravel, whole))
    ]
    np.testing.assert_array_equal(np.ravel(result), one_by_one)


def test_shapes_that_do_not_fit_name_the_argument() -> None:
    law = st.JointIntensity(0.5)
    with pytest.raises(tem00.ParameterError, match=r"given has the shape \[4\]") as caught:
        law.conditional_density(np.ones(3), np.ones(4))
    assert caught.value.parameter == "given"


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_values_that_are_not_finite_are_refused(bad: float) -> None:
    for argument in (bad, np.array([1.0, bad]), [[0.0], [bad]]):
        with pytest.raises(tem00.ParameterError, match="finite") as caught:
            st.exponential_density(argument)
        assert caught.value.parameter == "intensity"


@pytest.mark.parametrize("bad", ["1", None, True, 1j, np.array([True]), np.array(["1"]), object()])
def test_what_is_no_real_number_is_a_type_error_that_names_the_argument(bad: object) -> None:
    with pytest.raises(TypeError) as caught:
        st.exponential_density(bad)  # type: ignore[call-overload]
    notes = " ".join([str(caught.value), *getattr(caught.value, "__notes__", [])])
    assert "intensity" in notes


def test_results_that_memory_does_not_hold_are_a_memory_error() -> None:
    law = st.JointIntensity(0.5)
    wide = np.ones(1 << 20)
    # 2⁴⁰ results of 8 bytes.
    with pytest.raises(MemoryError, match="8796093022208 bytes"):
        law.conditional_density(wide[:, None], wide[None, :])


def test_results_that_no_address_counts_are_a_memory_error() -> None:
    long = np.ones(1 << 22)
    x, y, z = np.ix_(long, long, long)
    beam = AstigmaticBeam.from_divergences(650e-9, (1e-3, 1e-3))
    with pytest.raises(MemoryError, match="shape"):
        beam.irradiance_per_watt(x, y, z)


def test_arrays_with_many_axes_are_read() -> None:
    assert st.exponential_density(np.ones((1,) * 40)).ndim == 40


def test_rows_in_double_precision_are_not_copied() -> None:
    x = np.zeros(1 << 20)
    tracemalloc.start()
    try:
        st.exponential_density(x[: 1 << 10])
        tracemalloc.clear_traces()
        result = st.exponential_density(x)
        _, contiguous = tracemalloc.get_traced_memory()
        tracemalloc.clear_traces()
        st.exponential_density(x.reshape(1024, 1024).T)
        _, transposed = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    # NumPy reports the copy that it makes; the result itself is moved from Rust's own memory.
    assert contiguous < 1 << 16
    assert transposed > 8 << 20
    assert result.nbytes == 8 << 20


def test_the_interpreter_is_free_while_a_function_works() -> None:
    image = np.random.default_rng(2).exponential(size=(1024, 1024)).astype(np.float32)
    counts: list[int] = []
    done = threading.Event()

    def work() -> None:
        st.autocovariance(image, "finite")
        done.set()

    worker = threading.Thread(target=work)
    worker.start()
    while not done.wait(1e-4):
        counts.append(len(counts))
    worker.join()
    # With the lock held for the whole call, no more than the first wait could end before it.
    assert len(counts) > 10


def test_errors_survive_pickling() -> None:
    with pytest.raises(ValueError, match="shape") as caught:
        st.GammaIntensity(0.5)
    again = pickle.loads(pickle.dumps(caught.value))
    assert isinstance(again, tem00.ParameterError)
    assert (str(again), again.parameter) == (str(caught.value), "shape")


LAWS = [
    st.GammaIntensity(2.5),
    st.PartiallyPolarised(0.3),
    st.IncoherentSum([2.0, 1.0, 0.1]),
    st.CoherentBackground.from_contrast(0.7),
    st.PhasorSum(12),
    st.JointIntensity(0.3),
    st.ObjectiveSpeckle.disc(650e-9, 2.0, 1e-3),
    st.ObjectiveSpeckle.rectangle(650e-9, 2.0, 1e-3, 2e-3),
    st.ObjectiveSpeckle.gaussian_spot(650e-9, 2.0, 1e-3),
]


@pytest.mark.parametrize("law", LAWS, ids=repr)
def test_laws_survive_pickling_and_their_repr_makes_them(law: object) -> None:
    assert pickle.loads(pickle.dumps(law)) == law
    assert copy.deepcopy(law) == law
    assert eval(repr(law), vars(st)) == law


def thick_lens(**focus: float) -> dc.ImagingGeometry:
    return dc.ImagingGeometry.from_thick_lens(650e-9, 25e-3, 8.0, 1.0, 3.45e-6, **focus)


# One of each way in which classes are declared, made twice.
EQUALS: list[Callable[[], tuple[object, object]]] = [
    lambda: (tem00.Camera(position=(0.0, 0.1, 0.3)), tem00.Camera(position=(-0.0, 0.1, 0.3))),
    lambda: (tem00.Pose.along((-0.0, 0.0, 1.0)), tem00.Pose.along((0.0, 0.0, 1.0))),
    lambda: (thick_lens(magnification=1.0), thick_lens(surface_to_principal_plane=50e-3)),
    lambda: (st.IncoherentSum([2.0, 1.0]), st.IncoherentSum([2.0, 1.0])),
    lambda: (PupilField(64, 16, 7).pattern(), PupilField(64, 16, 7).pattern()),
]


@pytest.mark.parametrize("make", EQUALS)
def test_equal_objects_have_equal_hashes(make: Callable[[], tuple[object, object]]) -> None:
    first, second = make()
    assert first == second
    assert {first: 1}[second] == 1


def test_hashes_tell_objects_apart() -> None:
    assert len({hash(tem00.Pose.along((0.0, 0.0, z))) for z in (1.0, 2.0, 3.0)}) == 3


@pytest.mark.parametrize("make", EQUALS)
def test_a_copy_is_the_object_itself(make: Callable[[], tuple[object, object]]) -> None:
    thing, _ = make()
    assert copy.copy(thing) is thing
    assert copy.deepcopy([thing])[0] is thing


def test_functions_survive_pickling() -> None:
    assert pickle.loads(pickle.dumps(st.pixel_contrast)) is st.pixel_contrast
