#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A photograph of 108 megapixels is read at half its sides.
# shellcheck source=tests/cli/support/cases.bash
source "$(dirname "$0")/../support/cases.bash"
case_begin 12-over-64-megapixels

succeeds out "$MERLIN" estimate phone108.jpg -o out --size 256 --views 1
size=$(od -An -tu1 -j16 -N8 out/mask.png)
read -r a b c d e f g h <<<"$size"
[[ $(((a << 24) + (b << 16) + (c << 8) + d)) == 6000 ]] || complain "the maps' width is made of the bytes $size, not 6000"
[[ $(((e << 24) + (f << 16) + (g << 8) + h)) == 4800 ]] || complain "the maps' height is made of the bytes $size, not 4800"
grep -q '"code":[[:space:]]*"reduced_size"' out/report.json || complain "the report does not say that it was reduced"
grep -q 'reduced size: 2 x 2 of its pixels' "$scratch/stderr" || complain "no line says so: $(cat "$scratch/stderr")"

finish
