"""What 64 samples of a pixel miss of an edge and of a ramp, by how they lie in the pixel.

    pixel_samples.py

The mean squared error of the mean over the pixel, of 4000 pixels, for a step of height 1 along the
rows or columns (as the walls of the box in render_scenes.py have), for one in any direction, and
for light that grows by 1 over the pixel. `jittered` has one by chance in each cell of 8 x 8,
`multi-jittered` one in each of 64 columns and rows as well, and `Sobol` one in each elementary
rectangle, scrambled by Owen's method. `lattice` is how tem00 places camera samples.
"""

import numpy as np
from scipy.stats import qmc

SIDE = 8
COUNT = SIDE * SIDE
PIXELS = 4000


def independent(rng):
    return rng.random((COUNT, 2))


def jittered(rng):
    cells = np.stack(np.divmod(np.arange(COUNT), SIDE), axis=-1)
    return (cells + rng.random((COUNT, 2))) / SIDE


def multi_jittered(rng):
    # Within each column of cells the samples share its finer columns, each one, and so do the rows.
    columns = np.array([rng.permutation(SIDE) for _ in range(SIDE)])
    rows = np.array([rng.permutation(SIDE) for _ in range(SIDE)]).T
    x, y = np.divmod(np.arange(COUNT), SIDE)
    fine = np.stack([columns[x, y], rows[x, y]], axis=-1)
    return (np.stack([x, y], axis=-1) + (fine + rng.random((COUNT, 2))) / SIDE) / SIDE


def lattice(rng):
    # Of the lattices with one point in each column and row, those whose points are farthest apart.
    first = np.arange(COUNT)
    offsets = rng.integers(COUNT, size=2)
    ranks = (np.stack([first, rng.choice([19, 27, 37, 45]) * first], axis=-1) + offsets) % COUNT
    # Within two neighbouring columns, or rows, the samples mirror each other.
    within = np.take_along_axis(rng.random((COUNT // 2, 2)), ranks // 2, axis=0)
    return (ranks + np.where(ranks % 2 == 0, within, 1 - within)) / COUNT


def sobol(rng):
    return qmc.Sobol(2, scramble=True, rng=rng).random(COUNT)


def errors(points, rng):
    """Return the errors for a step along an axis, a step across the pixel, and a ramp."""
    place, angle = rng.random(), rng.random() * 2 * np.pi
    axis = (points[:, 0] < place).mean() - place
    # A dense grid of midpoints tells the area behind a slanted edge to 1e-4.
    normal = np.array([np.cos(angle), np.sin(angle)])
    offset = (rng.random() - 0.5) * 0.8
    across = (((points - 0.5) @ normal < offset).mean()) - ((GRID - 0.5) @ normal < offset).mean()
    slope = normal @ (points.mean(axis=0) - 0.5)
    return axis, across, slope


middles = (np.arange(256) + 0.5) / 256
GRID = np.stack(np.meshgrid(middles, middles), axis=-1).reshape(-1, 2)


def main():
    print(f"{'samples':16} {'edge along rows':>16} {'edge':>10} {'ramp':>10}")
    for name, draw in [
        ("independent", independent),
        ("jittered", jittered),
        ("multi-jittered", multi_jittered),
        ("Sobol", sobol),
        ("lattice", lattice),
    ]:
        rng = np.random.default_rng(1)
        found = np.array([errors(draw(rng), rng) for _ in range(PIXELS)])
        axis, across, slope = (found**2).mean(axis=0)
        print(f"{name:16} {axis:16.2e} {across:10.2e} {slope:10.2e}")


main()
