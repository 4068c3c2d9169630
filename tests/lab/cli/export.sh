#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# merlin-lab export: what it writes is valid ONNX by another's check (Debian's python3-onnx), of any size and of one; and one
# line for each kind of bad input. That ONNX Runtime computes the same is what tools/compare-onnxruntime shows.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/../../cli/support/check.bash"
train_tiny_model
make_bad_weights

succeeds "maps.onnx" "$MERLIN_LAB" export "$scratch/weights.safetensors" -o "$scratch/any"
succeeds "$scratch/fixed/relight.onnx" "$MERLIN_LAB" export --onnx "$scratch/weights.safetensors" --size 96 --json -o "$scratch/fixed"
for file in maps.onnx bounces.onnx relight.onnx networks.json; do
    [[ -s $scratch/any/$file ]] || complain "export wrote no $file"
done
# The weights are in it once, as half floats: bytes beside those of the weights file are the graph's.
((100 * $(cat "$scratch/any"/*.onnx | wc -c) < 130 * $(stat -c %s "$scratch/weights.safetensors"))) ||
    complain "the networks are more than 1.3 times as large as their weights"
"$MERLIN_LAB" export "$scratch/weights.safetensors" -q -o "$scratch/again" >"$scratch/quiet" && [[ ! -s $scratch/quiet ]] ||
    complain "export -q says something"
for file in maps bounces relight; do
    cmp -s "$scratch/any/$file.onnx" "$scratch/again/$file.onnx" || complain "$file.onnx differs from run to run"
done

if /usr/bin/python3 -c 'import onnx' 2>/dev/null; then
    /usr/bin/python3 "$(dirname "$0")/check_onnx.py" "$scratch/any" "batch,height,width" &&
        /usr/bin/python3 "$(dirname "$0")/check_onnx.py" "$scratch/fixed" "1,96,96" || complain "not valid as ONNX"
else
    echo "python3-onnx is missing: whether the networks are valid ONNX was not checked"
fi

# Another model without a decoder takes that of the earlier one away, by its list; and nothing else.
cp "$scratch/any/relight.onnx" "$scratch/any/mine.onnx"
succeeds "maps.onnx" "$MERLIN_LAB" export merlin-any -o "$scratch/any"
[[ ! -e $scratch/any/relight.onnx && -s $scratch/any/mine.onnx ]] || complain "another model's networks: $(ls "$scratch/any")"
mkdir "$scratch/foreign" && echo mine >"$scratch/foreign/relight.onnx"
succeeds "maps.onnx" "$MERLIN_LAB" export merlin-any -o "$scratch/foreign"
[[ $(cat "$scratch/foreign/relight.onnx") == mine ]] || complain "a file that no list names was removed"

refuses 2 "no folder to write" "$MERLIN_LAB" export "$scratch/weights.safetensors"
refuses 2 "not a multiple of 32" "$MERLIN_LAB" export "$scratch/weights.safetensors" --size 100 -o "$scratch/no"
refuses 2 "--size wants" "$MERLIN_LAB" export "$scratch/weights.safetensors" --size 1024 -o "$scratch/no"
refuses 2 "unexpected argument" "$MERLIN_LAB" export "$scratch/weights.safetensors" more -o "$scratch/no"
for bad in missing empty truncated stub text altered; do
    refuses 1 "$bad.safetensors" "$MERLIN_LAB" export "$scratch/$bad.safetensors" -o "$scratch/no"
done
[[ ! -e $scratch/no ]] || complain "a refused export left a folder"
echo old >"$scratch/file"
refuses 1 "file" "$MERLIN_LAB" export "$scratch/weights.safetensors" -o "$scratch/file"
finish
