#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A raw picture of deflated floats is read, as a photograph and as a picture of a capture.
# shellcheck source=tests/cli/support/cases.bash
source "$(dirname "$0")/../support/cases.bash"
case_begin 11-float-dng

succeeds "out/overview.png" "$MERLIN" estimate hdr.dng --size 64 -o out
[[ -s out/maps.exr ]] || complain "no maps"

finish
