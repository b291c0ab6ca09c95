#!/usr/bin/env bash
# A sweep as a Slurm array, one job for each task that `tem00-inspect sweep GRID --list` shows, and
# the table:
#   tasks=$(sbatch --parsable --array=0-23 bindings/integrations/sweep/slurm.sh GRID.toml OUT)
#   sbatch --dependency=afterok:$tasks --wrap "tem00-inspect sweep GRID.toml -o OUT --gather"
#SBATCH --job-name=tem00-sweep
#SBATCH --cpus-per-task=2
set -euo pipefail
tem00-inspect sweep "$1" -o "$2" --task "$SLURM_ARRAY_TASK_ID" --threads "${SLURM_CPUS_PER_TASK:-2}"
