#!/usr/bin/env bash
# Lack of memory and of threads is one line, and what a killed command leaves the next one removes.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/support/check.bash"
make_tiny_model
photo=$(dirname "$0")/../../examples/demo.png

# with MEGABYTES COMMAND...: or what sanitizers need, which is more than there is
if ldd "$MERLIN" 2>/dev/null | grep -q 'lib[at]san'; then
    echo "skipped: sanitizers take all addresses" >&2
else
    with() { (ulimit -v $((1000 * $1)) && shift && "$@"); }
    # oneDNN crashed at 200 to 300 MB, and GLib ended the program at 420
    for limit in 160 200 300; do
        refuses 1 "no memory" with $limit "$MERLIN" train "$scratch/tiny.json" --data "$scratch/samples" -o "$scratch/lack-$limit" --quiet
    done
    # the weights' header was said to be no JSON
    for limit in 150 160 170; do
        refuses 1 "no memory\|annot allocate memory" with $limit "$MERLIN" estimate "$photo" -o "$scratch/lack" --quiet
    done
    refuses 1 "no memory" with 300 "$MERLIN" estimate "$photo" --size 256 -o "$scratch/lack" --quiet
    [[ ! -e $scratch/lack ]] || complain "an estimate without memory left a folder"
fi

# what libgomp says of values that it does not know is its own matter
for threads in 100000 0 many; do
    OMP_NUM_THREADS=$threads "$MERLIN" render --count 1 --size 64 --spp 1 --paths 1 --no-env --quiet -o "$scratch/render-$threads" \
        >/dev/null 2>&1 || complain "OMP_NUM_THREADS=$threads ended in $?"
done

# root has as many processes as it likes; another who has none may still run, with one thread or not at all
if ((EUID == 0)) && chmod 777 "$scratch" && setpriv --reuid 65533 --regid 65533 --clear-groups "$MERLIN" --version >/dev/null 2>&1; then
    few() { setpriv --reuid 65533 --regid 65533 --clear-groups bash -c 'ulimit -u "$0" && exec "$@"' "$@"; }
    # a search for leaks wants a thread of its own, too
    export ASAN_OPTIONS=detect_leaks=0
    refuses 1 "no thread" few 1 "$MERLIN" render --count 1 --size 64 --spp 1 --paths 1 --no-env --quiet -o "$scratch/few"
    succeeds "" few 2 "$MERLIN" render --count 1 --size 64 --spp 1 --paths 1 --no-env -o "$scratch/few"
fi

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
