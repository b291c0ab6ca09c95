#!/bin/sh
# Renders the same scenes with tem00 and with Mitsuba, in turns, and prints times and variances.
#
#     benches/peers/setup_mitsuba.sh        # once
#     benches/peers/render.sh [OPTIONS]     # those of render_peers.py
set -eu
cd "$(dirname "$0")/../.."
cargo build --quiet --release -p tem00-benches --example render_server
DRJIT_LIBLLVM_PATH="$(benches/peers/libllvm.sh || true)"
export DRJIT_LIBLLVM_PATH
exec target/peers/bin/python benches/peers/render_peers.py \
    target/release/examples/render_server "$@"
