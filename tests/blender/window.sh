#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The Blender add-on in a window of a screen that nobody sees: merlin works beside it, and Escape ends it.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/../cli/support/check.bash"
support=$(realpath "$(dirname "$0")/support")
# shellcheck source=tests/blender/support/blender.bash
source "$support/blender.bash"
needs_blender
if ! command -v xvfb-run >/dev/null; then
    echo "skipped: there is no screen to open a window on (apt-get install xvfb xauth)"
    exit 77
fi
pack_addon
mkdir "$scratch/place"
show_blender check_window.py "$scratch/merlin-blender.zip" "$scratch/place" "$MERLIN_SOURCE_DIR/examples/demo.png"

echo "a Blender that ends does not leave it behind"
if [[ -d /proc/$(<"$scratch/place/process") ]]; then
    complain "the program still runs"
    kill -9 "$(<"$scratch/place/process")"
fi
finish
