#!/usr/bin/env bash
# One training run over eight machines, a rank each. Before its time is over it is told to stop, writes a checkpoint, and
# is queued again to go on from there.
#
#     sbatch examples/cluster/train.sh configs/runs/merlin-point/01-128.json data/train runs/point
#SBATCH --job-name=merlin-train
#SBATCH --nodes=8
#SBATCH --ntasks-per-node=1
#SBATCH --cpus-per-task=16
#SBATCH --time=04:00:00
#SBATCH --signal=B:TERM@180
#SBATCH --requeue
#SBATCH --open-mode=append
set -uo pipefail
resume=()
[[ ! -e $3/checkpoint.safetensors ]] || resume=(--resume)
srun --mpi=pmix merlin-lab train "$1" --data "$2" -o "$3" --mpi --threads "$SLURM_CPUS_PER_TASK" -q "${resume[@]}" &
steps=$!
trap 'stopped=1; scancel --signal=TERM "$SLURM_JOB_ID.0"' TERM
wait "$steps"
status=$?
[[ -z ${stopped:-} ]] || { wait "$steps"; scontrol requeue "$SLURM_JOB_ID"; }
exit "$status"
