"""What a laser and its speckle cost in Mitsuba, beside Mitsuba's own spot light.

    mitsuba_speckle.py [--rounds N] [--variant NAME] [--samples N] [--figure]

The scene is that of figure 11, by default on 512 x 512 pixels and with 256 samples for each: a
plate, a thin lens, a laser, direct light, in millimetres. Every row renders it in turns with the
others, once as a warm-up that compiles the kernel (which Dr.Jit keeps on disk) and makes the
patterns, and N times that count. The table has the medians in seconds, the throughput, and the
median and the quartiles of the ratios to the first row, turn by turn.
"""

import argparse
import statistics
import time

import drjit as dr
import mitsuba as mi

FIELD_OF_VIEW = 2.31901652169468
BUILT_IN = {"type": "spot", "cutoff_angle": 3.0, "beam_width": 0.1}
SPOT = {
    "type": "laser",
    "unit": "mm",
    "wavelength": 650e-6,
    "power": 5e-3,
    "waist_radius": 2,
    "waist_distance": 200,
}
LINE = {
    "type": "laser",
    "shape": "line",
    "unit": "mm",
    "wavelength": 650e-6,
    "power": 5e-3,
    "fan_angle": 30.0,
    "thickness": 0.2,
    "focus_distance": 200,
}
DIRECT = {"type": "direct", "emitter_samples": 1, "bsdf_samples": 0}
PLAIN = {"type": "speckle", "max_depth": 2, "speckle": False}
SPECKLE = {"type": "speckle", "max_depth": 2}
ROWS = {
    "direct, Mitsuba's spot": (DIRECT, BUILT_IN),
    "direct, laser spot": (DIRECT, SPOT),
    "speckle integrator without speckle, laser spot": (PLAIN, SPOT),
    "speckle, laser spot": (SPECKLE, SPOT),
    "direct, laser line": (DIRECT, LINE),
    "speckle, laser line": (SPECKLE, LINE),
}


def scene(integrator, emitter, width, height):
    """Return figure 11 in another size."""
    look_at = mi.ScalarTransform4f().look_at
    film = {
        "type": "hdrfilm",
        "width": width,
        "height": height,
        "filter": {"type": "box"},
    }
    sensor = {
        "type": "thinlens",
        "fov": FIELD_OF_VIEW,
        "aperture_radius": 25 / 22 / 2,
        "focus_distance": 300,
        "to_world": look_at([0, 0, 300], [0, 0, 0], [0, 1, 0]),
        "film": film,
        "sampler": {"type": "independent"},
    }
    plate = {
        "type": "rectangle",
        "to_world": mi.ScalarTransform4f().scale([20, 15, 1]),
        "bsdf": {"type": "diffuse", "reflectance": {"type": "rgb", "value": 0.8}},
    }
    to_world = look_at([100, 0, 173.2], [0, 0, 0], [0, 1, 0])
    return mi.load_dict(
        {
            "type": "scene",
            "integrator": integrator,
            "sensor": sensor,
            "plate": plate,
            "light": {**emitter, "to_world": to_world},
        }
    )


def seconds(picture, samples, seed):
    """Return how long a picture takes, until its last pixel is there."""
    start = time.perf_counter()
    image = mi.render(picture, spp=samples, seed=seed)
    dr.eval(image)
    dr.sync_thread()
    return time.perf_counter() - start


def report(times, samples):
    base = next(iter(times.values()))
    for name, (first, *turns) in times.items():
        ratios = sorted(own / other for own, other in zip(turns, base[1:]))
        low, middle, high = statistics.quantiles(ratios, n=4, method="inclusive")
        median = statistics.median(turns)
        print(
            f"{name:48} first {first:6.3f} s  then {median:6.3f} s"
            f"  {samples / median / 1e6:6.1f} Msamples/s"
            f"  ratio {middle:5.3f} ({low:5.3f} to {high:5.3f})"
        )


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--variant", default="llvm_ad_rgb")
    parser.add_argument("--samples", type=int, default=256, help="for each pixel")
    parser.add_argument("--figure", action="store_true", help="320 x 240 pixels, as figure 11")
    arguments = parser.parse_args()
    mi.set_variant(arguments.variant)
    # Needs a variant.
    import tem00.mitsuba

    tem00.mitsuba.register()
    width, height = (320, 240) if arguments.figure else (512, 512)
    pictures = {name: scene(*parts, width, height) for name, parts in ROWS.items()}
    times = {name: [] for name in pictures}
    for seed in range(arguments.rounds + 1):
        for name, picture in pictures.items():
            times[name].append(seconds(picture, arguments.samples, seed))
    print(f"{arguments.variant}, {width} x {height}, {arguments.samples} samples per pixel")
    report(times, width * height * arguments.samples)


main()
