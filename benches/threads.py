"""How much faster the programs are with more threads.

    cargo build --release
    python benches/threads.py [--threads 1,2,4,8,16] [--runs 3] [--quick]

Prints, for each work and number of threads, the fastest of the runs in seconds, the speed-up over
one thread, the efficiency (speed-up over threads), and the serial part of the work that would
explain it (Amdahl). Numbers of threads above the processors of the machine are left out. Every
output is compared with the output of one thread, byte by byte. `--quick` runs smaller works, once.
"""

import argparse
import filecmp
import os
import pathlib
import subprocess
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
RENDER, INSPECT = (ROOT / "target/release" / name for name in ("tem00", "tem00-inspect"))
SCENES, SETUPS = ROOT / "examples/scenes", ROOT / "examples/setups"


def works(quick):
    """Returns the commands by name, with the output files that must not depend on threads."""
    size, spp, trials = (1024, 1, 20) if quick else (8192, 64, 400)
    part = "step_gauge" if quick else "hexagon_nut"
    all_works = {
        f"pattern of {size}², EXR": (
            [RENDER, "pattern", "--size", size, "-o", "{out}/pattern.exr"],
            ["pattern.exr"],
        ),
        f"pattern of {size}², PNG": (
            [RENDER, "pattern", "--size", size, "-o", "{out}/pattern.png"],
            ["pattern.png"],
        ),
        "render a part": (
            [RENDER, "render", SCENES / "machined_part.toml", "--spp", spp, "-o", "{out}"],
            ["machined_part.exr"],
        ),
        "render a moving surface with its stack": (
            [RENDER, "render", SCENES / "moved_surface.toml", "--spp", spp, "-o", "{out}"],
            ["moved_surface_0001.exr"],
        ),
        f"triangulate {part}": (
            [INSPECT, "triangulate", SCENES / f"triangulation/{part}.toml", "-o", "{out}"],
            ["points.ply", "measurement.json"],
        ),
        f"budget, {trials} trials": (
            [INSPECT, "budget", SETUPS / "data_sheet.toml", "--trials", trials, "-o", "{out}"],
            ["budget.json"],
        ),
        "characterise": (
            [INSPECT, "characterise", SETUPS / "data_sheet.toml", "-o", "{out}"],
            ["characteristics.json"],
        ),
    }
    # The last takes a minute at least.
    return dict(list(all_works.items())[:-1]) if quick else all_works


def seconds(command, threads, out):
    """Runs a command with so many threads, and returns its time."""
    command = [str(word).replace("{out}", str(out)) for word in command]
    environment = os.environ | {"RAYON_NUM_THREADS": str(threads)}
    start = time.perf_counter()
    subprocess.run(command, env=environment, check=True, capture_output=True)
    return time.perf_counter() - start


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--threads", default="1,2,4,8,16")
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--quick", action="store_true")
    arguments = parser.parse_args()
    processors = len(os.sched_getaffinity(0))
    counts = [int(count) for count in arguments.threads.split(",") if int(count) <= processors]
    runs = 1 if arguments.quick else arguments.runs
    print(f"{processors} processors, the fastest of {runs}")
    for name, (command, outputs) in works(arguments.quick).items():
        alone = None
        with tempfile.TemporaryDirectory() as one, tempfile.TemporaryDirectory() as many:
            for threads in counts:
                out = pathlib.Path(one if alone is None else many)
                took = min(seconds(command, threads, out) for _ in range(runs))
                if alone is None:
                    alone, first = took, threads
                for output in outputs:
                    same = filecmp.cmp(pathlib.Path(one) / output, out / output, shallow=False)
                    assert same, f"{name}: {output} differs with {threads} threads"
                ratio = alone / took
                line = f"{name}, threads {threads}: {took:.2f} s"
                if threads > first:
                    more = threads / first
                    serial = max(0.0, (more / ratio - 1.0) / (more - 1.0))
                    line += (
                        f", {ratio:.2f} times as fast, efficiency {ratio / more:.0%},"
                        f" serial part {serial:.1%}"
                    )
                print(line, flush=True)


if __name__ == "__main__":
    main()
