#!/usr/bin/env bash
# Builds the page into target/web: static files, to be served from any folder.
set -euo pipefail
cd "$(dirname "$0")/../.."
rustup target list --installed | grep -qx wasm32-unknown-unknown ||
    rustup target add wasm32-unknown-unknown
version="$(sed -n 's/^wasm-bindgen = "=\(.*\)"/\1/p' bindings/web/Cargo.toml)"
bindgen="target/wasm-bindgen-$version/debug/bindgen"
# Its library alone: its program is installed together with servers for tests, which take longer
# to compile than all else.
if [ ! -x "$bindgen" ]; then
    tool="target/wasm-bindgen-$version/tool"
    mkdir -p "$tool/src"
    cat > "$tool/Cargo.toml" <<TOML
[workspace]

[package]
name = "bindgen"
edition = "2024"

[dependencies]
wasm-bindgen-cli-support = "=$version"

[profile.dev]
debug = false
TOML
    cat > "$tool/src/main.rs" <<'RUST'
fn main() {
    let mut arguments = std::env::args_os().skip(1);
    let mut path = || arguments.next().expect("bindgen PROGRAM.wasm FOLDER");
    let mut bindgen = wasm_bindgen_cli_support::Bindgen::new();
    bindgen.input_path(path()).web(true).expect("a page");
    bindgen.typescript(false).omit_default_module_path(false);
    bindgen.remove_name_section(true).remove_producers_section(true);
    bindgen.generate(path()).expect("bindings");
}
RUST
    cargo build --quiet --manifest-path "$tool/Cargo.toml" \
        --target-dir "target/wasm-bindgen-$version"
fi
optimiser=target/binaryen/node_modules/.bin/wasm-opt
[ -x "$optimiser" ] || npm install --silent --no-save --prefix target/binaryen binaryen@132.0.0
cargo build --locked -p tem00-web --profile smallest --target wasm32-unknown-unknown
rm -rf target/web
mkdir -p target/web
"$bindgen" target/wasm32-unknown-unknown/smallest/tem00_web.wasm target/web
"$optimiser" -Oz target/web/tem00_web_bg.wasm -o target/web/tem00_web_bg.wasm
cp bindings/web/static/* target/web/
du -cb target/web/* | tail -n 1 | sed 's/\s.*/ bytes in target\/web/'
