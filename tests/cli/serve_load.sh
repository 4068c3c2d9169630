#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# merlin serve under many clients at once: nothing fails, and its memory stays flat. Short in the suite; the figures of
# docs/serve.md are of
#
#     MERLIN_LOAD=500 MERLIN_LOAD_CLIENTS=8 ctest --preset release -R cli_serve_load -V
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/support/check.bash"
# shellcheck source=tests/cli/support/server.bash
source "$(dirname "$0")/support/server.bash"
export OMP_WAIT_POLICY=passive # other tests may run beside this one
count=${MERLIN_LOAD:-16} clients=${MERLIN_LOAD_CLIENTS:-8}
demo=${MERLIN_SOURCE_DIR:?}/examples/demo.png
cd "$scratch" || exit 1
server_start --results 16 || exit 77

memory() { awk '/^VmRSS/ { print int($2 / 1024) }' "/proc/$server/status"; }

# one NUMBER: an upload, its answer, a file of it, and its removal; says what it did.
one() {
    local fields=(-F photo=@small.png -F size=64 -F views=1) kind=estimate file=maps.exr job state
    (($1 % 4)) || { kind=mask fields=(-F photo=@small.png) file=mask.png; }
    job=$(curl -s --max-time 600 "${fields[@]}" "$site/v1/$kind" | identifier)
    [[ -n $job ]] || { echo "failed: not taken"; return; }
    while state=$(told "$job" | grep -o '"state":"[a-z]*"') && [[ $state == *queued* || $state == *working* ]]; do sleep 0.3; done
    [[ $state == *done* ]] || { echo "failed: $state"; return; }
    curl -sf --max-time 600 -o "got$1" "$site/v1/jobs/$job/files/$file" && cmp -s "got$1" "own/$kind" || { echo "failed: $file of $kind"; return; }
    curl -sf --max-time 600 -X DELETE "$site/v1/jobs/$job" && echo done || echo "failed: removal"
    rm -f "got$1"
}

client() { for ((i = $1; i < count; i += clients)); do one "$i"; done; }

# What every answer is to be.
mkdir own
small=$(submit mask -F photo=@"$demo" -F side=128)
fetches "$small" photo.png small.png
"$MERLIN" estimate small.png --size 64 --views 1 -o own/maps -q && mv own/maps/maps.exr own/estimate
mask=$(submit mask -F photo=@small.png)
fetches "$mask" mask.png own/mask
for ((i = 0; i < 4; i++)); do one $((i + 1)) >/dev/null; done
waited=()
first=$(memory) began=$EPOCHREALTIME

for ((c = 0; c < clients; c++)); do client "$c" >"client$c" & waited+=($!); done
highest=$first
while kill -0 "${waited[@]}" 2>/dev/null; do
    now=$(memory)
    ((now > highest)) && highest=$now
    sleep 0.5
done
wait "${waited[@]}"
last=$(memory)
seconds=$(awk -v a="$began" -v b="$EPOCHREALTIME" 'BEGIN { printf "%.1f", b - a }')
echo "$clients clients, $count jobs in $seconds s; memory $first MB after the first, $highest MB at most, $last MB at the end"

cat client* | grep failed && complain "jobs failed"
(($(cat client* | grep -c '^done') == count)) || complain "$(cat client* | grep -c '^done') of $count jobs came to their end"
# sanitizers keep what is freed
sanitized || ((last <= first + first / 10 + 16)) || complain "memory grew from $first MB to $last MB"
server_end
finish
