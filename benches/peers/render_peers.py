"""The same scenes by tem00 and Mitsuba, in turns.

    render_peers.py SERVER [--rounds N] [--only WORD] [--variants A,B] [--samplers A,B]
                    [--sampling A,B]

SERVER is the example `render_server`. Each scene is loaded by a fresh process of every program;
then they render in turns, one image that does not count and N that do, each with a seed of its own.
Mitsuba does so with each of the samplers, of which some take more samples than they are asked for.
The table has medians: seconds to load, seconds to render, samples per second; the squared error of
a pixel, which is the variance between seeds since all estimates are unbiased: its mean over the
image and its median; and ours by theirs of time, and of the time that an equal error takes, by the
mean and by the median, if errors fell with the samples, of images brought to the same mean. `mean`
is the mean of our image by theirs. Ours renders with even and with adaptive samples. A variant may
be `llvm_ad_rgb:avx2`, see mitsuba_server.py.
"""

import argparse
import pathlib
import statistics
import subprocess
import sys

import numpy as np

from render_scenes import ROOT, SAMPLES, write_scenes


class Program:
    """A process that renders."""

    def __init__(self, name, command, sampler=""):
        self.name = name
        self.sampler = sampler
        self.samples = SAMPLES
        self.process = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        self.task = "render"
        self.seconds, self.images = [], []

    def ask(self, task):
        self.process.stdin.write(task + "\n")
        self.process.stdin.flush()
        return float(self.process.stdout.readline())

    def load(self, task):
        self.load_seconds = self.ask(task)

    def render(self, seed, counts, raw):
        seconds = self.ask(f"{self.task} {SAMPLES} {seed}")
        if counts:
            self.ask(f"write {raw}")
            self.seconds.append(seconds)
            self.images.append(np.fromfile(raw, dtype="<f4").astype(float))
        else:
            self.first_seconds = seconds

    def finish(self):
        if self.sampler:
            self.samples = int(self.ask("samples"))
        self.peak = self.ask("peak")
        self.process.stdin.close()
        self.process.wait()

    def median(self):
        return statistics.median(self.seconds)

    def mean_image(self):
        return np.mean(self.images, axis=0)

    def squared_errors(self):
        """The squared error of each pixel."""
        return np.var(self.images, axis=0, ddof=1)


def report(name, ours, theirs):
    pixels = len(ours[0].images[0])
    print(f"{name}")
    for program in [*ours, *theirs]:
        time, errors = program.median(), program.squared_errors()
        rate = pixels * program.samples / time / 1e6
        line = (
            f"  {program.name:24} load {program.load_seconds:6.3f} s"
            f"  first {program.first_seconds:6.3f} s"
            f"  render {time:6.3f} s  {program.samples} samples  {rate:6.2f} Msamples/s"
            f"  error {errors.mean():.2e}  median {np.median(errors):.2e}"
            f"  peak {program.peak:5.0f} MiB"
        )
        for our in ours if program in theirs else []:
            ratio = our.median() / time
            mean = our.mean_image().mean() / program.mean_image().mean()
            # Of images brought to the same mean: a light that stands in for another may be
            # brighter.
            own, scaled = our.squared_errors(), errors * mean**2
            costs = ratio * own.mean() / scaled.mean(), ratio * np.median(own) / np.median(scaled)
            line += (
                f"\n    {our.name} by it: time {ratio:5.2f} cost {costs[0]:8.5f},"
                f" median {costs[1]:8.5f} mean {mean:.4f}"
            )
        print(line, flush=True)


def compare(row, arguments, folder):
    name, our_file, their_file, lights_only = row
    here = pathlib.Path(__file__).parent
    ours = [
        Program(f"tem00 {sampling}", [arguments.server])
        for sampling in arguments.sampling.split(",")
    ]
    theirs = [
        Program(
            f"{variant} {sampler}", [sys.executable, here / "mitsuba_server.py", variant], sampler
        )
        for variant in arguments.variants.split(",")
        for sampler in arguments.samplers.split(",")
    ]
    # Mitsuba's integrator of direct light makes no use of the directions that materials draw.
    for program in ours:
        program.task = "connect" if name.startswith("direct") else "render"
        program.load(f"{'lights' if lights_only else 'load'} {our_file}")
        program.ask(program.name.removeprefix("tem00 "))
    for program in theirs:
        program.load(f"load {their_file} {program.sampler}")
    for seed in range(arguments.rounds + 1):
        for program in [*ours, *theirs]:
            program.render(seed, seed > 0, folder / "image.raw")
    for program in [*ours, *theirs]:
        program.finish()
    report(name, ours, theirs)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("server")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--only", default="")
    parser.add_argument("--variants", default="scalar_rgb,llvm_ad_rgb")
    parser.add_argument("--samplers", default="independent,multijitter,orthogonal")
    parser.add_argument("--sampling", default="even,adaptive")
    arguments = parser.parse_args()
    folder = ROOT / "target/peers/scenes"
    for row in write_scenes(folder):
        if arguments.only in row[0]:
            compare(row, arguments, folder)


main()
