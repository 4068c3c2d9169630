#!/usr/bin/env bash
# Small hostile pictures are refused in one line, within ten seconds and a gigabyte of memory.
# shellcheck source=tests/cli/support/cases.bash
source "$(dirname "$0")/../support/cases.bash"
case_begin 20-hostile

limited_refusal() { (ulimit -v 3000000 && exec timeout 10 "$MERLIN" estimate "$1" -o out --size 256 --views 1); }
refuses 1 "2147483647 x 2147483647 pixels" limited_refusal png_max31.png
refuses 1 "1000 samples a pixel" limited_refusal bomb_tif_bands1000_strips.tif
refuses 1 "damaged or cut short" limited_refusal dng_ljpeg_huge.dng

finish
