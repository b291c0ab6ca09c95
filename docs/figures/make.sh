#!/usr/bin/env bash
# Makes the pictures of this folder again: one small render of every scene, and the diagrams of the
# examples.
set -euo pipefail
cd "$(dirname "$0")/../.."
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
for scene in scenes/*.toml; do
    cargo run --locked --release -- render "$scene" --spp "${1:-64}" -o "$work"
done
cargo run --locked --release -- render scenes/spot.toml --spp "${1:-64}" --no-speckle -o "$work/without"
cp "$work"/*.png docs/figures/
cp "$work/without/spot.png" docs/figures/spot_without_speckle.png
for example in beam_caustic correlated_slices defocus focus_by_lens interpolation_matters knife_edge \
    line_profile paper_errors phase_space surface_motion thin_line; do
    cargo run --locked --release --example "$example"
    cp "out/$example.svg" docs/figures/
done
cargo run --locked --release --example decorrelation_curves
cp out/decorrelation_both.svg docs/figures/
