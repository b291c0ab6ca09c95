"""One picture of a laser line on a tilted surface, with its speckle, and what is measured in it.

The camera looks down on the origin. The laser stands beside it and draws a line along the columns
of the picture. The surface is tilted about that line.
"""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from tem00.beam import FanGeometry, GaussianBeam, LaserLine, Light, LineProfile, Placement
from tem00.decorrelation import ImagingGeometry
from tem00.speckle import StackPlan
from tem00.statistics import Contrast, pixel_contrast

Floats = npt.NDArray[np.float64]
Row = dict[str, Any]

WAVELENGTH = 650e-9
POWER = 5e-3
DISTANCE = 0.3  # of camera and laser from the surface, in metres
TRIANGULATION_ANGLE = math.radians(30.0)
FULL_SCALE = 12.0  # of the brightest pixel without speckle; speckle is brighter once in 160 000


@dataclass(frozen=True)
class Parameters:
    """Parameters of a frame.

    Parameters
    ----------
    thickness : float
        Thickness (full, 1/e²) of the line across the light, in metres, from 5e-5 to 5e-3.
    tilt : float
        Angle of the surface about the line, positive towards the laser, in radians, from -0.87 to
        1.2.
    f_number : float
        Of the camera's lens.
    seed : int
        Of the speckle.
    columns, rows : int
        Size of the picture, in pixels, from 16 to 2048.

    Raises
    ------
    ValueError
        If the thickness, the tilt or the size is out of range.
    """

    thickness: float
    tilt: float
    f_number: float
    seed: int
    columns: int
    rows: int

    def __post_init__(self) -> None:
        check("thickness in metres", self.thickness, 5e-5, 5e-3)
        check("tilt in radians", self.tilt, -0.87, 1.2)
        check("columns", self.columns, 16, 2048)
        check("rows", self.rows, 16, 2048)


def check(name: str, value: float, smallest: float, largest: float) -> None:
    """Refuse a value that is out of range, or not a number."""
    if not smallest <= value <= largest:
        raise ValueError(f"{name} must lie between {smallest:g} and {largest:g}, got {value:g}")


@dataclass(frozen=True)
class Frame:
    """A picture, as uint16 of shape (rows, columns), and its row of the table."""

    picture: npt.NDArray[np.uint16]
    row: Row


def render(parameters: Parameters) -> Frame:
    """Return the frame of some parameters: the same bits wherever it is computed.

    Raises
    ------
    tem00.ParameterError
        If a parameter lies outside what the physics allows.
    """
    camera = camera_with(parameters.f_number)
    smooth = irradiance(parameters, camera)
    speckle = speckle_of_pixels(parameters, camera.speckle_size_in_pixels)
    exposed = smooth * speckle * (65535.0 / (FULL_SCALE * smooth.max()))
    picture = np.minimum(np.rint(exposed), 65535.0).astype(np.uint16)
    return Frame(picture, asdict(parameters) | measure(smooth, speckle, camera))


def camera_with(f_number: float) -> ImagingGeometry:
    """Return the camera, in focus at the origin."""
    return ImagingGeometry.from_lens(
        wavelength=WAVELENGTH,
        focal_length=25e-3,
        f_number=f_number,
        surface_to_pupil=DISTANCE,
        pixel_pitch=3.45e-6,
    )


def irradiance(parameters: Parameters, camera: ImagingGeometry) -> Floats:
    """Return the irradiance of the surface, in W/m², at the pixels' centres: (rows, columns)."""
    flux = laser_line(parameters.thickness).flux(*surface_points(parameters, camera))
    return np.maximum(-(flux @ normal_of(parameters.tilt)), 0.0)


def normal_of(tilt: float) -> Floats:
    """Return the normal of the surface, shape (3,)."""
    return np.array([math.sin(tilt), 0.0, math.cos(tilt)])


def surface_points(parameters: Parameters, camera: ImagingGeometry) -> tuple[Floats, ...]:
    """Return x, y, z, in metres, of what the pixels' centres see, each of shape (rows, columns)."""
    u, v = (
        (np.arange(count) - 0.5 * (count - 1)) * camera.pixel_pitch
        for count in (parameters.columns, parameters.rows)
    )
    u, v = np.meshgrid(u, -v)
    # Lines of sight (u, v, −c) from the pupil at (0, 0, DISTANCE) meet the plane after s of them.
    n_x, _, n_z = normal_of(parameters.tilt)
    c = camera.principal_distance
    s = DISTANCE * n_z / (c * n_z - u * n_x)
    return s * u, s * v, DISTANCE - s * c


def laser_line(thickness: float) -> Light:
    """Return the laser, in focus at the origin."""
    line = LaserLine(
        GaussianBeam.from_waist(WAVELENGTH, 0.5 * thickness),
        FanGeometry(fan_angle=0.5, apex_offset=5e-3, focus_distance=DISTANCE),
        LineProfile.uniform_angle(),
    )
    towards = np.array([math.sin(TRIANGULATION_ANGLE), 0.0, math.cos(TRIANGULATION_ANGLE)])
    placement = Placement(
        origin=DISTANCE * towards, direction=-towards, fan_axis=np.array([0.0, 1.0, 0.0])
    )
    return Light.line(line, placement, POWER)


def speckle_of_pixels(parameters: Parameters, speckle_size: float) -> Floats:
    """Return the speckle, with mean 1, over each pixel; `speckle_size` is in pixels."""
    image = (float(parameters.columns), float(parameters.rows))
    plan = StackPlan(
        image=image,
        region=image,
        speckle_size=speckle_size,
        motion=None,
        frames=1,
        memory_limit=1 << 30,
    )
    stack = plan.stack(parameters.seed)
    samples = stack.speckle_size / speckle_size
    columns, rows = samples * np.arange(parameters.columns), samples * np.arange(parameters.rows)
    x, y = np.meshgrid(columns, rows)
    return np.asarray(stack.average_over(x, y, (samples, samples), 0.0))


def measure(smooth: Floats, speckle: Floats, camera: ImagingGeometry) -> Row:
    """Return the contrast in the line and the noise of its place in a row; lengths in pixels."""
    size = camera.speckle_size_in_pixels
    lit = speckle[smooth > 0.5 * smooth.max()]
    centre = centre_of_gravity(smooth)
    off_centre = np.arange(smooth.shape[1]) - centre[:, np.newaxis]
    radius = 2.0 * math.sqrt(np.average(off_centre**2, weights=smooth))
    noise = centre_of_gravity(smooth * speckle) - centre
    return {
        "speckle_size": size,
        "line_radius": radius,
        "contrast": Contrast.from_samples(lit).value,
        "contrast_theory": float(pixel_contrast(1.0 / size)),
        "line_noise": math.sqrt(np.mean(noise**2)),
        "line_noise_theory": line_noise(size, radius),
    }


def centre_of_gravity(picture: Floats) -> Floats:
    """Return the centre of each row, in pixels, shape (rows,)."""
    centre: Floats = picture @ np.arange(picture.shape[1]) / picture.sum(axis=1)
    return centre


def line_noise(speckle_size: float, line_radius: float) -> float:
    """Return the standard deviation of a Gaussian line's centre of gravity in a row.

    ``var = l ∫ E² x² dx / (∫ E dx)²`` with ``E = exp(−2 x²/w²)`` and the integral
    ``l = 32 h / (3 π²)`` of the autocovariance of speckle behind a circular pupil. It holds for
    lines many speckles thick, and for pixels much smaller than a speckle.
    """
    length = 32.0 / (3.0 * math.pi**2) * speckle_size
    return math.sqrt(length * line_radius / (8.0 * math.sqrt(math.pi)))
