#!/bin/sh
# Installs the Python libraries that fft_peers.py compares with, below target/.
set -eu
cd "$(dirname "$0")/../.."
python3 -m venv target/peers
target/peers/bin/pip install --quiet numpy==2.4.6 scipy==1.17.1 pyFFTW==0.15.1 pyspeckle==0.6.1
