#!/usr/bin/env bash
# Tests and times the crate tem00-gpu on the graphics card of this machine, and CuPy and PyTorch on
# the same card, in a few minutes. Needs a Vulkan driver; for the peers a CUDA card, and Python with
# venv.
set -euo pipefail
cd "$(dirname "$0")/../.."
cargo test --locked --release -p tem00-gpu
cargo run --locked --release -p tem00-gpu --example times
if ! command -v nvidia-smi >/dev/null; then
    echo "no CUDA card: the peers are left out"
    exit 0
fi
peers=target/peers/card
[ -d "$peers" ] || python3 -m venv "$peers"
"$peers/bin/pip" install --quiet cupy-cuda12x torch
"$peers/bin/python" benches/peers/card_peers.py
# Once more, in the same minutes: cards change their clocks.
cargo run --locked --release -p tem00-gpu --example times
