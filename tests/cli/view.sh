#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# merlin view from outside: what it writes, how it refuses, and what a browser makes of the page. Light in the page is held
# to merlin relight by pictures of both. Where Chromium is missing the test says so and is skipped.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/support/check.bash"
# shellcheck source=tests/cli/support/pictures.bash
source "$(dirname "$0")/support/pictures.bash"
# shellcheck source=tests/cli/support/browser.bash
source "$(dirname "$0")/support/browser.bash"
export OMP_WAIT_POLICY=passive # other tests may run beside this one
examples=${MERLIN_SOURCE_DIR:?}/examples hands=$(cat "$(dirname "$0")/support/view_hands.js")
cd "$scratch" || exit 1
view() { "$MERLIN" view "$@"; }

succeeds cup.merlin "$MERLIN" estimate "$examples/demo.png" -o cup.merlin

echo "maps become a page"
succeeds '^cup.merlin: cup.merlin/viewer.html (.* 1 file, ' view cup.merlin
present cup.merlin/viewer.html
succeeds 'out/cup.html' view cup.merlin/maps.exr -o out/cup.html
succeeds 'out/cup.html' view cup.merlin/report.json -o out/cup.html
cmp -s cup.merlin/viewer.html out/cup.html || complain "the same maps give another page"
succeeds '"warnings":\[\],"input":"cup.merlin","output":"out"' view cup.merlin -o out/cup.html --json
lists_its_files out cup.html
succeeds small view cup.merlin --size 128 -o small.html
grep -q 'has 128 of the object.s 512 pixels a side$' stderr || complain "no word of what was left out: $(cat stderr)"
[ "$(stat -c %s small.html)" -lt "$(stat -c %s out/cup.html)" ] || complain "128 pixels a side are no less than 512"

echo "maps and page come at once"
succeeds '"html/viewer.html"' "$MERLIN" estimate "$examples/demo.png" --html -o html --json
present html/viewer.html
succeeds '"views/viewer.html"' "$MERLIN" stereo cup.merlin --html -o views --json
present views/viewer.html

echo "bad input gets one line, and nothing is half-written"
refuses 2 'no folder of maps given' view
refuses 2 'one folder at a time' view cup.merlin cup.merlin
refuses 2 'ends in .html' view cup.merlin -o cup.merlin/maps.exr
refuses 2 '--size' view cup.merlin --size 63
refuses 1 'there is no folder nowhere' view nowhere
mkdir empty
echo cup >list.txt
refuses 1 'no maps.exr in empty' view empty
refuses 1 'is no folder of maps: merlin estimate' view "$examples/demo.png"
refuses 1 'list.txt is neither a folder of maps nor a photograph' view list.txt
refuses 1 'a file of that name is in the way' view cup.merlin -o small.html/cup.html
mkdir taken.html
refuses 1 'cannot write ./taken.html: a folder is in the way' view cup.merlin -o taken.html
head -c 1000 cup.merlin/maps.exr >empty/maps.exr
refuses 1 'empty/maps.exr' view empty
[ "$(ls -A empty taken.html)" = $'empty:\nmaps.exr\n\ntaken.html:' ] || complain "left behind: $(ls -A empty taken.html)"

((failures == 0)) || finish
if sanitized; then
    echo "a browser runs the page without sanitizers: not looked at"
    finish
fi
browser_start || {
    echo "skipped: there is no Chromium, so nobody looks at the page"
    exit 77
}

# within MEAN PERCENTILE A B: the pictures differ by at most so many per cent of the scale in the mean, and in their 99th
# percentile.
within() {
    local differ
    differ=$("${PICTURES_DIFFER:?}" "$3" "$4") || complain "$3 and $4 cannot be compared"
    awk -v mean="$1" -v most="$2" '{ exit !($1 <= mean && $2 <= most) }' <<<"${differ:-100 100}" ||
        complain "$3 and $4 differ by $differ per cent, more than $1 and $2"
    echo "  $differ per cent"
}

# lit FOLDER WORDS RELIGHT-OPTIONS...: the page under the light of WORDS and merlin relight's picture, in page.png and
# relit/relit.png.
lit() {
    local folder=$1 words=$2
    shift 2
    "$MERLIN" relight "$folder" "$@" -o relit >/dev/null 2>stderr || complain "relight $*: $(cat stderr)"
    browser_open "file://$PWD/$folder/viewer.html#bare&$words" 640 640
    browser_picture page.png 512
}

# A step of 8 bits is 0.4 per cent; both round, from numbers that differ by less than a step, so that the mean is well below
# one, and the percentile two at most, where shadows end. Measured: 0.01 to 0.05, and 0.39 or 0.78.
same=(0.1 1)

echo "the page's lamps are merlin relight's"
lit cup.merlin 'light=0.7,0.3,-0.4' --light 0.7,0.3,-0.4 --no-bounces
within "${same[@]}" relit/relit.png page.png
lit cup.merlin 'direction=-1,0.4,0.3&power=1.7&color=%23ffd2a1&exposure=0.5' \
    --direction -1,0.4,0.3 --power 1.7 --color '#ffd2a1' --exposure 0.5 --no-bounces
within "${same[@]}" relit/relit.png page.png
lit cup.merlin 'light=0,0,0' --light 0,0,0 --no-bounces
within "${same[@]}" relit/relit.png page.png

# What the network adds on top, which a page has no room for, is 0.8 per cent in the mean here and 7 where it corrects a
# highlight.
echo "what the page leaves out of merlin relight is below one per cent"
lit cup.merlin 'light=0.7,0.3,-0.4' --light 0.7,0.3,-0.4
within 1 10 relit/relit.png page.png

echo "the light that was found turns as merlin relight turns it"
succeeds window "$MERLIN" estimate "$examples/window.png" -o window
succeeds window view window
lit window 'light=none&env=found&rotate=50' --found-light --rotate 50 --no-bounces
within "${same[@]}" relit/relit.png page.png

echo "a panorama that is dropped is merlin relight's surroundings"
radiance room.hdr 64 22 128
"$MERLIN" relight cup.merlin --env room.hdr --rotate 30 -o relit >/dev/null || complain "no picture in a room"
browser_open "file://$PWD/cup.merlin/viewer.html#bare&light=none&rotate=30" 640 640
browser_drop '#file' room.hdr
said=$(browser_eval '(async () => { while (!/lights the object|cannot/.test(document.body.textContent)) await new Promise((done) => setTimeout(done, 50));
    for (let i = 0; i < 5; i++) await new Promise((done) => requestAnimationFrame(done));
    return document.getElementById("said").textContent; })()')
[[ $said == "room.hdr lights the object" ]] || complain "the page says of room.hdr: $said"
browser_picture page.png 512
within "${same[@]}" relit/relit.png page.png

echo "a captured surface is lit without gloss"
ev=$(grep -o '"ev":[-0-9.e]*' views/viewer.html | cut -d: -f2)
lit views 'light=0.5,-0.6,-0.3' --light 0.5,-0.6,-0.3 --exposure "$ev" --no-bounces
within "${same[@]}" relit/relit.png page.png

echo "hands and keys do what the page says"
browser_open "file://$PWD/cup.merlin/viewer.html" 1200 800
browser_eval "(async () => { $hands
return await all(); })()" >said
grep -v '^ok' said && complain "the page does not do what it should"
[[ $(grep -c '^ok' said) -ge 20 ]] || complain "only $(grep -c '^ok' said) things were tried"

browser_end
finish
