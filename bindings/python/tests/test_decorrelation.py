"""Cameras, motions and correlations: calls, refusals and pickles."""

import copy
import math
import pickle
from collections.abc import Callable

import numpy as np
import pytest
import tem00
from tem00 import decorrelation as dc
from tem00._typing import FloatArray

WAVELENGTH = 650e-9
CAMERA = dc.ImagingGeometry.from_lens(WAVELENGTH, 25e-3, 8.0, 0.3, 3.45e-6)


def unit(vector: FloatArray) -> FloatArray:
    return np.asarray(vector / np.linalg.norm(vector, axis=-1, keepdims=True), dtype=np.float64)


class Bench:
    """A tilted camera, a point source and a surface whose normal is z, in NumPy."""

    eye = np.array([0.12, -0.05, 0.27])
    source = np.array([-0.3, 0.2, 0.5])
    point = np.array([0.01, 0.02, 0.0])

    def __init__(self) -> None:
        self.frame = dc.CameraFrame.look_at(self.eye, [0.0, 0.0, 0.0], [0.0, 1.0, 0.0])
        to_source = self.source - self.point
        self.wave = dc.Wavefront.spherical(to_source, 1 / float(np.linalg.norm(to_source)))

    def states(self, motion: FloatArray) -> tuple[dc.Configuration, dc.Configuration]:
        """Return the states before and after a motion of the surface."""
        before = dc.Configuration(
            wavelength=WAVELENGTH,
            point=self.point,
            normal=[0, 0, 1],
            illumination=dc.Illumination.near(self.point, self.wave),
            camera=self.frame,
            pupil=self.eye,
        )
        return before, before.moved(surface=dc.RigidMotion.along(motion))


def test_the_image_moves_as_a_pinhole_sees_the_point() -> None:
    bench = Bench()
    motion = np.array([15e-3, -10e-3, 20e-3])
    axes = bench.frame.axes.T

    def image(point: FloatArray) -> FloatArray:
        x, y, z = axes @ (point - bench.eye)
        return np.array([x / -z, y / -z], dtype=np.float64) * CAMERA.principal_distance

    expected = image(bench.point + motion) - image(bench.point)
    speckle = dc.speckle_motion(CAMERA, *bench.states(motion))
    np.testing.assert_allclose(speckle.image_displacement, expected, rtol=1e-12)
    assert math.isclose(speckle.axial_displacement, float(axes[2] @ motion), rel_tol=1e-12)
    still = dc.speckle_motion(CAMERA, *bench.states(np.zeros(3)))
    assert math.isclose(still.correlation, 1.0, rel_tol=1e-12)
    sheared = dc.speckle_motion(CAMERA, *bench.states(np.array([20e-6, 0, 0])))
    assert sheared.pupil_displacement is not None
    shift = float(np.linalg.norm(sheared.pupil_displacement)) / CAMERA.pupil_diameter
    assert math.isclose(sheared.correlation, dc.pupil_overlap_correlation(shift), rel_tol=1e-3)


def test_another_wavelength_changes_the_phase_of_heights() -> None:
    before, _ = Bench().states(np.zeros(3))
    along = unit(Bench.eye - Bench.point) + unit(Bench.source - Bench.point)
    # The light keeps its phases along the surface and leaves with the rest along the normal.
    ratio = 650.3 / WAVELENGTH * 1e-9
    tangents = ratio * along[:2] - unit(Bench.source - Bench.point)[:2]
    leaving = math.sqrt(1 - tangents @ tangents) + unit(Bench.source - Bench.point)[2]
    expected = 2 * math.pi * (leaving / 650.3e-9 - along[2] / WAVELENGTH)
    change = before.height_phase_change(before.with_wavelength(650.3e-9))
    assert change is not None
    assert math.isclose(change, expected, rel_tol=1e-6)
    assert before.height_phase_change(before) == 0
    behind = before.with_illumination(dc.Illumination.collimated([0.0, 0.0, -1.0]))
    assert before.height_phase_change(behind) is None


def test_correlations_are_the_laws_of_a_circular_pupil() -> None:
    shifts = np.array([0.0, 0.3, 0.95, 1.0, 2.0])
    inside = np.minimum(shifts, 1)
    overlaps = 2 / np.pi * (np.arccos(inside) - inside * np.sqrt(1 - inside**2))
    np.testing.assert_allclose(dc.pupil_overlap_correlation(shifts), overlaps**2, atol=1e-14)
    np.testing.assert_allclose(dc.axial_correlation(shifts), np.sinc(shifts) ** 2, atol=1e-15)
    for law in (dc.correlation_at_peak, dc.correlation_at_image_displacement):
        np.testing.assert_array_equal(law(shifts, 0.0), dc.pupil_overlap_correlation(shifts))
    assert dc.correlation_at_peak(0.3, 0.5) > dc.correlation_at_image_displacement(0.3, 0.5)


def test_inverses_undo_the_laws() -> None:
    left = np.linspace(0.01, 0.99, 23)
    # Both ends of the inverses have roots: 1e-12 of γ.
    np.testing.assert_allclose(
        dc.pupil_overlap_correlation(dc.equivalent_pupil_shift(left)), left, atol=1e-11
    )
    np.testing.assert_allclose(
        dc.axial_correlation(dc.equivalent_axial_shift(left)), left, atol=1e-11
    )


def test_the_geometry_is_that_of_a_thin_lens() -> None:
    image_distance = 1 / (1 / 25e-3 - 1 / 0.3)
    assert math.isclose(CAMERA.pupil_to_image, image_distance, rel_tol=1e-14)
    assert math.isclose(CAMERA.magnification, image_distance / 0.3, rel_tol=1e-14)
    assert math.isclose(CAMERA.speckle_size, WAVELENGTH * image_distance * 8 / 25e-3, rel_tol=1e-14)
    assert math.isclose(
        CAMERA.depth_of_focus, 4 * WAVELENGTH * (0.3 * 8 / 25e-3) ** 2, rel_tol=1e-14
    )
    depths = np.array([0.2, 0.3, 0.5])
    np.testing.assert_allclose(CAMERA.defocus_at(depths), 1 / depths - 1 / 0.3, rtol=1e-14)
    x, y = CAMERA.pattern_coordinate(([10.0, 20.0], 5.0), (CAMERA.pixel_pitch, 0.0), 4.0)
    scale = 4 / CAMERA.speckle_size_in_pixels
    np.testing.assert_allclose(x, scale * np.array([9.0, 19.0]), rtol=1e-13)
    np.testing.assert_allclose(y, -scale * np.array([5.0, 5.0]), rtol=1e-13)
    thick = dc.ImagingGeometry.from_thick_lens(
        WAVELENGTH, 50e-3, 4.0, pupil_magnification=0.8, pixel_pitch=3.45e-6, magnification=0.5
    )
    known = dc.ImagingGeometry.from_distances(WAVELENGTH, 0.3, image_distance, 25e-3 / 8, 3.45e-6)
    assert math.isclose(known.speckle_size, CAMERA.speckle_size, rel_tol=1e-14)
    assert math.isclose(thick.working_f_number, 4 * (1 + 0.5 / 0.8), rel_tol=1e-14)
    assert math.isclose(thick.exit_pupil_diameter, 0.8 * 12.5e-3, rel_tol=1e-14)


def test_an_astigmatic_wave_has_the_curvature_tensor_of_its_axes() -> None:
    direction = np.array([0.3, -0.2, 1.0])
    wave = dc.Wavefront.astigmatic(direction, [1, 0, 0], 4.0, -3.0)
    n = unit(direction)
    along = unit(np.array([1.0, 0, 0]) - n * n[0])
    across = np.cross(n, along)
    expected = 4 * np.outer(along, along) - 3 * np.outer(across, across)
    np.testing.assert_allclose(wave.curvature, expected, atol=1e-14)
    again = dc.Wavefront.from_tensor(direction, expected)
    np.testing.assert_allclose(again.curvature, expected, atol=1e-14)
    dp = np.array([[1.0, 0.2, 0.5], [-0.3, 1.0, 0.1]])
    again = dc.Wavefront.from_differentials(direction, dp, -dp @ expected)
    np.testing.assert_allclose(again.curvature, expected, atol=1e-13)
    for wrong in (dp[:1], dp[[0, 1, 1]], dp[0], dp[:, :2]):
        with pytest.raises(ValueError, match=r"dl has the shape .* but must have \[2, 3\]"):
            dc.Wavefront.from_differentials(direction, dp, wrong)
    with pytest.raises(ValueError, match="^dp must be finite"):
        dc.Wavefront.from_differentials(direction, dp[[0, 0]], dp)


def test_rigid_motions_are_matrices() -> None:
    turn = dc.RigidMotion.about([0.1, 0.2, 0.3], [0, 0, 2], 0.4)
    c, s = math.cos(0.4), math.sin(0.4)
    matrix = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    np.testing.assert_allclose(turn.rotation, matrix, atol=1e-15)
    point = np.array([0.5, -0.7, 0.2])
    pivot = np.array([0.1, 0.2, 0.3])
    np.testing.assert_allclose(turn.point(point), matrix @ (point - pivot) + pivot, atol=1e-15)
    given = dc.RigidMotion(matrix, [1, 2, 3])
    np.testing.assert_allclose(given.point(point), matrix @ point + [1, 2, 3], atol=1e-15)
    frame = dc.CameraFrame.from_axes(matrix)
    np.testing.assert_allclose(frame.axes, matrix, atol=1e-15)
    both = turn.then(dc.RigidMotion.along([1, 2, 3]))
    np.testing.assert_allclose(both.point(point), turn.point(point) + [1, 2, 3], atol=1e-14)
    np.testing.assert_allclose(both.inverse().point(both.point(point)), point, atol=1e-14)
    np.testing.assert_allclose(turn.direction(point), matrix @ point, atol=1e-15)
    points = np.arange(12.0).reshape(2, 2, 3)
    np.testing.assert_allclose(given.point(points), points @ matrix.T + [1, 2, 3], atol=1e-14)
    np.testing.assert_allclose(given.direction(points), points @ matrix.T, atol=1e-14)
    far = dc.RigidMotion.along([1.7e308, 0, 0])
    for motion, too_far in ((far, points), (given, np.array([[1e301, 0, 0]]))):
        with pytest.raises(ValueError, match="^points must be"):
            motion.point(too_far)


BENCH = Bench()
OBJECTS = [
    CAMERA,
    dc.ImagingGeometry.from_thick_lens(WAVELENGTH, 50e-3, 4.0, 0.8, 3e-6, surface_to_pupil=0.4),
    dc.ImagingGeometry.from_distances(WAVELENGTH, 0.3, 0.03, 3e-3, 3.45e-6),
    CAMERA.with_wavelength(532e-9),
    BENCH.frame,
    BENCH.wave,
    dc.RigidMotion.about([0, 0, 1], [1, 2, 3], 0.3),
]


@pytest.mark.parametrize("thing", OBJECTS, ids=lambda thing: type(thing).__name__)
def test_objects_survive_pickling(thing: object) -> None:
    again = pickle.loads(pickle.dumps(thing))
    assert type(again) is type(thing)
    if isinstance(thing, (dc.CameraFrame, dc.Wavefront, dc.RigidMotion)):
        # Matrices are made orthonormal or symmetric again, by rounding.
        for name in ("axes", "direction_to_source", "curvature", "rotation", "translation"):
            if hasattr(thing, name):
                np.testing.assert_allclose(getattr(again, name), getattr(thing, name), atol=1e-15)
    else:
        assert again == thing
        assert copy.deepcopy(thing) == thing
        assert eval(repr(thing), vars(dc)) == thing


NAN3 = [0.0, math.nan, 0.0]
STATE, _ = BENCH.states(np.zeros(3))


def lens(**changes: float) -> dc.ImagingGeometry:
    values = {
        "wavelength": WAVELENGTH,
        "focal_length": 25e-3,
        "f_number": 8.0,
        "surface_to_pupil": 0.3,
        "pixel_pitch": 3.45e-6,
    }
    return dc.ImagingGeometry.from_lens(**(values | changes))


REFUSALS: list[tuple[Callable[[], object], str]] = [
    (lambda: lens(wavelength=0.0), "wavelength"),
    (lambda: lens(focal_length=-1.0), "focal_length"),
    (lambda: lens(f_number=0.1), "f_number"),
    (lambda: lens(f_number=1e9), "f_number"),
    (lambda: lens(surface_to_pupil=0.01), "surface_to_pupil"),
    (lambda: lens(pixel_pitch=math.nan), "pixel_pitch"),
    (lambda: CAMERA.with_wavelength(1.0), "wavelength"),
    (lambda: CAMERA.defocus_at([0.1, 0.0]), "depth"),
    (lambda: CAMERA.pattern_coordinate((0.0, 0.0), (0.0, 0.0), 0.0), "pattern_speckle_size"),
    (lambda: CAMERA.pattern_coordinate((0.0, 0.0), (math.nan, 0.0), 4.0), "image_displacement"),
    (lambda: dc.CameraFrame.from_axes(2 * np.eye(3)), "axes"),
    (lambda: dc.CameraFrame.from_axes(np.ones((2, 3))), "axes"),
    (lambda: dc.CameraFrame.look_at([0, 0, 1], [0, 0, 1], [0, 1, 0]), "target"),
    (lambda: dc.CameraFrame.look_at([0, 0, 1], [0, 0, 0], [0, 0, 1]), "up"),
    (lambda: dc.CameraFrame.look_at(NAN3, [0, 0, 0], [0, 0, 1]), "position"),
    (lambda: dc.ImagingGeometry.from_thick_lens(WAVELENGTH, 0.05, 4.0, 0.8, 3e-6), "magnification"),
    (lambda: dc.Illumination.collimated([0, 1]), "direction_to_source"),
    (lambda: dc.Wavefront.plane([0, 0, 0]), "direction_to_source"),
    (lambda: dc.Wavefront.spherical([0, 0, 1], math.inf), "curvature"),
    (lambda: dc.Wavefront.astigmatic([0, 0, 1], [0, 0, 1], 1, 1), "axis"),
    (lambda: dc.Wavefront.astigmatic([0, 0, 1], [1, 0, 1], 1, math.nan), "curvature_across"),
    (lambda: dc.Wavefront.from_tensor([0, 0, 1], np.triu(np.ones((3, 3)))), "curvature"),
    (lambda: dc.RigidMotion(-np.eye(3), [0, 0, 0]), "rotation"),
    (lambda: dc.RigidMotion.along(NAN3), "translation"),
    (lambda: dc.RigidMotion.about([0, 0, 0], [0, 0, 0], 1.0), "axis"),
    (lambda: dc.RigidMotion.about([0, 0, 0], [0, 0, 1], math.inf), "angle"),
    (lambda: dc.Illumination.point_source(NAN3), "position"),
    (lambda: STATE.with_wavelength(-1.0), "wavelength"),
    (lambda: STATE.with_illumination(dc.Illumination.point_source(BENCH.point)), "illumination"),
    (lambda: STATE.moved(camera=dc.RigidMotion.along([0, 0, -9])), "motions"),
    (lambda: dc.equivalent_pupil_shift([0.5, -0.2]), "correlation"),
    (lambda: dc.equivalent_axial_shift(1.2), "correlation"),
]


@pytest.mark.parametrize(("call", "parameter"), REFUSALS)
def test_a_refusal_names_the_parameter(call: Callable[[], object], parameter: str) -> None:
    with pytest.raises(tem00.ParameterError) as caught:
        call()
    assert caught.value.parameter == parameter
