#!/usr/bin/env bash
# A folder of a hundred thousand photographs in a hundred jobs. One that is started again does what is not done yet.
#
#     sbatch examples/cluster/estimate.sh photos maps
#SBATCH --job-name=merlin-estimate
#SBATCH --array=1-100
#SBATCH --cpus-per-task=2
#SBATCH --time=02:00:00
#SBATCH --requeue
set -euo pipefail
merlin estimate "$1" -o "$2" --share "$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT" --resume -q \
    --threads "$SLURM_CPUS_PER_TASK"
