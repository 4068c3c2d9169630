#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A 16-bit PNG's own word about its curve is heeded: the same capture stored linear gives the same surface.
# shellcheck source=tests/cli/support/cases.bash
source "$(dirname "$0")/../support/cases.bash"
case_begin 04-png16-srgb-chunk

succeeds out "$MERLIN" stereo . -o out
succeeds lin "$MERLIN" stereo linear -o lin
normals_within 0.5 lin out

finish
