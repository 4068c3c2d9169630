#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Pipes and devices in the place of files are refused before they are opened, whatever they should have been: no command
# waits for somebody to write into them, and nothing is taken from them.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/support/check.bash"

cd "$scratch" || exit 1
for ending in exr png obj lp safetensors json gltf ply; do mkfifo "pipe.$ending"; done
mkdir folder capture
mkfifo folder/maps.exr capture/a.png capture/mask.png capture/lights.lp
soon=(timeout 20 "$MERLIN")

refuses 1 'pipe.exr: it is not a plain file' "${soon[@]}" estimate pipe.exr
refuses 1 'folder/maps.exr is not a plain file' "${soon[@]}" relight folder --light 0,0,0
refuses 1 'pipe.exr: it is not a plain file' "${soon[@]}" relight folder --env pipe.exr
refuses 1 'not a plain file' "${soon[@]}" stereo capture
refuses 1 'not a plain file' "${soon[@]}" stereo capture --lights pipe.lp
refuses 1 'pipe.exr is not a plain file' "${soon[@]}" info pipe.exr
refuses 1 'zero: it is not a plain file' "${soon[@]}" estimate /dev/zero

finish
