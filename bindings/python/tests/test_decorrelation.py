"""Speckle motion against optical paths in NumPy, correlations against quadrature by SciPy."""

import copy
import math
import pickle
from collections.abc import Callable

import numpy as np
import pytest
import tem00
from numpy.typing import NDArray
from scipy import integrate
from tem00 import decorrelation as dc
from tem00._typing import FloatArray

WAVELENGTH = 650e-9
LENS = dc.LensData(
    wavelength=WAVELENGTH,
    focal_length=25e-3,
    f_number=8.0,
    surface_to_pupil=0.3,
    pixel_pitch=3.45e-6,
)
CAMERA = dc.ImagingGeometry.from_lens(LENS)


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
        return before, before.moved(dc.RigidMotions(surface=dc.RigidMotion.along(motion)))

    def phases(self, pupil: FloatArray, motion: FloatArray) -> FloatArray:
        """Return the optical paths, source to scatterers to pupil points, as (pupil, scatterer)."""
        spread = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]]) * 1e-6
        scatterers = self.point + spread + motion
        arriving = np.linalg.norm(self.source - scatterers, axis=-1)
        leaving = np.linalg.norm(pupil[:, None] - scatterers[None], axis=-1)
        return np.asarray(arriving + leaving, dtype=np.float64)

    def exact_pupil_displacement(self, motion: FloatArray) -> FloatArray:
        """Return where the paths' differences over the surface are those of the centre before."""
        axes = np.stack([self.frame.right, self.frame.up])

        def differences(place: FloatArray, moved: FloatArray) -> FloatArray:
            paths = self.phases((self.eye + place @ axes)[None], moved)[0]
            return np.asarray((paths[1:] - paths[0]) / 1e-6, dtype=np.float64)

        wanted = differences(np.zeros(2), np.zeros(3))
        place = np.zeros(2)
        for _ in range(8):
            slope = np.stack(
                [
                    (differences(place + step, motion) - differences(place - step, motion)) / 2e-3
                    for step in 1e-3 * np.eye(2)
                ],
                axis=1,
            )
            place = place - np.linalg.solve(slope, differences(place, motion) - wanted)
        return place


@pytest.mark.parametrize("direction", [[1, 0, 0], [0, 1, 0], [0, 0, 1], [0.3, -0.5, 0.2]])
def test_the_pupil_displacement_keeps_the_differences_of_optical_paths(
    direction: list[float],
) -> None:
    bench = Bench()
    motion = 20e-6 * np.array(direction, dtype=float)
    expected = bench.exact_pupil_displacement(motion)
    before, after = bench.states(motion)
    exact = before.pupil_point_after(after, [0.0, 0.0])
    assert exact is not None
    # What is left is the rounding of paths and the curvature over the 1 µm between scatterers,
    # 1e-6 / 0.3 of the motion, some 2e-9 m.
    np.testing.assert_allclose(exact, expected, rtol=0, atol=4e-9)


def test_the_image_moves_as_a_pinhole_sees_the_point() -> None:
    bench = Bench()
    motion = np.array([15e-3, -10e-3, 20e-3])
    axes = np.stack([bench.frame.right, bench.frame.up, bench.frame.towards_camera])

    def image(point: FloatArray) -> FloatArray:
        x, y, z = axes @ (point - bench.eye)
        return np.array([x / -z, y / -z], dtype=np.float64) * CAMERA.principal_distance

    expected = image(bench.point + motion) - image(bench.point)
    speckle = dc.SpeckleMotion.between(CAMERA, *bench.states(motion))
    np.testing.assert_allclose(speckle.image_displacement, expected, rtol=1e-12)
    assert math.isclose(speckle.axial_displacement, float(axes[2] @ motion), rel_tol=1e-12)


def disc_overlap(shift: float) -> float:
    """Return the fraction of a disc of diameter 1 that its displaced copy covers."""
    def chord(x: float) -> float:
        return 4 / math.pi * math.sqrt(max(0.0, 1 - x * x))

    return integrate.quad(chord, abs(shift), 1)[0] if abs(shift) < 1 else 0.0


def test_correlations_are_those_of_the_pupil_by_quadrature() -> None:
    shifts = np.array([0.0, 0.05, 0.3, 0.6, 0.95, 1.0, 2.0])
    overlaps = np.array([disc_overlap(float(s)) for s in shifts])
    # A root at the end of the chord: 1e-8.
    np.testing.assert_allclose(dc.pupil_overlap_correlation(shifts), overlaps**2, atol=1e-7)
    np.testing.assert_allclose(dc.axial_correlation(shifts), np.sinc(shifts) ** 2, atol=1e-15)
    peak = dc.CorrelationLaw.at_peak()
    np.testing.assert_array_equal(peak.correlation(shifts, 0.0), dc.pupil_overlap_correlation(shifts))


@pytest.mark.parametrize(("s", "x"), [(0.1, 0.62), (0.26, 0.66), (0.5, 1.3), (0.0, 0.4)])
def test_the_correlation_laws_are_integrals_over_the_shared_lens(s: float, x: float) -> None:
    beta = 2 * math.pi * x

    def integral(centre: float) -> float:
        # Integrated over angle-free coordinates: x across the lens by Gauss, y by the chord.
        def part(function: Callable[[float], float]) -> float:
            def column(u: float) -> float:
                height = math.sqrt(max(0.0, 1 - (abs(u) + s) ** 2))
                return integrate.quad(
                    lambda y: function(beta * ((u - centre) ** 2 + y * y)), -height, height,
                    epsabs=1e-11,
                )[0]

            return integrate.quad(column, s - 1, 1 - s, points=[0.0], epsabs=1e-9)[0]

        return (part(math.cos) ** 2 + part(math.sin) ** 2) / math.pi**2

    # The chord's root at either end leaves 1e-7.
    assert abs(dc.CorrelationLaw.at_peak().correlation(s, x) - integral(0.0)) < 1e-6
    law = dc.CorrelationLaw.at_image_displacement()
    assert abs(law.correlation(s, x) - integral(s)) < 1e-6


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
    assert math.isclose(CAMERA.depth_of_focus, 4 * WAVELENGTH * (0.3 * 8 / 25e-3) ** 2, rel_tol=1e-14)
    depths = np.array([0.2, 0.3, 0.5])
    np.testing.assert_allclose(CAMERA.defocus_at(depths), 1 / depths - 1 / 0.3, rtol=1e-14)
    x, y = CAMERA.pattern_coordinate(([10.0, 20.0], 5.0), (CAMERA.pixel_pitch, 0.0), 4.0)
    scale = 4 / CAMERA.speckle_size_in_pixels
    np.testing.assert_allclose(x, scale * np.array([9.0, 19.0]), rtol=1e-13)
    np.testing.assert_allclose(y, -scale * np.array([5.0, 5.0]), rtol=1e-13)
    thick = dc.ImagingGeometry.from_thick_lens(
        dc.ThickLensData(
            wavelength=WAVELENGTH,
            focal_length=50e-3,
            f_number=4.0,
            pupil_magnification=0.8,
            focus=dc.Focus.magnification(0.5),
            pixel_pitch=3.45e-6,
        )
    )
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
    np.testing.assert_allclose(frame.right, matrix[:, 0], atol=1e-15)
    both = turn.then(dc.RigidMotion.along([1, 2, 3]))
    np.testing.assert_allclose(both.point(point), turn.point(point) + [1, 2, 3], atol=1e-14)
    np.testing.assert_allclose(both.inverse().point(both.point(point)), point, atol=1e-14)
    np.testing.assert_allclose(turn.direction(point), matrix @ point, atol=1e-15)


def test_large_changes_alter_the_phase_of_heights() -> None:
    pupil = [0.0, 0.0, 0.3]
    before = dc.Configuration(
        wavelength=650e-9,
        point=[0, 0, 0],
        normal=[0, 0, 1],
        illumination=dc.Illumination.collimated([0, 0, 1]),
        camera=dc.CameraFrame.look_at(pupil, [0, 0, 0], [0, 1, 0]),
        pupil=pupil,
    )
    change = before.height_phase_change(before.with_wavelength(651e-9))
    assert change is not None
    assert math.isclose(change, 4 * math.pi * (1 / 651e-9 - 1 / 650e-9), rel_tol=1e-9)
    tilted = before.moved(
        dc.RigidMotions(surface=dc.RigidMotion.about([0, 0, 0], [0, 1, 0], 0.3e-3))
    )
    # The reflected light turns by twice the tilt: tan 0.6 mrad · 0.3 m.
    moved = before.pupil_point_after(tilted, [0, 0])
    assert moved is not None
    np.testing.assert_allclose(moved, [0.3 * math.tan(0.6e-3), 0], atol=2e-10)
    speckle = dc.SpeckleMotion.between(CAMERA, before, tilted)
    assert math.isclose(speckle.correlation, disc_overlap(180e-6 / 3.125e-3) ** 2, rel_tol=1e-5)


BENCH = Bench()
OBJECTS = [
    LENS,
    dc.Focus.surface_to_principal_plane(0.2),
    CAMERA,
    CAMERA.with_wavelength(532e-9),
    BENCH.frame,
    BENCH.wave,
    dc.RigidMotion.about([0, 0, 1], [1, 2, 3], 0.3),
    dc.CorrelationLaw.at_peak(),
]


@pytest.mark.parametrize("thing", OBJECTS, ids=lambda thing: type(thing).__name__)
def test_objects_survive_pickling(thing: object) -> None:
    again = pickle.loads(pickle.dumps(thing))
    if isinstance(thing, (dc.CameraFrame, dc.Wavefront, dc.RigidMotion)):
        # Matrices are made orthonormal or symmetric again, by rounding.
        assert type(again) is type(thing)
        numbers = np.array([float(x) for x in _numbers(repr(thing))])
        np.testing.assert_allclose(
            np.array([float(x) for x in _numbers(repr(again))]), numbers, atol=1e-15
        )
    else:
        assert again == thing
        assert copy.deepcopy(thing) == thing
        assert eval(repr(thing), vars(dc)) == thing


def _numbers(text: str) -> list[str]:
    inside = text[text.index("(") + 1 : -1]
    return inside.replace("[", " ").replace("]", " ").replace(",", " ").split()


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
    return dc.ImagingGeometry.from_lens(dc.LensData(**(values | changes)))


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
    (lambda: dc.LineOfSight(BENCH.frame, [0, 0, 0]), "to_pupil"),
    (lambda: dc.LineOfSight(BENCH.frame, [0, 0]), "to_pupil"),
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
    (lambda: STATE.moved(dc.RigidMotions(camera=dc.RigidMotion.along([0, 0, -9]))), "motions"),
    (lambda: STATE.pupil_point_after(STATE, [0, 0, 0]), "pupil_point"),
    (lambda: dc.equivalent_pupil_shift([0.5, -0.2]), "correlation"),
    (lambda: dc.equivalent_axial_shift(1.2), "correlation"),
]


@pytest.mark.parametrize(("call", "parameter"), REFUSALS)
def test_a_refusal_names_the_parameter(call: Callable[[], object], parameter: str) -> None:
    with pytest.raises(tem00.ParameterError) as caught:
        call()
    assert caught.value.parameter == parameter


def test_vectors_come_back_as_arrays() -> None:
    right: NDArray[np.float64] = BENCH.frame.right
    assert right.shape == (3,)
