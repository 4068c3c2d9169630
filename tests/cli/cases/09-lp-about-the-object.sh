#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The frame of an .lp is the object's: how far the camera is from it the pictures tell, with --near and without.
# shellcheck source=tests/cli/support/cases.bash
source "$(dirname "$0")/../support/cases.bash"
case_begin 09-lp-about-the-object

succeeds right "$MERLIN" stereo camera --near --fov 25 -o right
succeeds far "$MERLIN" stereo . --fov 25 -o far
# 600, within the search's last step of one per cent
grep -Eq 'taken for near ones: the camera then is (59[4-9]|60[0-6]) from there' "$scratch/stderr" || complain "$(cat "$scratch/stderr")"
normals_within 0.1 right far
sanitized && finish
succeeds a "$MERLIN" stereo . --near --fov 25 -o a
normals_within 0.1 right a
succeeds b "$MERLIN" stereo . --near --fov 25 --distance 600 -o b
normals_within 0.1 right b
succeeds plain "$MERLIN" stereo . -o plain
normals_within 0.5 right plain

finish
