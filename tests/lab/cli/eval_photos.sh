#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# merlin-lab eval photos: one picture of several weights' answers, and one line for each kind of bad input.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/../../cli/support/check.bash"
# shellcheck source=tests/cli/support/pictures.bash
source "$(dirname "$0")/../../cli/support/pictures.bash"
train_tiny_model
export OMP_WAIT_POLICY=passive
cd "$scratch" || exit 1
photos() { "$MERLIN_LAB" eval photos "$@"; }
# width FILE: of a PNG, from its header
width() { od -An -j16 -N4 -tu1 "$1" | { read -r a b c d && echo $((((a * 256 + b) * 256 + c) * 256 + d)); }; }

mkdir folder
radiance folder/disc.hdr 64 22
radiance folder/other.hdr 64 18
succeeds '2 photographs by 1 weights' photos folder --model weights.safetensors -o one.png
succeeds 'by 2 weights' photos folder --model weights.safetensors --model weights.safetensors -o two.png
present one.png two.png
# 8 tiles against 15
(($(width two.png) > 18 * $(width one.png) / 10)) || complain "two weights' tiles are not side by side"
succeeds '^usage' photos --help

refuses 2 'no photograph' photos --model weights.safetensors -o none.png
refuses 2 'model W is missing' photos folder -o none.png
refuses 2 'FILE.png is missing' photos folder --model weights.safetensors
refuses 2 'at most 4' photos folder --model a --model b --model c --model d --model e -o none.png
refuses 2 'unknown option' photos folder --nonsense
refuses 2 'end in .png' photos folder --model weights.safetensors -o none.jpg
cp folder/disc.hdr kept.png
refuses 2 'one of the photographs' photos kept.png --model weights.safetensors -o ./kept.png
cmp -s kept.png folder/disc.hdr || complain "the photograph was replaced"
cp folder/disc.hdr painted.png
refuses 2 'one of the photographs or masks' photos folder/disc.hdr --mask painted.png --model weights.safetensors -o ./painted.png
refuses 1 'missing' photos missing --model weights.safetensors -o none.png --quiet
refuses 1 'missing.safetensors' photos --quiet folder --model missing.safetensors -o none.png
echo "not an image" >folder/worse.png
refuses 1 '^merlin-lab eval photos: cannot read folder/worse.png: ' photos folder --model weights.safetensors --model weights.safetensors -o rest.png --quiet
cmp -s rest.png two.png || complain "the others' rows are not those of a folder without the bad photograph"
rm folder/*.hdr
refuses 1 'worse.png' photos folder --model weights.safetensors -o none.png --quiet
radiance folder/disc.hdr 64 22
# before anything is taken apart, or worse.png would be told of
refuses 1 'no weights file missing.safetensors' photos folder --model weights.safetensors --model missing.safetensors -o none.png
refuses 1 'nowhere' photos --quiet folder/disc.hdr --model weights.safetensors -o nowhere/none.png
absent none.png
finish
