"""One speckle pattern and the look-ups of an image on a CUDA card, by CuPy (cuFFT) and PyTorch.

    card_peers.py

The peers of `cargo run --release -p tem00-gpu --example times`, which is to run in the same minute
on the same card. Patterns get their phasors for free, in the corner of an array of zeros on the
card, and new memory for their result. Look-ups are cubic splines between prefiltered complex
slices: two slices are blended and squared. Every time is that from the order to its end, the
fastest of those of a second, once plans and kernels are made.
"""

import time

import cupy
import torch
from cupyx.scipy import ndimage

SLICE = 0.375


def fastest(work, wait):
    def seconds():
        start = time.perf_counter()
        work()
        wait()
        return time.perf_counter() - start

    seconds()
    begin, times = time.perf_counter(), []
    while time.perf_counter() < begin + 1:
        times.append(seconds())
    return min(times)


def phasors(size):
    """Returns the phasors of a disc of diameter size / 2 in an array of zeros."""
    array = cupy.zeros((size, size), "complex64")
    axis = cupy.arange(size // 2 + 1) - size // 4
    inside = axis[:, None] ** 2 + axis**2 <= (size // 4) ** 2
    turns = cupy.random.default_rng(1).random(inside.shape)
    array[: len(axis), : len(axis)] = inside * cupy.exp(2j * cupy.pi * turns)
    return array


def report(what, seconds):
    print(f"{what}: {1e6 * seconds:.1f} µs")


def main():
    print(cupy.cuda.runtime.getDeviceProperties(0)["name"].decode())
    print(f"CuPy {cupy.__version__}, PyTorch {torch.__version__}")
    square = cupy.ElementwiseKernel(
        "complex64 a",
        "float32 squared",
        "squared = a.real() * a.real() + a.imag() * a.imag()",
        "square",
    )
    cupy_wait = cupy.cuda.Stream.null.synchronize
    for size in (1024, 2048, 4096):
        array = phasors(size)
        tensor = torch.as_tensor(array, device="cuda")
        report(
            f"pattern of {size}², CuPy",
            fastest(lambda: square(cupy.fft.fft2(array)), cupy_wait),
        )
        report(
            f"pattern of {size}², PyTorch",
            fastest(lambda: torch.fft.fft2(tensor).abs().square(), torch.cuda.synchronize),
        )

    apertures = cupy.stack([phasors(1024)] * 32)
    report(
        "stack of 32 slices of 1024², CuPy", fastest(lambda: cupy.fft.fft2(apertures), cupy_wait)
    )

    slices = [cupy.fft.fft2(phasors(1024)) for _ in range(2)]
    y, x = cupy.mgrid[:1080, :1920].astype("float32") * cupy.float32(0.8)
    at = cupy.stack([y, x])
    blend = cupy.ElementwiseKernel(
        "complex64 a, complex64 b, float32 f",
        "float32 squared",
        "complex<float> c = (1 - f) * a + f * b; "
        "squared = c.real() * c.real() + c.imag() * c.imag()",
        "blend",
    )

    def look_up():
        a, b = (
            ndimage.map_coordinates(s, at, order=3, mode="grid-wrap", prefilter=False)
            for s in slices
        )
        blend(a, b, cupy.float32(SLICE))

    report("look-ups of 1920 × 1080, between slices, CuPy", fastest(look_up, cupy_wait))


main()
