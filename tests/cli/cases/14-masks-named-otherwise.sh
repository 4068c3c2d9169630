#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Masks under their usual names are taken for masks, and not for photographs.
# shellcheck source=tests/cli/support/cases.bash
source "$(dirname "$0")/../support/cases.bash"
case_begin 14-masks-named-otherwise

estimate=("$MERLIN" estimate photos --size 64 --views 1 --json)
succeeds '"mask_file":"photos/a_mask.png"' "${estimate[@]}" -o out
[[ $(ls out) == $'a\nb' ]] || complain "photographs are $(ls out)"
for folder in masks masks_; do
    succeeds '"mask":"given"' "${estimate[@]}" --mask $folder -o out
    [[ $(grep -c '"mask":"given"' "$scratch/stdout") == 2 ]] || complain "$folder: not both masks are taken"
done
rm masks/a.PNG
refuses 1 'no mask for photos/a.jpg in masks: looked for .*a_mask.png' "${estimate[@]}" --mask masks

finish
