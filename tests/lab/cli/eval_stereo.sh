#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# merlin-lab eval stereo: the table once with a tiny model, and one line for each kind of bad input.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/../../cli/support/check.bash"
train_tiny_model
export OMP_WAIT_POLICY=passive MERLIN_MODEL=$scratch/weights.safetensors
cd "$scratch" || exit 1
table() { "$MERLIN_LAB" eval stereo --quiet "$@"; }

"$MERLIN_LAB" render --count 2 --size 64 --spp 1 --paths 1 --targets 8 --no-env --quiet -o near >/dev/null
succeeds '^single image' table --data near --count 1 --figure sheet.png
[[ -s sheet.png ]] || complain "no figure"
grep -q '^  real images' stdout || complain "no row of real images: $(cat stdout)"
succeeds '"real_images_uncalibrated"' table --data near --count 1 --draws 1 --json
grep -q '"draws":[[:space:]]*1,' stdout || complain "not one draw: $(cat stdout)"
"$MERLIN_LAB" render --count 1 --size 64 --spp 1 --paths 1 --targets 0 --leds 8 --no-env --quiet -o leds >/dev/null
grep -qx 'leds 8' leds/render.txt || complain "no word of LEDs: $(cat leds/render.txt)"
grep -q '^leds' near/render.txt && complain "LEDs in a set without any"
succeeds '^  real images' table --data leds --draws 1
refuses 2 '"65"' "$MERLIN_LAB" render --count 1 --leds 65 -o none
refuses 2 '40 targets and 25 LEDs: at most 64 together' "$MERLIN_LAB" render --count 1 --targets 40 --leds 25 -o none
[[ -e none ]] && complain "a folder for refused options"
succeeds '^usage' table --help

# the network of near lights as a judge, and nowhere else
"$TINY_MODEL" nfps.safetensors nfps
succeeds '^nfps, lights known$' table --data near --count 1 --draws 1 --nfps nfps.safetensors --figure nfps.png
[[ -s nfps.png ]] || complain "no figure with nfps"
refuses 1 'is none for pictures under known lights' table --data near --nfps "$MERLIN_MODEL"
refuses 1 'is for pictures under known lights' table --data near --model nfps.safetensors
refuses 1 'is for pictures under known lights' "$MERLIN" estimate "$MERLIN_SOURCE_DIR/examples/demo.png" \
    --model nfps.safetensors -o out
refuses 2 'is for pictures under known lights' "$MERLIN_LAB" export nfps.safetensors -o onnx

refuses 2 'data DIR is missing' table
refuses 2 'unexpected argument' table --data near more
refuses 2 'unknown option' table --data near --nonsense
refuses 2 '--count wants' table --data near --count none
refuses 2 '--draws wants' table --data near --draws 6
refuses 1 'missing' table --data missing
mkdir empty
refuses 1 'holds no samples' table --data empty
refuses 1 '000000.exr.*--targets' table --data samples
refuses 1 'missing.safetensors' table --data near --model missing.safetensors
refuses 1 'nowhere' table --data near --count 1 --figure nowhere/sheet.png
mkdir cut
head -c 3000 near/000000.exr >cut/000000.exr
refuses 1 '000000.exr' table --data cut
mkdir -p luces/cup
echo "nothing of use" >luces/cup/led_params.txt
refuses 1 'luces/cup/led_params.txt' table --data luces
refuses 1 'cup/led_params.txt' table --data luces/cup
finish
