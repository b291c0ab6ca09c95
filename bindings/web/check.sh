#!/usr/bin/env bash
# Builds the page and opens it in a headless browser, on a software adapter:
# bindings/web/check.sh [FOLDER FOR PICTURES]
set -euo pipefail
cd "$(dirname "$0")/../.."
bindings/web/build.sh
source bindings/web/browser.sh
cp bindings/web/check.mjs target/browser
node target/browser/check.mjs target/web "$@"
