#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# merlin-lab eval detail: the table once with a tiny model, and one line for each kind of bad input.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/../../cli/support/check.bash"
train_tiny_model
weights=$scratch/weights.safetensors
detail() { "$MERLIN_LAB" eval detail --quiet "$@"; }

"$MERLIN_LAB" render --count 2 --size 320 --spp 1 --paths 1 --no-env --quiet -o "$scratch/large" >/dev/null
succeeds '^320 pixels a side ' detail --data "$scratch/large" --model "$weights" --count 1 --views 1
succeeds '^both ' detail --data "$scratch/large" --model "$weights"
for threads in 1 2; do
    OMP_NUM_THREADS=$threads detail --data "$scratch/large" --model "$weights" --json | sed 's/"seconds":[^,]*//' >"$scratch/$threads.json"
done
cmp -s "$scratch/1.json" "$scratch/2.json" || complain "results depend on the number of threads"
grep -q '"samples":2,"size":320,"larger":320,"views":4,.*"small":{"albedo_error":.*"large":{.*"both":{.*"relit_ssim"' "$scratch/1.json" ||
    complain "the JSON report lacks something"

refuses 2 "--data DIR is missing" detail --model "$weights"
refuses 2 'unexpected argument "more"' detail --data "$scratch/large" more
refuses 2 "--views" detail --data "$scratch/large" --views 9
refuses 1 "nothing finer than 256" detail --data "$scratch/samples" --model "$weights"
refuses 1 "missing" detail --data "$scratch/large" --model "$scratch/missing.safetensors"
cp "$scratch/samples/000000.exr" "$scratch/large/000002.exr"
refuses 1 "000002.exr is .* but the first sample is 320x320" detail --data "$scratch/large" --model "$weights"
finish
