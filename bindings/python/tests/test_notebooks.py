"""The notebooks of the examples run from top to bottom, and are stored without results."""

import ast
import json
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import matplotlib
import matplotlib.pyplot as plt
import pytest

matplotlib.use("Agg")

FOLDER = Path(__file__).parents[3] / "examples/notebooks"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))
# What a browser kernel (Pyodide) has.
PACKAGES = {"matplotlib", "numpy", "tem00"}


def read(path: Path) -> dict[str, Any]:
    """Return a notebook."""
    notebook = json.loads(path.read_text(encoding="utf-8"))
    assert isinstance(notebook, dict)
    return notebook


def code(path: Path) -> Iterator[tuple[str, str]]:
    """Return the name and the text of each code cell."""
    for cell in read(path)["cells"]:
        if cell["cell_type"] == "code":
            yield cell["id"], "".join(cell["source"])


def test_there_are_six() -> None:
    assert [path.name[0] for path in NOTEBOOKS] == ["1", "2", "3", "4", "5", "6"]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs_from_top_to_bottom(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(path.parent)
    names: dict[str, object] = {"__name__": "__main__"}
    try:
        for name, source in code(path):
            exec(compile(source, f"{path.name}, cell {name}", "exec"), names)
    finally:
        plt.close("all")
        plt.rcdefaults()


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_has_the_format_4_5_and_no_results(path: Path) -> None:
    notebook = read(path)
    assert (notebook["nbformat"], notebook["nbformat_minor"]) == (4, 5)
    assert notebook["metadata"]["kernelspec"]["name"] == "python3"
    cells = notebook["cells"]
    names = [cell["id"] for cell in cells]
    assert len(set(names)) == len(names)
    for cell in cells:
        assert re.fullmatch("[a-zA-Z0-9_-]{1,64}", cell["id"])
        keys = {"cell_type", "id", "metadata", "source"}
        if cell["cell_type"] == "code":
            assert (cell["execution_count"], cell["outputs"]) == (None, [])
            keys |= {"execution_count", "outputs"}
        assert set(cell) == keys
        lines = "".join(cell["source"]).splitlines()
        assert max(map(len, lines)) <= 100, (path.name, cell["id"])
        assert not any(line.startswith(("%", "!")) for line in lines)


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_needs_no_other_packages(path: Path) -> None:
    imported = set()
    for _, source in code(path):
        for node in ast.walk(ast.parse(source)):
            if isinstance(node, ast.Import):
                imported |= {alias.name.partition(".")[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom):
                imported.add(str(node.module).partition(".")[0])
    assert imported <= PACKAGES | sys.stdlib_module_names
