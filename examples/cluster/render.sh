#!/usr/bin/env bash
# 64 thousand samples in 64 jobs of a thousand. Each renders its own numbers into the same folder; one that was stopped
# goes on where it was when it is started again.
#
#     sbatch examples/cluster/render.sh data/train
#SBATCH --job-name=merlin-render
#SBATCH --array=0-63
#SBATCH --cpus-per-task=4
#SBATCH --time=01:00:00
#SBATCH --requeue
set -euo pipefail
merlin-lab render --first $((SLURM_ARRAY_TASK_ID * 1000)) --count 1000 --seed 1 --size 128 --no-env -q -o "$1" \
    --threads "$SLURM_CPUS_PER_TASK"
