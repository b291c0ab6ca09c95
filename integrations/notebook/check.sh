#!/usr/bin/env bash
# Draws the widget of a notebook in a headless browser on a software adapter, after web/build.sh. Needs a virtual environment.
set -euo pipefail
cd "$(dirname "$0")/../.."
pip install --quiet anywidget==0.11.0
source web/browser.sh
rm -rf target/notebook
mkdir -p target/notebook
cp integrations/notebook/part.js target/web/tem00_web_bg.wasm target/notebook
echo '<!doctype html><link rel="icon" href="data:,">' >target/notebook/empty.html
cp integrations/notebook/check.mjs target/browser
PYTHONPATH=integrations/notebook python -c '
import json
from part import Part
part = Part(part=0, light=1, line_width=15)
part.set(elevation=80)
state = part.get_state()
assert state["_wasm"][:4] == b"\0asm"
print(json.dumps({"values": state["values"], "_module": state["_module"]}))' |
    node target/browser/check.mjs target/notebook
