#!/bin/sh
# Fuzzes every target in turn, from what lies in the repository.
#
#     cargo install cargo-fuzz              # once
#     tests/fuzz/run.sh [SECONDS] [TARGET...]
#
# With a stable toolchain, set RUSTC_BOOTSTRAP=1.
set -eu
cd "$(dirname "$0")"
seconds="${1:-60}"
[ $# -eq 0 ] || shift
[ $# -gt 0 ] || set -- scene_file mesh_gltf mesh_obj mesh_ply mesh_stl
mkdir -p corpus/scene_file corpus/mesh_gltf corpus/mesh_obj corpus/mesh_ply corpus/mesh_stl
cp ../../examples/scenes/*.toml corpus/scene_file
for extension in gltf obj ply stl; do
    cp seeds/*."$extension" "corpus/mesh_$extension"
done
cp seeds/*.glb corpus/mesh_gltf
for target in "$@"; do
    cargo fuzz run --sanitizer none "$target" -- \
        -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048
done
