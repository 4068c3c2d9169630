#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Small hostile pictures are refused in one line, within ten seconds and a gigabyte of memory.
# shellcheck source=tests/cli/support/cases.bash
source "$(dirname "$0")/../support/cases.bash"
case_begin 20-hostile

estimate=("$MERLIN" estimate -o out --size 256 --views 1)
refuses 1 "2147483647 x 2147483647 pixels" bounded "${estimate[@]}" png_max31.png
refuses 1 "1000 samples a pixel" bounded "${estimate[@]}" bomb_tif_bands1000_strips.tif
refuses 1 "damaged or cut short" bounded "${estimate[@]}" dng_ljpeg_huge.dng
# libraries' own lines stay where reports of sanitizers must be seen
sanitized || refuses 1 "cannot read" bounded "${estimate[@]}" heif_mdat_ff.avif

finish
