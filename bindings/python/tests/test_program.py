"""The programs of the package: what `tem00` says, and how it ends, is as without Python."""

import os
import signal
import subprocess
import sysconfig
import time
from pathlib import Path

import pytest
import tem00

PROGRAM = Path(sysconfig.get_path("scripts")) / "tem00"
SCENE = Path(__file__).parents[3] / "examples" / "scenes" / "spot.toml"
LENS = (
    "--wavelength", "650 nm", "--focal-length", "25 mm",
    "--f-number", "8", "--distance", "300 mm",
)


def run(*arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, check=False)


@pytest.mark.parametrize("name", ["tem00", "tem00-inspect"])
def test_it_has_the_version_of_the_package(name: str) -> None:
    ended = subprocess.run(
        [PROGRAM.with_name(name), "--version"], capture_output=True, text=True, check=False
    )
    assert (ended.returncode, ended.stdout) == (0, f"{name} {tem00.__version__}\n")


def test_what_it_computes_is_printed_to_the_end() -> None:
    ended = run("speckle", *LENS)
    assert ended.returncode == 0
    assert "5.67" in ended.stdout
    assert ended.stdout.endswith("\n")


@pytest.mark.parametrize(
    ("arguments", "code", "said"),
    [
        (("nonsense",), 2, "unrecognized subcommand"),
        (("render", "none.toml"), 2, "none.toml"),
        (("speckle", *LENS, "--f-number", "0"), 2, "--f-number"),
    ],
)
def test_bad_input_has_its_exit_code(arguments: tuple[str, ...], code: int, said: str) -> None:
    ended = run(*arguments)
    assert ended.returncode == code
    assert said in ended.stderr


def test_a_closed_pipe_is_no_failure() -> None:
    read, write = os.pipe()
    os.close(read)
    ended = subprocess.run(
        [PROGRAM, "completions", "bash"], stdout=write, stderr=subprocess.PIPE, check=False
    )
    os.close(write)
    assert (ended.returncode, ended.stderr) == (0, b"")


def test_ctrl_c_ends_a_render(tmp_path: Path) -> None:
    render = (PROGRAM, "render", SCENE, "--spp", "1000000", "-o", tmp_path / "out")
    with subprocess.Popen(render, stderr=subprocess.PIPE, text=True) as child:
        while not (tmp_path / "out").exists():
            assert child.poll() is None
            time.sleep(0.01)
        child.send_signal(signal.SIGINT)
        _, said = child.communicate(timeout=20)
    assert child.returncode == 130
    assert "Traceback" not in said
