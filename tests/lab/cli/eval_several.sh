#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# merlin-lab eval several: the table by a tiny network of several photographs, and one line for each kind of bad input.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/../../cli/support/check.bash"
weights=$scratch/several.safetensors
"$TINY_MODEL" "$weights" several
several() { "$MERLIN_LAB" eval several --quiet "$@"; }

"$MERLIN_LAB" render --count 1 --size 256 --spp 1 --paths 1 --lamps 3 --fov 30 --quiet -o "$scratch/lit" >/dev/null
succeeds '^2  *1 ' several --data "$scratch/lit" --model "$weights" --views 2
several --data "$scratch/lit" --model "$weights" --json --views 1 >"$scratch/report.json"
grep -q '"photographs":{"1":{"samples":1,"normal_angle_degrees":.*"2":' "$scratch/report.json" ||
    complain "the JSON report lacks something"
! grep -q '"4":' "$scratch/report.json" || complain "there are four photographs of three lamps"

succeeds '^2  *1 ' several --data "$scratch/lit" --model "$weights" --views 1 --size 64
refuses 1 "nor are weights of that name" several --data "$scratch/lit" --model "$weights" --several merlin-none
refuses 2 "--size wants a multiple of 32, not 100" several --data "$scratch/lit" --model "$weights" --size 100
refuses 2 "--data DIR is missing" several --model "$weights"
"$TINY_MODEL" "$scratch/flash.safetensors"
refuses 1 "is for flashes" several --data "$scratch/lit" --model "$scratch/flash.safetensors"
"$MERLIN_LAB" render --count 1 --size 64 --spp 1 --paths 1 --lamps 1 --quiet -o "$scratch/small" >/dev/null
refuses 1 "render them with --size 256" several --data "$scratch/small" --model "$weights"
finish
