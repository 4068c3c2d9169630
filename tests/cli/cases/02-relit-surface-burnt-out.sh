#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A captured surface is exposed so that nothing burns out: where a lamp is made stronger and it does, that is said.
# shellcheck source=tests/cli/support/cases.bash
source "$(dirname "$0")/../support/cases.bash"
case_begin 02-relit-surface-burnt-out

# not_burnt COMMAND...: at most one per cent of the object, and no word.
not_burnt() {
    succeeds '"warnings":\[\]' "$@" --json
    grep -Eq '"burnt_out":0(\.00[0-9]*)?,' "$scratch/stdout" || complain "$*: $(grep -Eo '"burnt_out":[^,]*' "$scratch/stdout")"
}

succeeds surface "$MERLIN" stereo . -o surface
not_burnt "$MERLIN" relight surface --light 0.7,0.3,-0.4 -o relit
not_burnt "$MERLIN" relight surface --light 0.2,0.3,-0.6 -o close
not_burnt "$MERLIN" relight surface --direction 0.7,0.3,0.6 -o afar
not_burnt "$MERLIN" relight surface --orbit 6 -o orbit
not_burnt "$MERLIN" relight surface --dome 20 --lp -o dome
succeeds flat "$MERLIN" stereo dome -o flat
normals_within 1 surface flat
succeeds '"code":"relit_burnt_out"' "$MERLIN" relight surface --light 0.7,0.3,-0.4 --power 8 -o strong --json
grep -q 'burnt out when relit' "$scratch/stderr" || complain "no word of what is burnt out: $(cat "$scratch/stderr")"
not_burnt "$MERLIN" relight surface --light 0.7,0.3,-0.4 --power 8 --exposure auto -o strong
finish
