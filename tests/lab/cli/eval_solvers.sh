#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# merlin-lab eval solvers: small objects hold the goals, two runs agree, and one line for each kind of bad input.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/../../cli/support/check.bash"
export OMP_WAIT_POLICY=passive
cd "$scratch" || exit 1
table() { "$MERLIN_LAB" eval solvers --quiet "$@"; }

succeeds '^mean' table --count 2 --size 64
figures() { grep '^mean\|^[01] ' stdout | awk '{ $0 = substr($0, 1, 61) substr($0, 71); print }'; } # all but the time
figures >first
goal_holds() { # goal_holds COLUMN GOAL
    awk -v c="$1" -v most="$2" '/^mean/ { exit !($c <= most) }' stdout || complain "column $1 is above $2: $(cat stdout)"
}
goal_holds 2 0.1
goal_holds 4 3.38
goal_holds 6 2
goal_holds 7 2
goal_holds 8 5
goal_holds 9 2
succeeds '^mean' env OMP_NUM_THREADS=1 "$MERLIN_LAB" eval solvers --quiet --count 2 --size 64
figures | diff - first || complain "one thread finds something else"
succeeds '"glossy_robust_degrees"' table --count 1 --size 48 --json
succeeds '^usage' table --help

refuses 2 'unexpected argument' table more
refuses 2 'unknown option' table --nonsense
refuses 2 '--count wants' table --count 0
refuses 2 '--size wants' table --size 8
finish
