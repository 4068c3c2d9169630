#!/usr/bin/env bash
# The frame of an .lp is the object's: with --near its positions want the camera's distance, without it they are directions.
# shellcheck source=tests/cli/support/cases.bash
source "$(dirname "$0")/../support/cases.bash"
case_begin 09-lp-about-the-object

succeeds right "$MERLIN" stereo camera --near --fov 25 -o right
refuses 1 'about the object.*--distance.*without --near' "$MERLIN" stereo . --near --fov 25 -o a
succeeds b "$MERLIN" stereo . --near --fov 25 --distance 600 -o b
normals_within 0.5 right b
succeeds far "$MERLIN" stereo . --fov 25 -o far
normals_within 1.3 right far

finish
