#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# merlin stereo from outside: what it writes, and how it refuses.
# shellcheck source=tests/cli/support/check.bash
source "$(dirname "$0")/support/check.bash"
# shellcheck source=tests/cli/support/pictures.bash
source "$(dirname "$0")/support/pictures.bash"
make_tiny_model
export OMP_WAIT_POLICY=passive MERLIN_MODEL=$scratch/weights.safetensors # other tests may run beside this one
cd "$scratch" || exit 1
stereo() { "$MERLIN" stereo "$@"; }

radiance disc.hdr 64 22
succeeds disc.merlin "$MERLIN" estimate disc.hdr --size 64
files=(maps.exr normal.png albedo.png depth.png mask.png error.png overview.png report.json)

echo "a dome of relit pictures is read back"
succeeds dome "$MERLIN" relight disc.merlin --dome 6 --lp -o dome
present dome/dome_00{0..5}.png dome/dome.lp dome/mask.webp
absent dome/dome_006.png
[ "$(wc -l <dome/dome.lp)" -eq 7 ] || complain "dome.lp is not a count and six lines"
succeeds '"pictures": *6' stereo dome --method ls --json
present "${files[@]/#/dome/stereo/}" dome/stereo/mesh.{ply,obj,mtl,png,glb}
absent dome/stereo/confidence.png
succeeds normal_spread_degrees stereo dome --json -o robust
present robust/confidence.png
LC_ALL=C grep -qaP 'depth\.Z\x00\x02\x00\x00\x00' dome/stereo/maps.exr || complain "maps.exr has no depth of 32 bits"

echo "a dome's list lights other pictures, and that is said"
mkdir other
for i in {0..5}; do cp "dome/dome_00$i.png" "other/bust$i.png"; done
succeeds '"lights_in_order":true' stereo other --lights dome/dome.lp --method ls --json
grep -q "in the order of the pictures' names" stderr || complain "stderr: $(cat stderr)"

echo "pictures of another kind are named where they are missed"
mkdir mixed
cp dome/dome_00[0-4].png dome/mask.webp mixed
{
    printf 'P5\n64 64\n255\n'
    head -c 4096 disc.hdr
} >mixed/dome_005.pgm
awk 'NR > 1 { print $2, $3, $4 }' dome/dome.lp >mixed/lights.txt
refuses 1 'mixed has 5 pictures, but mixed/lights.txt has 6 lights; each picture needs one; 1 file skipped: dome_005.pgm' stereo mixed

echo "three near lights do not tell the distance, and that is said"
printf '0.5 0 -0.3\n-0.3 0.5 -0.3\n-0.3 -0.5 -0.3\n' >near.txt
"$MERLIN" relight disc.merlin --lights near.txt -o near --quiet || complain "no pictures under near lights"
mkdir leds
cp near/relit_00?.png disc.merlin/mask.png leds
succeeds '"distance_unsure":true' stereo leds --lights near.txt --near --json
grep -q 'how far the object is' stderr || complain "stderr: $(cat stderr)"
succeeds '"distance_unsure":false' stereo leds --lights near.txt --near --distance 1 --json
grep -q 'how far the object is' stderr && complain "stderr: $(cat stderr)"
grep -q 'nothing tells the lens' stderr || complain "no word of the lens: $(cat stderr)"
grep -q 'three pictures or so' stderr || complain "no word of so few pictures: $(cat stderr)"

echo "a network of near lights solves them, too"
"$TINY_MODEL" nfps.safetensors nfps || complain "no weights of near lights"
near=(stereo leds --lights near.txt --near --distance 1 --method nfps --json)
succeeds '"method":"nfps","pictures":3' "${near[@]}" --model nfps.safetensors -o nfps
present "${files[@]/#/nfps/}" nfps/confidence.png
refuses 1 'model "tiny" is none for pictures under known lights' "${near[@]}" --model weights.safetensors
refuses 2 'needs light positions, which this capture does not have' stereo dome --method nfps --model nfps.safetensors
refuses 2 'nfps is for a folder of pictures' stereo disc.hdr --method nfps
refuses 2 'are for one photograph' "${near[@]}" --model nfps.safetensors --size 64

echo "whether unknown lights are told is said"
"$MERLIN" relight disc.merlin --dome 8 -o unknown --quiet || complain "no pictures under a dome"
succeeds '"lights_unsure":' stereo unknown --method uncalibrated --json

refuses 2 'takes no --lights and no --near' stereo dome --method universal --near
refuses 2 'ls, robust, near, nfps, semi, universal, uncalibrated or auto' stereo dome --method magic

echo "meshes by name, depth that may jump"
echo "a surface can be relit"
succeeds surface-relit "$MERLIN" relight dome/stereo --light 0.7,0.2,-0.4 --light -0.7,0.2,-0.4 --light 0,0,-9 -o surface-relit
present surface-relit/relit_00{0..2}.png
cmp -s surface-relit/relit_000.png surface-relit/relit_001.png && complain "light from the right as from the left"
cmp -s surface-relit/relit_000.png surface-relit/relit_002.png && complain "light from the right as from behind"
refuses 2 'network wants a photograph' "$MERLIN" relight dome/stereo --light 0,0,0 --by network

succeeds out stereo dome --method ls --integrate edges --mesh a.ply --mesh b.glb -o out
present "${files[@]/#/out/}" a.ply b.glb
absent out/mesh.ply out/mesh.glb
succeeds '"input":"dome"' stereo dome --method ls --mesh b.obj -o out --json
for file in ./b.{mtl,obj,png} out/{maps.exr,report.json}; do
    grep -qF "\"$file\"" stdout || complain "the files do not have $file: $(cat stdout)"
done

refuses 1 'out holds a captured surface' stereo out

echo "one photograph"
# by weights that ship: those of four presentations make much of the last digit, which processors differ in
export MERLIN_MODEL=$MERLIN_SOURCE_DIR/models/merlin-point.safetensors
succeeds '"normal_spread_mean_degrees"' stereo disc.hdr --size 64 --json -o photo
present "${files[@]/#/photo/}" photo/mesh.glb

echo "its maps, which are there already"
spread() { grep -o '"normal_spread_mean_degrees":[0-9.]*' stdout | cut -d: -f2; }
estimated=$(spread)
succeeds estimated "$MERLIN" estimate disc.hdr --size 64 -o estimated
succeeds '"normal_spread_mean_degrees"' stereo estimated --json
present "${files[@]/#/estimated/stereo/}" estimated/stereo/mesh.glb
# what estimate wrote is in half floats: three digits
awk "BEGIN { exit !(($(spread) - $estimated) ^ 2 < (0.005 * $estimated) ^ 2) }" || complain "$(spread) is not $estimated"
echo "places about the object are near lights, by the lens that is given, too"
"$MERLIN" estimate "$MERLIN_SOURCE_DIR/examples/demo.png" --size 96 -o cup --quiet || complain "no maps"
"$MERLIN" relight cup --dome 12 --near -o lamps --quiet || complain "no pictures under near lamps"
{
    echo 12
    grep -v '#' lamps/lights.txt | awk '{ printf "dome_%03d.png %s %s %s\n", NR - 1, $1 * 500, $2 * 500, ($3 + 1) * 500 }'
} >places.lp
succeeds '"method":"near"' stereo lamps --lights places.lp --fov 60 --json -o placed
differ=$("$NORMALS_DIFFER" placed cup)
awk "BEGIN { exit !($differ < 1.6) }" || complain "its normals are $differ degrees off" # 1.1; by their residuals 2.3
export MERLIN_MODEL=$scratch/weights.safetensors
cp dome/dome_* dome/dome.lp estimated
succeeds '"pictures": *6' stereo estimated --method ls --json -o out
refuses 2 'holds maps already' stereo disc.merlin --size 64
refuses 2 'disc.merlin holds maps already' stereo disc.merlin/maps.exr --size 64 # no photograph
refuses 2 'for a folder of pictures' stereo disc.merlin --near

echo "a burnt-out photograph is called so"
burn_out disc.hdr white.hdr
succeeds white stereo white.hdr --size 64 -o white
grep -q 'stereo: white.hdr: 100 % of the object is burnt out' stderr || complain "no word of it: $(cat stderr)"

echo "lights from a ball, straight ahead"
mkdir ball
for i in 1 2; do radiance ball/$i.png 64 3; done # by their content Radiance pictures
cp disc.merlin/mask.png ball
succeeds '"sphere":"chrome"' stereo calibrate --sphere chrome ball -o lights --json
lists_its_files lights calibration.png lights.txt
[ "$(grep -c '^-*0[.]00[0-9]* -*0[.]00[0-9]* [01][.][09]' lights/lights.txt)" = 2 ] || complain "lights.txt: $(cat lights/lights.txt)"
mkdir -p taken/lights.txt
refuses 1 'taken/lights.txt' stereo calibrate --sphere chrome ball -o taken
[ "$(ls -A taken)" = lights.txt ] || complain "taken has $(ls -A taken)"
succeeds lights stereo calibrate --sphere chrome ball -o lights
rmdir taken/lights.txt && echo '0 0 1 # mine' >taken/lights.txt
refuses 1 'taken/lights.txt: it is no earlier result' stereo calibrate --sphere chrome ball -o taken
[ "$(cat taken/lights.txt)" = '0 0 1 # mine' ] || complain "a list of lights was replaced by $(cat taken/lights.txt)"

echo "results do not take the place of another capture's files"
mkdir another
cp dome/dome_00?.png dome/dome.lp another
refuses 1 'cannot write into another: it holds a capture' stereo dome --method ls -o another
refuses 1 'cannot write into another: it holds a capture' "$MERLIN" estimate disc.hdr --size 64 -o another
mv another/dome.lp another/LIGHTS.TXT
refuses 1 'cannot write into another: it holds a capture' stereo dome --method ls -o another
cp disc.merlin/mask.png another
refuses 1 'another: its mask.png is no earlier result' stereo dome --method ls -o another
cmp -s disc.merlin/mask.png another/mask.png || complain "a mask was replaced"
succeeds again stereo dome --method ls -o again
succeeds again stereo dome --method ls -o again
rm again/maps.exr
succeeds again stereo dome --method ls -o again

echo "wrong use"
refuses 2 'no folder' stereo
refuses 2 'a folder, which comes alone' stereo dome disc.hdr
refuses 2 '--method' stereo dome --method magic
refuses 2 '--integrate' stereo dome --integrate magic
refuses 2 'c.stl' stereo dome --mesh c.stl
refuses 2 'unknown option' stereo dome --nonsense
refuses 2 'for one photograph' stereo dome --views 8
refuses 2 'standard output cannot hold' stereo dome --method ls -o -
refuses 2 'is the folder of the pictures' stereo dome --method ls -o ./dome/
refuses 2 'for a folder' stereo disc.hdr --near
refuses 2 'for a folder' stereo disc.hdr --fov 40
refuses 2 '--fov' stereo dome --fov 200
refuses 2 'field of view' stereo dome --distance 3 -o none
refuses 2 '--distance' stereo dome --fov 40 --distance 0
refuses 2 'takes no --lights and no --near' stereo dome --method uncalibrated --near
refuses 2 '--dome' "$MERLIN" relight disc.merlin --dome 1
refuses 2 '--lp' "$MERLIN" relight disc.merlin --orbit 4 --lp

echo "bad input"
refuses 1 'missing' stereo missing -o none
mkdir empty
refuses 1 'empty' stereo empty -o none
head -4 dome/dome.lp >short.lp
refuses 1 'short.lp' stereo dome --lights short.lp -o none
refuses 1 'missing.txt' stereo dome --lights missing.txt -o none
refuses 1 'missing.png' stereo dome --mask missing.png -o none
head -c 60 dome/dome_000.png >cut.png
refuses 1 'cut.png' stereo dome --mask cut.png -o none
cp -r dome sizes
rm -r sizes/stereo
cp disc.merlin/overview.png sizes/dome_003.png
refuses 1 'dome_003.png' stereo sizes -o none
refuses 1 'missing.safetensors' stereo disc.hdr --model missing.safetensors -o none
refuses 2 'near ones: use near' stereo disc.hdr --method robust -o none
# every reader, each with one line and nothing written
copy_of() { rm -rf "$1" && mkdir "$1" && cp dome/*.png "$1"; }
copy_of text && echo "up and left" >text/lights.txt
refuses 1 'text/lights.txt' stereo text -o none
copy_of few && printf '0 0 1\n0 1 1\n' >few/lights.txt
refuses 1 '6 pictures.*2 lights' stereo few -o none
copy_of flat && printf '0 0 1\n0 1 1\n0 2 1\n0 3 1\n0 4 1\n0 5 1\n' >flat/lights.txt
refuses 1 'one plane' stereo flat -o none
copy_of broken && cp dome/dome.lp broken && head -c 200 dome/dome_002.png >broken/dome_002.png
refuses 1 'dome_002.png' stereo broken -o none
refuses 1 'overview.png' stereo dome --mask disc.merlin/overview.png -o none
refuses 1 'overview.png' stereo dome --ambient disc.merlin/overview.png -o none
printf 'lights\n6 64 64 100 32\n' >broken/led_params.txt
refuses 1 'broken/led_params.txt' stereo broken -o none
rm broken/led_params.txt broken/dome.lp
refuses 1 'empty' stereo calibrate --sphere chrome empty -o none
refuses 1 'dome_002.png' stereo calibrate --sphere matte broken -o none
copy_of diligent && printf '0 0 1\n0 1 1\n1 0 1\n' >diligent/light_directions.txt
(cd diligent && printf '%s\n' dome_00[0-3].png >filenames.txt)
refuses 2 'no positions' stereo diligent --near -o none
refuses 1 'filenames.txt names 4 pictures' stereo diligent -o none
head -3 diligent/filenames.txt >three && mv three diligent/filenames.txt
echo "1 1 x" >diligent/light_intensities.txt
refuses 1 'light_intensities.txt' stereo diligent -o none
printf '1 1 1\n1 1 1\n1 1 1\n' >diligent/light_intensities.txt
echo "not from MATLAB" >diligent/Normal_gt.mat
refuses 1 'Normal_gt.mat' stereo diligent -o none
absent none empty/stereo sizes/stereo

echo "places that cannot be written"
refuses 1 '/proc/merlin' stereo dome --method ls -o /proc/merlin
refuses 1 '/proc/a.ply' stereo dome --method ls --mesh /proc/a.ply -o none
refuses 1 '/proc/b.glb' stereo dome --method ls --mesh first.obj --mesh /proc/b.glb -o none
mkdir folder.ply
refuses 1 'folder.ply' stereo dome --method ls --mesh second.ply --mesh folder.ply -o none
mkdir taken.mtl # found only when all is moved into place
refuses 1 'taken.mtl' stereo dome --method ls --mesh taken.obj -o none
sed 's/^\(dome_.*\)$/\1 1 0 0/' dome/dome.lp >red.lp
refuses 1 'red.lp:[0-9]*: the light has no red, green or blue' stereo dome --lights red.lp -o none
echo mine >beside.png
refuses 1 'beside.obj: beside.png is no part of an earlier one' stereo dome --method ls --mesh beside.obj -o none
[ "$(cat beside.png)" = mine ] || complain "beside.png was replaced"
refuses 1 'maps/depth.obj.*the map depth.png' stereo dome --method ls --mesh maps/depth.obj -o maps
refuses 1 'dome/dome_000.obj.*dome_000.png' stereo dome --method ls --mesh dome/dome_000.obj -o none
refuses 1 'dome/cup.obj.*among what is read' stereo dome --method ls --mesh dome/cup.obj -o none
absent none maps dome/cup.{obj,mtl,png} taken.obj first.obj first.mtl first.png second.ply
for blocks in 1 8 60; do # on a disk that is full soon, later, and only when the meshes come
    refuses 1 'cannot write' limited $blocks "$MERLIN" stereo dome --method ls -o none
    refuses 1 'cannot write' limited $blocks "$MERLIN" stereo dome --method ls --mesh third.ply --mesh third.obj -o none
    absent none third.ply third.obj third.mtl third.png
done
finish
