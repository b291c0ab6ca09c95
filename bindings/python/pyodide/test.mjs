// Loads a wheel in Pyodide: node test.mjs tem00-….whl. NumPy for Pyodide is in no package registry: numbers, no arrays.
import fs from "node:fs";
import { loadPyodide } from "pyodide";

const python = await loadPyodide();
python.unpackArchive(new Uint8Array(fs.readFileSync(process.argv[2])), "wheel");
python.runPython(`
import tem00
from tem00 import _tem00
from tem00.beam import GaussianBeam

assert abs(GaussianBeam.from_waist(632.8e-9, 100e-6).rayleigh_range - 49.65e-3) < 1e-5
try:
    GaussianBeam.from_waist(-1.0, 100e-6)
except tem00.ParameterError as error:
    assert "wavelength" in str(error), error
else:
    raise AssertionError("a negative wavelength")

print("tem00", tem00.__version__, "in Pyodide")
`);
