"""The sweep gives the same bits whoever computes it, and loses nothing when processes die."""

from __future__ import annotations

import math
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pyarrow.parquet
import pytest
from distributed import Client, LocalCluster

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE))

import frame  # noqa: E402
import sweep  # noqa: E402
from frame import Parameters  # noqa: E402

GRID = ["--thickness", "3e-4", "--tilt", "0", "25", "--f-number", "8", "16", "--seeds", "15"]
COUNT = 2 * 2 * 15


def command(folder: Path, *options: str) -> list[str]:
    return [sys.executable, str(HERE / "sweep.py"), *GRID, "--out", str(folder), *options]


def results(folder: Path) -> dict[str, bytes]:
    """All files of a folder, by name."""
    files = [path for path in folder.rglob("*") if path.is_file()]
    return {str(path.relative_to(folder)): path.read_bytes() for path in files}


@pytest.fixture(scope="module")
def expected(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """Results of one worker."""
    folder = tmp_path_factory.mktemp("one")
    subprocess.run(command(folder, "--workers", "1"), check=True, capture_output=True)
    return results(folder)


@pytest.fixture(scope="module")
def scheduler() -> Iterator[str]:
    """The address of two workers of our own."""
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        yield cluster.scheduler_address


def start(folder: Path, address: str) -> subprocess.Popen[str]:
    """Start the sweep on the cluster and return when it is well under way."""
    process = subprocess.Popen(
        command(folder, "--scheduler", address), stdout=subprocess.PIPE, text=True
    )
    while len(list(folder.glob("frames/frame_*.npz"))) < 2:
        assert process.poll() is None, "the sweep ended too early"
        time.sleep(0.01)
    return process


def test_one_and_two_workers_give_the_same_bytes(
    tmp_path: Path, scheduler: str, expected: dict[str, bytes]
) -> None:
    subprocess.run(
        command(tmp_path, "--scheduler", scheduler), check=True, capture_output=True
    )
    assert len(expected) == COUNT + 1
    assert results(tmp_path) == expected


def test_the_table_has_the_rows_and_the_files_the_pictures(
    tmp_path: Path, expected: dict[str, bytes]
) -> None:
    (tmp_path / "table.parquet").write_bytes(expected["table.parquet"])
    rows = pyarrow.parquet.read_table(tmp_path / "table.parquet").to_pylist()
    assert [row["frame"] for row in rows] == list(range(COUNT))
    for index in (0, 20, COUNT - 1):
        parameters = Parameters(
            **{name: rows[index][name] for name in Parameters.__dataclass_fields__}
        )
        alone = frame.render(parameters)
        assert rows[index].items() >= alone.row.items()
        (tmp_path / "frame.npz").write_bytes(expected[f"frames/frame_{index:05}.npz"])
        with np.load(tmp_path / "frame.npz") as kept:
            np.testing.assert_array_equal(kept["picture"], alone.picture)


def test_a_killed_worker_loses_nothing(
    tmp_path: Path, scheduler: str, expected: dict[str, bytes]
) -> None:
    with Client(scheduler) as client:
        victim = min(client.run(os.getpid).values())
        process = start(tmp_path, scheduler)
        os.kill(victim, signal.SIGKILL)
        done = len(list(tmp_path.glob("frames/frame_*.npz")))
        process.communicate(timeout=60)
        client.wait_for_workers(2, timeout=30)
        assert victim not in client.run(os.getpid).values()

    assert process.returncode == 0
    assert done < COUNT, "the worker died too late to matter"
    assert results(tmp_path) == expected


def test_a_killed_program_goes_on_where_it_stopped(
    tmp_path: Path, scheduler: str, expected: dict[str, bytes]
) -> None:
    process = start(tmp_path, scheduler)
    process.kill()
    process.communicate()
    kept = {path: path.stat().st_mtime_ns for path in tmp_path.glob("frames/frame_*.npz")}
    assert not (tmp_path / "table.parquet").exists()

    again = subprocess.run(
        command(tmp_path, "--scheduler", scheduler),
        check=True,
        capture_output=True,
        text=True,
    )
    assert f"{COUNT} frames, of which {COUNT - len(kept)} are to be computed" in again.stdout
    assert all(path.stat().st_mtime_ns == when for path, when in kept.items())
    assert results(tmp_path) == expected


def test_a_frame_of_other_parameters_is_not_reused(tmp_path: Path) -> None:
    first, second = (Parameters(3e-4, 0.0, 8.0, seed, 32, 32) for seed in (1, 2))
    path = tmp_path / "frame_00000.npz"
    assert sweep.kept_row(path, first) is None
    sweep.write_frame(path, first, frame.render(first))
    assert sweep.kept_row(path, first) is not None
    assert sweep.kept_row(path, second) is None


def test_the_table_can_be_npz(tmp_path: Path) -> None:
    rows = [{"frame_time": 0.5, "seed": 3}, {"frame_time": 1.5, "seed": 4}]
    sweep.write_table(tmp_path / "table.npz", rows)
    with np.load(tmp_path / "table.npz") as table:
        assert table["frame_time"].tolist() == [0.5, 1.5]
        assert table["seed"].tolist() == [3, 4]


@pytest.mark.parametrize("tilt", [-0.5, 0.0, 0.9])
def test_the_line_carries_its_power_on_a_tilted_surface(tilt: float) -> None:
    parameters = Parameters(8e-4, tilt, 8.0, 0, 256, 128)
    camera = frame.camera_with(parameters.f_number)
    x, y, z = frame.surface_points(parameters, camera)
    # Area of the surface per pixel, |∂r/∂u × ∂r/∂v|; differences are exact to (pixel / distance)².
    along_rows, along_columns = (
        np.stack([np.gradient(axis, axis=direction) for axis in (x, y, z)])
        for direction in (0, 1)
    )
    area = np.linalg.norm(np.cross(along_rows, along_columns, axis=0), axis=0)
    power = float((frame.irradiance(parameters, camera) * area).sum())

    # The fan spreads the power evenly over its angle, seen from its apex. Beside the middle of the
    # line the surface is nearer or farther, by less than 1 %, which cancels to first order.
    half_height = 0.5 * parameters.rows * camera.pixel_pitch / camera.principal_distance * 0.3
    share = 2.0 * math.atan(half_height / (0.3 + 5e-3)) / 0.5
    assert power == pytest.approx(share * frame.POWER, rel=1e-3)


def test_speckle_moves_the_line_as_the_closed_form_says() -> None:
    # 13 speckles thick, with pixels of a third of a speckle: the closed form is some 4 % too large.
    # 8 pictures of 128 rows hold 128 / 3.3 independent places each, which give the deviation to
    # 4 %; four of these are allowed.
    rows = [frame.render(Parameters(3.2e-3, 0.2, 16.0, seed, 512, 128)).row for seed in range(8)]
    squares = [(row["line_noise"] / row["line_noise_theory"]) ** 2 for row in rows]
    assert math.sqrt(np.mean(squares)) == pytest.approx(0.96, abs=0.16)
    # 60 × 128 pixels with 700 speckles each: 1.4 % in eight frames, and 1/700 of bias.
    contrast = np.mean([row["contrast"] for row in rows])
    assert contrast == pytest.approx(rows[0]["contrast_theory"], rel=0.06)


@pytest.mark.parametrize(
    ("name", "options"),
    [
        ("thickness in metres", ["--thickness", "nan"]),
        ("tilt in radians", ["--tilt", "80"]),
        ("columns", ["--size", "4", "64"]),
        ("rows", ["--size", "64", "4096"]),
    ],
)
def test_what_makes_no_frame_is_refused_by_its_name(name: str, options: list[str]) -> None:
    with pytest.raises(ValueError, match=f"^{name} must lie between"):
        sweep.grid(sweep.parse(options))


def test_what_a_worker_refuses_ends_the_program_with_its_message(
    tmp_path: Path, scheduler: str
) -> None:
    options = ["--scheduler", scheduler, "--f-number", "-8"]
    refused = subprocess.run(command(tmp_path, *options), capture_output=True, text=True)
    assert refused.returncode == 2
    assert refused.stderr.startswith("error: f_number must")
    assert "Traceback" not in refused.stderr


def test_a_folder_that_cannot_be_made_ends_the_program_with_a_message(
    tmp_path: Path, scheduler: str
) -> None:
    (tmp_path / "file").touch()
    options = ["--scheduler", scheduler]
    refused = subprocess.run(command(tmp_path / "file", *options), capture_output=True, text=True)
    assert refused.returncode == 2
    assert refused.stderr.startswith("error: ")
    assert "Traceback" not in refused.stderr


def test_an_interrupt_says_how_to_go_on(tmp_path: Path, scheduler: str) -> None:
    # A shell that starts the tests in the background has its programs ignore interrupts.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    process = start(tmp_path, scheduler)
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=60)
    assert process.returncode == 130
