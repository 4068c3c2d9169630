#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# merlin-lab train: where a run starts from, and one line for each kind of bad input.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/../../cli/support/check.bash"
train_tiny_model
refuses 1 "checkpoint.safetensors is a checkpoint of training" "$MERLIN" info "$scratch/run/checkpoint.safetensors"
train=("$MERLIN_LAB" train "$scratch/tiny.json" --data "$scratch/samples" -o "$scratch/more" --quiet)

# weights that ship go by their names here, too; these are of a larger model
for name in merlin-point merlin-env; do
    refuses 1 "$name.safetensors: .*another shape" "${train[@]}" --init "$name"
done
refuses 1 "no weights file merlin-pint" "${train[@]}" --init-shared merlin-pint
refuses 1 "no weights file merlin-pint" "${train[@]}" --init-shared merlin-point --init-shared merlin-pint
refuses 1 "missing.safetensors" "${train[@]}" --init "$scratch/missing.safetensors"
[[ ! -e $scratch/more ]] || complain "a run that could not start left a folder"
"${train[@]}" --init "$scratch/weights.safetensors" --note 816b79b || complain "training does not start from its own weights"
succeeds '"note":.*"816b79b"' "$MERLIN" info "$scratch/more/weights.safetensors" --json
refuses 2 "holds a run already" "${train[@]}" --init "$scratch/weights.safetensors"
refuses 2 "exclude each other" "${train[@]}" --init merlin-point --resume
refuses 2 "exclude each other" "${train[@]}" --init-shared merlin-point --resume
refuses 2 "exclude each other" "${train[@]}" --init merlin-point --init-shared merlin-env
too_many=()
for _ in 1 2 3 4 5 6 7 8 9; do too_many+=(--init-shared merlin-env); done
refuses 2 "takes at most 8 weights" "${train[@]}" "${too_many[@]}"
finish
