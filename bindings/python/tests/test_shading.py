"""One call per hit: against the Rust crate, law of motion, lights of `tem00.beam`, and itself."""

import math
import pickle
import runpy
import threading
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import tem00
from numpy.typing import NDArray
from tem00 import beam
from tem00 import decorrelation as dc
from tem00._typing import FloatArray
from tem00.coherence import ResolutionCell, Spectrum

ROOT = Path(__file__).parents[3]
ORIGIN, TARGET = [0.05, 0.02, 0.4], [0.0, 0.0, 0.0]
CAMERA = tem00.Camera(position=[-0.05, 0.01, 0.3], resolution=(96, 64))
LASER = tem00.Laser.spot(650e-9, 5e-3, origin=ORIGIN, target=TARGET, power=2e-3)
UP = np.array([0.0, 0.0, 1.0])
SLIDE, AWAY = tem00.Pose.along([4e-4, -2e-4, 0.0]), tem00.Pose.along([2e-3, 0.0, 0.0])
MOVED = tem00.Speckle(CAMERA, LASER, 7, poses=[SLIDE], memory=64 << 20)
FAR = tem00.Speckle(CAMERA, LASER, 1, poses=[SLIDE] * 3, memory=64 << 20)


def seen(pixels: NDArray[np.float64]) -> FloatArray:
    """Return the points of the plane z = 0 that the camera sees."""
    origin, direction = CAMERA.ray(pixels)
    return np.asarray(origin - origin[2] / direction[..., 2:] * direction, dtype=np.float64)


def image() -> FloatArray:
    """Return the image points of all pixels."""
    width, height = CAMERA.resolution
    x, y = np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5)
    return np.stack([x, y], axis=-1).astype(np.float64)


def carried(pose: tem00.Pose, points: FloatArray) -> FloatArray:
    """Return where a pose takes points."""
    return np.asarray(points @ pose.rotation.T + pose.translation, dtype=np.float64)


def test_a_fixed_case_has_the_values_of_the_rust_crate() -> None:
    # Printed by tem00-shading for the same arguments.
    surface = tem00.Pose.about(TARGET, [0, 1, 0], 1e-3).then(tem00.Pose.along([2e-4, -1e-4, 5e-4]))
    camera = tem00.Pose.along([0, 1e-4, 0])
    laser = tem00.Pose.about(ORIGIN, [0, 1, 0], 5e-4)
    speckle = tem00.Speckle(
        CAMERA,
        LASER,
        7,
        poses=[surface],
        camera_poses=[camera],
        laser_poses=[laser],
        looks=2,
        polarisation=0.6,
        memory=32 << 20,
    )
    frame = speckle.frame(surface, camera, laser, body=2)
    points = np.array([[0, 0, 5e-4], [3e-4, 2e-4, 5e-4], [-4e-4, 1e-4, 6e-4], [0, 0, 1]])
    normal = np.array([1e-3, 0, 1]) / math.hypot(1e-3, 1)
    shift = frame.shift(points, normal)
    # In single precision, of phases that another processor rounds otherwise.
    close = 1e-5
    factors = [1.0159947783, 0.2584848523, 0.9531888336, 1]
    averages = [1.0901372565, 0.2924545030, 0.8902109999, 1]
    real = [0.8132971326, -0.1117709498, 1.3222466281, 0]
    imaginary = [0.0924461514, -0.4250864862, -0.2261591300, 0]
    np.testing.assert_allclose(frame.factor(points, normal), factors, rtol=0, atol=close)
    np.testing.assert_allclose(frame.average(points, normal), averages, rtol=0, atol=close)
    amplitudes = np.asarray(frame.amplitude(points, normal))
    np.testing.assert_allclose(amplitudes.real, real, rtol=0, atol=close)
    np.testing.assert_allclose(amplitudes.imag, imaginary, rtol=0, atol=close)
    shifts = [
        (shift.displacement[:, 0], [7.522644010289848, 7.534671111038488, 7.505450554697517, 0]),
        (shift.displacement[:, 1], [5.666295421084302, 5.658126370363691, 5.662896966244203, 0]),
        (shift.across[:, 0], [0.23535250670433813, 0.235508265216536, 0.23513533897892405, 0]),
        (shift.across[:, 1], [-0.06875430707920618, -0.06865982499315146, -0.06870725289236154, 0]),
        (shift.pupil, [0.24523301918840543, 0.24535597014234217, 0.24501157549314792, math.inf]),
        (shift.axial, [0.009217195300193153, 0.009208607163777022, 0.009235041659411797, 0]),
    ]
    for got, expected in shifts:
        np.testing.assert_allclose(got, expected, rtol=1e-9)
    overlaps = tem00.decorrelation.pupil_overlap_correlation(np.minimum(shift.pupil, 1))
    np.testing.assert_array_equal(shift.correlation, overlaps)
    chosen = "4 patterns of 128 × 80 samples in 64 slices (20 MiB): speckle of 1.64 px, "
    assert str(speckle).startswith(chosen)
    assert repr(speckle) == f"<Speckle: {speckle}>"
    assert speckle.memory_bytes >> 20 == 20
    assert f"{speckle.speckle_size:.2f}" == "1.64"


def test_shifts_are_those_of_the_law_between_two_states() -> None:
    # At f/2 one axial decorrelation length is 3 mm; the light diverges, and the focus lies behind.
    camera = tem00.Camera(
        position=[-0.05, 0.01, 0.3], f_number=2, focus_distance=0.31, resolution=(16, 12)
    )
    laser = tem00.Laser.spot(650e-9, 30e-6, origin=ORIGIN, target=TARGET, focused_at=0.0)
    axes = dc.CameraFrame.look_at(camera.position, TARGET, [0, 1, 0])
    geometry = dc.ImagingGeometry.from_lens(650e-9, 25e-3, 2.0, 0.31, 3.45e-6)
    random = np.random.default_rng(5)

    def pose(slide: float, turn: float) -> tem00.Pose:
        turned = tem00.Pose.about(TARGET, random.normal(size=3), random.uniform(-turn, turn))
        return turned.then(tem00.Pose.along(random.uniform(-slide, slide, 3)))

    left = []
    for _ in range(24):
        body, eye, source = pose(2e-3, 5e-3), pose(2e-4, 1e-3), pose(1e-3, 1e-3)
        speckle = tem00.Speckle(
            camera,
            laser,
            1,
            poses=[body],
            camera_poses=[eye],
            laser_poses=[source],
            memory=64 << 20,
        )
        point, normal = random.uniform(-3e-3, 3e-3, 3), random.normal(size=3) / 4 + UP
        normal /= np.linalg.norm(normal)
        seen = body.point(point)
        before = dc.Configuration(
            wavelength=650e-9,
            point=point,
            normal=normal,
            illumination=dc.Illumination.collimated(laser.next_event(point).wi),
            camera=axes,
            pupil=camera.position,
        )
        lit = source.direction(laser.next_event(source.inverse().point(seen)).wi)
        after = before.moved(surface=body, camera=eye)
        after = after.with_illumination(dc.Illumination.collimated(lit))
        law = dc.speckle_motion(geometry, before, after)
        shift = speckle.frame(body, eye, source).shift(seen, body.direction(normal))
        expected = law.speckle_displacement * [1, -1] / 3.45e-6
        np.testing.assert_allclose(shift.displacement, expected, rtol=1e-9)
        # The polynomial of what a motion along the axis takes.
        np.testing.assert_allclose(shift.correlation, law.correlation, rtol=0, atol=1e-5)
        left.append(law.correlation)
    assert sum(0.1 < gamma < 0.9 for gamma in left) > 12, left


def test_rays_are_those_of_a_pinhole() -> None:
    # The camera looks down from 0.3 m, with y up in its image; d is the image distance in pixels.
    d = 25e-3 * 0.3 / (0.3 - 25e-3) / 3.45e-6
    x, y = 1500.0, 900.0
    pixel = [2000 + x, 1500 - y]

    def tangents(**given: object) -> FloatArray:
        camera = tem00.Camera(resolution=(4000, 3000), **given)  # type: ignore[arg-type]
        origin, direction = camera.ray(pixel)
        np.testing.assert_array_equal(origin, [0, 0, 0.3])
        return np.asarray(direction[:2] / -direction[2], dtype=np.float64)

    np.testing.assert_allclose(tangents(), [x / d, y / d], rtol=1e-12)
    moved = tangents(principal_point=[1980, 1460])
    np.testing.assert_allclose(moved, [(x + 20) / d, (y - 40) / d], rtol=1e-12)
    # Brown: the image point is the tangent times 1 + k₁ r² + k₂ r⁴ + k₃ r⁶.
    bent = tangents(distortion=[-0.2, 0.3, -0.4])
    r2 = bent @ bent
    stretch = 1 - 0.2 * r2 + 0.3 * r2**2 - 0.4 * r2**3
    np.testing.assert_allclose(bent * stretch, [x / d, y / d], rtol=1e-9)
    # The upper half of the sensor, upright, turns towards the lens.
    tilt = 0.1
    depth = d - y * math.sin(tilt)
    tilted = [x / depth, y * math.cos(tilt) / depth]
    np.testing.assert_allclose(tangents(tilt=[tilt, 0]), tilted, rtol=1e-12)
    depth = d + x * math.sin(tilt)
    turned = [x * math.cos(tilt) / depth, y / depth]
    np.testing.assert_allclose(tangents(tilt=[tilt, math.pi / 2]), turned, rtol=1e-12)


def test_batches_have_the_bits_of_single_calls_and_shapes_broadcast() -> None:
    frame = MOVED.frame(SLIDE)
    # More than one block of 4096.
    points = carried(SLIDE, seen(image()))[:50]
    points[7, 9] = np.nan
    normals = np.broadcast_to(UP, points.shape)
    for query in (frame.factor, frame.average, frame.amplitude):
        whole = np.asarray(query(points, UP))
        assert whole.shape == points.shape[:-1]
        np.testing.assert_array_equal(whole, query(points, normals))
        for place in ((0, 0), (7, 9), (44, 63), (49, 95)):
            assert whole[place] == query(points[place], UP)
    assert type(frame.factor(points[0, 0], UP)) is float
    assert type(frame.amplitude(points[0, 0], UP)) is complex
    assert np.shape(frame.factor(points[0, 0], np.tile(UP, (2, 5, 1)))) == (2, 5)
    assert np.shape(frame.shift(points[0, 0], UP).pupil) == ()
    shift = frame.shift(points, UP)
    assert shift.displacement.shape == (*points.shape[:-1], 2)
    np.testing.assert_array_equal(
        shift.displacement[44, 63], frame.shift(points[44, 63], UP).displacement
    )


def test_samples_in_focus_see_a_point_where_the_middle_of_the_lens_does() -> None:
    frame = MOVED.frame(SLIDE)
    pixels, points = image(), seen(image())
    np.testing.assert_allclose(CAMERA.project(points), pixels, rtol=0, atol=1e-9)
    np.testing.assert_array_equal(CAMERA.project([[0.0, 0.0, 1.0], [0.0, math.nan, 0.0]]), np.inf)
    at_samples = frame.factor_at(pixels, points, UP)
    # The same look-ups but for rounding, which the edge-free patterns hardly tell.
    np.testing.assert_allclose(at_samples, frame.factor(points, UP), rtol=0, atol=1e-6)
    # The speckle of the neighbour moves as far, but for 3e-4 of a pixel.
    beside = np.asarray(frame.factor_at(pixels + [1, 0], points, UP))
    np.testing.assert_allclose(beside[:, :-1], np.asarray(at_samples)[:, 1:], rtol=0, atol=1e-2)
    assert frame.factor_at([1, math.nan], points[0, 0], UP) == 1


def test_what_is_out_of_sight_has_the_factor_one_and_no_nan() -> None:
    frame = MOVED.frame(SLIDE)
    points = np.array([[np.nan, 0, 0], [np.inf, 0, 0], [0, 0, 1.0], [0, 0, 0]])
    factors = frame.factor(points, UP)
    np.testing.assert_array_equal(np.asarray(factors)[:3], 1)
    np.testing.assert_array_equal(np.asarray(frame.average(points, UP))[:3], 1)
    np.testing.assert_array_equal(np.asarray(frame.amplitude(points, UP))[:3], 0)
    shift = frame.shift(points, UP)
    np.testing.assert_array_equal(np.asarray(shift.pupil)[:3], np.inf)
    np.testing.assert_array_equal(np.asarray(shift.correlation)[:3], 0)
    assert np.isfinite(frame.factor(TARGET, [np.nan, 0, 0]))


def test_buffers_of_positions_have_the_bits_of_hits() -> None:
    # Steps that the sums of the points have exactly.
    steps = np.array([[0, 0, 0], [2.0**-12, -(2.0**-13), 2.0**-11]])
    poses = [tem00.Pose.along(step) for step in steps]
    speckle = tem00.Speckle(CAMERA, LASER, 17, poses=poses)
    x, y = np.meshgrid(np.arange(16.0) - 8, np.arange(12.0) - 6)
    previous = np.stack([x, y, 0 * x], axis=-1) * 2.0**-13
    moved = (x + y > 0)[..., None]
    points = previous + moved * steps[1]
    still, away = (np.asarray(speckle.frame(pose).factor(points, UP)) for pose in poses)
    expected = np.where(moved[..., 0], away, still)
    np.testing.assert_array_equal(speckle.factors_since(previous, points, UP), expected)
    assert np.any(away != still)


LASERS: list[tuple[tem00.Laser, Callable[[beam.Placement], beam.Light]]] = [
    (
        tem00.Laser.spot(650e-9, 5e-3, origin=ORIGIN, target=TARGET, power=2e-3, focused_at=0.3),
        lambda placement: beam.Light.spot(
            beam.GaussianBeam.from_waist(650e-9, 5e-3), 0.3, placement, 2e-3
        ),
    ),
    (
        tem00.Laser.spot(
            650e-9, [2e-4, 3e-4], origin=ORIGIN, target=TARGET, focused_at=-0.1, m_squared=1.5
        ),
        lambda placement: beam.Light.elliptic(
            beam.AstigmaticBeam(*(located(radius) for radius in (2e-4, 3e-4))), placement, 1e-3
        ),
    ),
    *(
        (
            tem00.Laser.line(
                *(650e-9, 2e-4, 0.1),
                origin=ORIGIN,
                target=TARGET,
                profile=profile,
                power=5e-3,
                focused_at=0.3,
            ),
            lambda placement, profile=profile: beam.Light.line(fan(profile), placement, 5e-3),
        )
        for profile in (
            beam.LineProfile.gaussian_tan(),
            beam.LineProfile.powell(0.1),
            beam.LineProfile.tabulated([-0.05, 0.0, 0.05], [1.0, 2.0, 1.0]),
        )
    ),
]


def located(radius: float) -> beam.LocatedBeam:
    return beam.LocatedBeam(beam.GaussianBeam.from_waist(650e-9, radius).with_m_squared(1.5), -0.1)


def fan(profile: beam.LineProfile) -> beam.LaserLine:
    focus = beam.GaussianBeam.from_waist(650e-9, 1e-4)
    offset = focus.radius_at(0.3) / math.tan(0.05)
    return beam.LaserLine(focus, beam.FanGeometry(0.1, offset, 0.3, "equal_plane"), profile)


def test_a_laser_is_focused_at_its_target() -> None:
    assert math.isclose(LASER.light.to_rows()[4, 2], math.dist(ORIGIN, TARGET), rel_tol=1e-7)


@pytest.mark.parametrize(("laser", "place"), LASERS)
def test_lasers_are_the_lights_of_beam(
    laser: tem00.Laser, place: Callable[[beam.Placement], beam.Light]
) -> None:
    light = place(beam.Placement(ORIGIN, np.subtract(TARGET, ORIGIN), [1, 0, 0]))
    assert laser.light == light
    assert (laser.wavelength, laser.power) == (light.wavelength, light.power)
    points = np.random.default_rng(1).uniform(-0.01, 0.01, (5, 40, 3))
    points[0, 0] = [0, 0, 1]  # behind the aperture
    event, expected = laser.next_event(points), light.next_event(*np.moveaxis(points, -1, 0))
    for member in ("point", "distance", "wi", "e_perp"):
        np.testing.assert_array_equal(getattr(event, member), getattr(expected, member))
    assert laser.next_event(points[0, 0]).e_perp == 0
    assert laser.next_event(TARGET).e_perp > 0
    assert repr(laser).startswith("<Laser: wavelength=6.5e-07, light=<Light: ")


@pytest.mark.parametrize(
    ("make", "parameter"),
    [
        (lambda: tem00.Camera(focal_length=-1.0), "focal_length"),
        (lambda: tem00.Camera(f_number=math.nan), "f_number"),
        (lambda: tem00.Camera(position=[0, 0]), "position"),
        (lambda: tem00.Camera(look_at=[0, 0, 0.3]), "look_at"),
        (lambda: tem00.Camera(up=[0, 0, 1]), "up"),
        (lambda: tem00.Camera(resolution=(0, 5)), "resolution"),
        (lambda: tem00.Camera(resolution=(-1, 5)), "resolution"),
        (lambda: tem00.Camera(tilt=[2.0, 0.0]), "tilt"),
        (lambda: tem00.Camera(distortion=[1, 2]), "distortion"),
        (lambda: tem00.Camera(principal_point=[math.inf, 0]), "principal_point"),
        (lambda: CAMERA.ray([1.0, math.nan]), "pixels"),
        (lambda: CAMERA.ray([1.0, 2.0, 3.0]), "pixels"),
        (lambda: spot(wavelength=-1.0), "wavelength"),
        (lambda: spot(wavelength=650), "wavelength"),
        (lambda: line(wavelength=650), "wavelength"),
        (lambda: spot(waist_radius=1e-9), "waist_radius"),
        (lambda: spot(waist_radius=[1e-3, 1e-3, 1e-3]), "waist_radius"),
        (lambda: spot(origin=[0, math.nan, 0]), "origin"),
        (lambda: spot(target=ORIGIN), "target"),
        (lambda: spot(line_direction=[0, 0, 0]), "line_direction"),
        (lambda: spot(power=-1.0), "power"),
        (lambda: spot(focused_at=math.inf), "focused_at"),
        (lambda: spot(m_squared=0.5), "m_squared"),
        (lambda: line(thickness=1e-9), "thickness"),
        (lambda: line(fan_angle=4.0), "fan_angle"),
        (lambda: line(fan_angle=-0.1), "fan_angle"),
        (lambda: line(focused_at=math.nan), "focused_at"),
        (lambda: LASER.next_event([0, 0, math.nan]), "points"),
        (lambda: tem00.Speckle(CAMERA, LASER, -1), "seed"),
        (lambda: tem00.Speckle(CAMERA, LASER, 1, looks=0), "looks"),
        (lambda: tem00.Speckle(CAMERA, LASER, 1, polarisation=1.5), "polarisation"),
        (
            lambda: tem00.Speckle(CAMERA, LASER, 1, poses=[SLIDE] * 2, camera_poses=[SLIDE]),
            "camera_poses",
        ),
        (lambda: tem00.Speckle(CAMERA, LASER, 1, at_points=([[0, 0]], UP)), "at_points"),
        (lambda: FAR.frame(tem00.Pose.about(TARGET, [0, 1, 0], 0.05)), "surface"),
        (lambda: MOVED.frame(body=-1), "body"),
        (lambda: MOVED.frame().factor([0, 0], UP), "points"),
        (lambda: MOVED.frame().factor_at([0, 0, 0], TARGET, UP), "pixels"),
        (lambda: MOVED.frame().factor(np.zeros((2, 3)), np.zeros((5, 3))), "normals"),
    ],
)
def test_each_refused_argument_is_named(make: Callable[[], object], parameter: str) -> None:
    with pytest.raises(tem00.ParameterError) as caught:
        make()
    assert caught.value.parameter == parameter
    assert "fan_axis" not in str(caught.value)


def test_patterns_that_no_memory_holds_are_a_memory_error() -> None:
    for poses, memory in [([], 1000), ([AWAY] * 9, 700_000)]:
        with pytest.raises(MemoryError, match="the patterns need [0-9]+ MiB"):
            tem00.Speckle(CAMERA, LASER, 1, poses=poses, memory=memory)


def spot(wavelength: float = 650e-9, waist_radius: object = 1e-3, **given: object) -> tem00.Laser:
    arguments = {"origin": ORIGIN, "target": TARGET, **given}
    return tem00.Laser.spot(wavelength, waist_radius, **arguments)  # type: ignore[arg-type]


def line(**given: object) -> tem00.Laser:
    arguments = {"wavelength": 650e-9, "thickness": 1e-4, "fan_angle": 0.1, **given}
    return tem00.Laser.line(
        **{"origin": ORIGIN, "target": TARGET, **arguments}  # type: ignore[arg-type]
    )


def test_given_points_decide_how_far_the_speckle_moves() -> None:
    turn = tem00.Pose.about(TARGET, [0, 1, 0], 5e-4)
    shown = []
    # In the plane in focus, and twice as far away.
    for point in (TARGET, [0.05, -0.01, -0.3]):
        speckle = tem00.Speckle(CAMERA, LASER, 1, poses=[turn], at_points=([point], UP))
        shown.append(float(str(speckle).split("moves by ")[1].split()[0]))
        shift = speckle.frame(turn).shift(turn.point(point), turn.direction(UP))
        assert abs(np.asarray(shift.pupil).item() - shown[-1]) <= 0.005
    assert abs(shown[0] - shown[1]) > 0.02


def test_the_interpreter_is_free_while_patterns_are_made() -> None:
    counts: list[int] = []
    done = threading.Event()

    def work() -> None:
        tem00.Speckle(tem00.Camera(), LASER, 1, poses=[SLIDE], memory=64 << 20)
        done.set()

    worker = threading.Thread(target=work)
    worker.start()
    while not done.wait(1e-4):
        counts.append(len(counts))
    worker.join()
    assert len(counts) > 10


def test_shifts_survive_pickling_and_frames_hold_their_patterns() -> None:
    frame = tem00.Speckle(CAMERA, LASER, 7, poses=[SLIDE], memory=64 << 20).frame(SLIDE)
    point = SLIDE.point(TARGET)
    shift = frame.shift(point, UP)
    assert repr(pickle.loads(pickle.dumps(shift))) == repr(shift)
    assert repr(frame).startswith(f"<SpeckleFrame: poses=({SLIDE!r}, ")
    assert frame.factor(point, UP) == MOVED.frame(SLIDE).factor(point, UP)


def test_the_example_of_the_guide_finds_the_law() -> None:
    example = ROOT / "bindings" / "integrations" / "python" / "moved_spot.py"
    names = runpy.run_path(str(example))
    law = names["shift"].correlation
    # Some 40 000 speckles, and what the blend of slices adds.
    assert abs(names["found"] - law) < 0.03
    before, after = names["frames"]
    assert before.shape == (480, 640)
    # The mean of so many speckles, weighted by the light: 5 mW at an angle of 27°.
    assert abs(before.sum() / after.sum() - 1) < 0.02


def test_a_linewidth_lowers_the_contrast_by_the_law_of_a_resolution_cell() -> None:
    line = Spectrum(650e-9, 5e-9)
    laser = tem00.Laser.spot(line, 50e-3, origin=[0, 0, 3], target=TARGET)
    eye = 0.3 * np.array([0.5, 0.0, np.cos(np.radians(30))])
    camera = tem00.Camera(position=eye, resolution=[480, 360])
    frame = tem00.Speckle(camera, laser, 3, at_points=(TARGET, UP), rms_height=2e-6).frame()
    pixels = 40.0 + 4.3 * np.stack(np.meshgrid(np.arange(64), np.arange(56)), axis=-1)
    origin, direction = camera.ray(pixels)
    points = origin - float(origin[2]) / direction[..., 2:] * direction
    factors = np.asarray(frame.factor(points, UP))
    sin_aperture = 0.5 * 25e-3 / 8 / 0.3
    law = ResolutionCell([0, 0, 1], eye, UP, sin_aperture, 650e-9, rms_height=2e-6).contrast(line)
    assert np.std(factors) / np.mean(factors) == pytest.approx(law, rel=0.06)
    waves = [np.asarray(frame.factor_in_wave(points[:8, 0], UP, (i + 0.5) / 64)) for i in range(64)]
    assert np.mean(waves, axis=0) == pytest.approx(factors[:8, 0], rel=0.15)
    with pytest.raises(tem00.ParameterError, match="at_points"):
        tem00.Speckle(camera, laser, 3)
