#!/usr/bin/env bash
# Builds the page and opens it in a headless browser, on a software adapter: web/check.sh [FOLDER FOR PICTURES]
set -euo pipefail
cd "$(dirname "$0")/.."
web/build.sh
for name in "${CHROMIUM:-}" chromium-headless-shell chromium google-chrome; do
    CHROMIUM="$(command -v "$name" || true)"
    [ -z "$CHROMIUM" ] || break
done
if [ -z "$CHROMIUM" ]; then
    package=chromium-headless-shell
    root="$([ "$(id -u)" = 0 ] || echo sudo)"
    $root apt-get install --yes --quiet "$package" >/dev/null ||
        { $root apt-get update --quiet && $root apt-get install --yes --quiet "$package" >/dev/null; } ||
        { echo "set CHROMIUM to the program of Chromium or Chrome" >&2; exit 1; }
    CHROMIUM="$package"
fi
export CHROMIUM
browser=target/web-check
mkdir -p "$browser"
[ -d "$browser/node_modules/puppeteer-core" ] ||
    npm install --prefix "$browser" --no-save --no-audit --no-fund --silent puppeteer-core@25.16.0
cp web/check.mjs "$browser"
node "$browser/check.mjs" target/web "$@"
