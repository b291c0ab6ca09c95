"""Answers the tasks of render_server.rs with Mitsuba.

    mitsuba_server.py VARIANT

The tasks are `load scene.xml`, `render SAMPLES SEED`, `write image.raw` and `peak`.
"""

import resource
import sys
import time

import drjit as dr
import mitsuba as mi
import numpy as np

mi.set_variant(sys.argv[1])
mi.set_log_level(mi.LogLevel.Error)
scene = image = None


def render(samples, seed):
    global image
    image = mi.render(scene, spp=int(samples), seed=int(seed))
    dr.eval(image)
    dr.sync_thread()


def load(path):
    global scene
    scene = mi.load_file(path)


for line in sys.stdin:
    task, *arguments = line.split()
    start = time.perf_counter()
    if task == "load":
        load(*arguments)
    elif task == "render":
        render(*arguments)
    elif task == "write":
        # Everything is grey, so the first channel is the radiance.
        np.array(image)[:, :, 0].astype("<f4").tofile(*arguments)
    elif task == "peak":
        print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024, flush=True)
        continue
    print(time.perf_counter() - start, flush=True)
