"""The page in a notebook: a part under a laser as a widget whose settings are set, and whose speckle is read, in Python.

After `web/build.sh` and `pip install anywidget`, in a notebook in this folder:

    from part import Part
    part = Part(part=0, light=1, line_width=15, elevation=80)
    part                                  # draws it, by WebGPU
    part.set(tilt=0.5)                    # in the units of the page
    part.measured                         # {'contrast': 0.97, 'contrast_in_theory': 0.96, ...}
"""

import pathlib

import anywidget
import traitlets

_HERE = pathlib.Path(__file__).resolve().parent
_BUILT = _HERE.parents[1] / "target" / "web"


class Part(anywidget.AnyWidget):
    """A part under a laser. Settings are those of the page, by name; a wrong one shows in `error` and changes nothing."""

    _esm = _HERE / "part.js"
    _module = traitlets.Unicode().tag(sync=True)
    _wasm = traitlets.Bytes().tag(sync=True)
    values = traitlets.Dict(key_trait=traitlets.Unicode(), value_trait=traitlets.Float()).tag(sync=True)
    measured = traitlets.Dict(help="What is measured in the last picture, beside theory.").tag(sync=True)
    error = traitlets.Unicode(help="Why the last settings made no picture, or nothing.").tag(sync=True)

    def __init__(self, **values: float) -> None:
        """Starts with these settings; the others as the page has them."""
        if not (_BUILT / "tem00_web.js").exists():
            raise FileNotFoundError(f"{_BUILT} holds no page: run web/build.sh")
        super().__init__(
            _module=(_BUILT / "tem00_web.js").read_text(),
            _wasm=(_BUILT / "tem00_web_bg.wasm").read_bytes(),
            values=values,
        )

    def set(self, **values: float) -> None:
        """Changes some settings."""
        self.values = {**self.values, **values}
