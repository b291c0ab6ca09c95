"""Answers the tasks of render_server.rs with Mitsuba.

    mitsuba_server.py VARIANT[:avx2]

`avx2` compiles for eight lanes in place of AVX-512's sixteen, with which loops over surfaces abort
(LLVM 19). The tasks are `load scene.xml SAMPLER`, `render SAMPLES SEED`, `write image.raw`, `peak`
and `samples`: the samples per pixel that were taken, which some samplers round up.
"""

import ctypes
import pathlib
import resource
import sys
import time

import drjit as dr
import mitsuba as mi
import numpy as np



def compile_for_avx2():
    """Dr.Jit has the call in its library, but not in Python."""
    library = ctypes.CDLL(str(pathlib.Path(dr.__file__).parent / "libdrjit-core.so"))
    library._Z19jit_llvm_set_targetPKcS0_j(b"skylake", b"+avx2,+fma,-avx512f", ctypes.c_uint32(8))


variant, _, lanes = sys.argv[1].partition(":")
mi.set_variant(variant)
if lanes:
    compile_for_avx2()
mi.set_log_level(mi.LogLevel.Error)
scene = image = None


def render(samples, seed):
    global image
    image = mi.render(scene, spp=int(samples), seed=int(seed))
    dr.eval(image)
    dr.sync_thread()


def load(path, sampler):
    global scene
    scene = mi.load_file(path, sampler=sampler)


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
    elif task == "samples":
        print(scene.sensors()[0].sampler().sample_count(), flush=True)
        continue
    print(time.perf_counter() - start, flush=True)
