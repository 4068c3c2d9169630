#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# merlin-lab eval pictures: the table once with a tiny model, and one line for each kind of bad input.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/../../cli/support/check.bash"
# shellcheck source=tests/cli/support/pictures.bash
source "$(dirname "$0")/../../cli/support/pictures.bash"
train_tiny_model
export OMP_WAIT_POLICY=passive MERLIN_MODEL=$scratch/weights.safetensors
cd "$scratch" || exit 1
pictures() { "$MERLIN_LAB" eval pictures --quiet "$@"; }

radiance disc.hdr 96 40
"$MERLIN" estimate disc.hdr --size 64 -q -o disc && "$MERLIN" relight disc --dome 5 --lp --matte -q -o dome ||
    complain "there is no capture"
succeeds '^dome  *stereo  *5 ' pictures dome
succeeds '^mean ' pictures dome dome --lights dome/dome.lp --linear
pictures dome --json >report.json
grep -q '"objects":\[{"name":"dome","true_normals":false,"frontal_degrees":.*"name":"dome_004.png","normal_angle_degrees":' \
    report.json || complain "the JSON report lacks something: $(cat report.json)"

refuses 2 'no capture given' pictures
refuses 2 'unknown option' pictures dome --nonsense
refuses 1 'missing' pictures missing
mkdir empty
refuses 1 'empty' pictures empty
refuses 1 'none.txt' pictures dome --lights none.txt
refuses 1 'missing.safetensors' pictures dome --model missing.safetensors
finish
