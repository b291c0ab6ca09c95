"""The page on Python does what it says, and every docstring is written in one dialect."""

import contextlib
import inspect
import io
import re
from collections.abc import Iterator
from pathlib import Path

import numpydoc.validate  # type: ignore[import-untyped]
import pytest
import tem00
from tem00 import beam, coherence, decorrelation, shading, speckle, statistics

PAGE = Path(__file__).parents[3] / "docs/python.md"
MODULES = (beam, beam.closed_form, coherence, decorrelation, shading, speckle, statistics)


def blocks(language: str) -> list[str]:
    """Return the blocks of the page in a language."""
    return re.findall(rf"^```{language}\n(.*?)^```", PAGE.read_text(encoding="utf-8"), re.M | re.S)


def test_the_examples_of_the_page_print_what_it_says() -> None:
    printed = io.StringIO()
    names: dict[str, object] = {}
    with contextlib.redirect_stdout(printed):
        for block in blocks("python"):
            exec(block, names)
    assert printed.getvalue() == "".join(blocks("text"))


def documented() -> Iterator[tuple[str, object]]:
    """Return the names of all that users call, and the objects."""
    for module in MODULES:
        for name, value in vars(module).items():
            if name.startswith("_") or inspect.ismodule(value) or not callable(value):
                continue
            yield f"{module.__name__}.{name}", value
            if inspect.isclass(value) and not issubclass(value, Exception):
                for member, inner in vars(value).items():
                    if not member.startswith("_"):
                        yield f"{module.__name__}.{name}.{member}", inner


# What numpydoc says of sections, and of parameters where they are listed: names, order, types, the
# space before a colon.
RULES = {"GL06", "GL07", "PR02", "PR03", "PR05", "PR10"}


@pytest.mark.parametrize("name", [name for name, _ in documented()])
def test_docstrings_are_those_of_numpydoc(name: str) -> None:
    found = numpydoc.validate.validate(name)
    errors = [(code, text) for code, text in found["errors"] if code in RULES]
    assert not errors, f"{name}: {errors}"
    # Code stands between two backticks, as in all of them.
    assert not re.search(r"(?<!`)`(?!`)[^`]+(?<!`)`(?!`)", found["docstring"]), found["docstring"]


CLASSES = [
    value
    for _, value in documented()
    if inspect.isclass(value) and not issubclass(value, Exception)
]


@pytest.mark.parametrize("cls", CLASSES, ids=lambda cls: cls.__name__)
def test_every_class_has_a_repr_and_says_how_it_is_made(cls: type) -> None:
    assert any("__repr__" in vars(base) for base in cls.__mro__ if base is not object)
    with pytest.raises(TypeError) as caught:
        cls(*[object()] * 40)
    message = str(caught.value)
    assert "No constructor" not in message
    if "it is made by" in message:
        _, makers = message.split(" is made by ")
        for maker in re.findall(r"[A-Za-z_.]+", makers):
            owner, _, member = maker.rpartition(".")
            scopes = [vars(module).get(owner) for module in MODULES] if owner else [cls, *MODULES]
            assert maker in ("or", "and") or any(hasattr(scope, member) for scope in scopes), maker


def test_an_estimate_is_a_number() -> None:
    value = tem00.beam.Estimate(2.0, 0.25)
    assert isinstance(value, float)
    assert (value.value, value.standard_error) == (2.0, 0.25)
    assert (2 * value, value / 4, value - 1, -value, abs(value), value**2) == (4, 0.5, 1, -2, 2, 4)
    assert 1.0 < value <= 2.0 == value
    assert f"{value:.3f} {value}" == "2.000 2.0 ± 0.25"
    assert sorted([value, 1.0]) == [1.0, value]
