#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# glTF files that harm a careless reader: each is rendered or refused in one line, in 10 s and 1 GB, and nothing is waited for.
# shellcheck source=tests/cli/support/cases.bash
source "$(dirname "$0")/../support/cases.bash"
case_begin 20-hostile
command -v python3 >/dev/null || {
    echo "skipped: python3, which makes the files, is not here"
    exit 77
}
[[ -n ${MERLIN_LAB:-} ]] || {
    echo "skipped: merlin-lab, which reads meshes, is not built"
    exit 77
}
python3 make_gltf.py
mkfifo pipe
printf 'mtllib pipe\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n' >library.obj

render=("$MERLIN_LAB" render --count 1 --no-env --quiet)
for name in deep_nodes.gltf many_attributes.gltf library.obj; do
    bounded "${render[@]}" --mesh "$name" -o "out-$name" 2>stderr || complain "$name: $? $(cat stderr)"
    [[ -s out-$name/000000.exr ]] || complain "$name: no sample"
done
refuses 1 'node 1 has two parents' bounded "${render[@]}" --mesh shared_nodes.gltf -o out
refuses 1 'levels deep' bounded "${render[@]}" --mesh deep_json.gltf -o out
refuses 1 'a sparse accessor replaces more than there is' bounded "${render[@]}" --mesh huge_sparse.gltf -o out
refuses 1 'pipe is not a plain file' bounded "${render[@]}" --mesh pipe_uri.gltf -o out
refuses 1 'not a plain file' bounded "${render[@]}" --mesh pipe -o out

finish
