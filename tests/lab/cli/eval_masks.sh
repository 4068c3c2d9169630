#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# merlin-lab eval masks: photographs and samples whose mask is known, and one line for each kind of bad input.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/../../cli/support/check.bash"
masks() { "$MERLIN_LAB" eval masks --quiet "$@"; }

"$MERLIN_LAB" render --count 3 --size 128 --spp 1 --paths 1 --no-env --quiet -o "$scratch/samples" >/dev/null
succeeds '^dark  *3 ' masks --data "$scratch/samples"
succeeds '^all  *5 ' masks --data "$scratch/samples" --count 1
for threads in 1 2; do
    OMP_NUM_THREADS=$threads masks --data "$scratch/samples" --json >"$scratch/$threads.json"
done
cmp -s "$scratch/1.json" "$scratch/2.json" || complain "results depend on the number of threads"
grep -q '"kinds":\[{"kind":"dark","pictures":3,"iou_median":.*"reliability":\[.*"pictures":\[{"name":"000000.exr","kind":"dark","found":true,"iou":0.9' \
    "$scratch/1.json" || complain "the JSON report lacks something"
masks --data "$scratch/samples" --seed 2 --json >"$scratch/other.json"
! cmp -s "$scratch/1.json" "$scratch/other.json" || complain "another seed makes the same pictures"

refuses 2 "nothing to search" masks
refuses 2 "--mask is of photographs" masks --data "$scratch/samples" --mask mask.png
refuses 2 "--count wants" masks --data "$scratch/samples" --count 0
refuses 1 "missing" masks --data "$scratch/missing"
refuses 1 "missing.png" masks "$scratch/missing.png"
mkdir "$scratch/unmasked"
cp "$MERLIN_SOURCE_DIR/models/merlin-env-curves.png" "$scratch/unmasked/a.png"
refuses 1 "none of the photographs has a mask" masks "$scratch/unmasked"
cp "$MERLIN_SOURCE_DIR/examples/demo.png" "$scratch/unmasked/a.mask.png"
refuses 1 "the mask of a.png is" masks "$scratch/unmasked"
finish
