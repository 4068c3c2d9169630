#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The Blender add-on, installed from its zip: results and photographs become objects that Cycles renders as merlin relights.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/../cli/support/check.bash"
support=$(realpath "$(dirname "$0")/support")
# shellcheck source=tests/blender/support/blender.bash
source "$support/blender.bash"
# shellcheck source=tests/blender/support/results.bash
source "$support/results.bash"
needs_blender

echo "packed twice it is the same"
pack_addon
mkdir "$scratch/elsewhere" && cp -r "$MERLIN_SOURCE_DIR/tools" "$MERLIN_SOURCE_DIR/blender" "$scratch/elsewhere"
(umask 077 && TZ=Asia/Tokyo "$scratch/elsewhere/tools/pack-blender" "$scratch/second.zip")
cmp "$scratch/merlin-blender.zip" "$scratch/second.zip" || complain "it is not the same zip"

echo "its version is merlin's"
version=$("$MERLIN" --version | grep -oE '[0-9]+\.[0-9]+\.[0-9]+')
for words in "blender_manifest.toml:^version = \"$version\"" "__init__.py:\"version\": (${version//./, })"; do
    grep -q "${words#*:}" "$MERLIN_SOURCE_DIR/blender/merlin_import/${words%%:*}" || complain "${words%%:*} has not $version"
done

make_results "$scratch/results"
mkdir "$scratch/renders" "$scratch/photographs"
cp "$MERLIN_SOURCE_DIR"/examples/{demo,window}.png "$scratch/photographs"
in_blender check_results.py "$scratch/merlin-blender.zip" "$scratch/results"
in_blender check_renders.py "$scratch/merlin-blender.zip" "$scratch/results" "$scratch/renders"
in_blender check_photographs.py "$scratch/merlin-blender.zip" "$MERLIN" "$scratch/photographs"
finish
