"""The page in a notebook: a part under a laser as a widget.

Its settings are set, and its speckle is read, in Python.

After `bindings/web/build.sh`, `pip install anywidget jupyterlab` and
`jupyter lab bindings/integrations/notebook/part.ipynb` it draws by WebGPU.
"""

import pathlib

import anywidget
import traitlets

_HERE = pathlib.Path(__file__).resolve().parent
# Also of a copy below target.
_ROOT = next((folder for folder in _HERE.parents if (folder / "Cargo.lock").exists()), _HERE)
_BUILT = _ROOT / "target" / "web"


class Part(anywidget.AnyWidget):
    """A part under a laser.

    Settings are those of the page, by name; a wrong one shows in `error` and changes nothing.
    """

    _esm = _HERE / "part.js"
    _module = traitlets.Unicode().tag(sync=True)
    _wasm = traitlets.Bytes().tag(sync=True)
    values = traitlets.Dict(
        key_trait=traitlets.Unicode(), value_trait=traitlets.Float()
    ).tag(sync=True)
    measured = traitlets.Dict(
        help="What is measured in the last picture, beside theory."
    ).tag(sync=True)
    error = traitlets.Unicode(
        help="Why the last settings made no picture, or nothing."
    ).tag(sync=True)

    def __init__(self, **values: float) -> None:
        """Starts with these settings; the others as the page has them."""
        if not (_BUILT / "tem00_web.js").exists():
            raise FileNotFoundError(f"{_BUILT} holds no page: run bindings/web/build.sh")
        super().__init__(
            _module=(_BUILT / "tem00_web.js").read_text(),
            _wasm=(_BUILT / "tem00_web_bg.wasm").read_bytes(),
            values=values,
        )

    def set(self, **values: float) -> None:
        """Changes some settings."""
        self.values = {**self.values, **values}
