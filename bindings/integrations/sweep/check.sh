#!/usr/bin/env bash
# Does a sweep in one go, by each template, and after a killed worker, and compares the tables byte
# for byte. Needs `tem00` on the path, and Python in a virtual environment that is active.
set -euo pipefail
cd "$(dirname "$0")/../../.."
python -m pip install --quiet --requirement bindings/integrations/sweep/requirements.txt

out=out/sweeps
rm -rf "$out"
mkdir -p "$out"
grid="$out/grid.toml"
cat > "$grid" <<TOML
[sweep]
command = "budget"
file = "../../examples/setups/data_sheet.toml"
options = ["--trials", "20"]
[[sweep.vary]]
key = "camera.f_number"
values = [4, 8]
[[sweep.vary]]
key = "laser.line_thickness"
from = "0.1 mm"
to = "0.3 mm"
steps = 3
TOML

same() {
    cmp "$out/at_once/sweep.csv" "$out/$1/sweep.csv"
    echo "$1: the same table"
}
tem00-inspect sweep "$grid" -o "$out/at_once" --quiet

openjd run bindings/integrations/sweep/openjd.yaml \
    -p Grid="$grid" -p Out="$PWD/$out/openjd" -p Tasks=0-5 > "$out/openjd.log"
same openjd

for task in 5 0 3 1 4 2; do
    SLURM_ARRAY_TASK_ID=$task bash bindings/integrations/sweep/slurm.sh "$grid" "$out/slurm"
done
tem00-inspect sweep "$grid" -o "$out/slurm" --gather
same slurm

snakemake -s bindings/integrations/sweep/Snakefile --cores 2 --quiet all \
    --config grid="$grid" out="$out/snakemake"
same snakemake

python bindings/integrations/sweep/with_dask.py "$grid" "$out/dask"
same dask

tem00-inspect sweep "$grid" -o "$out/killed" --quiet &
worker=$!
until ls "$out"/killed/rows/*.json > "$out/rows.log" 2>&1; do sleep 0.02; done
kill -KILL "$worker"
wait "$worker" || true
# A task that is done is not done again.
tem00-inspect sweep "$grid" -o "$out/killed" --task 0..3 --quiet
tem00-inspect sweep "$grid" -o "$out/killed" --task 2..5 --quiet
tem00-inspect sweep "$grid" -o "$out/killed" --gather
same killed
