#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# merlin itself: help, version, and what is no command.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/support/check.bash"

succeeds "commands:" "$MERLIN" --help
succeeds "^merlin [0-9]" "$MERLIN" --version
succeeds "^merlin [0-9]" "$MERLIN" -V
refuses 2 'no command "estimat"' "$MERLIN" estimat photo.png
refuses 2 'no command "esitmate": did you mean estimate? (try' "$MERLIN" esitmate photo.png
refuses 2 'no command "realight": did you mean relight?' "$MERLIN" help realight
refuses 2 'no option "--verson": did you mean --version?' "$MERLIN" --verson
refuses 2 'no command "quux" (try' "$MERLIN" quux
refuses 2 "for a photograph, merlin estimate $scratch/cup.jpg" "$MERLIN" "$(touch "$scratch/cup.jpg" && echo "$scratch/cup.jpg")"
refuses 2 'no command "photo?.png"' "$MERLIN" $'photo\n.png'
for command in estimate relight view export stereo serve info; do
    succeeds "$command" "$MERLIN" --help
    succeeds "[Uu]sage: merlin $command" "$MERLIN" "$command" --help
    succeeds "[Uu]sage: merlin $command" "$MERLIN" help "$command"
    refuses 2 "$command: unknown option --no-such-option" "$MERLIN" "$command" --no-such-option
    refuses 2 "$command: unknown option -j " "$MERLIN" "$command" -jpg.png
    for count in 0 -1 1025 many 2x; do
        refuses 2 "$command: --threads wants a whole number from 1 to 1024, not \"$count\"" "$MERLIN" "$command" -t "$count"
    done
    succeeds "[Uu]sage: merlin $command" "$MERLIN" "$command" -q --threads 1 -h
    refuses 2 "$command: --help=me: this option takes no value" "$MERLIN" "$command" --help=me
done
refuses 2 "-o wants a value" "$MERLIN" estimate photo.png -o
succeeds "usage: merlin estimate" "$MERLIN" estimate --he
refuses 2 "--m is short for several options" "$MERLIN" estimate photo.png --m mask.png
refuses 2 "--li=0,0,0 is short for several options" "$MERLIN" relight photo.png --li=0,0,0
refuses 2 "--output is given twice" "$MERLIN" estimate photo.png -o one --output two
refuses 2 "--power is given twice for the same lamps" "$MERLIN" relight photo.png --light 0,0,0 --power 2 --power 4
refuses 1 "there is no photograph" "$MERLIN" relight no.png --power 2 --light 0,0,0 --power 4 --light 1,0,0 --json --json
refuses 2 "unknown option --lamp (try" "$MERLIN" relight photo.png --lamp
refuses 2 "unknown option --exposre=1: did you mean --exposure? (try" "$MERLIN" estimate photo.png --exposre=1
refuses 2 "unknown option --ligth: did you mean --light?" "$MERLIN" relight photo.png --ligth 0,0,0
refuses 2 'no command "estimat"' "$MERLIN" help estimat
succeeds "usage: merlin stereo calibrate " "$MERLIN" help stereo calibrate
for command in render train eval bench; do
    refuses 2 "merlin: $command is a command of another program: merlin-lab $command (try merlin --help)" "$MERLIN" $command --help
done
succeeds "usage: merlin estimate" "$MERLIN" help estimate photo.png

"$MERLIN" >"$scratch/stdout" 2>"$scratch/stderr"
[[ $? == 2 && ! -s $scratch/stdout ]] || complain "merlin alone should explain itself on standard error and exit with 2"
"$MERLIN" --help >/dev/full 2>"$scratch/stderr" && complain "a full disk should not pass unnoticed"
finish
