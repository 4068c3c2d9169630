#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# merlin-lab eval: the whole way once with a tiny model, and one line for each kind of bad input.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/../../cli/support/check.bash"
train_tiny_model
make_bad_weights
weights=$scratch/weights.safetensors samples=$scratch/samples

succeeds "means over 4 samples" "$MERLIN_LAB" eval --means "$samples" -o "$scratch/means.exr"
succeeds "^albedo error" "$MERLIN_LAB" eval --data "$samples" --model "$weights" --quiet --means-file "$scratch/means.exr" \
    --figure "$scratch/sheet.png" --figure-rows 2
[[ -s $scratch/sheet.png ]] || complain "no figure"
succeeds "as merlin estimate and merlin relight have it" "$MERLIN_LAB" eval --data "$samples" --model "$weights" --quiet --count 1
succeeds "^relit by network" "$MERLIN_LAB" eval --raw --data "$samples" --model "$weights" --quiet --means-file "$scratch/means.exr"
succeeds "the network alone" "$MERLIN_LAB" eval --raw --data "$samples" --model "$weights" --quiet --count 1 --precision bfloat16
! "$MERLIN_LAB" eval --data "$samples" --model "$weights" --quiet --count 1 | grep -q "^relit by network" || complain "a row of the network alone is told of the product"
succeeds "favours that answer" "$MERLIN_LAB" eval --data "$samples" --model "$weights" --quiet --count 1
succeeds "environments: the first 2 samples" "$MERLIN_LAB" eval --data "$samples" --model "$weights" --quiet --environments 2
succeeds "saturate at radiance 1.5" "$MERLIN_LAB" eval --data "$samples" --model "$weights" --quiet --count 1 --white 1.5
succeeds "the true normal is given" "$MERLIN_LAB" eval --data "$samples" --model "$weights" --quiet --count 1 --raw --given depth --given normal
succeeds "^normal error .1e-2.  *0.0000" "$MERLIN_LAB" eval --data "$samples" --model "$weights" --quiet --count 1 --raw --given normal
options=(--data "$samples" --model "$weights" --environments 1 --quiet --json)
OMP_NUM_THREADS=1 "$MERLIN_LAB" eval "${options[@]}" >"$scratch/a.json"
OMP_NUM_THREADS=2 "$MERLIN_LAB" eval "${options[@]}" >"$scratch/b.json"
cmp -s "$scratch/a.json" "$scratch/b.json" || complain "results depend on the number of threads"
grep -q '"raw":.*false' "$scratch/a.json" || complain "the JSON report does not say what was measured"
"$MERLIN_LAB" eval "${options[@]}" --raw >"$scratch/c.json"
grep -q '"raw":.*true' "$scratch/c.json" || complain "the JSON report does not say that the network alone was measured"

refuses 2 "--data DIR is missing" "$MERLIN_LAB" eval --model "$weights"
refuses 2 "--model W is missing" "$MERLIN_LAB" eval --data "$samples"
refuses 2 "--means needs -o" "$MERLIN_LAB" eval --means "$samples"
refuses 2 "--means goes with" "$MERLIN_LAB" eval --means "$samples" -o "$scratch/other.exr" --data "$samples" --model "$weights"
refuses 2 "--means goes with" "$MERLIN_LAB" eval --means "$samples" -o "$scratch/other.exr" --json
refuses 2 "--means goes with" "$MERLIN_LAB" eval --means "$samples" -o "$scratch/other.exr" --precision bfloat16
refuses 2 "taken for a sample" "$MERLIN_LAB" eval --means "$samples" -o "$samples/means.exr"
refuses 2 "taken for a sample" env -C "$samples" "$MERLIN_LAB" eval --means . -o 000001.exr
refuses 2 "end in .exr" "$MERLIN_LAB" eval --means "$samples" -o "$scratch/other.png"
refuses 2 "-o is for --means" "$MERLIN_LAB" eval --data "$samples" --model "$weights" -o "$scratch/other.json"
refuses 2 "--count wants" "$MERLIN_LAB" eval --data "$samples" --model "$weights" --count 0
refuses 2 "--count wants" "$MERLIN_LAB" eval --data "$samples" --model "$weights" --count 3x
refuses 2 "--white wants" "$MERLIN_LAB" eval --data "$samples" --model "$weights" --white 0.5
refuses 2 "--given goes with --raw" "$MERLIN_LAB" eval --data "$samples" --model "$weights" --given normal
refuses 2 "--precision goes with --raw" "$MERLIN_LAB" eval --data "$samples" --model "$weights" --precision bfloat16
refuses 2 "--means goes with" "$MERLIN_LAB" eval --means "$samples" -o "$scratch/other.exr" --raw
refuses 2 "--given wants" "$MERLIN_LAB" eval --data "$samples" --model "$weights" --given light
refuses 2 "--environments wants" "$MERLIN_LAB" eval --data "$samples" --model "$weights" --environments none
refuses 2 "end in .png" "$MERLIN_LAB" eval --data "$samples" --model "$weights" --figure sheet.jpg
refuses 2 "--precision wants" "$MERLIN_LAB" eval --data "$samples" --model "$weights" --precision float16
refuses 2 "wants a value" "$MERLIN_LAB" eval --data
refuses 2 "unexpected argument" "$MERLIN_LAB" eval --data "$samples" --model "$weights" more
refuses 1 "cannot open the folder" "$MERLIN_LAB" eval --data "$scratch/missing" --model "$weights" --quiet
mkdir "$scratch/empty"
refuses 1 "holds no samples" "$MERLIN_LAB" eval --data "$scratch/empty" --model "$weights" --quiet
refuses 1 "holds no samples" "$MERLIN_LAB" eval --means "$scratch/empty" -o "$scratch/none.exr" --quiet
[[ ! -e $scratch/none.exr ]] || complain "a file was left behind"
for bad in missing empty truncated stub text altered; do
    refuses 1 "$bad.safetensors" "$MERLIN_LAB" eval --data "$samples" --model "$scratch/$bad.safetensors" --quiet
done
refuses 1 "means" "$MERLIN_LAB" eval --data "$samples" --model "$weights" --means-file "$samples/000000.exr" --quiet
refuses 1 "missing.exr" "$MERLIN_LAB" eval --data "$samples" --model "$weights" --means-file "$scratch/missing.exr" --quiet
refuses 1 "nowhere" "$MERLIN_LAB" eval --data "$samples" --model "$weights" --figure "$scratch/nowhere/f.png" --quiet
refuses 1 "nowhere" "$MERLIN_LAB" eval --means "$samples" -o "$scratch/nowhere/means.exr" --quiet

mkdir "$scratch/damaged"
cp "$samples"/*.exr "$scratch/damaged"
head -c 3000 "$samples/000002.exr" >"$scratch/damaged/000002.exr"
refuses 1 "000002.exr" "$MERLIN_LAB" eval --data "$scratch/damaged" --model "$weights" --quiet
echo "not an image" >"$scratch/damaged/000002.exr"
refuses 1 "000002.exr" "$MERLIN_LAB" eval --data "$scratch/damaged" --model "$weights" --quiet
"$MERLIN_LAB" render --count 1 --size 72 --spp 1 --paths 1 --no-env --quiet -o "$scratch/odd" >/dev/null
succeeds "of 72x72" "$MERLIN_LAB" eval --data "$scratch/odd" --model "$weights" --quiet
refuses 1 "multiple of 32" "$MERLIN_LAB" eval --raw --data "$scratch/odd" --model "$weights" --quiet
"$MERLIN_LAB" render --count 1 --size 64 --spp 1 --paths 1 --off-axis 30 --fov 30 --no-env --quiet -o "$scratch/aside" >/dev/null
succeeds "on 1 samples" "$MERLIN_LAB" eval --data "$scratch/aside" --model "$weights" --quiet
refuses 1 "without --raw" "$MERLIN_LAB" eval --raw --data "$scratch/aside" --model "$weights" --quiet
finish
