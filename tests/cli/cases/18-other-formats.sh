#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Formats that are read are estimated whatever their name; others are refused by name.
# shellcheck source=tests/cli/support/cases.bash
source "$(dirname "$0")/../support/cases.bash"
case_begin 18-other-formats

estimate=("$MERLIN" estimate --size 64 -o out)
for name in a.gif a.ppm a.tga; do
    succeeds "out/overview.png" "${estimate[@]}" "$name"
    rm -rf out
done
refuses 1 "JPEG 2000" "${estimate[@]}" a.jp2
refuses 1 "JPEG XL" "${estimate[@]}" a.jxl

finish
