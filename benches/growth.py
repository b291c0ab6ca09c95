"""How time and memory of `tem00 render` grow with pixels, triangles, lasers, frames and slices.

    cargo build --release
    python benches/growth.py [--quick] [--plot docs/figures/growth.svg]

One number at a time grows; the scenes are made in a temporary folder. Prints seconds, seconds of
processor time and the peak memory of each run, and the slopes of the latter two in log-log scale
over the largest decade: 1 is proportional. `--quick` runs the smaller sizes only, a few seconds.
Needs numpy, and matplotlib for the plot.
"""

import argparse
import math
import multiprocessing
import os
import pathlib
import statistics
import subprocess
import tempfile
import time

PROGRAM = pathlib.Path(__file__).resolve().parents[1] / "target/release/tem00"
# The smaller sizes of each sweep.
QUICK = 2

CAMERA = """
[camera]
position = [0, 0, 0.3]
look_at = [0, 0, 0]
focal_length = "25 mm"
f_number = 8
pixel_pitch = "{pitch} um"
resolution = [{side}, {side}]
"""
PLATE = """
[[surface]]
rectangle = {{ size = [0.1, 0.1] }}
displacement_per_frame = [{displacement}, 0, 0]
"""


def laser(wavelength):
    return f"""
[[laser]]
wavelength = "{wavelength} nm"
power = "5 mW"
position = [0.1, 0, 0.2]
look_at = [0, 0, 0]
spot.waist_radius = "5 mm"
"""


def scene(side=256, samples=4, lasers=1, frames=1, slices=None, mesh=None):
    """Returns a plate or a mesh in the light of lasers; the image shows 10 mm."""
    text = f"[render]\nsamples_per_pixel = {samples}\nframes = {frames}\n"
    text += CAMERA.format(side=side, pitch=909 / side)
    text += '[speckle]\nmemory = "8 GiB"\n'
    if slices:
        text += f"size = 512\ndiameter = 256\nhalf_period = {slices // 2}\n"
    for index in range(lasers):
        text += laser(400 + 5 * index)
    if mesh:
        return text + f'[[surface]]\nmesh = {{ file = "{mesh}", unit = "m" }}\n'
    return text + PLATE.format(displacement=0.0 if frames == 1 else 1e-5)


def write_mesh(path, triangles):
    """Writes a wavy sheet of 20 mm."""
    import numpy as np

    side = math.isqrt(triangles // 2)
    x, y = np.meshgrid(np.linspace(-0.01, 0.01, side + 1), np.linspace(-0.01, 0.01, side + 1))
    z = 0.001 * np.sin(1000 * x) * np.sin(1000 * y)
    vertices = np.stack([x, y, z], axis=-1).reshape(-1, 3).astype("<f4")
    row, column = np.meshgrid(np.arange(side), np.arange(side), indexing="ij")
    a = row * (side + 1) + column
    b, c, d = a + 1, a + side + 2, a + side + 1
    faces = np.zeros(2 * side * side, dtype=[("count", "u1"), ("corners", "<i4", 3)])
    faces["count"] = 3
    faces["corners"] = np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3)
    with open(path, "wb") as file:
        file.write(
            b"ply\nformat binary_little_endian 1.0\n"
            + f"element vertex {len(vertices)}\n".encode()
            + b"property float x\nproperty float y\nproperty float z\n"
            + f"element face {len(faces)}\n".encode()
            + b"property list uchar int vertex_indices\nend_header\n"
        )
        vertices.tofile(file)
        faces.tofile(file)


def run(folder, text, *options):
    """Renders a scene; returns seconds, seconds of processor time and the peak memory in MiB."""
    file = folder / "scene.toml"
    file.write_text(text)
    command = [PROGRAM, "render", file, "--quiet", "-o", folder / "out", *options]
    start = time.perf_counter()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    seconds = time.perf_counter() - start
    # `wait4` has taken the status that `Popen` would wait for.
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise SystemExit(f"{command} failed:\n{text}")
    return seconds, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


def render_mesh(folder, triangles):
    mesh = folder / "mesh.ply"
    # A process inherits the peak memory of the one that starts it, so another one needs the memory.
    writer = multiprocessing.get_context("fork").Process(target=write_mesh, args=(mesh, triangles))
    writer.start()
    writer.join()
    return run(folder, scene(mesh=mesh), "--no-speckle")


SWEEPS = {
    "pixels": (
        [side * side for side in (128, 256, 512, 1024, 2048, 4096)],
        lambda folder, n: run(folder, scene(side=math.isqrt(n))),
    ),
    "triangles": ([10**3, 10**4, 10**5, 10**6, 10**7], render_mesh),
    "lasers": ([1, 2, 5, 10, 20, 50], lambda folder, n: run(folder, scene(side=512, lasers=n))),
    "frames": ([1, 2, 4, 8, 16, 32], lambda folder, n: run(folder, scene(frames=n))),
    "slices": (
        [16, 32, 64, 128, 256, 512, 1024],
        lambda folder, n: run(folder, scene(slices=n)),
    ),
}


def slope(sizes, values):
    """Returns the slope of a line through the logarithms over the largest decade."""
    largest = [i for i, size in enumerate(sizes) if 10 * size >= sizes[-1]]
    logs = [[math.log(column[i]) for i in largest] for column in (sizes, values)]
    return statistics.linear_regression(*logs).slope


def plot(path, results):
    import matplotlib

    matplotlib.use("Agg")
    # The same file for the same numbers.
    matplotlib.rcParams.update({"svg.hashsalt": "growth", "svg.fonttype": "none", "font.size": 9})
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(2, len(results), figsize=(12, 5), sharey="row", sharex="col")
    for column, (name, (sizes, rows)) in enumerate(results.items()):
        _, processor, memory = zip(*rows)
        for axis, values in zip(axes[:, column], (processor, memory)):
            axis.loglog(sizes, values, "o-", markersize=3)
            # Beside it, what is proportional, down to a tenth of the largest.
            tenth = [sizes[-1] / 10, sizes[-1]]
            axis.loglog(tenth, [values[-1] / 10, values[-1]], ":", color="grey")
            axis.text(0.05, 0.9, f"slope {slope(sizes, values):.2f}", transform=axis.transAxes)
            axis.minorticks_off()
        axes[1, column].set_xlabel(name)
    axes[0, 0].set_ylabel("processor time / s")
    axes[1, 0].set_ylabel("peak memory / MiB")
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None})


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="the smaller sizes only")
    parser.add_argument("--plot", type=pathlib.Path, metavar="FILE.svg")
    arguments = parser.parse_args()
    results = {}
    with tempfile.TemporaryDirectory() as name:
        for quantity, (sizes, render) in SWEEPS.items():
            sizes = sizes[:QUICK] if arguments.quick else sizes
            rows = []
            for size in sizes:
                rows.append(render(pathlib.Path(name), size))
                print(f"{quantity:9} {size:9}  %6.2f s  %6.2f s  %6.0f MiB" % rows[-1], flush=True)
            results[quantity] = sizes, rows
            _, processor, memory = zip(*rows)
            print(f"{'slopes':29} {slope(sizes, processor):6.2f}   {slope(sizes, memory):7.2f}")
    if arguments.plot:
        plot(arguments.plot, results)


if __name__ == "__main__":
    main()
