#!/bin/sh
# Ours and theirs in one run, in turns: prints milliseconds and their ratios.
#
#     benches/peers/setup.sh                # once
#     benches/peers/compare.sh [ROUNDS]
#
# Ours is built with the features in FEATURES: threads and wide vector instructions unless it is
# set.
set -eu
cd "$(dirname "$0")/../.."
cargo build --quiet --release -p tem00-benches --no-default-features \
    --features "${FEATURES:-parallel,simd}" --example pattern_server
exec target/peers/bin/python benches/peers/fft_peers.py target/release/examples/pattern_server "$@"
