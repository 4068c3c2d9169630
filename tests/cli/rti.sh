#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# merlin relight --rti from outside: what viewers would show of it (rti_render) against pictures under the same lights,
# which the dome had no lamps at; and how it refuses.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/support/check.bash"
# shellcheck source=tests/cli/support/pictures.bash
source "$(dirname "$0")/support/pictures.bash"
make_tiny_model
export OMP_WAIT_POLICY=passive MERLIN_MODEL=$scratch/weights.safetensors # other tests may run beside this one
cd "$scratch" || exit 1
relight() { "$MERLIN" relight "$@"; }

radiance disc.hdr 64 22
succeeds disc.merlin "$MERLIN" estimate disc.hdr --size 64

# The bounds, in per cent of white, are what each basis cannot follow of the shadows on a tiny model's rough ground.
looks_alike() {
    local from=$1 bound=$2 light
    for light in '0.5 0.3 0.9' '-0.4 0.5 0.6' '0.1 -0.7 0.5'; do
        succeeds single relight disc.merlin --direction "${light// /,}" --exposure 0 -o single
        # shellcheck disable=SC2086 # three numbers
        "$RTI_RENDER" "$from" $light seen.png || complain "$from is not read"
        local mean
        mean=$("$PICTURES_DIFFER" single/relit.png seen.png | awk '{ print $1 }')
        awk -v mean="$mean" -v bound="$bound" 'BEGIN { exit !(mean <= bound) }' ||
            complain "$from under $light is off by $mean %, more than $bound %"
    done
}

echo "a dome becomes a picture that viewers relight"
while read -r kind planes bound; do
    succeeds "\"rti\":\"$kind\"" relight disc.merlin --dome 40 --rti "$kind" --exposure 0 -o "$kind" --json
    # shellcheck disable=SC2046 # names
    lists_its_files "$kind" info.json $(seq -f 'plane_%g.jpg' 0 $((planes / 3 - 1)))
    looks_alike "$kind" "$bound"
done <<'END'
ptm 18 13
lrgb 9 13
hsh 27 9
rbf 18 8
END
succeeds disc.merlin/rti relight disc.merlin --dome 9 --rti hsh
present disc.merlin/rti/info.json disc.merlin/rti/plane_8.jpg
absent disc.merlin/rti/dome_000.png

echo "planes of an earlier one with more are removed, and nothing else"
touch disc.merlin/rti/plane_10.jpg disc.merlin/rti/mine.jpg
succeeds disc.merlin/rti relight disc.merlin --dome 9 --rti lrgb
present disc.merlin/rti/plane_2.jpg
absent disc.merlin/rti/plane_{3..8}.jpg
[ -e disc.merlin/rti/plane_10.jpg ] && [ -e disc.merlin/rti/mine.jpg ] || complain "others' files went: $(ls disc.merlin/rti)"

echo "and a file for RTIViewer"
for kind in ptm lrgb; do
    succeeds "$kind.ptm" relight disc.merlin --dome 40 --rti $kind --exposure 0 -o $kind.ptm
    looks_alike $kind.ptm 13
done
[ "$(head -2 lrgb.ptm | tail -1)" = PTM_FORMAT_LRGB ] || complain "lrgb.ptm begins $(head -2 lrgb.ptm)"

echo "what cannot be is refused"
refuses 2 'of a --dome' relight disc.merlin --light 0,0,0 --rti ptm
refuses 2 'wants ptm, lrgb, hsh or rbf' relight disc.merlin --dome 9 --rti xyz
refuses 2 '9 pictures or more' relight disc.merlin --dome 8 --rti hsh
refuses 2 '300 pictures or fewer' relight disc.merlin --dome 301 --rti rbf
refuses 2 'leave out' relight disc.merlin --dome 9 --rti hsh --lp
refuses 2 'leave out' relight disc.merlin --dome 9 --rti hsh --format png
refuses 2 'leave out' relight disc.merlin --dome 9 --rti hsh --light 0,0,0
refuses 2 'give --rti ptm or lrgb' relight disc.merlin --dome 9 --rti hsh -o hsh.ptm
refuses 2 'wide.ptm is a file of --rti' relight disc.merlin --dome 9 -o wide.ptm
refuses 2 'wide.ptm is a file of --rti' relight disc.merlin --light 0,0,0 -o wide.ptm
absent hsh.ptm wide.ptm

finish
