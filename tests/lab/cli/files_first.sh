#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# What is not there is told before weights are read, in what trains, renders, measures and evaluates, too.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/../../cli/support/check.bash"
# shellcheck source=tests/cli/support/pictures.bash
source "$(dirname "$0")/../../cli/support/pictures.bash"
make_tiny_model
make_bad_weights
cd "$scratch" || exit 1
bad=(--model truncated.safetensors)
"$MERLIN_LAB" render --count 1 --size 32 --spp 1 --paths 1 --no-env -q -o taken || complain "no sample"
refuses 1 "there is no file of means missing.exr" "$MERLIN_LAB" eval --data taken --means-file missing.exr "${bad[@]}"
refuses 1 "there is no photograph or folder missing.png" "$MERLIN_LAB" eval doubts --right missing.png "${bad[@]}"
refuses 1 "there is no photograph or folder missing.png" "$MERLIN_LAB" eval doubts --wrong missing.png "${bad[@]}"
refuses 1 "there is no photograph missing.png" "$MERLIN_LAB" eval photos missing.png -o sheet.png "${bad[@]}"
refuses 1 "there is no weights file missing.safetensors" "$MERLIN_LAB" bench --quick --model missing.safetensors
refuses 1 "there is no configuration missing.json" "$MERLIN_LAB" train missing.json --data taken -o new
refuses 1 "there is no weights file missing.safetensors" "$MERLIN_LAB" train model.json --data none -o new --init missing.safetensors
refuses 1 "there is no mesh missing.obj" "$MERLIN_LAB" render --count 1 --env-dir none --mesh missing.obj -o taken
refuses 1 "there is no folder of environments none" "$MERLIN_LAB" render --count 1 --env-dir none -o taken
absent new sheet.png
finish
