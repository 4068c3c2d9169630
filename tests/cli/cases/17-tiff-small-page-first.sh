#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A TIFF whose first page is a thumbnail is its large page, to stereo and to estimate.
# shellcheck source=tests/cli/support/cases.bash
source "$(dirname "$0")/../support/cases.bash"
case_begin 17-tiff-small-page-first

succeeds out "$MERLIN" stereo . -o out
grep -q "\"width\":[[:space:]]*200" out/report.json || complain "the surface is not 200 pixels wide"
succeeds o "$MERLIN" estimate img_01.tif -o o --size 256 --views 1

finish
