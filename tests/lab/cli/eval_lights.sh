#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# merlin-lab eval lights: the table once with a tiny model, and one line for each kind of bad input.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/../../cli/support/check.bash"
train_tiny_model
weights=$scratch/weights.safetensors
lights() { "$MERLIN_LAB" eval lights --quiet "$@"; }

"$MERLIN_LAB" render --count 2 --size 64 --spp 1 --paths 1 --lamp-angles 5,30,80 --fov 30 --quiet -o "$scratch/lit" >/dev/null
succeeds '^lamp to 10 degrees  *2 ' lights --data "$scratch/lit" --model "$weights" --views 1
succeeds '^lamp further aside  *2 ' lights --data "$scratch/lit" --model "$weights" --lens-unknown --views 1
lights --data "$scratch/lit" --model "$weights" --json --views 1 >"$scratch/report.json"
grep -q '"samples":2,.*"lights":{"flash":{"photographs":2,"normal_angle_degrees":.*"flash in a room".*"lamp to 40 degrees"' \
    "$scratch/report.json" || complain "the JSON report lacks something"
! grep -q 'lamp to 25 degrees' "$scratch/report.json" || complain "a kind of light without a photograph is told"

refuses 2 "--data DIR is missing" lights --model "$weights"
refuses 1 "render samples with --lamps" lights --data "$scratch/samples" --model "$weights"
"$MERLIN_LAB" render --count 1 --size 72 --spp 1 --paths 1 --lamps 1 --quiet -o "$scratch/odd" >/dev/null
succeeds '^flash  *1 ' lights --data "$scratch/odd" --model "$weights" --views 1
refuses 2 "--lamp-angles" "$MERLIN_LAB" render --count 1 --lamp-angles 5,,6 -o "$scratch/none"
finish
