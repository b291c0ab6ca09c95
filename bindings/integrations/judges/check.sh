#!/usr/bin/env bash
# Has independent packages judge frames that the examples write. Needs cargo, and Python in a
# virtual environment that is active. TEM00_BUILD names a folder in which programs and examples are
# built already.
set -euo pipefail
cd "$(dirname "$0")/../../.."

python -m pip install --quiet --requirement bindings/integrations/judges/requirements.txt
if [ -z "${TEM00_BUILD:-}" ]; then
    cargo build --quiet --package tem00-cli --package tem00-inspect --package tem00 \
        --bin tem00 --bin tem00-inspect --example calibration_boards \
        --example guide_to_uncertainty --example line_frames --example photon_transfer
    export TEM00_BUILD=target/debug
fi

for check in bindings/integrations/judges/check_*.py; do
    echo "--- $(basename "$check")"
    python "$check"
done
