#!/bin/sh
# Runs the bench of the beam library and its NumPy peer, one after the other on the same machine.
# A Python without NumPy gets a virtual environment under target/.
set -eu
cd "$(dirname "$0")/../.."

python=python3
if ! "$python" -c 'import numpy' 2>/dev/null; then
    python3 -m venv target/peers
    target/peers/bin/pip install --quiet numpy
    python=target/peers/bin/python
fi

cargo bench -p tem00-benches --no-default-features --features simd --bench beam
"$python" benches/peers/numpy_beam.py
