#!/usr/bin/env bash
# merlin train: where a run starts from, and one line for each kind of bad input.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/support/check.bash"
make_tiny_model
train=("$MERLIN" train "$scratch/tiny.json" --data "$scratch/samples" -o "$scratch/more" --quiet)

# weights that ship go by their names here, too; these are of a larger model
for name in merlin-point merlin-env; do
    refuses 1 "$name.safetensors: .*another shape" "${train[@]}" --init "$name"
done
refuses 1 "no weights file merlin-pint" "${train[@]}" --init-shared merlin-pint
refuses 1 "missing.safetensors" "${train[@]}" --init "$scratch/missing.safetensors"
[[ ! -e $scratch/more ]] || complain "a run that could not start left a folder"
"${train[@]}" --init "$scratch/weights.safetensors" || complain "training does not start from its own weights"
refuses 2 "holds a run already" "${train[@]}" --init "$scratch/weights.safetensors"
refuses 2 "exclude each other" "${train[@]}" --init merlin-point --resume
finish
