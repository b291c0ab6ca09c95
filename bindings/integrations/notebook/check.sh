#!/usr/bin/env bash
# Runs the notebook in JupyterLab, in a headless browser on a software adapter, after
# bindings/web/build.sh: check.sh [FOLDER FOR PICTURES]. Needs a virtual environment.
set -euo pipefail
cd "$(dirname "$0")/../../.."
pip install --quiet anywidget==0.11.0 jupyterlab==4.6.6
source bindings/web/browser.sh
rm -rf target/notebook
mkdir -p target/notebook
cp bindings/integrations/notebook/part.* target/notebook
cp bindings/integrations/notebook/check.mjs target/browser
node target/browser/check.mjs target/notebook "$@"
