#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# make installs what is missing in silence, but for a bar on a terminal; apt is one of this script's own.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/support/check.bash"
if ! command -v script >/dev/null; then
    echo "there is no script(1) to make a terminal: not tested"
    exit 77
fi
export TERM=xterm SCRATCH=$scratch # commands run elsewhere
cd "$scratch" || exit 1
mkdir bin
PATH=$scratch/bin:$PATH
install_packages=$MERLIN_SOURCE_DIR/tools/install-packages

# stub NAME: a command, its text from standard input.
stub() {
    { echo '#!/bin/sh' && cat; } >"bin/$1"
    chmod +x "bin/$1"
}
echo 'exit 1' | stub dpkg-query # nothing is installed
echo 'shift; for p; do echo "$p | 1 | here"; done' | stub apt-cache
echo 'exec "$@"' | stub sudo
# Has a terminal's status lines only where they are asked for, and the other words of dpkg between them.
stub apt-get <<'SH'
echo "$*" >>"$SCRATCH/calls"
case "$*" in
*Status-Fd=1*update* | *update*Status-Fd=1*) echo 'dlstatus:3:50.0:Retrieving file 1 of 2' ;;
*Status-Fd=1*)
    echo 'dlstatus:1:25.0:Retrieving file 1 of 4'
    echo 'Selecting previously unselected package cmake.'
    echo 'pmstatus:cmake:amd64:50.0000:Unpacking cmake:amd64 (3.25)'
    ;;
esac
case "$*" in *install*) [ ! -e "$SCRATCH/broken" ] || { echo 'E: no more room' >&2; exit 100; } ;; esac
SH

on_terminal() { script -qec "$install_packages build" /dev/null </dev/null >screen 2>&1; }

echo "on a terminal a bar moves and is gone"
on_terminal || complain "exited with $?: $(<screen)"
for word in 'reading the lists of packages \[#' 'downloading packages .* 10 %' 'installing packages .* 70 %'; do
    grep -q "$word" screen || complain "no $word: $(<screen)"
done
all=$(<screen)
[[ ${all##* left} == $'\033[K\r\033[K' ]] || complain "the bar stays: $(<screen)"
grep -q 'install -y --no-install-recommends .*cmake' calls || complain "apt-get was called: $(<calls)"

echo "elsewhere nothing"
"$install_packages" build >stdout 2>stderr || complain "exited with $?: $(<stderr)"
[ -s stderr ] && complain "beside a terminal: $(<stderr)"
[ "$(wc -l <stdout)" -eq 1 ] || complain "beside a terminal: $(<stdout)"

echo "what apt refuses is told, and the status is apt's"
touch broken
status=0
on_terminal || status=$?
[ "$status" -eq 100 ] || complain "exited with $status"
all=$(<screen)
[[ ${all##* left} == $'\033[K\r\033[KE: no more room'* ]] || complain "said: $(<screen)"
"$install_packages" build >stdout 2>stderr && complain "beside a terminal a failure is none"
[ "$(<stderr)" = 'E: no more room' ] || complain "said: $(<stderr)"
finish
