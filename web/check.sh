#!/usr/bin/env bash
# Builds the page and opens it in a headless browser, on a software adapter: web/check.sh [FOLDER FOR PICTURES]
set -euo pipefail
cd "$(dirname "$0")/.."
web/build.sh
source web/browser.sh
cp web/check.mjs target/browser
node target/browser/check.mjs target/web "$@"
