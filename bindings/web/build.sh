#!/usr/bin/env bash
# Builds the page into target/web: static files, to be served from any folder.
set -euo pipefail
cd "$(dirname "$0")/../.."
rustup target list --installed | grep -qx wasm32-unknown-unknown ||
    rustup target add wasm32-unknown-unknown
version="$(sed -n 's/^wasm-bindgen = "=\(.*\)"/\1/p' bindings/web/Cargo.toml)"
bindgen="target/wasm-bindgen-$version/bin/wasm-bindgen"
# Without the lock of its own, which is older than what it needs, and unoptimised, in half of the
# time.
[ -x "$bindgen" ] || CARGO_PROFILE_DEV_DEBUG=none cargo install --quiet --debug wasm-bindgen-cli \
    --version "$version" --root "target/wasm-bindgen-$version"
optimiser=target/binaryen/node_modules/.bin/wasm-opt
[ -x "$optimiser" ] || npm install --silent --no-save --prefix target/binaryen binaryen@132.0.0
cargo build --locked -p tem00-web --profile smallest --target wasm32-unknown-unknown
rm -rf target/web
mkdir -p target/web
"$bindgen" --target web --no-typescript --remove-name-section --remove-producers-section \
    --out-dir target/web target/wasm32-unknown-unknown/smallest/tem00_web.wasm
"$optimiser" -Oz target/web/tem00_web_bg.wasm -o target/web/tem00_web_bg.wasm
cp bindings/web/static/* target/web/
du -cb target/web/* | tail -n 1 | sed 's/\s.*/ bytes in target\/web/'
