#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A capture's mask is taken whatever picture it is and in whatever case its name is written.
# shellcheck source=tests/cli/support/cases.bash
source "$(dirname "$0")/../support/cases.bash"
case_begin 07-capture-mask-ignored

for folder in *.d; do
    succeeds '"pixels":4675[,}]' "$MERLIN" stereo "$folder" -o "out_$folder" --json
    grep -q files_skipped "$scratch/stdout" && complain "$folder: something was skipped"
done

finish
