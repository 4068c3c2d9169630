#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# merlin-lab average: of a file with itself it is the same network; and one line for each kind of bad input.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/../../cli/support/check.bash"
average() { "$MERLIN_LAB" average "$@"; }
"$TINY_MODEL" "$scratch/a.safetensors"
"$TINY_MODEL" "$scratch/b.safetensors" several
a=$scratch/a.safetensors b=$scratch/b.safetensors mean=$scratch/mean.safetensors

average "$a" "$a" --share 0.25 -o "$mean" || complain "there is no mean"
succeeds 'note  *(1 - 0.25) times a.safetensors plus 0.25 times a.safetensors' "$MERLIN" info "$mean"
succeeds 'presentations  *4$' "$MERLIN" info "$mean"
"$MERLIN" estimate "$MERLIN_SOURCE_DIR/examples/demo.png" --model "$a" --size 64 --views 1 -q -o "$scratch/one"
"$MERLIN" estimate "$MERLIN_SOURCE_DIR/examples/demo.png" --model "$mean" --size 64 --views 1 -q -o "$scratch/two"
cmp "$scratch/one/albedo.png" "$scratch/two/albedo.png" || complain "the mean of a file with itself is another network"

refuses 1 "are of different networks" average "$a" "$b" -o "$scratch/none.safetensors"
[ ! -e "$scratch/none.safetensors" ] || complain "a refused mean was written"
refuses 2 "name two weights files, not 1" average "$a" -o "$mean"
refuses 2 "-o FILE is missing" average "$a" "$a"
refuses 2 "--share" average "$a" "$a" -o "$mean" --share 2
refuses 2 "would replace weights" average "$a" "$mean" -o "$mean"
refuses 1 "missing" average "$a" "$scratch/missing.safetensors" -o "$mean"
finish
