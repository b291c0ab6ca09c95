"""One speckle pattern by tem00, scipy, pyFFTW and pyspeckle, in turns.

    fft_peers.py SERVER [ROUNDS]

SERVER is the example `pattern_server`, which makes a pattern for every line it reads and answers
with the milliseconds that took: from the seed, so that its phasors are included. scipy and pyFFTW
get their phasors for free, in the corner of an array of zeros; pyFFTW measures its plan first and
has all of its memory. pyspeckle makes its own, from an array of twice the size in double precision.

A turn is a call that does not count, which brings its threads and memory back into the caches, and
three that do: the median of these is the turn's time. The medians of the turns are printed, the
median of the calls that did not count, and the median over the rounds of the ratio to ours of the
same round; for a stack also the memory that a process takes for it, less the slices.
"""

import os
import statistics
import subprocess
import sys
import time

import numpy as np
import pyfftw
import pyspeckle
import scipy.fft

THREADS = 2
SLICES = 32


def server(path, threads):
    """Returns a function that lets tem00 do a task and returns its milliseconds."""
    environment = {**os.environ, "RAYON_NUM_THREADS": str(threads)}
    process = subprocess.Popen(
        [path], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=environment
    )

    def milliseconds(task, size):
        process.stdin.write(f"{task} {size}\n")
        process.stdin.flush()
        return float(process.stdout.readline())

    return milliseconds


def timed(work):
    """Returns a function that works and returns its milliseconds."""

    def milliseconds():
        start = time.perf_counter()
        work()
        return 1e3 * (time.perf_counter() - start)

    return milliseconds


def phasors(size):
    """Returns the phasors of a disc of diameter size / 2 in an array of zeros."""
    array = pyfftw.zeros_aligned((size, size), "complex64")
    axis = np.arange(size // 2 + 1) - size // 4
    inside = axis[:, None] ** 2 + axis**2 <= (size // 4) ** 2
    turns = np.random.default_rng(1).random(inside.shape)
    array[: len(axis), : len(axis)] = inside * np.exp(2j * np.pi * turns)
    return array


def with_scipy(aperture, workers):
    def work():
        field = scipy.fft.fft2(aperture, workers=workers)
        return field.real**2 + field.imag**2

    return timed(work)


def with_pyfftw(aperture, threads):
    source, field = (pyfftw.empty_aligned(aperture.shape, "complex64") for _ in range(2))
    intensity = np.empty(aperture.shape, "float32")
    plan = pyfftw.FFTW(
        source, field, axes=(0, 1), threads=threads, flags=("FFTW_MEASURE",)
    )
    source[:] = aperture

    def work():
        plan()
        np.abs(field, out=intensity)
        np.multiply(intensity, intensity, out=intensity)

    return timed(work)


def contenders(ours, size):
    """Returns what takes part at a pattern size, by name; the others are divided by the first."""
    aperture = phasors(size)
    two, one = ours
    found = {
        "tem00, seed to intensity": lambda: two("pattern", size),
        "the same, one thread": lambda: one("pattern", size),
        "the same, fresh memory": lambda: two("fresh", size),
        "tem00, seed to complex field": lambda: two("field", size),
        "scipy fft2 + |.|^2": with_scipy(aperture, THREADS),
        "pyFFTW fft2 + |.|^2": with_pyfftw(aperture, THREADS),
        "scipy fft2 + |.|^2, one thread": with_scipy(aperture, 1),
        "pyFFTW fft2 + |.|^2, one thread": with_pyfftw(aperture, 1),
    }
    if size <= 1024:
        found["pyspeckle, pattern in float64"] = timed(
            lambda: pyspeckle.create_Exponential(size, 2)
        )
        found[f"tem00, stack of {SLICES} slices"] = lambda: two("stack", size)
    return found


def compare(ours, size, rounds):
    entries = contenders(ours, size)
    for entry in entries.values():
        entry()
    times = {name: [] for name in entries}
    first = {name: [] for name in entries}
    for _ in range(rounds):
        for name, entry in entries.items():
            first[name].append(entry())
            times[name].append(statistics.median(entry() for _ in range(3)))
    reference = times["tem00, seed to intensity"]
    print(f"\n{size} x {size}, {rounds} rounds")
    for name, values in times.items():
        ratio = statistics.median(t / r for t, r in zip(values, reference))
        print(
            f"  {name:34} median {statistics.median(values):8.2f} ms"
            f"   ratio {ratio:6.2f}   first call {statistics.median(first[name]):8.2f} ms"
        )


def stack_memory(path, size):
    """Prints what a stack takes at its peak besides its slices of 8 bytes a sample."""
    process = server(path, THREADS)
    before = process("peak", size)
    process("stack", size)
    slices = SLICES * size**2 * 8 / 2**20
    beside = process("peak", size) - before - slices
    print(f"  a stack of {slices:.0f} MiB takes {beside:.1f} MiB besides")


def main():
    path, rounds = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 21
    modules = (np, scipy, pyfftw, pyspeckle)
    print(*(f"{m.__name__} {m.__version__}" for m in modules), f"{THREADS} threads", sep=", ")
    ours = server(path, THREADS), server(path, 1)
    for size, share in ((1024, 1), (2048, 2), (4096, 4)):
        compare(ours, size, max(3, rounds // share))
        if size <= 1024:
            stack_memory(path, size)


main()
