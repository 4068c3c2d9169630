#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# merlin relight from outside: what it writes, and how it refuses.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/support/check.bash"
# shellcheck source=tests/cli/support/pictures.bash
source "$(dirname "$0")/support/pictures.bash"
make_tiny_model
make_bad_weights
export OMP_WAIT_POLICY=passive MERLIN_MODEL=$scratch/weights.safetensors # other tests may run beside this one
cd "$scratch" || exit 1
relight() { "$MERLIN" relight "$@"; }

radiance disc.hdr 64 22
succeeds disc.merlin "$MERLIN" estimate disc.hdr --size 64

echo "lights become pictures"
succeeds disc.merlin/relit relight disc.merlin --light 0.5,0.2,-0.4 --light -0.5,0.2,-0.4
present disc.merlin/relit/relit_000.png disc.merlin/relit/relit_001.png disc.merlin/relit/relit.png
cmp -s disc.merlin/relit/relit_000.png disc.merlin/relit/relit_001.png && complain "two lights, one picture"
succeeds network relight disc.merlin --light 0.5,0.2,-0.4 --by network -o network
present network/relit_000.png
cmp -s network/relit_000.png disc.merlin/relit/relit_000.png && complain "network and BRDF give the same bits"
succeeds plain relight disc.merlin --light 0.5,0.2,-0.4 --no-shadows -o plain
present plain/relit_000.png
succeeds direct relight disc.merlin --light 0.5,0.2,-0.4 --no-bounces -o direct
present direct/relit_000.png
for other in disc.merlin/relit plain; do
    cmp -s direct/relit_000.png $other/relit_000.png && complain "--no-bounces gives what $other has"
done

succeeds disc.merlin/relit relight disc.merlin/maps.exr --light 0.5,0.2,-0.4 -o disc.merlin/relit
(cd disc.merlin && succeeds ./relit relight maps.exr --light 0.5,0.2,-0.4)
absent disc.merlin/maps.merlin

echo "a burnt-out photograph is called so"
burn_out disc.hdr white.hdr
succeeds white relight white.hdr --size 64 --light 0.5,0.2,-0.4 -o white
grep -q 'relight: white.hdr: 100 % of the object is burnt out' stderr || complain "no word of it: $(cat stderr)"

echo "the same light gives the same picture"
succeeds again relight disc.merlin --light 0.5,0.2,-0.4 -o again
cmp -s again/relit_000.png disc.merlin/relit/relit_000.png || complain "relighting is not deterministic"

echo "a photograph can be relit at once"
succeeds '^{.*"lights":1,.*}$' relight disc.hdr --size 64 --light 0.5,0.2,-0.4 -o at-once --json
present at-once/relit_000.png

echo "--json lists what was written"
lists_its_files at-once relit.png relit_000.png
grep -q '"input":"disc.hdr"' stdout || complain "no input in $(cat stdout)"
succeeds '"dome":3' relight disc.merlin --dome 3 --lp --orbit 2 -o all --json
lists_its_files all dome.lp dome_00{0..2}.png frame_00{0,1}.png mask.webp orbit.{gif,png,webp}
succeeds '"dome":4' relight disc.merlin --dome 4 -o all --json # no list of three lights stays beside the four pictures
lists_its_files all dome.lp dome_00{0..3}.png mask.webp
[ "$(head -1 all/dome.lp)" = 4 ] || complain "dome.lp was not renewed: $(cat all/dome.lp)"
printf '1\nphoto.jpg 0 0 1\n' >all/dome.lp # of other pictures
succeeds '"dome":4' relight disc.merlin --dome 4 -o all --json
grep -q photo.jpg all/dome.lp || complain "a list of other pictures was replaced: $(cat all/dome.lp)"

echo "what is read is not replaced"
mkdir own
cp disc.hdr own/relit.png
refuses 1 'own/relit.png: it is what was read' relight own/relit.png --size 64 --light 0,0,0 -o own
[ "$(ls -A own)" = relit.png ] && cmp -s disc.hdr own/relit.png || complain "own has $(ls -A own)"

echo "lists of lights"
printf '0.5 0.2 -0.4\n# another\n-0.5 0.2 -0.4\n' >lights.txt
printf '2\na.jpg 0.5 0.2 0.8\nb.jpg -0.5 0.2 0.8\n' >lights.lp
for list in lights.txt lights.lp; do
    succeeds from relight disc.merlin --lights $list -o "from-$list"
    present "from-$list/relit_001.png"
    absent "from-$list/relit_002.png"
done

echo "one light's picture is relit.png itself, which standard output takes, too"
cmp -s again/relit.png again/relit_000.png || complain "relit.png of one light is another picture"
cmp -s disc.merlin/relit/relit.png disc.merlin/relit/relit_000.png || complain "relit.png of one light is a sheet"
"$MERLIN" relight disc.merlin --light 0.5,0.2,-0.4 -o - >printed 2>stderr || complain "-o - failed: $(cat stderr)"
cmp -s printed again/relit.png || complain "standard output has another picture"
"$MERLIN" relight disc.merlin --light 0.5,0.2,-0.4 --format jpg -o - >printed || complain "-o - of a JPEG failed"
[ "$(head -c 3 printed | od -An -tx1)" = ' ff d8 ff' ] || complain "what is printed is no JPEG"
refuses 2 'one picture to standard output' relight disc.merlin --light 0,0,0 --light 1,0,0 -o -
refuses 2 'one picture to standard output' relight disc.merlin --dome 5 -o -
refuses 2 'no room for --json' relight disc.merlin --light 0,0,0 -o - --json
[ -e ./- ] && complain "a folder - was made"

echo "lamps far away, stronger, of another colour"
succeeds afar relight disc.merlin --direction 0.5,0.25,0.75 --direction 4,2,6 -o afar
cmp -s afar/relit_000.png afar/relit_001.png || complain "a direction's length matters"
cmp -s afar/relit_000.png again/relit_000.png && complain "far lamps are as near ones"
relight disc.merlin --power 2 --light 0.5,0.2,-0.4 --light 0.5,0.2,-0.4 --power 1 -o power >stdout || complain "--power failed"
cmp -s power/relit_001.png again/relit.png || complain "power 1 is another lamp"
cmp -s power/relit_000.png again/relit.png && complain "power 2 is the same lamp"
relight disc.merlin --power 2 --light 0.5,0.2,-0.4 --exposure -1 -o halved >stdout || complain "--exposure failed"
cmp -s halved/relit.png again/relit.png || complain "twice the light at half the exposure is another picture"
relight disc.merlin --light 0.5,0.2,-0.4 --color '#ffffff' --light 0.5,0.2,-0.4 --color 2700K --light 0.5,0.2,-0.4 \
    --color 1,0.4,0.1 -o colors >stdout || complain "--color failed"
cmp -s colors/relit_000.png again/relit.png || complain "white is another light"
cmp -s colors/relit_000.png colors/relit_001.png && complain "a bulb is white"
echo "lamps together in one picture"
relight disc.merlin --together --no-bounces --light 0.5,0.2,-0.4 --light 0.5,0.2,-0.4 -o both >stdout || complain "--together failed"
relight disc.merlin --no-bounces --light 0.5,0.2,-0.4 --power 2 -o double >stdout || complain "--power failed"
[ "$(ls both)" = "$(ls double)" ] || complain "two lamps together are not one picture: $(ls both)"
cmp -s both/relit.png double/relit.png || complain "a lamp twice is not a lamp of twice the power"
succeeds '"lights":2' relight disc.merlin --together --light 0.5,0.2,-0.4 --color '#ff0000' --direction -1,0,1 --color '#0000ff' -o two --json
cmp -s two/relit.png both/relit.png && complain "--together forgets colours"
relight disc.merlin --together --light 0.5,0.2,-0.4 --light 0,0,0 -o - >printed.png && [ -s printed.png ] || complain "-o - refuses lamps together"
refuses 2 '--together is of the lamps' relight disc.merlin --together --env disc.hdr
refuses 2 '--together is of the lamps' relight disc.merlin --together --dome 4 --light 0,0,0
refuses 2 'beside which its lamps stand' relight disc.merlin --together --light 0,0,0 --orbit 4
refuses 2 'knows one lamp alone' relight disc.merlin --together --light 0,0,0 --by network
for color in 500K '#ff' 1,2 -1,0,0 0,0,0 red; do refuses 2 '--color' relight disc.merlin --light 0,0,0 --color "$color"; done
refuses 2 '--power' relight disc.merlin --light 0,0,0 --power 0
refuses 2 'no length' relight disc.merlin --direction 0,0,0
refuses 2 'no distant lights' relight disc.merlin --direction 0,0,1 --by network -o none
refuses 2 'knows lamps in front .* 0.5 to 2 away' relight disc.merlin --light 3,3,3 --by network -o none
refuses 2 'knows lamps in front' relight disc.merlin --light 0.5,0.2,-1.5 --by network -o none
mkdir mine
: >mine/frame_000.png
: >mine/relit_000.png
refuses 1 'mine: its frame_000.png is no earlier result' relight disc.merlin --orbit 3 -o mine
refuses 1 'mine: its relit_000.png is no earlier result' relight disc.merlin --light 0,0,0 --light 0.1,0,0 -o mine
[ -s mine/frame_000.png ] && complain "somebody's picture was replaced"
succeeds '"code":"relit_burnt_out".*"burnt_out":\(0.9\|1\)' relight disc.merlin --light 0,0,0 --power 1000 -o glare --json
grep -q '^merlin relight: disc.merlin: \(9[0-9]\|100\) % of the object is burnt out when relit' stderr || complain "no word: $(cat stderr)"
succeeds '"warnings":\[\]' relight disc.merlin --light 0,0,0 --power 1000 --exposure auto -o glare --json

echo "the report names the weights that worked: the maps' own, or with a word other ones"
shipped() { MERLIN_MODEL='' "$MERLIN" "$@"; }
succeeds '"code":"other_model","message":"the maps are of tiny, and the bounces of their light of merlin-point".*"model":"merlin-point"' \
    shipped relight disc.merlin --light 0.5,0.2,-0.4 -o others --json
succeeds '"code":"other_model".*decoder.*"model":"merlin-point"' \
    shipped relight disc.merlin --light 0.5,0.2,-0.4 --by network -o others --json
succeeds '"model":"tiny"' relight disc.merlin --light 0.5,0.2,-0.4 -o others --json
grep -q other_model stdout && complain "tiny is another model than tiny: $(cat stdout)"
for own in merlin-any merlin-env; do
    succeeds "$own" shipped estimate disc.hdr --size 64 --views 1 --model $own -o $own
    succeeds "\"model\":\"$own\"" shipped relight $own --light 0.5,0.2,-0.4 -o others --json
    grep -q other_model stdout && complain "$own is another model than $own: $(cat stdout)"
done
succeeds '"model":"merlin-env"' shipped relight merlin-env --light 0.5,0.2,-0.4 --by network -o others --json
succeeds '"code":"other_model".*"model":"merlin-point"' \
    shipped relight merlin-any --light 0.5,0.2,-0.4 --by network -o others --json
succeeds '"model":"tiny"' relight merlin-env --light 0.5,0.2,-0.4 -o others --json
grep -q '^merlin relight: merlin-env: the maps are of merlin-env, and the bounces of their light of tiny[;]' stderr ||
    complain "no word of other weights: $(cat stderr)"
succeeds '"model":"merlin-env"' shipped stereo merlin-env -o others-stereo --json
succeeds '"model":"merlin-point".*"code":"other_model"' shipped stereo disc.merlin -o others-stereo --json

echo "pictures that show nothing get a word"
succeeds '"code":"nothing_lit","message":"the object is black in the picture' \
    relight disc.merlin --light 0,0,0 --exposure -20 -o behind --json # behind it the tiny model sees bounces
succeeds behind relight disc.merlin --light 0.5,0.2,-0.4 --light 0,0,0 --exposure -20 -o behind
grep -q 'disc.merlin: the object is black in 2 of 2 pictures' stderr || complain "no word: $(cat stderr)"
succeeds '"warnings":\[\]' relight disc.merlin --dome 5 -o around-it --json

echo "what would change nothing is refused"
refuses 2 'are of lamps; surroundings are made brighter by --env-exposure' relight disc.merlin --env disc.hdr --power 3
refuses 2 'are of lamps; the found light is made brighter by --exposure' relight disc.merlin --found-light --color 2700K
refuses 2 'is of distant lights' relight disc.merlin --dome 9 --rti hsh --near

echo "pictures of an earlier run among the new ones get a word"
succeeds left relight disc.merlin --orbit 5 --light 0,0,0 --light 0.5,0,0 --light 0,0.5,0 -o left
[ -s stderr ] && complain "a word of nothing: $(cat stderr)"
succeeds '"code":"pictures_left","message":"4 pictures of an earlier run are still beside these, frame_003.png first"' \
    relight disc.merlin --orbit 3 --light 0,0,0 -o left --json
succeeds left relight disc.merlin --light 0,0,0 --light 0.5,0,0 -o left
grep -q '1 picture of an earlier run is still beside these, relit_002.png first' stderr || complain "no word: $(cat stderr)"
succeeds left relight disc.merlin --light 0,0,0 --light 0.5,0,0 --light 0,0.5,0 -o left
[ -s stderr ] && complain "a word of nothing: $(cat stderr)"

echo "a list of directions is of far lamps, unless they are to be near"
succeeds from relight disc.merlin --lights lights.lp --near -o from-near
cmp -s from-near/relit_000.png from-lights.lp/relit_000.png && complain "--near makes no difference to an .lp file's lamps"

echo "domes beside the object, as JPEG, and what they leave alone"
succeeds beside relight disc.merlin --dome 4 --near --radius 2 --format jpg -o beside
present beside/dome_00{0..3}.jpg beside/lights.txt beside/mask.webp
absent beside/dome.lp beside/dome_000.png
[ "$(grep -vc '^#' beside/lights.txt)" = 4 ] || complain "lights.txt does not list four lamps: $(cat beside/lights.txt)"
refuses 1 'lights.txt is of another dome' relight disc.merlin --dome 4 --format jpg -o beside
mkdir listed && echo '0 0 1 # mine' >listed/lights.txt
refuses 1 'listed/lights.txt: it is no earlier result' relight disc.merlin --dome 4 --near -o listed
[ "$(ls -A listed)" = lights.txt ] || complain "listed has $(ls -A listed)"
refuses 1 'dome_003.jpg is of another dome' relight disc.merlin --dome 3 --near --format jpg -o beside
refuses 1 'dome_000.jpg is of another dome' relight disc.merlin --dome 4 --near -o beside
mkdir from-dome && printf '1\ndome_000.png 0 0 1\n' >from-dome/dome.lp
refuses 1 'dome.lp is of another dome' relight disc.merlin --dome 4 --near -o from-dome
refuses 2 '--near has none' relight disc.merlin --dome 4 --near --lp
refuses 2 'give --near, too' relight disc.merlin --dome 4 --by network
refuses 2 '--radius is of --near' relight disc.merlin --dome 4 --radius 2
refuses 2 '--format' relight disc.merlin --light 0,0,0 --format tif
refuses 2 "an --orbit's frames are PNG" relight disc.merlin --orbit 4 --format jpg
printf '0.5 0.2 -0.4 1 0 0\n' >led.txt
succeeds led relight disc.merlin --lights led.txt -o led
relight disc.merlin --light 0.5,0.2,-0.4 --color 1,0,0 -o led_too >stdout || complain "--color failed"
cmp -s led/relit.png led_too/relit.png || complain "a list's red LED is another than --color's"

echo "intensities beside a list are heeded"
mkdir strong
printf '0.5 0.2 -0.4 2 1 3\n0 0 0 0.5 0.5 0.5\n' >whole.txt
printf '0.5 0.2 -0.4\n0 0 0\n' >strong/lights.txt
printf '2 1 3\n0.5 0.5 0.5\n' >strong/light_intensities.txt
succeeds whole relight disc.merlin --lights whole.txt -o whole
succeeds parts relight disc.merlin --lights strong/lights.txt -o parts
for i in 0 1; do cmp "whole/relit_00$i.png" "parts/relit_00$i.png" || complain "intensities of their own make another picture"; done
echo 3 >>strong/light_intensities.txt
refuses 1 'light_intensities.txt has 3 intensities for 2 lights' relight disc.merlin --lights strong/lights.txt -o none
cp whole.txt strong/lights.txt
refuses 1 'both say how strong the lights are' relight disc.merlin --lights strong/lights.txt -o none
refuses 2 '--matte is of --by brdf' relight disc.merlin --light 0,0,0 --by network --matte

echo "an orbit becomes frames and animations"
succeeds orbit relight disc.merlin --orbit 5 -o orbit
present orbit/frame_00{0..4}.png orbit/orbit.webp orbit/orbit.gif orbit/orbit.png
absent orbit/frame_005.png
# viewers take delays of a hundredth of a second for "as usual", which is a tenth
succeeds quick relight disc.merlin --orbit 201 --frame 32 -o quick
od -An -v -tx1 quick/orbit.gif | tr -d ' \n' | grep -q '21f904..0200..00' || complain "the GIF's frames do not take 0.02 s each"

echo "surroundings, alone and beside a light"
radiance room.hdr 8 3 16
sed -i '1s/.*/#?RGBE/' room.hdr # as some programs spell it
succeeds room relight disc.merlin --env room.hdr -o room
present room/relit_000.png room/relit.png
absent room/relit_001.png
succeeds turned relight disc.merlin --env room.hdr --rotate 90 -o turned
cmp -s room/relit_000.png turned/relit_000.png && complain "turned surroundings give the same picture"
succeeds room-again relight disc.merlin --env room.hdr -o room-again
cmp -s room/relit_000.png room-again/relit_000.png || complain "surroundings with shadows are not deterministic"
succeeds open relight disc.merlin --env room.hdr --no-shadows -o open
cmp -s room/relit_000.png open/relit_000.png && complain "--no-shadows makes no difference under surroundings"
succeeds whole relight disc.merlin --env room.hdr --env-exposure 1 --light 0.5,0.2,-0.4 -o whole
cmp -s room/relit_000.png whole/relit_000.png && complain "a light beside the surroundings makes no difference"
succeeds '"warnings":\[\]' relight disc.merlin --env room.hdr --env-exposure 6 --light 0.5,0.2,-0.4 --power 0.001 --exposure auto \
    -o metered --json # by the lamp alone it would be burnt out
succeeds around relight disc.merlin --env room.hdr --orbit 3 -o around
present around/relit_000.png around/frame_00{0..2}.png around/orbit.webp
cmp -s around/frame_000.png around/frame_001.png && complain "the surroundings do not go round"
refuses 2 'ends like a picture' relight disc.merlin --light 0,0,0 -o lit.PNG
refuses 2 'ends like a picture' relight disc.merlin --orbit 3 -o orbit.gif
refuses 2 'wants an --env or the --found-light' relight disc.merlin --light 0,0,0 --rotate 90
refuses 2 'without --env' relight disc.merlin --env room.hdr --dome 5
for other in '--light 0,0,0' '--dome 4' '--env room.hdr'; do
    # shellcheck disable=SC2086 # words
    refuses 2 'comes alone' relight disc.merlin --found-light $other
done
refuses 2 'knows one lamp alone' relight disc.merlin --found-light --by network
refuses 2 'exposed as the photograph' relight disc.merlin --found-light --exposure auto
refuses 1 'estimate it by merlin-any' relight disc.merlin --found-light -o none
refuses 2 '--rotate' relight disc.merlin --env room.hdr --rotate left
refuses 2 'relight by BRDF' relight disc.merlin --env room.hdr --by network -o none
refuses 2 'point lights only' relight disc.merlin --env room.hdr --light 0,0,0 --by network -o none
refuses 1 'missing.hdr' relight disc.merlin --env missing.hdr -o none
refuses 1 'disc.hdr is 64×64 pixels; a latitude-longitude' relight disc.merlin --env disc.hdr -o none
absent none

echo "wrong use"
refuses 2 'no photograph' relight
refuses 2 'no light' relight disc.merlin
refuses 2 '--frame is the side of an --orbit' relight disc.merlin --light 0,0,0 --frame 64
refuses 2 '--no-shadows is of --by brdf' relight disc.merlin --light 0,0,0 --by network --no-shadows
refuses 2 '--no-bounces is of --by brdf' relight disc.merlin --light 0,0,0 --by network --no-bounces
refuses 2 'give it or --no-shadows' relight disc.merlin --light 0,0,0 --no-bounces --no-shadows
refuses 2 'one --light, not 2' relight disc.merlin --env room.hdr --orbit 3 --light 0,0,0 --light 1,0,0
refuses 2 'one --light, not 2' relight disc.merlin --env room.hdr --orbit 3 --lights lights.txt
refuses 2 'holds maps already' relight disc.merlin --light 0,0,0 --views 8
refuses 2 'holds maps already' relight disc.merlin --light 0,0,0 --mask disc.merlin/mask.png
refuses 2 'one photograph' relight disc.merlin disc.hdr --light 0,0,0
refuses 2 '--light' relight disc.merlin --light 1,2
refuses 2 '--light' relight disc.merlin --light 0,nan,0
refuses 2 '--orbit' relight disc.merlin --orbit 100000
refuses 2 '--by' relight disc.merlin --light 0,0,0 --by magic
refuses 2 'unknown option' relight disc.merlin --nonsense

echo "bad input"
lights=(--light 0,0,0 -o none)
refuses 1 'missing' relight missing "${lights[@]}"
mkdir empty
refuses 1 'no maps.exr in empty: merlin estimate makes one' relight empty "${lights[@]}"
mkdir cut
head -c 1500 disc.merlin/maps.exr >cut/maps.exr
refuses 1 'cut/maps.exr' relight cut "${lights[@]}"
mkdir other
openexr other/maps.exr '\0\0\0\77'
refuses 1 'not written by merlin' relight other "${lights[@]}"
printf '0 0 0\n0 inf 0\n' >bad.txt
refuses 1 'bad.txt:2' relight disc.merlin --lights bad.txt -o none
: >nothing.txt
refuses 1 'no lights' relight disc.merlin --lights nothing.txt -o none
refuses 1 'missing.lp' relight disc.merlin --lights missing.lp -o none
refuses 1 'missing.safetensors' relight disc.merlin --model missing.safetensors "${lights[@]}"
absent none

echo "places that cannot be written, disks that fill up"
refuses 1 '/proc/merlin' relight disc.merlin --light 0,0,0 -o /proc/merlin
refuses 1 'cannot write' limited 1 "$MERLIN" relight disc.merlin --orbit 4 -o full/deep
absent full

echo "an interrupted orbit leaves nothing"
"$MERLIN" relight disc.merlin --orbit 240 -o interrupted/deep --quiet >out 2>err &
pid=$!
await interrupted/deep
kill -INT $pid
wait $pid
code=$?
[ $code -eq 1 ] || complain "exit code $code after an interrupt"
[ "$(wc -l <err)" -eq 1 ] || complain "after an interrupt: $(cat err)"
absent interrupted
finish
