#!/usr/bin/env bash
# Makes the pictures of this folder again: a render of every scene, and the diagrams of the
# examples.
#
#     docs/figures/make.sh [SAMPLES_PER_PIXEL]
set -euo pipefail
cd "$(dirname "$0")/../.."
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
for scene in examples/scenes/*.toml; do
    cargo run --locked --release -p tem00-cli -- render "$scene" --spp "${1:-64}" -o "$work"
done
for scene in spot line_on_metal grazing_waist; do
    cargo run --locked --release -p tem00-cli -- render "examples/scenes/$scene.toml" \
        --spp "${1:-64}" --no-speckle -o "$work/without"
    cp "$work/without/$scene.png" "docs/figures/${scene}_without_speckle.png"
done
render_spot() {
    cargo run --locked --release -p tem00-cli -- render examples/scenes/spot.toml \
        --spp "${3:-64}" --set "$2" -o "$work/$1"
    cp "$work/$1/spot.png" "docs/figures/spot_$1.png"
}
render_spot 1nm 'laser[0].linewidth="1 nm"' "$@"
render_spot 20nm 'laser[0].linewidth="20 nm"' "$@"
render_spot defocused 'camera.focus_distance="250 mm"' "$@"
cp "$work"/*.png docs/figures/
# With pieces of it enlarged; needs NumPy and Pillow, and so does the film, which is not made here.
docs/figures/front_page.py face "${1:-64}"
for example in beam_caustic correlated_slices focus_by_lens knife_edge line_profile paper_errors \
    thin_line; do
    cargo run --locked --release --example "$example"
    cp "out/$example.svg" docs/figures/
done
cargo run --locked --release --example decorrelation_curves
cp out/decorrelation_both.svg docs/figures/
cargo run --locked --release --example will_a_broader_source_help
cp out/broader_source_{noise,aperture}.svg docs/figures/
cargo run --locked --release --example my_part_is_plastic
cp out/plastic_shift.svg docs/figures/
# What the tutorial shows.
tem00-inspect() { cargo run --locked --release -p tem00-inspect -- "$@"; }
tem00-inspect design examples/setups/design.toml -o "$work/design"
cp "$work/design/trade_off.svg" docs/figures/triangulation_trade_off.svg
tem00-inspect triangulate examples/scenes/triangulation/step_gauge.toml -o "$work/gauge"
cp "$work/gauge/profile.svg" docs/figures/triangulation_profile.svg
tem00-inspect lines "$work/gauge/raw_0000.png" --window 21 -o "$work/lines"
cp "$work/lines/raw_0000_lines.png" docs/figures/triangulation_lines.png
tem00-inspect triangulate examples/scenes/triangulation/hexagon_nut.toml -o "$work/nut"
cp "$work/nut/height_map.png" docs/figures/triangulation_nut.png
# What they were made from: a test compares it.
md5sum examples/scenes/triangulation/{step_gauge,hexagon_nut}.toml \
    examples/scenes/meshes/{step_gauge,hexagon_nut}.ply > docs/figures/made_from.txt
