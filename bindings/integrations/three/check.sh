#!/usr/bin/env bash
# Opens the laser spot in three.js, in a headless browser on a software adapter: check.sh [PICTURE].
# After bindings/web/build.sh.
set -euo pipefail
cd "$(dirname "$0")/../../.."
source bindings/web/browser.sh
rm -rf target/three
mkdir -p target/three
cp bindings/integrations/three/{index.html,spot.js} target/web/tem00_web{.js,_bg.wasm} target/three
cp target/browser/node_modules/three/build/three.{core,tsl,webgpu}.js target/three
cp bindings/integrations/three/check.mjs target/browser
node target/browser/check.mjs target/three "$@"
