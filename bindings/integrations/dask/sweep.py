"""A parameter sweep over pictures of a laser line, as a Dask graph.

    python bindings/integrations/dask/sweep.py                              # workers here
    python bindings/integrations/dask/sweep.py --scheduler tcp://host:8786  # those of any cluster

Every combination of thickness, tilt, f-number and seed is a frame, and every frame a task. Pictures
come back over the network: workers share no folder with this program. They need the packages
`tem00`, of the same version, and `distributed`, and are sent `frame.py`. The output folder holds

    table.parquet (or table.npz)    a row for each frame: its parameters and what was measured
    frames/frame_00000.npz …        its `picture` (uint16, rows × columns), and its `row` as JSON

Dask computes again what a lost worker had. Started again after a stop, this program asks only for
frames that are not in the folder. Numbers do not depend on the workers.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import asdict
from itertools import product
from pathlib import Path
from typing import IO, Any

import numpy as np
import tem00
from distributed import Client, LocalCluster, as_completed, progress

import frame
from frame import Frame, Parameters, Row


def grid(arguments: argparse.Namespace) -> list[Parameters]:
    """Return all combinations, in the order of their frames."""
    axes = (arguments.thickness, arguments.tilt, arguments.f_number, range(arguments.seeds))
    return [
        Parameters(thickness, math.radians(tilt), f_number, seed, *arguments.size)
        for thickness, tilt, f_number, seed in product(*axes)
    ]


def identity(parameters: Parameters) -> Row:
    """Return what tells a frame from all others: parameters, and the version of the physics."""
    return asdict(parameters) | {"tem00": tem00.__version__}


def write(path: Path, content: Callable[[IO[bytes]], object]) -> None:
    """Write a file whole or not at all."""
    partial = path.with_name(f".{path.name}.partial")
    with partial.open("wb") as file:
        content(file)
        file.flush()
        os.fsync(file.fileno())
    partial.replace(path)


def write_frame(path: Path, parameters: Parameters, result: Frame) -> None:
    """Keep a frame and its row."""
    row = np.array(json.dumps(identity(parameters) | result.row))
    write(path, lambda file: np.savez(file, picture=result.picture, row=row))


def kept_row(path: Path, parameters: Parameters) -> Row | None:
    """Return the row of a frame of these parameters, if the folder has it."""
    if not path.exists():
        return None
    with np.load(path) as kept:
        row: Row = json.loads(str(kept["row"]))
    return row if identity(parameters).items() <= row.items() else None


def compute(client: Client, tasks: dict[Path, Parameters]) -> Iterator[tuple[Path, Frame]]:
    """Yield frames as they come back, under a progress bar."""
    if not tasks:
        return
    client.upload_file(frame.__file__)
    futures = client.map(frame.render, list(tasks.values()))
    paths = dict(zip(futures, tasks))
    # In the console `progress` returns when all is done.
    threading.Thread(target=progress, args=(futures,), daemon=True).start()
    for future, result in as_completed(futures, with_results=True):
        yield paths[future], result


def write_table(path: Path, rows: list[Row]) -> None:
    """Write the table, as Parquet or as NPZ with an array for each column."""
    columns: dict[str, Any] = {"frame": np.arange(len(rows))}
    columns |= {name: np.array([row[name] for row in rows]) for name in rows[0]}
    if path.suffix == ".npz":
        write(path, lambda file: np.savez(file, **columns))
        return
    import pyarrow
    import pyarrow.parquet

    table = pyarrow.table(columns)
    write(path, lambda file: pyarrow.parquet.write_table(table, file))


def sweep(client: Client, parameters: list[Parameters], folder: Path, table: str) -> Path:
    """Compute the frames that the folder lacks, and return the path of the table of all."""
    frames = folder / "frames"
    frames.mkdir(parents=True, exist_ok=True)
    paths = {frames / f"frame_{i:05}.npz": each for i, each in enumerate(parameters)}
    rows = {path: kept_row(path, each) for path, each in paths.items()}
    missing = {path: each for path, each in paths.items() if rows[path] is None}
    print(f"{len(paths)} frames, of which {len(missing)} are to be computed", flush=True)
    for path, result in compute(client, missing):
        write_frame(path, paths[path], result)
        rows[path] = kept_row(path, paths[path])
    target = folder / f"table.{table}"
    write_table(target, [row for row in rows.values() if row is not None])
    return target


def parse(command_line: list[str]) -> argparse.Namespace:
    """Return the arguments; lengths in metres, angles in degrees."""
    parser = argparse.ArgumentParser(
        description="Sweeps over pictures of a laser line on a tilted surface.",
        formatter_class=argparse.ArgumentDefaultsHelpFormatter,
    )
    add = parser.add_argument
    add("--thickness", type=float, nargs="+", default=[2e-4, 4e-4, 8e-4], help="full, 1/e², in m")
    add("--tilt", type=float, nargs="+", default=[-30.0, 0.0, 30.0], help="degrees, -49 to 68")
    add("--f-number", type=float, nargs="+", default=[5.6, 8.0, 16.0], help="of the camera")
    add("--seeds", type=int, default=12, help="patterns of speckle for each of these")
    add("--size", type=int, nargs=2, default=[192, 128], help="columns and rows of a picture")
    add("--out", type=Path, default=Path("out/sweep"), help="folder of the results")
    add("--table", choices=["parquet", "npz"], default="parquet", help="format of the table")
    add("--scheduler", help="address of a Dask scheduler, as tcp://host:8786")
    add("--workers", type=int, default=os.cpu_count(), help="processes, without a scheduler")
    arguments = parser.parse_args(command_line)
    if min(arguments.seeds, arguments.workers, *arguments.size) < 1:
        parser.error("--seeds, --workers and --size must be positive")
    return arguments


@contextmanager
def cluster(arguments: argparse.Namespace) -> Iterator[str]:
    """Lend the address of the scheduler: the one that was asked for, or one of our own."""
    if arguments.scheduler:
        yield arguments.scheduler
        return
    with LocalCluster(
        n_workers=arguments.workers, threads_per_worker=1, dashboard_address=None
    ) as local:
        yield local.scheduler_address


def main(command_line: list[str]) -> None:
    """Run the program."""
    arguments = parse(command_line)
    frames = grid(arguments)
    with cluster(arguments) as address, Client(address) as client:
        print(sweep(client, frames, arguments.out, arguments.table))


if __name__ == "__main__":
    try:
        main(sys.argv[1:])
    # tem00.ParameterError is a ValueError, a folder or scheduler out of reach an OSError.
    except (ValueError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        sys.exit(2)
    except KeyboardInterrupt:
        print("stopped; started again it computes the frames that are missing", file=sys.stderr)
        sys.exit(130)
