#!/bin/sh
# Installs what render_peers.py compares with below target/: Mitsuba, and for its LLVM variant the
# LLVM library, unpacked from Debian's package where there is one.
set -eu
cd "$(dirname "$0")/../.."
python3 -m venv target/peers
target/peers/bin/pip install --quiet numpy==2.4.6 mitsuba==3.9.1
mkdir -p target/peers/llvm
cd target/peers/llvm
if apt-get download libllvm19 2>/dev/null; then
    dpkg-deb --extract libllvm19_*.deb .
else
    echo "libllvm19 is not to be had: only scalar_rgb is compared" >&2
fi
