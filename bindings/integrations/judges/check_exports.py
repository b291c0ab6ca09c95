"""A height map and a point cloud of `tem00-inspect triangulate`, read by other programs.

x3pio, surfalize, pypcd4 and Pillow read them.

- X3P holds the heights of `height.npy` as they are, and verifies its checksums; its points are the
  middles of the cells.
- PCD holds the coordinates of the profiles, rounded to single precision: by 2^-24 of a length of at
  most 20 mm, 1.2e-9 m.
- An image of 16 bits holds a value to half a step and the rounding of its single-precision value.
"""

import csv
import json

import numpy as np
import x3pio
from PIL import Image
from pypcd4.pypcd4 import PointCloud
from surfalize import Surface

from judge import FRAMES, Verdict, run

folder = FRAMES / "exports"
run(
    *("tem00-inspect", "triangulate", "examples/scenes/triangulation/hexagon_nut.toml"),
    *("--frames", "40..45", "--spp", "4", "-o", str(folder)),
)
record = json.loads((folder / "measurement.json").read_text())["height_map"]
heights = np.load(folder / "height.npy").astype(float)
verdict = Verdict()

surface = x3pio.read(folder / "height.x3p", verify=True)
verdict.within("x3pio: holes", np.sum(np.isnan(surface.layers[0].z) != np.isnan(heights)), 0)
verdict.within("x3pio: heights / m", np.nanmax(np.abs(surface.layers[0].z - heights)), 0)
for axis in range(2):
    middle = record["origin"][axis] + record["pitch"] / 2
    verdict.within(f"x3pio: offset {axis} / m", surface.placement.offset[axis] - middle, 1e-15)
    increment = (surface.header.x, surface.header.y)[axis].increment
    verdict.within(f"x3pio: increment {axis} / m", increment - record["pitch"], 0)
# surfalize goes over to micrometres, in double precision.
topography = Surface.load(folder / "height.x3p").data
verdict.within("surfalize: heights / um", np.nanmax(np.abs(topography - 1e6 * heights)), 1e-11)

rows: list[dict[str, str]] = []
for profile in sorted(folder.glob("profile_*.csv")):
    with profile.open(newline="") as table:
        rows += [row for row in csv.DictReader(table) if row["validity"] == "valid"]
cloud = PointCloud.from_path(folder / "points.pcd")
verdict.within("pypcd4: points", cloud.points - len(rows), 0)
for field, column in [("x", "x_m"), ("y", "y_m"), ("z", "z_m"), ("sigma_z", "u_z_m")]:
    expected = np.array([float(row[column]) for row in rows])
    verdict.within(f"pypcd4: {field} / m", np.max(np.abs(cloud.pc_data[field] - expected)), 1.2e-9)

for name, image in record["images"].items():
    values = np.asarray(Image.open(folder / f"{name}.png"), float)
    verdict.within(f"{name}.png: holes", np.sum((values == 0) != np.isnan(heights)), 0)
    values[values == 0] = np.nan
    if name == "height":
        found = image["offset"] + image["scale"] * values
        step = 0.5 * image["scale"] + 2**-24 * np.nanmax(np.abs(heights))
        verdict.within("height.png / m", np.nanmax(np.abs(found - heights)), step)

verdict.end()
