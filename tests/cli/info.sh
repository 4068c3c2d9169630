#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# merlin info: what it says of good weights, and one line for each kind of bad ones.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/support/check.bash"
make_tiny_model
make_bad_weights
weights=$scratch/weights.safetensors

succeeds "^model  *tiny" "$MERLIN" info "$weights"
succeeds "GMAC" "$MERLIN" info "$weights"
succeeds "encoder.*F16 .*x3x3" "$MERLIN" info "$weights" --tensors
succeeds '"parameters":' "$MERLIN" info "$weights" --json
succeeds '"type":.*"F16"' "$MERLIN" info "$weights" --json --tensors
succeeds '--quiet' "$MERLIN" info --help
"$MERLIN" info "$weights" --quiet >"$scratch/stdout" || complain "--quiet fails"
[[ ! -s $scratch/stdout ]] || complain "--quiet says $(cat "$scratch/stdout")"

refuses 2 "one weights file" "$MERLIN" info
refuses 2 "one weights file" "$MERLIN" info "$weights" "$weights"
refuses 1 "missing.safetensors" "$MERLIN" info "$scratch/missing.safetensors"
refuses 1 "merlin info: " "$MERLIN" info "$scratch"
for bad in empty truncated stub text altered; do
    refuses 1 "$bad.safetensors" "$MERLIN" info "$scratch/$bad.safetensors"
done
finish
