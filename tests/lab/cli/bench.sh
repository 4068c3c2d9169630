#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# merlin-lab bench: one quick measurement as JSON, and one line for each kind of bad input.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/../../cli/support/check.bash"
train_tiny_model
make_bad_weights
export OMP_WAIT_POLICY=passive # other tests may run beside this one

if "$MERLIN_LAB" bench --quick --batch 2 --quiet --json --model "$scratch/weights.safetensors" >"$scratch/bench.json"; then
    for figure in copy_bytes_per_second peak_forward peak_training inference_256 seconds gflop_per_second planned_bytes \
        share_of_peak training_128 estimate_256 parts network write resident_bytes light_seconds stage_seconds samples_per_second rays_per_second; do
        grep -q -E "\"$figure\":[[:space:]]*([{]|[1-9]|0[.]0*[1-9])" "$scratch/bench.json" ||
            complain "the report has no $figure above zero"
    done
else
    complain "bench failed"
fi

if "$MERLIN_LAB" bench --layers --quick --batch 2 --quiet --model "$scratch/weights.safetensors" >"$scratch/layers.txt"; then
    for line in "^inference, 1 of 256x256, float32: [0-9.]+ ms in [0-9]+ steps, peak [0-9]+ GFLOP/s$" \
        "^training step, 2 of 128x128, float32: " \
        "^forward +conv2d +encoder.level0.a.conv +1x[0-9]+x[0-9]+x[0-9]+ +[0-9.]+ +[0-9.]+ % +[0-9.]+ +[0-9]+ +[0-9]+ % +[0-9.]+ +[0-9.]+$" \
        "^backward +conv2d +material.head "; do
        grep -q -E "$line" "$scratch/layers.txt" || complain "the layers have no line $line"
    done
    # the slowest first, within each run
    awk '/^(inference|training)/ {last = 1e9} /^(forward|refresh|backward)/ {if ($5 > last) exit 1; last = $5}' \
        "$scratch/layers.txt" || complain "the layers are not in the order of their times"
else
    complain "bench --layers failed"
fi
"$MERLIN_LAB" bench --layers --quick --batch 2 --quiet --json --model "$scratch/weights.safetensors" >"$scratch/layers.json" &&
    grep -q '"share_of_peak"' "$scratch/layers.json" && grep -q '"filtered":[[:space:]]*[0-9.e-]*[1-9]' "$scratch/layers.json" || complain "bench --layers has no JSON"

if "$MERLIN_LAB" bench --stereo --quick --quiet --json >"$scratch/stereo.json"; then
    mapfile -t working < <(grep -o '"working_bytes":[[:space:]]*[0-9]*' "$scratch/stereo.json" | grep -o '[0-9]*$')
    # a megapixel of results is 34 MB; 24 more pictures of 6 MB each must not show
    ((${#working[@]} == 3 && working[1] < working[0] + 4000000 && working[2] < working[0] + 4000000)) ||
        complain "memory grows with the number of pictures: ${working[*]}"
    grep -q '"bytes_per_second":[[:space:]]*[1-9]' "$scratch/stereo.json" || complain "no rate of photometric stereo"
else
    complain "bench --stereo failed"
fi
refuses 2 "goes without" "$MERLIN_LAB" bench --stereo --batch 4
refuses 2 "goes without" "$MERLIN_LAB" bench --stereo --layers
refuses 2 "--batch wants" "$MERLIN_LAB" bench --batch 0
refuses 2 "exclude each other" "$MERLIN_LAB" bench --model a --config b
refuses 2 "unexpected argument" "$MERLIN_LAB" bench more
TMPDIR=$scratch/missing refuses 1 "$scratch/missing/merlin-bench" "$MERLIN_LAB" bench --config "$scratch/tiny.json" --quiet
refuses 1 "missing.json" "$MERLIN_LAB" bench --config "$scratch/missing.json" --quiet
for bad in missing empty truncated altered; do
    refuses 1 "$bad.safetensors" "$MERLIN_LAB" bench --model "$scratch/$bad.safetensors" --quiet
done
finish
