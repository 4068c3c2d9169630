#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Lack of memory and of threads is one line in training and rendering, too.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/../../cli/support/check.bash"
train_tiny_model

# with MEGABYTES COMMAND...: or what sanitizers need, which is more than there is
if sanitized; then
    echo "skipped: sanitizers take all addresses" >&2
else
    with() { (ulimit -v $((1000 * $1)) && shift && "$@"); }
    # oneDNN crashed at 200 to 300 MB, and GLib ended the program at 420
    for limit in 160 200; do
        refuses 1 "no memory" with $limit "$MERLIN_LAB" train "$scratch/tiny.json" --data "$scratch/samples" -o "$scratch/lack-$limit" --quiet
    done
    # that is enough on some processors, though perhaps not for a chart
    with 300 "$MERLIN_LAB" train "$scratch/tiny.json" --data "$scratch/samples" -o "$scratch/lack-300" --quiet 2>"$scratch/stderr" ||
        { [[ $? == 1 ]] && grep -q "no memory" "$scratch/stderr"; } || complain "with 300 MB training ended otherwise: $(cat "$scratch/stderr")"
fi

# what libgomp says of values that it does not know is its own matter
for threads in 100000 0 many; do
    OMP_NUM_THREADS=$threads "$MERLIN_LAB" render --count 1 --size 64 --spp 1 --paths 1 --no-env --quiet -o "$scratch/render-$threads" \
        >/dev/null 2>&1 || complain "OMP_NUM_THREADS=$threads ended in $?"
done

# root has as many processes as it likes; another who has none may still run, with one thread or not at all
if ((EUID == 0)) && chmod 777 "$scratch" && setpriv --reuid 65533 --regid 65533 --clear-groups "$MERLIN_LAB" --version >/dev/null 2>&1; then
    few() { setpriv --reuid 65533 --regid 65533 --clear-groups bash -c 'ulimit -u "$0" && exec "$@"' "$@"; }
    # a search for leaks wants a thread of its own, too
    export ASAN_OPTIONS=detect_leaks=0
    refuses 1 "no thread" few 1 "$MERLIN_LAB" render --count 1 --size 64 --spp 1 --paths 1 --no-env --quiet -o "$scratch/few"
    succeeds "" few 2 "$MERLIN_LAB" render --count 1 --size 64 --spp 1 --paths 1 --no-env -o "$scratch/few"
fi

finish
