#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# --mesh takes a mesh's name, as merlin stereo does; alone it writes mesh.glb.
# shellcheck source=tests/cli/support/cases.bash
source "$(dirname "$0")/../support/cases.bash"
case_begin 19-estimate-mesh-file

succeeds 'photo.png: photo.merlin/overview.png' "$MERLIN" estimate photo.png --mesh out.obj --size 64 --views 1
grep -q '^f ' out.obj || complain "out.obj has no faces"
[[ -e photo.merlin/mesh.glb ]] && complain "mesh.glb is written beside the mesh that was asked for"
succeeds 'photo.png: photo.merlin/overview.png' "$MERLIN" estimate --mesh photo.png --size 64 --views 1
[[ -s photo.merlin/mesh.glb ]] || complain "--mesh alone writes no mesh.glb"
refuses 2 'one photograph' "$MERLIN" estimate photo.png photo.png --mesh out.obj

finish
