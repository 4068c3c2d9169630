#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Pipes in the place of files are refused before they are opened by what trains, renders and evaluates, too.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/../../cli/support/check.bash"

cd "$scratch" || exit 1
for ending in obj safetensors json gltf ply; do mkfifo "pipe.$ending"; done
mkdir folder capture
mkfifo folder/maps.exr capture/a.png
soon=(timeout 20 "$MERLIN_LAB")

refuses 1 'not a plain file' "${soon[@]}" eval --data folder --model pipe.safetensors
refuses 1 'pipe.json is not a plain file' "${soon[@]}" train pipe.json --data folder -o run
refuses 1 'capture/a.png: it is not a plain file' "${soon[@]}" render --count 1 --env-dir capture -o out
refuses 1 'capture/a.png: it is not a plain file' "${soon[@]}" render --count 1 --material-dir capture -o out
for mesh in pipe.obj pipe.ply pipe.gltf; do
    refuses 1 "$mesh: not a plain file" "${soon[@]}" render --count 1 --mesh "$mesh" -o out
done
finish
