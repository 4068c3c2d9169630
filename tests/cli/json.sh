#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Every name that a report has stands in docs/json.md.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/support/check.bash"
# shellcheck source=tests/cli/support/pictures.bash
source "$(dirname "$0")/support/pictures.bash"
make_tiny_model
export OMP_WAIT_POLICY=passive MERLIN_MODEL=$scratch/weights.safetensors
cd "$scratch" || exit 1
radiance disc.hdr 64 22
page=$MERLIN_SOURCE_DIR/docs/json.md

# listed NAME FILE: all of its keys are on the page, and the three of every report in it.
listed() {
    for key in version schema warnings; do
        grep -q "\"$key\":" "$2" || complain "$1 has no $key"
    done
    for key in $(grep -oE '"[A-Za-z_0-9]+":' "$2" | tr -d '":' | sort -u); do
        grep -qE "\`$key\`" "$page" || complain "$1: $key is not on the page"
    done
}

for command in "estimate disc.hdr --size 64" "relight disc.merlin --direction 0.3,0.2,1" \
    "relight disc.merlin --dome 8 --lp -o dome" "view disc.merlin" "stereo dome" "stereo disc.merlin -o views"; do
    # shellcheck disable=SC2086
    "$MERLIN" $command --json >report 2>stderr || complain "$command: $(cat stderr)"
    listed "$command" report
done
listed "estimate's report.json" disc.merlin/report.json
listed "stereo's report.json" dome/stereo/report.json
"$MERLIN" info weights.safetensors --json | tr -d '\n\t' | sed 's/"\(config\|training\)":{[^}]*}/"\1":0/g' >report
listed info report
if [[ -n ${MERLIN_LAB:-} ]]; then
    "$MERLIN_LAB" render --count 1 --size 64 --no-env -o one --json --quiet >report
    listed render report
fi

finish
