#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# merlin-lab eval table1 and table2: tables by untrained networks, and one line for each kind of bad input.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/../../cli/support/check.bash"
table() { "$MERLIN_LAB" eval "$@" --quiet; }
for name in table1-3 table1-9 sang several; do
    "$TINY_MODEL" "$scratch/$name.safetensors" $name
done
"$MERLIN_LAB" render --count 2 --size 64 --spp 1 --paths 1 --no-env --quiet -o "$scratch/samples" >/dev/null
samples=$scratch/samples

succeeds '^3  g 1 --  GA  net  -- .* 2 runs$' table table1 --data "$samples" "$scratch/table1-3.safetensors" \
    "$scratch/table1-9.safetensors" "$scratch/table1-3.safetensors"
succeeds '^   in the paper  *3.787  *8.267  *3.311  *0.975  *0.819  *0.894$' table table1 --data "$samples" \
    "$scratch/table1-9.safetensors"
succeeds '^Sang, Chandraker 2020 .* 21.64 *48.6$' table table2 --data "$samples" --count 1 "$scratch/sang.safetensors"
table table2 --data "$samples" "$scratch/table1-9.safetensors" "$scratch/sang.safetensors" --json >"$scratch/report.json"
grep -q '"table":2,"samples":2,"size":64,.*"table1-9":{"runs":1,.*"albedo":{"mean":.*"sang":{.*"relight_network_ssim":{' \
    "$scratch/report.json" || complain "the JSON report lacks something"
# alone, the same network has the same figures
"$MERLIN_LAB" eval --raw --views 1 --data "$samples" --model "$scratch/sang.safetensors" --quiet --json |
    tr -d "[:space:]" >"$scratch/alone.json"
for key in albedo depth relight_brdf_ssim; do
    one=$(grep -o "\"sang\":.*" "$scratch/report.json" | grep -o "\"$key\":{\"mean\":[^,}]*" | grep -o '[0-9.e-]*$')
    grep -q "\"$key\":{\"model\":$one" "$scratch/alone.json" || complain "$key is $one here and another alone"
done

refuses 2 "--data DIR is missing" table table1 "$scratch/table1-9.safetensors"
refuses 2 "name weights to measure" table table2 --data "$samples"
refuses 1 'model "sang" is none of table1-1 to table1-9' table table1 --data "$samples" "$scratch/sang.safetensors"
refuses 1 "is not for flash photographs" table table2 --data "$samples" "$scratch/several.safetensors"
refuses 1 "missing" table table2 --data "$samples" "$scratch/missing.safetensors"

# Table 3, relit by two (Sang's network would take a minute for 50 pictures)
"$MERLIN_LAB" render --count 1 --seed 52 --size 64 --targets 40 --spp 1 --paths 1 --no-env --quiet -o "$scratch/near" >/dev/null
table table3 --data "$scratch/near" --draws 1 "$scratch/table1-9.safetensors" "$scratch/table1-3.safetensors" --json |
    tr -d "[:space:]" >"$scratch/report.json"
grep -q '"table":3,"models":\[{"model":"table1-9","draws":1,.*"real_images":{"error_degrees":.*{"model":"table1-3",.*"relit_images":{' \
    "$scratch/report.json" || complain "the JSON report of Table 3 lacks something"
[ "$(grep -o '"real_images":{' "$scratch/report.json" | wc -l)" = 1 ] || complain "real pictures are solved for each weights"
refuses 2 "name weights to relight with" table table3 --data "$scratch/near"
refuses 2 '--method adds "universal"' table table3 --data "$scratch/near" --method near "$scratch/table1-9.safetensors"
finish
