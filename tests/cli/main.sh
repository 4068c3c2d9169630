#!/usr/bin/env bash
# merlin itself: help, version, and what is no command.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/support/check.bash"

succeeds "commands:" "$MERLIN" --help
succeeds "^merlin [0-9]" "$MERLIN" --version
refuses 2 'no command "estimat"' "$MERLIN" estimat photo.png
for command in estimate relight render train eval bench info; do
    succeeds "$command" "$MERLIN" --help
    succeeds "[Uu]sage: merlin $command" "$MERLIN" "$command" --help
    refuses 2 "$command" "$MERLIN" "$command" --no-such-option
done
"$MERLIN" >"$scratch/stdout" 2>"$scratch/stderr"
[[ $? == 2 && ! -s $scratch/stdout ]] || complain "merlin alone should explain itself on standard error and exit with 2"
"$MERLIN" --help >/dev/full 2>"$scratch/stderr" && complain "a full disk should not pass unnoticed"
finish
