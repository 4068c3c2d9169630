#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# merlin-lab train of the network of near lights: it learns, goes on to the same bits after a stop, and wants targets.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/../../cli/support/check.bash"
cd "$scratch" || exit 1
config() { # PRESENTATIONS
    sed "s/PRESENTATIONS/$1/" <<'JSON'
{"model": {"name": "near", "nfps_width": 8},
 "training": {"size": 32, "batch": 8, "presentations": PRESENTATIONS, "learning_rate": 3e-3, "encoder_rate_scale": 1,
              "fewest_pictures": 2, "most_pictures": 4,
              "halve_every_epochs": 0, "warmup_steps": 1, "beta1": 0.9, "beta2": 0.999, "clip_norm": 1.0, "depth_weight": 1,
              "type": "f32", "seed": 1, "exposure_jitter": 0, "colour_jitter": 0, "memory_gib": 1,
              "validation_count": 8, "validation_steps": 0, "curve_steps": 10, "checkpoint_minutes": 5}}
JSON
}
config 480 >near.json
"$MERLIN_LAB" render --count 12 --size 64 --spp 1 --paths 1 --targets 3 --leds 3 --fov 30-60 --quiet -o near >/dev/null
train() { "$MERLIN_LAB" train "$@" --quiet; }
train near.json --data near -o one >/dev/null || complain "it does not train"
losses=$(sed -n '2p;$p' one/curves.csv | cut -d, -f5 | paste -sd' ')
read -r first last <<<"$losses"
awk -v a="$first" -v b="$last" 'BEGIN { exit !(b < 0.8 * a) }' || complain "it does not learn: $losses"
succeeds '^model  *near$' "$MERLIN" info one/weights.safetensors

# stopped and resumed
train near.json --data near -o two >/dev/null &
for _ in $(seq 100); do
    [[ -s two/curves.csv ]] && break
    sleep 0.05
done
kill -INT $!
wait $!
if [[ -e two/checkpoint.safetensors ]]; then
    train near.json --data near -o two --resume >/dev/null || complain "it does not go on"
    cmp -s one/weights.safetensors two/weights.safetensors || complain "a resumed run has other weights"
fi

# where samples lack what it wants
"$MERLIN_LAB" render --count 9 --size 64 --spp 1 --paths 1 --no-env --quiet -o plain >/dev/null
refuses 1 'without targets: render samples with --targets or --leds' train near.json --data plain -o three
"$MERLIN_LAB" render --count 9 --size 32 --spp 1 --paths 1 --targets 6 --no-env --quiet -o small >/dev/null
refuses 1 'wants 64×64' train near.json --data small -o three
"$MERLIN_LAB" render --count 9 --size 64 --spp 1 --paths 1 --targets 3 --no-env --quiet -o few >/dev/null
refuses 1 'has 3 targets, and 4 pictures were asked for' train near.json --data few -o four
finish
