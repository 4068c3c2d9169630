#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Lights with y down or in another order than the pictures leave normals 55 degrees off: one line says so and what would fit, and
# nothing is said of lights that do.
# shellcheck source=tests/cli/support/cases.bash
source "$(dirname "$0")/../support/cases.bash"
case_begin 06-lights-do-not-fit

# doubted WORDS: the last result has one line on standard error with these words, and the same in its JSON.
doubted() {
    [[ $(wc -l <"$scratch/stderr") == 1 ]] || complain "other than one line: $(cat "$scratch/stderr")"
    grep -q "$1" "$scratch/stderr" || complain "not \"$1\" but: $(cat "$scratch/stderr")"
    grep -q "\"warnings\":\[{\"code\":\"lights_do_not_fit\",\"message\":\"[^\"]*$1" "$scratch/stdout" ||
        complain "not in the JSON: $(cat "$scratch/stdout")"
}

succeeds '"warnings":\[\]' "$MERLIN" stereo . --lights right.txt -o right --json
[[ ! -s $scratch/stderr ]] || complain "of lights that fit: $(cat "$scratch/stderr")"
succeeds out "$MERLIN" stereo . --lights ydown.txt -o out --json
doubted 'they fit with y reversed'
grep -q '"lights_do_not_fit"' out/report.json || complain "nothing in report.json"
succeeds out2 "$MERLIN" stereo order -o out2 --json
doubted 'they fit in the alphabetical order'

finish
