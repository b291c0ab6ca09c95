"""Refusals, representations and pickles of beams."""

import pickle
from collections.abc import Callable

import numpy as np
import pytest
from tem00 import ParameterError, beam
from tem00.beam import closed_form

NAN, INF = float("nan"), float("inf")
LASER = beam.GaussianBeam.from_waist(650e-9, 1e-4)
LOCATED = beam.LocatedBeam(LASER, 0.1)
ELLIPTIC = beam.AstigmaticBeam(LOCATED, LOCATED)
PLACEMENT = beam.Placement((0, 0, 0.3), (0, 0, -1), (1, 0, 0))
SPOT = beam.Light.spot(LASER, 0.1, PLACEMENT, 1e-3)
FAN = beam.FanGeometry(0.5, 2e-3, 0.2)
LINE = beam.LaserLine(LASER, FAN, beam.LineProfile.powell(0.1))
TABULATED = beam.LaserLine(LASER, FAN, beam.LineProfile.tabulated([-0.2, 0, 0.2], [1, 2, 1]))
MATRIX = beam.AbcdMatrix.thin_lens(0.1)
SECTION = LASER.cross_section_at(0.1)


def place(**change: object) -> object:
    good: dict[str, object] = {"origin": (0, 0, 0), "direction": (0, 0, 1), "fan_axis": (1, 0, 0)}
    placement = beam.Placement(**(good | change))  # type: ignore[arg-type]
    return beam.Light.spot(LASER, 0.1, placement, 1e-3)


def fan(fan_angle: float = 0.5, apex_offset: float = 2e-3, focus_distance: float = 0.2) -> object:
    geometry = beam.FanGeometry(fan_angle, apex_offset, focus_distance)
    return beam.LaserLine(LASER, geometry, beam.LineProfile.gaussian_tan())


REFUSED: list[tuple[str, Callable[[], object]]] = [
    ("wavelength", lambda: beam.GaussianBeam.from_waist(NAN, 1e-4)),
    ("waist_radius", lambda: beam.GaussianBeam.from_waist(650e-9, 0.0)),
    ("waist_radius", lambda: beam.GaussianBeam.from_waist(100e-6, 650e-9)),
    ("divergence", lambda: beam.GaussianBeam.from_divergence(650e-9, 0.6)),
    ("m_squared", lambda: LASER.with_m_squared(0.5)),
    ("m_squared", lambda: LASER.with_m_squared(1e6)),
    ("growth", lambda: LASER.depth_of_focus([2, 1])),
    ("z", lambda: LASER.radius_at(NAN)),
    ("z", lambda: LASER.radius_at([0, INF])),
    ("z", lambda: LASER.radius_at(1e31)),
    ("z", lambda: LASER.cross_section_at(-INF)),
    ("waist_distance", lambda: beam.LocatedBeam(LASER, INF)),
    ("focal_length", lambda: LOCATED.through_lens(0.0)),
    ("y", lambda: beam.AstigmaticBeam(LOCATED, beam.LocatedBeam(
        beam.GaussianBeam.from_waist(500e-9, 1e-4), 0.1))),
    ("divergences", lambda: beam.AstigmaticBeam.from_divergences(650e-9, (1e-3, 0.7))),
    ("waist_distances", lambda: ELLIPTIC.with_waist_distances((0.1, NAN))),
    ("rotation", lambda: ELLIPTIC.with_rotation(INF)),
    ("systems", lambda: ELLIPTIC.through_axes((MATRIX, beam.AbcdMatrix.flat_interface(1, 1.5)))),
    ("parameter", lambda: MATRIX.transform_parameter(complex(INF, 0.1))),
    ("parameter", lambda: MATRIX.transform_parameter(complex(0.1, 0.0))),
    ("m_squared", lambda: beam.LocatedBeam.from_complex_parameter(0.1 + 0.2j, 650e-9, 0.9)),
    ("b", lambda: beam.AbcdMatrix(1, NAN, 0, 1)),
    ("determinant", lambda: beam.AbcdMatrix(1, 0, 0, -1)),
    ("length", lambda: beam.AbcdMatrix.free_space(INF)),
    ("focal_length", lambda: beam.AbcdMatrix.thin_lens(0)),
    ("index", lambda: beam.AbcdMatrix.thick_lens(0, 1, 1, 1e-3)),
    ("front_curvature", lambda: beam.AbcdMatrix.thick_lens(1.5, INF, 1, 1e-3)),
    ("back_curvature", lambda: beam.AbcdMatrix.thick_lens(1.5, 1, NAN, 1e-3)),
    ("thickness", lambda: beam.AbcdMatrix.thick_lens(1.5, 1, 1, -1e-3)),
    ("index_before", lambda: beam.AbcdMatrix.flat_interface(0, 1.5)),
    ("index_after", lambda: beam.AbcdMatrix.curved_interface(1, NAN, 0)),
    ("curvature", lambda: beam.AbcdMatrix.curved_mirror(NAN)),
    ("angle_of_incidence", lambda: beam.AbcdMatrix.tilted_mirror(1, 2)),
    ("gradient", lambda: beam.AbcdMatrix.grin(-1, 1)),
    ("index", lambda: beam.AbcdMatrix.grin_rod(0, 1, 1)),
    ("half_trace", lambda: beam.AbcdMatrix.free_space(1).eigenmode()),
    ("ray", lambda: MATRIX.transform_ray([1, 2, 3])),
    ("radii", lambda: beam.CrossSection((1e-3, 0))),
    ("fraction", lambda: SECTION.circle_radius([0.5, 1])),
    ("fan_angle", lambda: fan(fan_angle=4)),
    ("apex_offset", lambda: fan(apex_offset=0)),
    ("focus_distance", lambda: fan(focus_distance=NAN)),
    ("focus_curve", lambda: beam.FanGeometry(0.5, 1e-3, 0.2, "sphere")),  # type: ignore[arg-type]
    ("edge", lambda: beam.LaserLine(LASER, FAN, beam.LineProfile.powell(0))),
    ("theta", lambda: LINE.half_thickness_at_angle(0.2, 1.6)),
    ("angles", lambda: beam.LineProfile.tabulated([0.1, 0.0], [1, 1])),
    ("powers", lambda: beam.LineProfile.tabulated([0.0, 0.1], [1, -1])),
    ("powers", lambda: beam.LineProfile.tabulated([0.0, 0.1], [1])),
    (
        "angles",
        lambda: beam.LineProfile.tabulated(
            [[0.1, 1], [0, 1]],  # type: ignore[list-item]
            [0, 1],
        ),
    ),
    ("origin", lambda: place(origin=(0, NAN, 0))),
    ("direction", lambda: place(direction=(0, 0, 0))),
    ("fan_axis", lambda: place(fan_axis=(0, 0, 1))),
    ("power", lambda: beam.Light.spot(LASER, 0.1, PLACEMENT, -1)),
    ("x", lambda: SPOT.irradiance(NAN, 0, 0)),
    ("z", lambda: SPOT.next_event(0, 0, [1e31])),
    ("y", lambda: SPOT.flux(np.zeros(3), np.zeros(2), 0)),
    ("u", lambda: SPOT.sample_ray([0.5, 0.5, 0.5, 1.0])),
    ("u", lambda: SPOT.sample_ray([0.5, 0.5])),
    ("wi", lambda: SPOT.hit(0, 0, 0, [0.5, 0.5])),
    ("z", lambda: SPOT.hit(0, 0, NAN, [0, 0, 1])),
    ("min", lambda: SPOT.power_bound([0, 0, NAN], [1, 1, 1])),
    ("max", lambda: SPOT.power_bound([0, 0, 0], [1, 1, 1e31])),
    ("u", lambda: SPOT.next_event_sampled(0, 0, 0, [NAN, 0.5])),
    ("d", lambda: SPOT.radiance(0, 0, 0, [0, 1])),
    ("wi", lambda: SPOT.next_event_pdf(0, 0, 0, [0, NAN, 1])),
    ("l", lambda: SPOT.bounds(INF)),
]


@pytest.mark.parametrize(("parameter", "call"), REFUSED)
def test_what_is_refused_is_named(parameter: str, call: Callable[[], object]) -> None:
    with pytest.raises(ParameterError) as refusal:
        call()
    assert refusal.value.parameter == parameter
    assert isinstance(refusal.value, ValueError)


OBJECTS = [
    LASER.with_m_squared(1.5),
    LOCATED,
    ELLIPTIC.with_rotation(0.3),
    SECTION,
    MATRIX,
    FAN,
    beam.LineProfile.gaussian_sin(),
    LINE,
    PLACEMENT,
    beam.Estimate(1.0, 0.1),
]


@pytest.mark.parametrize("thing", OBJECTS, ids=lambda thing: type(thing).__name__)
def test_pickles_are_equal_to_what_went_in(thing: object) -> None:
    again = pickle.loads(pickle.dumps(thing))
    assert again == thing
    assert type(again) is type(thing)
    assert repr(again) == repr(thing)
    assert eval(repr(thing), vars(beam)) == thing


def test_objects_cannot_be_changed() -> None:
    with pytest.raises(AttributeError):
        LASER.wavelength = 1.0  # type: ignore[misc]
    with pytest.raises(AttributeError):
        SPOT.power = 1.0  # type: ignore[misc]


def test_closed_forms_are_the_texts_of_the_shaders() -> None:
    assert "fn tem00_spot_next_event(" in closed_form.WGSL
    assert "tem00_spot_next_event_f32" in closed_form.C_HEADER
