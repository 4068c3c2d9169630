#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A folder's photographs are told by content: none of these endings is skipped, and what is no picture is named.
# shellcheck source=tests/cli/support/cases.bash
source "$(dirname "$0")/../support/cases.bash"
case_begin 10-batch-skips-silently

for folder in mixed hif; do
    succeeds "$folder/" "$MERLIN" estimate $folder -o out_$folder --size 64 --views 1
    ! grep -q skipped "$scratch/stderr" || complain "of $folder it said: $(cat "$scratch/stderr")"
    [[ $(ls out_$folder | wc -l) == $(ls $folder | wc -l) ]] || complain "of $folder it took $(ls out_$folder)"
done
echo "no picture" >hif/DSC0003.ARW.pdf
succeeds "hif/" "$MERLIN" estimate hif -o out_hif --size 64 --views 1
grep -q '1 file skipped: DSC0003.ARW.pdf' "$scratch/stderr" || complain "a skipped file has no word: $(cat "$scratch/stderr")"

finish
