r"""A sweep as tasks of Dask, on this machine or on a cluster whose workers share the folder.

    python bindings/integrations/sweep/with_dask.py examples/setups/sweeps/lens_and_line.toml \
        out/sweep [tcp://scheduler:8786]
"""

import subprocess
import sys

from distributed import Client, LocalCluster


def sweep(*arguments: str) -> str:
    """Return what `tem00-inspect sweep` prints."""
    command = ["tem00-inspect", "sweep", *arguments]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


if __name__ == "__main__":
    grid, out, *scheduler = sys.argv[1:]
    tasks = range(len(sweep(grid, "--list").splitlines()) - 1)
    with Client(*scheduler or [LocalCluster(dashboard_address=None)]) as client:
        done = [client.submit(sweep, grid, "-o", out, "--task", str(task)) for task in tasks]
        client.gather(done)
    print(sweep(grid, "-o", out, "--gather"), end="")
