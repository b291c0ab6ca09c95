#!/usr/bin/env bash
# Makes a wheel for Pyodide of a wheel for Linux and of the module for WebAssembly, and loads it in
# Node: check.sh tem00-….whl _tem00.wasm. Needs a virtual environment that is active, and npm.
set -euo pipefail
here="$(cd "$(dirname "$0")" && pwd)"
wheel="$(realpath "$1")" module="$(realpath "$2")"
mkdir -p "$here/../../../target/pyodide"
cd "$here/../../../target/pyodide"
rm -rf tem00-* ./*.whl

pip install --quiet wheel
python -m wheel unpack "$wheel" >/dev/null
cp "$module" tem00-*/tem00/_tem00.abi3.so
python -m wheel pack tem00-*/ >/dev/null
python -m wheel tags --remove --platform-tag pyemscripten_2026_0_wasm32 ./*.whl

[ -d node_modules/pyodide ] || npm install --silent --no-fund --no-audit pyodide@314.0.7
cp "$here/test.mjs" .
node test.mjs ./*.whl
