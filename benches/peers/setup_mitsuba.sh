#!/bin/sh
# Installs what render_peers.py compares with below target/: Mitsuba, and for its LLVM variant the
# LLVM library, unpacked from Debian's package where there is one.
set -eu
cd "$(dirname "$0")/../.."
python3 -m venv target/peers
target/peers/bin/pip install --quiet numpy==2.4.6 mitsuba==3.9.1
benches/peers/libllvm.sh || echo "no LLVM library: only scalar_rgb can be compared" >&2
