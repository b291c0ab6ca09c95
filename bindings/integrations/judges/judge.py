"""Helpers of the checks: paths, and a verdict that is printed and counted."""

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
FRAMES = ROOT / "out" / "judges"


def run(program: str, *arguments: str) -> str:
    """Runs a program that cargo built, such as `tem00` or `examples/line_frames`."""
    build = ROOT / os.environ.get("TEM00_BUILD", "target/debug")
    command = [str(build / program), *arguments]
    return subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout


class Verdict:
    """Counts what was outside of its tolerance."""

    def __init__(self) -> None:
        self.failed = 0

    def within(self, what: str, deviation: float, tolerance: float) -> None:
        """Prints a deviation beside the largest one that is allowed."""
        good = abs(deviation) <= tolerance
        self.failed += not good
        mark = "" if good else "   <-- too far"
        print(f"{what:58} {deviation:10.2e}   at most {tolerance:.1e}{mark}")

    def end(self) -> None:
        """Ends the program; its exit code says whether all was within."""
        sys.exit(1 if self.failed else 0)
