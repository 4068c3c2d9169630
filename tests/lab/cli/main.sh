#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# merlin-lab itself: help, version, and what is no command.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/../../cli/support/check.bash"

succeeds "commands:" "$MERLIN_LAB" --help
succeeds "^merlin-lab [0-9]" "$MERLIN_LAB" --version
refuses 2 'merlin-lab: no command "rendre": did you mean render? (try merlin-lab --help)' "$MERLIN_LAB" rendre
refuses 2 "merlin-lab: estimate is a command of another program: merlin estimate " "$MERLIN_LAB" estimate photo.png
for command in render train eval bench; do
    succeeds "$command" "$MERLIN_LAB" --help
    succeeds "[Uu]sage: merlin-lab $command" "$MERLIN_LAB" "$command" --help
    succeeds "[Uu]sage: merlin-lab $command" "$MERLIN_LAB" help "$command"
    refuses 2 "merlin-lab $command: unknown option --no-such-option" "$MERLIN_LAB" "$command" --no-such-option
    refuses 2 "$command: unknown option -j " "$MERLIN_LAB" "$command" -jpg.png
    for count in 0 -1 1025 many 2x; do
        refuses 2 "$command: --threads wants a whole number from 1 to 1024, not \"$count\"" "$MERLIN_LAB" "$command" -t "$count"
    done
    succeeds "[Uu]sage: merlin-lab $command" "$MERLIN_LAB" "$command" -q --threads 1 -h
    refuses 2 "$command: --help=me: this option takes no value" "$MERLIN_LAB" "$command" --help=me
done
refuses 2 "--mesh is given twice" "$MERLIN_LAB" render --count 1 -o set --mesh a.obj --mesh b.obj
refuses 2 "unknown option --thread-count (try" "$MERLIN_LAB" bench --thread-count 1
for command in "eval stereo" "eval solvers" "eval detail" "eval photos"; do
    read -ra words <<<"$command"
    succeeds "usage: merlin-lab $command " "$MERLIN_LAB" help "${words[@]}"
done
"$MERLIN_LAB" --help >/dev/full 2>"$scratch/stderr" && complain "a full disk should not pass unnoticed"
finish
