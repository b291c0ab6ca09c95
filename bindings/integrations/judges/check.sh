#!/usr/bin/env bash
# Has independent packages judge frames that the examples write. Needs cargo, and Python in a
# virtual environment that is active. TEM00_PROFILE names the profile of cargo to build with.
set -euo pipefail
cd "$(dirname "$0")/../../.."

profile="${TEM00_PROFILE:-dev}"
python -m pip install --quiet --requirement bindings/integrations/judges/requirements.txt
cargo build --quiet --profile "$profile" \
    --package tem00-cli --package tem00-inspect --package tem00 \
    --bin tem00 --bin tem00-inspect --example calibration_boards --example guide_to_uncertainty \
    --example line_frames --example photon_transfer
case "$profile" in
    dev) export TEM00_BUILD=target/debug ;;
    *) export TEM00_BUILD="target/$profile" ;;
esac

for check in bindings/integrations/judges/check_*.py; do
    echo "--- $(basename "$check")"
    python "$check"
done
