#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# On a grey table the dark disc inside a mirror ball, where the room is mirrored, is not the ball.
# shellcheck source=tests/cli/support/cases.bash
source "$(dirname "$0")/../support/cases.bash"
case_begin 03-chrome-ball-inner-disc

succeeds '"warnings":\[\]' "$MERLIN" stereo calibrate --sphere chrome . -o out --json
grep -qE '"circle":\[(119|120)\.[0-9]+,(479|480)\.[0-9]+,(44|45)\.[0-9]+\]' "$scratch/stdout" ||
    complain "not the ball at 120, 480 of radius 45: $(cat "$scratch/stdout")"
# the cosine of two degrees
paste -d' ' <(grep -v '^#' out/lights.txt) truth/lights.txt |
    awk '{ if ($1 * $4 + $2 * $5 + $3 * $6 < 0.99939) bad++ } END { exit NR != 10 || bad > 0 }' ||
    complain "lights are more than two degrees off: $(cat out/lights.txt)"

finish
