#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A dome is lit from afar, as its list says: what stereo makes of it are the maps' normals.
# shellcheck source=tests/cli/support/cases.bash
source "$(dirname "$0")/../support/cases.bash"
case_begin 01-dome-lp-near-lamps

succeeds maps "$MERLIN" estimate photo.png --size 256 --views 1 -o maps
succeeds dome "$MERLIN" relight maps --dome 50 --lp -o dome
succeeds flat "$MERLIN" stereo dome -o flat
normals_within 1 maps flat
pictures=(dome/*.png)
[ ${#pictures[@]} = 50 ] || complain "among the dome's 50 pictures are other ones: ${#pictures[@]}"
sanitized && finish

# what fitters by least squares make of JPEGs without gloss
succeeds matte "$MERLIN" relight maps --dome 50 --lp --matte --format jpg -o matte
succeeds fitted "$MERLIN" stereo matte --method ls -o fitted
normals_within 1 maps fitted

succeeds beside "$MERLIN" relight maps --dome 50 --near -o beside
succeeds near "$MERLIN" stereo beside --near --fov 63 -o near
normals_within 1 maps near
finish
