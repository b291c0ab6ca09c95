"""A plane under a laser spot slides by 0.1 mm: two frames, and how much of the speckle is left."""

import numpy as np
import tem00
from numpy.typing import NDArray

camera = tem00.Camera()  # 25 mm at f/8, 0.3 m above the origin
laser = tem00.Laser.spot(650e-9, 3e-3, origin=[0.2, 0, 0.4], target=[0, 0, 0], power=5e-3)
pose = tem00.Pose.along([1e-4, 0, 0])

# Chooses sizes, slices and seeds, says what it chose, and refuses what does not fit.
speckle = tem00.Speckle(camera, laser, 1, poses=[pose])
print(speckle)
# Once per body and frame.
before, after = speckle.frame(), speckle.frame(pose)


def seen(pixels: NDArray[np.floating]) -> NDArray[np.floating]:
    """Return the points of the plane z = 0 that the camera sees."""
    origin, direction = camera.ray(pixels)
    return origin - float(origin[2]) / direction[..., 2:] * direction


# Per hit: the point that is seen, how it is lit, and the speckle there; here of all pixels at once.
width, height = camera.resolution
pixels = np.stack(np.meshgrid(np.arange(width), np.arange(height)), axis=-1) + 0.5
points, normal = seen(pixels), [0, 0, 1]
light = laser.next_event(points)
irradiance = light.e_perp * light.wi[..., 2]
frames = [irradiance * frame.factor(points, normal) for frame in (before, after)]

# By the law, and as found where the speckle has gone.
shift = after.shift([0, 0, 0], normal)
gone = after.factor(seen(pixels + shift.displacement), normal)
found = np.corrcoef(np.ravel(before.factor(points, normal)), np.ravel(gone))[0, 1]
print(f"correlation {found:.3f}, by the law {shift.correlation:.3f}")
