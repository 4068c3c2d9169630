#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A mask of 0 and 1, of 0 and a label, or of two colours of a palette selects the object as white on black does.
# shellcheck source=tests/cli/support/cases.bash
source "$(dirname "$0")/../support/cases.bash"
case_begin 15-mask-of-labels

for m in m01 mpal m15; do
    succeeds "out-$m/overview.png" "$MERLIN" estimate photo.png --mask $m.png -o out-$m --size 256 --views 1
    cmp -s out-$m/mask.png out-m01/mask.png || complain "$m.png selects other than m01.png"
done
size=$(stat -c %s out-m01/mask.png)
[[ $size -gt 200 ]] || complain "the mask of $size bytes shows no object"

finish
