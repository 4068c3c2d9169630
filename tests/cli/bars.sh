#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Long work shows on a terminal that it goes on, and leaves nothing of that behind; elsewhere there is none.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/support/check.bash"
# shellcheck source=tests/cli/support/pictures.bash
source "$(dirname "$0")/support/pictures.bash"
if ! command -v script >/dev/null; then
    echo "there is no script(1) to make a terminal: not tested"
    exit 77
fi
make_tiny_model
export OMP_WAIT_POLICY=passive MERLIN_MODEL=$scratch/weights.safetensors # other tests may run beside this one
export TERM=xterm
cd "$scratch" || exit 1

# The work is long on every machine, for it is halted for some seconds.
cat >halted <<'BASH'
#!/usr/bin/env bash
"$MERLIN" "$@" &
sleep 0.3
kill -STOP $!
sleep 2.5
kill -CONT $!
wait $!
BASH
chmod +x halted
erase=$'\r\033[K'

# on_terminal COMMAND...: what the command writes on a terminal, in `screen`.
on_terminal() {
    local status=0
    script -qec "$(printf '%q ' "$@")" /dev/null </dev/null >screen 2>&1 || status=$?
    return "$status"
}

has_bar() { grep -q '\[[#.]*\] *[0-9]* %  .* left' screen; }

# is_cleared: behind the last bar the line is empty before anything else is written.
is_cleared() {
    local all
    all=$(<screen)
    [[ ${all##* left} == $'\033[K'"$erase"* ]]
}

# shows_bar WORD COMMAND...: drawn with that word before it, cleared, and exit status 0.
shows_bar() {
    local word=$1
    shift
    on_terminal "$@" || complain "$* exited with $?: $(<screen)"
    has_bar || complain "$* has no bar: $(<screen)"
    grep -q "\($word \[\|%  $word\)" screen || complain "$* does not say that it is $word: $(<screen)"
    is_cleared || complain "$* leaves its bar: $(<screen)"
}

# shows_none COMMAND...
shows_none() {
    on_terminal "$@" || complain "$* exited with $?: $(<screen)"
    has_bar && complain "$* has a bar: $(<screen)"
    grep -q $'\033' screen && complain "$* moves the cursor: $(<screen)"
}

radiance disc.hdr 256 100
"$MERLIN" estimate disc.hdr --size 64 -q || complain "no maps"

echo "stereo"
"$MERLIN" relight disc.merlin --dome 12 --near -o dome -q || complain "no dome"
near=(stereo dome --near --distance 1.3 --fov 60 -o out)
shows_bar '\(reading\|solving\|integrating\)' ./halted "${near[@]}"
shows_none ./halted "${near[@]}" -q
TERM=dumb shows_none ./halted "${near[@]}"
./halted "${near[@]}" >stdout 2>stderr || complain "stereo exited with $?: $(<stderr)"
grep -v ": the pictures fit these lights " stderr >more && complain "beside a terminal stereo says: $(<more)" # an untrained model's maps are odd
cp out/maps.exr alone.exr
on_terminal ./halted "${near[@]}"
cmp -s alone.exr out/maps.exr || complain "a bar changes the surface"

echo "an interrupt takes the bar away"
: >screen # the last one has a bar
script -qec 'echo $$ >pid; exec "$MERLIN" relight disc.merlin --orbit 240 --frame 1024 -o long' /dev/null </dev/null >screen 2>&1 &
for _ in {1..600}; do
    has_bar && break
    sleep 0.1
done
kill -INT "$(<pid)"
wait $! && complain "an interrupted command exits with 0"
is_cleared || complain "an interrupt leaves the bar: $(<screen)"
grep -q 'K.*merlin relight: interrupted' screen || complain "an interrupt is not told: $(<screen)"
absent long

echo "a refused picture's line is beside no bar"
head -c 2000 dome/dome_011.png >broken && mv broken dome/dome_011.png
on_terminal ./halted "${near[@]}" && complain "a broken picture was taken"
grep -q '^merlin stereo: ' <(tr '\r' '\n' <screen | sed 's/^\x1b\[K//') || complain "said: $(<screen)"
has_bar && ! is_cleared && complain "a failure leaves the bar: $(<screen)"

sanitized && finish # one command has been seen to draw, to be interrupted and to fail

echo "estimate"
photo=(estimate "$MERLIN_SOURCE_DIR/examples/demo.png" --model merlin-point -o photo)
shows_bar '\(reading\|estimating\|refining\|writing\)' ./halted "${photo[@]}"
shows_none ./halted "${photo[@]}" -q
./halted "${photo[@]}" >stdout 2>stderr || complain "estimate exited with $?: $(<stderr)"
[ -s stderr ] && complain "beside a terminal estimate says: $(<stderr)"
mkdir box
for i in {1..3}; do cp disc.hdr "box/$i.hdr"; done
shows_bar '[1-3]/3' ./halted estimate box -o boxes
for i in {1..3}; do # each photograph's line stands alone
    grep -q "^box/$i.hdr: boxes/$i/overview.png" <(sed 's/.*\x1b\[K//' screen) || complain "$i: $(<screen)"
done

echo "relight"
orbit=(relight disc.merlin --orbit 40 --frame 128 -o orbit)
shows_bar '\(preparing\|going round\|animating\)' ./halted "${orbit[@]}"
shows_none ./halted "${orbit[@]}" -q
./halted "${orbit[@]}" >stdout 2>stderr || complain "relight exited with $?: $(<stderr)"
[ -s stderr ] && complain "beside a terminal relight says: $(<stderr)"

echo "what is soon done has none"
shows_none "$MERLIN" relight disc.merlin --light 0.5,0.2,-0.4 -o soon

finish
