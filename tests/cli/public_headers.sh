#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Each public header compiles alone, as C and as C++, whatever else a program includes, and none sees the inside.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/support/check.bash"
include=$MERLIN_SOURCE_DIR/include

compiles() {
    local language=$1 standard=$2 compiler=$3 header=$4
    printf '#include <merlin/%s>\n#include <merlin/%s>\nint main(void) { return 0; }\n' "$header" "$header" |
        "$compiler" -x "$language" -std="$standard" -Wall -Wextra -Wpedantic -Werror -fsyntax-only -I"$include" - \
            >compiled.log 2>&1 || complain "$header is no $standard: $(head -n 3 compiled.log)"
}

cd "$scratch" || exit 1
for path in "$include"/merlin/*.h; do
    header=${path##*/}
    echo "$header compiles alone"
    compiles c c99 cc "$header"
    if command -v c++ >/dev/null; then compiles c++ c++11 c++ "$header"; fi
    grep -qF "#include <merlin/$header>" "$include/merlin/merlin.h" || [[ $header == merlin.h ]] ||
        complain "merlin.h does not include $header"
done

finish
