#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Lack of memory is one line, odd numbers of threads are no matter, and what a killed command leaves the next one removes.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/support/check.bash"
make_tiny_model
photo=$(dirname "$0")/../../examples/demo.png

# with MEGABYTES COMMAND...: or what sanitizers need, which is more than there is
if sanitized; then
    echo "skipped: sanitizers take all addresses" >&2
else
    with() { (ulimit -v $((1000 * $1)) && shift && "$@"); }
    # the weights' header was said to be no JSON
    for limit in 150 160 170; do
        refuses 1 "no memory\|annot allocate memory" with $limit "$MERLIN" estimate "$photo" -o "$scratch/lack" --quiet
    done
    refuses 1 "no memory" with 300 "$MERLIN" estimate "$photo" --size 256 -o "$scratch/lack" --quiet
    [[ ! -e $scratch/lack ]] || complain "an estimate without memory left a folder"
fi

# what libgomp says of values that it does not know is its own matter
for threads in 100000 0 many; do
    OMP_NUM_THREADS=$threads "$MERLIN" estimate "$photo" --model "$scratch/weights.safetensors" --size 64 -o "$scratch/maps-$threads" --quiet \
        >/dev/null 2>&1 || complain "OMP_NUM_THREADS=$threads ended in $?"
done

# killed while it writes
hidden() { find "$1" -maxdepth 1 -name '.*-*' 2>/dev/null | wc -l; }
"$MERLIN" estimate "$photo" --model "$scratch/weights.safetensors" --size 64 -o "$scratch/maps" --quiet
"$MERLIN" relight "$scratch/maps" --orbit 240 -o "$scratch/orbit" --quiet &
for ((i = 0; i < 500; i++)); do
    (($(hidden "$scratch/orbit") > 0)) && break
    sleep 0.01
done
kill -KILL $!
wait $! 2>/dev/null
(($(hidden "$scratch/orbit") > 0)) || complain "the killed command left nothing: it was killed too late"
"$MERLIN" relight "$scratch/maps" --light 1,1,0 -o "$scratch/orbit" --quiet || complain "nothing can be written where a command was killed"
(($(hidden "$scratch/orbit") == 0)) || complain "what a killed command left is still there: $(ls -A "$scratch/orbit")"
finish
